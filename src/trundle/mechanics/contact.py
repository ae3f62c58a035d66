"""The rolling law, once for every body, support and scalar: theory page, equations T1, T2 and T3.

Nothing here knows which body, surface, motion or load it handles, nor whether its scalars are floats, arrays of
balls, heyoka expressions or SymPy symbols.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..errors import SolverError
from .algebra import ZERO, Matrix, Quaternion, Turned, Vector, point_inertia
from .loads import Acting, BodyMotion
from .motions import SupportState
from .scalars import Scalar, is_zero

if TYPE_CHECKING:
    from .surfaces import Surface
    from .system import RollingSystem

_MOST_STEPS = 60  # of Newton's method, which needs five
_CLOSE = 1e-9  # share of the lengths at hand to which it must have found the contact
_NEXT_TO = 1e-7  # share of these by which a known point may be off
_ROUNDING = 1e-15
_SINGULAR = 1e-6  # of det(1 + (C + g)S), at which a run ends
_LOOKS, _GUESSES = 600, 6  # for a better first guess, and how many of them are followed
_ALIKE = 0.9  # cosine of the angle between the normals of two that lead to the same


@dataclass(frozen=True, slots=True)
class Contact:
    """The geometry of touch at one instant, in the inertial support frame."""

    support: SupportState
    point: Vector  # p, m
    normal: Vector  # n, from the support into the body
    offset: Vector  # ρ, from the centre of mass to p, m
    inverse_curvature: Matrix | Turned  # C of the body, m
    shape_operator: Matrix  # S of the support, 1/m

    @property
    def centre(self) -> Vector:
        """R = p − ρ, the centre of mass, m."""
        return self.point - self.offset

    @property
    def flat(self) -> bool:
        """Whether the support is known not to bend: S = 0."""
        return self.shape_operator.is_zero

    def across(self, gap: Scalar = 0.0) -> Matrix:
        """Return 1 + (C + g)S: how the body's nearest point moves over the support when the support's does."""
        reach = self.inverse_curvature.whole
        reach = reach if is_zero(gap) else reach + Matrix.identity() * gap
        return Matrix.identity() + reach @ self.shape_operator

    def clearance(self, gap: Scalar = 0.0) -> Scalar:
        """Return det(1 + (C + g)S), which falls to 0 where the support is as hollow as the body is round."""
        return self.across(gap).determinant

    def rates(
        self, slip: Vector, angular_velocity: Vector, velocity: Vector, gap: Scalar = 0.0
    ) -> tuple[Vector, Vector]:
        """Return ṗ and ρ̇ by the contact kinematics T1: (1 + C S) w = s + C(Ω − ω)×n, ṗ = u + w, ρ̇ = ṗ − V.

        Across a gap g, p is the support's point nearest to the body, p + g n the body's nearest to the support, and
        (1 + (C + g)S) w = s − (s·n)n + C(Ω − ω)×n − g ω×n.

        Parameters
        ----------
        slip : Vector
            s, m/s; zero when rolling.
        angular_velocity : Vector
            Ω of the body, rad/s.
        velocity : Vector
            V of the centre of mass, m/s.
        gap : Scalar
            g, m; 0 where they touch.

        Returns
        -------
        point_rate, offset_rate : Vector
            ṗ, and the rate of ρ, m/s.
        """
        n, omega, flat = self.normal, self.support.angular_velocity, self.flat
        C = self.inverse_curvature if flat else self.inverse_curvature.whole  # its elements are wanted anyway
        moved = slip + C @ (angular_velocity - omega).cross(n)
        if not is_zero(gap):
            moved = moved - n * slip.dot(n) - omega.cross(n) * gap
        along = moved if flat else self.across(gap).solve(moved)
        point_rate = self.support.material_velocity(self.point) + along
        if is_zero(gap):
            return point_rate, point_rate - velocity
        n_rate = omega.cross(n) + self.shape_operator @ along
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


@dataclass(frozen=True, slots=True)
class Rolling:
    """Rates of the state and the contact force of a body that rolls, in the inertial support frame."""

    contact: Contact
    velocity: Vector  # V, m/s
    point_rate: Vector  # ṗ, m/s
    orientation_rate: Quaternion  # 1/s
    angular_acceleration: Vector  # Ω̇, rad/s²
    reaction: Vector  # R, contact force on the body, N
    axle_moment: Scalar  # of the body on the support, about the support's axle, N m


def touch(
    system: RollingSystem, time: Scalar, point: Vector, orientation: Quaternion, own: tuple[Scalar, ...] = ()
) -> Contact:
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
    own : tuple of Scalar
        The coordinates of the support's own motion, where it has some.

    Returns
    -------
    Contact
        n, ρ, C and S.
    """
    surface, support = system.support.surface, system.support.motion.at(time, *own)
    turn, there = support.rotation, _own(support, point)
    n = turn @ surface.normal(there)
    S = Turned(turn, surface.shape_operator(there)).whole
    rho, C = system.body.shape.contact(orientation.matrix(), n)
    return Contact(support, point, n, rho, C, S)


