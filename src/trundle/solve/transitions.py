"""What follows when a phase of contact ends: read off the state, never guessed from the phase before."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from ..errors import SolverError
from ..mechanics.algebra import ZERO, Vector, inertia_about
from ..mechanics.contact import roll
from ..mechanics.duals import value_of
from ..mechanics.impact import land
from ..mechanics.kinks import Kink
from ..mechanics.placing import SLIP_TOLERANCE, no_gap
from ..mechanics.records import frozen_record
from ..mechanics.scalars import as_float
from ..mechanics.slipping import response, slip, unpushed, unturned
from ..mechanics.system import RollingSystem, State
from .coming_off import lift_at_hand, only_touches, slips_at_once
from .contact_state import WEIGHTLESS, ContactState, floats, moment
from .creeping import GROWN, CreepingLaw
from .laws import (
    AN_INSTANT,
    CORNER,
    JAMS,
    FlightLaw,
    Law,
    RestingLaw,
    RollingLaw,
    RollingWithResistance,
    SlidingFreely,
    SlippingLaw,
    cone,
    left_of_resistance,
    state_turning,
)
from .samples import Array, Event
from .slip_onset import jammed, slip_onset

_FLOOR = 1e-12  # share of the forces at hand by which the support seems to pull a weightless body: rounding
_PULLED_BACK = 1e-8  # share of the accelerations at hand at which a body that lifts off would come straight down
_LOOKS = (1e-6, 1e-5, 1e-4, 1e-3)  # shares of the time in which the motion changes: what comes at once
TAKE_OFF = 1e-15  # gap, as a share of the least length at hand, with which a flight begins: it must not end there
SETTLED = 1e-6  # height, as a share of |ρ|, below which a bounce is cut
JOLT = "jolt"  # the stop where the velocity of the support jumps under a body that touches it


@frozen_record()
class ZeroCrossing:
    """Where a stretch ended, a stop: the instant, which of the law's event functions was zero, and the state vector."""

    time: float
    name: str
    state_vector: Array
    known: ContactState | None = None  # the same, where the method knows it better than by its numbers

    def at(self, system: RollingSystem, law: Law) -> ContactState:
        """Return the body where it was then."""
        return law.unpack(system, self.time, self.state_vector) if self.known is None else self.known


@frozen_record()
class PhaseStart:
    """The law that holds from now on, where the body is, its numbers by that law, and what happened."""

    law: Law
    start: State
    state_vector: list[float]
    event_parameters: tuple[float, ...] = ()
    events: tuple[Event, ...] = ()
    across: PhaseStart | None = None  # by which the body moves until this begins, where something happened before

    @staticmethod
    def of(
        law: Law, at: ContactState, event_parameters: tuple[float, ...] = (), events: tuple[Event, ...] = ()
    ) -> PhaseStart:
        """Return what begins where a body touches."""
        return PhaseStart(law, at.state, law.state_vector(at), event_parameters, events)

    @property
    def time(self) -> float:
        """When it begins, s."""
        return self.start.time


def at_start(system: RollingSystem, start: State) -> PhaseStart:
    """Return the phase in which a start finds itself; a system keeps that of the last start that was asked about."""
    known: tuple[State, PhaseStart] | None = system._known.get(at_start)
    if known is None or known[0] is not start:
        system._known[at_start] = known = start, _at_start(system, start)
    return known[1]


def _at_start(system: RollingSystem, start: State) -> PhaseStart:
    at = ContactState.of(system, start)
    if at.gap > no_gap(at.contact, start.position):
        return _fly(at)
    if at.approach < -SLIP_TOLERANCE * at.speed:
        return _struck(system, at)
    if at.approach > SLIP_TOLERANCE * at.speed:
        return _fly(at, max(at.gap, _first_gap(at, at.approach, _pull(system, at))))
    return _touching(system, at)


