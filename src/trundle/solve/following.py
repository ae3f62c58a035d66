"""What follows when a phase of contact ends: read off the state, never guessed from the phase before."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import SolverError
from ..mechanics.algebra import ZERO, Vector
from ..mechanics.contact import roll
from ..mechanics.impact import land, response
from ..mechanics.placing import SLIP_TOLERANCE
from ..mechanics.slipping import slip
from ..mechanics.system import RollingSystem, State
from .laws import (
    CONE_SLACK,
    FlightLaw,
    Law,
    RestingLaw,
    RollingLaw,
    RollingWithResistance,
    SlidingFreely,
    SlippingLaw,
    state_turning,
)
from .onset_of_slip import first_moment
from .samples import Event
from .touch import Touch, floats, moment

_WEIGHTLESS = 1e-13  # share of the forces at hand below which nothing presses the body on
_PULLED_BACK = 1e-8  # share of the accelerations at hand at which a body that lifts off would come straight down
_TAKE_OFF = 1e-15  # gap, as a share of |ρ|, with which a flight begins: it must not end where it begins
SETTLED = 1e-6  # height, as a share of |ρ|, below which a bounce is cut


@dataclass(frozen=True)
class Next:
    """The law that holds from now on, its numbers, and what happened."""

    law: Law
    time: float
    state: list[float]
    extras: tuple[float, ...] = ()
    events: tuple[Event, ...] = ()


def at_start(system: RollingSystem, start: State) -> Next:
    """Return the phase in which a start finds itself.

    Parameters
    ----------
    system : RollingSystem
        Body and support.
    start : State
        Touching the support or over it.

    Returns
    -------
    Next
        Its law; an event where it strikes the support at once.
    """
    at = Touch.of(system, start)
    if at.gap > SLIP_TOLERANCE * at.arm:
        return _fly(system, start)
    if at.approach < -SLIP_TOLERANCE * at.speed:
        return _struck(system, start)
    if at.approach > SLIP_TOLERANCE * at.speed:
        return _fly(system, start)
    return _touching(system, at)


def after(system: RollingSystem, law: Law, stop: str, time: float, numbers: Any) -> Next:
    """Return what follows one of a law's stops.

    Parameters
    ----------
    system : RollingSystem
        Body and support.
    law : Law
        That ended.
    stop : str
        Which of its stops it came to.
    time : float
        s.
    numbers : array
        The state there.

    Returns
    -------
    Next
        The next law, and the event.
    """
    before = law.state(system, time, numbers)
    stop = stop.removeprefix("near ")
    if stop in ("grip", "stop") and _goes_on(system, before, numbers, stop):
        slip = Vector(*map(float, numbers[10:13])) if stop == "grip" else None
        return Next(law, time, list(numbers), _extras(system, Touch.of(system, before), slip))
    if stop == "land":
        return _struck(system, before)
    if stop == "lift":
        return _lifted(system, before)
    if stop in ("grip", "stop"):
        before = _come_to_it(system, law, time, numbers, stop)
        time = before.time
    follows = _touching(system, Touch.of(system, before), gave_way=stop)
    kind, said = _NAMES[type(follows.law).code] if type(follows.law).code != law.code else ("slip", _TURNED)
    if stop == "grip" and isinstance(follows.law, SlippingLaw):
        kind, said = "slip", _TURNED
    event = Event(time, kind, f"{said} at t = {time:.9g} s", before, before)
    return replace(follows, events=(event, *follows.events))


_TURNED = "stopped slipping and slipped on the other way"
_NAMES = {
    RollingLaw.code: ("grip", "gripped and rolled"),
    SlippingLaw.code: ("slip", "began to slip"),
    FlightLaw.code: ("lift", "came off the support"),
    RestingLaw.code: ("stop", "came to rest on the support"),
}


def _goes_on(system: RollingSystem, state: State, numbers: Any, stop: str) -> bool:
    """Tell whether slip or turning was only at its slowest, and did not end."""
    at = Touch.of(system, state)
    left = np.linalg.norm(numbers[10:13]) if stop == "grip" else state_turning(at.contact, at.Omega).norm() * at.arm
    return bool(left > 1e2 * at.still(system))


def _extras(system: RollingSystem, at: Touch, slip: Vector | None = None) -> tuple[float, ...]:
    """Return what the stops of slipping take: when slip is all but nothing, and its direction; or those of turning."""
    v = state_turning(at.contact, at.Omega) if slip is None else slip
    still = at.still(system) / (at.arm if slip is None else 1.0)
    return still**2, *floats(v / v.norm())


def spins_on(system: RollingSystem, law: Law, time: float, numbers: Any) -> bool:
    """Tell whether a body has stopped rolling, and still spins about the normal.

    Parameters
    ----------
    system : RollingSystem
        Body and support.
    law : Law
        Of rolling, at its stop.
    time : float
        s.
    numbers : array
        The state there.

    Returns
    -------
    bool
        False also where its turning over the support was only at its slowest.
    """
    state = law.state(system, time, numbers)
    if _goes_on(system, state, numbers, "stop"):
        return False
    at = Touch.of(system, state)
    relative = at.Omega - at.contact.support.angular_velocity
    return bool(abs(relative.dot(at.contact.normal)) * at.arm > 1e-9 * at.scale(system))


def _fly(system: RollingSystem, state: State, least_gap: float = 0.0, events: tuple[Event, ...] = ()) -> Next:
    law = FlightLaw()
    numbers = law.pack(system, state)
    numbers[13] = max(numbers[13], least_gap)
    return Next(law, state.time, numbers, (), events)


def _lifted(system: RollingSystem, state: State) -> Next:
    at = Touch.of(system, state)
    if system.support.friction is None and _pull(system, at) > _PULLED_BACK * at.scale(system) ** 2 / at.arm:
        raise SolverError(
            f"At t = {state.time:.9g} s friction without limit would have to hold the body down, which no support "
            "does. Give the support a `friction`, so that the body slips before that."
        )
    event = Event(state.time, "lift", f"came off the support at t = {state.time:.9g} s", state, state)
    return _fly(system, state, _TAKE_OFF * at.arm, (event,))


def _pull(system: RollingSystem, at: Touch) -> float:
    """Return how fast the body would come down on the support if it did not push, m/s²."""
    own = at.state.support
    free = slip(system, at.state.time, at.contact.point, at.orientation, at.Omega, at.sliding, own, direction=ZERO)
    n = at.contact.normal
    return float(free.normal_force * response(system, at.contact, at.orientation, n).dot(n))


def _struck(system: RollingSystem, before: State) -> Next:
    """Let the body strike the support, and bounce or stay."""
    at = Touch.of(system, before)
    n, own = at.contact.normal, before.support
    V, Omega, off = at.V, at.Omega, 0.0
    if at.approach < 0:
        struck = land(system, at.contact, at.orientation, at.slip)
        V, Omega = V + struck.velocity_change, Omega + struck.angular_velocity_change
        if system.support.motion.free:
            own = (*own[:-1], own[-1] + float(struck.axle_rate_change))
        off = float(at.contact.slip_velocity(V, Omega).dot(n)) if system.support.restitution > 0 else 0.0
    pull = _pull(system, at)
    bounces = off > 0 and not (pull > 0 and off * off < 2 * pull * SETTLED * at.arm)
    time, said = before.time, f"landed at {-at.approach:.4g} m/s"
    if bounces:
        after = at.moving(V, Omega, own)
        event = Event(time, "land", f"{said} and bounced at t = {time:.9g} s", before, after)
        return _fly(system, after, _TAKE_OFF * at.arm, (event,))
    after = _set_down(system, at.moving(V, Omega, own))
    cut = "; the bounces to come are lower than a millionth of the body and were cut" if off > 0 else ""
    kind = "settle" if off > 0 else "land"
    event = Event(time, kind, f"{said}{cut} at t = {time:.9g} s", before, after)
    follows = _touching(system, Touch.of(system, after))
    return replace(follows, events=(event, *follows.events))


def _set_down(system: RollingSystem, state: State) -> State:
    """Return a state that touches and stays: no velocity off the support, and none along it where that is rounding."""
    at = Touch.of(system, state)
    limit = SLIP_TOLERANCE * at.speed
    held = at.sliding.norm() <= limit and system.support.friction != 0
    return at.moving(at.contact.rolling_velocity(at.Omega) + (ZERO if held else at.sliding), at.Omega)


def _come_to_it(system: RollingSystem, law: Law, time: float, numbers: Any, stop: str) -> State:
    """Go on straight from where slip or turning has all but ended to where it has ended."""
    y, wait = np.asarray(numbers, dtype=float), 0.0
    at = Touch.of(system, law.state(system, time, y))
    s = y[10:13] if stop == "grip" else state_turning(at.contact, at.Omega).array()
    length, still = float(np.linalg.norm(s)), at.still(system)
    if length > 1e-3 * (still if stop == "grip" else still / at.arm):
        rates = np.array([float(rate) for rate in law.rates(system, time, y.tolist())])
        closing = float(-(s @ (rates[10:13] if stop == "grip" else rates[7:10])) / length)
        wait = length / closing if closing > 0 else 0.0
        y = y + wait * rates
        at = Touch.of(system, law.state(system, time + wait, y))
    Omega = at.Omega if stop == "grip" else at.Omega - state_turning(at.contact, at.Omega)
    return replace(at.moving(at.contact.rolling_velocity(Omega), Omega), time=time + wait)


def _touching(system: RollingSystem, at: Touch, gave_way: str = "") -> Next:
    """Return the phase of a body that touches and stays: slipping where it slips, else what its forces ask for.

    Where static friction or the resistance has just given way, "slip" or "start", rounding no longer decides it.
    """
    state, support, limit = at.state, system.support, SLIP_TOLERANCE * at.speed
    if support.friction == 0:
        law: Law = SlidingFreely()
        return Next(law, state.time, law.pack(system, state))
    if support.friction is not None and at.sliding.norm() > limit:
        law = SlippingLaw()
        return Next(law, state.time, law.pack(system, state), _extras(system, at, at.sliding))
    if any(load.stops for load in system.loads) and gave_way != "start":
        resting = _resting(system, at)
        if resting is not None:
            return resting
    return _rolling(system, at, slips=gave_way == "slip")


def _rolling(system: RollingSystem, at: Touch, *, slips: bool) -> Next:
    """Return rolling where the support can make it do so, else slipping or flight."""
    state = at.state
    now = roll(system, state.time, at.contact.point, at.orientation, at.Omega, state.support)
    n, R = at.contact.normal, now.reaction
    N = float(n.dot(R))
    f = R - n * N
    forces = system.body.mass * at.scale(system) ** 2 / at.arm
    weightless = abs(N) <= _WEIGHTLESS * forces
    if N < 0 and not weightless:
        return _lifted(system, state)
    mu = system.support.friction
    if slips or (mu is not None and f.norm() > mu * max(N, 0.0) * (1 + CONE_SLACK) + _WEIGHTLESS * forces):
        then, extras = first_moment(system, at, f)
        slipping = SlippingLaw()
        return Next(slipping, then.time, slipping.pack(system, then), extras)
    if any(load.stops for load in system.loads):
        return _turning_on(system, at, lifts=not weightless)
    law = RollingLaw(lifts=not weightless, grips=not weightless)
    return Next(law, state.time, law.pack(system, state))


def _turning_on(system: RollingSystem, at: Touch, *, lifts: bool) -> Next:
    """Return rolling against a resistance; from rest, with a first little turn the way it is driven."""
    law, state, still = RollingWithResistance(lifts=lifts, grips=lifts), at.state, at.still(system) / at.arm
    turning = state_turning(at.contact, at.Omega)
    if turning.norm() <= 2 * still:
        law_at_rest = RestingLaw()
        couple = law_at_rest.held(system, state.time, law_at_rest.pack(system, state)).couple
        driven = couple - at.contact.normal * couple.dot(at.contact.normal)
        way = driven * (-4 * still / driven.norm()) if driven.norm() > 0 else ZERO
        Omega = at.Omega - turning + way
        state = at.moving(at.contact.rolling_velocity(Omega), Omega)
    return Next(law, state.time, law.pack(system, state), _extras(system, Touch.of(system, state)))


def _resting(system: RollingSystem, at: Touch) -> Next | None:
    """Return rest where the body does not turn over the support and the resistance can hold it so."""
    relative = at.Omega - at.contact.support.angular_velocity
    if relative.norm() * at.arm > SLIP_TOLERANCE * at.scale(system):
        return None
    law = RestingLaw()
    numbers = law.pack(system, at.state)
    stops = law.stops(system, at.state.time, numbers, ())
    if system.support.motion.free or min(stops["lift"], stops["start"], stops.get("slip", 0.0)) < 0:
        return None
    return Next(law, at.state.time, numbers)


__all__ = ["SETTLED", "Next", "after", "at_start", "moment", "spins_on"]
