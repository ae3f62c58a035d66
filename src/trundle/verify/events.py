"""Each event by itself: whether what made it happen was so at its instant, no sooner and no later.

The states just before and just after come from the method run again at these instants; the figures on the normal force,
on friction and on the gap say that no event was missed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise
from types import MappingProxyType
from typing import Any

import numpy as np

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import contact_at, roll
from ..mechanics.duals import value_of
from ..mechanics.kinks import Kink
from ..mechanics.overlap import TOUCHING
from ..mechanics.slipping import slip
from ..mechanics.system import RollingSystem, State
from ..solve.contact_state import ContactState
from ..solve.samples import FLIGHT, RESTING, ROLLING, SLIPPING, Event, Samples
from ..solve.transitions import JOLT
from ..solve.walls import WALL, reach, slack
from .acting import acting, cross
from .bounds import A_STEP, SINGULAR, SOLVER, Array, blur_of, largest, sizes_of
from .card import CardFigure
from .each_sample import EachSample, Shares, worst_of
from .friction import holding, normal_and_friction

_SLACK = 1e-8  # by which static friction and resistance hold more than they say (docs/phases.md), and rounding
_SHORT = 2e-6  # a run stops a millionth short of an end at which the law is singular
_CLOSE = 100.0  # roundings of the clock: no step is shorter than ten, and one leads a tenth of the way to such an end
_UNSURE = 4.0  # times a square that rises towards such an end is not known: it can only fall
_MOST = 1000  # events looked at
_GOES_ON = 100.0  # times the bound: a run goes straight on from where slip or turning has all but ended
_STRIKES = ("land", "settle", JOLT)
_BROKEN = ("lift", "slip")  # by forces that jump where the acceleration of the support does
_ANY, _TOUCHING = frozenset(range(4)), frozenset((ROLLING, SLIPPING, RESTING))
# What an event may lie between: the phases before it and after it.
_BETWEEN = {
    "slip": (_TOUCHING, {SLIPPING}),
    "grip": ({SLIPPING, RESTING}, {ROLLING}),
    "lift": (_TOUCHING, {FLIGHT}),
    "land": ({FLIGHT}, _ANY),
    "settle": ({FLIGHT}, _TOUCHING),
    JOLT: (_TOUCHING, _ANY),
    "stop": ({ROLLING, SLIPPING}, {RESTING}),
    "start": ({RESTING}, {ROLLING}),
}


def instants_of(events: tuple[Event, ...], begin: float, kinks: Sequence[Kink] = ()) -> Array:
    """Return the last instant before each event and its own, s: where the method run again is asked for them.

    So it is at both sides of kinks of the support's motion, where the body's may jump by an event only.

    Examples
    --------
    >>> instants_of((Event(1.0, "lift", ""),), 0.0).tolist() == [np.nextafter(1.0, 0.0), 1.0]
    True
    """
    times = np.array([event.time for event in _looked_at(events)])
    sides = [side for kink in kinks[:_MOST] for side in (kink.before, kink.behind)]
    both = np.concatenate([np.nextafter(times, -np.inf), times, sides])
    return both[both >= begin]


def _looked_at(events: tuple[Event, ...]) -> tuple[Event, ...]:
    """Return the events of the first instants of a run, no more than are looked at."""
    return events[:_MOST]


@dataclass(frozen=True)
class AtEvents:
    """The events of a run beside the method's states at their instants.

    Examples
    --------
    See `trundle.verify.card`.
    """

    system: RollingSystem  # what moved
    again: Samples  # the method run again, at `instants_of` its events and at other times
    bound: float  # the share that the method may be off
    kinks: Sequence[Kink] = ()  # of the support's motion

    def figures(self) -> Iterator[CardFigure]:
        """Yield the figure, if anything happened."""
        events = _looked_at(self.again.events)
        found = [one for _, group in groupby(events, key=lambda event: event.time) for one in self._group(list(group))]
        found += [one for kink in self.kinks[:_MOST] for one in self._at_kink(kink)]
        if not found:
            return
        conditions = [Shares(f"{event.kind}: {what}", np.array([share]), bound) for event, what, share, bound in found]
        worst = max(range(len(found)), key=lambda i: conditions[i].ratio[0])
        looked = f"{len(events)} event{'s' if len(events) != 1 else ''}"
        said = f"{looked}: N = 0 at lift, |f| = μN at slip, s = 0 at grip, gap 0 at landing; no jump but by impact"
        yield worst_of("events at their instants", [conditions[worst]], np.array([found[worst][0].time]), said)

    @cached_property
    def _sizes(self) -> dict[str, float]:
        sizes = sizes_of(self.system, self.again)
        return {**sizes, "position": sizes["position"] + self._arm, "orientation": 1.0}

    @cached_property
    def _speed(self) -> float:
        """The fastest speed, or what the forces make of one within the body's size, m/s."""
        pull = self._sizes["contact_force"] / float(self.system.body.mass)
        return float(max(self._sizes["velocity"], np.sqrt(pull * self._arm)))

    @cached_property
    def _own(self) -> float:
        """The largest of the support's own angle and rate."""
        return float(np.abs(self.again.support_coordinates).max(initial=0.0))

    @cached_property
    def _arm(self) -> float:
        return largest(self.again.contact - self.again.position)

    def _sample(self, time: float) -> Samples | None:
        """Return the sample at an instant, if there is one."""
        at = int(np.searchsorted(self.again.time, time))
        known = at < self.again.time.size and self.again.time[at] == time
        return self.again.part(slice(at, at + 1)) if known else None

    def _group(self, group: list[Event]) -> Iterator[tuple[Event, str, float, float]]:
        """Yield the conditions of events that happen at one instant: event, name, share, bound."""
        time, kink = group[0].time, self._kink_at(group[0].time)
        since = float(np.nextafter(time, -np.inf)) if kink is None else kink.before
        before, after = self._sample(since), self._sample(time)
        for event in group:
            if event.before is not None and event.kind not in _STRIKES:
                yield from self._same(event, event.before, event.after, "no jump")
        for event, other in pairwise(group):
            yield from self._same(other, event.after, other.before, "no jump")
        first, last = group[0], group[-1]
        if before is not None:
            changing = self._in_a_moment(before, time - since)
            if first.kind in SINGULAR:  # V and Ω go with the root of the time left: twice as far as their rates say
                changing = {name: 2 * share for name, share in changing.items()}
            yield from self._same(first, before.state(0), first.before, "no jump before", changing)
            yield from self._met(first, before, changing)
        if last.final:
            return
        if after is not None:
            yield from self._same(last, last.after, after.state(0), "no jump after", self._begun(last))
        if before is not None and after is not None:
            may, then = _BETWEEN.get(first.kind, (_ANY, _ANY))[0], _BETWEEN.get(last.kind, (_ANY, _ANY))[1]
            fits = int(before.phase[0]) in may and int(after.phase[0]) in then
            yield first, "the phases that it lies between", 0.0 if fits else np.inf, 1.0

    def _at_kink(self, kink: Kink) -> Iterator[tuple[Event, str, float, float]]:
        """Yield whether a kink of the support's motion at which nothing happened leaves the body's alone."""
        before, after = self._sample(kink.before), self._sample(kink.behind)
        if before is None or after is None or any(kink.before < e.time <= kink.behind for e in self.again.events):
            return
        none = Event(kink.time, JOLT, "nothing happened")
        changing = self._in_a_moment(before, kink.behind - kink.before)
        yield from self._same(none, before.state(0), after.state(0), "no jump without an event", changing)

    def _kink_at(self, time: float) -> Kink | None:
        """Return the kink of the support's motion at an instant, if there is one."""
        return next((kink for kink in self.kinks if kink.before < time <= kink.behind), None)

    def _begun(self, event: Event) -> dict[str, float]:
        """Return by what shares V and Ω jump where a resistance gives way: to the least turn that has a direction."""
        if event.kind != "start" or event.after is None:
            return {}
        at = ContactState.of(self.system, event.after, None if event.contact is None else Vector(*event.contact))
        first = float(value_of(at.first_turn(self.system)))
        turns = {"velocity": first * self._arm, "angular_velocity": first}
        return {name: turn / max(self._sizes[name], 1e-300) for name, turn in turns.items()}

    def _in_a_moment(self, at: Samples, span: float = 0.0) -> dict[str, float]:
        """Return by what shares the state changes while the clock, the place, or the lean is not told apart.

        Where the support becomes as hollow as the body is round V and Ω change a million times as fast as the place;
        so does the place beside the lean where a body all but lies flat.
        """
        F, K, J, gyroscopic = (part[0] for part in acting(self.system, at))
        R, V, Omega, sizes = at.contact_force[0], at.velocity[0], at.angular_velocity[0], self._sizes
        pace = np.linalg.norm(V) / sizes["position"] + np.linalg.norm(Omega)
        moment = span + np.spacing(abs(float(at.time[0]))) + A_STEP * self.bound / SOLVER / max(float(pace), 1e-300)
        turned = np.linalg.solve(J, K - gyroscopic + cross(at.contact[0] - at.position[0], R))
        rates = {
            "position": V,
            "velocity": (F + R) / float(self.system.body.mass),
            "angular_velocity": turned,
            "orientation": 0.5 * Omega,
        }
        motion = self.system.support.motion
        if motion.free:
            lever = _row(at.support(self.system).lever(Vector.of(at.contact)))
            rates["support"], sizes = lever @ R / float(motion.inertia), {**sizes, "support": self._own}
        changed = {name: float(np.linalg.norm(rate)) * moment for name, rate in rates.items()}
        blur = blur_of(self.system, at)
        changed["position"] += blur
        changed["velocity"] += blur * float(np.linalg.norm(Omega))
        shares = {name: change / max(sizes[name], 1e-300) for name, change in changed.items()}
        return {**shares, "force": float(pace) * moment}

    def _same(
        self,
        event: Event,
        one: State | None,
        other: State | None,
        what: str,
        changing: Mapping[str, float] = MappingProxyType({}),
    ) -> Iterator[tuple[Event, str, float, float]]:
        """Yield how far two states of one instant are apart."""
        if one is None or other is None:
            return
        for field, size in self._sizes.items():
            if field == "contact_force":
                continue
            apart = float(np.linalg.norm(np.subtract(getattr(one, field), getattr(other, field))))
            allowed = _GOES_ON * self.bound + changing.get(field, 0.0)
            yield event, f"{what} of the {field.replace('_', ' ')}", apart / max(size, 1e-300), allowed
        if one.support:
            apart = float(np.abs(np.subtract(one.support, other.support)).max())
            allowed = _GOES_ON * self.bound + changing.get("support", 0.0)
            yield event, f"{what} of the support", apart / max(self._own, 1e-300), allowed

    def _met(
        self, event: Event, at: Samples, changing: Mapping[str, float]
    ) -> Iterator[tuple[Event, str, float, float]]:
        """Yield whether the condition of an event was met just before it, but for what changed since."""
        phase, each = int(at.phase[0]), EachSample(self.system, at, self.bound)
        if event.final:
            yield from self._ended(event, at, each)
            return
        kink = self._kink_at(event.time)
        if event.kind == JOLT:
            jumps = kink is not None and self._jumps(event, kink)
            yield event, "the velocity of the support jumps", 0.0 if jumps else np.inf, 1.0
            return
        if kink is not None and event.kind in _BROKEN and phase in (ROLLING, SLIPPING):
            yield event, "no contact bears the forces behind it", self._borne(kink, at), _SLACK + _GOES_ON * self.bound
            return
        if phase == FLIGHT:
            apart, height = each.apart
            gap = abs(float(apart[0] @ each.normals[0])) + abs(float(height[0]))
            allowed = _GOES_ON * self.bound + changing["position"] + changing["orientation"]
            yield event, "gap 0", gap / self._sizes["position"], allowed
            return
        N, f = (np.asarray(part)[0] for part in normal_and_friction(self.system, at))
        force = max(self._sizes["contact_force"], 1e-300)
        if event.kind == "lift":
            fast = float(self.system.body.mass) * float(np.linalg.norm(at.velocity[0])) ** 2 / self._arm
            share = self._pulled(phase, float(N), f) / max(force, fast)  # of what holds a body that fast on a path
            yield event, "N = 0", share, _GOES_ON * self.bound + changing["force"]
        elif phase == SLIPPING:
            what, share, allowed = self._slipped(event, at, each)
            yield event, what, share, allowed + changing["velocity"] + changing["angular_velocity"]
        elif phase == RESTING and event.kind != "slip":
            yield event, "the resistance is overcome", self._short_of_turning(at), _SLACK
        elif event.kind == "slip":
            allowed = _SLACK + _GOES_ON * self.bound + changing["force"]
            yield event, "|f| = μN", self._short_of_slipping(float(N), f) / force, allowed
        elif event.kind == "stop":
            allowed = _GOES_ON * self.bound + changing["angular_velocity"]
            yield event, "it no longer turns", self._turning(at, each), allowed

    def _borne(self, kink: Kink, at: Samples) -> float:
        """Return how much more a body that goes on behind a kink as before it could push or rub, as a share."""
        p, q, Omega, own = (
            Vector(*at.contact[0]),
            Quaternion(*at.orientation[0]),
            Vector(*at.angular_velocity[0]),
            at.support_coordinates[0].tolist(),
        )
        if int(at.phase[0]) == SLIPPING:
            s = Vector(*EachSample(self.system, at, self.bound).slip[0])
            left = float(slip(self.system, kink.behind, p, q, Omega, s, tuple(own)).normal_force)
        else:
            now = roll(self.system, kink.behind, p, q, Omega, tuple(own))
            N = float(now.reaction.dot(now.contact.normal))
            f = _row(now.reaction - now.contact.normal * N)
            left = N if self.system.support.friction is None else min(N, self._short_of_slipping(N, f))
        return max(left, 0.0) / max(self._sizes["contact_force"], 1e-300)

    def _jumps(self, event: Event, kink: Kink) -> bool:
        """Tell whether the support's velocity where it touches, or its turning, jumps at a kink."""
        assert event.before is not None  # noqa: S101  a jolt has both
        assert event.contact is not None  # noqa: S101
        motion, p = self.system.support.motion, Vector(*event.contact)
        one, other = (motion.at(time, *event.before.support) for time in (kink.before, kink.behind))
        jump = _row(other.material_velocity(p) - one.material_velocity(p))
        turned = _row(other.angular_velocity - one.angular_velocity)
        return bool(np.linalg.norm(jump) + np.linalg.norm(turned) * self._arm > self.bound * self._speed)

    def _turning(self, at: Samples, each: EachSample) -> float:
        """Return how fast a body turns over the support, as a share of how fast it does, or its forces let it."""
        relative = at.angular_velocity[0] - _row(at.support(self.system).angular_velocity)
        over = float(np.linalg.norm(relative - (relative @ each.normals[0]) * each.normals[0]))
        return over / max(self._sizes["angular_velocity"], self._speed / self._arm)

    def _slipped(self, event: Event, at: Samples, each: EachSample) -> tuple[str, float, float]:
        """Return what ended a way of slipping: the slip, or against resistance the turning, or its being held."""
        if "began to turn" in event.text:
            return "the resistance is overcome", self._short_of_turning(at), _SLACK
        if "stopped turning" in event.text:
            return "it no longer turns", self._turning(at, each), _GOES_ON * self.bound
        return "s = 0", float(np.linalg.norm(each.slip[0])) / self._speed, _GOES_ON * self.bound

    def _short_of_turning(self, at: Samples) -> float:
        """Return the share by which resistance could have held more than it was asked for."""
        couple, N = holding(self.system, at)
        most = float(self.system.resistance) * float(N[0])
        return (most - float(np.linalg.norm(couple[0]))) / max(most, 1e-300)

    def _short_of_slipping(self, N: float, f: Array) -> float:
        """Return by how much friction could have given more than it was asked for, N."""
        mu = self.system.support.friction
        return np.inf if mu is None else float(mu) * N - float(np.linalg.norm(f))

    def _pulled(self, phase: int, N: float, f: Array) -> float:
        """Return how far N is from 0 at a lift; one that follows slip that would pull begins where slip does."""
        gives_way = phase == ROLLING and self.system.support.friction is not None
        return min(abs(N), abs(self._short_of_slipping(N, f))) if gives_way else abs(N)

    def _ended(self, event: Event, at: Samples, each: EachSample) -> Iterator[tuple[Event, str, float, float]]:
        """Yield whether a run ended where it says."""
        surface, support = self.system.support.surface, at.support(self.system)
        if event.kind == "rim":
            there = support.local(Vector.of(at.contact))
            off = np.hypot(_number(there.x), _number(there.y)) - _number(surface.rim)
            yield event, "at the rim", abs(float(off)) / self._sizes["position"], _GOES_ON * self.bound
        elif event.kind in ("end", "edge", "curved"):
            left, then = self._left(event, at), self._sample(event.time)
            # It goes with the root of the time that is left: its square evenly with the time, and with the state.
            allowed = _SHORT + (float(np.sqrt(self.bound)) if event.kind == "curved" else 0.0)
            if then is not None:
                fallen = left**2 - self._left(event, then) ** 2
                allowed += float(np.sqrt(_CLOSE * fallen if fallen > 0 else -_UNSURE * fallen))
            yield event, "1 + C S singular" if event.kind == "curved" else "at the end", abs(left), allowed
        elif event.kind == WALL:
            then, allowed = self._sample(event.time), 2 * slack(self.bound / SOLVER)
            touches = then is None or float(reach(self.system, then)[0]) > TOUCHING / 2
            below = float(reach(self.system, at)[0])  # over a rim it may be deeper at once
            yield event, "another part touches, and not before", below if touches else np.inf, allowed
        elif event.kind == "spot":
            yield event, "it no longer turns", self._turning(at, each), _GOES_ON * self.bound

    def _left(self, event: Event, at: Samples) -> float:
        """Return how much is left of what ends a run."""
        q, support = Quaternion.of(at.orientation), at.support(self.system)
        if event.kind == "end":
            return _number(self.system.support.surface.domain_margin(support.local(Vector.of(at.contact))))
        if event.kind == "edge":
            nu = -(q.matrix().transpose @ Vector.of(at.normals(self.system)))
            return _number(self.system.body.shape.validity_margin(nu))
        contact = contact_at(self.system, at.time, Vector.of(at.contact), q, at.support_columns)
        each = EachSample(self.system, at, self.bound)
        gap = float(each.apart[0][0] @ each.normals[0]) if each.flies[0] else 0.0
        return _number(contact.relative_curvature_determinant(gap))


def _number(value: Any) -> float:
    return np.inf if value is None else float(np.asarray(value, dtype=float).ravel()[0])


def _row(v: Vector) -> Array:
    return np.array([_number(part) for part in v])
