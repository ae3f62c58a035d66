"""PASCO Capstone's CSV: a run behind each heading, or above it in a line of its own."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from ..grid import Grid
from ..options import Options
from ..table import Table
from .base import GridFormat, table_of

_RUN = re.compile(r"(?:(.*?)\s+)?((?:Run|Trial)\s*#?\s*\d+)\s*", re.IGNORECASE)
_QUANTITY = re.compile(r"^(Position|Pos\.?),?\s+(?=[xyz]\b)", re.IGNORECASE)


class Capstone(GridFormat):
    """Headings such as `x (m) Run #1`, in one line or two."""

    name = "Capstone's export"
    origin = "PASCO Capstone: File > Export Data"

    def fits(self, grid: Grid) -> bool:
        """Tell by the runs."""
        return len([run for run, _ in _headings(grid) if run]) > 1

    def tracks(self, grid: Grid, options: Options) -> Sequence[Table]:  # noqa: ARG002
        """Return a track for each run; each has its own times, and may end before the others do."""
        headings = _headings(grid)
        table = table_of(grid, [_QUANTITY.sub("", name) for _, name in headings])
        runs = dict.fromkeys(run for run, _ in headings if run)
        return [
            replace(table, name=run, columns=[table.columns[i] for i, (one, _) in enumerate(headings) if one == run])
            for run in runs
        ]


def _headings(grid: Grid) -> list[tuple[str, str]]:
    """Return the run and the name of each column."""
    names = grid.names
    found = [(match[2], match[1] or "") if (match := _RUN.fullmatch(name)) else ("", name) for name in names]
    if any(name for run, name in found if run) or len(grid.head) < 2:
        return found
    above, run, runs = grid.head[-2][1], "", []
    for i in range(len(names)):
        cell = above[i] if i < len(above) else ""
        match = _RUN.fullmatch(cell)
        run = match[2] if match else "" if cell else run  # named once above several columns, or above each
        runs.append(run)
    return list(zip(runs, names, strict=True))
