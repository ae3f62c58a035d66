"""What became of the circle, measured from a path alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...simulation.trajectory import Trajectory

MOST_ROUNDS = 3  # in each of the two windows, at the beginning and at the end


@dataclass(frozen=True)
class CircleMotion:
    """How a circle moved on the whole.

    Examples
    --------
    See `Sensitivity`.
    """

    centre_rate: float  # speed of its centre from the beginning to the end, m/s
    radius_rate: float  # growth of its radius, m/s; negative where it shrinks

    @property
    def size(self) -> float:
        """Both together, m/s: how much the circle changes."""
        return self.centre_rate + abs(self.radius_rate)


def measure(run: Trajectory, kappa: float, rate: float) -> CircleMotion | None:
    """Measure how the circle of a run moved, from circles fitted to its beginning and to its end.

    Examples
    --------
    >>> import numpy as np
    >>> import trundle as tr
    >>> run = tr.Scenario.load("level-turntable-nudged").run()
    >>> found = measure(run, 2 / 7 * run.system.support.motion.rate, run.system.support.motion.rate)
    >>> found.size < 1e-15
    True
    """
    samples = run.in_frame("support").data
    t = samples.time.values[: -1 if run.events else None]
    path = samples.position.values[: t.size, 0] + 1j * samples.position.values[: t.size, 1]
    rounds = min(MOST_ROUNDS, math.floor((t[-1] - t[0]) * abs(kappa) / (4 * math.pi) + 1e-9))
    if rounds < 1:
        return None
    count = round(rounds * 2 * math.pi / abs(kappa) / float(t[1] - t[0])) + 1
    (first, begin), (last, end) = (
        _fit(t[part], path[part], kappa, rate) for part in (slice(count), slice(-count, None))
    )
    elapsed = float(t[-count:].mean() - t[:count].mean())
    return CircleMotion(abs(last - first) / elapsed, (end - begin) / elapsed)


def _fit(t: NDArray[np.float64], path: NDArray[np.complex128], kappa: float, rate: float) -> tuple[complex, float]:
    """Return centre and radius in the middle of a stretch: a circle that drifts, and what the table's turn adds."""
    s = t - t.mean()
    parts = [np.ones_like(s), s / s[-1], np.exp(1j * kappa * s), np.exp(1j * rate * s)]
    fit = np.linalg.lstsq(np.stack(parts, axis=1).astype(complex), path, rcond=None)[0]
    return complex(fit[0]), abs(complex(fit[2]))
