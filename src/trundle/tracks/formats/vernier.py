"""Vernier Video Analysis: a CSV with times, places and velocities, each with its unit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..grid import Grid
from ..names import apart
from ..options import Options
from ..table import Table
from .base import GridFormat, known_columns, table_of

_COLUMNS = {"time": "t", "x": "x", "y": "y", "x velocity": "vx", "y velocity": "vy"}


class VernierVideoAnalysis(GridFormat):
    """Headings such as `Time (s)`, `X (m)`, `X Velocity (m/s)`."""

    name = "Vernier Video Analysis's export"
    origin = "Vernier Video Analysis: File > Export > CSV"

    def fits(self, grid: Grid) -> bool:
        """Tell by time, place and velocity under these names."""
        return len(grid.head) == 1 and _COLUMNS.keys() <= {apart(name)[0].lower() for name in grid.names}

    def tracks(self, grid: Grid, options: Options) -> Sequence[Table]:  # noqa: ARG002
        """Return the one track."""
        table = table_of(grid, grid.names)
        return [replace(table, columns=known_columns(table.columns, _COLUMNS), y_down=False)]
