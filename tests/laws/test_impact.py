"""Landings of bodies that are not balls, against impulses worked out by hand in the plane of the motion."""

from __future__ import annotations

import math

import pytest
from tests.tolerances import SOLVER

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.contact import touch
from trundle.mechanics.impact import Impact, land

A, B, MASS, MOMENT, LEAN = 0.3, 0.1, 2.0, 0.05, 0.4
Q = Quaternion(math.cos(LEAN / 2), 0.0, math.sin(LEAN / 2), 0.0)  # turned about the second axis


def landing(slip: tuple[float, float], friction: float | None, restitution: float) -> tuple[Impact, Vector]:
    """Let an ellipsoid come down leaning in the plane of the first and third axis."""
    body = tr.Body(MASS, tr.Principal(0.04, MOMENT, 0.03), tr.Ellipsoid(A, 0.2, B))
    floor = tr.RollingSystem(body, tr.Support(tr.Plane(), friction=friction, restitution=restitution))
    contact = touch(floor, 0.0, Vector(0.0, 0.0, 0.0), Q)
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
