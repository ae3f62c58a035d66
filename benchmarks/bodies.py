"""Rattleback, coin and ball in a spinning elliptic bowl, against equations written for each by hand.

These are given to SciPy's DOP853, to one whose loop is compiled, and to heyoka.

Achieved error: the largest of |p − reference| / largest |p| and of |q − reference| over all samples, q up to its sign.
The reference integrates the hand-written equations with 80-bit numbers, by Taylor series at 1e-19. Each side runs at
the loosest of its tolerances that is as good as the other: the peer as good as ours at 1e-15, or as good as it gets
where it gets no further, and ours as good as that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

import by_hand
import trundle as tr
from measure import Row, best_times, check, seconds
from peers import COMPILED, IN_PYTHON, attempts, compiled_peer, fairest, run, scipy_peers
from trundle.solve import integrators, taylor
from trundle.solve.laws import RollingLaw

TITLE = "Taylor on the general law: rattleback 20 s, coin 60 s, ball in a spinning elliptic bowl 1000 s, ten samples/s"

ROUNDS = 5
OURS = (1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10)

Array = NDArray[Any]


@dataclass(frozen=True)
class Case:
    """A system of trundle's, its start, and the same by hand."""

    name: str
    system: tr.RollingSystem
    start: tr.State
    duration: float
    by_hand: by_hand.Problem
    of_hand: float  # at most so many times heyoka's time on them
    of_ode: float  # at least so many times faster than SciPy's compiled `ode`

    @property
    def times(self) -> Array:
        """Ten a second."""
        return np.linspace(0.0, self.duration, round(10 * self.duration) + 1)

    @property
    def state(self) -> Array:
        """(p, q, Ω) at the start."""
        return np.array(RollingLaw().pack(self.system, self.start))


def cases() -> list[Case]:
    """Return the three; the rattleback is Kane and Levinson's, the coin one of 24 mm that wobbles as it rolls."""
    axes, moments, product, rise = (0.2, 0.03, 0.02), (2e-4, 1.6e-3, 1.7e-3), -2e-5, 0.01
    stone = tr.Body.ellipsoid(axes, mass=1.0, moments=moments, products=(product, 0, 0), centre=(0, 0, rise))
    spun = tr.RollingSystem(stone, tr.Support(tr.Plane()))
    coin = tr.Body.disc(radius=0.012, mass=0.0075, thickness=0.0022)
    rolled = tr.RollingSystem(coin, tr.Support(tr.Plane()))
    across, about = (float(moment) for moment in (coin.inertia.x, coin.inertia.z))
    return [
        Case(
            "rattleback",
            spun,
            spun.place(attitude=(0.0, 0.02, 0.01), spin=-5.0),
            20.0,
            by_hand.rattleback(1.0, moments, product, axes, rise),
            of_hand=1.3,
            of_ode=2.5,
        ),
        Case(
            "coin",
            rolled,
            rolled.place(attitude=(0.0, "80 deg", 0.0), velocity=(0.5, 0.0), spin=1.0),
            60.0,
            by_hand.coin(0.012, 0.0075, across, about),
            of_hand=2.0,
            of_ode=5.0,
        ),
        bowl(1000.0),
    ]


def bowl(duration: float, size: float = 1.0) -> Case:
    """Return the ball in a bowl of semi-axes 50, 40 and 30 cm, or larger, that turns at 1.5 rad/s, or slower."""
    axes, radius, rate = tuple(size * axis for axis in (0.5, 0.4, 0.3)), 0.1 * size, 1.5 / size**0.5
    system = tr.RollingSystem(
        tr.Body.solid_sphere(radius, 0.1), tr.Support(tr.EllipsoidalBowl(axes), motion=tr.Spin(rate))
    )
    speed = size**0.5
    start = system.place((0.1 * size, 0.05 * size), (0.1 * speed, 0.2 * speed), spin=1.0 / speed)
    problem = by_hand.ball_in_bowl(radius, 0.4, axes, rate)
    return Case("spinning bowl", system, start, duration, problem, of_hand=2.0, of_ode=5.0)


def rows() -> Iterator[Row]:
    """Find what each peer needs to come as near as it can, then time it in turns with ours."""
    for case in cases():
        yield from _rows(case)


