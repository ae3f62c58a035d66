"""The motion of somebody else against contact, constraint and law, each residual beside what it may be by chance."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..mechanics.algebra import Vector
from ..mechanics.system import RollingSystem, State
from .chance import longest
from .comparisons import (
    ACCELERATION,
    LIFTS,
    PATH,
    SHIFTED,
    SLIPS,
    TURN,
    TURNING,
    Comparison,
    Sensitivity,
    comparisons,
    nodes_of,
    sensitivity_of,
)
from .laws import Law, Rates, independent_law
from .motion import Instants, Motion, motion_of, rate_of
from .record import Array, Theirs, gap_of
from .slopes import SIGMAS, Index
from .windows import Plan, Weights, plans, spread_of, weights_of

LAW_SHARE = 10.0  # times the tolerance: an acceleration is a slope, and multiplies what a method leaves
GAP, SLIP = "touches the support", "no slip"
INSTANTS = 240  # looked at for gap and slip
_TRIAL = 8  # windows of each width on which the width is chosen
_AS_GOOD = 1.3  # times the least bound: of widths that tell as much the narrowest is taken
_DIMMEST = 0.05  # share of a mismatch that is left where it turns about within a window
_BEYOND = 3.0  # standard deviations that a truncation must stand out of the noise

_UNITS = {
    PATH: "share of the speed",
    TURN: "2 q̇ q* against Ω, share of Ω",
    ACCELERATION: "Newton, Euler and constraint as one 9×9 system",
    TURNING: "Newton, Euler and constraint as one 9×9 system",
}


@dataclass(frozen=True)
class Series:
    """One residual over time beside its bound.

    Parameters
    ----------
    name : str
        Of the check.
    time : array (m,)
        s.
    residual : array (m, c)
        As vectors.
    size : float
        Beside which a residual is small or not: the shares are shares of it.
    bound : array (m,)
        The longest vector allowed.
    asked : float
        The part of the bound that the tolerance makes; the rest is what the data themselves leave open.
    note : str
        How it was measured.

    Examples
    --------
    >>> one = Series("no slip", np.arange(2.0), np.array([[0.0], [0.5]]), 1.0, np.array([0.25, 0.25]), 0.1, "")
    >>> float(one.worst), one.share, one.first_failure
    (2.0, 0.5, 1.0)
    """

    name: str
    time: Array
    residual: Array
    size: float
    bound: Array
    asked: float
    note: str

    @property
    def length(self) -> Array:
        """The residual's length at each instant."""
        return np.asarray(np.linalg.norm(self.residual, axis=1), dtype=float)

    @property
    def ratio(self) -> Array:
        """The residual over its bound."""
        return self.length / self.bound

    @property
    def worst(self) -> float:
        """The largest residual over its bound."""
        return float(self.ratio.max())

    @property
    def share(self) -> float:
        """The residual as a share of the size, where it is worst against its bound."""
        return float(self.length[np.argmax(self.ratio)] / self.size)

    @property
    def allowed(self) -> float:
        """The bound as a share of the size, at the same instant."""
        return float(self.bound[np.argmax(self.ratio)] / self.size)

    @property
    def typical(self) -> float:
        """The root mean square residual as a share of the size."""
        return float(np.sqrt((self.length**2).mean()) / self.size)

    @property
    def first_failure(self) -> float | None:
        """The first instant at which the bound is exceeded, s."""
        over = np.flatnonzero(self.ratio > 1)
        return float(self.time[over[0]]) if over.size else None


@dataclass(frozen=True)
class View:
    """How their motion is looked at: what is compared over which windows, and at which instants contact and slip are.

    It is found once, for the system as it was given; whoever asks for another law looks in the same way.
    """

    compared: tuple[tuple[Comparison, Plan], ...]
    instants: Index

    def thinned(self, count: int) -> View:
        """Return no more than some of the windows and instants."""
        some = np.unique(np.linspace(0, self.instants.size - 1, min(self.instants.size, 2 * count)).round().astype(int))
        return View(tuple((one, plan.thinned(count)) for one, plan in self.compared), self.instants[some])

    def fitting(self, theirs: Theirs) -> View:
        """Return what of it can be looked at in changed samples, which may lack a part."""
        able = {(one.name, one.array) for one in comparisons(theirs)}
        return View(tuple(pair for pair in self.compared if (pair[0].name, pair[0].array) in able), self.instants)


@dataclass(frozen=True)
class _Seen:
    """One comparison over its windows: mismatch and mean rate (k, 3), spread and bias (k,), and the means' dimming."""

    mismatch: Array
    rate: Array
    spread: Array
    bias: Array
    freedom: float
    left: float


