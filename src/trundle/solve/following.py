"""What follows when a phase of contact ends: read off the state, never guessed from the phase before."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import SolverError
from ..mechanics.algebra import E_X, E_Y, E_Z, ZERO, Matrix, Quaternion, Vector
from ..mechanics.contact import Contact, roll, settle
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
from .samples import Event

_STILL = 1e-12  # share of the speeds at the contact at which slip or turning has all but ended
_FIRST = 1e-6  # share of |ρ| over that speed that slip takes to begin, at least, and a thousand times that at most
_SETTLED_IN = 2e3  # how much faster its direction settles than it grows once it has begun
_JUST = 1e-8  # share of friction below which what it cannot give has no direction yet
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


@dataclass(frozen=True)
class _Touch:
    """A body at its contact: the geometry, how it moves there, and against what that is small or not."""

    state: State
    contact: Contact
    orientation: Quaternion
    V: Vector
    Omega: Vector
    slip: Vector
    gap: float
    arm: float  # |ρ|, m
    speed: float  # m/s

    @staticmethod
    def of(system: RollingSystem, state: State) -> _Touch:
        q, centre = Quaternion(*state.orientation), Vector(*state.position)
        V, Omega = Vector(*state.velocity), Vector(*state.angular_velocity)
        contact = settle(system, state.time, centre, q, state.support)
        gap = (centre + contact.offset - contact.point).dot(contact.normal)
        arm = contact.offset.norm()
        u = contact.support.material_velocity(contact.point)
        speed = max(V.norm(), Omega.norm() * arm, u.norm())
        return _Touch(state, contact, q, V, Omega, contact.slip_velocity(V, Omega), float(gap), arm, float(speed))

    @property
    def approach(self) -> float:
        """How fast it comes off the support, m/s; negative: how fast it comes down."""
        return float(self.slip.dot(self.contact.normal))

    @property
    def sliding(self) -> Vector:
        """The part of s along the support, m/s."""
        return self.slip - self.contact.normal * self.approach

    def moving(self, V: Vector, Omega: Vector, support: tuple[float, ...] | None = None) -> State:
        """Return the state with other velocities."""
        own = self.state.support if support is None else support
        return replace(self.state, velocity=_floats(V), angular_velocity=_floats(Omega), support=own)

    def scale(self, system: RollingSystem) -> float:
        """Return a speed of this motion: the fastest at the contact, or what all that acts makes of it, m/s."""
        motion = self.contact.body_motion(system.body.mass, self.state.time, self.V, self.orientation, self.Omega)
        force, torque = system.loads_on(motion)
        pull = (force.norm() + torque.norm() / self.arm) / system.body.mass
        support, p = self.contact.support, self.contact.point
        pull = max(pull, support.material_acceleration(p, support.material_velocity(p)).norm())
        return max(self.speed, math.sqrt(pull * self.arm), 1e-30)


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
    at = _Touch.of(system, start)
    if at.gap > SLIP_TOLERANCE * at.arm:
        return _fly(system, start)
    if at.approach < -SLIP_TOLERANCE * at.speed:
        return _struck(system, start)
    if at.approach > SLIP_TOLERANCE * at.speed:
        return _fly(system, start)
    return _touching(system, start)


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
    before = _state(system, law, time, numbers)
    stop = stop.removeprefix("near ")
    if stop in ("grip", "stop") and _goes_on(system, before, numbers, stop):
        slip = Vector(*map(float, numbers[10:13])) if stop == "grip" else None
        return Next(law, time, list(numbers), _extras(system, _Touch.of(system, before), slip))
    if stop == "land":
        return _struck(system, before)
    if stop == "lift":
        return _lifted(system, before)
    if stop in ("grip", "stop"):
        before = _come_to_it(system, law, time, numbers, stop)
        time = before.time
    follows = _touching(system, before, gave_way=stop)
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
    at = _Touch.of(system, state)
    left = np.linalg.norm(numbers[10:13]) if stop == "grip" else state_turning(at.contact, at.Omega).norm() * at.arm
    return bool(left > 1e2 * _still(system, at))


def _extras(system: RollingSystem, at: _Touch, slip: Vector | None = None) -> tuple[float, ...]:
    """Return what the stops of slipping take: when slip is all but nothing, and its direction; or those of turning."""
    v = state_turning(at.contact, at.Omega) if slip is None else slip
    still = _still(system, at) / (at.arm if slip is None else 1.0)
    return still**2, *_floats(v / v.norm())


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
    state = _state(system, law, time, numbers)
    if _goes_on(system, state, numbers, "stop"):
        return False
    at = _Touch.of(system, state)
    relative = at.Omega - at.contact.support.angular_velocity
    return bool(abs(relative.dot(at.contact.normal)) * at.arm > 1e-9 * at.scale(system))


def _state(system: RollingSystem, law: Law, time: float, numbers: Any) -> State:
    return law.record(system, np.array([time]), np.asarray(numbers, dtype=float)[None]).state(0)


def _floats(v: Vector) -> tuple[float, float, float]:
    return float(v.x), float(v.y), float(v.z)


def _fly(system: RollingSystem, state: State, least_gap: float = 0.0, events: tuple[Event, ...] = ()) -> Next:
    law = FlightLaw()
    numbers = law.pack(system, state)
    numbers[13] = max(numbers[13], least_gap)
    return Next(law, state.time, numbers, (), events)


def _lifted(system: RollingSystem, state: State) -> Next:
    at = _Touch.of(system, state)
    if system.support.friction is None and _pull(system, at) > _PULLED_BACK * at.scale(system) ** 2 / at.arm:
        raise SolverError(
            f"At t = {state.time:.9g} s friction without limit would have to hold the body down, which no support "
            "does. Give the support a `friction`, so that the body slips before that."
        )
    event = Event(state.time, "lift", f"came off the support at t = {state.time:.9g} s", state, state)
    return _fly(system, state, _TAKE_OFF * at.arm, (event,))


def _pull(system: RollingSystem, at: _Touch) -> float:
    """Return how fast the body would come down on the support if it did not push, m/s²."""
    own = at.state.support
    free = slip(system, at.state.time, at.contact.point, at.orientation, at.Omega, at.sliding, own, direction=ZERO)
    n = at.contact.normal
    return float(free.normal_force * response(system, at.contact, at.orientation, n).dot(n))


def _struck(system: RollingSystem, before: State) -> Next:
    """Let the body strike the support, and bounce or stay."""
    at = _Touch.of(system, before)
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
    follows = _touching(system, after)
    return replace(follows, events=(event, *follows.events))


def _set_down(system: RollingSystem, state: State) -> State:
    """Return a state that touches and stays: no velocity off the support, and none along it where that is rounding."""
    at = _Touch.of(system, state)
    limit = SLIP_TOLERANCE * at.speed
    held = at.sliding.norm() <= limit and system.support.friction != 0
    return at.moving(at.contact.rolling_velocity(at.Omega) + (ZERO if held else at.sliding), at.Omega)


def _come_to_it(system: RollingSystem, law: Law, time: float, numbers: Any, stop: str) -> State:
    """Go on straight from where slip or turning has all but ended to where it has ended."""
    y, wait = np.asarray(numbers, dtype=float), 0.0
    at = _Touch.of(system, _state(system, law, time, y))
    s = y[10:13] if stop == "grip" else state_turning(at.contact, at.Omega).array()
    length, still = float(np.linalg.norm(s)), _still(system, at)
    if length > 1e-3 * (still if stop == "grip" else still / at.arm):
        rates = np.array([float(rate) for rate in law.rates(system, time, y.tolist())])
        closing = float(-(s @ (rates[10:13] if stop == "grip" else rates[7:10])) / length)
        wait = length / closing if closing > 0 else 0.0
        y = y + wait * rates
        at = _Touch.of(system, _state(system, law, time + wait, y))
    Omega = at.Omega if stop == "grip" else at.Omega - state_turning(at.contact, at.Omega)
    return replace(at.moving(at.contact.rolling_velocity(Omega), Omega), time=time + wait)


def _touching(system: RollingSystem, state: State, gave_way: str = "") -> Next:
    """Return the phase of a body that touches and stays: slipping where it slips, else what its forces ask for.

    Where static friction or the resistance has just given way, "slip" or "start", rounding no longer decides it.
    """
    at = _Touch.of(system, state)
    support, limit = system.support, SLIP_TOLERANCE * at.speed
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


def moment(system: RollingSystem, state: State) -> float:
    """Return a time in which a motion changes: |ρ| over its speed, or over what the forces make of it.

    Parameters
    ----------
    system : RollingSystem
        Body, support and loads.
    state : State
        At a contact.

    Returns
    -------
    float
        s.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> moment(table, table.place(velocity=(10.0, 0.0)))
    0.01
    """
    at = _Touch.of(system, state)
    return float(at.arm / at.scale(system))


def _still(system: RollingSystem, at: _Touch) -> float:
    return _STILL * at.scale(system)


def _rolling(system: RollingSystem, at: _Touch, *, slips: bool) -> Next:
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
        return _begins_to_slip(system, at, f)
    if any(load.stops for load in system.loads):
        return _turning_on(system, at, lifts=not weightless)
    law = RollingLaw(lifts=not weightless, grips=not weightless)
    return Next(law, state.time, law.pack(system, state))


def _turning_on(system: RollingSystem, at: _Touch, *, lifts: bool) -> Next:
    """Return rolling against a resistance; from rest, with a first little turn the way it is driven."""
    law, state, still = RollingWithResistance(lifts=lifts, grips=lifts), at.state, _still(system, at) / at.arm
    turning = state_turning(at.contact, at.Omega)
    if turning.norm() <= 2 * still:
        law_at_rest = RestingLaw()
        couple = law_at_rest.held(system, state.time, law_at_rest.pack(system, state)).couple
        driven = couple - at.contact.normal * couple.dot(at.contact.normal)
        way = driven * (-4 * still / driven.norm()) if driven.norm() > 0 else ZERO
        Omega = at.Omega - turning + way
        state = at.moving(at.contact.rolling_velocity(Omega), Omega)
    return Next(law, state.time, law.pack(system, state), _extras(system, _Touch.of(system, state)))


def _resting(system: RollingSystem, at: _Touch) -> Next | None:
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


def _begins_to_slip(system: RollingSystem, at: _Touch, needed: Vector) -> Next:
    """Return slipping after its first moment, in which the body still rolls but for what friction cannot give.

    What it cannot give grows from nothing, mostly, and so the slip is the integral of a slope. Its direction would
    settle so fast at first that no method could follow.
    """
    state, numbers = at.state, RollingLaw().pack(system, at.state)
    begun = _way(system, at, needed)[1]

    def later(wait: float) -> tuple[_Touch, Vector, float]:
        moved = RollingLaw().advanced(system, state.time, numbers, wait)
        then = _Touch.of(system, _state(system, RollingLaw(), state.time + wait, moved))
        return (then, *_way(system, then, _friction(system, then)))

    trial = _FIRST * at.arm / at.scale(system)
    growth = max((later(trial)[2] - begun) / trial, 1e-300)
    settling = needed.norm() * response(system, at.contact, at.orientation, needed / needed.norm()).norm()
    wait = trial if begun > 0 else min(max(settling / (_SETTLED_IN * growth), trial), 1000 * trial)
    (middle, *_), (then, hat, speed) = (later(0.5 * wait), later(wait))
    halfway = _way(system, middle, _friction(system, middle))[1]
    slip = hat * (wait * (begun + 4 * halfway + speed) / 6)
    follows = SlippingLaw()
    changed = follows.pack(system, _pushed(system, then, slip))
    near = min((0.25 * slip.norm()) ** 2, _still(system, at) ** 2)
    return Next(follows, then.state.time, changed, (near, *_floats(hat)))


def _friction(system: RollingSystem, at: _Touch) -> Vector:
    """Return the friction that rolling takes."""
    state, n = at.state, at.contact.normal
    R = roll(system, state.time, at.contact.point, at.orientation, at.Omega, state.support).reaction
    return R - n * n.dot(R)


def _pushed(system: RollingSystem, at: _Touch, slip: Vector) -> State:
    """Return the state after the impulse at the contact that makes it slip so."""
    columns = [response(system, at.contact, at.orientation, e) for e in (E_X, E_Y, E_Z)]
    P = Matrix(*columns).transpose.solve(slip)
    J = system.body.inertia_in_space(at.orientation.matrix())
    own = at.state.support
    if system.support.motion.free:
        own = (
            *own[:-1],
            own[-1] - float(at.contact.support.lever(at.contact.point).dot(P) / system.support.motion.inertia),
        )
    return at.moving(at.V + P / system.body.mass, at.Omega + J.solve(at.contact.offset.cross(P)), own)


def _way(system: RollingSystem, at: _Touch, needed: Vector) -> tuple[Vector, float]:
    """Return the direction ŝ in which slip grows along ŝ when friction acts against it, and how fast, m/s²."""
    from scipy.optimize import brentq

    first = needed / -needed.norm()
    second = at.contact.normal.cross(first)

    def grows(hat: Vector) -> Vector:
        own = at.state.support
        return slip(system, at.state.time, at.contact.point, at.orientation, at.Omega, ZERO, own, hat).slip_rate

    if grows(first).norm() <= _JUST * needed.norm() / system.body.mass:  # it gives way just now
        return first, 0.0

    def hat_at(angle: float) -> Vector:
        return first * math.cos(angle) + second * math.sin(angle)

    def across(angle: float) -> float:
        hat = hat_at(angle)
        return float(grows(hat).dot(at.contact.normal.cross(hat)))

    angles = np.linspace(-math.pi, math.pi, 73)
    values = [across(angle) for angle in angles]
    found = []
    for i in range(len(angles) - 1):
        if values[i] * values[i + 1] <= 0:
            angle = brentq(across, angles[i], angles[i + 1], xtol=1e-15)
            found.append((float(grows(hat_at(angle)).dot(hat_at(angle))), hat_at(angle)))
    growing = [pair for pair in found if pair[0] > 0]
    if not growing:
        raise SolverError(
            f"At t = {at.state.time:.9g} s the body can neither roll nor slip any way (friction jams it: Painlevé's "
            "paradox of rigid contact). Use less friction."
        )
    speed, hat = max(growing, key=lambda pair: pair[0])
    return hat, speed


__all__ = ["SETTLED", "Next", "after", "at_start", "spins_on"]
