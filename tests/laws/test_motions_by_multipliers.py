"""Every motion and load against Lagrange multipliers: an ellipsoid in an elliptic bowl that does it all.

The search for the contact is that of `test_multipliers`; here Newton, Euler, the differentiated constraint and, of a
free support, the moment about its axle are one linear system, in which the couples grow with the multiplier.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath
import pytest
from tests.laws.test_multipliers import Case, contact_after, normal_at, offset_at
from tests.precise import precisely, quaternions, size_of, slope, vectors
from tests.tolerances import EXACT

import trundle as tr
from trundle.mechanics.algebra import Matrix, Quaternion, Vector
from trundle.mechanics.contact import roll
from trundle.mechanics.loads import Load
from trundle.mechanics.motions import Motion, SupportState
from trundle.mechanics.shapes import Ellipsoid, Sphere

PRINCIPAL = tr.Principal(0.003, 0.004, 0.005)
BODIES = {
    "ball": tr.Body.sphere(radius=0.125, mass=0.75, inertia_ratio=0.55),
    "weighted ball": tr.Body(0.75, PRINCIPAL, Sphere(0.125, Vector(0.01, -0.02, 0.03))),
    "ellipsoid": tr.Body(0.75, PRINCIPAL, Ellipsoid(0.15, 0.125, 0.1)),
}
SURFACES = {"plane": tr.Plane(), "elliptic bowl": tr.EllipsoidalBowl((0.9, 0.7, 0.6))}
START_UP = tr.SpinBy("3*(1 - exp(-2*t)) + 0.5*sin(4*t)")
FREE = tr.FreeAxle(0.04, rate=1.5, motor_torque="0.1*cos(3*t)", bearing_drag=0.02, bearing_torque=0.03, below=0.5)
SHAKE = tr.Shake((0.05, -0.03, 0.02), 6.0, 0.5)


def turned(t: Any) -> Any:
    """Return the angle of the start-up, integrated by hand."""
    return 3 * (t + mpmath.expm1(-2 * t) / 2) + (1 - mpmath.cos(4 * t)) / 8


# Each motion with the coordinates of its own at the time t.
Own = Callable[[Any], tuple[Any, ...]]
MOTIONS: dict[str, tuple[Motion, Own]] = {
    "start-up": (START_UP, lambda t: (turned(t),)),
    "tilting": (tr.Tilt("0.2*sin(3*t) - 0.1*t", axis=(1.0, -2.0, 0.0)), lambda t: ()),  # noqa: ARG005
    "rocking": (tr.Rock(0.25, 3.0, 0.5), lambda t: ()),  # noqa: ARG005
    "swirled": (tr.PrecessingTilt(0.2, -2.5), lambda t: ()),  # noqa: ARG005
    "shaken": (SHAKE, lambda t: ()),  # noqa: ARG005
    "moved": (tr.Move(("0.1*t**2", "0.05*sin(4*t)", "0.1*exp(-t)")), lambda t: ()),  # noqa: ARG005
    "shaken, rocking, starting up": (tr.Combined((SHAKE, tr.Rock(0.2, 2.0), START_UP)), lambda t: (turned(t),)),
    "free": (FREE, lambda t: (1.25 * t, mpmath.mpf(1.25))),
    "free and shaken": (tr.Combined((SHAKE, FREE)), lambda t: (1.25 * t, mpmath.mpf(1.25))),
}
AIR: tuple[Load, ...] = (tr.QuadraticDrag(0.3, 1.5), tr.Magnus(0.02), tr.Potential("0.5*x**2*y + z**3*cos(t)"))
INSIDE = (tr.Motor((0.01, "0.02*cos(t)", 0.0)),)
RUBBING = (tr.RollingCouple(0.003, 0.001), tr.RollingResistance(0.002), tr.PivotFriction(0.001, 0.5))
LOADS = (*AIR, *INSIDE, *RUBBING)
CASES = [
    (list(BODIES)[(i + j) % 3], surface, motion)
    for (i, surface), (j, motion) in itertools.product(enumerate(SURFACES), enumerate(MOTIONS))
]


@dataclass(frozen=True)
class Driven(Motion):
    """A motion whose coordinates are known functions of the time: of a free axle, for ω̇ = 0."""

    motion: Motion
    support_coordinates_at: Any

    def at(self, time: Any) -> SupportState:
        return self.motion.at(time, *self.support_coordinates_at(time))


def applied(now: Any, n: Vector, omega: Vector, gravity: Vector) -> tuple[Vector, Vector, Vector, Vector]:
    """Return F, K, the part of K that the support exerts, and the couple for each newton of N, all written anew."""
    t, r, V, q, Omega = now
    air = V - Vector(-mpmath.mpf(1.5) * r.y, mpmath.mpf(1.5) * r.x, 0)
    pull = Vector(r.x * r.y, r.x**2 / 2, 3 * r.z**2 * mpmath.cos(t))
    speed = mpmath.sqrt(air.dot(air) + mpmath.mpf(1e-6) ** 2)
    F = gravity - air * (mpmath.mpf(0.3) * speed) + Omega.cross(V) * mpmath.mpf(0.02) - pull
    over = Omega - omega
    spin = over.dot(n)
    along = over - n * spin
    rubbing = along * -mpmath.mpf(0.003) - n * (mpmath.mpf(0.001) * spin)
    motor = q.matrix() @ Vector(mpmath.mpf(0.01), mpmath.mpf(0.02) * mpmath.cos(t), 0)
    resistance = along * (-mpmath.mpf(0.002) / along.norm())
    pivoting = n * (-mpmath.mpf(0.001) * spin / mpmath.sqrt(spin**2 + mpmath.mpf(0.25)))
    return F, motor + rubbing, rubbing, resistance + pivoting


@pytest.mark.parametrize(("body", "surface", "motion"), CASES, ids=[" ".join(case) for case in CASES])
@precisely
def test_the_law_is_that_of_the_multipliers(body: str, surface: str, motion: str) -> None:
    moving, support_coordinates_at = MOTIONS[motion]
    seed, t, tilt = f"{body} {surface} {motion}", mpmath.mpf("0.625"), mpmath.mpf(0.25)
    system = tr.RollingSystem(BODIES[body], tr.Support(SURFACES[surface], motion=moving, tilt=0.25), LOADS)
    known = tr.RollingSystem(
        BODIES[body], tr.Support(SURFACES[surface], motion=Driven(moving, support_coordinates_at), tilt=0.25)
    )
    state = known.support.motion.at(t)
    there = vectors(seed, 1, size=0.3)[0]
    own = SURFACES[surface].point(there.x, there.y)
    q: Quaternion = quaternions(seed, 1)[0]
    Omega = vectors(f"{seed} turning", 1, size=4.0)[0]
    case = Case(known, t, state.carried(own), q, Omega)

    n = normal_at(case, t, case.point)
    rho = offset_at(case, q, n)
    velocity = state.material_velocity(case.point) - Omega.cross(rho)
    p_at = contact_after(case, velocity)
    m, g = mpmath.mpf(known.body.mass), mpmath.mpf(known.gravity)
    weight = Vector(m * g * mpmath.sin(tilt), 0, -m * g * mpmath.cos(tilt))
    now = (t, case.point - rho, velocity, q, Omega)
    F, K, rubbing, couple = applied(now, n, state.angular_velocity, weight)
    V_rate, Omega_rate, R, omega_rate = solved(
        case, velocity, rho, n, p_at, moving, support_coordinates_at(t), (F, K, rubbing, couple)
    )

    found = roll(system, t, case.point, q, Omega, support_coordinates_at(t))
    assert size_of(found.velocity - velocity) <= EXACT(64, 4)
    assert size_of(found.point_rate - slope(p_at)) <= EXACT(64, 4)
    assert size_of(found.angular_acceleration - Omega_rate) <= EXACT(2048, size_of(Omega_rate))
    assert size_of(found.reaction - R) <= EXACT(2048, size_of(R))
    assert size_of(found.reaction + F - V_rate * m) <= EXACT(2048, size_of(R))
    if moving.free:
        rates = moving.coordinate_rates(t, support_coordinates_at(t), found.axle_moment)
        assert abs(rates[-1] - omega_rate) <= EXACT(2048, abs(omega_rate))
        assert abs(omega_rate) > 0.01


def solved(
    case: Case,
    velocity: Vector,
    rho: Vector,
    n: Vector,
    p_at: Callable[[Any], Vector],
    moving: Motion,
    own: tuple[Any, ...],
    acting: tuple[Vector, Vector, Vector, Vector],
) -> tuple[Vector, Vector, Vector, Any]:
    """Return V̇, Ω̇, R and the ω̇ of a free axle."""
    body, Omega, Q, motion = (
        case.system.body,
        case.angular_velocity,
        case.orientation.matrix(),
        case.system.support.motion,
    )
    F, K, rubbing, couple = acting
    u_rate = slope(lambda h: motion.at(case.time + h).material_velocity(p_at(h)))
    constraint = u_rate - Omega.cross(slope(p_at) - velocity)
    m, state = mpmath.mpf(body.mass), motion.at(case.time)
    J = Q @ body.inertia_in_space(Matrix.identity()) @ Q.transpose
    lever = Vector(0, 0, 1).cross(case.point - state.origin)  # the axle stays upright in every free case
    A, b = mpmath.zeros(10, 10), mpmath.matrix([*F, *(K - Omega.cross(J @ Omega)), *constraint, 0])
    cross = Matrix(Vector(0, -rho.z, rho.y), Vector(rho.z, 0, -rho.x), Vector(-rho.y, rho.x, 0))
    for i, (arm, row) in enumerate(zip(cross.rows, J.rows, strict=True)):
        A[i, i], A[i, 6 + i], A[6 + i, i] = m, -1, 1  # m V̇ = F + R, V̇ + Ω̇×ρ − ω̇ lever = constraint
        A[6 + i, 9] = -list(lever)[i] if moving.free else 0
        for j in range(3):
            A[3 + i, 3 + j] = list(row)[j]
            A[6 + i, 3 + j] = -list(arm)[j]
            A[3 + i, 6 + j] = -list(arm)[j] - list(couple)[i] * list(n)[j]  # JΩ̇ − ρ×R − N couple
    A[9, 9] = 1
    if moving.free:  # I ω̇ + lever·R + N couple_z = τ − rubbing_z
        A[9, 9] = mpmath.mpf(moving.inertia)
        b[9] = moving.axle_torque(case.time, own) - rubbing.z
        for j in range(3):
            A[9, 6 + j] = list(lever)[j] + couple.z * list(n)[j]
    x = mpmath.lu_solve(A, b)
    return Vector(*x[0:3]), Vector(*x[3:6]), Vector(*x[6:9]), x[9]
