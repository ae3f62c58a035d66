"""The ball at some places of its path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mechanics.algebra import E_Z, Quaternion

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stages:
    """The ball at some places of its path.

    Parameters
    ----------
    distance : array (n,)
        Along the path, m.
    contact : array (n, 2)
        Contact point on the plane, m.
    heading : array (n,)
        Direction of travel, from the first axis towards the second, rad.
    orientation : array (n, 4)
        Unit quaternion (w, x, y, z), body frame to support frame.
    radius : float
        Of the ball, m.
    """

    distance: Array
    contact: Array
    heading: Array
    orientation: Array
    radius: float

    @property
    def position(self) -> Array:
        """The centre of the ball, (n, 3), m."""
        return np.column_stack([self.contact, np.full(len(self.contact), self.radius)])

    @property
    def north_pole(self) -> Array:
        """The direction from the centre to the north pole, where the body's third axis comes out: (n, 3)."""
        return (Quaternion.of(self.orientation).matrix() @ E_Z).array()

    @property
    def trace(self) -> Array:
        """The point of the ball that touches the plane, in the body frame: (n, 3), m."""
        return (Quaternion.of(self.orientation).conjugate.matrix() @ (E_Z * -self.radius)).array()
