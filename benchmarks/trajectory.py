"""A general trajectory by Taylor's method, against SciPy's DOP853 on numba and diffrax's Dopri8.

Ten numbers, orientation included, so nothing here knows of the closed form. Achieved error: the largest of
|position − reference| / largest |position| and of |q − reference|, over all samples of three starts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import trundle as tr
from measure import Row, best_times, check, seconds, timed
from rolling_ball import for_jax, for_numba, law
from trundle.mechanics.parameters import numbers
from trundle.solve import closed_form, taylor
from trundle.solve.tracing import contact_state

TITLE = "Taylor: three trajectories of a ball on a tilted turntable with drag, ten numbers, 60 s, 601 samples each"

DURATION, SAMPLES, ROUNDS = 60.0, 601, 4
STARTS = (0.30, 0.35, 0.40)  # m from the axis
TOLERANCES = (1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 2.3e-14, 1e-14)  # solve_ivp takes nothing below 2.22e-14

Array = NDArray[Any]
Solver = Callable[[Array, float], Array]  # the ten numbers at the start, tolerance -> (samples, 10)


@dataclass(frozen=True)
class Attempt:
    """What a peer reached with one tolerance."""

    tolerance: float
    error: float
    time: float


def rows() -> Iterator[Row]:
    """Find what each peer needs to come as near as it can, then time it in turns with ours."""
    spin = tr.Spin("33.3 rpm")
    table = tr.Support(tr.Plane(), motion=spin, tilt="0.2 deg")
    system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.1, mass=4.0), table, loads=(tr.Drag(0.5),))
    facts = (0.1, 4.0, 0.4, spin.rate, 4.0 * system.weight.x, 0.5)
    times = np.linspace(0.0, DURATION, SAMPLES)
    starts = [system.place(position=(x, 0.0), velocity=(0.0, 0.2), spin=1.0) for x in STARTS]
    states = [np.array(contact_state(system, start)) for start in starts]
    references = [_reference(facts, state, times) for state in states]

    def error(trajectories: list[Array]) -> float:
        return max(_error(a, b) for a, b in zip(trajectories, references, strict=True))

    def ours() -> list[Array]:
        solved = [taylor.solve(system, start, times) for start in starts]
        return [np.hstack([one.contact, one.orientation, one.angular_velocity]) for one in solved]

    exact = [closed_form.solve(system, start, times) for start in starts]
    exact_error = error([np.hstack([one.contact, one.orientation, one.angular_velocity]) for one in exact])
    check(exact_error < 1e-12, f"closed form and reference must agree; they are {exact_error:.1e} apart")
    our_error = error(ours())

    integrator = taylor._integrator(system, taylor.TOLERANCE)  # heyoka alone, for information

    def bare() -> list[Array]:
        found = []
        for state in states:
            integrator.time, integrator.state[:], integrator.pars[:] = 0.0, state, numbers(system)
            found.append(integrator.propagate_grid(times)[-1].copy())
        return found

    peers = _peers(facts, times)
    attempts = {name: _attempts(solver, states, error) for name, solver in peers.items()}
    chosen = {name: _fairest(found, our_error) for name, found in attempts.items()}
    candidates: dict[str, Callable[[], Any]] = {"ours": ours, "bare": bare}
    for name, solver in peers.items():
        for label, attempt in ((name, chosen[name]), (f"{name}, loose", attempts[name][0])):
            candidates[label] = _run(solver, states, attempt.tolerance)
    best = best_times(candidates, ROUNDS)

    for name, attempt in chosen.items():
        raw = f"{seconds(best[name])} / {seconds(best['ours'])}, peer at tolerance {attempt.tolerance:.1e}"
        yield Row(f"{name} / taylor.solve", best[name] / best["ours"], least=8, raw=raw)
        raw = f"{our_error:.1e} / {attempt.error:.1e}"
        yield Row("  achieved error: taylor.solve / the peer", our_error / attempt.error, most=1, raw=raw)
    for name in peers:
        loose, label = attempts[name][0], f"{name}, loose"
        raw = f"{seconds(best[label])} / {seconds(best['ours'])}, the peer with error {loose.error:.1e}"
        yield Row(f"{name} at {loose.tolerance:.0e} / ours", best[label] / best["ours"], raw=raw)
    raw = f"{seconds(best['ours'])} / {seconds(best['bare'])}, heyoka's error {error(bare()):.1e}"
    yield Row("taylor.solve / heyoka alone", best["ours"] / best["bare"], raw=raw)
    yield Row("error of the closed form and its orientation", exact_error, kind="error")


def _reference(facts: tuple[float, ...], state: Array, times: Array) -> Array:
    """Integrate the hand-written law with 80-bit numbers, by Taylor series at 1e-19."""
    import heyoka

    wide = np.longdouble
    check(bool(np.finfo(wide).eps < 2e-19), "the reference needs 80-bit long doubles")
    variables = heyoka.make_vars(*(f"y{j}" for j in range(10)))
    rates = law(*(heyoka.expression(wide(fact)) for fact in facts), zero=heyoka.expression(wide(0.0)))(*variables)
    integrator = heyoka.taylor_adaptive(
        list(zip(variables, rates, strict=True)), state.astype(wide), fp_type=wide, tol=wide(1e-19), compact_mode=True
    )
    return integrator.propagate_grid(times.astype(wide))[-1]


def _error(found: Array, reference: Array) -> float:
    where, turned = np.abs(found - reference)[:, :2].max(), np.abs(found - reference)[:, 3:7].max()
    return float(max(where / np.abs(reference[:, :2]).max(), turned))


def _peers(facts: tuple[float, ...], times: Array) -> dict[str, Solver]:
    """Return the peers. SciPy has DOP853 twice: in Python as solve_ivp, and compiled as ode."""
    import diffrax
    import jax
    from scipy.integrate import ode, solve_ivp

    jax.config.update("jax_enable_x64", True)
    on_numba, on_jax = for_numba(law(*facts)), for_jax(law(*facts))

    def with_solve_ivp(state: Array, tolerance: float) -> Array:
        if tolerance < 100 * np.finfo(float).eps:
            return np.full((SAMPLES, 10), np.inf)
        span = (0.0, DURATION)
        return solve_ivp(on_numba, span, state, "DOP853", times, rtol=tolerance, atol=tolerance).y.T

    def with_ode(state: Array, tolerance: float) -> Array:
        solver = ode(on_numba).set_integrator("dop853", rtol=tolerance, atol=tolerance, nsteps=10**9)
        solver.set_initial_value(state, 0.0)
        return np.array([state, *(solver.integrate(t) for t in times[1:])])

    @jax.jit
    def compiled(state: Any, tolerance: Any) -> Any:
        return diffrax.diffeqsolve(
            diffrax.ODETerm(on_jax),
            diffrax.Dopri8(),
            t0=0.0,
            t1=DURATION,
            dt0=None,
            y0=state,
            saveat=diffrax.SaveAt(ts=jax.numpy.asarray(times)),
            stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance),
            max_steps=1_000_000,
            throw=False,
        ).ys

    def with_diffrax(state: Array, tolerance: float) -> Array:
        return np.asarray(compiled(state, tolerance))

    return {
        "SciPy solve_ivp DOP853, numba": with_solve_ivp,
        "SciPy ode dop853, numba": with_ode,
        "diffrax Dopri8, jit": with_diffrax,
    }


def _run(solver: Solver, states: list[Array], tolerance: float) -> Callable[[], list[Array]]:
    return lambda: [solver(state, tolerance) for state in states]


def _attempts(solver: Solver, states: list[Array], error: Callable[[list[Array]], float]) -> list[Attempt]:
    """Run a peer at each tolerance; one that it refuses, or does not come through with, has the error infinity."""
    found = []
    solver(states[0], TOLERANCES[0])  # compiles
    for tolerance in TOLERANCES:
        time, trajectories = timed(_run(solver, states, tolerance))
        reached = error(trajectories)
        found.append(Attempt(tolerance, reached if np.isfinite(reached) else np.inf, time))
    return found


def _fairest(attempts: list[Attempt], our_error: float) -> Attempt:
    """Choose the fastest run that is as good as ours; where there is none, the fastest of the peer's best error."""
    goal = max(our_error, min(attempt.error for attempt in attempts))
    return min((attempt for attempt in attempts if attempt.error <= goal), key=lambda attempt: attempt.time)
