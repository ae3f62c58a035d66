"""The motion of somebody else against contact, constraint and law, each residual beside what it may be by chance."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...mechanics.algebra import Vector
from ...mechanics.system import RollingSystem, State
from ...verify.acting import cross
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
from .looking import Open, left_open, seen, share_left
from .motion import Instants, Motion, motion_of, rate_of
from .record import Array, ExternalTrajectory, gap_of
from .series import Series
from .slopes import SIGMAS, Index
from .windows import Plan, Weights, plans, spread_of, weights_of

LAW_SHARE = 10.0  # times the tolerance: an acceleration is a slope, and multiplies what a method leaves
GAP, SLIP = "touches the support", "no slip"
INSTANTS = 240  # looked at for gap and slip
_TRIAL = 8  # windows of each width on which the width is chosen
_AS_GOOD = 1.3  # times the least bound: of widths that tell as much the narrowest is taken
_DIMMEST = 0.05  # share of a mismatch that is left where it turns about within a window

_UNITS = {
    PATH: "share of the speed",
    TURN: "2 q̇ q* against Ω, share of Ω",
    ACCELERATION: "Newton, Euler and constraint as one 9×9 system",
    TURNING: "Newton, Euler and constraint as one 9×9 system",
}


@dataclass(frozen=True)
class _Looked:
    """Their motion at the nodes and instants of a view, and where among these each is."""

    at: Motion
    places: dict[str, Index]


@dataclass(frozen=True)
class _Seen:
    """What a comparison asks of their samples alone: its weights, the mean slope of what they wrote, what is open."""

    weights: Weights
    slope: Array
    open: Open
    moment: Array
    note: str


@dataclass(frozen=True)
class View:
    """How their motion is looked at: what is compared over which windows, and at which instants contact and slip are.

    It is found once, for the system as it was given; whoever asks for another law looks in the same way. What asks for
    no law is worked out once, too.
    """

    compared: tuple[tuple[Comparison, Plan], ...]
    instants: Index
    _known: dict[Any, Any] = field(default_factory=dict, compare=False, repr=False)

    def _once(self, key: tuple[Any, ...], of: tuple[Any, ...], found: Callable[[], Any]) -> Any:
        """Work something out once of objects that are told by their place in memory, and are kept for that."""
        key = (*key, *map(id, of))
        if key not in self._known:
            self._known[key] = found(), of
        return self._known[key][0]

    def looked(self, system: RollingSystem, theirs: ExternalTrajectory, start: State | None) -> _Looked:
        """Return their motion on a support: neither loads, gravity nor inertia matter to it."""

        def found() -> _Looked:
            windows = {one.name: plan.index for one, plan in self.compared}
            index, places = nodes_of(windows | {"": self.instants[None]})
            return _Looked(motion_of(system, theirs, start, index), places)

        parts = system.support.surface, system.support.motion, system.body.shape
        equal = tuple(part if _hashable(part) else None for part in parts)
        of = tuple(part for part, same in zip(parts, equal, strict=True) if same is None)
        return self._once(("looked", equal), (theirs, start, *of), found)

    def seen(
        self, one: Comparison, plan: Plan, theirs: ExternalTrajectory, looked: _Looked, reacts: Sensitivity
    ) -> _Seen:
        """Return what asks for no law, once it is known how the law reacts."""

        def found() -> _Seen:
            weights = self._once(
                ("weights", one.name), (theirs.time,), lambda: weights_of(plan, theirs.time, one.order)
            )
            open_ = left_open(one, weights, looked.at, looked.places[one.name], reacts)
            note = f"{_UNITS[one.name]}, means over {_span(theirs, plan)}"
            slope = weights.slope(getattr(theirs, one.array))
            return _Seen(weights, slope, open_, plan.moment(theirs.time), note)

        return self._once(("seen", one.name), (theirs, reacts), found)

    def series(
        self,
        one: Comparison,
        plan: Plan,
        system: RollingSystem,
        theirs: ExternalTrajectory,
        looked: _Looked,
        tolerance: float,
        reacts: Sensitivity,
        rates: Rates,
    ) -> Series:
        """Return what is left of a comparison."""

        def found() -> Series:
            kept = self.seen(one, plan, theirs, looked, reacts)
            now = seen(one, kept.weights, kept.slope, theirs, looked.at, looked.places[one.name], rates, kept.open)
            slope = now.mismatch + now.rate
            size = _size(one.name, system, looked.at, slope, rates)
            asked = _times(one.name) * tolerance * size
            bound = asked + now.bias + longest(len(now.spread), now.freedom) * now.spread
            motion = _largest(slope, now.rate)
            return Series(one.name, kept.moment, now.mismatch, size, bound, asked, kept.note, motion)

        return found() if one.which is not None else self._once((one.name, tolerance), (looked, reacts), found)

    def contact(
        self, system: RollingSystem, theirs: ExternalTrajectory, looked: _Looked, tolerance: float, reacts: Sensitivity
    ) -> tuple[Series, ...]:
        """Return gap and slip at the instants."""

        def found() -> tuple[Series, ...]:
            return tuple(_contact(system, theirs, looked.at, looked.places[""][0], tolerance, reacts))

        return self._once(("contact", tolerance), (looked, reacts), found)

    def thinned(self, count: int) -> View:
        """Return no more than some of the windows and instants."""
        some = np.unique(np.linspace(0, self.instants.size - 1, min(self.instants.size, 2 * count)).round().astype(int))
        return View(tuple((one, plan.thinned(count)) for one, plan in self.compared), self.instants[some])

    def fitting(self, theirs: ExternalTrajectory) -> View:
        """Return what of it can be looked at in changed samples, which may lack a part."""
        able = {(one.name, one.array) for one in comparisons(theirs)}
        kept = tuple(pair for pair in self.compared if (pair[0].name, pair[0].array) in able)
        return self if len(kept) == len(self.compared) else View(kept, self.instants, self._known)


def _hashable(part: Any) -> bool:
    try:
        hash(part)
    except TypeError:  # a part of somebody's own
        return False
    return True


def view_of(system: RollingSystem, theirs: ExternalTrajectory, tolerance: float, start: State | None) -> View:
    """Choose for each comparison the windows in which a wrong rate would show best."""
    n = theirs.time.size
    tried = {f"{i}": plan.thinned(_TRIAL) for i, plan in enumerate(plans(n))}
    whole = list(plans(n))
    index, places = nodes_of({name: plan.index for name, plan in tried.items()})
    at = motion_of(system, theirs, start, index)
    rates, reacts = independent_law(system, at), sensitivity(system, theirs, start, independent_law)
    best: dict[str, list[tuple[float, int, Comparison]]] = {}
    for one in comparisons(theirs):
        for i, (name, plan) in enumerate(tried.items()):
            weights = weights_of(plan, theirs.time, one.order)
            here = theirs, at, places[name]
            slope = weights.slope(getattr(theirs, one.array))
            found = seen(one, weights, slope, *here, rates, left_open(one, weights, *here[1:], reacts))
            asked = _times(one.name) * tolerance * _size(one.name, system, at, found.mismatch + found.rate, rates)
            left = max(share_left(one, weights, *here[1:], rates), _DIMMEST)
            bound = float(np.median(SIGMAS * found.spread + found.bias + asked)) / left
            best.setdefault(one.name, []).append((bound, i, one))
    chosen = []
    for entries in best.values():
        least = min(bound for bound, _, _ in entries)
        _, i, one = min((entry for entry in entries if entry[0] <= _AS_GOOD * least), key=lambda entry: entry[1])
        chosen.append((one, whole[i]))
    return View(tuple(chosen), np.unique(np.linspace(0, n - 1, min(n, INSTANTS)).round().astype(int)))


def examine(
    system: RollingSystem,
    theirs: ExternalTrajectory,
    tolerance: float,
    start: State | None,
    view: View,
    law: Law = independent_law,
    reacts: Sensitivity | None = None,
) -> tuple[dict[str, Series], Motion]:
    """Compare their motion with contact, constraint and law."""
    view = view.fitting(theirs)
    looked = view.looked(system, theirs, start)
    rates = law(system, looked.at)
    reacts = sensitivity(system, theirs, start, law) if reacts is None else reacts
    found = list(view.contact(system, theirs, looked, tolerance, reacts))
    found += [view.series(one, plan, system, theirs, looked, tolerance, reacts, rates) for one, plan in view.compared]
    return {series.name: series for series in found}, looked.at


def _span(theirs: ExternalTrajectory, plan: Plan) -> str:
    ends = theirs.time[plan.start + plan.width - 1] - theirs.time[plan.start]
    return f"{float(np.median(ends)):.3g} s"


def _times(name: str) -> float:
    return LAW_SHARE if name in (ACCELERATION, TURNING) else 1.0


def sensitivity(system: RollingSystem, theirs: ExternalTrajectory, start: State | None, law: Law) -> Sensitivity:
    """Return what errors of their states do to V̇, Ω̇, slip and gap."""
    n = theirs.time.size
    few = np.unique(np.linspace(0, n - 1, min(n, SHIFTED)).round().astype(int))

    def asked(states: Instants) -> tuple[Array, ...]:
        return (*law(system, states), states.slip, gap_of(system, states.contact))

    return sensitivity_of(system, asked, motion_of(system, theirs, start, few))[0]


def _size(name: str, system: RollingSystem, at: Motion, slope: Array, rates: Rates) -> float:
    """Return what a residual is small beside, or not; never nothing, where something might move."""
    if name == TURN:
        return _largest(at.angular_velocity, slope)
    speed = _largest(at.velocity, cross(at.angular_velocity, at.offset), at.carried)
    if name == PATH:
        return speed
    weight = 1e-3 * float(np.max(Vector(*system.weight.acceleration).norm()))
    if name == ACCELERATION:
        return max(_largest(slope, rates[0]), 1e-2 * rate_of(system) * speed, weight)
    least = max(_largest(rates[0]), 1e-2 * rate_of(system) * speed, weight) / at.arm
    return max(least, _largest(slope, rates[1]))


def _contact(
    system: RollingSystem, theirs: ExternalTrajectory, at: Motion, some: Index, tolerance: float, reacts: Sensitivity
) -> Iterator[Series]:
    """Yield gap and slip at some instants."""
    speed = _largest(at.velocity, cross(at.angular_velocity, at.offset), at.carried)
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
    gains = {part: gain for part, gain in reacts.gains_at(which, at.time).items() if part in at.estimates}
    asked = tolerance * size
    parts = [(at.sources[part], gain * at.estimates[part].spread) for part, gain in gains.items()]
    spread = spread_of(parts, {source: np.ones(1) for source, _ in parts})
    bias = reacts.curvature_at(which, at.time) + sum(gain * at.estimates[part].bias for part, gain in gains.items())
    freedom = min(at.estimates[part].freedom for part in gains)
    bound = asked + bias + longest(some.size, freedom, residual.shape[1]) * spread
    return Series(name, at.time[some], residual[some], size, bound[some], asked, note)


def _largest(*arrays: Any) -> float:
    return max(1e-300, *(float(np.linalg.norm(array, axis=1).max()) for array in arrays))
