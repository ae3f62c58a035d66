"""DeepLabCut: parts of bodies by frames, in pixels, each with how sure the network is of it."""

from __future__ import annotations

import io
import pickle
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ..file import File, opened
from ..grid import Grid
from ..options import Options
from ..rows import Cells, row_numbers
from ..table import Column, Rejected, Table
from ..track import Array
from .base import Format, GridFormat, table_of

_LEVELS = ("scorer", "individuals", "bodyparts", "coords")


class DeepLabCut(GridFormat):
    """Three lines of headings, or four where there are several animals: scorer, bodyparts, coords."""

    name = "DeepLabCut's CSV"
    origin = "DeepLabCut: analyze_videos with save_as_csv=True"

    def fits(self, grid: Grid) -> bool:
        """Tell by the words that the lines begin with."""
        return [cells[0].lower() for _, cells in grid.head if cells][-2:] == ["bodyparts", "coords"]

    def tracks(self, grid: Grid, options: Options) -> Sequence[Table]:
        """Return a track for each part."""
        width = len(grid.names)
        levels = [
            [*cells, *[""] * width][1:width] for _, cells in grid.head if cells and cells[0].lower() in _LEVELS[1:]
        ]
        labels = list(zip(*levels, strict=True))
        table = table_of(grid, grid.names)
        return parts(table, table.columns[0].cells, labels, [column.cells for column in table.columns[1:]], options)


class DeepLabCutHDF5(Format):
    """The same as pandas keeps it in HDF5."""

    name = "DeepLabCut's HDF5"
    origin = "DeepLabCut: analyze_videos"
    endings = (".h5", ".hdf5", ".hdf")

    def recognises(self, file: File) -> bool:
        """Tell by the table that pandas writes."""
        with opened(file) as root:
            return _table(root) is not None

    def read(self, file: File, options: Options) -> Sequence[Table]:
        """Return a track for each part."""
        with opened(file) as root:
            table = _table(root)
            labels = _labels(table.attrs.get("values_block_0_kind"))
            values = np.asarray(table["values_block_0"], dtype=float)
            frames = np.asarray(table["index"], dtype=float)
        if values.ndim != 2 or len(labels) != values.shape[1]:
            rule = "must have a name for each column"
            received = f"{len(labels)} for columns of the shape {values.shape[1:]}"
            raise InvalidValueError("file", rule, received, "Export it as CSV: analyze_videos with save_as_csv=True.")
        return parts(Table([]), frames, [label[1:] for label in labels], list(values.T), options)


def _table(root: Any) -> Any:
    """Return the table that pandas writes to HDF5; None where there is none."""
    tables = (group["table"] for group in root.values() if "table" in getattr(group, "keys", dict)())
    return next((table for table in tables if {"index", "values_block_0"} <= set(table.dtype.names or ())), None)


class _Words(pickle.Unpickler):
    """Reads lists, tuples and words, which is how pandas keeps the names of columns, and nothing that could act."""

    def find_class(self, module: str, name: str) -> Any:
        rule = "must keep the names of its columns as words"
        raise InvalidValueError("file", rule, f"{module}.{name}", "Export it as CSV: save_as_csv=True.")

    def persistent_load(self, pid: Any) -> Any:
        return self.find_class("persistent", str(pid))


def _labels(kept: Any) -> list[tuple[str, ...]]:
    """Return the names of the columns, each with one word a level."""
    content = kept.tobytes() if isinstance(kept, np.generic) else kept if isinstance(kept, bytes) else b""
    try:
        found = _Words(io.BytesIO(content)).load()
        labels = [tuple(map(str, label)) for label in found]
    except InvalidValueError:
        raise
    except Exception:  # noqa: BLE001  a damaged pickle raises a dozen kinds
        labels = []
    if not labels or any(len(label) not in (3, 4) for label in labels):
        rule = "must name scorer, bodypart and coordinate of each column"
        raise InvalidValueError("file", rule, "none that can be read", "Export it as CSV: save_as_csv=True.")
    return labels


def parts(
    table: Table, frames: Array, labels: Sequence[Sequence[str]], values: Sequence[Any], options: Options
) -> list[Table]:
    """Return a track for each part that has a place; where the network was not sure, there is none."""
    by_part: dict[str, dict[str, Any]] = {}
    for label, cells in zip(labels, values, strict=True):
        by_part.setdefault("/".join(filter(None, label[:-1])), {})[label[-1].lower()] = cells
    found = ((name, cells) for name, cells in by_part.items() if {"x", "y"} <= cells.keys())
    return [_part(replace(table, name=name, y_down=True), frames, cells, options) for name, cells in found]


def _part(table: Table, frames: Array, cells: dict[str, Any], options: Options) -> Table:
    """Return the track of a part, without the places of which the network was not sure."""
    sure = Cells(Column("likelihood", cells.get("likelihood", np.ones(len(frames))))).numbers
    doubtful = np.flatnonzero(~(sure >= options.likelihood))
    rows = row_numbers(table, len(frames))
    rejected = [Rejected(int(rows[i]), f"likelihood {sure[i]:.2g}") for i in doubtful]
    columns = [Column("frame", frames, "frame", "frame")]
    for axis in "xy":
        places = np.array(cells[axis])
        places[doubtful] = np.nan
        columns.append(Column(axis, places, "px", axis))
    return replace(table, columns=columns, rejected=(*table.rejected, *rejected))