def after(system: RollingSystem, law: Law, stop: ZeroCrossing) -> PhaseStart:
    """Return what follows where one of a law's event functions falls through zero."""
    at, name = stop.at(system, law), stop.name.removeprefix("near ")
    if name in ("slip", "start"):
        event_parameters = _floor(system, law, at) + (0.0,) * law.ending
        lift = lift_at_hand(system, law, stop.time, stop.state_vector.tolist(), name, event_parameters)
        if lift is not None:
            advanced = law.rk4_step(system, stop.time, stop.state_vector.tolist(), lift - stop.time)
            return _lifted(system, law.unpack(system, lift, advanced))
    if (same := going_on(system, law, stop)) is not None:
        return same
    if name == JOLT:
        return _jolted(system, law, at, stop)
    if name == "land":
        # The gap and r may differ by rounding. The gap has said when; r gives way, or each bounce would add its share.
        return _struck(system, at.over(0.0))
    if name in GROWN:
        return slipping(system, PhaseStart.of(law, at))
    if isinstance(law, CreepingLaw) and name == "turned":
        turned = law.turned(law.direction(system, stop.time, stop.state_vector))
        return PhaseStart(turned, at.state, stop.state_vector.tolist(), _floor(system, law, at))
    if name == "jam":
        raise jammed(at.state.time, JAMS)
    if name == "lift":
        follows = _touching(system, at) if _stays(system, law, at, stop) else _lifted(system, at)
        return follows if isinstance(follows.law, FlightLaw) else replace(follows, events=())
    if name in ("grip", "stop"):
        at = _come_to_it(system, law, at, stop.state_vector, name)
    if name == "held":
        at = replace(at.moving(system, at.contact.rolling_velocity(at.Omega), at.Omega), slip=ZERO)
    follows = _touching(system, at, gave_way=name)
    if name == "slip" and follows.law.code == law.code:  # friction holds again at once
        return replace(follows, events=())
    said = _said(name, law.code, follows.law.code)
    return replace(follows, events=(*(_event(kind, text, at) for kind, text in said), *follows.events))


def going_on(system: RollingSystem, law: Law, stop: ZeroCrossing) -> PhaseStart | None:
    """Return the same phase behind a stop that ends nothing; None where it ends something."""
    name = stop.name.removeprefix("near ")
    if not (name in ("grip", "stop", "jam") or name.startswith(CORNER)):
        return None
    at = stop.at(system, law)
    if name == "jam":
        ends = _jams(system, law, at, stop)
    else:
        ends = not name.startswith(CORNER) and not _goes_on(system, law, at, stop)
    return None if ends else _same(system, law, at, stop.state_vector)


def later(system: RollingSystem, now: PhaseStart, time: float, numbers: Array) -> PhaseStart:
    """Return the same phase as it goes on from a later instant."""
    return _same(system, now.law, now.law.unpack(system, time, numbers), numbers)


def _same(system: RollingSystem, law: Law, at: ContactState, numbers: Array) -> PhaseStart:
    """Return a phase that goes on where a body is: its slip or turning may have another direction by now."""
    event_parameters = (*_floor(system, law, at), *_extras(system, law, at, numbers))
    return PhaseStart(law, at.state, numbers.tolist(), event_parameters)


def jolted(system: RollingSystem, law: Law, kink: Kink, numbers: Array) -> ContactState:
    """Return a body as it moves before the velocity of the support jumps, on the support as it is after.

    The slip is that against the support as it moves then.
    """
    before = law.unpack(system, kink.before, numbers)
    return ContactState.of(system, replace(before.state, time=kink.time), before.contact.point)


def _jolted(system: RollingSystem, law: Law, at: ContactState, stop: ZeroCrossing) -> PhaseStart:
    """Return what follows where the velocity of the support jumps.

    A support that comes towards the body strikes it as in a landing, and from one that goes away the body comes off.
    Along the support friction acts from now on; without limit it takes the body along at once.
    """
    limit = SLIP_TOLERANCE * at.speed
    jump = (at.slip - law.unpack(system, stop.time, stop.state_vector).slip).norm()
    if jump <= limit and isinstance(law, SlippingLaw) and not law.held:
        return _same(system, law, at, stop.state_vector)
    if at.approach < -limit:
        return _struck(system, at, f"the support struck the body at {-at.approach:.4g} m/s")
    if at.approach > limit:
        return _left_behind(system, at, limit)
    said = f"the support jerked sideways at {jump:.4g} m/s" if jump > limit else "the turning of the support jumped"
    if system.support.friction is None and at.sliding.norm() > limit:
        return _struck(system, at, said)
    after = _set_down(system, at)
    follows = _touching(system, after)
    if jump <= limit and follows.law.code == law.code:
        return follows
    return replace(follows, events=(_event(JOLT, said, at, after), *follows.events))


