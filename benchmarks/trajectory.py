"""A general trajectory by Taylor's method, against SciPy's DOP853 on numba and diffrax's Dopri8.

Ten numbers, orientation included, so nothing here knows of the closed form. Achieved error: the largest of
|position − reference| / largest |position| and of |q − reference|, over all samples of three starts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

import trundle as tr
from measure import Row, best_times, check, seconds
from peers import Solver, attempts, fairest, run, scipy_peers
from rolling_ball import for_jax, for_numba, law
from trundle.mechanics.parameters import numbers
from trundle.solve import closed_form, integrators, taylor
from trundle.solve.laws import RollingLaw
from trundle.solve.tracing import contact_state

TITLE = "Taylor: three trajectories of a ball on a tilted turntable with drag, ten numbers, 60 s, 601 samples each"

DURATION, SAMPLES, ROUNDS = 60.0, 601, 4
STARTS = (0.30, 0.35, 0.40)  # m from the axis

Array = NDArray[Any]


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

    integrator, lowered = integrators.compiled(system, RollingLaw())  # heyoka alone, for information
    parameters = lowered.values(numbers(system), 0.0)[: lowered.parameters]

    def bare() -> list[Array]:
        found = []
        for state in states:
            integrator.time, integrator.state[:], integrator.pars[:] = 0.0, state, parameters
            found.append(integrator.propagate_grid(times)[-1].copy())
        return found

    peers = _peers(facts, times)
    tried = {name: attempts(solver, states, error) for name, solver in peers.items()}
    chosen = {name: fairest(found, our_error) for name, found in tried.items()}
    candidates: dict[str, Callable[[], Any]] = {"ours": ours, "bare": bare}
    for name, solver in peers.items():
        for label, attempt in ((name, chosen[name]), (f"{name}, loose", tried[name][0])):
            candidates[label] = run(solver, states, attempt.tolerance)
    best = best_times(candidates, ROUNDS)

    for name, attempt in chosen.items():
        raw = f"{seconds(best[name])} / {seconds(best['ours'])}, peer at tolerance {attempt.tolerance:.1e}"
        yield Row(f"{name} / taylor.solve", best[name] / best["ours"], least=8, raw=raw)
        raw = f"{our_error:.1e} / {attempt.error:.1e}"
        yield Row("  achieved error: taylor.solve / the peer", our_error / attempt.error, most=1, raw=raw)
    for name in peers:
        loose, label = tried[name][0], f"{name}, loose"
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
    """Return the peers."""
    import diffrax
    import jax

    jax.config.update("jax_enable_x64", True)
    on_numba, on_jax = for_numba(law(*facts)), for_jax(law(*facts))

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

    return {**scipy_peers(on_numba, times), "diffrax Dopri8, jit": with_diffrax}