def normal_at(system: RollingSystem, time: Scalar, point: Vector, own: tuple[Scalar, ...] = ()) -> Vector:
    """Return n at a point of the support, from the support into the body, in the inertial support frame.

    Parameters
    ----------
    system : RollingSystem
        Its support.
    time : Scalar
        t, s.
    point : Vector
        p in the inertial support frame, m.
    own : tuple of Scalar
        As for `touch`.

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
    support = system.support.motion.at(time, *own)
    return support.rotation @ system.support.surface.normal(_own(support, point))


def _own(support: SupportState, point: Vector) -> Vector:
    """Return a point in the support's own coordinates."""
    return support.rotation.transpose @ (point - support.origin)


def nearest(
    system: RollingSystem,
    time: Scalar,
    point: Vector,
    centre: Vector,
    orientation: Quaternion,
    own: tuple[Scalar, ...] = (),
) -> Contact:
    """Return the geometry at the support's point nearest to a body, from a point next to it, by one of Newton's steps.

    Parameters
    ----------
    system, time, orientation, own
        As for `touch`.
    point : Vector
        p in the inertial support frame, m, off by so little that its square is rounding.
    centre : Vector
        r, m.

    Returns
    -------
    Contact
        As of `settle`, which wants no point to begin with; that at the point itself where the step is no small one.

    Examples
    --------
    >>> import trundle as tr
    >>> bowl = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> still, off = Quaternion(1.0, 0.0, 0.0, 0.0), Vector(1e-9, 0.0, 2e-9)
    >>> bool(nearest(bowl, 0.0, off, Vector(0.0, 0.0, 0.3), still).point.norm() < 1e-16)
    True
    """
    import numpy as np

    contact = touch(system, time, point, orientation, own)
    with np.errstate(all="ignore"):  # by the end of a formula
        _, aside, down = _beside(system, contact, centre)
        step = aside + down
        small = step.norm() <= _NEXT_TO * (point.norm() + contact.offset.norm())
    moved = Vector(*(np.where(small, there + by, there)[()] for there, by in zip(point, step, strict=True)))
    return touch(system, time, moved, orientation, own)


def _beside(
    system: RollingSystem, contact: Contact, centre: Vector, *, bent: bool = True
) -> tuple[Vector, Vector, Vector]:
    """Return how far the body's point is aside of the support's, and Newton's step along the support and off it."""
    n, support = contact.normal, contact.support
    apart = centre + contact.offset - contact.point
    gap = n.dot(apart)
    off = apart - n * gap
    down = n * -_height(system.support.surface, _own(support, contact.point), support.rotation.transpose @ n)
    # The normal leans by S along the support, and ρ follows it by C.
    return off, contact.across(gap).solve(off) if bent and not contact.flat else off, down


def settle(
    system: RollingSystem, time: float, centre: Vector, orientation: Quaternion, own: tuple[Scalar, ...] = ()
) -> Contact:
    """Return the geometry of touch for a body whose centre of mass is known: the p nearest to the body.

    Where body and support touch, p = r + ρ(n(p)); where they do not, r + ρ is straight over p, by the gap.

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
    own : tuple of Scalar
        As for `touch`.

    Returns
    -------
    Contact
        Where the body touches, or would if it were pushed on along the normal.

    Raises
    ------
    SolverError
        Where no point of the surface is nearest to the body.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    >>> settle(system, 0.0, Vector(0.4, 0.0, 0.0), Quaternion(1.0, 0.0, 0.0, 0.0)).point
    Vector(x=0.5, y=0.0, z=0.0)
    """
    # The normal at the centre is already that at the contact for a sphere over a surface of constant curvature.
    found = _newton(system, time, centre, centre, orientation, own)
    if found is None or misplaced(system, found, centre, orientation) or _hollow_under(found, centre):
        found = _searched(system, time, centre, orientation, own, found) or found
    if found is None or _is_beyond(system.support.surface, _own(found.support, found.point)):
        raise SolverError(
            f"At t = {float(time):.9g} s no point of the surface is nearest to the body, whose centre is at "
            f"({', '.join(f'{float(part):.4g}' for part in centre)}) m. Does the surface reach there, and smoothly?"
        )
    return found


