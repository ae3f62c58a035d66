"""Rows without a number: left out with a word, or refused, by their line and column."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from .slopes import Array

_MOST = 0.5  # of the rows, that may be left out
_TOLD = 6  # lines that are named


def whole_rows(
    table: Mapping[str, Any], needed: Sequence[str], lines: Sequence[int] = ()
) -> tuple[dict[str, Array], tuple[str, ...]]:
    """Return the columns that are needed, without the rows in which one of them has no number.

    Examples
    --------
    >>> columns = {"t": np.arange(4.0), "x": np.array([0.0, np.nan, 2.0, 3.0])}
    >>> kept, remarks = whole_rows(columns, ["t", "x"], [2, 3, 4, 5])
    >>> kept["x"].tolist(), remarks
    ([0.0, 2.0, 3.0], ('1 of 4 rows was left out, for want of a number: line 3 (x).',))
    """
    columns = {name: _numbers(name, table[name], lines) for name in needed}
    sizes = {name: array.size for name, array in columns.items()}
    if len(set(sizes.values())) > 1 or 0 in sizes.values():
        return columns, ()  # refused where their lengths are looked at
    missing = {name: np.isnan(array) for name, array in columns.items()}
    for name, empty in missing.items():
        if empty.mean() > _MOST:
            first = _where(int(np.flatnonzero(empty)[0]), lines)
            received = f"none in {int(empty.sum())} of {empty.size} rows, {first} the first"
            raise InvalidValueError(name, "must hold a number in most rows", received, "Leave the column out.")
    bad = np.any(list(missing.values()), axis=0)
    if not bad.any():
        return columns, ()
    rows = np.flatnonzero(bad)
    told = [f"{_where(int(i), lines)} ({', '.join(n for n, e in missing.items() if e[i])})" for i in rows[:_TOLD]]
    more = f" and {rows.size - _TOLD} more" if rows.size > _TOLD else ""
    verb = "was" if rows.size == 1 else "were"
    says = f"{rows.size} of {bad.size} rows {verb} left out, for want of a number: {', '.join(told)}{more}."
    return {name: array[~bad] for name, array in columns.items()}, (says,)


def _where(row: int, lines: Sequence[int]) -> str:
    return f"line {lines[row]}" if len(lines) > row else f"row {row + 1}"


def _numbers(name: str, array: Any, lines: Sequence[int]) -> Array:
    """Return a column as numbers, or refuse the first cell that is none."""
    if array.dtype == object:
        row, cell = next((i, cell) for i, cell in enumerate(array) if not _is_number(cell))
        remedy = "Write a number, or leave the cell empty: the row is then left out."
        raise InvalidValueError(name, "must hold numbers", f"{str(cell)!r} in {_where(row, lines)}", remedy)
    endless = np.flatnonzero(np.isinf(array))
    if endless.size:
        row = int(endless[0])
        raise InvalidValueError(
            name, "must be finite numbers", f"{array[row]} in {_where(row, lines)}", "Leave it out."
        )
    return np.asarray(array, dtype=float)


def _is_number(cell: Any) -> bool:
    try:
        float(cell)
    except (TypeError, ValueError):
        return False
    return True
