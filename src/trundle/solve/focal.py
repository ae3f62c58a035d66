"""A flight past a focal point of the support, such as the centre of a bowl, where its nearest point is so no longer.

There det(1 + (C + g)S) = 0: the way of the nearest point has no slope, but nothing happens to the body. It flies on,
with the point held, until it is clearly past; then the nearest point is looked for anew.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np

from ..errors import SolverError
from ..mechanics.duals import value_of
from ..mechanics.scalars import Scalar
from ..mechanics.system import RollingSystem
from .contact_state import ContactState
from .laws import FlightLaw, Law, Numbers
from .samples import Array
from .transitions import PhaseStart, ZeroCrossing

_STEP = 1e-3  # of the gap over the speed, and of the time in which the motion changes: rk4 is exact to the last digit
ASIDE = 1e-15  # share of a length at hand: so far beside a focal point there is a nearest point
_MOST_STEPS = 512  # to where the nearest point is known again: half of the gap


def is_focal(law: Law, stop: ZeroCrossing) -> bool:
    """Tell whether a body in flight has come to a focal point."""
    return isinstance(law, FlightLaw) and stop.name == "curved"


def past_it(system: RollingSystem, law: Law, stop: ZeroCrossing) -> PhaseStart | None:
    """Return how a flight goes on past a focal point; None where it comes to touch, or no point in reach is nearest."""
    step, state, time = _step(system, law, stop), list(stop.state_vector), stop.time
    with suppress(ArithmeticError, ValueError, SolverError):
        for count in range(1, _MOST_STEPS + 1):
            state, time = _after(system, law, time, state, step), time + step
            if count & (count - 1):  # to look for a nearest point takes far longer: after twice as many each time
                continue
            at = ContactState.of(system, law.unpack(system, time, state).state)
            if value_of(at.gap) <= 0:
                return None
            follows = PhaseStart.of(law, at)
            left = law.event_functions(system, time, follows.state_vector, ())
            if value_of(left["curved"]) > 0:  # beyond a rim there is nothing to come down on
                return follows if all(value_of(one) > 0 for one in left.values()) else None
    return None


def flown(system: RollingSystem, law: Law, stop: ZeroCrossing, times: Array) -> Array:
    """Return the states between a focal point and where the nearest point is known again, at ascending times, s."""
    step, state, time, found = _step(system, law, stop), stop.state_vector.tolist(), stop.time, []
    for until in times.tolist():
        for _ in range(int(np.ceil((until - time) / step))):
            wait = min(step, until - time)
            state, time = _after(system, law, time, state, wait), time + wait
        found.append(_with_nearest(system, law, time, state))
    return np.array(found)


def _with_nearest(system: RollingSystem, law: Law, time: float, state: list[float]) -> list[float]:
    """Return a state with its nearest point: on a focal point, one of many that are as near."""
    at = law.unpack(system, time, state)
    for aside in (0.0, ASIDE * at.arm):
        with suppress(ArithmeticError, ValueError, SolverError):
            x, y, z = at.state.position
            moved = replace(at.state, position=(x + aside, y + aside, z + aside))
            return [*ContactState.of(system, moved).contact.point, *state[3:]]
    return state


def _step(system: RollingSystem, law: Law, stop: ZeroCrossing) -> float:
    """Return how long a step may be, s."""
    at = law.unpack(system, stop.time, stop.state_vector)
    gap, speed = value_of(at.gap), value_of(at.speed)
    return _STEP * float(min(gap / max(speed, 1e-300), value_of(at.moment(system))))


def _after(system: RollingSystem, law: Law, time: Scalar, state: Numbers, step: float) -> list[Scalar]:
    """Return the state of a flight after a step, with the nearest point and the gap as they are."""
    gap = len(law.variables) - 4
    still = {0, 1, 2, gap}

    def rates(time: Scalar, moved: Numbers) -> list[Scalar]:
        held = [state[i] if i in still else number for i, number in enumerate(moved)]
        return [0.0 if i in still else rate for i, rate in enumerate(law.rates(system, time, held))]

    return law.rk4_step(system, time, state, step, rates)
