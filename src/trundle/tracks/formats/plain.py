"""A table with headings: CSV and its relatives, or a sheet of a spreadsheet."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from ...errors import InvalidValueError
from ..grid import Grid
from ..options import Options
from ..table import Table
from .base import GridFormat, headed, table_of

_ACCURACY = re.compile(r"#\s*accuracy:\s*([\d.eE+-]+)\s*m\b")  # as `FilmTrack.save` writes it


class PlainTable(GridFormat):
    """A table with a line of headings, and perhaps a line of units below it."""

    name = "a table with headings"
    origin = "any program, spreadsheet or `numpy.savetxt`"

    def fits(self, grid: Grid) -> bool:  # noqa: ARG002
        """Any table is one."""
        return True

    def tracks(self, grid: Grid, options: Options) -> Sequence[Table]:
        """Return the one track."""
        if not grid.rows and not grid.head:
            raise InvalidValueError("file", "must hold rows of numbers", "none", "It is empty.")
        if not grid.rows and len(grid.head) < 2:
            rule = "must hold rows of numbers below its headings"
            raise InvalidValueError("file", rule, f"headings in line {grid.head[0][0]}, and nothing else")
        names, units, rejected = headed(grid) if grid.head else (self._noted(grid), [], ())
        if not names:
            names = [str(i + 1) for i in range(grid.width)]
            if not options.columns:
                rule = "must begin with a line of headings"
                remedy = "Add one, such as t,x,y,z, or name the columns by number: --columns 't=1, x=2, y=3'."
                raise InvalidValueError("file", rule, f"numbers in {grid.counted} {grid.lines[0]}", remedy)
        names = [name or f"column {i + 1}" for i, name in enumerate(names)]
        table = table_of(grid, names, units)
        return [replace(table, rejected=(*rejected, *table.rejected), accuracy=_accuracy(grid.notes))]

    def _noted(self, grid: Grid) -> list[str]:
        """Return the headings from the last remark that has a word for each column (as numpy.savetxt writes it)."""
        for line in reversed(grid.notes):
            for sign in (grid.separator or r"\s+", r"[,;\s]+"):
                words = [word.strip() for word in re.split(sign, line.lstrip("# \t").strip())]
                if len(words) == grid.width:
                    return words
        return []


def _accuracy(notes: Sequence[str]) -> float:
    """Return by how much places may be off, as a remark says it, m.

    Examples
    --------
    >>> _accuracy(["# film.mp4", "# accuracy: 0.00013 m, a tenth of a pixel"])
    0.00013
    """
    found = next(filter(None, map(_ACCURACY.match, notes)), None)
    try:
        number = float(found.group(1)) if found else 0.0
    except ValueError:
        return 0.0
    return number if 0 < number < float("inf") else 0.0
