"""Slipping and flight, for every body, support and scalar: theory page, equation T4.

Slipping, the state gains the slip velocity s, and friction is f = −μ N ŝ. In flight nothing touches: the centre of mass
moves by itself, and the support's point nearest to the body and the gap between them are carried along.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .algebra import ZERO, Matrix, Quaternion, Vector
from .contact import Contact, contact_at
from .loads import Acting, BodyMotion
from .records import frozen_record
from .scalars import Scalar, namespace

if TYPE_CHECKING:
    from .system import RollingSystem


@frozen_record()
class Slipping:
    """Rates of the state and the contact force of a body that slips, in the inertial support frame."""

    contact: Contact
    velocity: Vector  # V, m/s
    point_rate: Vector  # ṗ, m/s
    orientation_rate: Quaternion  # 1/s
    angular_acceleration: Vector  # Ω̇, rad/s²
    slip_rate: Vector  # ṡ, m/s²
    normal_force: Scalar  # N, N
    opening_per_newton: Scalar  # n·a₁: how fast each newton of N opens the contact, 1/kg
    reaction: Vector  # R, N
    axle_moment: Scalar  # of the body on the support, about the support's axle, N m
    holding: Vector = ZERO  # the couple that keeps it from turning over the support, N m


@frozen_record()
class HeldInertia:
    """The inertia of a body that a couple keeps from turning over the support: it answers about the normal alone."""

    normal: Vector
    tensor: Matrix  # J, kg m²

    def solve(self, torque: Vector) -> Vector:
        """Return Ω̇, rad/s², given a torque, N m."""
        n = self.normal
        return n * (n.dot(torque) / n.dot(self.tensor @ n))


@frozen_record()
class Unpushed:
    """How a body at a contact would move on if the support did not push."""

    velocity: Vector  # V, m/s
    point_rate: Vector  # ṗ, m/s
    acting: Acting  # what acts besides the contact force
    inertia: Matrix | HeldInertia  # J, kg m²
    angular_acceleration: Vector  # Ω̇, rad/s²
    slip_rate: Vector  # ṡ, m/s²
    opening: Scalar  # the rate of s·n: how fast it would come off, m/s²
    normal_rate: Vector  # ṅ, 1/s
    holding: Vector = ZERO  # the couple that keeps it from turning over the support, N m


@frozen_record()
class Response:
    """What a push at the contact does, for a force the rates and for an impulse the changes."""

    angular_velocity: Vector  # of Ω
    slip: Vector  # of s


@frozen_record()
class Flying:
    """Rates of the state of a body that touches nothing, in the inertial support frame."""

    contact: Contact
    point_rate: Vector  # ṗ, m/s
    orientation_rate: Quaternion  # 1/s
    angular_acceleration: Vector  # Ω̇, rad/s²
    acceleration: Vector  # V̇, m/s²
    gap_rate: Scalar  # ġ, m/s


def slip_direction(slip: Vector) -> Vector:
    """Return ŝ = s/|s|.

    Examples
    --------
    >>> slip_direction(Vector(0.0, 2.0, 0.0))
    Vector(x=0.0, y=1.0, z=0.0)
    """
    return slip / namespace(*slip).sqrt(slip.dot(slip))


def slip(
    system: RollingSystem,
    time: Scalar,
    point: Vector,
    orientation: Quaternion,
    angular_velocity: Vector,
    slip_velocity: Vector,
    coordinates: tuple[Scalar, ...] = (),
    direction: Vector | None = None,
    *,
    held: bool = False,
) -> Slipping:
    """Return the rates of (p, q, Ω, s) and the contact force of a body that slips: T1 and T4.

    Examples
    --------
    A ball that slides without turning slows down at μ g:

    >>> import trundle as tr
    >>> lane = tr.RollingSystem(tr.Body.solid_sphere(0.1, 7.0), tr.Support(tr.Plane(), friction=0.1), gravity=10.0)
    >>> now = slip(lane, 0.0, ZERO, Quaternion(1.0, 0.0, 0.0, 0.0), ZERO, Vector(8.0, 0.0, 0.0))
    >>> round(now.reaction.x / 7.0, 12), round(now.slip_rate.x, 12)
    (-1.0, -3.5)
    """
    contact = contact_at(system, time, point, orientation, coordinates)
    n, support = contact.normal, contact.support
    Omega = unturned(contact, angular_velocity) if held else angular_velocity
    off = n.dot(slip_velocity)  # rounding's part along n: left in s it would grow where the support bends
    s = slip_velocity - n * off
    free = unpushed(system, time, contact, orientation, Omega, s, coordinates, held=held)
    acting = free.acting
    if direction is None:
        hat = slip_direction(s)
    else:  # of a slip that is all but over, rounding's part along n is large beside it
        hat = direction if direction is ZERO else direction - n * n.dot(direction)
    d = n if hat is ZERO else n - hat * system.support.sliding_friction
    answer = response(system, contact, free.inertia, d, acting.couple if acting.has_couple else None)
    opening_per_newton = n.dot(answer.slip)
    N = -free.opening / opening_per_newton
    holding = free.holding
    if isinstance(free.inertia, HeldInertia):
        asked = free.inertia.tensor @ answer.angular_velocity - contact.offset.cross(d) - acting.couple
        holding = holding + asked * N
    return Slipping(
        contact,
        free.velocity,
        free.point_rate,
        orientation.rate(Omega),
        free.angular_acceleration + answer.angular_velocity * N,
        free.slip_rate + answer.slip * N + free.normal_rate * off,  # it turns with n, or s would grow by it
        N,
        opening_per_newton,
        d * N,
        acting.moment_on_axle(support, N) - support.lever(point).dot(d) * N,
        holding,
    )


def unturned(contact: Contact, angular_velocity: Vector) -> Vector:
    """Return Ω without its part that turns the body over the support.

    Examples
    --------
    >>> import trundle as tr
    >>> floor = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane()))
    >>> unturned(contact_at(floor, 0.0, ZERO, Quaternion(1.0, 0.0, 0.0, 0.0)), Vector(1.0, 2.0, 3.0)).array().tolist()
    [0.0, 0.0, 3.0]
    """
    n, omega = contact.normal, contact.support.angular_velocity
    return omega + n * n.dot(angular_velocity - omega)


def response(
    system: RollingSystem, contact: Contact, inertia: Matrix | HeldInertia, push: Vector, couple: Vector | None = None
) -> Response:
    """Return what a push P at the contact does to Ω and to s: there M P, M = 1/m + [J⁻¹(ρ×·)]×ρ and a free axle's part.

    Examples
    --------
    Pushed along the floor at its lowest point, a solid ball of 2 kg answers with 7/2 of its mass's share:

    >>> import trundle as tr
    >>> floor = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane()))
    >>> still = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> J = floor.body.inertia_in_space(still.matrix())
    >>> response(floor, contact_at(floor, 0.0, ZERO, still), J, Vector(2.0, 0.0, 0.0)).slip.x
    3.5
    """
    rho, motion = contact.offset, system.support.motion
    torque = rho.cross(push) if couple is None else rho.cross(push) + couple
    turned = inertia.solve(torque)
    answer = push / system.body.mass + turned.cross(rho)
    if motion.free:
        lever = contact.support.lever(contact.point)
        moment = lever.dot(push) if couple is None else lever.dot(push) + contact.support.axle.dot(couple)
        answer = answer + lever * (moment / motion.inertia)
    return Response(turned, answer)


def unpushed(
    system: RollingSystem,
    time: Scalar,
    contact: Contact,
    orientation: Quaternion,
    angular_velocity: Vector,
    slip_velocity: Vector,
    coordinates: tuple[Scalar, ...] = (),
    *,
    held: bool = False,
) -> Unpushed:
    """Return how a body at a contact would move on without a contact force: T4 with N = 0.

    Examples
    --------
    A ball on a level floor would fall away from it at g:

    >>> import trundle as tr
    >>> floor = tr.RollingSystem(tr.Body.solid_sphere(0.1, 7.0), tr.Support(tr.Plane()), gravity=10.0)
    >>> still = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> unpushed(floor, 0.0, contact_at(floor, 0.0, ZERO, still), still, ZERO, ZERO).opening
    -10.0
    """
    m, Omega, s = system.body.mass, angular_velocity, slip_velocity
    n, support, point = contact.normal, contact.support, contact.point
    V = contact.rolling_velocity(Omega) + s
    p_rate, rho_rate = contact.rates(s, Omega, V)
    u_rate = support.material_acceleration(point, p_rate)
    acting = system.acting_on(contact.body_motion(m, time, V, orientation, Omega), held=held)
    along = p_rate - support.material_velocity(point)
    n_rate = support.angular_velocity.cross(n) + contact.shape_operator.on_tangent(along)
    Q = orientation.matrix()
    whole = system.body.inertia_in_space(Q)
    torque, holding = acting.torque - system.body.gyroscopic(Q, Omega), ZERO
    J = HeldInertia(n, whole) if held else whole
    if held:  # Ω = ω + Ω_n n, and only Ω_n is free
        along = support.angular_acceleration + n_rate * n.dot(Omega - support.angular_velocity)
        turning = along + J.solve(torque - whole @ along)
        holding = whole @ turning - torque
    else:
        turning = J.solve(torque)
    s_rate = acting.force / m + turning.cross(contact.offset) + Omega.cross(rho_rate) - u_rate
    if system.support.motion.free:  # I ω̇ = τ − e·(p − X)×R, so that u̇ is affine in N
        driven = system.support.motion.axle_torque(time, coordinates) - support.axle.dot(acting.from_support)
        s_rate = s_rate - support.lever(point) * (driven / system.support.motion.inertia)
    return Unpushed(V, p_rate, acting, J, turning, s_rate, n.dot(s_rate) + n_rate.dot(s), n_rate, holding)


def fly(
    system: RollingSystem,
    time: Scalar,
    point: Vector,
    gap: Scalar,
    centre: Vector,
    orientation: Quaternion,
    angular_velocity: Vector,
    velocity: Vector,
    coordinates: tuple[Scalar, ...] = (),
) -> Flying:
    """Return the rates of (p, g, q, Ω, V) of a body that touches nothing; that of r is V.

    Neither the point nor the gap has a part in how the body moves: where they lose digits, as at a shape's edge or by
    a cone's apex, it does not.

    Examples
    --------
    >>> import trundle as tr
    >>> floor = tr.RollingSystem(tr.Body.solid_sphere(0.1, 7.0), tr.Support(tr.Plane()), gravity=10.0)
    >>> centre, down = Vector(0.0, 0.0, 0.6), Vector(1.0, 0.0, -2.0)
    >>> now = fly(floor, 0.0, ZERO, 0.5, centre, Quaternion(1.0, 0.0, 0.0, 0.0), ZERO, down)
    >>> now.gap_rate, now.acceleration.z
    (-2.0, -10.0)
    """
    m, Omega, V = system.body.mass, angular_velocity, velocity
    contact = contact_at(system, time, point, orientation, coordinates)
    n = contact.normal
    s = contact.slip_velocity(V, Omega)
    p_rate, _ = contact.rates(s, Omega, V, gap)
    acting = system.acting_on(BodyMotion(time, m, centre, V, orientation, Omega))
    Q = orientation.matrix()
    turned = system.body.inertia_in_space(Q).solve(acting.torque - system.body.gyroscopic(Q, Omega))
    return Flying(contact, p_rate, orientation.rate(Omega), turned, acting.force / m, n.dot(s))
