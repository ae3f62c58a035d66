"""A scenario, or its run, as a file to keep: text, table, NetCDF, figure, page, model or animation."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..errors import RunFileError
from ..scenario import files
from ..views.viewer.exports import FORMATS
from . import limits
from .answers import answering, path_from, run_of, scenario_from, told
from .cache import Answer
from .errors import refused


@answering
def export(data: dict[str, Any], kind: str, folder: str) -> Answer:
    """Make a file of a scenario.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     made = export(files.tables_of("tilted-turntable"), "csv", folder)
    >>> made.filename, made.body[:40]
    ('steel-ball-on-a-tilted-turntable.csv', b'time [s],position_x [m],position_y [m],p')
    """
    along_path = files.rolls_along_path(data)
    scenario: Any = path_from(data) if along_path else scenario_from(data)
    name, media_type = f"{slug(scenario.title)}.{kind}", FORMATS[f".{kind}"].media_type
    if kind == "toml":
        return Answer(scenario.to_toml().encode(), media_type, name)
    with _temporary_files_in(folder):
        return Answer(_written(scenario, kind), media_type, name)


def _written(scenario: Any, kind: str) -> bytes:
    from ..views.viewer.exports import export as write

    if not hasattr(scenario, "timing"):
        from ..analysis.geometry.scene import rolled_scene

        return write(scenario.run(), f".{kind}", rolled_scene)
    run, _ = run_of(scenario, limits.MOST_SAVED)
    return write(run, f".{kind}")


@contextmanager
def _temporary_files_in(folder: str) -> Iterator[None]:
    """Let temporary files be made in a folder that the server removes, also where this process is ended."""
    before, tempfile.tempdir = tempfile.tempdir, folder
    try:
        yield
    finally:
        tempfile.tempdir = before


def slug(title: str) -> str:
    """Return a title as the stem of a file's name: small letters, digits and dashes.

    Examples
    --------
    >>> slug("Steel ball, 25 mm (½ turn)"), slug("../../…")
    ('steel-ball-25-mm-turn', 'trundle')
    """
    return re.sub(r"[^a-z0-9]+", "-", title.lower()[:80]).strip("-") or "trundle"


@answering
def opened(content: bytes, folder: str) -> Answer:
    """Return the scenario in a file that a visitor dropped on the page.

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
    from ..simulation.run_file import scenario_in

    target = folder / "upload.nc"
    target.write_bytes(content)
    try:
        text = scenario_in(target)
    except RunFileError:
        text = ""
    if not text:
        raise refused(422, "This is no run.nc that trundle saved, or it is damaged: it holds no scenario.", "scenario")
    return text
