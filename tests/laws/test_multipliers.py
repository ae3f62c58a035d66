"""The rolling law against Lagrange multipliers, for bodies, surfaces and motions that the law has never seen.

Nothing of T1-T3 is used: the body is moved a little with V and Ω, the new place of contact is searched for, and ρ̇, ṗ, ṅ
and u̇ are difference quotients; then Newton, Euler and the differentiated constraint are one linear system of which the
reaction is the multiplier.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath
import pytest
from tests.additions import Ball, Tumble
from tests.precise import directions, numbers, precisely, quaternions, size_of, slope, turn, unit, vectors
from tests.tolerances import EXACT

import trundle as tr
from trundle.mechanics.algebra import Matrix, Quaternion, Vector
from trundle.mechanics.contact import contact_at, roll
from trundle.mechanics.loads import BodyMotion
from trundle.mechanics.shapes import Ellipsoid, Sphere, Torus

PRINCIPAL = tr.Principal(0.003, 0.004, 0.005)
BODIES = {
    "ball": tr.Body.sphere(radius=0.125, mass=0.75, inertia_ratio=0.55),
    "Chaplygin's ball": tr.Body(0.75, PRINCIPAL, Sphere(0.125)),
    "weighted ball": tr.Body(0.75, PRINCIPAL, Sphere(0.125, Vector(0.01, -0.02, 0.03))),
    "ellipsoid": tr.Body(0.75, PRINCIPAL, Ellipsoid(0.15, 0.125, 0.1)),
    "torus": tr.Body(0.75, PRINCIPAL, Torus(0.1, 0.03)),
    "thin disc": tr.Body(0.75, PRINCIPAL, Torus(0.12, 0.0)),
}
SURFACES = {
    "plane": tr.Plane(),
    "hill": Ball(0.5, 1.0),
    "bowl": Ball(0.75, -1.0),
    "pipe": tr.Cylinder(0.5),
    "log": tr.Cylinder(0.5, "outside"),
}
MOTIONS = {
    "fixed": tr.Fixed(),
    "spinning": tr.Spin(-2.5),
    "tumbling": Tumble(1.5, 0.25, -0.75, Vector(0.5, -0.25, 0.125), 2.0),
    "uneven": tr.UnevenSpin(2.5, 0.3, 4.0),
    "wobbling": tr.Wobble(-1.5, 0.2),
}
LOADS = (tr.Force((0.25, -0.5, 0.125)), tr.Torque(("0.01*cos(2*t)", 0.02, "-0.03*t")), tr.Drag(0.3, air=1.5))
# Every body on every surface, the motions by turns; each motion meets every body and every surface.
CASES = [
    (body, surface, list(MOTIONS)[(i + j) % len(MOTIONS)])
    for (i, body), (j, surface) in itertools.product(enumerate(BODIES), enumerate(SURFACES))
]
SOME, NAMED = CASES[::5], [" ".join(case) for case in CASES]


@dataclass(frozen=True)
class Case:
    """A random admissible state of a system."""

    system: tr.RollingSystem
    time: Any
    point: Vector
    orientation: Quaternion
    angular_velocity: Vector


def on_surface(name: str, seed: Any) -> Vector:
    """Return a point of a surface in the support's own frame."""
    e, (x, y) = directions(seed, 1)[0], numbers(f"{seed} along", 2)
    around = unit(Vector(e.x, e.y, mpmath.mpf(0)))
    return {
        "plane": Vector(x, y, mpmath.mpf(0)),
        "hill": e * mpmath.mpf(0.5),
        "bowl": e * mpmath.mpf(0.75),
        "pipe": around * mpmath.mpf(0.5) + Vector(0, 0, x),
        "log": around * mpmath.mpf(0.5) + Vector(0, 0, y),
    }[name]


def case_of(body: str, surface: str, motion: str) -> Case:
    seed = f"{body} {surface} {motion}"
    support = tr.Support(SURFACES[surface], motion=MOTIONS[motion], tilt=0.25)
    system = tr.RollingSystem(BODIES[body], support, loads=LOADS)
    (time,) = (abs(t) for t in numbers(f"{seed} time", 1))
    now = support.motion.at(time)
    point = now.origin + now.rotation @ on_surface(surface, seed)
    return Case(system, time, point, quaternions(seed, 1)[0], vectors(f"{seed} turning", 1, size=4.0)[0])


def normal_at(case: Case, time: Any, p: Vector) -> Vector:
    now = case.system.support.motion.at(time)
    return now.rotation @ case.system.support.surface.normal(now.rotation.transpose @ (p - now.origin))


def offset_at(case: Case, q: Quaternion, n: Vector) -> Vector:
    Q = q.matrix()
    return Q @ case.system.body.shape.support_map(-(Q.transpose @ n))


def contact_after(case: Case, velocity: Vector) -> Callable[[Any], Vector]:
    """Return p as a function of a short time, found as the place where the moved body touches the moved surface."""
    r = case.point - offset_at(case, case.orientation, normal_at(case, case.time, case.point))

    @functools.cache
    def search(h: Any) -> Vector:
        moved, q, later = r + velocity * h, turn(case.angular_velocity * h) * case.orientation, case.time + h
        now = case.system.support.motion.at(later)

        def misses(x: Any, y: Any, z: Any, gap: Any) -> list[Any]:
            p = Vector(x, y, z)
            n = normal_at(case, later, p)
            level = case.system.support.surface.level(now.rotation.transpose @ (p - now.origin))
            return [*(moved + offset_at(case, q, n) - p - n * gap), level]

        found = mpmath.findroot(misses, [*case.point, 0], tol=mpmath.mpf(10) ** -100, maxsteps=4, verify=False)
        assert max(abs(miss) for miss in misses(*found)) < mpmath.mpf(10) ** -45
        return Vector(*found[:3])

    return search


