"""The support as a mesh in its own frame, so much of it as a run needs, with coordinates that its markings follow."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import Vector
from ...mechanics.surfaces import Plane, Surface
from ..plots.ground import Window, meridians, window_of
from .mesh import Array, Mesh, grid_triangles, joined, oriented

_AROUND, _ALONG = 120, 48  # cells of a surface of revolution round its axis and along its outline
_OF_STRAIGHT = np.array([0.0, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1.0])  # shares of a straight outline
_SIDE = 64  # cells along a side of a field
_FAR = 3.0  # times as far as a run comes, and an edge is not shown
_CLOSER = 8  # looks, each closer, at a surface so steep that few of its points are in the window
_PROJECTIONS = 4  # of Newton's steps that bring a vertex onto the surface


@dataclass(frozen=True)
class Ground:
    """A support's mesh and what a camera should see of it."""

    mesh: Mesh  # in the support's own frame, its normals towards the body
    # "polar": painted by turns round the axis, 0 to 1, and distance along the outline over `size`. "square": by x and y
    # over `size`.
    marks: str
    size: float  # of what is shown, from its middle, m
    centre: tuple[float, float, float]  # its middle, m


def ground_of(surface: Surface, turns: bool, places: Array, radius: float) -> Ground:
    """Return the part of a surface that a run needs, as a mesh."""
    if surface.flat and not turns and surface.rim is None:
        low, high = np.min(places[:, :2], axis=0), np.max(places[:, :2], axis=0)
        pad = max(0.25 * float(np.max(high - low)), 4 * radius)
        return _sheet(*(_outwards(float(part), pad) for part in (-low[0], -low[1], high[0], high[1])))
    window = window_of(surface, places, radius)
    room = float(np.max(window.high - window.low))
    numbers = tuple(_outwards(float(part), 0.0, room) for part in (*-window.low, *window.high))
    edge = math.inf if surface.rim is None else float(surface.rim)
    reach = edge if window.reach >= edge else _outwards(window.reach)
    first = _on_first_branch(surface, places)
    try:
        return _ground(surface, numbers, reach, first)
    except TypeError:  # a surface of somebody's own that cannot be hashed
        return _ground.__wrapped__(surface, numbers, reach, first)


def _outwards(value: float, pad: float = 0.0, size: float | None = None) -> float:
    """Return a length with some more added, rounded up so that runs that are nearly alike share a mesh."""
    grown = value + pad
    step = 0.02 * max(abs(value) if size is None else size, pad)
    if step == 0:
        return grown
    step = 10.0 ** math.ceil(math.log10(step))
    return math.ceil(grown / step) * step if step < 0.5 * max(abs(grown), size or 0.0) else grown


def _on_first_branch(surface: Surface, places: Array) -> bool:
    """Tell whether the surface's own coordinates reach all these places: those of a sphere reach one half of it."""
    if tuple(surface.coordinates) != ("length", "length"):
        return True
    some = places[:: max(1, len(places) // 500)]
    with np.errstate(all="ignore"):
        back = np.broadcast_to(surface.point(some[:, 0], some[:, 1]).z, len(some))
    extent = float(np.max(np.ptp(places, axis=0))) + 1e-300
    return bool(np.all(np.abs(back - some[:, 2]) <= 1e-3 * extent))


@lru_cache(maxsize=64)
def _ground(surface: Surface, numbers: tuple[float, ...], reach: float, first: bool) -> Ground:
    window = Window(-np.array(numbers[:3]), np.array(numbers[3:]), reach)
    if surface.axisymmetric:
        return _of_revolution(surface, window, first)
    return _field(surface, window)


def _of_revolution(surface: Surface, window: Window, first: bool) -> Ground:
    lines = [line for line in _outlines(surface, window, first) if len(line) > 1]
    size = max(float(np.max(line[:, 0])) for line in lines)
    turns = np.linspace(0.0, 1.0, _AROUND + 1)
    turned = np.stack([np.cos(2 * np.pi * turns), np.sin(2 * np.pi * turns)], axis=-1)
    meshes = []
    for line in lines:
        flat = np.zeros((len(line), 3))
        flat[:, [0, 2]] = line
        flat = _onto(surface, flat)
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(flat, axis=0), axis=1))])
        if line[0, 0] > 1e-9 * size:  # no axis to count from: a wall is marked by its height
            along = line[:, 1]
        normal = _normals(surface, flat)
        if len(line) > 2 and not math.isclose(abs(float(normal[0] @ normal[1])), 1.0, abs_tol=0.2):
            normal[0] = normal[1]  # the apex of a cone
        vertices, normals = (_spun(part, turned) for part in (flat, normal))
        paint = np.stack(np.broadcast_arrays(turns[None, :], along[:, None] / size), axis=-1).reshape(-1, 2)
        meshes.append(
            Mesh(vertices, normals, oriented(vertices, normals, grid_triangles(len(line), _AROUND + 1)), paint)
        )
    mesh = joined(meshes)
    return Ground(mesh, "polar", *_box(mesh.vertices))


