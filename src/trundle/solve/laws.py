"""The laws of the phases of contact as the numerical methods take them: a state of numbers, its rates, what ends it.

A phase ends where one of its event functions falls through zero: that is a stop. Each law also packs a state into its
numbers and completes these to a full record; the mechanics itself is in `mechanics.contact` and `mechanics.slipping`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..mechanics.algebra import ZERO, Quaternion, Vector
from ..mechanics.contact import Contact, Rolling, contact_at, roll
from ..mechanics.loads import BodyMotion
from ..mechanics.nearest import nearest
from ..mechanics.scalars import Scalar, as_float, is_zero
from ..mechanics.slipping import Flying, Slipping, fly, slip, slip_direction, unturned
from ..mechanics.system import RollingSystem, State
from .contact_state import ContactState, floats
from .samples import FLIGHT, RESTING, ROLLING, SLIPPING, Array, Samples

CONTACT = ("p_x", "p_y", "p_z", "q_w", "q_x", "q_y", "q_z", "Omega_x", "Omega_y", "Omega_z")
Numbers = Sequence[Scalar]
Rates = Callable[[float, Sequence[float]], Sequence[float]]  # of time and state


class Law:
    """What a phase is to a method.

    Parameters of the class
    -----------------------
    code : int
        The phase, as in `Samples.phase`.
    variables : tuple of str
        Names of the state's numbers; those of the support's own motion come after them.
    ends : tuple of str
        Which of its events come where something shrinks to nothing: "grip", the slip; "stop", turning over the support.
    brief : bool
        Whether it holds for so short a time that to compile it would take longer than to follow it.
    in_charts : bool
        Whether its state is no more than place, turning and the support's own motion, which charts know.
    variational : bool
        Whether its numbers are those of another law with their derivatives.
    unwatched : int
        How many of the last numbers have no say in how long a step is.

    Parameters
    ----------
    weightless : bool
        Whether nothing presses the body on, as on a plane without gravity: its event functions then take one more, the
        pull, N, that is rounding and lifts nothing off.
    """

    code: int
    variables: tuple[str, ...] = CONTACT
    brief: bool = False
    in_charts: bool = False
    unwatched: int = 0
    variational: bool = False

    def __init__(self, weightless: bool = False) -> None:
        self.weightless = weightless

    @property
    def ends(self) -> tuple[str, ...]:
        """Which of its events come where something shrinks to nothing."""
        return ()

    @property
    def ending(self) -> int:
        """How many numbers end slip or turning for each such event: the square of what is all but nothing, and ŝ."""
        return 4 * len(self.ends)

    @property
    def event_parameters(self) -> int:
        """How many numbers the event functions take besides the system's."""
        return self.ending + self.weightless

    def _floor(self, event_parameters: Numbers) -> tuple[Scalar, Numbers]:
        """Return the pull that lifts nothing off, N, and the numbers that end slip or turning."""
        return (event_parameters[0], event_parameters[1:]) if self.weightless else (0.0, event_parameters)

    def names(self, system: RollingSystem) -> tuple[str, ...]:
        """Return the names of all numbers of the state."""
        return (*self.variables, *(f"support_{name}" for name in system.support.motion.coordinates))

    def split(self, state: Numbers) -> tuple[Vector, Quaternion, Vector, Numbers, tuple[Scalar, ...]]:
        """Return p, q, Ω, the numbers that this phase adds, and those of the support's own motion."""
        coordinates = len(self.variables)
        return (
            Vector(*state[:3]),
            Quaternion(*state[3:7]),
            Vector(*state[7:10]),
            state[10:coordinates],
            tuple(state[coordinates:]),
        )

    def rates(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return the rates of the state."""
        raise NotImplementedError

    def event_functions(
        self, system: RollingSystem, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> dict[str, Scalar]:
        """Return what ends the phase where it falls through zero, by name."""
        raise NotImplementedError

    def reaction(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:
        """Return R, the contact force on the body, N."""
        raise NotImplementedError

    def found(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:  # noqa: ARG002
        """Return what else of a state it takes some work to find; nothing, mostly."""
        return []

    def pack(self, system: RollingSystem, state: State) -> list[float]:
        """Return the numbers of a state."""
        return self.state_vector(ContactState.of(system, state))

    def state_vector(self, at: ContactState) -> list[float]:
        """Return the numbers of a body at its contact."""
        raise NotImplementedError

    def record(self, system: RollingSystem, time: Array, states: Array) -> Samples:
        """Complete states (n, ...) to full samples."""
        raise NotImplementedError

    def unpack(self, system: RollingSystem, time: float, numbers: Sequence[float] | Array) -> ContactState:
        """Return the body that is meant by its numbers."""
        plain = [as_float(number) for number in numbers]
        p, q, Omega, rest, coordinates = self.split(plain)
        q = q.unit
        contact = self._contact(system, time, p, q, rest, coordinates)
        Omega = self._turns(contact, Omega)
        centre, V = self._moves(contact, Omega, rest)
        s = self._slip(system, time, plain)
        at = ContactState.at(
            State(floats(centre), floats(V if s is None else V + s), floats(Omega), tuple(q), time, coordinates),
            contact,
        )
        return at if s is None else replace(at, slip=s)

    def motion(self, system: RollingSystem, time: Scalar, state: Numbers) -> BodyMotion:
        """Return what loads may depend on."""
        p, q, Omega, rest, coordinates = self.split(state)
        contact = contact_at(system, time, p, q, coordinates)
        Omega = self._turns(contact, Omega)
        V, s = self._moves(contact, Omega, rest)[1], self._slip(system, time, state)
        return contact.body_motion(system.body.mass, time, V if s is None else V + s, q, Omega)

    def _contact(
        self,
        system: RollingSystem,
        time: Scalar,
        p: Vector,
        q: Quaternion,
        rest: Numbers,  # noqa: ARG002
        coordinates: tuple[Scalar, ...],
    ) -> Contact:
        """Return the geometry of touch, or where the body is nearest to the support."""
        return contact_at(system, time, p, q, coordinates)

    def _moves(self, contact: Contact, Omega: Vector, rest: Numbers) -> tuple[Vector, Vector]:  # noqa: ARG002
        """Return the centre of mass and its velocity, slip apart, which rolling gives unless the phase adds to it."""
        return contact.centre, contact.rolling_velocity(Omega)

    def _turns(self, contact: Contact, Omega: Vector) -> Vector:  # noqa: ARG002
        """Return Ω, of which the state's numbers may hold more than the phase lets it have."""
        return Omega

    def _slip(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector | None:  # noqa: ARG002
        """Return s to its last digit, which V and Ω do not tell, m/s; None in flight."""
        return ZERO

    def direction(self, system: RollingSystem, time: float, numbers: Sequence[float] | Array) -> Vector:
        """Return ŝ, the direction of the slip, of a phase that slips."""
        raise NotImplementedError

    def stiff(self, numbers: Array) -> bool:  # noqa: ARG002
        """Tell whether a part of the state settles far faster than all else changes."""
        return False

    def shrinking(self, system: RollingSystem, time: float, numbers: Sequence[float] | Array, stop: str) -> Vector:
        """Return what shrinks to nothing at a stop: the slip, m/s, or how the body turns over the support, rad/s."""
        p, q, Omega, rest, coordinates = self.split([as_float(number) for number in numbers])
        return (
            Vector(*rest[:3]) if stop == "grip" else state_turning(contact_at(system, time, p, q, coordinates), Omega)
        )

    def shrinking_rate(self, system: RollingSystem, time: float, numbers: Sequence[float] | Array, stop: str) -> Vector:
        """Return how fast that changes, m/s² or rad/s²; of Ω̇ only the part along the support."""
        plain = [as_float(number) for number in numbers]
        rate = Vector(*(as_float(part) for part in self.rates(system, time, plain)[_SHRINKS[stop]]))
        if stop == "stop":
            p, q, _, _, coordinates = self.split(plain)
            n = contact_at(system, time, p, q, coordinates).normal
            rate = rate - n * rate.dot(n)
        return rate

    def rk4_step(
        self, system: RollingSystem, time: Scalar, state: Numbers, step: Scalar, known: Rates | None = None
    ) -> list[Any]:
        """Return the state after a step so short that one of the classical Runge-Kutta method is exact.

        Its rates may be known as a function of time and state.
        """
        y = [as_float(number) for number in state]

        def after(wait: float, slopes: Sequence[Scalar]) -> list[Scalar]:
            at = [number + wait * slope for number, slope in zip(y, slopes, strict=True)]
            return [
                as_float(rate) for rate in (known(time + wait, at) if known else self.rates(system, time + wait, at))
            ]

        first = after(0.0, [0.0] * len(y))
        second = after(step / 2, first)
        third = after(step / 2, second)
        fourth = after(step, third)
        slopes = [a + 2 * b + 2 * c + d for a, b, c, d in zip(first, second, third, fourth, strict=True)]
        return [number + step / 6 * slope for number, slope in zip(y, slopes, strict=True)]

    def _bounds(self, system: RollingSystem, contact: Contact, orientation: Quaternion, gap: Scalar) -> dict[str, Any]:
        """Return the event functions of every phase: where the support ends, the body's shape, or what fits."""
        surface, support = system.support.surface, contact.support
        there, found = support.local(contact.point), {}
        if surface.rim is not None:
            found["rim"] = surface.rim * surface.rim - (there.x * there.x + there.y * there.y)
        ending = surface.domain_margin(there)
        if ending is not None:
            found["end"] = ending - _SHORT_OF_IT * contact.offset.norm()
        covered = system.body.shape.validity_margin(-(orientation.matrix().transpose @ contact.normal))
        if covered is not None:
            found["edge"] = covered
        if not contact.flat:
            found["curved"] = contact.relative_curvature_determinant(gap) - _SHORT_OF_IT
        return found


class RollingLaw(Law):
    """No slip: the state is (p, q, Ω)."""

    code = ROLLING
    in_charts = True

    def _now(self, system: RollingSystem, time: Scalar, state: Numbers) -> Rolling:
        p, q, Omega, _, coordinates = self.split(state)
        return roll(system, time, p, q, Omega, coordinates)

    def rates(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return ṗ, q̇, Ω̇."""
        now = self._now(system, time, state)
        coordinates = system.support.motion.coordinate_rates(time, self.split(state)[4], now.axle_moment)
        return [*now.point_rate, *now.orientation_rate, *now.angular_acceleration, *coordinates]

    def event_functions(
        self, system: RollingSystem, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> dict[str, Scalar]:
        """Return the normal force, the rest of the friction cone, and the bounds."""
        now, (floor, ending) = self._now(system, time, state), self._floor(event_parameters)
        found = cone(system, now.contact, now.reaction, now.normal_force, floor)
        if ending:
            turning = state_turning(now.contact, Vector(*state[7:10]))
            found |= _ending("stop", turning, now.angular_acceleration, ending)
        return {**found, **self._bounds(system, now.contact, Quaternion(*state[3:7]), 0.0)}

    def reaction(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:
        """Return R of the law."""
        return self._now(system, time, state).reaction

    def state_vector(self, at: ContactState) -> list[float]:
        """Return p = r + ρ, q and Ω."""
        return [*at.nearest, *at.orientation, *at.Omega, *at.state.support]

    def record(self, system: RollingSystem, time: Array, states: Array) -> Samples:
        """Complete p, q and Ω by the rolling law."""
        p, q, Omega, coordinates = _columns(states, len(self.variables))
        now = roll(system, time, Vector.of(p), Quaternion.of(q), Vector.of(Omega), tuple(coordinates.T))
        centre, V, R = _arrays(p, now.contact.centre, now.velocity, now.reaction)
        return Samples(
            time, centre, p, V, Omega, q, R + 0.0, phase=_phase(time, self.code), support_coordinates=coordinates
        )


class RollingWithResistance(RollingLaw):
    """Rolling that comes to a stop where the body no longer turns over the support."""

    @property
    def ends(self) -> tuple[str, ...]:
        """Its turning may end."""
        return ("stop",)


class SlippingLaw(Law):
    """Slipping with friction −μ N ŝ: the state is (p, q, Ω, s).

    Against resistance to rolling, turning over the support may end while slip goes on. Then a couple, no larger than
    the resistance, holds the body so until more would be asked of it, "start".

    Parameters
    ----------
    weightless : bool
        As of `Law`.
    turning : str
        "free"; "resisted"; or "held", where the body does not turn over the support.
    """

    code = SLIPPING
    variables: tuple[str, ...] = (*CONTACT, "s_x", "s_y", "s_z")

    def __init__(self, weightless: bool = False, turning: str = "free") -> None:
        super().__init__(weightless)
        self.turning = turning

    @property
    def held(self) -> bool:
        """Whether resistance keeps the body from turning over the support."""
        return self.turning == "held"

    @property
    def ends(self) -> tuple[str, ...]:
        """Its slip may end, and turning that is resisted."""
        return ("grip", *self._turning_ends)

    @property
    def _turning_ends(self) -> tuple[str, ...]:
        return ("stop",) if self.turning == "resisted" else ()

    def _turns(self, contact: Contact, Omega: Vector) -> Vector:
        return unturned(contact, Omega) if self.held else Omega

    def _now(self, system: RollingSystem, time: Scalar, state: Numbers, direction: Vector | None = None) -> Slipping:
        p, q, Omega, s, coordinates = self.split(state)
        return slip(system, time, p, q, Omega, Vector(*s), coordinates, direction, held=self.held)

    def rates(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return ṗ, q̇, Ω̇, ṡ."""
        now = self._now(system, time, state)
        coordinates = system.support.motion.coordinate_rates(time, self.split(state)[4], now.axle_moment)
        return [*now.point_rate, *now.orientation_rate, *now.angular_acceleration, *now.slip_rate, *coordinates]

    def event_functions(
        self, system: RollingSystem, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> dict[str, Scalar]:
        """Return the normal force, its own effect on the gap, what is left of slip and turning, and the bounds."""
        now, ending = self._now(system, time, state), self._floor(event_parameters)[1]
        found = self._pressing(system, now, event_parameters)
        for i, name in enumerate(self.ends if ending else ()):
            v, rate = Vector(*state[10:13]), now.slip_rate
            if name == "stop":
                v, rate = state_turning(now.contact, Vector(*state[7:10])), now.angular_acceleration
            found |= _ending(name, v, rate, ending[4 * i : 4 * i + 4])
        return {**found, **self._bounds(system, now.contact, Quaternion(*state[3:7]), 0.0)}

    def _pressing(self, system: RollingSystem, now: Slipping, event_parameters: Numbers) -> dict[str, Scalar]:
        """Return the normal force, and how it opens the contact where friction may turn that round."""
        found = {"lift": now.normal_force + self._floor(event_parameters)[0]}
        if self.held:
            found["start"] = left_of_resistance(system, found["lift"], now.holding)
        if not is_zero(system.support.friction):
            found["jam"] = now.opening_per_newton * system.body.mass - JAMS
        return found

    def reaction(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:
        """Return R of the law."""
        return self._now(system, time, state).reaction

    def state_vector(self, at: ContactState) -> list[float]:
        """Return p, q, Ω and the part of s along the support."""
        return [*at.nearest, *at.orientation, *at.Omega, *at.sliding, *at.state.support]

    def record(self, system: RollingSystem, time: Array, states: Array) -> Samples:
        """Complete p, q, Ω and s by the law of slipping."""
        p, q, Omega, coordinates = _columns(states, len(self.variables))
        now = self._recorded(system, time, states)
        turning = self._turns(now.contact, Vector.of(Omega))
        centre, V, R, Omega = _arrays(p, now.contact.centre, now.velocity, now.reaction, turning)
        return Samples(
            time, centre, p, V, Omega, q, R + 0.0, phase=_phase(time, self.code), support_coordinates=coordinates
        )

    def _slip(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:  # noqa: ARG002
        return Vector(*state[10:13])

    def direction(self, system: RollingSystem, time: float, numbers: Sequence[float] | Array) -> Vector:  # noqa: ARG002
        """Return ŝ, the direction of the slip."""
        return slip_direction(Vector(*map(as_float, numbers[10:13])))

    def stiff(self, numbers: Array) -> bool:
        """Tell whether it slips so slowly that the direction of its slip settles far faster than all else changes."""
        s, Omega = (float(np.linalg.norm(part)) for part in (numbers[10:13], numbers[7:10]))
        return "grip" in self.ends and 0 < s < _SLOW_SLIP * Omega

    def _recorded(self, system: RollingSystem, time: Array, states: Array) -> Slipping:
        columns = list(states.T)
        columns[3:7] = _unit(states[:, 3:7]).T
        s = Vector(*columns[10:13])
        length = s.norm()
        return self._now(system, time, columns, s / np.where(length > 0, length, 1.0))  # none where s has just ended


class SlidingFreely(SlippingLaw):
    """Contact without any friction: s has no part in the force, and never grips."""

    @property
    def ends(self) -> tuple[str, ...]:
        """Only turning that is resisted may end."""
        return self._turning_ends

    def _now(
        self,
        system: RollingSystem,
        time: Scalar,
        state: Numbers,
        direction: Vector | None = ZERO,  # noqa: ARG002
    ) -> Slipping:
        p, q, Omega, s, coordinates = self.split(state)
        return slip(system, time, p, q, Omega, Vector(*s), coordinates, ZERO, held=self.held)


class FlightLaw(Law):
    """Nothing touches: the state is (p, q, Ω, V, g, r), p being the support's point nearest to the body, g the gap.

    The body is where r is. Where its shape ends, or by the apex of a cone, p loses digits of which r − ρ + g n would
    have as few; p and g only say what is near, and when it lands.
    """

    code = FLIGHT
    variables = (*CONTACT, "V_x", "V_y", "V_z", "g", "r_x", "r_y", "r_z")

    def _now(self, system: RollingSystem, time: Scalar, state: Numbers) -> Flying:
        p, q, Omega, rest, coordinates = self.split(state)
        return fly(system, time, p, rest[3], Vector(*rest[4:]), q, Omega, Vector(*rest[:3]), coordinates)

    def rates(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return ṗ, q̇, Ω̇, V̇, ġ and ṙ = V."""
        now, (*_, rest, coordinates) = self._now(system, time, state), self.split(state)
        coordinate_rates = system.support.motion.coordinate_rates(time, coordinates, 0.0)
        turning = now.angular_acceleration
        moving = (*now.acceleration, now.gap_rate, *rest[:3])
        return [*now.point_rate, *now.orientation_rate, *turning, *moving, *coordinate_rates]

    def event_functions(
        self,
        system: RollingSystem,
        time: Scalar,
        state: Numbers,
        event_parameters: Numbers,  # noqa: ARG002
    ) -> dict[str, Scalar]:
        """Return the gap and the bounds."""
        p, q, _, rest, coordinates = self.split(state)
        contact = contact_at(system, time, p, q, coordinates)
        return {"land": rest[3], **self._bounds(system, contact, q, rest[3])}

    def reaction(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:  # noqa: ARG002
        """Return 0: nothing touches."""
        return ZERO

    def state_vector(self, at: ContactState) -> list[float]:
        """Return the nearest point, q, Ω, V, the gap and r."""
        return [*at.contact.point, *at.orientation, *at.Omega, *at.V, at.gap, *at.state.position, *at.state.support]

    def _contact(
        self,
        system: RollingSystem,
        time: Scalar,
        p: Vector,
        q: Quaternion,
        rest: Numbers,
        coordinates: tuple[Scalar, ...],
    ) -> Contact:
        """Return the geometry where the body that is at r is nearest: p is beside that by what it has lost."""
        return nearest(system, time, p, Vector(*rest[4:]), q, coordinates)

    def _moves(self, contact: Contact, Omega: Vector, rest: Numbers) -> tuple[Vector, Vector]:  # noqa: ARG002
        return Vector(*rest[4:]), Vector(*rest[:3])

    def _slip(self, system: RollingSystem, time: Scalar, state: Numbers) -> None:  # noqa: ARG002
        return None

    def motion(self, system: RollingSystem, time: Scalar, state: Numbers) -> BodyMotion:
        """Return what loads may depend on: of the support they know nothing."""
        _, q, Omega, rest, _ = self.split(state)
        return BodyMotion(time, system.body.mass, Vector(*rest[4:]), Vector(*rest[:3]), q, Omega)

    def record(self, system: RollingSystem, time: Array, states: Array) -> Samples:
        """Complete the state of a flight; nothing pushes then."""
        p, q, Omega, coordinates = _columns(states, len(self.variables))
        rest = states[:, 10 : len(self.variables)].copy()
        contact = self._contact(system, time, Vector.of(p), Quaternion.of(q), list(rest.T), tuple(coordinates.T))
        (point,), phase = _arrays(p, contact.point), _phase(time, self.code)
        return Samples(
            time,
            rest[:, 4:],
            point,
            rest[:, :3],
            Omega,
            q,
            np.zeros_like(p),
            phase=phase,
            support_coordinates=coordinates,
        )


class RestingLaw(Law):
    """At rest on the support, which carries the body along: the state is (p, q, Ω)."""

    code = RESTING

    def rates(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return the rates of a body that turns with the support."""
        p, q, _, _, coordinates = self.split(state)
        support = system.support.motion.at(time, *coordinates)
        along = system.support.motion.coordinate_rates(time, coordinates, 0.0)
        turning = support.angular_velocity
        return [*support.material_velocity(p), *q.rate(turning), *support.angular_acceleration, *along]

    def held(self, system: RollingSystem, time: Scalar, state: Numbers) -> Held:
        """Return what holds the body: the contact force and the couple that rest takes."""
        p, q, _, _, coordinates = self.split(state)
        m, contact = system.body.mass, contact_at(system, time, p, q, coordinates)
        support, Q = contact.support, q.matrix()
        turning = support.angular_velocity
        V = support.material_velocity(contact.centre)
        motion = BodyMotion(time, m, contact.centre, V, q, turning, contact.normal, turning)
        F, K = system.loads_on(motion)
        R = support.material_acceleration(contact.centre, V) * m - F
        J = system.body.inertia_in_space(Q)
        couple = J @ support.angular_acceleration + system.body.gyroscopic(Q, turning) - K - contact.offset.cross(R)
        return Held(contact, V, R, couple)

    def event_functions(
        self, system: RollingSystem, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> dict[str, Scalar]:
        """Return what is left of the resistance, of the friction cone and of the normal force."""
        held, (floor, _) = self.held(system, time, state), self._floor(event_parameters)
        n = held.contact.normal
        over = held.couple - n * n.dot(held.couple)
        found = cone(system, held.contact, held.reaction, n.dot(held.reaction), floor)
        found["start"] = left_of_resistance(system, n.dot(held.reaction) + floor, over)
        return {**found, **self._bounds(system, held.contact, Quaternion(*state[3:7]), 0.0)}

    def reaction(self, system: RollingSystem, time: Scalar, state: Numbers) -> Vector:
        """Return what carries the body."""
        return self.held(system, time, state).reaction

    def state_vector(self, at: ContactState) -> list[float]:
        """Return p, q and Ω."""
        return RollingLaw().state_vector(at)

    def _moves(self, contact: Contact, Omega: Vector, rest: Numbers) -> tuple[Vector, Vector]:  # noqa: ARG002
        return contact.centre, contact.support.material_velocity(contact.centre)

    def record(self, system: RollingSystem, time: Array, states: Array) -> Samples:
        """Complete the state of a body at rest on its support."""
        p, q, Omega, coordinates = _columns(states, len(self.variables))
        columns = list(states.T)
        columns[3:7] = q.T
        held = self.held(system, time, columns)
        centre, V, R = _arrays(p, held.contact.centre, held.velocity, held.reaction)
        return Samples(
            time, centre, p, V, Omega, q, R + 0.0, phase=_phase(time, self.code), support_coordinates=coordinates
        )


@dataclass(frozen=True, slots=True)
class Held:
    """A body at rest on its support: where, and what that takes."""

    contact: Contact
    velocity: Vector
    reaction: Vector  # R, N
    couple: Vector  # that the support exerts besides, N m


# A run stops so far short of an end at which the law is singular; in units of |ρ|, and of 1 + C S.
_SHORT_OF_IT = 1e-6
# By this share static friction and resistance hold more than they say, so that rounding does not decide.
CONE_SLACK = 1e-9
# Friction all but jams a body where a newton of N opens the contact by so small a share of 1/m.
JAMS = 1e-3
AN_INSTANT = 3e-15  # s: what ends in less has ended, for the terms of its series are greater than any float
CORNER = "corner"  # with which the names of events begin at which the same law goes on
_SLOW_SLIP = 1e-8  # m/s for each rad/s of Ω
_SHRINKS = {"grip": slice(10, 13), "stop": slice(7, 10)}  # the numbers that change as what shrinks to nothing there


def left_of_resistance(system: RollingSystem, normal_force: Scalar, holding: Vector) -> Scalar:
    """Return what is left of resistance to rolling that holds a body: its most squared less the couple squared."""
    most = system.resistance * normal_force
    return most * most * (1 + CONE_SLACK) - holding.dot(holding)


def cone(
    system: RollingSystem, contact: Contact, reaction: Vector, N: Scalar, floor: Scalar = 0.0
) -> dict[str, Scalar]:
    """Return the normal force, and what is left of the friction cone where friction has a limit."""
    n = contact.normal
    found = {"lift": N + floor}
    if system.support.friction is not None:
        f, most = reaction - n * N, system.support.friction * (N + floor)
        found["slip"] = most * most * (1 + CONE_SLACK) - f.dot(f)
    return found


def _ending(name: str, v: Vector, rate: Vector, event_parameters: Numbers) -> dict[str, Scalar]:
    """Return two event functions for a vector that shrinks to nothing.

    Where its direction stays, its part along the direction it had passes through zero with it. Where it turns, the law
    grows singular there, and the run stops just before; a quarter turn alone is no end.
    """
    near, *before = event_parameters
    return {name: v.dot(Vector(*before)), f"near {name}": v.dot(v) - near - rate.dot(rate) * AN_INSTANT**2}


def state_turning(contact: Contact, angular_velocity: Vector) -> Vector:
    """Return the part of Ω − ω along the support: how the body turns over it, rad/s."""
    relative = angular_velocity - contact.support.angular_velocity
    return relative - contact.normal * relative.dot(contact.normal)


def _unit(q: Array) -> Array:
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def _columns(states: Array, size: int) -> tuple[Array, Array, Array, Array]:
    """Return p, unit q, Ω and the support's own coordinates."""
    return states[:, :3].copy(), _unit(states[:, 3:7]), states[:, 7:10].copy(), states[:, size:].copy()


def _arrays(like: Array, *vectors: Vector) -> list[Array]:
    return [np.broadcast_to(vector.array(), like.shape).copy() for vector in vectors]


def _phase(time: Array, code: int) -> Any:
    return np.full(time.size, code, dtype=np.int8)