def accelerations(case: Case, velocity: Vector, rho: Vector, p_at: Callable[[Any], Vector]) -> tuple[Vector, ...]:
    """Return V̇, Ω̇ and R, from difference quotients and one linear system."""
    body, Omega, Q = case.system.body, case.angular_velocity, case.orientation.matrix()
    motion = case.system.support.motion
    u_rate = slope(lambda h: motion.at(case.time + h).material_velocity(p_at(h)))
    rho_rate = slope(p_at) - velocity
    m, weight = mpmath.mpf(body.mass), mpmath.mpf(body.mass) * case.system.gravity
    J = Q @ body.inertia_in_space(Matrix.identity()) @ Q.transpose
    now = BodyMotion(case.time, m, case.point - rho, velocity, case.orientation, Omega)
    tilt = mpmath.mpf(case.system.support.tilt)
    F = (
        Vector(weight * mpmath.sin(tilt), 0, -weight * mpmath.cos(tilt))
        + LOADS[0].value
        - (velocity - Vector(0, 0, mpmath.mpf(1.5)).cross(case.point - rho)) * LOADS[2].coefficient
    )
    K = Vector(mpmath.mpf(0.01) * mpmath.cos(2 * case.time), 0.02, mpmath.mpf(-0.03) * case.time)
    assert size_of(F - case.system.loads_on(now)[0]) <= EXACT(16, weight)
    constraint = u_rate - Omega.cross(rho_rate)  # V̇ + Ω̇×ρ
    A, b = mpmath.zeros(9, 9), mpmath.matrix([*F, *(K - Omega.cross(J @ Omega)), *constraint])
    cross = Matrix(Vector(0, -rho.z, rho.y), Vector(rho.z, 0, -rho.x), Vector(-rho.y, rho.x, 0))
    for i, (arm, row) in enumerate(zip(cross.rows, J.rows, strict=True)):
        A[i, i], A[i, 6 + i], A[6 + i, i] = m, -1, 1
        for j in range(3):
            A[3 + i, 3 + j] = list(row)[j]
            A[3 + i, 6 + j] = A[6 + i, 3 + j] = -list(arm)[j]
    x = mpmath.lu_solve(A, b)
    return Vector(*x[0:3]), Vector(*x[3:6]), Vector(*x[6:9])


@pytest.mark.parametrize(("body", "surface", "motion"), CASES, ids=NAMED)
@precisely
def test_the_law_is_that_of_the_multipliers(body: str, surface: str, motion: str) -> None:
    case = case_of(body, surface, motion)
    rho = offset_at(case, case.orientation, normal_at(case, case.time, case.point))
    u = case.system.support.motion.at(case.time).material_velocity(case.point)
    velocity = u - case.angular_velocity.cross(rho)
    p_at = contact_after(case, velocity)
    found = roll(case.system, case.time, case.point, case.orientation, case.angular_velocity)

    speed = size_of(velocity) + size_of(u) + size_of(case.angular_velocity) * rho.norm()
    assert size_of(found.velocity - velocity) <= EXACT(64, speed)
    assert size_of(found.point_rate - slope(p_at)) <= EXACT(64, speed)  # T1
    q_rate = slope(lambda h: Vector(*list(turn(case.angular_velocity * h) * case.orientation)[1:]))
    assert size_of(Vector(*list(found.orientation_rate)[1:]) - q_rate) <= EXACT(64, size_of(case.angular_velocity))

    _, Omega_rate, R = accelerations(case, velocity, rho, p_at)
    assert size_of(found.angular_acceleration - Omega_rate) <= EXACT(512, size_of(Omega_rate))  # T2
    assert size_of(found.reaction - R) <= EXACT(512, size_of(R))  # T3


@pytest.mark.parametrize(("body", "surface", "motion"), SOME, ids=NAMED[::5])
@precisely
def test_the_normal_leans_as_the_shape_operator_says(body: str, surface: str, motion: str) -> None:
    # ṅ = ω×n + S w, the step from which T1 is derived.
    case = case_of(body, surface, motion)
    contact = contact_at(case.system, case.time, case.point, case.orientation)
    velocity = contact.rolling_velocity(case.angular_velocity)
    p_at = contact_after(case, velocity)
    n_rate = slope(lambda h: normal_at(case, case.time + h, p_at(h)))
    zero = Vector(mpmath.mpf(0), mpmath.mpf(0), mpmath.mpf(0))
    p_rate, rho_rate = contact.rates(zero, case.angular_velocity, velocity)
    w = p_rate - contact.support.material_velocity(case.point)
    leans = contact.support.angular_velocity.cross(contact.normal) + contact.shape_operator @ w
    assert size_of(n_rate - leans) <= EXACT(64, 4 + size_of(leans))
    assert abs(w.dot(contact.normal)) <= EXACT(64, 1 + w.norm())
    assert size_of(rho_rate - (slope(p_at) - velocity)) <= EXACT(64, 1 + velocity.norm())


@precisely
def test_slip_is_added_to_the_contact_kinematics() -> None:
    # (T1) with s: sliding without turning carries the contact along with the body over a plane.
    case = case_of("ellipsoid", "plane", "fixed")
    contact = contact_at(case.system, case.time, case.point, case.orientation)
    slip, zero = (
        Vector(mpmath.mpf(1), mpmath.mpf(2), mpmath.mpf(0)),
        Vector(mpmath.mpf(0), mpmath.mpf(0), mpmath.mpf(0)),
    )
    p_rate, rho_rate = contact.rates(slip, zero, slip)
    assert size_of(p_rate - slip) + size_of(rho_rate) <= EXACT(16, 2)
    assert size_of(contact.slip_velocity(slip, zero) - slip) == 0
