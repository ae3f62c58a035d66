"""The law of a body at rest on its support, and what holds it there."""

from __future__ import annotations

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.contact import Contact, contact_at
from ...mechanics.loads import BodyMotion
from ...mechanics.records import frozen_record
from ...mechanics.scalars import Scalar
from ...mechanics.system import RollingSystem
from ..contact_state import ContactState
from ..samples import RESTING, Array, Samples
from .columns import arrays, columns_of, phase_of
from .friction import cone, left_of_resistance
from .law import Law, Numbers
from .rolling import RollingLaw


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
        p, q, Omega, coordinates = columns_of(states, len(self.variables))
        columns = list(states.T)
        columns[3:7] = q.T
        held = self.held(system, time, columns)
        centre, V, R = arrays(p, held.contact.centre, held.velocity, held.reaction)
        return Samples(
            time, centre, p, V, Omega, q, R + 0.0, phase=phase_of(time, self.code), support_coordinates=coordinates
        )


@frozen_record()
class Held:
    """A body at rest on its support: where, and what that takes."""

    contact: Contact
    velocity: Vector
    reaction: Vector  # R, N
    couple: Vector  # that the support exerts besides, N m
