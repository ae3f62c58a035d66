"""The camera that filmed: where a point of the world is seen, and which point of a plane a pixel shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_DOWN = np.diag([1.0, -1.0, -1.0])  # a camera that looks straight down: x to the right of the picture, y upwards in it
_ROUNDS = 8  # of fixed points that gain two digits each


@dataclass(frozen=True)
class PinholeCamera:
    """A pinhole with a lens that bends straight lines a little.

    Examples
    --------
    >>> above = PinholeCamera(1000.0, (320.0, 240.0), np.zeros(3), np.array([0.0, 0.0, 2.0]))
    >>> above.project(np.array([[0.1, 0.2, 0.0]])).tolist()
    [[370.0, 140.0]]
    >>> above.on_plane(np.array([[370.0, 140.0]])).round(12).tolist()
    [[0.1, 0.2]]
    """

    focal: float  # focal length, px
    centre: tuple[float, float]  # where the optical axis meets the picture, px
    turn: Array  # (3,): rotation vector, rad, by which the camera is turned from looking straight down
    place: Array  # (3,): of the lens, m: the table is the plane z = 0, its axis the z axis
    distortion: float = 0.0  # κ: a direction (u, v) is seen at (u, v) (1 + κ (u² + v²))

    @property
    def rotation(self) -> Array:
        """The matrix from the axes of the world to those of the camera (right, down, ahead)."""
        angle = float(np.linalg.norm(self.turn))
        if angle < 1e-12:
            return _DOWN
        x, y, z = self.turn / angle
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        return np.asarray(_DOWN @ (np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross))

    def project(self, points: Array) -> Array:
        """Return where points (n, 3) are seen, px (n, 2)."""
        seen = (np.atleast_2d(points) - self.place) @ self.rotation.T
        flat = seen[:, :2] / seen[:, 2:]
        bent = flat * (1 + self.distortion * (flat**2).sum(axis=1, keepdims=True))
        return np.asarray(self.focal * bent + self.centre)

    def directions(self, pixels: Array) -> Array:
        """Return the directions (u, v) that pixels (n, 2) show, the lens undone."""
        bent = (np.atleast_2d(pixels) - self.centre) / self.focal
        flat = bent
        if self.distortion:
            for _ in range(_ROUNDS):
                flat = bent / (1 + self.distortion * (flat**2).sum(axis=1, keepdims=True))
        return np.asarray(flat)

    def _meets(self, flat: Array, z: float) -> tuple[Array, Array]:
        """Return where directions meet the plane at a height, (n, 2), and how far from the lens, (n,)."""
        ahead = np.column_stack([flat, np.ones(len(flat))]) @ self.rotation
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = (z - self.place[2]) / ahead[:, 2]
        reach = np.where(reach > 0, reach, np.nan)  # the plane is behind: no place
        return self.place[:2] + reach[:, None] * ahead[:, :2], reach * np.linalg.norm(ahead, axis=1)

    def on_plane(self, pixels: Array, z: float = 0.0) -> Array:
        """Return the points (n, 2) of a horizontal plane that pixels show, m; NaN above the horizon."""
        return self._meets(self.directions(pixels), z)[0]

    def ball_centres(self, pixels: Array, radius: float) -> Array:
        """Return where balls on the table have their centres, (n, 2), from the centroids of their pictures.

        The picture of a ball is an ellipse, and its middle is not where the centre is seen: with T the tangent of the
        angle from the optical axis and s the sine of half the angle under which the ball is seen, it is at
        T/(1 − s²(1 + T²)).
        """
        flat = self.directions(pixels)
        outward = np.linalg.norm(flat, axis=1, keepdims=True)
        centre = flat
        for _ in range(_ROUNDS):
            far = self._meets(centre, radius)[1][:, None]
            tangent = np.linalg.norm(centre, axis=1, keepdims=True)
            centre = flat * (1 - (radius / far) ** 2 * (1 + tangent**2))
        return self._meets(np.where(outward > 0, centre, flat), radius)[0]

    def ball_outlines(self, places: Array, radius: float, count: int) -> Array:
        """Return where the outlines of balls with centres over (n, 2) are seen, px (n, count, 2).

        The rays that touch a ball do so on a circle: a² / d from its centre towards the lens, √(a² − a⁴/d²) wide.
        """
        centre = np.column_stack([places, np.full(len(places), radius)])
        towards = self.place - centre
        far = np.linalg.norm(towards, axis=1, keepdims=True)
        towards /= far
        across = np.cross(towards, self.rotation[1])
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        other = np.cross(towards, across)
        ring = 2 * np.pi * np.arange(count)[:, None, None] / count
        wide = radius * np.sqrt(1 - (radius / far) ** 2)
        points = centre + towards * radius**2 / far + wide * (np.cos(ring) * across + np.sin(ring) * other)
        return self.project(points.reshape(-1, 3)).reshape(count, -1, 2).swapaxes(0, 1)

    def ball_area(self, places: Array, radius: float) -> Array:
        """Return how many pixels the pictures of balls with centres over (n, 2) fill."""
        seen = (np.column_stack([places, np.full(len(places), radius)]) - self.place) @ self.rotation.T
        far = np.linalg.norm(seen, axis=1)
        along = seen[:, 2] / far  # the cosine of the angle from the optical axis
        s = radius / far
        # A cone about θ with the sine s of half its angle cuts the plane at 1 in an ellipse with these half axes.
        inner = along**2 - s**2
        return np.asarray(np.pi * self.focal**2 * (s * np.sqrt(1 - s**2) / inner) * (s / np.sqrt(inner)))
