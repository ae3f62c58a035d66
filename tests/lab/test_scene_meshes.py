"""The drawn body is the body, and the drawn support is the surface that is rolled on."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

import trundle as tr
from trundle.mechanics.algebra import Vector
from trundle.views.scene.body_mesh import body_mesh
from trundle.views.scene.support_mesh import ground_of

INERTIA = tr.Principal(1e-3, 1e-3, 1e-3)
BODIES = {
    "ball": tr.Body.solid_sphere(0.5, 1.0),
    "eccentric": tr.Body(1.0, INERTIA, tr.Sphere(0.1, (0.01, 0.0, -0.02))),
    "ellipsoid": tr.Body.ellipsoid((0.2, 0.03, 0.02), 1.0),
    "hemisphere": tr.Body.hemisphere(0.1, 1.0),
    "half-cylinder": tr.Body.half_cylinder(0.1, 1.0),
    "cylinder": tr.Body.cylinder(0.1, 1.0),
    "hoop": tr.Body.hoop(0.1, 1.0),
    "disc": tr.Body.disc(0.1, 1.0),
    "ring": tr.Body.ring(0.1, 1.0),
    "torus": tr.Body.torus(0.1, 0.03, 1.0),
    "rounded disc": tr.Body(1.0, INERTIA, tr.Torus(0.1, 0.02)),
    "egg": tr.Body(1.0, INERTIA, tr.SupportFunction("0.03 + 0.004*nu_z**3")),
}


def merged(mesh):
    """Return the triangles of a mesh whose vertices at one place are one."""
    places = np.round(mesh.vertices / np.ptp(mesh.vertices) * 1e9).astype(np.int64)
    triangles = np.unique(places, axis=0, return_inverse=True)[1].ravel()[mesh.triangles]
    return triangles[[len(set(corners)) == 3 for corners in triangles.tolist()]]


def crossed(mesh):
    p, q, r = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    return np.cross(q - p, r - p)


COARSE = [name for name, body in BODIES.items() if body_mesh(body).coarse is not None]


def meshes():
    """Each body, and those that have it again with fewer triangles."""
    yield from ((body_mesh(body), name) for name, body in BODIES.items())
    for name in COARSE:
        mesh = body_mesh(BODIES[name])
        yield replace(mesh, triangles=mesh.coarse), f"{name}, coarse"


@pytest.mark.parametrize("mesh", [pytest.param(mesh, id=name) for mesh, name in meshes()])
def test_a_body_is_closed_and_faces_outwards(mesh):
    edges = Counter()
    for i, j in ((0, 1), (1, 2), (2, 0)):
        edges.update(map(tuple, merged(mesh)[:, [i, j]].tolist()))
    assert edges
    assert all(count == 1 and edges[edge[::-1]] == 1 for edge, count in edges.items())
    volume = np.sum(np.sum(mesh.vertices[mesh.triangles[:, 0]] * crossed(mesh), axis=1)) / 6
    assert volume > 0
    facing = np.sum(crossed(mesh) * mesh.normals[mesh.triangles].mean(axis=1), axis=1)
    assert np.all(facing > 0)
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, rtol=0, atol=1e-12)
    assert len(mesh.vertices) < 3000


@pytest.mark.parametrize("name", COARSE)
def test_the_coarse_triangles_of_a_body_are_fewer_and_take_in_as_much(name):
    mesh = body_mesh(BODIES[name])
    fine, coarse = (
        np.sum(np.sum(part.vertices[part.triangles[:, 0]] * crossed(part), axis=1)) / 6
        for part in (mesh, replace(mesh, triangles=mesh.coarse))
    )
    assert len(mesh.coarse) < 0.35 * len(mesh.triangles)
    assert 0.98 * fine < coarse <= fine * (1 + 1e-9)


@pytest.mark.parametrize("name", ["ball", "eccentric", "ellipsoid", "hemisphere", "rounded disc", "egg"])
def test_no_vertex_lies_outside_a_body_and_each_normal_has_its_point(name):
    """A convex body is what lies behind all of its tangent planes, X·ν ≤ h(ν); the vertex of ν touches its own."""
    shape, mesh = BODIES[name].shape, body_mesh(BODIES[name])
    rng = np.random.default_rng(5)
    nu = rng.normal(size=(300, 3))
    if name == "hemisphere":
        nu[:, 2] = -np.abs(nu[:, 2])
    nu /= np.linalg.norm(nu, axis=1, keepdims=True)
    reach = np.sum(shape.support_map(Vector.of(nu)).array() * nu, axis=1)
    size = np.ptp(mesh.vertices)
    over = mesh.vertices @ nu.T - reach
    assert np.max(over) < 1e-12 * size
    assert np.max(np.min(-over, axis=0)) < 4e-3 * size  # the mesh's sag at most


def test_an_ellipsoid_has_its_vertices_on_it():
    axes = np.array([0.2, 0.03, 0.02])
    mesh = body_mesh(BODIES["ellipsoid"])
    assert np.allclose(np.sum((mesh.vertices / axes) ** 2, axis=1), 1, rtol=0, atol=1e-12)
    gradient = mesh.vertices / axes**2
    gradient /= np.linalg.norm(gradient, axis=1, keepdims=True)
    assert np.allclose(gradient, mesh.normals, rtol=0, atol=1e-9)
    volume = np.sum(np.sum(mesh.vertices[mesh.triangles[:, 0]] * crossed(mesh), axis=1)) / 6
    assert volume == pytest.approx(4 * np.pi / 3 * np.prod(axes), rel=5e-3)


@pytest.mark.parametrize(("name", "closer"), [("cylinder", 1.0), ("hoop", 0.82), ("disc", 0.0), ("ring", 0.82)])
def test_what_has_a_hole_shows_it(name, closer):
    distance = np.hypot(*body_mesh(BODIES[name]).vertices[:, :2].T)
    assert np.max(distance) == pytest.approx(0.1, rel=1e-12)
    assert np.min(distance) == pytest.approx(0.0 if name in ("cylinder", "disc") else closer * 0.1, abs=1e-12)


SIDE = np.linspace(-0.5, 0.5, 9).tolist()
SURFACES = {
    "plane": (tr.Plane(), [(0.1, 0.2), (0.3, -0.2)]),
    "rimmed plane": (tr.Plane(rim=0.5), [(0.1, 0.2), (0.3, -0.2)]),
    "pipe": (tr.Cylinder(0.5), [(0.1, 0.2), (1.3, -0.2)]),
    "log": (tr.Cylinder(0.5, side="outside"), [(0.1, 0.0), (1.3, 0.0)]),
    "funnel": (tr.Cone("40 deg"), [(0.1, 0.2), (0.3, 0.1)]),
    "hill": (tr.Cone("40 deg", side="outside", rim=0.6), [(0.1, 0.2), (0.3, 0.1)]),
    "bowl": (tr.Bowl(0.5), [(0.1, 0.2), (0.3, 0.0)]),
    "rimmed bowl": (tr.Bowl(0.5, rim=0.45), [(0.1, 0.2), (0.43, 0.0)]),
    "dome": (tr.Dome(0.5), [(0.0, 0.0), (0.3, 0.0)]),
    "dish": (tr.Paraboloid(0.7), [(0.1, 0.2), (0.3, 0.0)]),
    "mound": (tr.Paraboloid(-0.7, rim=0.4), [(0.1, 0.2), (0.3, 0.0)]),
    "ring inside": (tr.TorusTrack(0.4, 0.1), [(0.1, 0.2), (2.0, -0.4)]),
    "ring outside": (tr.TorusTrack(0.4, 0.1, side="outside"), [(0.1, 0.2), (2.0, -0.4)]),
    "elliptic bowl": (tr.EllipsoidalBowl((0.5, 0.4, 0.25)), [(0.1, 0.2), (0.3, 0.0)]),
    "elliptic dish": (tr.EllipsoidalBowl((0.5, 0.4, 0.25), depth=0.1), [(0.1, 0.2), (0.3, 0.0)]),
    "revolution": (tr.Revolution("r**2 - r**4", rim=0.7), [(0.1, 0.2), (0.3, 0.0)]),
    "vortex": (tr.Revolution("-0.02/r"), [(0.1, 0.2), (0.3, 0.0)]),
    "wall like a dish": (tr.Revolution("1000*r**2"), [(0.06, 0.064), (0.0, 0.088)]),
    "table of heights over r": (
        tr.Revolution.through([0.0, 0.1, 0.2, 0.3, 0.4], [0.0, 0.01, 0.04, 0.09, 0.16]),
        [(0.1, 0.2), (0.3, 0.0)],
    ),
    "hills": (tr.HeightField("0.05*sin(6*x)*cos(5*y)"), [(0.1, 0.2), (0.3, 0.0)]),
    "rimmed hills": (tr.HeightField("0.05*sin(6*x)*cos(5*y)", rim=0.5), [(0.1, 0.2), (0.45, 0.0)]),
    "saddle by a table": (
        tr.HeightField.through(SIDE, SIDE, [[x * x - y * y for y in SIDE] for x in SIDE]),
        [(0.1, 0.2), (0.3, 0.0)],
    ),
}


@pytest.mark.parametrize("moves", [False, True])
@pytest.mark.parametrize("name", SURFACES)
def test_a_support_lies_on_its_surface_and_faces_the_body(name, moves):
    surface, coordinates = SURFACES[name]
    places = np.array([surface.point(*pair).array() for pair in coordinates])
    ground = ground_of(surface, moves, places, 0.02)
    mesh = ground.mesh
    used = np.unique(mesh.triangles)
    p = Vector.of(mesh.vertices[used])
    size = np.ptp(mesh.vertices[used])
    with np.errstate(invalid="ignore"):  # at an apex
        level, normal = np.broadcast_to(surface.level(p), used.shape), surface.normal(p)
    assert np.nanmax(np.abs(level)) < 1e-9 * size
    sharp = isinstance(surface, tr.Cone)  # its apex has no normal
    normal = np.broadcast_to(normal.array(), (used.size, 3)) if not sharp else mesh.normals[used]
    assert np.allclose(mesh.normals[used], normal, rtol=0, atol=1e-12)
    assert np.allclose(np.linalg.norm(mesh.normals[used], axis=1), 1, rtol=0, atol=1e-9)
    facing = np.sum(crossed(mesh) * mesh.normals[mesh.triangles].mean(axis=1), axis=1)
    assert np.all(facing > 0)
    assert np.isfinite(mesh.vertices).all()
    assert np.isfinite(mesh.paint).all()
    assert len(mesh.vertices) < 12000
    low, high = np.min(mesh.vertices[used], axis=0), np.max(mesh.vertices[used], axis=0)
    assert np.all(places >= low - 1e-9 * size)
    assert np.all(places <= high + 1e-9 * size)
    assert ground.size >= 0.5 * np.max(high - low) * (1 - 1e-9)
    if surface.rim is not None:
        assert np.max(np.hypot(*mesh.vertices[used, :2].T)) == pytest.approx(float(surface.rim), rel=1e-9)


def test_a_ball_that_goes_over_the_top_of_a_sphere_has_all_of_it():
    bowl = tr.Bowl(0.5)
    angle = np.linspace(0, 3, 40)
    places = np.column_stack([0.5 * np.sin(angle), 0 * angle, 0.5 - 0.5 * np.cos(angle)])
    mesh = ground_of(bowl, False, places, 0.02).mesh
    assert np.max(mesh.vertices[:, 2]) == pytest.approx(1.0, abs=2e-3)
    assert np.max(np.abs(bowl.level(Vector.of(mesh.vertices)))) < 1e-9


def test_the_paint_of_a_turntable_goes_once_round_and_out_to_its_edge():
    places = np.array([[0.1, 0.0, 0.0], [0.2, 0.1, 0.0]])
    ground = ground_of(tr.Plane(rim=0.5), True, places, 0.02)
    x, y, _ = ground.mesh.vertices.T
    turns, outwards = ground.mesh.paint.T
    assert ground.marks == "polar"
    assert np.allclose(outwards, np.hypot(x, y) / 0.5, rtol=0, atol=1e-12)
    assert np.allclose(outwards * np.cos(2 * np.pi * turns), x / 0.5, rtol=0, atol=1e-12)
    assert np.allclose(outwards * np.sin(2 * np.pi * turns), y / 0.5, rtol=0, atol=1e-12)


def test_nearly_the_same_run_shares_its_mesh():
    places = np.array([[0.1, 0.0, 0.0], [0.2, 0.1, 0.0]])
    one, other = (ground_of(tr.Bowl(0.5), True, places * size, 0.02) for size in (1.0, 1.00001))
    assert one is other
