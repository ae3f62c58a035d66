"""The law of a body in flight, with the point of the support that it is nearest to."""

from __future__ import annotations

import numpy as np

from ...mechanics.algebra import ZERO, Quaternion, Vector
from ...mechanics.contact import Contact, contact_at
from ...mechanics.loads import BodyMotion
from ...mechanics.nearest import nearest
from ...mechanics.scalars import Scalar
from ...mechanics.slipping import Flying, fly
from ...mechanics.system import RollingSystem
from ..contact_state import ContactState
from ..samples import FLIGHT, Array, Samples
from .columns import arrays, columns_of, phase_of
from .law import CONTACT, Law, Numbers


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
        p, q, Omega, coordinates = columns_of(states, len(self.variables))
        rest = states[:, 10 : len(self.variables)].copy()
        contact = self._contact(system, time, Vector.of(p), Quaternion.of(q), list(rest.T), tuple(coordinates.T))
        (point,), phase = arrays(p, contact.point), phase_of(time, self.code)
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
