"""Tracker's data export, and its table copied to the clipboard."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from ..grid import Grid
from ..names import apart
from ..options import Options
from ..table import NOT_USED, Column, Table
from .base import GridFormat, table_of

# What Tracker calls its columns; px and py are momenta, and θ turns counterclockwise.
_COLUMNS = {"t": "t", "x": "x", "y": "y", "vx": "vx", "vy": "vy", "θ": "angle", "frame": "frame"}
_OTHERS = "r, θr, v, θv, ax, ay, a, θa, ω, α, step, px, py, p, θp, pixelx, pixely, K, L, I, mass"
_FIRST = ("t", "frame", "step")


class TrackerExport(GridFormat):
    """A line with the names of the tracks, and below it a line with those of the columns."""

    name = "Tracker's data export or copied table"
    origin = "Tracker: File > Export > Data File, or the table's Copy Data"

    def fits(self, grid: Grid) -> bool:
        """Tell by the two lines above the numbers."""
        if len(grid.head) < 2:
            return False
        names = [_bare(cell) for cell in grid.names]
        written = [name for name in names if name]
        above = [cell for cell in grid.head[-2][1] if cell]
        known = {*_COLUMNS, *_OTHERS.split(", ")}
        return len(written) > 1 and names[0] in _FIRST and known >= set(written) and 0 < len(above) < len(written)

    def tracks(self, grid: Grid, options: Options) -> Sequence[Table]:  # noqa: ARG002
        """Return a track for each name: its columns lie below it, and the first column is everybody's."""
        table = table_of(grid, grid.names)
        columns = [_known(column) for column in table.columns]
        starts = [(i, name) for i, name in enumerate(grid.head[-2][1]) if name]
        shift = 1 if len(starts) > 1 and starts[0][0] == 0 else 0  # no place was left for the column of times
        edges = [max(i + shift, 1) for i, _ in starts]
        return [
            replace(table, columns=[columns[0], *columns[first:end]], name=name, y_down=False)
            for (_, name), first, end in zip(starts, edges, [*edges[1:], len(columns)], strict=True)
        ]


def _bare(heading: str) -> str:
    """Return the name of a column without its unit and the signs of a subscript."""
    return re.sub(r"[_{}$]", "", apart(heading)[0]).strip()


def _known(column: Column) -> Column:
    unit = apart(column.heading)[1]
    known = _COLUMNS.get(_bare(column.heading), NOT_USED)
    if known == "t" and not unit:
        unit = "s"  # Tracker knows no other
    return replace(column, unit=unit, known=known)
