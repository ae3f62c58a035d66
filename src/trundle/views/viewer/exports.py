"""The forms in which a motion can be handed on, by the ending of the file's name: one table for command and lab.

Each form loads what it needs when it is made: the table itself costs a server, or a help text, nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import TrundleError, UnknownNameError
from ...extras import need

if TYPE_CHECKING:
    from ..scene import Scene

Motion = Any  # a Trajectory; or a path that was rolled, with how it becomes a scene
MakeScene = Callable[..., "Scene"]


@dataclass(frozen=True)
class Format:
    """One form."""

    what: str  # in a few words, for help texts
    media_type: str  # as HTTP calls it
    write: Callable[[Motion, MakeScene], bytes]  # takes a motion and what makes a scene of it, returns the file's bytes
    extra: str = ""  # that must be installed for it, if any


def export(motion: Motion, suffix: str, make_scene: MakeScene | None = None) -> bytes:
    """Return a motion in another form.

    Examples
    --------
    >>> import trundle as tr
    >>> export(tr.Scenario.load("tilted-turntable").run(), ".svg")[:5]
    b'<?xml'
    """
    if suffix.lower() not in FORMATS:
        raise UnknownNameError("form to export", suffix, FORMATS)
    check_installed(suffix, suffix)
    from ..scene import scene_of

    return FORMATS[suffix.lower()].write(motion, make_scene or scene_of)


def check_installed(suffix: str, asked: str) -> None:
    """Refuse a form whose extra is not installed, before anything is computed for it.

    Examples
    --------
    >>> check_installed(".svg", "path.svg")
    """
    extra = FORMATS[suffix.lower()].extra
    if extra:
        need(extra, asked)


def _html(motion: Motion, make_scene: MakeScene) -> bytes:
    from .page import page_of

    return page_of([make_scene(motion, with_card=True)])


def _glb(motion: Motion, make_scene: MakeScene) -> bytes:
    from .glb import glb_of

    return glb_of(make_scene(motion))


def _gif(motion: Motion, make_scene: MakeScene) -> bytes:
    from .animation import gif_of

    return gif_of(make_scene(motion))


def _csv(motion: Motion, _: MakeScene) -> bytes:
    from .table import csv_of

    return csv_of(motion.dataset() if hasattr(motion, "dataset") else motion.data)


def _toml(motion: Motion, _: MakeScene) -> bytes:
    if not motion.scenario:
        raise TrundleError(
            "This run has no scenario file: the format has no words for a part of its system. "
            "Export its numbers instead, as .csv."
        )
    return str(motion.scenario).encode()


def _nc(motion: Motion, _: MakeScene) -> bytes:
    import tempfile

    with tempfile.TemporaryDirectory(prefix="trundle-") as folder:
        return motion.save(Path(folder) / "run.nc").read_bytes()


def _figure(kind: str, **options: Any) -> Callable[[Motion, MakeScene], bytes]:
    def draw(motion: Motion, _: MakeScene) -> bytes:
        picture = BytesIO()
        motion.plot().savefig(picture, format=kind, **options)
        return picture.getvalue()

    return draw


FORMATS: dict[str, Format] = {
    ".html": Format("a page that plays it, by itself", "text/html; charset=utf-8", _html),
    ".glb": Format("an animated model, for Blender and the like", "model/gltf-binary", _glb, extra="lab"),
    ".gif": Format("an animation", "image/gif", _gif),
    ".png": Format("the figure of the path", "image/png", _figure("png")),
    ".svg": Format("the same as a drawing", "image/svg+xml", _figure("svg")),
    ".csv": Format("its numbers", "text/csv; charset=utf-8", _csv),
    ".nc": Format("its numbers, scenario and card, as NetCDF", "application/x-netcdf", _nc),
    ".toml": Format("its scenario", "application/toml", _toml),
}