def _left_behind(system: RollingSystem, at: ContactState, limit: float) -> PhaseStart:
    """Return the flight of a body from which the support jerks away; one as low as a bounce that is cut is cut."""
    said, pull = f"the support jerked away from the body at {at.approach:.4g} m/s", _pull(system, at)
    flies = _fly(at, max(at.gap, _first_gap(at, at.approach, pull)), (_event(JOLT, said, at),))
    if not _is_low(at, at.approach, pull):
        return flies
    said += "; a flight lower than a millionth of the body was cut"
    after = _set_down(system, at)
    if system.support.friction is None and after.sliding.norm() > limit:  # which takes it along
        holding = replace(system.support, tangential_restitution=0.0)
        follows = _struck(replace(system, support=holding), after, said, at)
        return flies if isinstance(follows.law, FlightLaw) else follows
    follows = _touching(system, after)
    return replace(follows, events=(_event(JOLT, said, at, after), *follows.events))


def _said(stop: str, before: int, after: int) -> tuple[tuple[str, str], ...]:
    """Return the kinds of the events between two phases that a stop has parted, and what is said of them."""
    if stop == "start" and after == RollingLaw.code:
        return (_BEGAN_TO_ROLL,)
    if stop == "stop" and before == RollingLaw.code and after in (RollingLaw.code, SlippingLaw.code):
        # The resistance jumps: friction gives way, or what drives the body overcomes it at once.
        return _STOPPED_TURNING, _BEGAN_TO_ROLL if after == before else _NAMES[after]
    return (_NAMES[after] if before != after else ("slip", _SLIPS_ON[stop]),)


def slipping(system: RollingSystem, now: PhaseStart) -> PhaseStart:
    """Return the same phase by the law of slipping where it is slip whose direction settles at once."""
    if not isinstance(now.law, CreepingLaw):
        return now
    at = now.law.unpack(system, now.time, now.state_vector)
    follows = _slipping(system, at, SlippingLaw, at.sliding / at.sliding.norm())
    return replace(follows, events=now.events)


def _event(kind: str, said: str, before: ContactState, after: ContactState | None = None) -> Event:
    """Return what happened to a body where it touches; absent after, nothing about its motion changed at once."""
    state = before.state
    now = state if after is None else after.state
    return Event(state.time, kind, f"{said} at t = {state.time:.9g} s", state, now, floats(before.nearest))


_SLIPS_ON = {
    "grip": "stopped slipping and slipped on the other way",
    "stop": "stopped turning over the support as it slipped",
    "start": "began to turn over the support as it slipped",
}
_STOPPED_TURNING, _BEGAN_TO_ROLL = ("stop", "stopped turning over the support"), ("start", "began to roll")
_NAMES = {
    RollingLaw.code: ("grip", "gripped and rolled"),
    SlippingLaw.code: ("slip", "began to slip"),
    FlightLaw.code: ("lift", "came off the support"),
    RestingLaw.code: ("stop", "came to rest on the support"),
}


def _goes_on(system: RollingSystem, law: Law, at: ContactState, stop: ZeroCrossing) -> bool:
    """Tell whether slip or turning was only at its slowest, and did not end."""
    name = stop.name.removeprefix("near ")
    left = value_of(law.shrinking(system, at.state.time, stop.state_vector, name).norm())
    if left <= 4 * _least(system, at, name):
        return False
    if not stop.name.startswith("near "):
        return True
    rate = law.shrinking_rate(system, at.state.time, stop.state_vector, name)
    return bool(left > 4 * AN_INSTANT * rate.norm())


