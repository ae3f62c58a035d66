"""A thousand balls on one turntable: in one call, and in a thousand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from measure import Row, best_times, check, seconds
from trundle.solve.exact import SphereOnPlane

TITLE = "A thousand balls at 100 instants each: position, velocity, angular velocity and force"

BALLS, INSTANTS, ROUNDS = 1000, 100, 7


def rows() -> Iterator[Row]:
    """Measure one call against a thousand; for information."""
    x = np.linspace(0.05, 0.45, BALLS)
    t = np.linspace(0.0, 20.0, INSTANTS)
    ball = SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.0, 0.0), (0.0, 0.2), force=(0.03, 0.0, -0.64), drag=0.01)
    together = replace(ball, position=(x[:, None], 0.0))
    alone = [replace(ball, position=(float(place), 0.0)) for place in x]

    best = best_times(
        {
            "one call": lambda: together.motion_at(t),
            "a thousand calls": lambda: [motion.motion_at(t) for motion in alone],
        },
        ROUNDS,
    )
    for whole, *parts in zip(together.motion_at(t), *(motion.motion_at(t) for motion in alone), strict=True):
        stacked = np.stack([np.broadcast_arrays(part.x, part.y, part.z, t)[:3] for part in parts], axis=1)
        all_at_once = np.stack(np.broadcast_arrays(whole.x, whole.y, whole.z, t[None] + 0 * x[:, None])[:3])
        check(np.allclose(stacked, all_at_once, rtol=1e-13, atol=1e-13), "one call must give what a thousand give")
    raw = f"{seconds(best['a thousand calls'])} / {seconds(best['one call'])}"
    yield Row("a thousand calls / one call", best["a thousand calls"] / best["one call"], raw=raw)
