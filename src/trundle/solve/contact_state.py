"""A body at its contact, and against what its motion there is small or not."""

from __future__ import annotations

import math

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import Contact, contact_at
from ..mechanics.duals import value_of
from ..mechanics.motions import SupportState
from ..mechanics.nearest import contact_of
from ..mechanics.records import frozen_record
from ..mechanics.scalars import as_float
from ..mechanics.system import RollingSystem, State

WEIGHTLESS = 1e-13  # share of the forces at hand below which nothing presses the body on
_UNSEEN = 1e-6  # 1/s: of what leads over |ρ| in no less than days, nothing is seen yet
_AHEAD = tuple(10.0**k for k in range(-6, 7))  # s
STILL = 1e-12  # share of the speeds at the contact at which slip or turning has all but ended


@frozen_record()
class ContactState:
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
    def of(system: RollingSystem, state: State, point: Vector | None = None) -> ContactState:
        """Return the contact of a state that touches the support, or is over it; it is searched for unless given."""
        if point is None:
            return ContactState.at(state, contact_of(system, state))
        q = Quaternion(*state.orientation)
        return ContactState.at(state, contact_at(system, state.time, point, q, state.support))

    @staticmethod
    def at(state: State, contact: Contact) -> ContactState:
        """Return the same for a contact that is known."""
        gap = (Vector(*state.position) + contact.offset - contact.point).dot(contact.normal)
        return ContactState._moving(
            state, contact, Quaternion(*state.orientation), as_float(gap), contact.offset.norm()
        )

    @staticmethod
    def _moving(state: State, contact: Contact, q: Quaternion, gap: float, arm: float) -> ContactState:
        """Return a body that moves as its state says where the geometry is known."""
        V, Omega = Vector(*state.velocity), Vector(*state.angular_velocity)
        u, turning = contact.support.material_velocity(contact.point), contact.support.angular_velocity
        speed = max(V.norm(), Omega.norm() * arm, u.norm(), turning.norm() * arm)
        slip = contact.slip_velocity(V, Omega)
        return ContactState(state, contact, q, V, Omega, slip, gap, arm, float(value_of(speed)))

    @property
    def nearest(self) -> Vector:
        """The point r + ρ of the body that touches, or that is nearest to the support, m."""
        return Vector(*self.state.position) + self.contact.offset

    @property
    def approach(self) -> float:
        """How fast it comes off the support, m/s; negative: how fast it comes down."""
        return as_float(self.slip.dot(self.contact.normal))

    @property
    def sliding(self) -> Vector:
        """The part of s along the support, m/s."""
        return self.slip - self.contact.normal * self.approach

    def moving(
        self, system: RollingSystem, V: Vector, Omega: Vector, support: tuple[float, ...] | None = None
    ) -> ContactState:
        """Return the body at the same place with other velocities, also of the support's own motion."""
        coordinates = self.state.support if support is None else support
        was = self.state
        state = State(was.position, floats(V), floats(Omega), was.orientation, was.time, coordinates)
        if coordinates == self.state.support:  # which is all of the motion that the geometry of touch depends on
            return ContactState._moving(state, self.contact, self.orientation, self.gap, self.arm)
        return ContactState.of(system, state, self.contact.point)

    def over(self, gap: float) -> ContactState:
        """Return the body moved along the normal until it is so far over the support, m."""
        centre, was = self.contact.centre + self.contact.normal * gap, self.state
        moved = State(floats(centre), was.velocity, was.angular_velocity, was.orientation, was.time, was.support)
        V, Omega, slip, arm, speed = self.V, self.Omega, self.slip, self.arm, self.speed
        return ContactState(moved, self.contact, self.orientation, V, Omega, slip, gap, arm, speed)

    def scale(self, system: RollingSystem) -> float:
        """Return a speed of this motion: the fastest at the contact, or what all that acts makes of it, m/s."""
        seen = max(self.speed, math.sqrt(self._pull(system, self.contact.support, 0.0) * value_of(self.arm)))
        if seen < _UNSEEN * value_of(self.arm):
            seen = max(seen, self._soon(system))
        return max(seen, 1e-30)

    def _pull(self, system: RollingSystem, support: SupportState, wait: float) -> float:
        """Return the greatest acceleration that acts on it here, or on the support, a little later, m/s²."""
        time, p = self.state.time + wait, self.contact.point
        motion = self.contact.body_motion(system.body.mass, time, self.V, self.orientation, self.Omega)
        force, torque = system.loads_on(motion)
        pull = (force.norm() + torque.norm() / self.arm) / system.body.mass
        return float(value_of(max(pull, support.material_acceleration(p, support.material_velocity(p)).norm())))

    def _soon(self, system: RollingSystem) -> float:
        """Return a speed of a motion yet to begin: |ρ| over the time in which what acts then leads so far, m/s."""
        arm = float(value_of(self.arm))
        for wait in _AHEAD:
            try:
                then = system.support.motion.at(self.state.time + wait, *self.state.support)
                if self._pull(system, then, wait) * wait**2 >= arm:
                    return arm / wait
            except (ArithmeticError, ValueError):  # a formula has no value so far ahead
                break
        return 0.0

    def moment(self, system: RollingSystem) -> float:
        """Return a time in which this motion changes, s."""
        return float(value_of(self.arm) / self.scale(system))

    def forces(self, system: RollingSystem) -> float:
        """Return the size of the forces in this motion, N."""
        return float(value_of(system.body.mass)) * self.scale(system) ** 2 / self.arm

    def still(self, system: RollingSystem) -> float:
        """Return the speed at which slip has all but ended, m/s."""
        return STILL * self.scale(system)

    def first_turn(self, system: RollingSystem) -> float:
        """Return how fast a body begins to turn against a resistance, rad/s: the least that surely has a direction."""
        return 4 * self.still(system) / self.arm


def moment(system: RollingSystem, state: State, contact: tuple[float, float, float] | None = None) -> float:
    """Return a time in which a motion changes: |ρ| over its speed, or over what the forces make of it.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> moment(table, table.place(velocity=(10.0, 0.0)))
    0.01
    """
    return ContactState.of(system, state, None if contact is None else Vector(*contact)).moment(system)


def floats(v: Vector) -> tuple[float, float, float]:
    """Return a vector's components, as Python's floats where they are numbers.

    Examples
    --------
    >>> floats(Vector(1, 2, 3))
    (1.0, 2.0, 3.0)
    """
    return as_float(v.x), as_float(v.y), as_float(v.z)
