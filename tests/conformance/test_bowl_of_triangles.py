"""A bowl of triangles: the mesh, and the ball that is exact but for it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import trundle as tr
from trundle.conformance import cases
from trundle.conformance.bowl_of_triangles import BowlOfTriangles
from trundle.conformance.case import Array
from trundle.conformance.measuring import errors_of
from trundle.conformance.triangles import Triangles, stretches

BOWLS = {case.name: case for case in cases() if isinstance(case, BowlOfTriangles)}
COARSE = BOWLS["bowl-mesh-coarse"]


def matrix(quaternion: Array) -> Array:
    """Of a unit quaternion (w, x, y, z)."""
    turn: Array = Rotation.from_quat(quaternion, scalar_first=True).as_matrix()
    return turn


def mesh_of(case: BowlOfTriangles) -> tuple[Triangles, Array]:
    """The mesh as the task tells it, about the middle of the sphere; nothing else of the case is used."""
    told = case.situation()["support"]
    vertices = np.array(told["mesh"]["vertices"]) - [0.0, 0.0, told["radius"]]
    corners = np.array(told["mesh"]["triangles"])
    a, b, c = (vertices[corners[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return Triangles(vertices, corners, normals, -(normals * a).sum(-1)), vertices


@pytest.mark.parametrize("case", BOWLS.values(), ids=lambda case: case.name)
def test_the_triangles_bound_a_convex_room_about_the_bowl(case: BowlOfTriangles) -> None:
    mesh, vertices = mesh_of(case)
    assert len(mesh.corners) == int("".join(filter(str.isdigit, case.title)))
    for normal, distance in zip(mesh.normals, mesh.distances, strict=True):
        assert (distance + vertices @ normal).min() >= -1e-12
    assert np.ptp(np.linalg.norm(vertices, axis=-1)) < 1e-12
    assert (mesh.normals[:, 2] > 0).all()
    # The ball begins on the bowl and on a triangle at once.
    body = case.situation()["bodies"][0]
    gaps = mesh.distances + mesh.normals @ (np.array(body["position"]) - [0, 0, 0.5])
    assert gaps.min() == pytest.approx(0.025, abs=1e-14)
    # Each edge within belongs to two triangles, each way once: there is no hole.
    edges = [pair for a, b, c in mesh.corners.tolist() for pair in ((a, b), (b, c), (c, a))]
    known = set(edges)
    assert len(known) == len(edges)
    rim = [i for edge in edges if edge[::-1] not in known for i in edge]
    highest = case.exact().position[..., 2].max() - 0.5
    assert vertices[rim, 2].min() > highest


def test_each_triangle_and_each_edge_is_as_trundle_rolls_and_lands() -> None:
    """The general law of this package knows planes and landings, and no meshes: here it goes from one to the next."""
    told = COARSE.situation()
    mesh, _ = mesh_of(COARSE)
    found = stretches(mesh, told, COARSE.duration)
    body = told["bodies"][0]
    ball = tr.Body.solid_sphere(radius=0.025, mass=body["mass"])
    velocity, turning = np.array(body["velocity"]), np.array(body["angular_velocity"])
    place, orientation = np.array(body["position"]) - [0, 0, 0.5], np.eye(3)
    gravity = np.array(told["gravity"])
    assert len(found) > 40
    for each, until in zip(found, [*(one.time for one in found[1:]), COARSE.duration], strict=True):
        n = each.normal
        down = gravity - (gravity @ n) * n
        x = down / np.linalg.norm(down)
        A = np.stack([x, np.cross(n, x), n])
        ground = tr.Support(tr.Plane(), tilt=math.atan2(gravity @ x, -(gravity @ n)), friction=1.0, restitution=0.0)
        state = tr.State((0.0, 0.0, 0.025), tuple(A @ velocity), tuple(A @ turning), (1.0, 0.0, 0.0, 0.0))
        span = until - each.time
        data = tr.simulate(tr.RollingSystem(ball, ground), state, span, span).data.isel(time=-1)
        turned = matrix(data.orientation.values)
        place = place + A.T @ (data.position.values - [0, 0, 0.025])
        velocity, turning = A.T @ data.velocity.values, A.T @ data.angular_velocity.values
        orientation = A.T @ turned @ A @ orientation
        assert (mesh.distances + mesh.normals @ place).min() >= 0.025 - 1e-12  # it is in no triangle
    ours = COARSE.on_mesh()
    assert place == pytest.approx(ours.position[-1, 0] - [0, 0, 0.5], abs=1e-12)
    assert velocity == pytest.approx(ours.velocity[-1, 0], abs=1e-11)
    assert turning == pytest.approx(ours.angular_velocity[-1, 0], abs=1e-9)
    assert orientation == pytest.approx(matrix(ours.orientation[-1, 0]), abs=1e-9)


def test_an_edge_takes_what_a_pencil_loses() -> None:
    """Straight over an edge of angle δ, a ball keeps (cos δ + k)/(1 + k) of its speed."""
    delta, k, speed = 0.3, 0.4, 2.0
    normals = np.array([[0.0, 0.0, 1.0], [-math.sin(delta), 0.0, math.cos(delta)]])
    mesh = Triangles(np.zeros((0, 3)), np.zeros((0, 3)), normals, np.array([1.0, 1.0]))
    told = {
        "gravity": [0.0, 0.0, 0.0],
        "friction": 1.0,
        "support": {"radius": 1.0},
        "bodies": [
            {
                "shape": {"radius": 0.1},
                "mass": 2.0,
                "inertia": [[k * 2.0 * 0.01]],
                "position": [-1.0, 0.0, 0.1],
                "velocity": [speed, 0.0, 0.0],
                "angular_velocity": [0.0, speed / 0.1, 0.0],
            }
        ],
    }
    first, second = stretches(mesh, told, 2.0)
    assert first.time == 0.0
    kept = (math.cos(delta) + k) / (1 + k)
    assert second.velocity == pytest.approx(speed * kept * np.array([math.cos(delta), 0.0, math.sin(delta)]))
    told["friction"] = 0.01
    with pytest.raises(ArithmeticError, match="slips at an edge"):
        stretches(mesh, told, 2.0)


def test_the_share_of_the_mesh_falls_with_its_edges() -> None:
    """Half the edge, half the share: what is lost at edges is of first order."""
    shares = [errors_of(case, case.exact(), case.on_mesh()) for case in BOWLS.values()]
    coarse, fine, medium = shares
    assert 1.5 < coarse.position / medium.position < 2.6
    assert 1.5 < medium.position / fine.position < 2.6
    assert all(each.own == 0.0 and each.mesh == max(each.position, each.turning) for each in shares)
    # Energy only falls, and by as much as all edges take.
    for case in BOWLS.values():
        energy = case.energy(case.on_mesh())
        assert np.diff(energy).max() < 1e-12 * case.kinetic_energy(case.exact()).max()
        for motion in (case.exact(), case.on_mesh()):
            assert np.abs(case.slip(motion)).max() < 1e-14


@pytest.mark.parametrize("points", [None, 3, 40.5, "many"])
def test_a_mesh_needs_a_number_of_points(points: object) -> None:
    tables = {"mesh": {"points": points} if points else 5}
    with pytest.raises(tr.ScenarioError, match=r"mesh\.points"):
        BowlOfTriangles.read("mine", tables, "mine.toml")
