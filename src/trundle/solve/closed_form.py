"""The closed forms of `exact` as a method: each covers one phase of contact, and a run is a chain of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ..errors import OutOfDomainError, SolverError, TurnsTooFastError
from ..mechanics.algebra import ZERO, Quaternion, Vector
from ..mechanics.contact import Contact, contact_at, normal_on
from ..mechanics.duals import value_of
from ..mechanics.motions import SupportState
from ..mechanics.nearest import closest_contact
from ..mechanics.records import frozen_record
from ..mechanics.scalars import is_number
from ..mechanics.system import RollingSystem, State
from . import phases
from .contact_state import ContactState, floats
from .exact import ClosedForm, form_of_phase, refusals
from .first_stop import first_stop
from .focal import ASIDE
from .laws import Law
from .orientation import orientation, periodic_orientation
from .phases import Segment, cut
from .samples import AT_ONCE, FLIGHT, RESTING, SLIPPING, Array, Progress, Samples
from .transitions import PhaseStart, ZeroCrossing

_PHASE_A_STEP = 0.05  # rad of the motion's own phase between two looks at what may end it
_SHORT = 1000  # samples of a stretch, up to which it is completed with those around it
_PERIODS_WORTH_A_MONODROMY = 10.0  # to work one out takes ten times as long as to follow two circles
_BOUNDS = {"rim", "end", "edge", "curved"}  # which the place of the contact decides


def solve(
    system: RollingSystem, start: State, times: Array, tolerance: float = 0.0, progress: Progress | None = None
) -> Samples:
    """Follow a body through its phases by their closed forms; every event is located to the last digit.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    >>> solve(system, system.place((0.1, 0.0)), np.array([0.0, 9.0])).position.tolist()
    [[0.1, 0.0, 0.025], [0.1, 0.0, 0.025]]
    """
    return phases.solve(integrate, system, start, times, tolerance, progress, in_steps=False)


def integrate(
    system: RollingSystem,
    now: PhaseStart,
    times: Array,
    tolerance: float = 0.0,  # noqa: ARG001
    progress: Progress | None = None,
) -> Iterator[Segment]:
    """Follow one law to its first stop by the closed form of its phase."""
    law, start = now.law, now.start
    form = form_of_phase(law.code, system, start, now.state_vector)
    if form is None:
        raise OutOfDomainError(refusals(law.code, system, start))
    end = float(times[-1]) if times.size else now.time
    found = _first_stop(system, now, form, end - now.time)
    if found is None:
        kept, stop = times, None
        q = orientations(form, start, times) if times.size else np.empty((0, 4))
    else:
        reached = now.time + found[0]
        kept, _ = cut(times, reached)
        q, there = _orientations_to(form, start, kept, reached)
        at = _place(system, law, form, start, found[0], there)
        stop = ZeroCrossing(reached, found[1], np.array(law.state_vector(at), dtype=float), at)
    along = ClosedFormSegment(law, form, start.time, start.support, together=kept.size <= _SHORT)
    last = max(kept.size - 1, 0) // AT_ONCE * AT_ONCE
    for first in range(0, last, AT_ONCE):
        block = slice(first, first + AT_ONCE)
        yield Segment(kept[block], q[block], None, along)
        if progress is not None:
            progress(float(kept[block][-1]))
    yield Segment(kept[last:], q[last:], stop, along)
    if progress is not None:
        progress(end if stop is None else stop.time)


def _place(system: RollingSystem, law: Law, form: ClosedForm, start: State, t: float, q: Quaternion) -> ContactState:
    """Return the body where the form takes it in a time, with the orientation there."""
    (r, V, Omega, _), grown = form.motion_and_support_at(t)
    coordinates = tuple(float(of_start + gone) for of_start, gone in zip(start.support, grown, strict=True))
    time = start.time + t
    state = State(floats(r), floats(V), floats(Omega), (q.w, q.x, q.y, q.z), time, coordinates)
    return ContactState.of(system, state, _contact(system, law, time, Vector(*state.position), q, coordinates))


# What ends a stretch


def _first_stop(system: RollingSystem, now: PhaseStart, form: ClosedForm, duration: float) -> tuple[float, str] | None:
    """Return when and by which of the law's events the form's motion ends, if it does within the duration."""
    names = _event_names(system, now)
    known = {name: t for name, t in form.ends_at.items() if name in names and 0 <= t <= duration}
    sooner = min(((t, name) for name, t in known.items()), default=None)
    given = form.ends_at.keys() | form.impossible_events
    asked = [name for name in names if name not in given and name.removeprefix("near ") not in form.ends_at]
    if not asked:
        return sooner
    upto = min(duration if sooner is None else sooner[0], 1.01 * max(form.repeats(name) for name in asked))
    values = _values(system, now, form, asked)
    looks = [(t, _PHASE_A_STEP / pace if pace > 0 else math.inf) for t, pace in form.max_rates(upto)]
    found = first_stop(values, looks)
    return sooner if found is None else (found[0], asked[found[1]])


def _event_names(system: RollingSystem, now: PhaseStart) -> tuple[str, ...]:
    """Return the names of a law's events, which are the same wherever it begins; they are asked for once."""
    key = _event_names, now.law.identity, len(now.event_parameters)
    if key not in system._known:
        system._known[key] = tuple(now.law.event_functions(system, now.time, now.state_vector, now.event_parameters))
    found: tuple[str, ...] = system._known[key]
    return found


