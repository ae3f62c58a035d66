"""The rolling law, once for every body, support and scalar: theory page, equations T1, T2 and T3.

Nothing here knows which body, surface, motion or load it handles, nor whether its scalars are floats, arrays of
balls, heyoka expressions or SymPy symbols.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .algebra import Matrix, Quaternion, Vector, point_inertia
from .loads import BodyMotion
from .motions import SupportState
from .scalars import Scalar

if TYPE_CHECKING:
    from .system import RollingSystem

_MOST_STEPS = 60  # of Newton's method, which needs five


@dataclass(frozen=True, slots=True)
class Contact:
    """The geometry of touch at one instant, in the inertial support frame."""

    support: SupportState
    point: Vector  # p, m
    normal: Vector  # n, from the support into the body
    offset: Vector  # ρ, from the centre of mass to p, m
    inverse_curvature: Matrix  # C of the body, m
    shape_operator: Matrix  # S of the support, 1/m

    @property
    def centre(self) -> Vector:
        """R = p − ρ, the centre of mass, m."""
        return self.point - self.offset

    def rates(self, slip: Vector, angular_velocity: Vector, velocity: Vector) -> tuple[Vector, Vector]:
        """Return ṗ and ρ̇ by the contact kinematics T1: (1 + C S) w = s + C(Ω − ω)×n, ṗ = u + w, ρ̇ = ṗ − V.

        Parameters
        ----------
        slip : Vector
            s, m/s; zero when rolling.
        angular_velocity : Vector
            Ω of the body, rad/s.
        velocity : Vector
            V of the centre of mass, m/s.

        Returns
        -------
        point_rate, offset_rate : Vector
            m/s.
        """
        relative = angular_velocity - self.support.angular_velocity
        moved = slip + self.inverse_curvature @ relative.cross(self.normal)
        along = (Matrix.identity() + self.inverse_curvature @ self.shape_operator).solve(moved)
        point_rate = self.support.material_velocity(self.point) + along
        return point_rate, point_rate - velocity

    def rolling_velocity(self, angular_velocity: Vector) -> Vector:
        """Return V = u(p) − Ω×ρ, the velocity of the centre of mass when nothing slips, m/s."""
        return self.support.material_velocity(self.point) - angular_velocity.cross(self.offset)

    def slip_velocity(self, velocity: Vector, angular_velocity: Vector) -> Vector:
        """Return s = V + Ω×ρ − u(p), m/s."""
        return velocity + angular_velocity.cross(self.offset) - self.support.material_velocity(self.point)


@dataclass(frozen=True, slots=True)
class Rolling:
    """Rates of the state and the contact force of a body that rolls, in the inertial support frame."""

    contact: Contact
    velocity: Vector  # V, m/s
    point_rate: Vector  # ṗ, m/s
    orientation_rate: Quaternion  # 1/s
    angular_acceleration: Vector  # Ω̇, rad/s²
    reaction: Vector  # R, contact force on the body, N


def touch(system: RollingSystem, time: Scalar, point: Vector, orientation: Quaternion) -> Contact:
    """Return the geometry of touch for a contact at a given point of the support.

    Parameters
    ----------
    system : RollingSystem
        Body and support.
    time : Scalar
        t, s.
    point : Vector
        p in the inertial support frame, m.
    orientation : Quaternion
        Body frame to support frame.

    Returns
    -------
    Contact
        n, ρ, C and S.
    """
    surface, support = system.support.surface, system.support.motion.at(time)
    turn, own = support.rotation, _own(support, point)
    n = turn @ surface.normal(own)
    S = turn @ surface.shape_operator(own) @ turn.transpose
    rho, C = system.body.shape.contact(orientation.matrix(), n)
    return Contact(support, point, n, rho, C, S)


def normal_at(system: RollingSystem, time: Scalar, point: Vector) -> Vector:
    """Return n at a point of the support, from the support into the body, in the inertial support frame.

    Parameters
    ----------
    system : RollingSystem
        Its support.
    time : Scalar
        t, s.
    point : Vector
        p in the inertial support frame, m.

    Returns
    -------
    Vector
        Of length 1.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> normal_at(level, 0.0, Vector(0.4, 0.0, 0.0))
    Vector(x=0.0, y=0.0, z=1.0)
    """
    support = system.support.motion.at(time)
    return support.rotation @ system.support.surface.normal(_own(support, point))


def _own(support: SupportState, point: Vector) -> Vector:
    """Return a point in the support's own coordinates."""
    return support.rotation.transpose @ (point - support.origin)


