"""A rolling system (body, support, loads) and a state to start it from."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from ..errors import InvalidValueError, did_you_mean
from . import checks, straight
from .algebra import E_Z, ZERO, Quaternion, Vector
from .bodies import Body
from .contact import Contact, touch
from .loads import Acting, BodyMotion, Gravity, Load
from .motions import Fixed, Motion
from .scalars import Scalar, is_number, is_zero, namespace
from .surfaces import Surface

STANDARD_GRAVITY = 9.80665  # m/s², exact by definition (3rd CGPM, 1901)
SLIP_TOLERANCE = 1e-9  # of the largest speed at the contact: beyond it a start slips


@dataclass(frozen=True)
class Support:
    """What the body rolls on: a surface, how it moves, how it leans.

    Parameters
    ----------
    surface : Surface
        The surface in the support's own frame.
    motion : Motion
        How it moves; at rest unless said otherwise.
    tilt : float or quantity
        α, the angle between the support's axis and the vertical, rad; the first axis points down the slope.
    friction : float, optional
        Coulomb coefficient; absent: it holds whatever rolling takes, and the card says how much that was.

    Examples
    --------
    >>> from trundle.mechanics.surfaces import Plane
    >>> Support(Plane(), tilt="3 deg").tilt
    0.05235987755982989
    """

    surface: Surface
    motion: Motion = field(default_factory=Fixed)
    tilt: Scalar = 0.0
    friction: Scalar | None = None

    def __post_init__(self) -> None:
        checks.instance(self.surface, Surface, "surface", "Give for instance tr.Plane(rim=0.5).")
        checks.instance(self.motion, Motion, "motion", "Give for instance tr.Spin(3.5).")
        tilt = checks.real(self.tilt, "angle", "tilt")
        if is_number(tilt):
            self.surface.check_tilt(tilt, self.tilt)
        object.__setattr__(self, "tilt", tilt)
        if self.friction is not None:
            object.__setattr__(self, "friction", checks.non_negative(self.friction, "number", "friction"))


@dataclass(frozen=True)
class State:
    """Where a body is and how it moves, in the inertial support frame.

    Parameters
    ----------
    position : tuple of 3 floats
        Centre of mass, m.
    velocity : tuple of 3 floats
        Of the centre of mass, m/s.
    angular_velocity : tuple of 3 floats
        Ω, rad/s.
    orientation : tuple of 4 floats
        Unit quaternion (w, x, y, z), body frame to support frame.
    time : float
        s.

    Examples
    --------
    >>> State((0.1, 0.0, 0.025), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)).orientation
    (1.0, 0.0, 0.0, 0.0)
    """

    position: tuple[float, float, float]
    velocity: tuple[float, float, float]
    angular_velocity: tuple[float, float, float]
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    time: float = 0.0


@dataclass(frozen=True)
class RollingSystem:
    """A body that rolls on a support under loads.

    Parameters
    ----------
    body : Body
        What rolls.
    support : Support
        What it rolls on.
    loads : sequence of Load
        Forces and torques besides gravity.
    gravity : float or quantity
        g, m/s²; 0 turns it off.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(3.49), tilt=0.05)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), table)
    >>> start = system.place(position=(0.10, 0.0), velocity=(0.0, 0.2))
    >>> [round(rate, 6) for rate in start.angular_velocity]
    [5.96, 0.0, 0.0]
    """

    body: Body
    support: Support
    loads: tuple[Load, ...] = ()
    gravity: Scalar = STANDARD_GRAVITY

    def __post_init__(self) -> None:
        checks.instance(self.body, Body, "body", "Give for instance tr.Body.solid_sphere(radius=0.025, mass=0.065).")
        checks.instance(self.support, Support, "support", "Give for instance tr.Support(tr.Plane()).")
        example = "Give for instance [tr.Drag(0.01)]."
        loads = self.loads if isinstance(self.loads, (list, tuple)) else (self.loads,)
        for i, load in enumerate(loads):
            checks.instance(load, Load, f"loads[{i}]", example)
        object.__setattr__(self, "loads", tuple(loads))
        object.__setattr__(self, "gravity", checks.non_negative(self.gravity, "acceleration", "gravity"))

    @property
    def weight(self) -> Gravity:
        """Gravity in the support frame: g(sin α, 0, −cos α)."""
        tilt = self.support.tilt
        xp = namespace(tilt)
        # The float nearest to a right angle means one: cos α as sin(π/2 − α) leaves no gravity along a level axis.
        normal = xp.cos(tilt) if getattr(xp, "exact", False) else xp.sin(0.5 * math.pi - xp.abs(tilt))
        return Gravity(self.gravity * xp.sin(tilt), 0.0, -(self.gravity * normal))

    @property
    def all_loads(self) -> tuple[Load, ...]:
        """Gravity and the other loads."""
        return (self.weight, *self.loads)

    def loads_on(self, motion: BodyMotion) -> tuple[Vector, Vector]:
        """Return the applied force F, N, and torque K about the centre of mass, N m."""
        acting = self.acting_on(motion)
        return acting.force, acting.torque

    def acting_on(self, motion: BodyMotion) -> Acting:
        """Return all that acts on the body besides the contact force."""
        force, torque, from_support, couple = ZERO, ZERO, ZERO, ZERO
        for load in self.all_loads:
            exerted = load.torque(motion)
            force, torque = force + load.force(motion), torque + exerted
            from_support = from_support + exerted if load.at_contact else from_support
            couple = couple + load.torque_per_normal_force(motion)
        return Acting(force, torque, from_support, couple)

    def place(
        self,
        position: Any = (0.0, 0.0),
        velocity: Any = None,
        spin: Any = None,
        angular_velocity: Any = None,
        orientation: Any = None,
        roll: Any = 0.0,
    ) -> State:
        """Put the body down so that it rolls from the first instant.

        Parameters
        ----------
        position : sequence of 2 floats or quantities
            On a plane, the centre of the body over it, m. On a curved support, the coordinates of the contact: on a
            cylinder the angle from its first axis towards the second, rad, and the height along its axis, m.
        velocity : sequence of 2 floats or quantities, or "co-rotating", optional
            Of the centre, in the inertial support frame, along the directions in which the two coordinates grow, m/s;
            absent: at rest. "co-rotating" releases the body from rest relative to the support's material under it.
        spin : float or quantity, optional
            Ω·n, rad/s; the rest of Ω follows from no slip. Absent: 0, or the support's rate when co-rotating.
        angular_velocity : sequence of 3 floats or quantities, optional
            Ω instead of `spin`; it must agree with rolling.
        orientation : sequence of 4 floats, optional
            Quaternion (w, x, y, z), body frame to support frame; it is normalised. Absent: not turned; a cylinder is
            laid across its way, the first axis of the body frame along the normal.
        roll : float or quantity
            Of a cylinder laid down so: the angle by which it has rolled on since, rad.

        Returns
        -------
        State
            The start.

        Raises
        ------
        InvalidValueError
            If a value is refused, the body is outside the rim, or the start contradicts itself.

        Examples
        --------
        >>> import trundle as tr
        >>> table = tr.Support(tr.Plane(), motion=tr.Spin(2.0))
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.5, mass=1.0), table)
        >>> system.place(position=(1.0, 0.0), velocity="co-rotating").velocity
        (0.0, 2.0, 0.0)
        """
        surface = self.support.surface
        u, v = (
            checks.real(part, kind, f"position[{i}]")
            for i, (part, kind) in enumerate(zip(_pair(position, "position"), surface.coordinates, strict=True))
        )
        begin = self.support.motion.at(0.0)
        turning = self.body.shape.axis is not None and orientation is None
        q = _unit_quaternion((1.0, 0.0, 0.0, 0.0) if orientation is None else orientation)
        contact = touch(self, 0.0, begin.carried(surface.point(u, v)), q)
        if turning:
            q = straight.facing(contact, begin, surface, velocity, checks.real(roll, "angle", "roll"))
            contact = touch(self, 0.0, contact.point, q)
        elif not is_zero(roll):
            raise InvalidValueError("roll", "belongs to a cylinder put down without `orientation`", roll)
        own = begin.rotation.transpose @ contact.offset
        contact = touch(self, 0.0, begin.carried(surface.under(u, v, own)), q)
        self.check_rim(contact.point, position)
        V = self._velocity(contact, velocity, begin.rotation.transpose @ (contact.point - begin.origin))
        Omega = self._angular_velocity(contact, V, spin, angular_velocity, isinstance(velocity, str))
        start = State(_triple(contact.centre), _triple(V), _triple(Omega), tuple(q))
        straight.check_start(self, start)
        return start

    def _velocity(self, contact: Contact, velocity: Any, own: Vector) -> Vector:
        """Return V from its components along the surface; the one along n follows from V·ρ = u·ρ."""
        begin, rho, n = contact.support, contact.offset, contact.normal
        first, second = (begin.rotation @ e for e in self.support.surface.directions(own))
        if isinstance(velocity, str):
            if velocity != "co-rotating":
                raise InvalidValueError(
                    "velocity",
                    'must be two components or "co-rotating"',
                    velocity,
                    did_you_mean(velocity, ["co-rotating"]).strip(),
                )
            carried = begin.material_velocity(contact.centre)
            along = (carried.dot(first), carried.dot(second))
        else:
            along = checks.components((0.0, 0.0) if velocity is None else velocity, "velocity", "velocity", 2)
        V = first * along[0] + second * along[1]
        u = begin.material_velocity(contact.point)
        return V + n * ((u - V).dot(rho) / n.dot(rho))

    def _angular_velocity(
        self, contact: Contact, V: Vector, spin: Any, angular_velocity: Any, co_rotating: bool
    ) -> Vector:
        u, rho = contact.support.material_velocity(contact.point), contact.offset
        if angular_velocity is None:
            turning = contact.support.angular_velocity.dot(contact.normal) if co_rotating else 0.0
            about_normal = turning if spin is None else checks.real(spin, "angular velocity", "spin")
            return _rolling_rate(V - u, rho, contact.normal, about_normal)
        if spin is not None:
            raise InvalidValueError(
                "angular_velocity", "must not stand beside `spin`", angular_velocity, "Give one of the two."
            )
        Omega = Vector(*checks.components(angular_velocity, "angular velocity", "angular_velocity"))
        _check_no_slip(contact.slip_velocity(V, Omega), V, Omega.cross(rho), u)
        return Omega

    def check_rim(self, point: Vector, position: Any) -> None:
        """Refuse a contact point at or beyond the rim, naming the position as the user gave it."""
        rim, distance = self.support.surface.rim, (point - self.support.motion.at(0.0).origin).norm()
        if rim is not None and distance >= rim:
            raise InvalidValueError(
                "position",
                f"must lie inside the rim at {rim:g} m",
                position,
                f"The contact is {distance:g} m from the axis.",
            )


def _triple(v: Vector) -> tuple[float, float, float]:
    return v.x + 0.0, v.y + 0.0, v.z + 0.0  # + 0.0 turns -0.0 into 0.0


def _pair(value: Any, key: str) -> tuple[Any, Any]:
    """Return two parts of whatever kinds; `checks.components` is for parts of one kind."""
    parts = None if isinstance(value, (str, bytes)) or not hasattr(value, "__len__") else tuple(value)
    if parts is None or len(parts) != 2:
        raise InvalidValueError(key, "must be a list of 2 components", value)
    return parts


def _unit_quaternion(orientation: Any) -> Quaternion:
    parts = checks.components(orientation, "number", "orientation", 4)
    length = math.hypot(*parts)
    if not 0 < length < math.inf:
        raise InvalidValueError("orientation", "must be a quaternion other than zero", orientation)
    if abs(length - 1) < 4e-16:  # it is one already: keep it to the last digit
        return Quaternion(*parts)
    return Quaternion(*(part / length for part in parts))


def _rolling_rate(relative: Vector, rho: Vector, n: Vector, spin: Scalar) -> Vector:
    """Solve ρ×Ω = V − u for the Ω with Ω·n = spin."""
    across = relative.cross(rho) / rho.dot(rho)
    return across + rho * ((spin - across.dot(n)) / rho.dot(n))


def _check_no_slip(slip: Vector, *speeds: Vector) -> None:
    scale = max(speed.norm() for speed in speeds)
    if slip.norm() > SLIP_TOLERANCE * scale:
        raise InvalidValueError(
            "angular_velocity",
            "must agree with rolling, V + Ω×ρ = u(p)",
            f"a slip of {slip.norm():.6g} m/s",
            "Give `spin` instead and the rest follows from no slip; starts that slip are not covered yet.",
        )


__all__ = ["E_Z", "STANDARD_GRAVITY", "RollingSystem", "State", "Support"]
