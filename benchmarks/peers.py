"""DOP853 on compiled equations, SciPy's two and one whose loop is compiled, too; which of a peer's runs counts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from measure import timed

TOLERANCES = (1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 2.3e-14, 1e-14)  # solve_ivp takes nothing below 2.22e-14

IN_PYTHON, COMPILED = "SciPy solve_ivp DOP853, numba", "DOP853 with its loop compiled, numba"

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

    return {IN_PYTHON: with_solve_ivp, "SciPy ode dop853, numba": with_ode}


def compiled_peer(rates: Callable[[float, Array], Array], times: Array) -> Solver:
    """Return DOP853 with its loop compiled by numba; it steps to each sample, as SciPy's `ode` does."""
    import numba
    from scipy.integrate._ivp import dop853_coefficients as given

    stages = given.N_STAGES
    A, B, C = (np.ascontiguousarray(part[:stages]) for part in (given.A[:, :stages], given.B, given.C))
    third, fifth = given.E3[:stages].copy(), given.E5[:stages].copy()

    @numba.njit
    def follow(state: Array, tolerance: float) -> Array:
        found, y = np.empty((times.size, state.size)), state.copy()
        k, t, h = np.empty((stages, state.size)), times[0], 1e-6
        found[0] = y
        for sample in range(1, times.size):
            while t < times[sample]:
                left = times[sample] - t
                step = left if h >= left else h
                for i in range(stages):
                    there = y.copy()
                    for j in range(i):
                        if A[i, j] != 0.0:
                            for n in range(y.size):
                                there[n] += step * A[i, j] * k[j, n]
                    k[i] = rates(t + C[i] * step, there)
                ahead = y.copy()
                squares, cubes = 0.0, 0.0
                for n in range(y.size):
                    e5, e3 = 0.0, 0.0
                    for i in range(stages):
                        ahead[n] += step * B[i] * k[i, n]
                        e5 += fifth[i] * k[i, n]
                        e3 += third[i] * k[i, n]
                    scale = tolerance * (1.0 + max(abs(y[n]), abs(ahead[n])))
                    squares += (e5 / scale) ** 2
                    cubes += (e3 / scale) ** 2
                error = 0.0
                if squares > 0.0:
                    error = step * squares / np.sqrt((squares + 0.01 * cubes) * y.size)
                factor = min(6.0, 0.9 * error**-0.125) if error > 0.0 else 6.0
                if error < 1.0:
                    t = times[sample] if step == left else t + step
                    y = ahead
                    h = max(h, step * factor) if step < h else step * factor
                else:
                    h = step * max(0.333, factor)
            found[sample] = y
        return found

    return follow


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
