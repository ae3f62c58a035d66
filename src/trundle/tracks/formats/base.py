"""What every format says of itself: its name, where such files come from, how it is known and how it is read."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import ClassVar

from ...errors import InvalidValueError
from ..file import File
from ..grid import Grid, is_missing, is_number, numeric_share
from ..names import apart, is_unit
from ..options import Options
from ..table import NOT_USED, Column, Rejected, Table

TEXTS = (".csv", ".txt", ".tsv", ".dat")


class Format(ABC):
    """One kind of file.

    A new one is a class in a file of its own, named in `formats/__init__.py`, the narrower before the wider.
    """

    name: ClassVar[str]
    """What it is called in messages and in the documents."""
    origin: ClassVar[str]
    """How one gets such a file, in a few words."""
    endings: ClassVar[tuple[str, ...]]
    """Of names of such files, in small letters."""

    @abstractmethod
    def recognises(self, file: File) -> bool:
        """Tell whether a file is of this kind, by what is in it; its ending is one of these."""

    @abstractmethod
    def read(self, file: File, options: Options) -> Sequence[Table]:
        """Return the tracks of a file that is of this kind."""


class GridFormat(Format):
    """A kind of table: in a text, in a sheet of a spreadsheet, or in a text within an archive."""

    endings = (*TEXTS, ".xlsx", ".xlsm", ".zip")

    @abstractmethod
    def fits(self, grid: Grid) -> bool:
        """Tell whether a table is of this kind."""

    @abstractmethod
    def tracks(self, grid: Grid, options: Options) -> Sequence[Table]:
        """Return the tracks of a table that is of this kind."""

    def recognises(self, file: File) -> bool:
        """Tell whether one of the file's tables is of this kind."""
        return any(self.fits(grid) for grid in file.grids.values())

    def read(self, file: File, options: Options) -> Sequence[Table]:
        """Return the tracks of all the tables that are of this kind, with the table's name where there are several."""
        fitting = {name: grid for name, grid in file.grids.items() if self.fits(grid)}
        found = [(name, table) for name, grid in fitting.items() for table in self.tracks(grid, options)]
        if len(fitting) == 1:
            return [table for _, table in found]
        return [replace(table, name=f"{name}/{table.name}" if table.name else name) for name, table in found]


def units_row(cells: Sequence[str]) -> bool:
    """Tell whether a line holds nothing but units, one at least."""
    written = [cell.strip("()[] ") for cell in cells if cell.strip()]
    return bool(written) and all(map(is_unit, written))


def headed(grid: Grid) -> tuple[list[str], list[str], tuple[Rejected, ...]]:
    """Return the headings of a table, the units below them, and the rows between them and the first whole one."""
    head = list(grid.head)
    names_at = next((i for i in reversed(range(len(head))) if not units_row(head[i][1]) and not _row(head[i][1])), 0)
    names = [cell.strip() for cell in head[names_at][1]]
    units: list[str] = [""] * len(names)
    rejected = []
    for line, cells in head[names_at + 1 :]:
        if units_row(cells):
            units = [*(cell.strip("()[] ") for cell in cells), *units][: len(names)]
            continue
        bad = next((cell for cell in cells if not (is_number(cell) or is_missing(cell))), "")
        remedy = "Write a number, or leave the cell empty."
        error = InvalidValueError("file", "must hold numbers", f"{bad!r} in {grid.counted} {line}", remedy)
        rejected.append(Rejected(line, f"{bad!r} is no number", error))
    while names and not names[-1]:
        names.pop()
    return names, units[: len(names)], tuple(rejected)


def _row(cells: Sequence[str]) -> bool:
    """Tell whether a line above the first whole row of numbers is one of numbers, too, but for some of its cells."""
    return numeric_share(cells) > 0.0


def table_of(grid: Grid, names: Sequence[str], units: Sequence[str] = ()) -> Table:
    """Return the columns of a table under these headings, and what there is to say of its rows."""
    cells, lines, rejected = grid.cells(len(names))
    units = [*units, *[""] * (len(names) - len(units))]
    columns = [Column(name, values, unit) for name, values, unit in zip(names, cells, units, strict=True)]
    return Table(columns, rows=lines, counted=grid.counted, remarks=grid.remarks, rejected=rejected)


def known_columns(columns: Sequence[Column], known: Mapping[str, str]) -> list[Column]:
    """Return columns under trundle's names by what stands before their units; all others are not used."""
    found = []
    for column in columns:
        name, unit = apart(column.heading)
        found.append(replace(column, unit=unit, known=known.get(name.lower(), NOT_USED)))
    return found
