"""Which rows of a table are taken, and why the others are not."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from ..errors import InvalidValueError
from .grid import is_missing
from .table import Column, Rejected, Table
from .track import Array, Index

_FEW, _SHARE = 3, 0.1  # rows that may be wrong: so many, or this share of them
_REMEDY = "Write a number, or leave the cell empty: the row is then left out."


class Cells:
    """The cells of a column as numbers, and those that are none.

    Examples
    --------
    >>> cells = Cells(Column("x", np.array(["1.5", "", "oops"], dtype=object)))
    >>> cells.numbers.tolist(), list(cells.wrong())
    ([1.5, nan, nan], [(2, "'oops'", 'must hold numbers')])
    """

    def __init__(self, column: Column) -> None:
        self.heading = column.heading
        cells = column.cells
        self._words: dict[int, str] = {}
        if getattr(cells, "dtype", None) != np.dtype(object):
            self.numbers = np.asarray(cells, dtype=float)
            return
        self.numbers = np.full(len(cells), np.nan)
        for i, cell in enumerate(cells):
            if cell is None or (isinstance(cell, str) and is_missing(cell)):
                continue
            try:
                self.numbers[i] = float(cell)
            except (TypeError, ValueError):
                self._words[i] = repr(str(cell)[:60])

    def wrong(self) -> Iterator[tuple[int, str, str]]:
        """Yield the rows in which there is something else than a number, what it is, and the rule."""
        for i, word in self._words.items():
            yield i, word, "must hold numbers"
        for place in np.flatnonzero(np.isinf(self.numbers)):
            yield int(place), str(self.numbers[place]), "must be finite numbers"


def row_numbers(table: Table, size: int) -> Index:
    """Return the number of each row in its file."""
    rows = np.asarray(table.rows, dtype=int)
    return rows if rows.size else np.arange(1, size + 1)


def taken_rows(table: Table, time: Array, cells: Mapping[str, Cells]) -> tuple[Index, tuple[Rejected, ...]]:
    """Return the rows that are taken, and the others with the reason; refuse where too many are wrong."""
    rows, counted = row_numbers(table, time.size), table.counted
    rejected = list(table.rejected)
    good = np.ones(time.size, dtype=bool)
    for column in cells.values():
        for i, shown, rule in column.wrong():
            if good[i]:
                error = InvalidValueError(column.heading, rule, f"{shown} in {counted} {rows[i]}", _REMEDY)
                rejected.append(Rejected(int(rows[i]), f"`{column.heading}` {rule}: {shown}", error))
                good[i] = False
    timeless = np.flatnonzero(good & np.isnan(time))
    rejected += [Rejected(int(row), "no time") for row in rows[timeless]]
    good[timeless] = False
    size = time.size + len(table.rejected)
    _check_few(rejected, size)
    again = list(_repeated(time, np.flatnonzero(good), rows, counted))
    _check_few([one for _, one in again], size)
    good[[i for i, _ in again]] = False
    rejected += [one for _, one in again]
    if not good.any():
        raise InvalidValueError("file", "must hold rows of numbers", "none", "Is there another track in it?")
    return np.flatnonzero(good), tuple(sorted(rejected, key=lambda one: one.row))


def _check_few(rejected: list[Rejected], size: int) -> None:
    """Refuse a table of which too much is wrong, by the first of it."""
    errors = [one.error for one in rejected if one.error is not None]
    if errors and (len(errors) > max(_FEW, _SHARE * size) or 2 * len(errors) >= size):
        raise errors[0]


def _repeated(time: Array, at: Index, rows: Index, counted: str) -> Iterator[tuple[int, Rejected]]:
    """Yield the rows whose time is that of the row before, and refuse times that go back."""
    steps = np.diff(time[at])
    for i in np.flatnonzero(steps <= 0):
        before, row = rows[at[i]], rows[at[i + 1]]
        received = f"{time[at[i]]:g} s, then {time[at[i + 1]]:g} s ({counted}s {before} and {row})"
        error = InvalidValueError("time", "must ascend", received, "Sort the rows, or leave one track in the file.")
        if steps[i] < 0:
            raise error
        yield int(at[i + 1]), Rejected(int(row), f"its time is that of {counted} {before}", error)