def _rows(case: Case) -> Iterator[Row]:
    times, problem = case.times, case.by_hand
    p, q, Omega = np.split(case.state, (3, 7))
    begin = problem.begin(p, q, Omega)
    reference = problem.seen(times, by_hand.reference(problem, begin, times))

    def error(seen: Array) -> float:
        sign = np.sign((seen[:, 3:] * reference[:, 3:]).sum(axis=1))[:, None]
        apart = np.abs(seen - np.hstack([reference[:, :3], sign * reference[:, 3:]]))
        return float(max(apart[:, :3].max() / np.abs(reference[:, :3]).max(), apart[:, 3:].max()))

    def peer_error(trajectories: list[Array]) -> float:
        finite = np.isfinite(trajectories[0]).all()
        return error(problem.seen(times, trajectories[0])) if finite else np.inf

    def ours(tolerance: float = taylor.TOLERANCE) -> Any:
        return taylor.solve(case.system, case.start, times, tolerance)

    def our_error(tolerance: float) -> float:
        found = ours(tolerance)
        check(not found.events, f"the {case.name} must roll to the end")
        return error(np.hstack([found.contact, found.orientation]))

    reached = {tolerance: our_error(tolerance) for tolerance in OURS}
    default = reached[taylor.TOLERANCE]
    check(default < 1e-8, f"the {case.name} must agree with the equations by hand; they are {default:.1e} apart")

    compiled = by_hand.for_numba(problem)
    peers = scipy_peers(compiled, times) | {COMPILED: compiled_peer(compiled, times)}
    tried = {name: attempts(solver, [begin], peer_error) for name, solver in peers.items()}
    chosen = {name: fairest(those, default) for name, those in tried.items()}
    equal = {
        name: max((t for t, e in reached.items() if e <= attempt.error), default=taylor.TOLERANCE)
        for name, attempt in chosen.items()
    }
    heyoka = by_hand.for_heyoka(problem, begin)

    def by_heyoka() -> Any:
        heyoka.time, heyoka.state[:] = 0.0, begin
        return heyoka.propagate_grid(times)

    candidates: dict[str, Callable[[], Any]] = {"ours": ours, "heyoka": by_heyoka}
    candidates |= {f"ours, {t}": partial(ours, t) for t in set(equal.values())}
    for name, solver in peers.items():
        candidates[name] = run(solver, [begin], chosen[name].tolerance)
        candidates[f"{name}, loose"] = run(solver, [begin], tried[name][0].tolerance)
    best = best_times(candidates, ROUNDS)
    raw = f"{seconds(best['ours'])} / {seconds(best['heyoka'])}"
    yield Row(
        f"{case.name}: ours / heyoka on equations by hand", best["ours"] / best["heyoka"], most=case.of_hand, raw=raw
    )
    law = integrators.ready(case.system, RollingLaw(), taylor.TOLERANCE, case.state.tolist())[0]
    counts = law.operations, len(heyoka.decomposition) - 2 * problem.size
    yield Row("  operations: ours / by hand", counts[0] / counts[1], most=2, raw="{} / {}".format(*counts))
    for name, attempt in chosen.items():
        least = {IN_PYTHON: 8.0, COMPILED: None}.get(name, case.of_ode)
        mine = best[f"ours, {equal[name]}"]
        raw = f"{seconds(best[name])} at {attempt.tolerance:.1e} / {seconds(mine)} at {equal[name]:.0e}"
        yield Row(f"{case.name}: {name} / ours", best[name] / mine, least=least, raw=raw)
        raw = f"{reached[equal[name]]:.1e} / {attempt.error:.1e}"
        yield Row("  achieved error: ours / the peer", reached[equal[name]] / attempt.error, most=1, raw=raw)
        raw = f"{seconds(best[name])} / {seconds(best['ours'])}, our error {default:.1e}"
        yield Row("  the same / ours at 1e-15, as users run it", best[name] / best["ours"], raw=raw)
    for name in peers:
        loose, label = tried[name][0], f"{name}, loose"
        raw = f"{seconds(best[label])} / {seconds(best['ours'])}, the peer with error {loose.error:.1e}"
        yield Row(f"  {name} at {loose.tolerance:.0e} / ours", best[label] / best["ours"], raw=raw)