def _jams(system: RollingSystem, law: Law, at: ContactState, stop: ZeroCrossing) -> bool:
    """Tell whether friction all but jams the body.

    Where slip has just begun and nothing presses the body on, a series says little of how friction would be directed
    over the long steps of a free fall.
    """
    event_parameters = (*_floor(system, law, at), *_extras(system, law, at, stop.state_vector))
    left = law.event_functions(system, stop.time, stop.state_vector.tolist(), event_parameters)["jam"]
    return bool(value_of(left) < JAMS)


def _least(system: RollingSystem, at: ContactState, stop: str) -> float:
    """Return the slip, m/s, or how the body turns, rad/s, below which it has all but ended."""
    return at.still(system) / (1.0 if stop == "grip" else at.arm)


def _floor(system: RollingSystem, law: Law, at: ContactState) -> tuple[float, ...]:
    """Return what the event functions take where nothing presses the body on: the pull that is rounding."""
    return (_FLOOR * at.forces(system),) if law.weightless else ()


def _extras(system: RollingSystem, law: Law, at: ContactState, numbers: Any = None) -> tuple[float, ...]:
    """Return what ends slip or turning: when it is all but nothing, and its direction."""
    found: list[float] = []
    for name in law.ends:
        v = law.shrinking(system, at.state.time, law.state_vector(at) if numbers is None else numbers, name)
        length = v.norm()
        found += [_least(system, at, name) ** 2, *floats(v if length == 0 else v / length)]
    return tuple(found)


def spins_on(system: RollingSystem, law: Law, stop: ZeroCrossing) -> bool:
    """Tell whether a body neither slips nor turns over the support from now on, and still spins about the normal."""
    at = stop.at(system, law)
    if _goes_on(system, law, at, stop):
        return False
    relative = at.Omega - at.contact.support.angular_velocity
    return bool(abs(relative.dot(at.contact.normal)) * at.arm > 1e-9 * at.scale(system))


def _fly(at: ContactState, gap: float | None = None, events: tuple[Event, ...] = ()) -> PhaseStart:
    return PhaseStart.of(FlightLaw(), at if gap is None else at.over(gap), (), events)


def _lifted(system: RollingSystem, at: ContactState) -> PhaseStart:
    state = at.state
    if system.support.friction is None and _pulled_back(system, at):
        raise SolverError(
            f"At t = {state.time:.9g} s friction without limit would have to hold the body down, which no support "
            "does. Give the support a `friction`, so that the body slips before that."
        )
    return _fly(at, TAKE_OFF * at.arm, (_event("lift", _NAMES[FlightLaw.code][1], at),))


def _first_gap(at: ContactState, off: float, pull: float) -> float:
    """Return the gap with which a body begins to fly that comes off so fast, m: none, but for the sign.

    It is small beside the height of the flight: what is added again at each bounce would show in those to come.
    """
    height = off * off / (2 * pull) if pull > 0 else at.arm
    return TAKE_OFF * min(at.arm, height)


def _is_low(at: ContactState, off: float, pull: float) -> bool:
    """Tell whether a body that comes off so fast, m/s, comes back before it is any height off, against a pull, m/s²."""
    return pull > 0 and off * off < 2 * pull * SETTLED * at.arm


def _pulled_back(system: RollingSystem, at: ContactState) -> bool:
    """Tell whether friction alone keeps a body from coming straight down again."""
    pull, limit = _pull(system, at), _PULLED_BACK * at.scale(system) ** 2 / at.arm
    n, coordinates = at.contact.normal, at.state.support
    R = roll(system, at.state.time, at.contact.point, at.orientation, at.Omega, coordinates).reaction
    J = system.body.inertia_in_space(at.orientation.matrix())
    by_friction = pull - value_of(response(system, at.contact, J, n * n.dot(R)).slip.dot(n))
    return bool(min(pull, by_friction) > limit)


def _pull(system: RollingSystem, at: ContactState) -> float:
    """Return how fast the body would come down on the support if it did not push, m/s²."""
    coordinates = at.state.support
    free = unpushed(system, at.state.time, at.contact, at.orientation, at.Omega, at.sliding, coordinates)
    return -float(value_of(free.opening))


def _stays(system: RollingSystem, law: Law, at: ContactState, stop: ZeroCrossing) -> bool:
    """Tell whether a body stays in touch, or is looked at again, although N has come to zero."""
    if law.weightless:
        return True
    numbers = stop.state_vector.tolist()
    return only_touches(system, law, at, numbers, _extras(system, law, at, numbers))


