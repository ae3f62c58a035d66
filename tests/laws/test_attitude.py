"""Heading, lean and turn: against another library's Euler angles, and where a coin then stands."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.tolerances import EXACT

import trundle as tr
from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import E_X, E_Y, E_Z, Quaternion, Vector
from trundle.mechanics.attitude import attitude, attitude_of

ANGLES = [(0.0, 0.0, 0.0), (0.3, 1.2, -2.0), (-3.0, 0.01, 3.0), (2.0, 3.1, 1.0), (math.pi, math.pi / 2, math.pi)]
FRAME = Rotation.from_euler("xyz", [0.4, -0.7, 1.9]).as_matrix()
E1, E2, N = (Vector(*column) for column in FRAME.T)


@pytest.mark.parametrize("angles", ANGLES, ids=str)
def test_they_are_z_x_z_euler_angles_in_the_frame_of_the_contact(angles: tuple[float, float, float]) -> None:
    q = attitude(E1, E2, N, *angles)
    wanted = FRAME @ Rotation.from_euler("ZXZ", angles).as_matrix()
    assert np.allclose([list(row) for row in q.matrix().rows], wanted, rtol=0, atol=EXACT(8, 1))
    assert sum(part * part for part in q) == pytest.approx(1.0, abs=EXACT(8, 1))
    assert q.w >= 0


@pytest.mark.parametrize("angles", ANGLES[1:4], ids=str)
def test_they_can_be_read_off_again(angles: tuple[float, float, float]) -> None:
    # Near the pole the turn is known as well as the sine of the lean is.
    assert attitude_of(E1, E2, N, attitude(E1, E2, N, *angles)) == pytest.approx(
        angles, abs=EXACT(16, 1 / math.sin(angles[1]))
    )


@pytest.mark.parametrize(("lean", "heading"), [(0.0, 0.7), (math.pi, 0.3)])
def test_lying_flat_a_body_has_one_angle_left(lean: float, heading: float) -> None:
    found = attitude_of(E1, E2, N, attitude(E1, E2, N, 0.5, lean, 0.2))
    assert found.turn == 0.0
    assert found == pytest.approx((heading, lean, 0.0), abs=EXACT(16, 1))
    again = attitude(E1, E2, N, *found)
    assert np.allclose(again.array(), attitude(E1, E2, N, 0.5, lean, 0.2).array(), rtol=0, atol=EXACT(16, 1))


def test_a_whole_run_is_read_off_at_once() -> None:
    angles = np.array([*ANGLES[1:4], (0.5, 0.0, 0.2)])
    qs = np.array([list(attitude(E_X, E_Y, E_Z, *row)) for row in angles])
    found = np.stack(attitude_of(E_X, E_Y, E_Z, Quaternion.of(qs)), axis=-1)
    assert np.allclose(found, [*ANGLES[1:4], (0.7, 0.0, 0.0)], rtol=0, atol=1e-13)


@pytest.mark.parametrize("lean", ["90 deg", "60 deg", "120 deg", "5 deg"])
@pytest.mark.parametrize("heading", [0.0, 2.5])
def test_a_coin_stands_on_its_rim_along_its_heading(lean: str, heading: float) -> None:
    a, theta = 0.03, math.radians(float(lean.removesuffix(" deg")))
    system = tr.RollingSystem(tr.Body.disc(a, mass=0.01), tr.Support(tr.Plane()))
    q = attitude(E_X, E_Y, E_Z, heading, lean, turn=1.0)
    start = system.place(orientation=tuple(q))
    assert start.position[2] == pytest.approx(a * math.sin(theta), rel=1e-14)  # its centre is that high
    Q = q.matrix()
    rho, C = system.body.shape.contact(Q, E_Z)
    along = Vector(math.cos(heading), math.sin(heading), 0.0)
    assert (C @ along - along * (a / math.sin(theta))).norm() == pytest.approx(0.0, abs=1e-15)  # the rim lies along it
    # Below 90 degrees the top leans to the left: the contact is to the right of the centre.
    left = E_Z.cross(along)
    assert rho.dot(left) == pytest.approx(-a * math.cos(theta), abs=1e-15)
    axis = Q @ E_Z
    assert axis.dot(left) == pytest.approx(-math.sin(theta), abs=1e-15)


def test_the_turn_is_about_the_bodys_own_axis() -> None:
    # A mark on the rim where the first body axis leaves it: with no turn it is ahead, with a quarter turn on top.
    ahead = attitude(E_X, E_Y, E_Z, lean="90 deg").matrix() @ E_X
    top = attitude(E_X, E_Y, E_Z, lean="90 deg", turn="90 deg").matrix() @ E_X
    assert (ahead - E_X).norm() < 1e-15
    assert (top - E_Z).norm() < 1e-15


def test_a_wrong_angle_is_named() -> None:
    with pytest.raises(InvalidValueError, match="`lean` must be an angle"):
        attitude(E_X, E_Y, E_Z, lean="3 m")
