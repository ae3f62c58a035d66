"""Motions that repeat but for a shift and a turn, and the multipliers by which nudges grow in one period (Floquet)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...display import Headline, Markup, Serializable, pairs
from ...errors import SolverError
from ...mechanics import checks
from ...mechanics.system import RollingSystem, State
from ...scenario import ScenarioFile
from .finding import flow_of
from .flow import Array, Flow
from .runs import carried, does_not_return, reference, slope_of_run
from .symmetry import COUNT, generator, group_matrix, moved_by, symmetries

_FEWEST = 3  # samples that may show a return
_SAMPLES = 400  # of the run in which the period is looked for
_STEPS = 25
FOUND = 2e-14  # closing error in units of the scale: as good as it gets
CLOSED = 1e-9  # likewise: what is more has not closed
_RANK = 1e-7
_ONE = 1e-5  # from 1: a multiplier that differs less is 1
_BACK = 0.3  # share of the way that it was away: what is left of that is back
_CLOSE_ENOUGH = 1e-3  # in units of the scale: a better move need not be looked for
_NEAR = 0.03  # share of the signature's spread below which a dip may be a return
_STARTS = 16  # turns from which a move that brings back is looked for
_TRIES = 25  # steps from each
_OTHER_SIGN = np.diag([1.0] * 3 + [-1.0] * 4 + [1.0] * 4)  # q and −q are one orientation


@dataclass(frozen=True, repr=False)
class PeriodicMotion(Serializable):
    """A motion that repeats after a period, seen after a shift and a turn that change nothing that matters.

    Parameters
    ----------
    system : RollingSystem
        Body, support and loads.
    state : State
        One instant of it: a start for `trundle.simulate`.
    period : float
        s.
    turned : float
        By how much all has turned about the support's axis in one period, rad, to within whole turns.
    multipliers : tuple of complex
        By which nudges are multiplied in one period, the largest first; symmetry divided out.
    free : int
        How many of them are 1 because the motion belongs to a family or a nudge runs along it.
    residual : float
        How far it fails to close, in units of the scale.

    Examples
    --------
    >>> import trundle as tr
    >>> trough = tr.Support(tr.Cylinder(0.5), tilt="90 deg")
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), trough)
    >>> swing = tr.periodic_motion(system, system.place(position=(0.001, 0.0)))
    >>> round(swing.period * (9.80665 / (1.4 * 0.4)) ** 0.5 / (2 * math.pi), 6)  # a pendulum's, small
    1.0
    """

    system: RollingSystem
    state: State
    period: float
    turned: float
    multipliers: tuple[complex, ...]
    free: int
    residual: float
    start: Array = field(repr=False, compare=False)

    @property
    def verdict(self) -> str:
        """The words "unstable", "stable", "stable to first order" or "neutral", from the multipliers that are not 1."""
        sizes = [abs(one) for one in self.multipliers[self.free :]] if self.free else [abs(m) for m in self.multipliers]
        if not sizes:
            return "neutral"
        if max(sizes) > 1 + 1e-6:
            return "unstable"
        return "stable" if max(sizes) < 1 - 1e-6 else "stable to first order"

    def __str__(self) -> str:
        from .words import periodic_report

        return periodic_report(self)

    def _headline(self) -> Headline:
        return Headline("", self.verdict)

    def _parts(self) -> Iterator[Markup]:
        from .words import periodic_facts

        yield pairs(periodic_facts(self).items())

    def as_dict(self) -> dict[str, Any]:
        """Return everything in SI units and plain types, for JSON."""
        return {
            "period": self.period,
            "turned": self.turned,
            "multipliers": [[one.real, one.imag] for one in self.multipliers],
            "free": self.free,
            "verdict": self.verdict,
            "residual": self.residual,
            "state": {
                "position": self.state.position,
                "velocity": self.state.velocity,
                "angular_velocity": self.state.angular_velocity,
                "orientation": self.state.orientation,
            },
        }


def periodic_motion(system: Any, start: State | None = None, *, longest: Any = None) -> PeriodicMotion:
    """Find the periodic motion next to a start, and its Floquet multipliers.

    Parameters
    ----------
    system : RollingSystem or Scenario
        As for `steady_motions`.
    start : State, optional
        Where the search begins; absent: the scenario's start, or ``system.place()``.
    longest : float or quantity, optional
        The longest period looked for, s; absent: a hundred of the system's own times.

    Returns
    -------
    PeriodicMotion
        With period, multipliers and verdict.

    Raises
    ------
    SolverError
        If nothing comes back within the longest period, or Newton's method finds nothing that closes.

    Source: Floquet's theorem; see [hairer1993], section I.12. Slopes come from differences of whole runs.

    Examples
    --------
    >>> import trundle as tr
    >>> inside = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5)))
    >>> bobbing = tr.periodic_motion(inside, inside.place(velocity=(3.0, 0.2)))
    >>> round(2 * math.pi / bobbing.period / (3.0 / 0.4), 9) == round(math.sqrt(2 / 7), 9)
    True
    """
    if isinstance(system, ScenarioFile):
        start = system.start_state() if start is None else start
        system = system.system()
    checks.instance(system, RollingSystem, "system", "Give a tr.RollingSystem or a tr.Scenario.")
    start = system.place() if start is None else start
    checks.instance(start, State, "start", "Let system.place(...) make it.")
    flow, y = flow_of(system, start)
    moves = symmetries(flow, y)
    most = 200 / flow.rate if longest is None else float(checks.positive(longest, "time", "longest"))
    return _refined(flow, y, moves, *_first_return(flow, y, moves, most))


def signature(flow: Flow, y: Any) -> Array:
    """Return numbers that no symmetry changes: lengths and angles among V, Ω, n, ρ and R, without units."""
    now = flow.law(y)
    L, w = flow.length, flow.rate
    Omega = [part / w for part in y[7:]]
    V = [part / (L * w) for part in now.velocity]
    weight = flow.system.body.mass * L * w * w
    vectors = [V, Omega, list(now.contact.normal), [part / weight for part in now.reaction]]
    turned = [part / (L * w) for part in now.point_rate]
    vectors.append(turned)
    pairs = [(a, b) for i, a in enumerate(vectors) for b in vectors[i:]]
    rows = [a[0] * b[0] + a[1] * b[1] + a[2] * b[2] for a, b in pairs]
    rows.append(now.contact.offset.dot(now.contact.normal) / L)
    return np.stack([np.broadcast_to(row, np.shape(y)[1:]) for row in rows]).astype(float)


def _first_return(flow: Flow, y: Array, moves: Array, most: float) -> tuple[float, Array, float]:
    """Return about when a run first comes back but for a symmetry, that symmetry's move, and how far away it was.

    The signature says when to look; a mirror image, as of half a swing, has the same signature and does not come back.
    """
    span = min(most, 12 / flow.rate)
    while True:
        times = np.linspace(0, span, _SAMPLES * max(1, round(span * flow.rate / 12)) + 1)
        states, end = carried(flow, y, times)
        if end is not None and states.shape[1] < _FEWEST:
            raise does_not_return(end)
        times = times[: states.shape[1]]
        marks = signature(flow, states)
        apart = np.linalg.norm(marks - marks[:, :1], axis=0)
        if apart.max() < 1e-10:
            raise SolverError("The start is a steady motion: it has no period. Nudge it, or ask for steady motions.")
        far = bringing_back(flow, y, moves, states[:, int(apart.argmax())])[1]
        for i in _dips(times, marks, apart):
            move, off = bringing_back(flow, y, moves, states[:, i])
            if off < _BACK * far:
                return float(times[i]), move, far
        if end is not None:
            raise does_not_return(end)
        if span >= most:
            raise SolverError(
                f"Nothing came back within {span:g} s. Give a longer `longest`, or a start nearer to a periodic motion."
            )
        span = min(most, 3 * span)


def _dips(times: Array, marks: Array, apart: Array) -> list[int]:
    """Return the instants at which the signature is next to what it was, and moves as it did."""
    spread, rate = float(apart.max()), np.gradient(marks, times, axis=1)
    at_turn = np.linalg.norm(rate[:, 0]) < 0.02 * np.linalg.norm(rate, axis=0).max()
    left = int(np.flatnonzero(apart > 0.3 * spread)[0])
    return [
        i
        for i in range(left + 1, len(times) - 1)
        if apart[i] <= min(apart[i - 1], apart[i + 1])
        and apart[i] < _NEAR * spread
        and (at_turn or float(rate[:, i] @ rate[:, 0]) > 0)
    ]


def _refined(flow: Flow, y: Array, moves: Array, period: float, move: Array, far: float) -> PeriodicMotion:
    """Return the periodic motion next to a guess: Newton's method, for period and move first, then the state, too."""
    begin, slope = y, None
    best, last = (math.inf, y, period, move), math.inf
    for _ in range(_STEPS):
        basis, error = flow.tangent(y), (reference(flow, y, period, move) - y) / flow.scale
        size = float(np.linalg.norm(error))
        best = min(best, (size, y, period, move), key=lambda one: one[0])
        if size < FOUND or (best[0] < CLOSED and size > 0.5 * last):
            break
        if size > 0.3 * last:
            slope = _slope(flow, y, period, move, rough=True)
        last = size
        step = _newton(flow, y, moves, slope, error, basis)
        y = flow.put_back(y + flow.scale * (basis @ step[: basis.shape[1]]))
        shares = step[basis.shape[1] : -1]
        move = group_matrix(-(shares @ moves) if len(moves) else np.zeros(COUNT)) @ move
        period += float(step[-1]) / flow.rate
    if best[0] > CLOSED:
        raise SolverError("No motion that closes was found near the start. Begin nearer to a periodic motion.")
    _, y, period, move = best
    if np.linalg.norm((y - begin) / flow.scale) > _BACK * far:
        raise SolverError("The nearest motion that closes is another one. Begin nearer to a periodic motion.")
    return _described(flow, moves, *best, _slope(flow, y, period, move))


