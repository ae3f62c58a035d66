"""A ball from rest on a table that speeds off evenly, with hardly too little friction: its slip grows with the time.

In a plane: a = μg is all that friction gives, and the surface gains a/k on the centre, so that the slip is
s = [(1 + 1/k) μg − A] t for ever, and turns in no way; only how fast its direction would settle falls, as 1/t.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.methods import tolerance_of

G, A = 9.80665, 0.024
K = 2 / 5


# Along an axis and between two, by either method; the least slip takes by far the most steps.
CASES = [
    *((1e-6, 0.0, "taylor"), (1e-6, 2.5, "runge-kutta")),
    *itertools.product((1e-3, 6e-3, 0.05), (0.0, 2.5), ("taylor", "runge-kutta")),
]


@pytest.mark.parametrize(("short", "angle", "method"), CASES)
def test_slip_that_keeps_its_direction(short: float, angle: float, method: str) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    table = 26.0
    friction = table / G * K / (1 + K) * (1 - short)
    way = np.array([np.cos(angle), np.sin(angle), 0.0])
    move = tr.Move(tuple(f"{float(0.5 * table * part)!r}*t**2" for part in way))
    system = tr.RollingSystem(
        tr.Body.solid_sphere(A, 1.9), tr.Support(tr.Plane(), motion=move, friction=friction), gravity=G
    )
    span = 3.0 if short > 1e-4 else 1.0
    ours = tr.simulate(system, system.place(), span, 0.05, method=method)
    assert (ours.data.phase.values == 1).all()
    t = ours.data.time.values
    s = ((1 + 1 / K) * friction * G - table) * t[:, None] * way
    error = EXACT(64, table * span) + SOLVER(1000, tolerance_of(method), table * span)
    np.testing.assert_allclose(ours.data.slip_velocity.values, s, rtol=0, atol=error)
    np.testing.assert_allclose(ours.data.velocity.values, friction * G * t[:, None] * way, rtol=0, atol=error)
    assert ours.card().passed, ours.card().failures