def _values(system: RollingSystem, now: PhaseStart, form: ClosedForm, asked: list[str]) -> Callable[[Any], Any]:
    """Return the event functions asked for, as functions of the time since the start.

    Where they depend on the orientation, the form says how the body stands; most are the same from all sides, or turn
    in their plane.
    """
    law, start = now.law, now.start
    at_start, only_bounds = Quaternion(*start.orientation), set(asked) <= _BOUNDS

    def at(t: Any) -> Any:
        (r, V, Omega, _), grown = form.motion_and_support_at(t)
        q = at_start if only_bounds else form.representative_orientation(t) or at_start
        coordinates = tuple(of_start + gone for of_start, gone in zip(start.support, grown, strict=True))
        contact = contact_at(system, start.time + t, r, q, coordinates)
        contact = replace(contact, point=_point(system, law, contact, r))
        if only_bounds:
            found = law._bounds(system, contact, q, 0.0)
        else:
            added: list[Any] = []
            if law.code == SLIPPING:
                s = contact.slip_velocity(V, Omega)
                added = [*(s - contact.normal * s.dot(contact.normal))]
            found = law.event_functions(
                system, start.time + t, [*contact.point, *q, *Omega, *added, *coordinates], now.event_parameters
            )
        if is_number(t):
            return [float(found[name]) for name in asked]
        return np.array([np.broadcast_to(found[name], np.shape(t)) for name in asked])

    return at


# Samples


@frozen_record()
class ClosedFormSegment:
    """What completes the orientations at some times to samples: the closed form that the body follows from a start."""

    law: Law
    form: ClosedForm
    since: Any  # s; an array where the form's numbers are arrays
    support_coordinates: tuple[Any, ...]  # of the support's motion, then
    together: bool = True  # whether it is completed with others, which makes arrays of its numbers

    def joins(self, other: Any) -> bool:
        """Tell whether the next stretch has the same formula, so that arrays of its numbers give both."""
        if not (isinstance(other, ClosedFormSegment) and self.together and other.together and self.form.of_arrays):
            return False
        return type(other.form) is type(self.form) and other.law.code == self.law.code

    def record(self, system: RollingSystem, stretches: Sequence[Segment]) -> Samples:
        """Return the samples of this stretch, and of those that go on from it."""
        stretches = [stretch for stretch in stretches if stretch.times.size] or stretches[:1]  # no array of nothing
        sizes = [stretch.times.size for stretch in stretches]
        each: list[Any] = [stretch.known for stretch in stretches]
        form, since, coordinates = (
            _spread(values, sizes)
            for values in zip(*((one.form, one.since, one.support_coordinates) for one in each), strict=True)
        )
        together = ClosedFormSegment(self.law, form, since, coordinates)
        times = np.concatenate([stretch.times for stretch in stretches])
        samples = together.samples(system, times, np.concatenate([stretch.states for stretch in stretches]))
        return replace(samples, form=self.form)

    def samples(self, system: RollingSystem, times: Array, q: Array) -> Samples:
        """Return the samples at given times, at which the orientations are known."""
        parts, grown = self.form.motion_and_support_at(times - self.since)
        position, velocity, turning, force = (np.broadcast_to(part.array(), (times.size, 3)) for part in parts)
        coordinates = np.empty((times.size, len(self.support_coordinates)))
        for i, (of_start, gone) in enumerate(zip(self.support_coordinates, grown, strict=True)):
            coordinates[:, i] = of_start + gone
        contact = _contact(system, self.law, times, Vector.of(position), Quaternion.of(q), tuple(coordinates.T)).array()
        phase: Any = np.full(times.size, self.law.code, dtype=np.int8)
        return Samples(
            times,
            position,
            contact,
            velocity,
            turning,
            q,
            force + 0.0,
            phase=phase,
            support_coordinates=coordinates,
            form=self.form,
        )


