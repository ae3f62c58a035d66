"""A body that is put down touches, rolls, and has the velocity and spin that were asked for."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Vector
from trundle.mechanics.shapes import Ellipsoid, Sphere, Torus

PRINCIPAL = tr.Principal(0.003, 0.004, 0.005)
BODIES = {
    "ball": tr.Body.solid_sphere(0.125, 0.75),
    "weighted ball": tr.Body(0.75, PRINCIPAL, Sphere(0.125, Vector(0.01, -0.02, 0.03))),
    "ellipsoid": tr.Body(0.75, PRINCIPAL, Ellipsoid(0.15, 0.125, 0.1)),
    "torus": tr.Body(0.75, PRINCIPAL, Torus(0.1, 0.03)),
}
RATE = -2.5
TABLES = {
    "fixed": tr.Support(tr.Plane(rim=1.0)),
    "spinning": tr.Support(tr.Plane(rim=1.0), motion=tr.Spin(RATE), tilt=0.1),
}
SIDE = [-0.2, -0.1, 0.0, 0.1, 0.2]
TRAY = tr.RollingSystem(BODIES["ball"], tr.Support(tr.HeightField.through(SIDE, SIDE, [[0.0] * 5] * 5), friction=0.1))
TURNED = (0.8, 0.3, -0.4, 0.2)


@pytest.fixture(params=BODIES)
def body(request: pytest.FixtureRequest) -> tr.Body:
    return BODIES[request.param]


def lowest(body: tr.Body, orientation: Any) -> Any:
    """Return ρ: the point whose outward normal points down, the rotation made by SciPy."""
    Q = Rotation.from_quat(orientation, scalar_first=True).as_matrix()
    down = -Q.T[:, 2]  # the direction in the body frame
    return Q @ body.shape.support_map(Vector(*down)).array()


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("spin", [None, 0.0, 3.0])
def test_it_touches_and_rolls_as_asked(body: tr.Body, table: str, spin: float | None) -> None:
    system = tr.RollingSystem(body, TABLES[table])
    start = system.place((0.2, -0.3), (0.4, 0.1), spin=spin, orientation=TURNED)
    V, Omega, r = (np.array(getattr(start, name)) for name in ("velocity", "angular_velocity", "position"))
    assert math.hypot(*start.orientation) == pytest.approx(1.0, abs=EXACT(4, 1))
    assert np.abs(np.array(start.orientation) - np.array(TURNED) / math.hypot(*TURNED)).max() <= EXACT(4, 1)
    rho = lowest(body, start.orientation)
    assert np.abs(r[:2] - [0.2, -0.3]).max() <= EXACT(4, 0.5)
    assert abs((r + rho)[2]) <= EXACT(8, 0.2)
    assert start.velocity[:2] == (0.4, 0.1)
    turn = RATE if table == "spinning" else 0.0
    u = np.cross([0.0, 0.0, turn], r + rho)
    assert np.abs(V + np.cross(Omega, rho) - u).max() <= EXACT(16, 2.0)
    assert abs(Omega[2] - (spin or 0.0)) <= EXACT(16, 20.0)


def test_released_with_the_table_it_moves_with_what_is_under_it(body: tr.Body) -> None:
    system = tr.RollingSystem(body, TABLES["spinning"])
    start = system.place((0.2, -0.3), "co-rotating", orientation=TURNED)
    assert np.abs(np.array(start.velocity[:2]) - [-RATE * -0.3, RATE * 0.2]).max() <= EXACT(4, 1.0)
    assert abs(start.angular_velocity[2] - RATE) <= EXACT(16, 4.0)
    # As one piece with the table: Ω = ω n, whatever the body.
    assert np.abs(np.array(start.angular_velocity) - [0.0, 0.0, RATE]).max() <= EXACT(64, 4.0)
    assert abs(start.velocity[2]) <= EXACT(16, 1.0)
    spun = system.place((0.2, -0.3), "co-rotating", spin=1.0, orientation=TURNED)
    assert abs(spun.angular_velocity[2] - 1.0) <= EXACT(16, 4.0)


def test_an_angular_velocity_that_agrees_is_taken_as_it_is(body: tr.Body) -> None:
    system = tr.RollingSystem(body, TABLES["spinning"])
    start = system.place((0.2, -0.3), (0.4, 0.1), spin=3.0, orientation=TURNED)
    again = system.place((0.2, -0.3), (0.4, 0.1), angular_velocity=start.angular_velocity, orientation=TURNED)
    assert again == start


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"position": (1.0, 0.0)}, "position"),
        ({"position": (0.8, -0.7)}, "position"),
        ({"position": (0.1,)}, "position"),
        ({"position": (0.1, math.nan)}, "position"),
        ({"position": "here"}, "position"),
        ({"velocity": "corotating"}, "velocity"),
        ({"velocity": (0.1, 0.2, 0.3, 0.4)}, "velocity"),
        ({"velocity": ("1 m", "2 m")}, "velocity"),
        ({"spin": "3 m/s"}, "spin"),
        ({"spin": math.inf}, "spin"),
        ({"angular_velocity": (1.0, 2.0, 3.0)}, "angular_velocity"),
        ({"angular_velocity": (0.0, 0.0, 1.0), "spin": 1.0}, "angular_velocity"),
        ({"orientation": (0.0, 0.0, 0.0, 0.0)}, "orientation"),
        ({"orientation": (1.0, 0.0, 0.0)}, "orientation"),
    ],
)
def test_a_contradiction_is_refused_by_name(arguments: dict[str, Any], key: str) -> None:
    system = tr.RollingSystem(BODIES["ball"], TABLES["spinning"])
    with pytest.raises(tr.InvalidValueError, match=key):
        system.place(**arguments)


def test_a_body_beyond_the_end_of_a_table_of_numbers_is_over_nothing() -> None:
    assert TRAY.place((0.19, 0.0)).position[0] == 0.19
    with pytest.raises(tr.SolverError, match="no point of the surface is nearest"):
        tr.simulate(TRAY, tr.State((0.21, 0.0, 0.3), (0.0,) * 3, (0.0,) * 3), 0.1, 0.05)


def test_a_body_slips_on_a_table_of_numbers_as_on_the_plane() -> None:
    start = TRAY.place((0.0, 0.0), (0.3, 0.0), angular_velocity=(0.0, 0.0, 0.0))
    run = tr.simulate(TRAY, start, 0.05, 0.05)
    assert abs(run.samples.velocity[-1, 0] - (0.3 - 0.1 * TRAY.gravity * 0.05)) <= SOLVER(10, 1e-12)