def _spun(line: Array, turned: Array) -> Array:
    """Return vectors of the half plane of the first axis turned about the third, row by row."""
    x, y = line[:, :1] * turned[:, 0], line[:, :1] * turned[:, 1]
    return np.stack(np.broadcast_arrays(x, y, line[:, 2:]), axis=-1).reshape(-1, 3)


def _outlines(surface: Surface, window: Window, first: bool) -> list[Array]:
    """Return the outline of a surface of revolution, distance from the axis and height, by its own coordinates."""
    kinds = tuple(surface.coordinates)
    if kinds == ("length", "length") and first:
        # Thicker at the end, where a bowl stands steep.
        r = window.reach * np.sin(np.linspace(0.0, 0.5 * np.pi, 4 * _ALONG + 1))
        z, seen = _seen(surface, window, r)
        for _ in range(_CLOSER):  # of what is very steep few points are in the window
            if not 0 < np.count_nonzero(seen) < _ALONG:
                break
            places = np.flatnonzero(seen)
            r = np.linspace(r[max(places[0] - 1, 0)], r[min(places[-1] + 1, r.size - 1)], r.size)
            z, seen = _seen(surface, window, r)
        return [_thinned(np.column_stack([r, z])[seen])]
    if kinds == ("angle", "length"):
        v = np.linspace(window.low[2], window.high[2], 2 * _ALONG)
    elif kinds == ("angle", "angle"):
        v = np.linspace(0.0, 2 * np.pi, 4 * _ALONG + 1)
    else:  # a whole sphere, of which the coordinates reach one half
        return [_thinned(line) for line in meridians(surface, window)]
    p = surface.point(np.zeros_like(v), v)
    return [_thinned(np.column_stack([np.broadcast_to(part, v.shape) for part in (p.x, p.z)]))]


