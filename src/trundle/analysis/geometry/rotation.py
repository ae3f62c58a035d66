"""One rotation, as an axis and an angle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ...display import Displayed, Headline, Markup, number, pairs


@dataclass(frozen=True)
class Rotation(Displayed):
    """A rotation about an axis.

    Parameters
    ----------
    axis : tuple of 3 floats
        Unit vector, support frame; the normal where there is no rotation.
    angle : float
        0 to π, right-handed about the axis, rad.
    about_normal : float
        The part of it about the normal of the plane, −π to π, rad: the whole, where the axis is the normal.

    Examples
    --------
    >>> Rotation.of((0.5**0.5, 0.0, 0.0, -(0.5**0.5))).axis
    (0.0, 0.0, -1.0)
    """

    axis: tuple[float, float, float]
    angle: float
    about_normal: float

    @staticmethod
    def of(quaternion: Any) -> Rotation:
        """Return the rotation of a unit quaternion (w, x, y, z).

        Parameters
        ----------
        quaternion : sequence of 4 floats
            q and −q are the same rotation.

        Returns
        -------
        Rotation
            By at most half a turn.

        Examples
        --------
        >>> Rotation.of((-1.0, 0.0, 0.0, 0.0)).angle
        0.0
        """
        w, x, y, z = (float(part) for part in quaternion)
        if w < 0:
            w, x, y, z = -w, -x, -y, -z
        sine = math.hypot(x, y, z)
        axis = (x / sine + 0.0, y / sine + 0.0, z / sine + 0.0) if sine else (0.0, 0.0, 1.0)
        return Rotation(axis, 2 * math.atan2(sine, w), 2 * math.atan2(z, w) if w or z else 0.0)

    def _headline(self) -> Headline:
        return Headline("", str(self))

    def _parts(self) -> Iterator[Markup]:
        yield pairs([("angle", number(self.angle, unit="rad")), ("about n", number(self.about_normal, unit="rad"))])

    def __str__(self) -> str:
        x, y, z = (float(f"{part:.6f}") + 0.0 for part in self.axis)
        return f"{math.degrees(self.angle):.6g} deg about ({x:g}, {y:g}, {z:g})"
