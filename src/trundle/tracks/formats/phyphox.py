"""Phyphox: the gyroscope of a telephone, along the axes of what it lies in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..grid import Grid
from ..names import apart
from ..options import Options
from ..table import Table
from .base import GridFormat, known_columns, table_of

_COLUMNS = {"time": "t", "gyroscope x": "wx", "gyroscope y": "wy", "gyroscope z": "wz"}


class Phyphox(GridFormat):
    """Columns `Time (s)`, `Gyroscope x (rad/s)`, ..., in a text, a spreadsheet or an archive."""

    name = "Phyphox's gyroscope"
    origin = "Phyphox: Gyroscope, Export Data as CSV or Excel"

    def fits(self, grid: Grid) -> bool:
        """Tell by the names of the columns."""
        return _COLUMNS.keys() <= {apart(name)[0].lower() for name in grid.names}

    def tracks(self, grid: Grid, options: Options) -> Sequence[Table]:  # noqa: ARG002
        """Return Ω along the axes of the body."""
        table = table_of(grid, grid.names)
        return [replace(table, columns=known_columns(table.columns, _COLUMNS), axes="body")]