def _opens(system: RollingSystem, at: ContactState) -> bool:
    """Tell whether a body on which nothing presses comes off at once: left alone, the gap opens faster and faster.

    What only seems to press or to pull on a weightless body, rounding, stays as small as it is.
    """
    alone, floor = _fly(at), _FLOOR * at.forces(system) / as_float(value_of(system.body.mass))
    wait = alone.law.moment(system, at, alone.law.rates(system, alone.time, alone.state_vector))
    opening = 0.0
    for share in _LOOKS:
        time = alone.time + share * wait
        numbers = alone.law.rk4_step(system, alone.time, alone.state_vector, share * wait)
        opening = -_pull(system, alone.law.unpack(system, time, numbers))
        if opening < -floor:
            return False
    return opening > floor


def _struck(system: RollingSystem, at: ContactState, jolt: str = "", before: ContactState | None = None) -> PhaseStart:
    """Let the body strike the support, or be struck by it, of which is told; it bounces or stays."""
    begin = before or at
    V, Omega, coordinates, off, after = at.V, at.Omega, at.state.support, 0.0, at
    if at.approach < 0 or jolt:
        struck = land(system, at.contact, at.orientation, at.slip)
        V, Omega = V + struck.velocity_change, Omega + struck.angular_velocity_change
        if system.support.motion.free:
            coordinates = (*coordinates[:-1], coordinates[-1] + as_float(struck.axle_rate_change))
        after = at.moving(system, V, Omega, coordinates)
        off = after.approach  # a free axle that was struck carries the contact along
        sideways = at.approach >= -SLIP_TOLERANCE * at.speed
        bare = sideways or system.support.restitution == 0 or system.support.tangential_restitution > 0
        if bare and off <= SLIP_TOLERANCE * at.speed:
            off = 0.0  # slip that is given back may throw a body off or hold it down, rounding does not
    pull = _pull(system, after)  # by the motion that it has now: what it came down with is gone
    gives_back = system.support.friction is None and system.support.tangential_restitution > 0
    slips_off = gives_back and -pull * at.arm > _FLOOR * at.speed**2
    bounces = slips_off if off == 0 else off > 0 and not _is_low(at, off, pull)
    if not bounces and gives_back:
        holding = replace(system.support, tangential_restitution=0.0)  # nothing slips that stays on it
        return _struck(replace(system, support=holding), at, jolt, before)
    said = jolt or f"landed at {-at.approach:.4g} m/s"
    if bounces:
        said = f"{jolt} and threw it off" if jolt else f"{said} and bounced"
        return _fly(after, _first_gap(at, off, pull), (_event(JOLT if jolt else "land", said, begin, after),))
    after = _set_down(system, after)
    cut = "; the bounces to come are lower than a millionth of the body and were cut" if off > 0 else ""
    kind = JOLT if jolt else "settle" if off > 0 else "land"
    event = _event(kind, f"{said}{cut}", begin, after)
    follows = _touching(system, after)
    return replace(follows, events=(event, *follows.events))


def _set_down(system: RollingSystem, at: ContactState) -> ContactState:
    """Return a body that touches and stays: no velocity off the support, and none along it where that is rounding."""
    limit = SLIP_TOLERANCE * at.speed
    if at.sliding.norm() > limit or system.support.friction == 0:
        return at.moving(system, at.contact.rolling_velocity(at.Omega) + at.sliding, at.Omega)
    Omega = _held_fast(system, at, at.slip if abs(at.approach) <= limit else at.sliding)
    return at.moving(system, at.contact.rolling_velocity(Omega), Omega)


def _held_fast(system: RollingSystem, at: ContactState, left: Vector) -> Vector:
    """Return Ω after an impulse at the contact that takes away what rounding has left of the slip.

    Taken from V alone it would be much beside a light impulse, where a body of hardly any inertia turns.
    """
    rho, m = at.contact.offset, system.body.mass
    whole = inertia_about(system.body.inertia_in_space(at.orientation.matrix()), m, rho)
    return at.Omega - whole.solve(ZERO, rho.cross(left) * m)


