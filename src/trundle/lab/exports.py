"""A scenario, or its run, as a file to keep: text, table, NetCDF, figure, page, model or animation."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..scenario import files
from . import limits
from .answers import answering, path_from, run_of, scenario_from, told
from .cache import Answer
from .errors import refused

if TYPE_CHECKING:
    import xarray

    from ..geometry import RolledPath
    from ..trajectory import Trajectory

Motion = Any  # a Trajectory or a RolledPath

MEDIA = {
    "toml": "application/toml",
    "csv": "text/csv; charset=utf-8",
    "nc": "application/x-netcdf",
    "png": "image/png",
    "svg": "image/svg+xml",
    "html": "text/html; charset=utf-8",
    "glb": "model/gltf-binary",
    "gif": "image/gif",
}
_NOT_OF_A_PATH = ("html", "glb", "gif")
_SAVED_FIGURE = {"dpi": 150}


@answering
def export(data: dict[str, Any], kind: str, folder: str) -> Answer:
    """Make a file of a scenario.

    Parameters
    ----------
    data : dict
        The scenario; one with [[path]] tables is rolled along its path.
    kind : str
        One of `MEDIA`.
    folder : str
        An empty folder for what must be a file on the way.

    Returns
    -------
    Answer
        The file, named after the scenario's title.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     made = export(files.parse(files.read("tilted-turntable"), ""), "csv", folder)
    >>> made.filename, made.body[:40]
    ('steel-ball-on-a-tilted-turntable.csv', b'time [s],position_x [m],position_y [m],p')
    """
    along_path = files.rolls_along_path(data)
    scenario: Any = path_from(data) if along_path else scenario_from(data)
    name = f"{slug(scenario.title)}.{kind}"
    if kind == "toml":
        return Answer(scenario.to_toml().encode(), MEDIA[kind], name)
    if along_path:
        if kind in _NOT_OF_A_PATH:
            message = f"A path has no {kind} of its own. Take png, svg, csv, nc or toml."
            raise refused(422, message, "format", "OutOfDomainError")
        motion: Motion = scenario.run()
    else:
        motion, _ = run_of(scenario, limits.MOST_SAVED)
    return Answer(_WRITERS[kind](motion, Path(folder)), MEDIA[kind], name)


def slug(title: str) -> str:
    """Return a title as the stem of a file's name: small letters, digits and dashes.

    Parameters
    ----------
    title : str
        Any.

    Returns
    -------
    str
        Never empty.

    Examples
    --------
    >>> slug("Steel ball, 25 mm (½ turn)"), slug("../../…")
    ('steel-ball-25-mm-turn', 'trundle')
    """
    return re.sub(r"[^a-z0-9]+", "-", title.lower()[:80]).strip("-") or "trundle"


def table_of(motion: Motion) -> xarray.Dataset:
    """Return a motion as labelled arrays, in the support frame."""
    return motion.dataset() if hasattr(motion, "dataset") else motion.in_frame("support").data


def csv(motion: Trajectory | RolledPath, folder: Path) -> bytes:  # noqa: ARG001
    """Return a table with a column for each component, its unit in brackets behind its name.

    Parameters
    ----------
    motion : Trajectory or RolledPath
        Any.
    folder : pathlib.Path
        Not used.

    Returns
    -------
    bytes
        Every digit is kept; `trundle check` reads it back.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("tilted-turntable").run(duration=1.0, every=0.5)
    >>> csv(run, Path()).decode().splitlines()[1][:20]
    '0.0,-0.97,-3.68,0.02'
    """
    import pandas as pd

    data = table_of(motion)
    main = "time" if "time" in data.dims else "distance"
    columns = {_heading(main, data[main]): data[main].values}
    for name, variable in data.data_vars.items():
        if variable.dims == (main,):
            columns[_heading(str(name), variable)] = variable.values
        elif variable.dims[0] == main:
            for part in data[variable.dims[1]].values:
                values = variable.sel({variable.dims[1]: part}).values
                columns[_heading(f"{name}_{part}", variable)] = values
    text = io.StringIO()
    pd.DataFrame(columns).to_csv(text, index=False, lineterminator="\r\n")
    return text.getvalue().encode()


def _heading(name: str, variable: xarray.DataArray) -> str:
    unit = str(variable.attrs.get("units", "1")).replace(" s-1", "/s")
    return name if unit == "1" else f"{name} [{unit}]"


def _saved(motion: Motion, folder: Path) -> bytes:
    return motion.save(folder / "run.nc").read_bytes()


def _figure(kind: str) -> Callable[[Motion, Path], bytes]:
    def drawn(motion: Motion, folder: Path) -> bytes:  # noqa: ARG001
        made = io.BytesIO()
        motion.plot().savefig(made, format=kind, **(_SAVED_FIGURE if kind == "png" else {}))
        return made.getvalue()

    return drawn


def _page(motion: Motion, folder: Path) -> bytes:
    viewer: Any = _viewer()
    from ..scene import scene_of

    target = folder / "scene.html"
    viewer.save_html(scene_of(motion), target)
    return target.read_bytes()


def _model(motion: Motion, folder: Path) -> bytes:  # noqa: ARG001
    viewer: Any = _viewer()
    from ..scene import scene_of

    return bytes(viewer.glb(scene_of(motion)))


def _viewer() -> Any:
    from importlib import import_module

    try:
        return import_module("trundle.viewer")
    except ImportError:
        message = "This copy of trundle has no viewer built into it. `pip install .` builds it."
        raise refused(422, message, "format", "OutOfDomainError") from None


def _animation(motion: Motion, folder: Path) -> bytes:  # noqa: ARG001
    from .animation import gif

    return gif(motion)


_WRITERS: dict[str, Callable[[Motion, Path], bytes]] = {
    "csv": csv,
    "nc": _saved,
    "png": _figure("png"),
    "svg": _figure("svg"),
    "html": _page,
    "glb": _model,
    "gif": _animation,
}


@answering
def opened(content: bytes, folder: str) -> Answer:
    """Return the scenario in a file that a visitor dropped on the page.

    Parameters
    ----------
    content : bytes
        A scenario as TOML, or a run.nc; which, its first bytes tell.
    folder : str
        An empty folder.

    Returns
    -------
    Answer
        `scenario` and `toml`, as JSON.

    Examples
    --------
    >>> opened(files.read("tilted-turntable").encode(), "").media_type
    'application/json'
    """
    import json

    text = _text_in(content, Path(folder)) if content.startswith((b"\x89HDF", b"CDF")) else _decoded(content)
    tables = files.parse(text, "the file")
    scenario = path_from(tables) if files.rolls_along_path(tables) else scenario_from(tables)
    return Answer(json.dumps(told(scenario)).encode("ascii"), "application/json")


def _decoded(content: bytes) -> str:
    if len(content) > files.LARGEST:
        raise refused(422, "A scenario is a text of at most 1 MiB; this is longer. Is it a scenario file?", "scenario")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        message = "This is neither a scenario (text in UTF-8) nor a run.nc that trundle saved."
        raise refused(422, message, "scenario") from None


def _text_in(content: bytes, folder: Path) -> str:
    """Return the scenario in a NetCDF file; it is read from a name of our own, never from one that came."""
    import xarray

    target = folder / "upload.nc"
    target.write_bytes(content)
    try:
        with xarray.open_dataset(target, engine="h5netcdf") as data:
            text = data.attrs.get("scenario")
    except Exception:  # noqa: BLE001  whatever a damaged file makes HDF5 raise
        text = None
    if not isinstance(text, str) or not text:
        raise refused(422, "This is no run.nc that trundle saved, or it is damaged: it holds no scenario.", "scenario")
    return text