def _spread(each: Sequence[Any], sizes: list[int]) -> Any:
    """Return one value like several of one kind: of what differs an array, each repeated as often as its size says."""
    first = each[0]
    if len(each) == 1:  # a form keeps what it has worked out
        return first
    if isinstance(first, ClosedForm):
        numbers = {part.name: [getattr(one, part.name) for one in each] for part in fields(first)}  # type: ignore[arg-type]
        return replace(first, **{name: _spread(values, sizes) for name, values in numbers.items()})  # type: ignore[type-var]
    if isinstance(first, tuple):
        return tuple(_spread(parts, sizes) for parts in zip(*each, strict=True))
    return first if all(_alike(one, first) for one in each) else np.repeat(each, sizes)


def _alike(one: Any, other: Any) -> bool:
    """Tell whether two values are the same; not a number, by which a form says that it has none, is like itself."""
    return bool(one == other or (one != one and other != other))


def _contact(
    system: RollingSystem, law: Law, time: Any, centre: Vector, q: Quaternion, coordinates: tuple[Any, ...]
) -> Vector:
    """Return the contact; in flight the point of the support nearest to the body."""
    if law.code == RESTING:  # any body, with another normal under its centre: once, as nothing moves
        first = (np.ravel(part)[0] for part in (time, *centre, *q, *coordinates))
        t, x, y, z, *rest = (float(part) for part in first)
        place = closest_contact(system, t, Vector(x, y, z), Quaternion(*rest[:4]), tuple(rest[4:])).point
        return place + ZERO * time
    if law.code == FLIGHT:
        support = system.support.motion.at(time, *coordinates)
        with np.errstate(divide="ignore", invalid="ignore"):
            found = _under(system, support, normal_on(system, support, centre), centre)
            known = np.isfinite(np.asarray(value_of(found.x), dtype=float))
            if known.all():
                return found
            # In the middle of a tube all sides are as near.
            aside = centre + Vector(1.0, 1.0, 1.0) * (ASIDE * abs(system.support.surface.level(support.local(centre))))
            other = _under(system, support, normal_on(system, support, aside), aside)
        return Vector(*(np.where(known, part, own) for part, own in zip(found, other, strict=True)))
    return centre + contact_at(system, time, centre, q, coordinates).offset


def _point(system: RollingSystem, law: Law, contact: Contact, centre: Vector) -> Vector:
    """Return p of a body whose normal at the contact is known."""
    return _under(system, contact.support, contact.normal, centre) if law.code == FLIGHT else centre + contact.offset


def _under(system: RollingSystem, support: SupportState, n: Vector, centre: Vector) -> Vector:
    """Return the point of the support straight under the centre."""
    return centre - n * system.support.surface.level(support.local(centre))


def _orientations_to(form: ClosedForm, start: State, times: Array, end: float) -> tuple[Array, Quaternion]:
    """Return the orientations at some times, and at the end after them: alone where that is a formula of its own."""
    straight = form.fixed_axis_rotation(end - start.time)
    if straight is None:
        q = orientations(form, start, np.append(times, end))
        return q[:-1], Quaternion.of(q[-1].tolist())
    axis, half = straight[0], 0.5 * straight[1]
    turned = axis * math.sin(half)
    there = Quaternion(*map(float, Quaternion(math.cos(half), *turned) * Quaternion(*start.orientation)))
    return orientations(form, start, times) if times.size else np.empty((0, 4)), there


def orientations(motion: ClosedForm, start: State, times: Array) -> Array:
    """Return the orientation at given times; where the motion repeats, any time costs what one circle costs.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.solve.exact import closed_form
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    >>> start = system.place((0.1, 0.0), (0.0, 0.2))
    >>> orientations(closed_form(system, start), start, np.array([0.0]))[0].tolist()
    [1.0, 0.0, 0.0, 0.0]
    """
    elapsed = times - start.time
    straight = motion.fixed_axis_rotation(elapsed)
    if straight is not None:
        axis, angle = straight
        half, q = 0.5 * angle + np.zeros_like(times), Quaternion(*start.orientation)
        both = np.array([[*q], [*(Quaternion(0.0, *axis) * q)]], dtype=float)
        return np.array([np.cos(half), np.sin(half)]).T @ both

    def angular_velocity(t: Array) -> Array:
        Omega = motion.angular_velocity_at(t)
        return np.stack(np.broadcast_arrays(Omega.x, Omega.y, Omega.z, t))[:3]

    long = elapsed[-1] > _PERIODS_WORTH_A_MONODROMY * motion.period
    monodromy = motion.monodromy() if long else None
    if monodromy is not None:
        return periodic_orientation(angular_velocity, monodromy, elapsed, start.orientation)
    try:
        return orientation(angular_velocity, elapsed, start.orientation)
    except SolverError as error:  # a method that takes steps may still follow it
        raise TurnsTooFastError(f"{error} A numerical method may do.") from None
