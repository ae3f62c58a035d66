"""A bowl made of triangles, and how a ball rolls in it that is exact but for the triangles.

The triangles are the faces of a convex polyhedron, so that seen from inside every edge is a valley. On a triangle the
ball rolls as on a slope. At an edge it meets the next triangle while it still lies on the last, and what it was about
to do into the new one is lost: friction holds it there, and it rolls on with the angular momentum about the new point
of contact that it had (as a pencil of six sides does). Each edge of angle δ takes about δ²/(1 + k) of the energy, and
there are as many edges as 1/δ, so that all of it is of the order of the length of an edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from .case import Array, Motion, Task

_UP_TO = math.radians(75.0)  # from the lowest point: higher triangles are left out
_SAME = 1e-13  # s: an edge that the ball is just leaving
_GOLDEN = math.pi * (1.0 + math.sqrt(5.0))
_FINE = 1e-13  # of the turning on one triangle


@dataclass(frozen=True)
class Triangles:
    """Triangles on a sphere about the origin, all of them in planes at about its radius.

    Parameters
    ----------
    vertices : array of shape (vertices, 3)
        m.
    corners : array of shape (triangles, 3)
        Three vertices each, anticlockwise seen from inside.
    normals : array of shape (triangles, 3)
        Unit vectors, inwards.
    distances : array of shape (triangles,)
        Of the planes from the origin, m.
    """

    vertices: Array
    corners: NDArray[np.integer]
    normals: Array
    distances: Array

    @classmethod
    def bowl(cls, points: int, radius: float, towards: Array) -> Triangles:
        """Lay triangles round the lower part of a sphere; the one in the direction `towards` touches it.

        Their corners are points at even steps of a golden spiral, their edges those of the convex hull.

        Parameters
        ----------
        points : int
            On the whole sphere.
        radius : float
            Of the sphere, m.
        towards : array of shape (3,)
            A unit vector.

        Examples
        --------
        >>> mesh = Triangles.bowl(500, 0.5, np.array([0.6, 0.0, -0.8]))
        >>> mesh.corners.shape, round(float(mesh.distances[np.argmin(mesh.normals @ [0.6, 0.0, -0.8])]), 12)
        ((400, 3), 0.5)
        """
        from scipy.spatial import ConvexHull

        steps = np.arange(points) + 0.5
        height = 1.0 - 2.0 * steps / points
        width, angle = np.sqrt(1.0 - height**2), _GOLDEN * steps
        sphere = np.stack([width * np.cos(angle), width * np.sin(angle), height], axis=-1)
        hull = ConvexHull(sphere)
        outwards, distances = hull.equations[:, :3], -hull.equations[:, 3]
        first = int(np.argmax(outwards @ towards))
        turn, scale = _turn(outwards[first], towards), radius / distances[first]
        vertices, normals = scale * sphere @ turn.T, -outwards @ turn.T
        kept = (vertices[hull.simplices][:, :, 2] < -math.cos(_UP_TO) * radius).any(1)
        used, corners = np.unique(hull.simplices[kept], return_inverse=True)
        vertices, corners, normals = vertices[used], corners.reshape(-1, 3), normals[kept]
        a, b, c = (vertices[corners[:, i]] for i in range(3))
        clockwise = (np.cross(b - a, c - a) * normals).sum(-1) < 0
        corners[clockwise] = corners[clockwise][:, ::-1]
        return cls(vertices, corners, normals, scale * distances[kept])

    def nearest(self, points: Array) -> tuple[Array, Array]:
        """Return the normal of the triangle that each point inside is nearest to, and its distance from that."""
        gaps = self.distances + points @ self.normals.T
        nearest = gaps.argmin(-1)
        return self.normals[nearest], np.take_along_axis(gaps, nearest[..., None], -1)[..., 0]


def _turn(a: Array, b: Array) -> Array:
    """Return the rotation that takes the unit vector a to b, the shortest way."""
    v = np.cross(a, b)
    K = np.cross(v, np.eye(3)).T
    turn: Array = np.eye(3) + K + K @ K / (1.0 + a @ b)
    return turn


@dataclass
class _Stretch:
    """The ball on one triangle: where it begins, with which rates, and what it gains."""

    time: float
    normal: Array
    position: Array
    velocity: Array
    gain: Array
    spin: float  # about the normal

    def at(self, t: float) -> tuple[Array, Array]:
        """Return position and velocity."""
        s = t - self.time
        return self.position + s * self.velocity + 0.5 * s * s * self.gain, self.velocity + s * self.gain

    def turning(self, velocity: Array, radius: float) -> Array:
        """Return the angular velocity of a ball that rolls here."""
        turning: Array = np.cross(self.normal, velocity) / radius + self.spin * self.normal
        return turning


def stretches(mesh: Triangles, situation: Task, duration: float) -> list[_Stretch]:
    """Follow a ball that rolls from triangle to triangle; positions are from the middle of the sphere.

    Raises
    ------
    ArithmeticError
        Where friction would have to be larger than it is: then this is not the motion.
    """
    body = situation["bodies"][0]
    radius, mass = body["shape"]["radius"], body["mass"]
    k = body["inertia"][0][0] / (mass * radius * radius)
    gravity, room = np.array(situation["gravity"]), mesh.distances - radius
    position = np.array(body["position"]) - [0.0, 0.0, situation["support"]["radius"]]
    velocity, turning = (np.array(body[part]) for part in ("velocity", "angular_velocity"))
    now, there = 0.0, int((room + mesh.normals @ position).argmin())
    found: list[_Stretch] = []
    while True:
        n = mesh.normals[there]
        gain = (gravity - (gravity @ n) * n) / (1.0 + k)
        stretch = _Stretch(now, n, position, velocity, gain, float(turning @ n))
        found.append(stretch)
        gaps = room + mesh.normals @ position
        gaps[there] = math.inf
        waits = _touch(gaps, mesh.normals @ velocity, mesh.normals @ gain)
        there = int(waits.argmin())
        if now + waits[there] >= duration:
            return found
        now += float(waits[there])
        position, velocity = stretch.at(now)
        turning = stretch.turning(velocity, radius)
        n = mesh.normals[there]
        momentum = radius * np.cross(n, velocity) + k * radius**2 * turning  # about the new contact, over the mass
        rolling = np.cross(momentum, n) / (radius * (1.0 + k))
        blow = rolling - velocity
        across = np.linalg.norm(blow - (blow @ n) * n)
        if across > situation["friction"] * (blow @ n):
            raise ArithmeticError(f"the ball slips at an edge: that takes a friction of {across / (blow @ n):.3g}")
        velocity = rolling
        turning = np.cross(n, rolling) / radius + (momentum @ n) / (k * radius**2) * n


def _touch(gaps: Array, rates: Array, gains: Array) -> Array:
    """Return when each gap + rate t + gain t²/2 falls to zero for the first time; infinite where it never does."""
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(rates**2 - 2.0 * gains * gaps)
        # Of both solutions, each in the form that loses nothing, the one at which the gap is falling.
        times = np.where(rates < 0.0, 2.0 * gaps / (root - rates), -(root + rates) / gains)
    return np.where(np.isfinite(times) & (times > _SAME), times, math.inf)


def rolled(mesh: Triangles, situation: Task, times: Array) -> Motion:
    """Return the motion of an exact ball on the triangles, at these times."""
    from scipy.integrate import solve_ivp

    radius, middle = situation["bodies"][0]["shape"]["radius"], np.array([0.0, 0.0, situation["support"]["radius"]])
    found = stretches(mesh, situation, times[-1])
    begins = np.array([each.time for each in found] + [math.inf])
    orientation = np.array(situation["bodies"][0]["orientation"], dtype=float)
    rows: dict[str, list[Array]] = {each.name: [] for each in fields(Motion) if each.name not in ("time", "support")}
    for i, each in enumerate(found):
        until = min(begins[i + 1], times[-1])
        inside = times[(times >= each.time) & ((times < until) | (begins[i + 1] > times[-1]))]
        seen = np.unique(np.append(inside, until))

        def rate(t: float, q: Array, each: _Stretch = each) -> Array:
            (x, y, z), w = 0.5 * each.turning(each.at(t)[1], radius), q
            a, b, c, d = w
            return np.array(
                [-x * b - y * c - z * d, x * a + y * d - z * c, y * a + z * b - x * d, z * a + x * c - y * b]
            )

        turned = solve_ivp(rate, (each.time, until), orientation, "DOP853", seen, rtol=_FINE, atol=_FINE)
        orientation = turned.y[:, -1] / np.linalg.norm(turned.y[:, -1])
        for t, q in zip(inside, turned.y.T, strict=False):
            position, velocity = each.at(t)
            rows["position"].append(position + middle)
            rows["velocity"].append(velocity)
            rows["angular_velocity"].append(each.turning(velocity, radius))
            rows["orientation"].append(q / np.linalg.norm(q))
    return Motion(times, **{name: np.array(row)[:, None, :] for name, row in rows.items()})
