"""A run beside another: the same method again, and a closed form beside a numerical method."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ..errors import OutOfDomainError
from ..mechanics.algebra import E_X, E_Z, Quaternion, Vector
from ..mechanics.contact import settle
from ..mechanics.system import RollingSystem, State
from ..solve.exact import ClosedForm
from ..solve.methods import Method
from ..solve.samples import Samples
from .bounds import EXACT, SOLVER, bound_of, largest, sizes_of, turned_in
from .card import CardFigure, checked

_INSTANTS = 200
_MOST_RADIANS = 50_000.0  # of turning that a cross-check follows
_NUDGE = 1e-10  # of the largest Ω: small beside a motion that magnifies it a billionfold, large beside rounding
_A_STEP = 10.0  # times its tolerance that a method may err in a step


def same_again(system: RollingSystem, start: State, ours: Samples, again: Samples, method: Method) -> CardFigure:
    """Compare samples with the same method run again: then what is checked of that run holds for them.

    Parameters
    ----------
    system : RollingSystem
        What moved.
    start : State
        Where it started.
    ours, again : Samples
        The samples, and the second run at their times and others.
    method : Method
        Of both.

    Returns
    -------
    CardFigure
        The largest difference, as a share.
    """
    theirs = again.part(np.clip(np.searchsorted(again.time, ours.time), 0, again.time.size - 1))
    known = theirs.time == ours.time
    ours, theirs = ours.part(known), theirs.part(known)
    turned, sizes = turned_in(ours), sizes_of(system, ours)
    sizes |= {"contact": sizes["position"], "contact_force": largest(ours.contact_force)}
    side = np.sign((ours.orientation * theirs.orientation).sum(axis=1, keepdims=True))  # q and −q are one rotation
    angle = largest(ours.orientation - side * theirs.orientation)
    rounding = max(EXACT, 1e-15 * turned, 100 * method.tolerance * turned)  # of an angle, which adds up
    bound = bound_of(method, turned)
    share = max(_difference(ours, theirs, sizes), angle * bound / rounding)
    bound, grown = _allowing_growth(share, bound, system, start, ours, method, sizes)
    note = f"gives the same motion, force and orientation at {known.sum()} instants{grown}"
    return checked("the method run again", share, bound, note)


def cross_check(
    system: RollingSystem, start: State, at: Samples, method: Method, motion: ClosedForm | None
) -> Iterator[CardFigure]:
    """Compare a closed form with a numerical method, whichever of the two made the run.

    Parameters
    ----------
    system, start, at, method
        As for `same_again`.
    motion : ClosedForm or None
        None: there is nothing to compare with.

    Yields
    ------
    CardFigure
        For motion and for orientation.
    """
    if motion is None:
        return
    from ..solve.taylor import available

    closed = method.name == "exact"
    other = Method.of(("taylor" if available() else "runge-kutta") if closed else "exact")
    numerical = other if closed else method
    span, speed = float(at.time[-1] - start.time), largest(at.angular_velocity)
    times = start.time + np.linspace(0.0, min(span, _MOST_RADIANS / max(speed, 1e-300)), _INSTANTS)
    try:
        ours, theirs = (one.solve(system, start, times) for one in (method, other))
    except OutOfDomainError:  # the run comes into a phase that no closed form covers
        return
    count = min(theirs.time.size, ours.time.size)  # one may reach the rim first, by a rounding
    ours, theirs = ours.part(slice(0, count)), theirs.part(slice(0, count))
    turned = speed * float(ours.time[-1] - start.time)
    name = f"closed form against {'Taylor' if numerical.name == 'taylor' else 'Runge-Kutta'}"
    difference, bound = _difference(ours, theirs, sizes_of(system, ours)), bound_of(numerical, turned)
    turn = Quaternion.of(ours.orientation) * Quaternion.of(theirs.orientation).conjugate
    angle = 2 * largest(turn.array()[:, 1:])
    allowed = 100 * numerical.tolerance * max(10.0, turned)  # the error of Ω added up over the turning
    share = max(difference, angle * bound / allowed)
    wider, grown = _allowing_growth(share, bound, system, start, ours, numerical, sizes_of(system, ours))
    over = f"over {ours.time[-1] - start.time:g} s, {count} instants"
    yield checked(name, difference, wider, f"position, velocity, Ω; {over}{grown}")
    alone = "; exact from the place alone" if motion.straight_turn(0.0) is not None else ""
    note = f"angle between the two, after {turned:.3g} rad{alone}"
    yield checked(f"{name}, orientation", angle, allowed * wider / bound, note, "rad")


def _difference(ours: Samples, theirs: Samples, sizes: dict[str, float]) -> float:
    """Return the largest difference as a share of the quantity's size."""
    return max(
        largest(getattr(ours, field) - getattr(theirs, field)) / max(size, 1e-300) for field, size in sizes.items()
    )


def _allowing_growth(
    share: float,
    bound: float,
    system: RollingSystem,
    start: State,
    at: Samples,
    method: Method,
    sizes: dict[str, float],
) -> tuple[float, str]:
    """Widen a bound by what the motion itself does to a small difference, where the plain bound does not hold.

    A numerical method errs a little at each step, about one a radian, and these errors add up as a random walk; then
    the motion magnifies them. How much, a run from a start changed by a known little shows.
    """
    if share <= bound:
        return bound, ""
    magnified = _magnified(system, start, at, method, sizes)
    wider = bound * max(1.0, _A_STEP * magnified * np.sqrt(max(turned_in(at), 1.0)) / SOLVER)
    return (wider, f"; a change of the start shows {magnified:.2g} times larger") if wider > bound else (bound, "")


def _magnified(system: RollingSystem, start: State, at: Samples, method: Method, sizes: dict[str, float]) -> float:
    """Return how many times larger than in Ω of the start a small change shows in the motion."""
    span = float(at.time[-1] - at.time[0])
    size = max(largest(at.angular_velocity), 1 / max(span, 1e-300))
    times = np.union1d(at.time[:: max(1, at.time.size // _INSTANTS)], at.time[-1:])
    starts = [start, *_nudged(system, start, _NUDGE * size)]
    first, *others = (method.solve(system, begin, times) for begin in starts)
    found = []
    for other in others:
        count = min(first.time.size, other.time.size)
        one, changed = (run.part(slice(0, count)) for run in (first, other))
        found.append(_difference(one, changed, sizes) / _NUDGE)
    return max(found)


def _nudged(system: RollingSystem, start: State, change: float) -> list[State]:
    """Return starts that roll a little differently: along the axis of a cylinder, or else each way a body can turn."""
    q, Omega = Quaternion(*start.orientation), Vector(*start.angular_velocity)
    contact = settle(system, start.time, Vector(*start.position), q, start.support)
    n, axis = contact.normal, system.body.shape.axis
    first = n.cross(E_X if abs(n.x) < 0.9 else E_Z)
    first = first / first.norm()
    found = []
    for way in (first, n.cross(first), n) if axis is None else (q.matrix() @ axis,):
        turned = Omega + way * change
        rolling = contact.rolling_velocity(turned)
        (vx, vy, vz), (wx, wy, wz) = map(float, rolling), map(float, turned)
        found.append(replace(start, velocity=(vx, vy, vz), angular_velocity=(wx, wy, wz)))
    return found


__all__ = ["cross_check", "same_again"]