def _slope(flow: Flow, y: Array, period: float, move: Array, *, rough: bool = False) -> Array:
    """Return how nudges along the basis of tangents have moved on after a period, in units of the scale."""
    nudges = flow.scale[:, None] * flow.tangent(y)
    return slope_of_run(flow, y, nudges, period, move, rough=rough) / flow.scale[:, None]


def _newton(flow: Flow, y: Array, moves: Array, slope: Array | None, error: Array, basis: Array) -> Array:
    """Return the step in state, shares of the symmetries and period that closes the motion best, to first order.

    Without a slope the state stays as it is; with one, of all steps that close it the shortest in the state is taken.
    """
    free = np.stack([moved_by(row, y) for row in moves], axis=1) if len(moves) else np.zeros((10, 0))
    flowing = flow.rates(y) / (flow.rate * flow.scale)
    columns = basis.T @ np.hstack([-free / flow.scale[:, None], flowing[:, None]])
    right, count = -(basis.T @ error), basis.shape[1]
    if slope is None:
        return np.concatenate([np.zeros(count), np.linalg.lstsq(columns, right, rcond=1e-9)[0]])
    whole = np.hstack([basis.T @ (slope - basis), 1e3 * columns])
    step = np.linalg.lstsq(whole, right, rcond=1e-9)[0]
    step[count:] *= 1e3
    return np.asarray(step * min(1.0, 0.2 / max(float(np.linalg.norm(step[:count])), 1e-300)))