def _come_to_it(system: RollingSystem, law: Law, at: ContactState, numbers: Any, stop: str) -> ContactState:
    """Go on straight from where slip or turning has all but ended to where it has ended."""
    y, time = [as_float(number) for number in numbers], at.state.time
    v = law.shrinking(system, time, numbers, stop)
    if v.norm() > 1e-3 * _least(system, at, stop):
        rate = law.shrinking_rate(system, time, y, stop)
        # To where it is least: what rounding leaves of it across its way never ends.
        wait = max(0.0, -v.dot(rate) / max(rate.dot(rate), 1e-300))
        rates = law.rates(system, time, y)
        at = law.unpack(system, time + wait, [number + wait * rate for number, rate in zip(y, rates, strict=True)])
    Omega = at.Omega if stop == "grip" else unturned(at.contact, at.Omega)
    s = at.sliding if stop == "stop" and law.code == SlippingLaw.code else ZERO
    return at.moving(system, at.contact.rolling_velocity(Omega) + s, Omega)


def _touching(system: RollingSystem, at: ContactState, gave_way: str = "") -> PhaseStart:
    """Return the phase of a body that touches and stays: slipping where it slips, else what its forces ask for.

    Where static friction or the resistance has just given way, "slip" or "start", rounding no longer decides it.
    """
    support, limit = system.support, SLIP_TOLERANCE * at.speed
    if support.friction == 0:
        return _slipping(system, at, SlidingFreely, ZERO, starts=gave_way == "start")
    if support.friction is not None and at.sliding.norm() > limit:
        return _slipping(system, at, SlippingLaw, at.sliding / at.sliding.norm(), starts=gave_way == "start")
    if system.resisted and gave_way != "start":
        resting = _resting(system, at, slips=gave_way == "slip")
        if resting is not None:
            return resting
    return _rolling(system, at, slips=gave_way == "slip")


def _slipping(
    system: RollingSystem,
    at: ContactState,
    law: Callable[..., SlippingLaw],
    direction: Vector,
    ending: tuple[float, ...] | None = None,
    *,
    starts: bool = False,
) -> PhaseStart:
    """Return slipping where the support pushes, else flight; what no law can follow is named.

    Where more has just been asked of resistance than it has, turning starts.
    """
    at, turning = _resisted(system, at, direction, starts=starts) if system.resisted else (at, "free")
    state, held = at.state, turning == "held"
    place = at.contact.point, at.orientation, at.Omega, at.sliding, state.support
    now = slip(system, state.time, *place, direction, held=held)
    N, forces = float(value_of(now.normal_force)), at.forces(system)
    weightless = abs(N) <= WEIGHTLESS * forces
    share = float(value_of(now.opening_per_newton * system.body.mass))
    if share <= JAMS and not weightless:
        raise jammed(state.time, share, opens=N * share < 0)
    if _opens(system, at) if weightless else N < 0:
        return _lifted(system, at)
    follows = law(weightless, turning=turning)
    ending = (*ending, *_extras(system, follows, at)[len(ending) :]) if ending else _extras(system, follows, at)
    return PhaseStart.of(follows, at, (_FLOOR * forces, *ending) if weightless else ending)


def _resisted(system: RollingSystem, at: ContactState, direction: Vector, *, starts: bool) -> tuple[ContactState, str]:
    """Return a body that slips against resistance to rolling, and how it turns: "resisted", "held" or only just."""
    if state_turning(at.contact, at.Omega).norm() * at.arm > SLIP_TOLERANCE * at.scale(system):
        return at, "resisted"
    state = at.state
    if system.support.motion.free:
        raise SolverError(
            f"At t = {state.time:.9g} s the body slips and no longer turns over its support, and resistance to rolling "
            "would hold it so against an axle that turns freely: that is not covered. Give the support a motion."
        )
    place = at.contact.point, at.orientation, at.Omega, at.sliding, state.support
    now = slip(system, state.time, *place, direction, held=True)
    N = float(value_of(now.normal_force)) + _FLOOR * at.forces(system)
    if not starts and N >= 0 and left_of_resistance(system, N, now.holding) >= 0:
        return replace(_turned_off(system, at, ZERO, at.sliding), slip=at.slip), "held"
    return replace(_turned_off(system, at, now.holding, at.sliding), slip=at.slip), "resisted"


