"""Seconds for trundle and for each engine at equal error, where the engine can reach it.

An engine's error and cost are measured at three steps, by `trundle score`. Between two steps both go as powers of the
step, so that the cost at an error between them is read off the line through them. trundle's own cost is that of its
answer as shipped, which does not depend on the step: its error is a rounding, and nothing coarser would be cheaper.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

import trundle as tr
from measure import Row
from trundle.conformance.results import Cell

TITLE = "Engines: processor time for a second of the motion over trundle's, at an error of 1e-3"
ENGINES = ("mujoco", "pybullet", "dart", "drake", "rapier", "ode")
CASES = ("incline", "billiard-draw", "billiard-swerve", "hinged-turntable", "dome")
ERROR = 1e-3
REPEAT = 3


def rows() -> Iterator[Row]:
    """Yield a row for each case and engine; those that do not come so near say how near they come."""
    conformance = tr.conformance
    cases = [case for case in conformance.cases() if case.name in CASES]
    entrants = [conformance.Entrant.of_engine(name) for name in ("trundle", *ENGINES)]
    cells = conformance.score(entrants, cases, repeat=REPEAT).profiles
    for case in cases:
        (ours,) = (
            cell for cell in cells if (cell.engine, cell.setting, cell.case) == ("trundle", "as shipped", case.name)
        )
        own = ours.rows[0]
        for cell in cells:
            if cell.case == case.name and cell.engine != "trundle":
                yield _row(cell, own.seconds)


def _row(cell: Cell, ours: float) -> Row:
    what = f"{cell.case}, {cell.engine} {cell.setting}"
    ran = [(row.worst, row.seconds) for row in cell.rows if row.outcome == "ok" and np.isfinite(row.worst)]
    if not ran:
        return Row(f"{what}: {cell.rows[0].message[:40]}", np.nan)
    theirs = seconds_at(ERROR, *zip(*ran, strict=True))
    if theirs is None:
        nearest = min(error for error, _ in ran)
        return Row(f"{what}: {ERROR:g} not reached, error", nearest, kind="error")
    return Row(what, theirs / ours, raw=f"{theirs:.2g} s, trundle {ours:.2g} s")


def seconds_at(error: float, errors: Sequence[float], seconds: Sequence[float]) -> float | None:
    """Return the cost at an error, by powers between two steps, or of the coarsest step that is better; else None."""
    if errors[0] <= error:
        return seconds[0]
    for i in range(1, len(errors)):
        if errors[i] <= error < errors[i - 1]:
            share = np.log(errors[i - 1] / error) / np.log(errors[i - 1] / errors[i])
            return float(np.exp((1 - share) * np.log(seconds[i - 1]) + share * np.log(seconds[i])))
    return None
