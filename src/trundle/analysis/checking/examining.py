"""The motion of somebody else against contact, constraint and law, each residual beside what it may be by chance."""

from __future__ import annotations

from collections.abc import Iterator
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
class View:
    """How their motion is looked at: what is compared over which windows, and at which instants contact and slip are.

    It is found once, for the system as it was given; whoever asks for another law looks in the same way.
    """

    compared: tuple[tuple[Comparison, Plan], ...]
    instants: Index
    _known: dict[Any, Any] = field(default_factory=dict, compare=False, repr=False)

    def open(
        self, one: Comparison, plan: Plan, theirs: ExternalTrajectory, at: Motion, place: Index, reacts: Sensitivity
    ) -> tuple[Weights, Open]:
        """Return the weights of a comparison, and what it leaves open; neither asks for the law, once it reacts."""
        key = (one.name, id(theirs), id(reacts))
        if key not in self._known:  # with what it was worked out of, so that nothing else takes its place in memory
            weights = weights_of(plan, theirs.time, one.order)
            self._known[key] = weights, left_open(one, weights, at, place, reacts), theirs, reacts
        return self._known[key][:2]

    def thinned(self, count: int) -> View:
        """Return no more than some of the windows and instants."""
        some = np.unique(np.linspace(0, self.instants.size - 1, min(self.instants.size, 2 * count)).round().astype(int))
        return View(tuple((one, plan.thinned(count)) for one, plan in self.compared), self.instants[some])

    def fitting(self, theirs: ExternalTrajectory) -> View:
        """Return what of it can be looked at in changed samples, which may lack a part."""
        able = {(one.name, one.array) for one in comparisons(theirs)}
        return View(
            tuple(pair for pair in self.compared if (pair[0].name, pair[0].array) in able), self.instants, self._known
        )


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
            found = seen(one, weights, *here, rates, left_open(one, weights, *here[1:], reacts))
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
    windows = {one.name: plan.index for one, plan in view.compared}
    index, places = nodes_of(windows | {"": view.instants[None]})
    at = motion_of(system, theirs, start, index)
    rates = law(system, at)
    reacts = sensitivity(system, theirs, start, law) if reacts is None else reacts
    found = list(_contact(system, theirs, at, places[""][0], tolerance, reacts))
    for one, plan in view.compared:
        weights, open_ = view.open(one, plan, theirs, at, places[one.name], reacts)
        one_ = seen(one, weights, theirs, at, places[one.name], rates, open_)
        slope = one_.mismatch + one_.rate
        size = _size(one.name, system, at, slope, rates)
        asked = _times(one.name) * tolerance * size
        bound = asked + one_.bias + longest(len(one_.spread), one_.freedom) * one_.spread
        note = f"{_UNITS[one.name]}, means over {_span(theirs, plan)}"
        motion = _largest(slope, one_.rate)
        found.append(Series(one.name, plan.moment(theirs.time), one_.mismatch, size, bound, asked, note, motion))
    return {series.name: series for series in found}, at


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