def misplaced(system: RollingSystem, contact: Contact, centre: Vector, orientation: Quaternion) -> str:
    """Say why a point straight under a body is not where it is nearest to the support; empty where it is.

    Parameters
    ----------
    system, centre, orientation
        As for `settle`.
    contact : Contact
        The geometry there.

    Returns
    -------
    str
        A sentence.

    Examples
    --------
    A ball high over one side of a bowl is nearer to the other:

    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> still = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> contact = touch(system, 0.0, Vector(0.0, 0.0, 0.0), still)
    >>> misplaced(system, contact, Vector(0.0, 0.0, 0.3), still)
    ''
    >>> misplaced(system, contact, Vector(0.0, 0.0, 0.6), still)
    'There the support is so hollow, or the body so high over it, that other points of it are as near.'
    """
    if _is_beyond(system.support.surface, _own(contact.support, contact.point)):
        return "There the support has ended."
    covered = system.body.shape.covers(-(orientation.matrix().transpose @ contact.normal))
    if covered is not None and not covered > 0:
        return "There the body has a flat side or an edge towards the support, which its shape does not cover."
    if contact.flat:
        return ""
    across = contact.across(_gap(contact, centre))
    # Along n it is 1: the two others have the determinant as their product, and their sum is the trace less 1.
    around = sum(row[i] for i, row in enumerate(map(tuple, across.rows))) - 1.0
    if across.determinant > _SINGULAR and around > 0:
        return ""
    return "There the support is so hollow, or the body so high over it, that other points of it are as near."


def _is_beyond(surface: Surface, there: Vector) -> bool:
    """Tell whether a point is beyond the surface's end: a table's spline goes on there, the surface does not."""
    inside = surface.inside(there)
    return inside is not None and bool(inside < 0)


def _newton(
    system: RollingSystem,
    time: float,
    centre: Vector,
    point: Vector,
    orientation: Quaternion,
    own: tuple[Scalar, ...],
) -> Contact | None:
    """Return the contact to which Newton's method leads from a first guess at p; None where it leads nowhere."""
    last = math.inf
    try:
        contact = touch(system, time, point, orientation, own)
        for step in range(_MOST_STEPS):
            off, aside, down = _beside(system, contact, centre, bent=step > 0)
            size = point.norm() + contact.offset.norm()
            left = max(off.norm(), down.norm()) / size
            point = point + aside + down
            contact = touch(system, time, point, orientation, own)
            # What is left now is less by as much again; or it was rounding.
            if step > 0 and (left <= _ROUNDING or (left <= _CLOSE and left * left <= 0.1 * _ROUNDING * last)):
                break
            last = left
    except (ArithmeticError, ValueError):  # outside a formula, or where it has no slope
        return None
    return contact if left <= _CLOSE else None


def _gap(contact: Contact, centre: Vector) -> float:
    return float((centre + contact.offset - contact.point).dot(contact.normal))


def _hollow_under(contact: Contact, centre: Vector) -> bool:
    """Tell whether a body is over a support that bends up somehow, of which other points may be nearer."""
    S = contact.shape_operator
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = S.rows
    bends_up = xx + yy + zz < 0 or xx * yy + yy * zz + zz * xx < xy * xy + yz * yz + xz * xz
    return bends_up and _gap(contact, centre) > _CLOSE * contact.offset.norm()


def _searched(
    system: RollingSystem,
    time: float,
    centre: Vector,
    orientation: Quaternion,
    own: tuple[Scalar, ...],
    known: Contact | None,
) -> Contact | None:
    """Return the nearest of the known contact and those to which Newton's method leads from other likely points."""
    try:
        guesses = _guesses(system, time, centre, orientation, own)
    except (ArithmeticError, ValueError):  # outside a formula
        guesses = []
    led_to = (_newton(system, time, centre, point, orientation, own) for point in guesses)
    found = [one for one in (known, *led_to) if one is not None and not misplaced(system, one, centre, orientation)]
    return min(found, key=lambda contact: abs(_gap(contact, centre)), default=None)


