"""Landings of bodies that are not balls, against impulses worked out by hand in the plane of the motion."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Matrix, Quaternion, Vector
from trundle.mechanics.contact import contact_at
from trundle.mechanics.impact import Impact, _Course, land
from trundle.verify.course import Course

A, B, MASS, MOMENT, LEAN = 0.3, 0.1, 2.0, 0.05, 0.4
Q = Quaternion(math.cos(LEAN / 2), 0.0, math.sin(LEAN / 2), 0.0)  # turned about the second axis


def landing(slip: tuple[float, float], friction: float | None, restitution: float) -> tuple[Impact, Vector]:
    """Let an ellipsoid come down leaning in the plane of the first and third axis."""
    body = tr.Body(MASS, tr.Principal(0.04, MOMENT, 0.03), tr.Ellipsoid(A, 0.2, B))
    floor = tr.RollingSystem(body, tr.Support(tr.Plane(), friction=friction, restitution=restitution))
    contact = contact_at(floor, 0.0, Vector(0.0, 0.0, 0.0), Q)
    return land(floor, contact, Q, Vector(slip[0], 0.0, slip[1])), contact.offset


def planar(rho: Vector) -> tuple[float, float, float]:
    """Return by how much a unit impulse along x, along z, changes the slip along x, across, and along z."""
    return 1 / MASS + rho.z**2 / MOMENT, -rho.x * rho.z / MOMENT, 1 / MASS + rho.x**2 / MOMENT


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("friction", [0.0, 0.05])
def test_a_body_that_slips_all_the_way(friction: float, restitution: float) -> None:
    # Slipping one way, s_n falls off with the impulse at a steady rate c: P = (1 + e)|s_n|/c by Stronge's rule.
    found, rho = landing((5.0, -2.0), friction, restitution)
    _, across, along = planar(rho)
    P = (1 + restitution) * 2.0 / (along - friction * across)
    assert abs(found.impulse.z - P) <= SOLVER(10 * P, 1e-12)
    assert abs(found.impulse.x + friction * P) <= SOLVER(10 * P, 1e-12)
    turned = (rho.z * found.impulse.x - rho.x * found.impulse.z) / MOMENT
    assert abs(found.angular_velocity_change.y - turned) <= SOLVER(10 * abs(turned), 1e-12)


def test_a_body_that_sticks() -> None:
    # Without limit to friction and without restitution, all of the slip is gone: a pair of linear equations.
    found, rho = landing((0.7, -2.0), None, 0.0)
    xx, xz, zz = planar(rho)
    determinant = xx * zz - xz * xz
    assert abs(found.impulse.x - (-0.7 * zz - 2.0 * xz) / determinant) <= SOLVER(10, 1e-12)
    assert abs(found.impulse.z - (2.0 * xx + 0.7 * xz) / determinant) <= SOLVER(10, 1e-12)


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.4, 2.0])
@pytest.mark.parametrize("across", [-3.0, -0.2, 0.0, 0.2, 3.0])
def test_no_landing_makes_energy(friction: float, across: float) -> None:
    found, rho = landing((across, -2.0), friction, 1.0)
    xx, xz, zz = planar(rho)
    x, z = found.impulse.x, found.impulse.z
    gained = x * across - 2.0 * z + 0.5 * (xx * x * x + 2 * xz * x * z + zz * z * z)  # P·s + ½P·MP
    assert gained <= SOLVER(10, 1e-12)
    if friction == 0:
        assert abs(gained) <= SOLVER(10, 1e-12)  # e = 1 gives all of it back


@pytest.mark.parametrize(("friction", "across"), [(1.2, 0.2), (0.9, -0.5), (2.0, 0.3)])
def test_slip_that_ends_on_the_way(friction: float, across: float) -> None:
    # Slip falls at a steady rate to nothing, and from there on friction is what keeps it so: two straight pieces.
    found, rho = landing((across, -2.0), friction, 0.0)
    xx, xz, zz = planar(rho)
    way = math.copysign(friction, across)
    sliding = -across / (xz - way * xx)
    left = -2.0 + (zz - way * xz) * sliding
    assert sliding > 0 > left  # it ends before compression does
    assert abs(xz / xx) < friction  # and friction can hold it
    holding = -left / (zz - xz * xz / xx)
    assert abs(found.impulse.z - (sliding + holding)) <= EXACT(32, sliding + holding)
    x = -way * sliding - xz / xx * holding
    assert abs(found.impulse.x - x) <= EXACT(32, friction * (sliding + holding))
    assert found.impulse.y == 0.0


@pytest.mark.parametrize(("friction", "slip"), [(0.1, (1.0, 0.7, -2.0)), (0.2, (3.0, 1.5, -1.0))])
def test_slip_that_turns_on_the_way(friction: float, slip: tuple[float, float, float]) -> None:
    # Keller's ds/dP = M(n − μŝ) by Taylor's method with 25 digits, up to where s_n = 0.
    turned = Quaternion(0.8, 0.3, 0.4, math.sqrt(0.11))
    principal = (0.04, MOMENT, 0.03)
    body = tr.Body(MASS, tr.Principal(*principal), tr.Ellipsoid(A, 0.2, B))
    floor = tr.RollingSystem(body, tr.Support(tr.Plane(), friction=friction))
    contact = contact_at(floor, 0.0, Vector(0.0, 0.0, 0.0), turned)
    found = land(floor, contact, turned, Vector(*slip)).impulse
    with mpmath.workdps(25):
        Q = mpmath.matrix([[float(part) for part in row] for row in turned.matrix().rows])
        x, y, z = (mpmath.mpf(float(part)) for part in contact.offset)
        cross = mpmath.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        M = mpmath.eye(3) / MASS - cross * Q * mpmath.diag([1 / mpmath.mpf(part) for part in principal]) * Q.T * cross

        def rates(_: object, s: list[mpmath.mpf]) -> list[mpmath.mpf]:
            sigma = mpmath.hypot(s[0], s[1])
            return list(M * mpmath.matrix([-friction * s[0] / sigma, -friction * s[1] / sigma, 1]))

        course = mpmath.odefun(rates, 0, [mpmath.mpf(part) for part in slip])
        P = mpmath.findroot(lambda P: course(P)[2], float(found.z))
        ended = course(P)
        impulse = mpmath.lu_solve(M, mpmath.matrix(ended) - mpmath.matrix(slip))
    aside = math.atan2(slip[1], slip[0]) - float(mpmath.atan2(ended[1], ended[0]))
    assert abs(aside) > 1e-2  # it does turn
    assert max(abs(a - float(b)) for a, b in zip(found, impulse, strict=True)) <= EXACT(64, float(P))


@pytest.mark.parametrize("mass", [1e-12, 1e-6, 1e-3, 1.0, 1e6, 1e12])
@pytest.mark.parametrize("slip", [(0.3, 0.1, -0.6), (0.9, -0.4, -2.0), (-0.002, 0.0006, -0.025), (1.6e-3, 6e-4, -0.5)])
def test_a_landing_in_which_slip_turns_does_not_depend_on_the_mass(
    mass: float, slip: tuple[float, float, float]
) -> None:
    # By dimensions: velocities change alike, and the impulse is as many times as great as the mass.
    def struck(times: float) -> Impact:
        body = tr.Body(MASS * times, tr.Principal(0.04 * times, 0.05 * times, 0.03 * times), tr.Ellipsoid(A, 0.2, B))
        floor = tr.RollingSystem(body, tr.Support(tr.Plane(), friction=0.4, restitution=0.8))
        return land(floor, contact_at(floor, 0.0, Vector(0.0, 0.0, 0.0), Q), Q, Vector(*slip))

    found, one = struck(mass), struck(1.0)
    speed, turning = one.velocity_change.norm(), one.angular_velocity_change.norm()
    assert (found.velocity_change - one.velocity_change).norm() <= EXACT(64, speed)
    assert (found.angular_velocity_change - one.angular_velocity_change).norm() <= EXACT(64, turning)
    assert (found.impulse / mass - one.impulse).norm() <= EXACT(64, one.impulse.norm())


@pytest.mark.parametrize("restitution", [0.0, 0.7])
@pytest.mark.parametrize("friction", [0.05, 0.4, 1.1])
@pytest.mark.parametrize("seed", range(12))
def test_slip_that_turns_by_its_size_and_by_its_components(seed: int, friction: float, restitution: float) -> None:
    # A card follows it a second way, and both to the last digits: M of any body, slip that ends and that does not.
    random = np.random.default_rng(seed)
    turned, _ = np.linalg.qr(random.normal(size=(3, 3)))
    M = turned @ np.diag(random.uniform(0.4, 3.0, 3)) @ turned.T
    slip = np.array([*random.normal(size=2) * 10.0 ** random.uniform(-3, 1), -1.0])
    rows = Matrix(*(Vector(*row) for row in M.tolist()))
    found = _Course(rows, friction, restitution, 0.5, Vector(*slip.tolist())).impulse().array()
    wanted = Course(M, friction, restitution, slip, 0.5).impulse()
    assert np.abs(found - wanted).max() <= EXACT(256, np.abs(wanted).max())


@pytest.mark.parametrize("friction", [3.0, 0.3, 0.03])
def test_a_body_that_is_easy_to_turn_keeps_no_speed_off_the_support(friction: float) -> None:
    # Light impulses turn it fast: what an impulse errs by must not be told by the momentum of the whole body.
    for seed in range(40):
        drawn = np.random.default_rng(seed)
        moments = tuple(3e-5 * drawn.uniform(1.0, 1.7, 3))
        body = tr.Body(1.3, tr.Principal(*moments), tr.Ellipsoid(0.013, 0.19, 0.12))
        system = tr.RollingSystem(body, tr.Support(tr.Plane(), friction=friction))
        q = Quaternion(*(turn := drawn.normal(size=4)) / np.linalg.norm(turn))
        contact, s = contact_at(system, 0.0, Vector(0.0, 0.0, 0.0), q), Vector(*drawn.normal(size=2), -1.0)
        struck = land(system, contact, q, s)
        turned = struck.angular_velocity_change.cross(contact.offset)
        after = (s + struck.velocity_change + turned).z
        assert 1.3 * abs(after) <= 1e-12 * struck.impulse.norm(), seed


LIGHT = """
start = {{ position = [-0.104, 0.2095], attitude = [0.3, 1.2, 0.01], height = 0.0075 }}
run = {{ duration = 0.2, every = 0.01 }}
[body]
kind = "ellipsoid"
semi_axes = [0.16, 0.12, 0.06]
mass = 20
moments = [{}, {}, {}]
centre = [-0.01, 0.006, -0.009]
[support]
kind = "cone"
half_angle = "45 deg"
{}
"""


@pytest.mark.parametrize("inertia", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize(("friction", "restitution"), [(0.5, 0.0), (0.5, 0.5), (None, 0.5)])
def test_one_impulse_sets_down_a_heavy_body_of_hardly_any_inertia(
    inertia: float, friction: float | None, restitution: float
) -> None:
    # Its impulse is a light one, of which V = Ω×ρ with a rounding of Ω would take a share of m|ρ|²/J times that.
    moments = np.array([1.1, 1.5, 1.2]) * inertia
    loose = "" if friction is None else f"friction = {friction}"
    run = tr.Scenario.loads(LIGHT.format(*moments, f"{loose}\nrestitution = {restitution}")).run()
    assert run.card().passed
    landings = [event for event in run.events if event.kind in ("land", "settle")]
    assert landings
    for event in landings:
        before, after = event.before, event.after
        assert before is not None
        assert after is not None
        assert event.contact is not None
        rho = np.subtract(event.contact, before.position)
        axes = np.array([row.array() for row in Quaternion(*before.orientation).matrix().rows])
        turned = axes @ np.diag(moments) @ axes.T @ np.subtract(after.angular_velocity, before.angular_velocity)
        P = 20.0 * np.subtract(after.velocity, before.velocity)
        sharp = 2e-13 * np.linalg.norm(P) + EXACT(16, 20.0 * np.linalg.norm([before.velocity, after.velocity]))
        if event.kind == "land":  # else V loses what is left of the bounces, too
            assert np.linalg.norm(turned - np.cross(rho, P)) <= np.linalg.norm(rho) * sharp
