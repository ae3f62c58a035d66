"""A million seconds of a ball in a spinning elliptic bowl: what is conserved, and what ought to be zero or one.

The bowl has semi-axes of 5, 4 and 3 m and turns at 0.47 rad/s. The conserved moving energy is worked out here with
80-bit numbers from the contact point and Ω alone, the bowl's angle as the product of rate and time to 64 bits.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bodies import bowl
from by_hand import G
from measure import Row, check, seconds, timed
from trundle.solve import taylor
from trundle.solve.laws import RollingLaw
from trundle.solve.taylor import TOLERANCE
from trundle.solve.transitions import PhaseStart

TITLE = "Ball in a spinning elliptic bowl, 10^6 s by Taylor's method, looked at each 10 s"

DURATION, LOOKS, SIZE = 1e6, 100_001, 10.0

Array = NDArray[Any]


def rows() -> Iterator[Row]:
    """Run once."""
    case = bowl(DURATION, SIZE)
    times, begin = np.linspace(0.0, DURATION, LOOKS), PhaseStart(RollingLaw(), case.start, case.state.tolist())
    took, pieces = timed(lambda: list(taylor.integrate(case.system, begin, times, TOLERANCE)))
    check(pieces[-1].stop is None, "the ball must stay in the bowl")
    states = np.concatenate([piece.states for piece in pieces])
    level, energy = _looked_at(case.system, times, states)
    length = np.linalg.norm(states[:, 3:7], axis=1)
    drift = float(np.abs(energy / energy[0] - 1).max())
    yield Row("moving energy: largest relative drift", drift, most=1e-11, raw=f"in {seconds(took)}", kind="error")
    yield Row("largest |phi(p)|, m", float(np.abs(level).max()), most=1e-13, kind="error")
    yield Row("largest ||q| - 1|", float(np.abs(length - 1).max()), most=1e-13, kind="error")


def _looked_at(system: Any, times: Array, states: Array) -> tuple[Array, Array]:
    """Return φ(p) and E − ω·L."""
    wide = np.longdouble
    check(bool(np.finfo(wide).eps < 2e-19), "this needs 80-bit long doubles")
    A, B, C = (wide(axis) for axis in system.support.surface.semi_axes)
    K, L, M = C / (A * A), C / (B * B), 1 / C
    a, m, rate = wide(system.body.shape.radius), wide(system.body.mass), wide(system.support.motion.rate)
    inertia = wide(system.body.inertia.ratio) * m * a * a
    angle = rate * times.astype(wide)
    c, s = np.cos(angle), np.sin(angle)

    def seen_from_the_bowl(v: Array) -> Array:
        x, y, z = v.astype(wide).T
        return np.stack([c * x + s * y, c * y - s * x, z], axis=1)

    p, turning = seen_from_the_bowl(states[:, :3]), seen_from_the_bowl(states[:, 7:10])
    turning[:, 2] -= rate
    slope = np.stack([-K * p[:, 0], -L * p[:, 1], 1 - M * p[:, 2]], axis=1)
    level = p[:, 2] - (K * p[:, 0] ** 2 + L * p[:, 1] ** 2 + M * p[:, 2] ** 2) / 2
    n = slope / np.sqrt((slope**2).sum(axis=1))[:, None]
    v, centre = a * np.cross(turning, n), p + a * n
    moving = m * (v**2).sum(axis=1) + inertia * (turning**2).sum(axis=1)
    around = m * rate * rate * (centre[:, :2] ** 2).sum(axis=1)
    return level, (moving - around) / 2 + m * wide(G) * centre[:, 2]