def _rolling(system: RollingSystem, at: ContactState, *, slips: bool = False) -> PhaseStart:
    """Return rolling where the support can make it do so, else slipping or flight."""
    at = _turning_on(system, at) if system.resisted else at  # what friction is to give depends on the resistance
    state = at.state
    now = roll(system, state.time, at.contact.point, at.orientation, at.Omega, state.support)
    R = now.reaction
    N = float(value_of(now.normal_force))
    forces = at.forces(system)
    weightless = abs(N) <= WEIGHTLESS * forces
    floor = _FLOOR * forces if weightless else 0.0
    pulled = N + floor < 0
    if weightless and _opens(system, at):
        return _lifted(system, at)
    if pulled and (system.support.friction is None or _pull(system, at) < 0):
        return _lifted(system, at)
    gives_way = cone(system, at.contact, R, N, floor).get("slip", 0.0) < 0
    if slips or pulled or gives_way or (weightless and slips_at_once(system, at, floor)):
        return _giving_way(system, at, RollingLaw())
    law = (RollingWithResistance if system.resisted else RollingLaw)(weightless)
    if law.ends and state_turning(at.contact, at.Omega).norm() == 0:
        raise SolverError(
            f"At t = {state.time:.9g} s the body only spins about the normal: rolling resistance has no direction "
            "there, and what it would hold is not covered. Let it roll a little, or leave the resistance out."
        )
    ending = _extras(system, law, at)
    return PhaseStart.of(law, at, (floor, *ending) if weightless else ending)


def _giving_way(system: RollingSystem, at: ContactState, law: Law) -> PhaseStart:
    """Return slipping that begins where friction cannot give what rolling, or rest, takes."""
    begun = slip_onset(system, at, law)
    if begun is None:
        if _pull(system, at) < 0:
            return _lifted(system, at)
        raise jammed(at.state.time)
    if isinstance(begun, ContactState):
        return _rolling(system, begun) if law.code == RollingLaw.code else _touching(system, begun)
    follows = _slipping(system, begun.at, begun.law, begun.direction, begun.ending)
    return replace(follows, across=PhaseStart.of(law, at))


def _turning_on(system: RollingSystem, at: ContactState) -> ContactState:
    """Return a body that rolls against a resistance; from rest, with a first little turn the way it is driven."""
    at_rest = RestingLaw()
    couple = at_rest.held(system, at.state.time, at_rest.state_vector(at)).couple
    return _turned_off(system, at, couple - at.contact.normal * couple.dot(at.contact.normal), ZERO)


def _turned_off(system: RollingSystem, at: ContactState, holding: Vector, slip: Vector) -> ContactState:
    """Return a body that turns over the support; from none, with a first little turn against what would hold it."""
    first, turning = at.first_turn(system), state_turning(at.contact, at.Omega)
    if turning.norm() > first / 2:
        return at
    way = holding * (-first / holding.norm()) if holding.norm() > 0 else ZERO
    Omega = at.Omega - turning + way
    return at.moving(system, at.contact.rolling_velocity(Omega) + slip, Omega)


def _resting(system: RollingSystem, at: ContactState, *, slips: bool) -> PhaseStart | None:
    """Return rest where the body does not turn over the support and the resistance can hold it so; else None.

    Where friction gives way, it begins to slip as it is held.
    """
    relative = at.Omega - at.contact.support.angular_velocity
    if relative.norm() * at.arm > SLIP_TOLERANCE * at.scale(system):
        return None
    rest = PhaseStart.of(RestingLaw(), at)
    stops = rest.law.event_functions(system, rest.time, rest.state_vector, ())
    if system.support.motion.free or min(stops["lift"], stops["start"]) < 0:
        return None
    return _giving_way(system, at, rest.law) if slips or stops.get("slip", 0.0) < 0 else rest


__all__ = ["SETTLED", "PhaseStart", "ZeroCrossing", "after", "at_start", "moment", "spins_on"]
