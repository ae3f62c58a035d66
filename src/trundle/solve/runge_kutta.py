"""Dormand and Prince's Runge-Kutta method of order 8, by SciPy: every platform, and the check on Taylor's method."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import SolverError
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
    begin, end = start.time, float(times[-1])
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
        events=_exits(system),
    )
    if result.status < 0:
        raise SolverError(f"The Runge-Kutta method broke down on the way to t = {end:g} s: {result.message}")
    times, states, reached = result.t, result.y.T, None
    if result.status == 1 and result.t_events and result.y_events:
        reached = float(result.t_events[0][0])
        times, states = cut(times, states, reached, result.y_events[0][0])
    samples = Samples.of_contact(system, times, states[:, :3], states[:, 3:7], states[:, 7:])
    return samples if reached is None else samples.ended(ran_off(reached, system.support.surface.rim))


def _size(part: Array) -> float:
    return max(float(np.abs(part).max()), 1e-3)


def _exits(system: RollingSystem) -> list[Any] | None:
    rim = system.support.surface.rim
    if rim is None:
        return None

    def inside(_: float, y: Array) -> float:
        return float(rim * rim - y[0] * y[0] - y[1] * y[1])

    inside.terminal, inside.direction = True, -1  # type: ignore[attr-defined]
    return [inside]
