"""What a phase is to the numerical methods: a state of numbers, its rates, what ends it, and the full record.

A phase ends where one of its event functions falls through zero: that is a stop. The mechanics itself is in
`mechanics.contact` and `mechanics.slipping`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import replace
from typing import Any

from ...mechanics.algebra import ZERO, Quaternion, Vector
from ...mechanics.contact import Contact, contact_at
from ...mechanics.duals import value_of, values_of
from ...mechanics.loads import BodyMotion
from ...mechanics.scalars import Scalar, as_float
from ...mechanics.system import RollingSystem, State
from ..contact_state import ContactState, floats
from ..samples import Array, Samples

CONTACT = ("p_x", "p_y", "p_z", "q_w", "q_x", "q_y", "q_z", "Omega_x", "Omega_y", "Omega_z")
Numbers = Sequence[Scalar]
Rates = Callable[[float, Sequence[float]], Sequence[float]]  # of time and state
# A run stops so far short of an end at which the law is singular; in units of |ρ|, and of 1 + C S.
_SHORT_OF_IT = 1e-6
AN_INSTANT = 3e-15  # s: what ends in less has ended, for the terms of its series are greater than any float
CORNER = "corner"  # with which the names of events begin at which the same law goes on


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
    turning : str
        "free"; "resisted"; or "held", where the body slips and does not turn over the support.
    variational : bool
        Whether its numbers are those of another law with their derivatives.
    unwatched : int
        How many of the last numbers have no say in how long a step is.
    handed_on : tuple of str
        Events at which another law goes on with the same motion: an instant about there is as good.
    lasts : float
        About how long a brief law holds, s: a step that is much longer is taken for nothing.

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
    turning: str = "free"
    variational: bool = False
    handed_on: tuple[str, ...] = ()
    lasts: float = math.inf

    def __init__(self, weightless: bool = False) -> None:
        self.weightless = weightless

    def traced(self) -> Law:
        """Return a copy of which a tape may replace the numbers."""
        return copy(self)

    def before_series(self, *, late: bool = False) -> Law:  # noqa: ARG002
        """Return the law as it is followed until a method of series goes on: a brief one may be handed on sooner."""
        return self

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

    @property
    def identity(self) -> tuple[Any, ...]:
        """What tells it from other laws: its class, and its settings by name."""
        return type(self), *vars(self).items()

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
        """Return how fast that changes, m/s² or rad/s²; of how it turns only the part along the support."""
        plain = [as_float(number) for number in numbers]
        point, _, turning, rest, coordinates = self.split([as_float(rate) for rate in self.rates(system, time, plain)])
        if stop == "grip":
            return Vector(*rest[:3])
        p, q, Omega, _, own = self.split(plain)
        contact = contact_at(system, time, p, q, own)
        n, support = contact.normal, contact.support
        axle = support.axle * coordinates[-1] if system.support.motion.free else ZERO
        n_rate = support.angular_velocity.cross(n) + contact.shape_operator @ (point - support.material_velocity(p))
        rate = turning - support.angular_acceleration - axle - n_rate * n.dot(Omega - support.angular_velocity)
        return rate - n * rate.dot(n)

    def moment(self, system: RollingSystem, at: ContactState, rates: Sequence[Scalar]) -> float:
        """Return a time in which a motion with these rates changes, s: at most that of the body.

        Where the support is all but as hollow as the body is round, the contact runs far faster than the body moves.
        """
        point, _, turning, *_ = self.split(values_of(tuple(rates)))
        body, arm = at.moment(system), value_of(at.arm)
        return float(1 / max(1 / body, point.norm() / arm, turning.norm() * body))

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
        covered = system.body.shape.validity_margin(-(contact.normal @ orientation.matrix()))
        if covered is not None:
            found["edge"] = covered
        if not contact.flat:
            found["curved"] = contact.relative_curvature_determinant(gap) - _SHORT_OF_IT
        return found


def shrinking_events(name: str, v: Vector, rate: Vector, event_parameters: Numbers) -> dict[str, Scalar]:
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
