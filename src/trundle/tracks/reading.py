"""`read_track`: a file, a table or arrays from outside, read to one track in SI."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..errors import InvalidValueError, UnknownNameError
from .arrays import table_of
from .examples import example_of
from .file import File
from .formats import endings, read_file
from .options import SI, Options
from .settling import AXES, FRAMES, Reading
from .table import Table
from .track import Track

_LARGEST = 2**30  # bytes
_TRACKS = 12  # names of tracks in a message


def read_track(
    source: Any,
    *,
    track: str | None = None,
    columns: Mapping[str, str] | None = None,
    units: str | Mapping[str, str] | None = None,
    rate: float | None = None,
    pixel: str | float | None = None,
    y: str | None = None,
    sense: str | None = None,
    decimal: str | None = None,
    frame: str = "support",
    axes: str = "space",
    quaternion: str = "wxyz",
    likelihood: float | None = None,
) -> Track:
    r"""Read a measured track, say what was taken for what, and ask for what the file does not tell.

    Parameters
    ----------
    source : path, Track, Trajectory, pandas.DataFrame, xarray.Dataset or mapping of arrays
        A file of one of the formats on the page "Read a measured track", an example such as
        ``"example:ball-on-a-ramp"``, or the track in memory. Numbers in memory are in SI unless their names say a unit.
    track : str, optional
        Which one, where a file holds several.
    columns : mapping, optional
        Trundle's name (t, x, y, z, vx, ..., wx, ..., angle, qw, ...) -> the heading, where the name does not tell.
    units : str or mapping, optional
        Of columns that say none: "cm" for lengths, or {"length": "cm", "time": "ms", "angle": "deg"}. Velocities and
        rates are per second of these.
    rate : float, optional
        Frames a second, where the file counts frames; of a film in slow motion the true rate at which it was taken.
    pixel : str or float, optional
        The size of a pixel, such as "0.8 mm", where places are in pixels; a bare number is in m.
    y : str, optional
        "up" or "down": whether y grows upwards, as in graphs, or downwards, as in pictures.
    sense : str, optional
        "clockwise" or "anticlockwise": how the column `angle` is counted, seen from above.
    decimal : str, optional
        "point" or "comma", where "1,234" might be either.
    frame : str
        "support", "world" or "corotating": the frame of the places, unless the file says it.
    axes : str
        "space" or "body": along which Ω has its components, unless the file says it.
    quaternion : str
        Order of numbered parts, "wxyz" or "xyzw".
    likelihood : float, optional
        Points that a network finds with less are left out; 0.6 unless you say otherwise.

    Returns
    -------
    Track
        Its columns in SI, with the sentence `taken`, and the rows and columns that were left out.

    Raises
    ------
    InvalidValueError
        If the file cannot be read, or does not tell what has to be known: the message says how to give it.
    UnknownNameError
        If an option has no such value.
    MissingExtraError
        For a format that needs an extra.

    Examples
    --------
    A table as Tracker exports it, with decimal commas; it does not say its unit:

    >>> import trundle as tr
    >>> text = "mass_A;;\nt;x;y\n0,00;10,0;0,0\n0,04;10,2;0,5\n0,08;;\n0,12;10,5;1,6\n"
    >>> _ = Path("track.txt").write_text(text)
    >>> track = tr.read_track("track.txt", units="cm")
    >>> print(track.taken)
    t from column `t`, x, y in cm, 4 rows, 1 gap (1 frame), 25 frames a second, decimal comma
    >>> [round(float(x), 9) for x in track["x"]]
    [0.1, 0.102, nan, 0.105]
    """
    if isinstance(source, Track):
        return source
    given: dict[str, Any] = {} if likelihood is None else {"likelihood": likelihood}
    options = Options.asked(
        track=track,
        columns=dict(columns or {}),
        units=units,
        rate=rate,
        pixel=pixel,
        y=y,
        sense=sense,
        decimal=decimal,
        quaternion=quaternion,
        **given,
    )
    for what, value, allowed in (("frame", frame, FRAMES), ("kind of axes", axes, AXES)):
        if value not in allowed:
            raise UnknownNameError(what, str(value), allowed)
    if not isinstance(source, (str, Path)):
        title, table = table_of(source, options)
        filled = replace(options, units=SI | dict(options.units))
        return Reading(table, filled, title, "", frame, axes, film=False).track({"options": options.as_dict()})
    known = example_of(source)
    path = Path(source) if known is None else known.path
    file = _opened(path, options)
    kind, tables = read_file(file, options)
    provenance = {
        "file": path.name,
        "bytes": len(file.content),
        "sha256": hashlib.sha256(file.content).hexdigest(),
        "format": kind.name,
        "options": options.as_dict(),
    }
    chosen = _chosen(tables, options.track, path.name)
    return Reading(chosen, options, path.name, kind.name, frame, axes, film=True).track(provenance)


def _opened(path: Path, options: Options) -> File:
    """Return a file in memory, if it is one and its ending is known."""
    if path.suffix.lower() not in endings():
        known = endings()
        ends = f"must end in {', '.join(known[:-1])} or {known[-1]}"
        raise InvalidValueError("file", ends, str(path), "Export it as CSV, or give it the ending of what it is.")
    if not path.is_file():
        raise InvalidValueError("file", "must exist", str(path), "Check the name and the folder.")
    try:
        size = path.stat().st_size
        if size > _LARGEST:
            rule = f"must be of {_LARGEST >> 20} MB at most"
            raise InvalidValueError("file", rule, f"{size >> 20} MB", "Leave out what is not needed.")
        return File(path, path.read_bytes(), options.decimal)
    except OSError as error:
        raise InvalidValueError("file", "must be readable", str(path), f"{error.strerror}.") from None


def track_names(path: Path) -> list[str]:
    r"""Return what the tracks of a file are called.

    Examples
    --------
    >>> _ = Path("two.txt").write_text("A;;B;\nt;x;t;x\n0;1;0;2\n1;1;1;2\n")
    >>> track_names(Path("two.txt"))
    ['A', 'B']
    """
    options = Options.asked()
    return _names(read_file(_opened(path, options), options)[1])


def _names(tables: Sequence[Table]) -> list[str]:
    """Return the names of tracks, with their numbers where two are called the same."""
    known = [table.name or str(i + 1) for i, table in enumerate(tables)]
    return [f"{one} ({i + 1})" if known.count(one) > 1 else one for i, one in enumerate(known)]


def _chosen(tables: Sequence[Table], name: str | None, source: str) -> Table:
    """Return the track that was asked for, or the only one."""
    known = _names(tables)
    if name is None and len(tables) == 1:
        return tables[0]
    if not tables:
        remedy = "It has no places and no rates: export these with their times."
        raise InvalidValueError("file", "must hold a track", source, remedy)
    if name is None:
        shown = ", ".join(known[:_TRACKS]) + (f" and {len(known) - _TRACKS} more" if len(known) > _TRACKS else "")
        rule = "must be named where a file holds several"
        raise InvalidValueError("track", rule, shown, f"Say which: track={known[0]!r} (`--track '{known[0]}'`).")
    if name not in known:
        raise UnknownNameError("track of this file", name, known)
    return tables[known.index(name)]
