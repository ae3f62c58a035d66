"""Slip that only just begins: a ball that swings in a trough with hardly too little friction, worked out in a plane.

The reference knows one angle, one speed of the ball's surface and Coulomb's rule. Static friction holds as much more
than it says as docs/phases.md allows.
"""

from __future__ import annotations

import math
from typing import Any

import mpmath
import pytest
from scipy.integrate import solve_ivp
from tests.tolerances import SOLVER

import trundle as tr
from trundle.solve import runge_kutta

G, A, B, K = 9.81, 0.02, 0.3, 0.4  # gravity, radii of ball and trough, inertia ratio
ARM = B - A
TURNING = 0.6  # rad, where a ball that rolls turns back
NEEDED = K / (1 + K) * math.tan(TURNING)  # of friction, there
FAST = math.sqrt(2 * G * ARM * (1 - math.cos(TURNING)) / (1 + K))


def lets_go(friction: float) -> tuple[float, float, float]:
    """Return angle, its rate and the time at which rolling takes more than friction gives, on the way up.

    By the pendulum's energy and Legendre's integral of the first kind, at 40 digits: friction falls short like a
    parabola, whose roots lie close together.
    """
    with mpmath.workdps(40):
        g, arm, k = (mpmath.mpf(number) for number in (G, ARM, K))
        most = mpmath.acos(1 - (1 + k) * mpmath.mpf(FAST) ** 2 / (2 * g * arm))
        square = lambda angle: 2 * g / (arm * (1 + k)) * (mpmath.cos(angle) - mpmath.cos(most))  # noqa: E731

        def left(angle: Any) -> Any:
            pressed = g * mpmath.cos(angle) + arm * square(angle)
            return mpmath.mpf(friction) * mpmath.sqrt(1 + mpmath.mpf("1e-9")) * pressed - k / (1 + k) * g * mpmath.sin(
                angle
            )

        angle = mpmath.findroot(left, (most / 2, most), solver="anderson", tol=1e-60)
        amplitude = mpmath.asin(mpmath.sin(angle / 2) / mpmath.sin(most / 2))
        time = mpmath.ellipf(amplitude, mpmath.sin(most / 2) ** 2) / mpmath.sqrt(g / (arm * (1 + k)))
        return float(angle), float(mpmath.sqrt(square(angle))), float(time)


def swing(friction: float, duration: float) -> tuple[float, float, float]:
    """Return when the ball slips and when it grips, s, and the angle at the end, rad, for one that sets out upwards."""

    def slipping(_: float, y: Any) -> list[float]:
        f = friction * (G * math.cos(y[0]) + ARM * y[1] ** 2)  # N/m: the ball slips down, friction holds it up
        return [y[1], (f - G * math.sin(y[0])) / ARM, f * (1 + 1 / K) - G * math.sin(y[0])]

    def speed(_: float, y: Any) -> float:
        return float(y[2])

    def rolling(_: float, y: Any) -> list[float]:
        return [y[1], -G / ARM * math.sin(y[0]) / (1 + K)]

    speed.terminal, speed.direction = True, 1  # type: ignore[attr-defined]
    angle, rate, slips = lets_go(friction)
    exact: dict[str, Any] = {"method": "DOP853", "rtol": 1e-13}
    begun, small = [angle, rate, -1e-30], [1e-15, 1e-14, 1e-14 * math.sqrt(1 - friction / NEEDED)]
    slip = solve_ivp(slipping, (slips, duration), begun, events=speed, first_step=1e-9, atol=small, **exact)
    assert slip.status == 1
    after = solve_ivp(rolling, (float(slip.t[-1]), duration), slip.y[:2, -1], atol=1e-15, **exact)
    return slips, float(slip.t[-1]), float(after.y[0, -1])


def trough(friction: float) -> tr.RollingSystem:
    support = tr.Support(tr.Cylinder(B), tilt="90 deg", friction=friction)
    return tr.RollingSystem(tr.Body.solid_sphere(A, 1.0), support, gravity=G)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("share", [1e-9, 3e-9, 1e-8, 3e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2])
def test_a_ball_whose_friction_hardly_falls_short_slips_and_grips_when_it_must(share: float, method: str) -> None:
    friction, duration, sense = NEEDED * (1 - share), 0.7, 1 if share < 1e-6 else -1
    slips, grips, angle = swing(friction, duration)
    system = trough(friction)
    run = tr.simulate(system, system.place((0.0, 0.0), (sense * FAST, 0.0)), duration, 0.02, method)
    assert [event.kind for event in run.events] == ["slip", "grip"]
    # Friction falls short like a parabola: close to its top a rounding of it moves the two times far.
    own = SOLVER(10, runge_kutta.TOLERANCE) if method == "runge-kutta" else 0.0
    blurred = max(1e-15, 3e-18 / math.sqrt(share - 4.9e-10))
    for event, time in zip(run.events, (slips, grips), strict=True):
        assert abs(event.time - time) <= SOLVER(1000, blurred) + own
    x, y, _ = run.data.position.values[-1]
    assert abs(math.atan2(y, x) - sense * angle) <= SOLVER(100, 1e-15)
    if method == "taylor" or share < 1e-3:  # the other takes thousands of steps there, and its card three times those
        assert run.card().passed


def test_friction_that_suffices_never_lets_go() -> None:
    for share in (-1e-9, 0.0, 1e-10, 4e-10):  # static friction holds half of 1e-9 more than it says
        system = trough(NEEDED * (1 - share))
        for method in ("taylor", "runge-kutta"):
            run = tr.simulate(system, system.place((0.0, 0.0), (FAST, 0.0)), 0.7, 0.02, method)
            assert not run.events
            assert run.card().passed
