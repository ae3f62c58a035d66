"""Findings of Chaplygin's ball, whose centre of mass is its centre, on a level plane."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...solve.exact import ChaplyginBall, UprightChaplyginBall
from .finding import Finding
from .fits import Seen, crossings


def nodding(form: ChaplyginBall | UprightChaplyginBall, seen: Seen) -> Iterator[Finding]:
    """Compare the time after which Ω is as long as before with T15, and how far the ball has got on by then."""
    upright = isinstance(form, UprightChaplyginBall)
    predicted = float(form.round_period if isinstance(form, UprightChaplyginBall) else form.nutation_period)
    square = np.sum(seen.at.angular_velocity**2, axis=1)
    low, high = float(np.min(square)), float(np.max(square))
    if not math.isfinite(predicted) or high - low <= 1e-9 * high:
        return
    times = crossings(seen.time, square - 0.5 * (low + high))
    measured = float((times[-1] - times[0]) / (len(times) - 1)) if len(times) > 1 else None
    note = "from one rise of |Ω| to the next" if measured else "the run shows less than one"
    name = "Time of half a round of the normal in the ball" if upright else "Time of one nutation"
    yield Finding(name, "T", predicted, measured, "s", note)
    if isinstance(form, ChaplyginBall):
        ends = (
            np.array([np.interp(times[[0, -1]], seen.time, part) for part in seen.at.position.T[:2]]).T
            if measured
            else None
        )
        speed = None if ends is None else float(np.linalg.norm(ends[1] - ends[0]) / (times[-1] - times[0]))
        drift = math.hypot(float(form.drift.x), float(form.drift.y))
        fastest = float(np.max(np.linalg.norm(seen.at.velocity, axis=1)))
        yield Finding("Speed from one nutation to the next", r"\bar v", drift, speed, "m/s", "", max(drift, fastest))
