"""Corners that a load has where a vector passes through zero, as drag has that goes with |v|v.

On either side of such a corner the force is as smooth as a polynomial, and a series leads across it as if it were none.
So a step ends there, and the same law goes on from the other side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..errors import SolverError
from ..mechanics.algebra import Vector
from ..mechanics.scalars import Scalar
from ..mechanics.system import RollingSystem
from .contact_state import ContactState, floats
from .laws import CORNER, Law
from .samples import Array

if TYPE_CHECKING:
    from .transitions import PhaseStart

_NUMBERS = 4  # of each corner: the direction that its vector has, and 1/W
_CLOSE = 1e-2  # W as a share of the vector's length, or of how it changes in the time in which the motion changes
# Shares of that time: behind a corner, clear of it, and where one sees what a vector grows to.
_BEHIND, _CLEAR, _AHEAD = 1e-13, 1e-9, 1e-6
_FURTHER, _TRIES = 4.0, 10
_ROUNDING = 1e-15  # of |ρ|
_MANY, _MANY_WITHIN = 50, 1e-6  # corners, and the share of that time in which nothing passes through so many
_MOST = 10_000


def count(system: RollingSystem) -> int:
    """Return how many numbers the event functions of a system's corners take.

    Examples
    --------
    >>> import trundle as tr
    >>> count(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()), loads=[tr.QuadraticDrag(0.1)]))
    4
    """
    return _NUMBERS * len(system.corners)


def all_event_functions(
    system: RollingSystem, law: Law, time: Scalar, state: Sequence[Scalar], given: Sequence[Scalar]
) -> dict[str, Scalar]:
    """Return what ends a stretch where it falls through zero: a law's event functions, and the corners of the loads.

    A vector w that had the direction ŵ passes close by zero where w·ŵ + w²/W falls through it, W being a small length:
    one that only turns about has no such instant.
    """
    split = len(given) - count(system)
    found, corners = law.event_functions(system, time, state, given[:split]), system.corners
    if not corners:
        return found
    motion = law.motion(system, time, state)
    for i, corner in enumerate(corners):
        x, y, z, inverse = given[split + _NUMBERS * i : split + _NUMBERS * (i + 1)]
        w = corner(motion)
        found[f"{CORNER} {i + 1}"] = w.dot(Vector(x, y, z)) + w.dot(w) * inverse
    return found


def directions(system: RollingSystem, now: PhaseStart) -> tuple[float, ...]:
    """Return the numbers of the event functions of corners, for a stretch that begins."""
    if not system.corners:
        return ()
    found: list[float] = []
    for w, ahead in zip(_vectors(system, now, 0.0), _vectors(system, now, _AHEAD), strict=True):
        way = ahead if _is_on(w, ahead) else w
        length = float(np.linalg.norm(way))
        size = max(float(np.linalg.norm(w)), float(np.linalg.norm(ahead - w)) / _AHEAD)
        found += [*(way / length if length > 0 else way).tolist(), 1 / (_CLOSE * size) if size > 0 else 0.0]
    return tuple(found)


def beyond(system: RollingSystem, now: PhaseStart) -> PhaseStart:
    """Return what begins on a corner as it is just behind it, where no rounding decides on which side it is."""
    if not system.corners:
        return now
    try:
        here, later = _vectors(system, now, 0.0), _vectors(system, now, _AHEAD)
    except ArithmeticError:  # just on it, where the load has no direction
        now = _aside(system, now)
        here, later = _vectors(system, now, 0.0), _vectors(system, now, _AHEAD)
    on = [later[i] for i, w in enumerate(here) if _is_on(w, later[i])]
    share, wait = _BEHIND, 2 * float(np.spacing(now.time))
    for _ in range(_TRIES if any(w.any() for w in on) else 0):
        wait = max(share * _moment(system, now), wait)
        behind = advanced(system, now, wait)
        if not any(_is_on(w, w + later[i] - here[i]) for i, w in enumerate(_vectors(system, behind, 0.0))):
            # Closer to it the high terms of a series are greater than any float.
            return advanced(system, behind, max(_CLEAR * _moment(system, now), wait))
        share *= _FURTHER
    return now


def advanced(system: RollingSystem, now: PhaseStart, wait: float) -> PhaseStart:
    """Return the same a moment later, by its own law until then."""
    numbers = now.law.rk4_step(system, now.time, now.state_vector, wait)
    at = now.law.unpack(system, now.time + wait, numbers)
    return replace(now, start=at.state, state_vector=numbers, across=replace(now, events=()))


def check_count(system: RollingSystem, times: Sequence[float], now: PhaseStart) -> None:
    """Refuse a motion that would pass through corners for ever."""
    many = times[-_MANY:]
    trapped = len(many) == _MANY and many[-1] - many[0] < _MANY_WITHIN * _moment(system, now)
    if not trapped and len(times) <= _MOST:
        return
    said = "is pushed back from both sides of" if trapped else f"has passed more than {_MOST} times through"
    raise SolverError(
        f"At t = {now.time:.9g} s the body {said} a corner of a load, as `abs(x)` has one at 0 and quadratic drag "
        "where nothing moves through the air. Ask for a shorter run, or round the corner off: `sqrt(x*x + 1e-6)`."
    )


def _vectors(system: RollingSystem, now: PhaseStart, share: float) -> list[Array]:
    """Return what passes through zero at the corners, a share of the time later in which the motion changes."""
    wait = share * _moment(system, now) if share else 0.0
    numbers = now.law.rk4_step(system, now.time, now.state_vector, wait) if wait else now.state_vector
    motion = now.law.motion(system, now.time + wait, list(map(float, numbers)))
    return [np.array([float(part) for part in corner(motion)]) for corner in system.corners]


def _aside(system: RollingSystem, now: PhaseStart) -> PhaseStart:
    """Return what begins a rounding further along the way of the body."""
    at = now.law.unpack(system, now.time, now.state_vector)
    centre = Vector(*now.start.position) + at.V * (_ROUNDING * at.arm / max(at.speed, 1e-300))
    at = ContactState.of(system, replace(now.start, position=floats(centre)))
    return replace(now, start=at.state, state_vector=now.law.state_vector(at))


def _is_on(w: Array, later: Array) -> bool:
    """Tell whether a vector is zero but for rounding, given the same one a moment later."""
    return bool(np.linalg.norm(w) <= _BEHIND / _AHEAD * np.linalg.norm(later - w))


def _moment(system: RollingSystem, now: PhaseStart) -> float:
    """Return a time in which the motion changes, s."""
    return now.law.unpack(system, now.time, now.state_vector).moment(system)
