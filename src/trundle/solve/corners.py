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
from ..mechanics.system import RollingSystem
from .contact_state import ContactState, floats
from .samples import Array
from .tracing import PythonLaw, python_law

if TYPE_CHECKING:
    from .transitions import PhaseStart

_CLOSE = 1e-2  # W as a share of the vector's length, or of how it changes in the time in which the motion changes
# Shares of that time, which is shorter where the vector turns about sooner: behind a corner, clear of it, and where one
# sees what a vector grows to.
_BEHIND, _CLEAR, _AHEAD = 1e-13, 1e-9, 1e-6
_FURTHER, _TRIES = 4.0, 10
_ROUNDING = 1e-15  # of |ρ|
_MANY, _MANY_WITHIN = 50, 1e-6  # corners, and the share of that time in which nothing passes through so many
_MOST = 10_000


def directions(system: RollingSystem, now: PhaseStart) -> tuple[float, ...]:
    """Return the numbers of the event functions of corners, for a stretch that begins."""
    if not system.corners:
        return ()
    found: list[float] = []
    for w, ahead, further in zip(*_here_and_ahead(system, now), strict=True):
        way = ahead if _is_on(w, ahead) else w
        length = float(np.linalg.norm(way))
        change, bend = (float(np.linalg.norm(part)) for part in (ahead - w, further - 2 * ahead + w))
        grows = change / max(_AHEAD, bend / change) if change > 0 else 0.0  # until it has turned back
        size = max(float(np.linalg.norm(w)), grows)
        found += [*(way / length if length > 0 else way).tolist(), 1 / (_CLOSE * size) if size > 0 else 0.0]
    return tuple(found)


def beyond(system: RollingSystem, now: PhaseStart) -> PhaseStart:
    """Return what begins on a corner as it is just behind it, where no rounding decides on which side it is."""
    if not system.corners:
        return now
    try:
        here, later, _ = _here_and_ahead(system, now)
    except ArithmeticError:  # just on it, where the load has no direction
        now = _aside(system, now)
        here, later, _ = _here_and_ahead(system, now)
    on = [later[i] for i, w in enumerate(here) if _is_on(w, later[i])]
    if not any(w.any() for w in on):
        return now
    share, moment, wait = _BEHIND, _moment(system, now), 2 * float(np.spacing(now.time))
    for _ in range(_TRIES):
        wait = max(share * moment, wait)
        behind = advanced(system, now, wait)
        there = _vectors(python_law(system, now.law), behind.time, behind.state_vector)
        if not any(_is_on(w, w + later[i] - here[i]) for i, w in enumerate(there)):
            # Closer to it the high terms of a series are greater than any float.
            return advanced(system, behind, max(_CLEAR * moment, wait))
        share *= _FURTHER
    return now


def advanced(system: RollingSystem, now: PhaseStart, wait: float) -> PhaseStart:
    """Return the same a moment later, by its own law until then."""
    numbers = now.law.rk4_step(system, now.time, now.state_vector, wait, python_law(system, now.law).rates)
    at = now.law.unpack(system, now.time + wait, numbers)
    return replace(now, start=at.state, state_vector=numbers, across=replace(now, events=()))


def check_count(system: RollingSystem, times: Sequence[float], now: PhaseStart) -> None:
    """Refuse a motion that would pass through corners for ever."""
    many = times[-_MANY:]
    look = len(times) % _MANY == 0
    trapped = look and many[-1] - many[0] < _MANY_WITHIN * _moment(system, now)
    if not trapped and len(times) <= _MOST:
        return
    said = "is pushed back from both sides of" if trapped else f"has passed more than {_MOST} times through"
    raise SolverError(
        f"At t = {now.time:.9g} s the body {said} a corner of a load, as `abs(x)` has one at 0 and quadratic drag "
        "where nothing moves through the air. Ask for a shorter run, or round the corner off: `sqrt(x*x + 1e-6)`."
    )


def _here_and_ahead(system: RollingSystem, now: PhaseStart) -> list[list[Array]]:
    """Return what passes through zero at the corners, and the same a little later, and later still.

    A system keeps that of the last phase that was asked about: where it begins, and for its event functions.
    """
    known: tuple[PhaseStart, list[list[Array]]] | None = system._known.get(_here_and_ahead)
    if known is None or known[0] is not now:
        law, numbers = python_law(system, now.law), list(map(float, now.state_vector))
        wait = _AHEAD * _moment(system, now)
        found = [_vectors(law, now.time, numbers)]
        for look in (1, 2):
            later = now.law.rk4_step(system, now.time, numbers, look * wait, law.rates)
            found.append(_vectors(law, now.time + look * wait, later))
        system._known[_here_and_ahead] = known = now, found
    return known[1]


def _vectors(law: PythonLaw, time: float, numbers: Sequence[float]) -> list[Array]:
    """Return what passes through zero at the corners."""
    return [*np.reshape(law.corners(time, numbers), (-1, 3))]


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
    at = now.law.unpack(system, now.time, now.state_vector)
    return now.law.moment(system, at, python_law(system, now.law).rates(now.time, now.state_vector))
