"""The closed forms of `exact` as a method: each covers one phase of contact, and a run is a chain of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import OutOfDomainError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import touch
from ..mechanics.scalars import is_number
from ..mechanics.system import RollingSystem, State
from . import phases
from .exact import ClosedForm, SphereOnPlane, form_of_phase, refusals
from .first_stop import first_stop
from .following import Next, Stop
from .laws import Law
from .monodromy import Monodromy
from .orientation import orientation, periodic_orientation
from .phases import Stretch
from .samples import FLIGHT, SLIPPING, Array, Progress, Samples
from .touch import Touch

_PHASE_A_STEP = 0.05  # rad of the motion's own phase between two looks at what may end it
_AT_ONCE = 100_000
_PERIODS_WORTH_A_MONODROMY = 10.0  # to work one out takes ten times as long as to follow two circles
_BOUNDS = {"rim", "end", "edge", "curved"}  # which the place of the contact decides


def solve(
    system: RollingSystem, start: State, times: Array, tolerance: float = 0.0, progress: Progress | None = None
) -> Samples:
    """Follow a body through its phases by their closed forms; every event is located to the last digit.

    Parameters
    ----------
    system, start, times, progress
        As for `trundle.solve.taylor.solve`.
    tolerance : float
        Not used: a closed form is as exact as its numbers.

    Returns
    -------
    Samples
        At `times`, cut where the run ends early, with its events.

    Raises
    ------
    OutOfDomainError
        If no closed form covers a phase that the run comes to.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    >>> solve(system, system.place((0.1, 0.0)), np.array([0.0, 9.0])).position.tolist()
    [[0.1, 0.0, 0.025], [0.1, 0.0, 0.025]]
    """
    return phases.solve(integrate, system, start, times, tolerance, progress)


def integrate(
    system: RollingSystem,
    now: Next,
    times: Array,
    tolerance: float = 0.0,  # noqa: ARG001
    progress: Progress | None = None,
) -> Stretch:
    """Follow one law to its first stop by the closed form of its phase.

    Parameters
    ----------
    system, now, times, progress
        As for `trundle.solve.taylor.integrate`.
    tolerance : float
        Not used.

    Returns
    -------
    Stretch
        The samples at the times before the stop.

    Raises
    ------
    OutOfDomainError
        If no closed form covers the phase.
    """
    law, start = now.law, now.start
    form = form_of_phase(law.code, system, start, now.numbers)
    if form is None:
        raise OutOfDomainError(refusals(law.code, system, start))
    end = float(times[-1]) if times.size else now.time
    found = _first_stop(system, now, form, end - now.time)
    if found is None:
        samples = _samples(system, law, form, start, times, progress)
        return Stretch(times, np.empty((times.size, 0)), None, samples)
    reached = now.time + found[0]
    kept = times[times < reached]
    samples = _samples(system, law, form, start, np.append(kept, reached), progress)
    at = Touch.of(system, samples.state(-1), Vector(*samples.contact[-1].tolist()))
    stop = Stop(reached, found[1], np.array(law.numbers(at), dtype=float), at)
    return Stretch(kept, np.empty((kept.size, 0)), stop, samples.part(slice(0, kept.size)))


# What ends a stretch


def _first_stop(system: RollingSystem, now: Next, form: ClosedForm, duration: float) -> tuple[float, str] | None:
    """Return when and by which of the law's stops the form's motion ends, if it does within the duration."""
    names = now.law.stops(system, now.time, now.numbers, now.extras)
    known = {name: t for name, t in form.ends_at.items() if name in names and 0 <= t <= duration}
    sooner = min(((t, name) for name, t in known.items()), default=None)
    given = {*form.ends_at, *(f"near {name}" for name in form.ends_at), *form.never}
    asked = [name for name in names if name not in given]
    if not asked:
        return sooner
    upto = min(duration if sooner is None else sooner[0], 1.01 * max(form.repeats(name) for name in asked))
    pace = form.pace(upto)
    values = _values(system, now, form, asked)
    found = first_stop(values, upto, _PHASE_A_STEP / pace if pace > 0 else math.inf)
    return sooner if found is None else (found[0], asked[found[1]])


def _values(system: RollingSystem, now: Next, form: ClosedForm, asked: list[str]) -> Callable[[Any], Any]:
    """Return the stops asked for as functions of the time since the start.

    Where they depend on the orientation, the form says how the body stands; most are the same from all sides, or turn
    in their plane.
    """
    law, start = now.law, now.start
    at_start, only_bounds = Quaternion(*start.orientation), set(asked) <= _BOUNDS

    def at(t: Any) -> Any:
        (r, V, Omega, _), grown = form.motion_and_own_at(t)
        q = at_start if only_bounds else form.stance(t) or at_start
        own = tuple(of_start + gone for of_start, gone in zip(start.support, grown, strict=True))
        contact = touch(system, start.time + t, r, q, own)
        contact = replace(contact, point=r + contact.offset)
        if only_bounds:
            found = law._bounds(system, contact, q, 0.0)
        else:
            added: list[Any] = []
            if law.code == SLIPPING:
                s = contact.slip_velocity(V, Omega)
                added = [*(s - contact.normal * s.dot(contact.normal))]
            found = law.stops(system, start.time + t, [*contact.point, *q, *Omega, *added, *own], now.extras)
        if is_number(t):
            return [float(found[name]) for name in asked]
        return np.array([np.broadcast_to(found[name], np.shape(t)) for name in asked])

    return at


# Samples


def _samples(
    system: RollingSystem, law: Law, form: ClosedForm, start: State, times: Array, progress: Progress | None
) -> Samples:
    shape = (times.size, 3)
    position, velocity, turning, force = (np.empty(shape) for _ in range(4))
    own = np.empty((times.size, len(start.support)))
    for first in range(0, times.size, _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        parts, grown = form.motion_and_own_at(times[part] - start.time)
        for array, vector in zip((position, velocity, turning, force), parts, strict=True):
            array[part] = vector.array()
        for i, (of_start, gone) in enumerate(zip(start.support, grown, strict=True)):
            own[part, i] = of_start + gone
        if progress is not None:
            progress(0.5 * (start.time + float(times[part][-1])))
    q = orientations(form, start, times) if times.size else np.empty((0, 4))
    contact = _contact(system, law, times, position, q, own)
    if progress is not None and times.size:
        progress(float(times[-1]))
    phase: Any = np.full(times.size, law.code, dtype=np.int8)
    return Samples(times, position, contact, velocity, turning, q, force + 0.0, phase=phase, own=own, form=form)


def _contact(system: RollingSystem, law: Law, times: Array, position: Array, q: Array, own: Array) -> Array:
    """Return the contacts; in flight the points of the support nearest to the body."""
    centre = Vector.of(position)
    if law.code != FLIGHT:
        return position + touch(system, times, centre, Quaternion.of(q), tuple(own.T)).offset.array()
    surface, support = system.support.surface, system.support.motion.at(times, *own.T)
    there = support.rotation.transpose @ (centre - support.origin)
    return (centre - support.rotation @ surface.normal(there) * surface.level(there)).array()


def orientations(motion: ClosedForm, start: State, times: Array) -> Array:
    """Return the orientation at given times; where the motion repeats, any time costs what one circle costs.

    Parameters
    ----------
    motion : ClosedForm
        The motion.
    start : State
        Where it starts.
    times : array (n,)
        Ascending, s.

    Returns
    -------
    array (n, 4)
        Unit quaternions (w, x, y, z), body frame to support frame.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    >>> start = system.place((0.1, 0.0), (0.0, 0.2))
    >>> orientations(SphereOnPlane.of(system, start), start, np.array([0.0]))[0].tolist()
    [1.0, 0.0, 0.0, 0.0]
    """
    straight = motion.straight_turn(times - start.time)
    if straight is not None:
        axis, angle = straight
        half, q = np.broadcast_to(0.5 * np.asarray(angle), times.shape), Quaternion(*start.orientation)
        across = Quaternion(0.0, *axis) * q
        return np.multiply.outer(np.cos(half), q.array()) + np.multiply.outer(np.sin(half), across.array())

    def angular_velocity(t: Array) -> Array:
        Omega = motion.motion_at(t)[2]
        return np.stack(np.broadcast_arrays(Omega.x, Omega.y, Omega.z, t))[:3]

    def absolute(t: Array) -> Array:
        return angular_velocity(t - start.time)

    long = times[-1] - start.time > _PERIODS_WORTH_A_MONODROMY * motion.period
    if long and isinstance(motion, SphereOnPlane) and motion.torque[2] == 0:
        return periodic_orientation(angular_velocity, _monodromy(motion), times, start.orientation, start.time)
    return orientation(absolute, times, start.orientation, start.time)


def _monodromy(motion: SphereOnPlane) -> Monodromy:
    """Work out the rotation over one circle from numbers that start exact: a Ω = ω ζ_c + (ω − κ)(ζ − ζ_c)."""
    import mpmath

    with mpmath.workdps(40):
        number = mpmath.mpf
        precise = replace(
            motion,
            radius=number(motion.radius),
            mass=number(motion.mass),
            inertia_ratio=number(motion.inertia_ratio),
            rate=number(motion.rate),
            position=tuple(number(part) for part in motion.position),
            velocity=tuple(number(part) for part in motion.velocity),
        )
        centre = mpmath.mpc(*precise.guiding_centre(0))
        arm = mpmath.mpc(*precise.position) - centre
        turning = (precise.rate - precise.kappa) * arm / precise.radius
        return Monodromy.of_turning_vector(precise.rate * centre / precise.radius, turning, motion.spin, precise.kappa)
