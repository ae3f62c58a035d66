"""A studio: films of a ball on a turntable, drawn from a known motion as a known camera would see it.

OpenCV projects (`cv2.projectPoints`): nothing of the calibration under test draws what it is tested on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

FINER = 3  # times the pixels in each direction, for smooth edges
SHIFT = 4  # bits behind the point of OpenCV's coordinates
Path2D = Callable[[Any], Any]  # times (n,) -> places (n, 2), m


@dataclass(frozen=True)
class Studio:
    """What stands before the camera, and the camera."""

    width: int = 320
    height: int = 240
    focal: float = 380.0  # px
    lens: tuple[float, float, float] = (0.02, -0.30, 0.40)  # its place, m
    aim: tuple[float, float, float] = (0.0, 0.0, 0.0)
    distortion: float = 0.0
    rim: float = 0.14
    ball: float = 0.02
    mark: float | None = 0.115  # its distance from the axis, m
    mark_size: float = 0.008
    ball_colour: tuple[int, int, int] = (20, 25, 120)
    mark_colour: tuple[int, int, int] = (15, 80, 10)
    rate: float = 3.4907  # rad/s
    shutter: float = 0.008  # s
    exposures: int = 2
    noise: float = 4.0
    spokes: int = 0  # a pattern on the table, that turns

    def pinhole(self) -> tuple[Any, Any, Any, Any]:
        """Return the camera as OpenCV has it: matrix, distortion, rotation vector, translation."""
        import cv2

        place, aim = np.array(self.lens), np.array(self.aim)
        ahead = (aim - place) / np.linalg.norm(aim - place)
        right = np.cross(ahead, [0.0, 1.0, 0.0])
        right /= np.linalg.norm(right)
        turn = np.stack([right, np.cross(ahead, right), ahead])
        matrix = np.array([[self.focal, 0, (self.width - 1) / 2], [0, self.focal, (self.height - 1) / 2], [0, 0, 1]])
        return matrix, np.array([self.distortion, 0, 0, 0]), cv2.Rodrigues(turn)[0], -turn @ place

    def seen(self, points: Any) -> Any:
        """Return where points (n, 3) are seen, px."""
        import cv2

        matrix, lens, turn, shift = self.pinhole()
        return cv2.projectPoints(np.asarray(points, dtype=float), turn, shift, matrix, lens)[0][:, 0]

    def _fill(self, picture: Any, points: Any, colour: Sequence[int]) -> None:
        import cv2

        fine = (self.seen(points) + 0.5) * FINER - 0.5
        outward = fine - fine.mean(axis=0)
        fine -= 0.5 * outward / np.linalg.norm(outward, axis=1, keepdims=True)  # OpenCV fills its outline, too
        cv2.fillPoly(picture, [np.round(fine * 2**SHIFT).astype(np.int32)], colour, shift=SHIFT)

    def _disc(self, x: float, y: float, radius: float) -> Any:
        ring = 2 * np.pi * np.arange(360) / 360
        return np.column_stack([x + radius * np.cos(ring), y + radius * np.sin(ring), np.zeros(360)])

    def outline(self, x: float, y: float) -> Any:
        """Return the circle along which the rays of the lens touch the ball."""
        centre, lens = np.array([x, y, self.ball]), np.array(self.lens)
        away = lens - centre
        far = np.linalg.norm(away)
        away /= far
        one = np.cross(away, [1.0, 0.0, 0.0])
        one /= np.linalg.norm(one)
        other = np.cross(away, one)
        ring = 2 * np.pi * np.arange(120)[:, None] / 120
        middle = centre + away * self.ball**2 / far
        wide = self.ball * np.sqrt(1 - (self.ball / far) ** 2)
        return middle + wide * (np.cos(ring) * one + np.sin(ring) * other)

    def _table(self) -> Any:
        picture = np.full((self.height * FINER, self.width * FINER, 3), 52, np.uint8)
        self._fill(picture, self._disc(0, 0, self.rim), (190, 185, 180))
        return picture

    def pictures(self, path: Path2D, times: Any, after: Callable[[int, Any], Any] | None = None) -> Iterator[Any]:
        """Yield a picture for each time; `after` may put a hand into it."""
        import cv2

        table, draw = self._table(), np.random.default_rng(11)
        for i, time in enumerate(times):
            total = np.zeros((self.height, self.width, 3))
            for part in range(self.exposures):
                now = time + self.shutter * ((part + 0.5) / self.exposures - 0.5)
                fine = table.copy()
                for spoke in range(self.spokes):
                    angle = self.rate * now + 2 * np.pi * spoke / self.spokes
                    self._fill(fine, self._disc(0.07 * np.cos(angle), 0.07 * np.sin(angle), 0.018), (90, 95, 160))
                if self.mark is not None:
                    angle = self.rate * now
                    at = self.mark * np.cos(angle), self.mark * np.sin(angle)
                    self._fill(fine, self._disc(*at, self.mark_size), self.mark_colour)
                x, y = np.atleast_2d(path(np.array([now])))[0]
                self._fill(fine, self.outline(float(x), float(y)), self.ball_colour)
                total += cv2.resize(fine, (self.width, self.height), interpolation=cv2.INTER_AREA)
            picture = total / self.exposures
            if after is not None:
                picture = after(i, picture)
            yield np.clip(picture + draw.normal(0, self.noise, picture.shape), 0, 255).astype(np.uint8)


def write(target: Path, pictures: Iterator[Any], rate: float = 30.0, code: str = "mp4v") -> Path:
    """Write a film with OpenCV's own writer."""
    import cv2

    writer = None
    for picture in pictures:
        if writer is None:
            writer = cv2.VideoWriter(str(target), cv2.VideoWriter_fourcc(*code), rate, picture.shape[1::-1])
        writer.write(picture)
    assert writer is not None
    writer.release()
    return target
