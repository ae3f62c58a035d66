"""The ball at some places of its path."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...display import Displayed, Headline, Markup, table
from ...mechanics.algebra import E_Z, Quaternion

Array = NDArray[np.float64]
MOST_TOLD = 24  # of many places, the first and the last


@dataclass(frozen=True, repr=False)
class Stages(Displayed):
    """The ball at some places of its path."""

    distance: Array  # (n,): along the path, m
    contact: Array  # (n, 2): contact point on the plane, m
    heading: Array  # (n,): direction of travel, from the first axis towards the second, rad
    orientation: Array  # (n, 4): unit quaternion (w, x, y, z), body frame to support frame
    radius: float  # of the ball, m

    @property
    def position(self) -> Array:
        """The centre of the ball, (n, 3), m."""
        return np.column_stack([self.contact, np.full(len(self.contact), self.radius)])

    @property
    def north_pole(self) -> Array:
        """The direction from the centre to the north pole, where the body's third axis comes out: (n, 3)."""
        return (Quaternion.of(self.orientation).matrix() @ E_Z).array()

    def told(self) -> list[tuple[str, str, str]]:
        """Say where the ball is at each place, and where its north pole points.

        Returns
        -------
        list of (name, place, pole)
            Of many places those in the middle are left out.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.roll_along(tr.Straight(turn="90 deg"), radius="2 cm").stages.told()[0]
        ('start', '(0, 0) cm', 'up')
        """
        from ...wording import unit_for
        from .evidence import direction

        unit = unit_for(max(float(abs(self.contact).max()), self.radius), "length")
        rows = []
        for i, (place, pole) in enumerate(zip(self.contact / unit.scale, self.north_pole, strict=True)):
            x, y = (float(f"{round(float(part), 9):.4g}") + 0.0 for part in place)
            rows.append((f"stage {i}" if i else "start", unit.after(f"({x:g}, {y:g})"), direction(pole)))
        half = MOST_TOLD // 2
        return rows if len(rows) <= MOST_TOLD else [*rows[:half], ("...", "", ""), *rows[-half:]]

    def _headline(self) -> Headline:
        first, last = self.distance[[0, -1]] if self.distance.size else (0.0, 0.0)
        return Headline("", f"{self.distance.size} places, {first:g} to {last:g} m along the path")

    def _parts(self) -> Iterator[Markup]:
        yield table(self.told(), ("", "contact", "north pole"))

    @property
    def trace(self) -> Array:
        """The point of the ball that touches the plane, in the body frame: (n, 3), m."""
        return (Quaternion.of(self.orientation).conjugate.matrix() @ (E_Z * -self.radius)).array()