def _guesses(
    system: RollingSystem, time: float, centre: Vector, orientation: Quaternion, own: tuple[Scalar, ...]
) -> list[Vector]:
    """Return r + ρ(n) for those n, of many all around, that are nearest to the surface's normal there."""
    import numpy as np

    support, surface = system.support.motion.at(time, *own), system.support.surface
    i = np.arange(_LOOKS)
    z, angle = 1.0 - (2 * i + 1) / _LOOKS, math.pi * (1.0 + math.sqrt(5.0)) * (i + 0.5)  # Fibonacci's lattice
    across = np.sqrt(1.0 - z * z)
    n = support.rotation @ Vector(across * np.cos(angle), across * np.sin(angle), z)
    with np.errstate(all="ignore"):
        points = centre + system.body.shape.contact(orientation.matrix(), n)[0]
        there = _own(support, points)
        off = np.linalg.norm((support.rotation @ surface.normal(there)).array() - n.array(), axis=-1)
        inside = surface.inside(there)
        likely = np.isfinite(off) if inside is None else np.isfinite(off) & (np.asarray(inside) >= 0)
    normals, places = n.array(), points.array()
    kept: list[int] = []
    for which in np.argsort(off).tolist():
        if likely[which] and len(kept) < _GUESSES and (normals[kept] @ normals[which] < _ALIKE).all():
            kept.append(which)
    return [Vector(*places[which].tolist()) for which in kept]


def _height(surface: Surface, there: Vector, n: Vector) -> Scalar:
    """Return about how far a point is over the surface along n, m: φ over its slope."""
    level, step = surface.level(there), 1e-6 * (there.norm() + 1e-6)
    return 2 * step * level / (surface.level(there + n * step) - surface.level(there - n * step))


def roll(
    system: RollingSystem,
    time: Scalar,
    point: Vector,
    orientation: Quaternion,
    angular_velocity: Vector,
    own: tuple[Scalar, ...] = (),
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
    own : tuple of Scalar
        The coordinates of the support's own motion, where it has some.

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
    contact = touch(system, time, point, orientation, own)
    rho, n, support = contact.offset, contact.normal, contact.support
    V = contact.rolling_velocity(Omega)
    p_rate, rho_rate = contact.rates(ZERO, Omega, V)
    u_rate = support.material_acceleration(point, p_rate)
    acting = system.acting_on(contact.body_motion(m, time, V, orientation, Omega))
    F, Q = acting.force, orientation.matrix()
    J = system.body.inertia_in_space(Q)
    whole = J + point_inertia(m, rho)
    inertial = u_rate - Omega.cross(rho_rate)
    # T2
    moment = acting.torque - system.body.gyroscopic(Q, Omega) - rho.cross(F) + m * rho.cross(inertial)
    Omega_rate = whole.solve(moment)
    # T3
    R = m * (inertial - Omega_rate.cross(rho)) - F
    lever = support.lever(point)
    # What grows with an unknown: Ω̇ and R for each newton of N, and for each rad/s² of a free axle.
    couplings = []
    if acting.has_couple:
        turned = whole.solve(acting.couple)
        couplings.append((turned, turned.cross(rho) * -m))
    if system.support.motion.free:
        turned = whole.solve(m * rho.cross(lever))
        couplings.append((turned, m * (lever - turned.cross(rho))))
    amounts = _amounts(system, time, own, contact, acting, R, [reaction for _, reaction in couplings])
    for amount, (turned, reaction) in zip(amounts, couplings, strict=True):
        Omega_rate, R = Omega_rate + turned * amount, R + reaction * amount
    moment_on_axle = acting.moment_on_axle(support, n.dot(R)) - lever.dot(R)
    return Rolling(contact, V, p_rate, orientation.rate(Omega), Omega_rate, R, moment_on_axle)


def _amounts(
    system: RollingSystem,
    time: Scalar,
    own: tuple[Scalar, ...],
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
        applied = system.support.motion.axle_torque(time, own) + acting.moment_on_axle(contact.support, 0.0)
        rows.append([*(lever.dot(reaction) for reaction in reactions), applied - lever.dot(R)])
        rows[-1][-2] = system.support.motion.inertia + rows[-1][-2]
        if acting.has_couple:
            rows[-1][0] = rows[-1][0] + axle.dot(acting.couple)
    if len(rows) < 2:
        return [row[1] / row[0] for row in rows]
    (a, b, x), (c, d, y) = rows
    determinant = a * d - b * c
    return [(x * d - b * y) / determinant, (a * y - x * c) / determinant]