def view_of(system: RollingSystem, theirs: Theirs, tolerance: float, start: State | None) -> View:
    """Choose for each comparison the windows in which a wrong rate would show best.

    Parameters
    ----------
    system : RollingSystem
        What is said to move.
    theirs : Theirs
        Their samples, checked.
    tolerance : float
        As for `examine`.
    start : State, optional
        As for `motion_of`.

    Returns
    -------
    View
        Of widths that tell as much as each other, the narrowest.
    """
    n = theirs.time.size
    tried = {f"{i}": plan.thinned(_TRIAL) for i, plan in enumerate(plans(n))}
    whole = list(plans(n))
    index, places = nodes_of({name: plan.index for name, plan in tried.items()})
    at = motion_of(system, theirs, start, index)
    rates, reacts = independent_law(system, at), sensitivity(system, theirs, start, independent_law)
    best: dict[str, list[tuple[float, int, Comparison]]] = {}
    for one in comparisons(theirs):
        for i, (name, plan) in enumerate(tried.items()):
            seen = _seen(one, weights_of(plan, theirs.time, one.order), theirs, at, places[name], rates, reacts)
            asked = _times(one.name) * tolerance * _size(one.name, system, at, [seen.mismatch + seen.rate], rates)
            bound = float(np.median(SIGMAS * seen.spread + seen.bias + asked)) / max(seen.left, _DIMMEST)
            best.setdefault(one.name, []).append((bound, i, one))
    chosen = []
    for found in best.values():
        least = min(bound for bound, _, _ in found)
        _, i, one = min((entry for entry in found if entry[0] <= _AS_GOOD * least), key=lambda entry: entry[1])
        chosen.append((one, whole[i]))
    return View(tuple(chosen), np.unique(np.linspace(0, n - 1, min(n, INSTANTS)).round().astype(int)))


def examine(
    system: RollingSystem,
    theirs: Theirs,
    tolerance: float,
    start: State | None,
    view: View,
    law: Law = independent_law,
    reacts: Sensitivity | None = None,
) -> tuple[dict[str, Series], Motion]:
    """Compare their motion with contact, constraint and law.

    Parameters
    ----------
    system : RollingSystem
        What is said to move.
    theirs : Theirs
        Their samples, checked.
    tolerance : float
        To which they are held, as a share; the data's own noise and spacing may ask for more room.
    start : State, optional
        As for `motion_of`.
    view : View
        How to look.
    law : callable
        Gives the accelerations.
    reacts : Sensitivity, optional
        Of a law much like it, where the errors of the states need not be followed again.

    Returns
    -------
    series : dict from str to Series
        By name.
    motion : Motion
        That they are of, at all instants looked at.
    """
    view = view.fitting(theirs)
    windows = {one.name: plan.index for one, plan in view.compared}
    index, places = nodes_of(windows | {"": view.instants[None]})
    at = motion_of(system, theirs, start, index)
    rates = law(system, at)
    reacts = sensitivity(system, theirs, start, law) if reacts is None else reacts
    found = list(_contact(system, theirs, at, places[""][0], tolerance, reacts))
    for one, plan in view.compared:
        seen = _seen(one, weights_of(plan, theirs.time, one.order), theirs, at, places[one.name], rates, reacts)
        size = _size(one.name, system, at, [seen.mismatch + seen.rate], rates)
        asked = _times(one.name) * tolerance * size
        bound = asked + seen.bias + longest(len(seen.spread), seen.freedom) * seen.spread
        note = f"{_UNITS[one.name]}, means over {_span(theirs, plan)}"
        found.append(Series(one.name, plan.moment(theirs.time), seen.mismatch, size, bound, asked, note))
    return {series.name: series for series in found}, at


def _span(theirs: Theirs, plan: Plan) -> str:
    ends = theirs.time[plan.start + plan.width - 1] - theirs.time[plan.start]
    return f"{float(np.median(ends)):.3g} s"


def _times(name: str) -> float:
    return LAW_SHARE if name in (ACCELERATION, TURNING) else 1.0


def sensitivity(system: RollingSystem, theirs: Theirs, start: State | None, law: Law) -> Sensitivity:
    """Return what errors of their states do to V̇, Ω̇, slip and gap.

    Parameters
    ----------
    system, theirs, start, law
        As of `examine`.

    Returns
    -------
    Sensitivity
        At some instants all along their samples.
    """
    n = theirs.time.size
    few = np.unique(np.linspace(0, n - 1, min(n, SHIFTED)).round().astype(int))

    def asked(states: Instants) -> tuple[Array, ...]:
        return (*law(system, states), states.slip, gap_of(system, states.contact))

    return sensitivity_of(system, asked, motion_of(system, theirs, start, few))[0]


