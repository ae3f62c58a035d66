"""The orientation of a ball after a million circles on a level turntable: its cost, and its error."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

import trundle as tr
from measure import Row, best_times, check, seconds
from trundle.solve.closed_form import orientations
from trundle.solve.exact import SphereOnPlane
from trundle.solve.orientation import orientation

TITLE = "Orientation after 10^6 circles of the ball on a level turntable"

CIRCLES = (10.37, 1_000_000.37)  # not whole: the last part of a circle has to be right too
ROUNDS = 7
DIGITS = 50
STEPS, TERMS = 64, 48  # of the reference: what the series leaves is below 1e-40


def rows() -> Iterator[Row]:
    """Measure the cost through the closed form and through `simulate`, and the error against 50 digits."""
    table = tr.Support(tr.Plane(), motion=tr.Spin("33.3 rpm"))
    system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), table)
    start = system.place(position=(0.15, 0.02), velocity=(0.03, 0.25), spin=1.3)
    motion = SphereOnPlane.of(system, start)
    few, many = (circles * motion.period for circles in CIRCLES)

    def at(time: float) -> NDArray[np.float64]:
        return orientations(motion, start, np.array([time]))[0]

    def angular_velocity(t: NDArray[np.float64]) -> NDArray[np.float64]:
        Omega = motion.motion_at(t)[2]
        return np.stack(np.broadcast_arrays(Omega.x, Omega.y, Omega.z, t))[:3]

    def stepped(time: float) -> NDArray[np.float64]:
        return orientation(angular_velocity, np.array([time]), start.orientation)[0]

    def simulated(time: float) -> Any:
        return tr.simulate(system, start, duration=time, every=time)

    best = best_times(
        {
            "few, stepped": lambda: stepped(few),
            "few": lambda: at(few),
            "many": lambda: at(many),
            "simulate few": lambda: simulated(few),
            "simulate many": lambda: simulated(many),
        },
        ROUNDS,
    )
    errors = [_distance(at(time), _precise(motion, start, time)) for time in (few, many)]
    check(
        np.abs(simulated(many).data.orientation.values[-1] - at(many)).max() < 1e-12,
        "simulate must give the orientation that was timed",
    )
    check(np.abs(stepped(few) - at(few)).max() < 1e-12, "steps must give the same orientation")
    # Mean |Ω| over a circle, for the number of turns of the ball about itself.
    Omega = motion.motion_at(np.linspace(0.0, motion.period, 1000, endpoint=False))[2]
    turns = float(np.sqrt(Omega.x**2 + Omega.y**2 + Omega.z**2).mean()) * many / (2 * math.pi)

    raw = f"{seconds(best['many'])} / {seconds(best['few'])}"
    yield Row("orientation after 10^6 circles / after 10", best["many"] / best["few"], most=2, raw=raw)
    raw = f"after {turns:.3g} turns of the ball, {many / 86400:.0f} days"
    yield Row("error after 10^6 circles, against mpmath", errors[1], most=1e-9, raw=raw, kind="error")
    yield Row("error after 10 circles, against mpmath", errors[0], kind="error")
    raw = f"{seconds(best['many'])} / {seconds(best['few, stepped'])}"
    yield Row("after 10^6 circles / after 10 by steps", best["many"] / best["few, stepped"], raw=raw)
    raw = f"{seconds(best['simulate many'])} / {seconds(best['simulate few'])}"
    yield Row("simulate: after 10^6 circles / after 10", best["simulate many"] / best["simulate few"], raw=raw)


def _distance(q: NDArray[np.float64], exact: list[Any]) -> float:
    """Return the largest difference of the components; the sign of a quaternion counts here."""
    return float(max(abs(a - float(b)) for a, b in zip(exact, q, strict=True)))


def _precise(motion: SphereOnPlane, start: tr.State, time: float) -> list[Any]:
    """Return the orientation to 50 digits: the matrix of one circle, to a power by squaring, and the rest of one.

    The ball's centre circles at κ about ζ_c, so a(Ω_x + iΩ_y) = ωζ + iζ̇ = ω ζ_c + (ω − κ) b e^{iκt}. On the matrices
    [[w + iz, −x − iy], [x − iy, w − iz]] of SU(2), known by their first column (A, B),
    q̇ = ½Ωq is  Ȧ = ½(iΩ_z A − W B),  Ḃ = ½(W̄ A − iΩ_z B),  W = Ω_x + iΩ_y.
    """
    mpf, mpc = mpmath.mpf, mpmath.mpc
    with mpmath.workdps(DIGITS):
        k, a, omega = mpf(motion.inertia_ratio), mpf(motion.radius), mpf(motion.rate)
        kappa = omega * k / (1 + k)
        arm = mpc(*motion.velocity) / mpc(0, kappa)
        steady = omega * (mpc(*motion.position) - arm) / a
        circling = (omega - kappa) * arm / a
        spin, period = mpf(start.angular_velocity[2]), 2 * mpmath.pi / kappa
        whole = int(mpmath.floor(mpf(time) / period))

        def turn(end: Any) -> tuple[Any, Any]:
            return _propagate(steady, circling, spin, kappa, end)

        moved = _times(turn(mpf(time) - whole * period), _power(turn(period), whole))
        w, x, y, z = (mpf(part) for part in start.orientation)
        A, B = _times(moved, (mpc(w, z), mpc(x, -y)))
        return [A.real, B.real, -B.imag, A.imag]


def _propagate(steady: Any, circling: Any, spin: Any, kappa: Any, end: Any) -> tuple[Any, Any]:
    """Sum Taylor series of the first column from 0 to `end`."""
    mpc, h = mpmath.mpc, end / STEPS
    shrink = [(mpc(0, kappa * h)) ** n / mpmath.factorial(n) for n in range(TERMS)]
    A, B = mpc(1), mpc(0)
    for step in range(STEPS):
        now = circling * mpmath.expj(kappa * h * step)
        W = [h * now * factor for factor in shrink]
        W[0] += h * steady
        conjugate = [mpmath.conj(w) for w in W]
        As, Bs, turn = [A], [B], mpc(0, spin * h)
        for n in range(TERMS - 1):
            down = mpmath.fdot(zip(W[: n + 1], reversed(Bs), strict=True))
            up = mpmath.fdot(zip(conjugate[: n + 1], reversed(As), strict=True))
            As.append((turn * As[n] - down) / (2 * (n + 1)))
            Bs.append((up - turn * Bs[n]) / (2 * (n + 1)))
        A, B = mpmath.fsum(As), mpmath.fsum(Bs)
    return A, B


def _times(p: tuple[Any, Any], q: tuple[Any, Any]) -> tuple[Any, Any]:
    """Multiply two matrices [[A, −B̄], [B, Ā]], each given by its first column."""
    return p[0] * q[0] - mpmath.conj(p[1]) * q[1], p[1] * q[0] + mpmath.conj(p[0]) * q[1]


def _power(base: tuple[Any, Any], n: int) -> tuple[Any, Any]:
    result = (mpmath.mpc(1), mpmath.mpc(0))
    while n:
        if n % 2:
            result = _times(base, result)
        base, n = _times(base, base), n // 2
    return result
