"""Dormand and Prince's Runge-Kutta method of order 8, by SciPy: every platform, and the check on Taylor's method."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import SolverError
from ..mechanics.algebra import Vector
from ..mechanics.system import RollingSystem, State
from .samples import Array, Progress, Samples, cut, ran_off
from .tracing import contact_state, python_rates

TOLERANCE = 1e-12


def solve(
    system: RollingSystem, start: State, times: Array, tolerance: float = TOLERANCE, progress: Progress | None = None
) -> Samples:
    """Integrate the rolling law and return the states at the given times; a rim ends the run at the located instant.

    Parameters
    ----------
    system, start, times, tolerance, progress
        As for `trundle.solve.taylor.solve`.

    Returns
    -------
    Samples
        At `times`, cut at the rim where it is reached.

    Raises
    ------
    SolverError
        If the integration breaks down.

    Examples
    --------
    >>> import trundle as tr
    >>> slope = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), tilt=0.1))
    >>> x = solve(slope, slope.place(), np.array([1.0])).position[0, 0]
    >>> print(round(x / (9.80665 * np.sin(0.1) / 2), 9))  # (5/7) g sin α
    0.714285714
    """
    from scipy.integrate import solve_ivp

    rates = python_rates(system)
    begin, end = start.time, max(float(times[-1]), float(np.nextafter(start.time, np.inf)))  # some way to go
    y0 = np.asarray(contact_state(system, start))

    def law(t: float, y: Array) -> list[float]:
        if progress is not None:
            progress(min(1.0, (t - begin) / (end - begin)))
        return rates(t, y.tolist())

    scale = np.maximum(np.abs(y0), [*[1e-3 * _size(y0[:3])] * 3, *[1.0] * 4, *[1e-3 * _size(y0[7:])] * 3])
    result = solve_ivp(
        law,
        (begin, end),
        y0,
        method="DOP853",
        t_eval=times,
        rtol=tolerance,
        atol=tolerance * scale,
        events=_exits(system, rates),
        dense_output=system.support.surface.rim is not None,
    )
    if result.status < 0:
        raise SolverError(f"The Runge-Kutta method broke down on the way to t = {end:g} s: {result.message}")
    times, states, reached = result.t, result.y.T, _first_exit(system, result)
    if reached is not None and result.sol is not None:
        times, states = cut(times, states, reached, result.sol(reached))
    samples = Samples.of_contact(system, times, states[:, :3], states[:, 3:7], states[:, 7:])
    return samples if reached is None else samples.ended(ran_off(reached, system.support.surface.rim))


def _size(part: Array) -> float:
    return max(float(np.abs(part).max()), 1e-3)


def _arm(system: RollingSystem, t: float, y: Array) -> Vector:
    """Return p − X, from the support's origin to the contact, m."""
    return Vector(*y[:3]) - system.support.motion.at(t).origin


def _excess(system: RollingSystem) -> Any:
    """Return the function of time and state that rises through 0 at the rim."""
    rim = float(system.support.surface.rim or 0.0)

    def excess(t: float, y: Array) -> float:
        arm = _arm(system, t, y)
        return float(arm.dot(arm) - rim * rim)

    return excess


def _exits(system: RollingSystem, rates: Any) -> list[Any] | None:
    """Return what SciPy looks for at the ends of each step: the rim, and where the distance from the axis is largest.

    Without the second a ball could leave and come back within one step unseen.
    """
    if system.support.surface.rim is None:
        return None
    excess = _excess(system)

    def outside(t: float, y: Array) -> float:
        return excess(t, y)

    def leaving(t: float, y: Array) -> float:
        away = Vector(*rates(t, y.tolist())[:3]) - system.support.motion.at(t).velocity
        return float(_arm(system, t, y).dot(away))

    outside.terminal, outside.direction = True, 1  # type: ignore[attr-defined]
    leaving.direction = -1  # type: ignore[attr-defined]
    return [outside, leaving]


def _first_exit(system: RollingSystem, result: Any) -> float | None:
    """Return the first instant at the rim: at an event of its own, or just before a largest distance beyond it."""
    from scipy.optimize import brentq

    if not result.t_events:
        return None
    excess, (ends, peaks) = _excess(system), result.t_events
    for peak in peaks:
        if excess(peak, result.sol(peak)) >= 0:
            inside = float(result.sol.ts[np.searchsorted(result.sol.ts, peak) - 1])
            return float(brentq(lambda t: excess(t, result.sol(t)), inside, peak, xtol=1e-300, rtol=1e-15))
    return float(ends[0]) if ends.size else None
