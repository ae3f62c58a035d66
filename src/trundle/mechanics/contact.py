"""The rolling law, once for every body, support and scalar: theory page, equations T1, T2 and T3.

Nothing here knows which body, surface, motion or load it handles, nor whether its scalars are floats, arrays of
balls, heyoka expressions or SymPy symbols.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .algebra import ZERO, Matrix, Quaternion, RotatedTensor, Vector, inertia_about
from .loads import Acting, BodyMotion
from .motions import SupportState
from .records import frozen_record
from .scalars import Scalar, is_zero

if TYPE_CHECKING:
    from .system import RollingSystem


@frozen_record()
class Contact:
    """The geometry of touch at one instant, in the inertial support frame."""

    support: SupportState
    point: Vector  # p, m
    normal: Vector  # n, from the support into the body
    offset: Vector  # ρ, from the centre of mass to p, m
    inverse_curvature: Matrix | RotatedTensor  # C of the body, m
    shape_operator: Matrix | RotatedTensor  # S of the support, 1/m

    @property
    def centre(self) -> Vector:
        """R = p − ρ, the centre of mass, m."""
        return self.point - self.offset

    @property
    def flat(self) -> bool:
        """Whether the support is known not to bend: S = 0."""
        return self.shape_operator.is_zero

    def relative_curvature(self, gap: Scalar = 0.0) -> Matrix:
        """Return 1 + (C + g)S: how the body's nearest point moves over the support when the support's does."""
        reach = self.inverse_curvature.dense
        reach = reach if is_zero(gap) else reach + Matrix.identity() * gap
        return Matrix.identity() + reach @ self.shape_operator.dense

    def relative_curvature_determinant(self, gap: Scalar = 0.0) -> Scalar:
        """Return det(1 + (C + g)S), which falls to 0 where the support is as hollow as the body is round."""
        C, S = self.inverse_curvature, self.shape_operator
        both = C.tangent_determinant
        both = both if is_zero(gap) else both + (C.trace + gap) * gap
        return 1.0 + self._relative_trace(gap) + both * S.tangent_determinant

    def _relative_trace(self, gap: Scalar) -> Scalar:
        """Return tr((C + g)S)."""
        C, S = self.inverse_curvature, self.shape_operator
        return C.trace_with(S) if is_zero(gap) else C.trace_with(S) + S.trace * gap

    def along_support(self, moved: Vector, gap: Scalar = 0.0) -> Vector:
        """Return w with (1 + (C + g)S) w = v for a v along the support.

        There a matrix M is 2×2, and M² − (tr M) M + det M = 0: so its inverse is (tr M − M)/det M.
        """
        if self.flat:
            return moved
        bent = self.shape_operator.on_tangent(moved)
        turned = self.inverse_curvature.on_tangent(bent)
        turned = turned if is_zero(gap) else turned + bent * gap
        whole = moved * (1.0 + self._relative_trace(gap)) - turned
        return whole / self.relative_curvature_determinant(gap)

    def rates(
        self, slip: Vector, angular_velocity: Vector, velocity: Vector, gap: Scalar | None = None
    ) -> tuple[Vector, Vector]:
        """Return ṗ and ρ̇ by the contact kinematics T1: (1 + C S) w = s + C(Ω − ω)×n, ṗ = u + w, ρ̇ = ṗ − V.

        A body in flight has a gap g, were it 0 for an instant. Then p is the support's point nearest to the body,
        p + g n the body's nearest to the support, and (1 + (C + g)S) w = s − (s·n)n + C(Ω − ω)×n − g ω×n.
        """
        n, omega = self.normal, self.support.angular_velocity
        moved = slip + self.inverse_curvature.on_tangent((angular_velocity - omega).cross(n))
        if gap is not None:
            moved = moved - n * slip.dot(n) - omega.cross(n) * gap
        along = self.along_support(moved, 0.0 if gap is None else gap)
        point_rate = self.support.material_velocity(self.point) + along
        if gap is None:
            return point_rate, point_rate - velocity
        n_rate = omega.cross(n) + self.shape_operator.on_tangent(along)
        return point_rate, point_rate + n * slip.dot(n) + n_rate * gap - velocity

    def body_motion(
        self, mass: Scalar, time: Scalar, velocity: Vector, orientation: Quaternion, angular_velocity: Vector
    ) -> BodyMotion:
        """Return what loads may depend on, for a body that touches here."""
        return BodyMotion(
            time, mass, self.centre, velocity, orientation, angular_velocity, self.normal, self.support.angular_velocity
        )

    def rolling_velocity(self, angular_velocity: Vector) -> Vector:
        """Return V = u(p) − Ω×ρ, the velocity of the centre of mass when nothing slips, m/s."""
        return self.support.material_velocity(self.point) - angular_velocity.cross(self.offset)

    def slip_velocity(self, velocity: Vector, angular_velocity: Vector) -> Vector:
        """Return s = V + Ω×ρ − u(p), m/s."""
        return velocity + angular_velocity.cross(self.offset) - self.support.material_velocity(self.point)


@frozen_record()
class Rolling:
    """Rates of the state and the contact force of a body that rolls, in the inertial support frame."""

    contact: Contact
    velocity: Vector  # V, m/s
    point_rate: Vector  # ṗ, m/s
    orientation_rate: Quaternion  # 1/s
    angular_acceleration: Vector  # Ω̇, rad/s²
    reaction: Vector  # R, contact force on the body, N
    normal_force: Scalar  # N = n·R, N
    axle_moment: Scalar  # of the body on the support, about the support's axle, N m


def contact_at(
    system: RollingSystem, time: Scalar, point: Vector, orientation: Quaternion, coordinates: tuple[Scalar, ...] = ()
) -> Contact:
    """Return the geometry of touch for a contact at a given point of the support."""
    surface, support = system.support.surface, system.support.motion.at(time, *coordinates)
    turn, there = support.rotation, support.local(point)
    n = turn @ surface.normal(there)
    S = RotatedTensor(turn, surface.shape_operator(there))
    rho, C = system.body.shape.contact(orientation.matrix(), n)
    return Contact(support, point, n, rho, C, S)


def normal_at(system: RollingSystem, time: Scalar, point: Vector, coordinates: tuple[Scalar, ...] = ()) -> Vector:
    """Return n at a point of the support, from the support into the body, in the inertial support frame.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> normal_at(level, 0.0, Vector(0.4, 0.0, 0.0))
    Vector(x=0.0, y=0.0, z=1.0)
    """
    return normal_on(system, system.support.motion.at(time, *coordinates), point)


def normal_on(system: RollingSystem, support: SupportState, point: Vector) -> Vector:
    """Return the same where the support's pose is known."""
    return support.rotation @ system.support.surface.normal(support.local(point))