def bringing_back(flow: Flow, y: Array, moves: Array, end: Array) -> tuple[Array, float]:
    """Return the move that takes a state closest to the start, and what is left: Gauss and Newton's method."""
    from scipy.linalg import expm

    generators = np.array([generator(row) for row in moves]).reshape(-1, 11, 11)
    largest = max(float(np.abs(moves[:, 3:]).max(initial=0.0)), 1e-300)
    random, best, least = np.random.default_rng(1883), np.eye(11), math.inf
    for trial in range(_STARTS if len(moves) else 1):
        shares = random.uniform(-math.pi, math.pi, len(moves)) / largest if trial else np.zeros(len(moves))
        move, before = expm(np.tensordot(shares, generators, 1)), math.inf
        for _ in range(_TRIES):
            there = move @ np.append(end, 1.0)
            if there[3:7] @ y[3:7] < 0:
                move, there = _OTHER_SIGN @ move, _OTHER_SIGN @ there
            left = (y - there[:10]) / flow.scale
            off = float(np.linalg.norm(left))
            if off < least:
                best, least = move, off
            if not len(moves) or off > 0.99 * before:
                break
            before = off
            step = np.linalg.lstsq((generators @ there)[:, :10].T / flow.scale[:, None], left, rcond=1e-9)[0]
            move = expm(np.tensordot(step, generators, 1)) @ move
        if least < _CLOSE_ENOUGH:
            break
    return best, least


def _described(
    flow: Flow, moves: Array, size: float, y: Array, period: float, move: Array, slope: Array
) -> PeriodicMotion:
    basis = flow.tangent(y)
    matrix = basis.T @ slope
    across = np.eye(basis.shape[1])
    if len(moves):
        rows = np.stack([basis.T @ (moved_by(row, y) / flow.scale) for row in moves], axis=1)
        U, singular, _ = np.linalg.svd(rows, full_matrices=True)
        across = U[:, int((singular > _RANK * max(float(singular.max()), 1e-300)).sum()) :]
    reduced = across.T @ matrix @ across
    one = np.eye(len(reduced))
    _, singular, right = np.linalg.svd(reduced - one)
    free = int((singular <= _RANK * 10).sum())
    rest = right[: len(right) - free].T
    values = np.linalg.eigvals(rest.T @ reduced @ rest)
    ordered = sorted((complex(value) for value in values), key=lambda value: (-abs(value), value.imag))
    free += sum(abs(value - 1) < _ONE for value in ordered)  # those of a period that changes with the size of the swing
    ordered = [value for value in ordered if abs(value - 1) >= _ONE]
    turned = float(math.atan2(-move[1, 0], move[0, 0])) + 0.0
    multipliers = (*[1 + 0j] * free, *ordered)
    return PeriodicMotion(flow.system, flow.state(y), period, turned, multipliers, free, size, y)
