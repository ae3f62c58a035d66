"""What is behind the ball: the still picture of the film, and the table's own picture, turned with it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from .calibration import Turning
from .container import Film, Frame, Picture
from .pinhole import Array, PinholeCamera

_MOST = 25  # pictures of which a median is taken
_FEWEST = 5
_MEMORY = 2**28  # bytes that they may fill
_WIDEST = 1500  # px from the middle of the table's own picture
_STRIP = 64  # rows of which a median is taken at once


def sample(film: Film) -> tuple[list[Frame], Array]:
    """Return pictures spread evenly over a film, and the times of all its frames; the film is read once.

    Raises
    ------
    InvalidValueError
        If it has too few pictures.
    """
    kept: list[Frame] = []
    times: list[float] = []
    stride, most = 1, _MOST
    for count, frame in enumerate(film.frames()):
        times.append(frame.time)
        most = max(_FEWEST, min(_MOST, _MEMORY // frame.picture.nbytes // 2))
        if count % stride == 0:
            kept.append(frame)
        if len(kept) > 2 * most:
            kept, stride = kept[::2], 2 * stride
    if len(times) < 2 * _FEWEST:
        remedy = "Film for some seconds; look at what `begin` and `end` leave."
        raise InvalidValueError("film", f"must have {2 * _FEWEST} pictures at least", f"{len(times)}", remedy)
    return kept[:: -(-len(kept) // most)], np.array(times)


def median(pictures: Iterable[Picture]) -> Picture:
    """Return the median of pictures, pixel by pixel, a strip at a time."""
    stack = list(pictures)
    found = np.empty_like(stack[0])
    for top in range(0, len(found), _STRIP):
        strip = np.stack([picture[top : top + _STRIP] for picture in stack])
        found[top : top + _STRIP] = np.sort(strip, axis=0)[len(stack) // 2]
    return found


@dataclass(frozen=True)
class Ground:
    """The picture without the ball at any time: still, but for the table where a mark shows how that turns."""

    still: Picture  # the median of the film
    camera: PinholeCamera  # with its origin on the axis
    turning: Turning | None  # of the table
    radius: float  # of the part of the picture that turns, m
    # (float, array): true times and pictures, of which the table's own picture is made
    samples: tuple[tuple[float, Picture], ...]

    @cached_property
    def _places(self) -> tuple[Any, Any, Any, float, int]:
        """Return which pixels show the table, where on it they are, and the scale and half the width of its picture."""
        height, width = self.still.shape[:2]
        pixels = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1).reshape(-1, 2).astype(float)
        there = self.camera.on_plane(pixels).reshape(height, width, 2)
        on_it = np.linalg.norm(there, axis=2) < self.radius
        top = self.camera.project(np.array([[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0]]))
        fine = 1e3 * max(np.linalg.norm(top[1] - top[0]), np.linalg.norm(top[2] - top[0]))
        half = int(min(np.ceil(1.2 * fine * self.radius), _WIDEST)) + 1
        scale = half / self.radius
        x, y = (np.where(on_it, there[:, :, i] * scale, 0.0).astype(np.float32) for i in (0, 1))
        return on_it.astype(np.uint8), x, y, scale, half

    @cached_property
    def _table(self) -> Picture:
        """Return the table's own picture, as it was at the angle 0: the median of pictures turned back."""
        import cv2

        *_, scale, half = self._places
        angles = [self.turning.angle(time) if self.turning else 0.0 for time, _ in self.samples]
        across = np.arange(-half, half + 1) / scale
        here = across[None, :] + 1j * across[:, None]
        turned_back = []
        for angle, (_, picture) in zip(angles, self.samples, strict=True):
            place = here * np.exp(1j * angle)
            flat = np.column_stack([place.real.ravel(), place.imag.ravel(), np.zeros(place.size)])
            seen = self.camera.project(flat).astype(np.float32).reshape(*place.shape, 2)
            turned_back.append(
                cv2.remap(picture, seen[:, :, 0], seen[:, :, 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
            )
        return median(turned_back)

    def at(self, time: float) -> Picture:
        """Return the picture without the ball at a time."""
        import cv2

        if self.turning is None:
            return self.still
        on_it, x, y, _, half = self._places
        angle = self.turning.angle(time)
        c, s = np.float32(np.cos(angle)), np.float32(np.sin(angle))
        there = (c * x + s * y + np.float32(half), c * y - s * x + np.float32(half))
        shown = cv2.remap(self._table, *there, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(cv2.copyTo(shown, on_it, self.still.copy()))
