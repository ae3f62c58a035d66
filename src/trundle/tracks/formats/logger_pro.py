"""Logger Pro's CSV: each heading begins with the name of its data set."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from ..grid import Grid
from ..names import apart
from ..options import Options
from ..table import NOT_USED, Column, Table
from .base import GridFormat, table_of

_HEADING = re.compile(r"\s*([^:]+?)\s*:\s*(\S.*)")
_COUNTED = re.compile(r"(.*\S)\s+(\d+)")  # "X 2": of the second object
_COLUMNS = {"time": "t", "x": "x", "y": "y", "x velocity": "vx", "y velocity": "vy"}


class LoggerPro(GridFormat):
    """Columns such as `Video Analysis: X (m)`, or `Latest: Time (s)` of a sensor."""

    name = "Logger Pro's export"
    origin = "Logger Pro: File > Export As > CSV or Text"

    def fits(self, grid: Grid) -> bool:
        """Tell by the colon in most headings."""
        headings = [name for name in grid.names if name]
        return len(headings) > 1 and sum(bool(_HEADING.fullmatch(name)) for name in headings) * 2 > len(headings)

    def tracks(self, grid: Grid, options: Options) -> Sequence[Table]:  # noqa: ARG002
        """Return a track for each object that was followed, in each data set."""
        table = table_of(grid, grid.names)
        sets: dict[str, dict[str, list[Column]]] = {}
        for column in table.columns:
            match = _HEADING.fullmatch(column.heading)
            if match:
                name, unit = apart(match[2])
                counted = _COUNTED.fullmatch(name)
                known = _COLUMNS.get((counted[1] if counted else name).lower(), NOT_USED)
                number = counted[2] if counted and known != NOT_USED else ""
                told = replace(column, unit=unit, known=known)
                sets.setdefault(match[1], {}).setdefault(number, []).append(told)
        return [
            replace(table, name=f"{name} {number}".strip(), columns=columns, y_down=False)
            for name, objects in sets.items()
            for number, columns in _with_time(objects).items()
        ]


def _with_time(objects: dict[str, list[Column]]) -> dict[str, list[Column]]:
    """Return the columns of each object that has any, with the time of the data set where it has none of its own."""
    shared = [column for column in objects.get("", []) if column.known == "t"]
    found = {}
    for number, columns in objects.items():
        own = columns if any(column.known == "t" for column in columns) else [*shared, *columns]
        if any(column.known not in ("t", NOT_USED) for column in own):
            found[number] = own
    return found
