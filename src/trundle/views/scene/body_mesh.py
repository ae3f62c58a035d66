"""The body as a mesh, from its support map: vertices X(ν) over a grid of outward normals ν.

Where X is not one-to-one, as on an edge, many ν share a vertex and their triangles vanish. What a support map cannot
know is added by eye: how long a roller is, how thick a sharp disc, and the hole of a ring.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import Vector
from ...mechanics.bodies import Body
from ...mechanics.shapes import CylinderShape, Disc, Shape, Torus
from .mesh import Array, Mesh, grid_triangles, joined, oriented

# Intervals of the grid from pole to pole, and round: the equator is a row of it, and each axis a column.
_ROWS, _AROUND = 36, 56
_COVERED = -1e-13  # `validity_margin` at the edge itself, but for rounding
_NEARLY = 1e-3  # rad from the pole
_LENS = 0.02  # half the thickness in the middle of a sharp disc, over its radius
_RING = 0.8  # moment about the axis over m a² from which on a rim is a ring, and a roller a pipe
_HOLE = 0.82  # radius of the hole of a ring or pipe, over the outer one
_LONG, _SHORT = 0.9, 0.3  # half the length of a roller and of a pipe, over the radius


@lru_cache(maxsize=64)
def body_mesh(body: Body) -> Mesh:
    """Return the mesh of a body in its own frame, the centre of mass at the origin.

    Examples
    --------
    >>> mesh = body_mesh(Body.solid_sphere(radius=0.5, mass=1.0))
    >>> np.allclose(np.linalg.norm(mesh.vertices, axis=1), 0.5)
    True
    """
    shape = body.shape
    if isinstance(shape, CylinderShape):
        return _roller(shape, hollow(body))
    if isinstance(shape, Torus) and hollow(body) and shape.rim_radius < shape.radius:
        return _torus(shape)
    if isinstance(shape, Disc):
        return _disc(shape, hollow(body))
    return _convex(shape)


def hollow(body: Body) -> bool:
    """Tell whether a body that rolls on a rim or on its side has its mass out there, as a ring or pipe has.

    Examples
    --------
    >>> hollow(Body.ring(0.1, 1.0)), hollow(Body.disc(0.1, 1.0))
    (True, False)
    """
    shape: Any = body.shape
    moment = float(body.inertia_in_space(_upright()).c.z)
    return moment >= _RING * float(body.mass) * float(shape.radius) ** 2


def _upright() -> Any:
    from ...mechanics.algebra import Matrix

    return Matrix.identity()


def points(shape: Shape, nu: Array) -> Array:
    """Return X(ν), (n, 3), m; NaN where the shape has no single point with that normal."""
    with np.errstate(all="ignore"):
        found = np.broadcast_to(shape.support_map(Vector.of(nu)).array(), nu.shape).copy()
        covered = shape.validity_margin(Vector.of(nu))
    if covered is not None:
        found[~(np.broadcast_to(covered, len(nu)) >= _COVERED)] = np.nan
    return found


def _convex(shape: Shape) -> Mesh:
    """Return a mesh from the support map alone, flat faces where it says nothing."""
    nu = _directions(shape)
    x = points(shape, nu)
    missing = ~np.isfinite(x).all(axis=1)
    if missing.any():
        known = x[~missing]
        x[missing] = known[np.argmax(nu[missing] @ known.T, axis=1)]  # the edge that a plane of that normal rests on
    grid = x.reshape(_ROWS + 1, _AROUND + 1, 3)
    for pole, ring in ((0, 1), (-1, -2)):
        if missing.reshape(_ROWS + 1, _AROUND + 1)[pole].all():
            grid[pole] = grid[ring, :-1].mean(axis=0)  # the middle of a flat face
    x = grid.reshape(-1, 3)
    return Mesh(x, nu, oriented(x, nu, grid_triangles(_ROWS + 1, _AROUND + 1)), nu, _coarse(x, nu))


def _coarse(x: Array, nu: Array) -> NDArray[np.uint32]:
    """Return triangles over every other row and column of the grid."""
    kept = np.arange(len(x)).reshape(_ROWS + 1, _AROUND + 1)[::2, ::2]
    return oriented(x, nu, kept.ravel()[grid_triangles(*kept.shape)].astype(np.uint32))


def _directions(shape: Shape) -> Array:
    """Return the normals ν of a grid, thick where the body is sharply curved.

    They are those of an ellipsoid of the body's widths at the points of an even grid, as in the integrals over a
    body's volume (`trundle.mechanics.bodies.homogeneous`).
    """
    axes = points(shape, np.vstack([np.eye(3), -np.eye(3)]))
    widths = 0.5 * np.diag(axes[:3] - axes[3:])
    widths = np.where(
        np.isfinite(widths) & (widths > 0), widths, np.nanmax(widths) if np.isfinite(widths).any() else 1.0
    )
    down, round_ = _angles()
    u = np.stack([np.sin(down) * np.cos(round_), np.sin(down) * np.sin(round_), np.cos(down)], axis=-1)
    nu = u / widths
    return nu / np.linalg.norm(nu, axis=1, keepdims=True)


def _angles() -> tuple[Array, Array]:
    """Return angle from the pole and longitude of a grid, its seam twice."""
    down, round_ = np.linspace(0.0, np.pi, _ROWS + 1), np.linspace(0.0, 2 * np.pi, _AROUND + 1)
    down[[1, -2]] = _NEARLY, np.pi - _NEARLY  # the edge of a face that lies across the axis, if there is one
    down, round_ = (part.ravel() for part in np.meshgrid(down, round_, indexing="ij"))
    return down, round_


def _circle(count: int = _AROUND) -> Array:
    angle = np.linspace(0.0, 2 * np.pi, count + 1)
    return np.column_stack([np.cos(angle), np.sin(angle), np.zeros(count + 1)])


def _centre(shape: Any) -> Array:
    return np.zeros(3) if shape.centre is None else np.array([float(part) for part in shape.centre])


def swept(rings: list[Array], normals: list[Array]) -> Mesh:
    """Return the mesh of rings of points, each joined to the next."""
    vertices, nu = np.concatenate(rings), np.concatenate(normals)
    return Mesh(vertices, nu, oriented(vertices, nu, grid_triangles(len(rings), len(rings[0]))), nu)


def _torus(shape: Torus) -> Mesh:
    """Return a whole ring: its inner half never touches, and no support map has it."""
    e, round_ = _circle(_AROUND), np.linspace(0.0, 2 * np.pi, _ROWS + 1)
    normals = [e * np.cos(angle) + np.array([0.0, 0.0, np.sin(angle)]) for angle in round_]
    middle = _centre(shape) + float(shape.radius) * e
    return swept([middle + float(shape.rim_radius) * normal for normal in normals], normals)


def _disc(shape: Disc, ring: bool) -> Mesh:
    """Return a disc as a flat lens, sharp at its rim; a ring has its hole."""
    e, up = _circle(_AROUND), np.array([0.0, 0.0, 1.0])
    a, centre = float(shape.radius), _centre(shape)
    inner = _HOLE if ring else 0.0
    faces = []
    for side in (1.0, -1.0):
        shares = (0.96, 0.9, inner) if ring else (0.96, 0.9, 0.6, 0.3, inner)
        rings = [centre + a * (share * e + side * _LENS * _bulge(share, inner) * up) for share in (1.0, *shares)]
        faces.append(swept(rings, [np.broadcast_to(side * up, e.shape)] * len(rings)))
    if ring:
        edges = [centre + a * (inner * e + side * _LENS * up) for side in (1.0, -1.0)]
        faces.append(swept(edges, [-e, -e]))
    return joined(faces)


def _bulge(share: float, inner: float) -> float:
    """Return how thick a lens is at a distance from its middle, both over what they are at most."""
    return float((1.0 - share) / (1.0 - inner))


def _roller(shape: CylinderShape, pipe: bool) -> Mesh:
    """Return a body that touches along a line: its profile across the axis, drawn out along it."""
    e = _circle(_AROUND)
    profile = points(shape, e)
    missing = ~np.isfinite(profile).all(axis=1)
    if missing.any():
        known = profile[~missing]
        profile[missing] = known[np.argmax(e[missing] @ known.T, axis=1)]
        profile[-1] = profile[0]  # between two edges that reach equally far, rounding chose
    length = float(shape.radius) * (_SHORT if pipe else _LONG)
    along = np.array([0.0, 0.0, length])
    axis = np.array([0.0, 0.0, 1.0])
    outer = [profile - along, profile + along]
    parts = [_walls(outer, e, missing)]
    inside = _centre(shape) + _HOLE * (profile - _centre(shape)) if pipe else None
    for side in (1.0, -1.0):
        edge = profile + side * along
        middle = np.broadcast_to(profile[:-1].mean(axis=0), profile.shape) if inside is None else inside
        flat = np.broadcast_to(side * axis, e.shape)
        parts.append(swept([edge, middle + side * along], [flat, flat]))
    if inside is not None:
        parts.append(swept([inside - along, inside + along], [-e, -e]))
    return joined(parts)


def _walls(rings: list[Array], e: Array, missing: Any) -> Mesh:
    """Return the side of a roller; where the round side is missing, the one flat face between its edges."""
    around = swept(rings, [e, e])
    if not missing.any():
        return around
    known = np.flatnonzero(~missing[:-1])
    gap = int(np.argmax(np.diff(np.append(known, known[0] + _AROUND))))
    ends = [known[gap], known[(gap + 1) % len(known)]]
    chord = rings[0][ends]
    across = np.cross(chord[1] - chord[0], [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    flat = swept([ring[ends] for ring in rings], [np.broadcast_to(across, (2, 3))] * 2)
    round_ = around.triangles[~np.isin(around.triangles % (_AROUND + 1), np.flatnonzero(missing)).any(axis=1)]
    a, b, c = (around.vertices[round_[:, i]] for i in range(3))
    chords = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    usual = np.median(chords)
    return joined([Mesh(around.vertices, around.normals, round_[chords < 3 * usual], around.paint), flat])