def roll(
    system: RollingSystem,
    time: Scalar,
    point: Vector,
    orientation: Quaternion,
    angular_velocity: Vector,
    coordinates: tuple[Scalar, ...] = (),
) -> Rolling:
    """Return the rates of (p, q, Ω) and the contact force of a body that rolls: T1, T2 and T3.

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
    contact = contact_at(system, time, point, orientation, coordinates)
    rho, n, support = contact.offset, contact.normal, contact.support
    V = contact.rolling_velocity(Omega)
    p_rate, rho_rate = contact.rates(ZERO, Omega, V)
    u_rate = support.material_acceleration(point, p_rate)
    acting = system.acting_on(contact.body_motion(m, time, V, orientation, Omega))
    F, Q = acting.force, orientation.matrix()
    J = system.body.inertia_in_space(Q)
    whole = inertia_about(J, m, rho)
    inertial = u_rate - Omega.cross(rho_rate)
    # T2
    Omega_rate = whole.solve(acting.torque - system.body.gyroscopic(Q, Omega), rho.cross(m * inertial - F))
    # T3
    R = m * (inertial - Omega_rate.cross(rho)) - F
    N = m * (n.dot(inertial) - Omega_rate.dot(rho.cross(n))) - n.dot(F)  # ρ×n is 0 for a sphere, and F often along n
    lever = support.lever(point)
    # What grows with an unknown: Ω̇ and R for each newton of N, and for each rad/s² of a free axle.
    couplings = []
    if acting.has_couple:
        turned = whole.solve(acting.couple)
        couplings.append((turned, turned.cross(rho) * -m))
    if system.support.motion.free:
        turned = whole.solve(ZERO, m * rho.cross(lever))
        couplings.append((turned, m * (lever - turned.cross(rho))))
    amounts = _amounts(system, time, coordinates, contact, acting, R, [reaction for _, reaction in couplings])
    for amount, (turned, reaction) in zip(amounts, couplings, strict=True):
        Omega_rate, R, N = Omega_rate + turned * amount, R + reaction * amount, N + n.dot(reaction) * amount
    moment_on_axle = acting.moment_on_axle(support, N) - lever.dot(R)
    return Rolling(contact, V, p_rate, orientation.rate(Omega), Omega_rate, R, N, moment_on_axle)


def _amounts(
    system: RollingSystem,
    time: Scalar,
    coordinates: tuple[Scalar, ...],
    contact: Contact,
    acting: Acting,
    R: Vector,
    reactions: list[Vector],
) -> list[Scalar]:
    """Solve for the normal force that drives a couple, N = n·R, and for the axle's ω̇, I ω̇ = τ − e·(p − X)×R."""
    lever, n, axle = contact.support.lever(contact.point), contact.normal, contact.support.axle
    rows: list[list[Scalar]] = []
    if acting.has_couple:
        rows.append([*(-n.dot(reaction) for reaction in reactions), n.dot(R)])
        rows[-1][0] = 1.0 + rows[-1][0]
    if system.support.motion.free:
        applied = system.support.motion.axle_torque(time, coordinates) + acting.moment_on_axle(contact.support, 0.0)
        rows.append([*(lever.dot(reaction) for reaction in reactions), applied - lever.dot(R)])
        rows[-1][-2] = system.support.motion.inertia + rows[-1][-2]
        if acting.has_couple:
            rows[-1][0] = rows[-1][0] + axle.dot(acting.couple)
    if len(rows) < 2:
        return [row[1] / row[0] for row in rows]
    (a, b, x), (c, d, y) = rows
    determinant = a * d - b * c
    return [(x * d - b * y) / determinant, (a * y - x * c) / determinant]