def settle(system: RollingSystem, time: float, centre: Vector, orientation: Quaternion) -> Contact:
    """Return the geometry of touch for a body whose centre of mass is known: the p with p = r + ρ(n(p)).

    Parameters
    ----------
    system : RollingSystem
        Body and support, in numbers.
    time : float
        t, s.
    centre : Vector
        r in the inertial support frame, m.
    orientation : Quaternion
        Body frame to support frame.

    Returns
    -------
    Contact
        Where the body touches, or would if it were pushed on along the normal.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    >>> settle(system, 0.0, Vector(0.4, 0.0, 0.0), Quaternion(1.0, 0.0, 0.0, 0.0)).point
    Vector(x=0.5, y=0.0, z=0.0)
    """
    point = centre  # the normal there is already that at the contact for a sphere over a surface of constant curvature
    for _ in range(_MOST_STEPS):
        contact = touch(system, time, point, orientation)
        aside = centre + contact.offset - point
        if aside.norm() <= 1e-15 * (point.norm() + contact.offset.norm()):
            break
        step = aside
        if point is not centre:  # Newton's, by how ρ follows the normal
            step = (Matrix.identity() + contact.inverse_curvature @ contact.shape_operator).solve(aside)
        point = point + step
    return touch(system, time, point, orientation)


def roll(
    system: RollingSystem, time: Scalar, point: Vector, orientation: Quaternion, angular_velocity: Vector
) -> Rolling:
    """Return the rates of (p, q, Ω) and the contact force of a body that rolls: T1, T2 and T3.

    Parameters
    ----------
    system : RollingSystem
        Body, support and loads.
    time : Scalar
        t, s.
    point : Vector
        p in the inertial support frame, m.
    orientation : Quaternion
        Body frame to support frame.
    angular_velocity : Vector
        Ω in the inertial support frame, rad/s.

    Returns
    -------
    Rolling
        ṗ, q̇, Ω̇, V and R.

    Examples
    --------
    A ball at rest on a slope of 0.1 rad gains (5/7) g sin α:

    >>> import trundle as tr
    >>> slope = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), tr.Support(tr.Plane(), tilt=0.1))
    >>> still = Vector(0.0, 0.0, 0.0)
    >>> now = roll(slope, 0.0, still, Quaternion(1.0, 0.0, 0.0, 0.0), still)
    >>> round(now.angular_acceleration.y * 0.025 / (9.80665 * 0.09983341664682815), 12) == round(5 / 7, 12)
    True
    """
    m, Omega = system.body.mass, angular_velocity
    contact = touch(system, time, point, orientation)
    rho = contact.offset
    V = contact.rolling_velocity(Omega)
    zero = Vector(0.0, 0.0, 0.0)
    p_rate, rho_rate = contact.rates(zero, Omega, V)
    u_rate = contact.support.material_acceleration(point, p_rate)
    F, K = system.loads_on(BodyMotion(time, m, contact.centre, V, orientation, Omega))
    Q = orientation.matrix()
    J = system.body.inertia_in_space(Q)
    inertial = u_rate - Omega.cross(rho_rate)
    # T2
    moment = K - system.body.gyroscopic(Q, Omega) - rho.cross(F) + m * rho.cross(inertial)
    Omega_rate = (J + point_inertia(m, rho)).solve(moment)
    # T3
    R = m * (inertial - Omega_rate.cross(rho)) - F
    return Rolling(contact, V, p_rate, orientation.rate(Omega), Omega_rate, R)