def _seen(
    one: Comparison,
    weights: Weights,
    theirs: Theirs,
    at: Motion,
    place: Index,
    rates: Rates,
    reacts: Sensitivity,
) -> _Seen:
    """Return the mismatch of one comparison in each window, and what noise and spacing make of it."""
    f = one.rate(at, rates)[place]
    mismatch, change = weights.mismatch(getattr(theirs, one.array), f)
    gains = one.gains(at, reacts)
    noise = {name: _noise(at, name, place) for name in {one.array, *(at.sources[part] for part in gains)}}
    by_row = [(one.array, np.linalg.norm(weights.row, axis=1))]

    def parts(phi: Array) -> list[tuple[str, Array]]:
        carried = ((at.sources[part], weights.gain(phi * g[place], at.estimates[part], place)) for part, g in gains.items())
        return list(carried)

    spread = spread_of(by_row + parts(weights.phi), noise)
    by_chance = spread_of(parts(weights.fewer), noise) if gains else np.zeros_like(spread)
    bias = np.maximum(change - _BEYOND * np.sqrt(f.shape[-1]) * by_chance, 0.0)
    for part, gain in gains.items():
        bias = bias + np.abs(weights.mean((gain * at.estimates[part].bias)[place]))
    if one.which is not None:
        bias = bias + np.abs(weights.mean(reacts.curvature_at(one.which, at.time)[place]))
    if one.array in theirs.doubts:
        bias = bias + _growth(theirs, one.array)[at.index][place].mean(axis=1)
    twice = 2.0 if one.turning else 1.0
    freedom = min(at.estimates[name].freedom for name in noise)
    mean = one.vectors(at, place, weights.mean(f))
    left = min(_left(weights, probe[place]) for probe in ([f_ for f_ in (one.rate(at, rates),)] + _probes(one, at)))
    return _Seen(one.vectors(at, place, mismatch), mean, twice * spread, twice * bias, freedom, left)


def _noise(at: Motion, name: str, place: Index) -> Array:
    """Return the standard deviation of means of an array in each window, per root of their number."""
    estimate = at.estimates[name]
    return np.asarray(np.sqrt(estimate.alike * (estimate.noise[place] ** 2).mean(axis=1)))


def _growth(theirs: Theirs, name: str) -> Array:
    """Return what a doubt about Ω leaves of its slope: it turns with Ω as the body does."""
    return theirs.doubts[name] * float(np.linalg.norm(getattr(theirs, name), axis=1).max())


def _probes(one: Comparison, at: Motion) -> list[Array]:
    return [at.velocity] if one.which is not None and not one.turning else []


def _left(weights: Weights, f: Array) -> float:
    """Return the share that a window's mean leaves of something that turns with f, as most mistakes do."""
    length = weights.mean(np.linalg.norm(f, axis=-1))
    mean = np.linalg.norm(weights.mean(f), axis=-1)
    return float(np.median(np.where(length > 0, mean / np.where(length > 0, length, 1.0), 1.0)))


def _size(name: str, system: RollingSystem, at: Motion, slopes: list[Array], rates: Rates) -> float:
    """Return what a residual is small beside, or not."""
    if name == TURN:
        return _largest(at.angular_velocity, *slopes)
    speed = _largest(at.velocity, np.cross(at.angular_velocity, at.offset), at.carried)
    if name == PATH:
        return speed
    weight = 1e-3 * float(np.max(Vector(*system.weight.acceleration).norm()))
    if name == ACCELERATION:
        return max(_largest(*slopes, rates[0]), 1e-2 * rate_of(system) * speed, weight)
    least = max(_largest(rates[0]), 1e-2 * rate_of(system) * speed, weight) / at.arm
    return max(least, _largest(*slopes, rates[1]))


def _contact(
    system: RollingSystem, theirs: Theirs, at: Motion, some: Index, tolerance: float, reacts: Sensitivity
) -> Iterator[Series]:
    """Yield gap and slip at some instants."""
    speed = _largest(at.velocity, np.cross(at.angular_velocity, at.offset), at.carried)
    if theirs.height_given:
        gap = gap_of(system, at.contact)[:, None]
        yield _at_instants(GAP, gap, at.arm, LIFTS, at, some, tolerance, reacts, "gap, share of the radius")
    if at.turning_known:
        yield _at_instants(SLIP, at.slip, speed, SLIPS, at, some, tolerance, reacts, "|V + Ω×ρ − u| over the speed")


def _at_instants(
    name: str,
    residual: Array,
    size: float,
    which: int,
    at: Motion,
    some: Index,
    tolerance: float,
    reacts: Sensitivity,
    note: str,
) -> Series:
    """Return the series of something that the states themselves must make zero."""
    gains, asked = reacts.gains_at(which, at.time), tolerance * size
    parts = [(at.sources[part], gain * at.estimates[part].spread) for part, gain in gains.items()]
    spread = spread_of(parts, {source: np.ones(1) for source, _ in parts})
    bias = reacts.curvature_at(which, at.time) + sum(gain * at.estimates[part].bias for part, gain in gains.items())
    freedom = min(at.estimates[part].freedom for part in gains)
    bound = asked + bias + longest(some.size, freedom, residual.shape[1]) * spread
    return Series(name, at.time[some], residual[some], size, bound[some], asked, note)


def _largest(*arrays: Any) -> float:
    return max(1e-300, *(float(np.linalg.norm(array, axis=1).max()) for array in arrays))
