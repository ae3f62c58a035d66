"""SciPy's DOP853 on compiled equations, and which of a peer's runs counts against ours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from measure import timed

TOLERANCES = (1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 2.3e-14, 1e-14)  # solve_ivp takes nothing below 2.22e-14

Array = NDArray[Any]
Solver = Callable[[Array, float], Array]  # the state at the start, tolerance -> (samples, size)


@dataclass(frozen=True)
class Attempt:
    """What a peer reached with one tolerance."""

    tolerance: float
    error: float
    time: float


def scipy_peers(rates: Callable[[float, Array], Array], times: Array) -> dict[str, Solver]:
    """Return SciPy's two DOP853: in Python as solve_ivp, and compiled as ode."""
    from scipy.integrate import ode, solve_ivp

    span = (float(times[0]), float(times[-1]))

    def with_solve_ivp(state: Array, tolerance: float) -> Array:
        if tolerance < 100 * np.finfo(float).eps:
            return np.full((times.size, state.size), np.inf)
        return solve_ivp(rates, span, state, "DOP853", times, rtol=tolerance, atol=tolerance).y.T

    def with_ode(state: Array, tolerance: float) -> Array:
        solver = ode(rates).set_integrator("dop853", rtol=tolerance, atol=tolerance, nsteps=10**9)
        solver.set_initial_value(state, span[0])
        return np.array([state, *(solver.integrate(t) for t in times[1:])])

    return {"SciPy solve_ivp DOP853, numba": with_solve_ivp, "SciPy ode dop853, numba": with_ode}


def run(solver: Solver, states: list[Array], tolerance: float) -> Callable[[], list[Array]]:
    """Return what runs a peer from each start."""
    return lambda: [solver(state, tolerance) for state in states]


def attempts(solver: Solver, states: list[Array], error: Callable[[list[Array]], float]) -> list[Attempt]:
    """Run a peer at each tolerance; one that it refuses, or does not come through with, has the error infinity."""
    found = []
    solver(states[0], TOLERANCES[0])  # compiles
    for tolerance in TOLERANCES:
        time, trajectories = timed(run(solver, states, tolerance))
        reached = error(trajectories)
        found.append(Attempt(tolerance, reached if np.isfinite(reached) else np.inf, time))
    return found


def fairest(found: list[Attempt], our_error: float) -> Attempt:
    """Choose the fastest run that is as good as ours; where there is none, the fastest of the peer's best error."""
    goal = max(our_error, min(attempt.error for attempt in found))
    return min((attempt for attempt in found if attempt.error <= goal), key=lambda attempt: attempt.time)