def _seen(surface: Surface, window: Window, r: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the heights at distances from the axis, and which of them are in the window."""
    with np.errstate(all="ignore"):
        z = np.broadcast_to(surface.point(r, np.zeros_like(r)).z, r.shape)
    return z, np.isfinite(z) & (z >= window.low[2]) & (z <= window.high[2])


def _thinned(line: Array) -> Array:
    """Return points of a line, even along it; a few of a straight one, so that turns are true near the axis."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    if len(line) < 2 or along[-1] == 0:
        return line
    straight = along[-1] - np.hypot(*(line[-1] - line[0])) <= 1e-9 * along[-1]
    at = along[-1] * (_OF_STRAIGHT if straight else np.linspace(0.0, 1.0, _ALONG + 1))
    return np.column_stack([np.interp(at, along, line[:, i]) for i in (0, 1)])


def _onto(surface: Surface, vertices: Array) -> Array:
    """Return vertices brought onto the surface along its normal; those at the axis or an apex stay."""
    p = vertices
    for _ in range(_PROJECTIONS):
        with np.errstate(all="ignore"):
            step = surface.step_onto(Vector.of(p)).array()
        p = np.where(np.isfinite(step), p + step, p)
    return p


def _normals(surface: Surface, vertices: Array) -> Array:
    with np.errstate(all="ignore"):
        normal = np.broadcast_to(surface.normal(Vector.of(vertices)).array(), vertices.shape).copy()
    normal[~np.isfinite(normal).all(axis=1)] = (0.0, 0.0, 1.0)  # an apex
    return normal


def _box(vertices: Array) -> tuple[float, tuple[float, float, float]]:
    """Return half the largest extent of a mesh, and its middle, m."""
    low, high = np.min(vertices, axis=0), np.max(vertices, axis=0)
    x, y, z = ((low + high) / 2).tolist()
    return 0.5 * float(np.max(high - low)), (x, y, z)


def _field(surface: Surface, window: Window) -> Ground:
    """Return a surface over the plane that is not one of revolution."""
    if getattr(surface, "grid", None) is None:
        reach = float(np.max(np.hypot(*np.array([window.low[:2], window.high[:2]]).T)))
        edge = _edge(surface, _FAR * reach)
        if np.max(edge) < _FAR * reach:  # it ends all round, not far away: all of it is shown
            return _star(surface, edge)
        if np.min(edge) < reach:
            return _star(surface, np.minimum(edge, reach))
    x, y = (np.linspace(window.low[i], window.high[i], _SIDE + 1) for i in (0, 1))
    return _over(surface, *np.meshgrid(x, y))


def _edge(surface: Surface, reach: float) -> Array:
    """Return how far from the axis a surface goes in each direction, found by halving, m; at most `reach`."""
    angle = np.linspace(0.0, 2 * np.pi, _AROUND + 1)
    low, high = np.zeros_like(angle), np.full_like(angle, reach)
    low = np.where(_exists(surface, reach * np.cos(angle), reach * np.sin(angle)), reach, low)
    for _ in range(50):
        middle = 0.5 * (low + high)
        there = _exists(surface, middle * np.cos(angle), middle * np.sin(angle))
        low, high = np.where(there, middle, low), np.where(there, high, middle)
    return low


def _star(surface: Surface, edge: Array) -> Ground:
    """Return a mesh about the axis up to a distance from it in each direction."""
    angle = np.linspace(0.0, 2 * np.pi, _AROUND + 1)
    share = np.sin(np.linspace(0.0, 0.5 * np.pi, _ALONG + 1))[:, None]
    return _over(surface, share * edge * np.cos(angle), share * edge * np.sin(angle))


def _exists(surface: Surface, x: Array, y: Array) -> Array:
    with np.errstate(all="ignore"):
        p = surface.point(x, y)
        z = np.broadcast_to(np.asarray(p.z, dtype=float), x.shape)
        inside = surface.domain_margin(Vector(x, y, np.where(np.isfinite(z), z, 0.0)))
    there = np.isfinite(z)
    if inside is not None:
        there &= np.broadcast_to(inside, x.shape) >= 0
    return there if surface.rim is None else there & (np.hypot(x, y) <= float(surface.rim))


def _over(surface: Surface, x: Array, y: Array) -> Ground:
    """Return the mesh of a surface at the places of a grid over the plane."""
    with np.errstate(all="ignore"):
        z = np.broadcast_to(np.asarray(surface.point(x, y).z, dtype=float), x.shape)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    good = np.isfinite(vertices).all(axis=1)
    vertices = np.where(good[:, None], vertices, 0.0)
    normals = _normals(surface, vertices)
    triangles = grid_triangles(*x.shape)
    triangles = triangles[good[triangles].all(axis=1)]
    size, centre = _box(vertices[good])
    mesh = Mesh(vertices, normals, oriented(vertices, normals, triangles), vertices[:, :2] / size)
    return Ground(mesh, "square", size, centre)


@lru_cache(maxsize=64)
def _sheet(left: float, front: float, right: float, back: float) -> Ground:
    """Return a rectangle of a plane, given by how far it goes down each axis and up it."""
    x, y = np.meshgrid(np.linspace(-left, right, 2), np.linspace(-front, back, 2))
    return _over(Plane(), x, y)
