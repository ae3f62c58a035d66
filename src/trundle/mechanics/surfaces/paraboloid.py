"""The paraboloid of revolution, a bowl or a mound."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from ... import wording
from ...errors import InvalidValueError
from ..parts import POSITIVE, Number
from ..scalars import Scalar
from .over_plane import Bends, OverPlane, Slopes


def _check_not_zero(radius: float, received: Any) -> None:
    if radius == 0:
        remedy = "It is the radius of curvature at the vertex: positive makes a bowl, negative a mound."
        raise InvalidValueError("", "must not be zero", received, remedy)


@dataclass(frozen=True)
class Paraboloid(OverPlane):
    """The paraboloid z = r²/(2b): a bowl where b is positive, a mound where it is negative.

    Parameters
    ----------
    radius : float or quantity
        b, the radius of curvature at the vertex, m. A ball fits a bowl if it is smaller.
    rim : float or quantity, optional
        Distance of the edge from the axis, m; absent: it has none.

    Examples
    --------
    >>> Paraboloid("50 cm").point(0.3, 0.4).z, Paraboloid(-0.5).point(0.3, 0.4).z
    (0.25, -0.25)
    """

    radius: Annotated[
        Scalar,
        Number(
            "length",
            said="Radius of curvature at the vertex; negative: a mound.",
            example="50 cm",
            limit=_check_not_zero,
        ),
    ]
    rim: Annotated[
        Scalar | None, Number("length", POSITIVE, "Distance of the edge from the axis; absent: unbounded.", "40 cm")
    ] = None
    kind = "paraboloid"
    label = "Dish"
    axisymmetric = True

    @property
    def where(self) -> str:  # type: ignore[override]
        """In a bowl, on a mound."""
        return "in" if self.radius > 0 else "on"

    @property
    def noun(self) -> str:  # type: ignore[override]
        """A mound where it opens downward."""
        return "paraboloid" if self.radius > 0 else "mound"

    @property
    def ground(self) -> str:  # type: ignore[override]
        """As its noun."""
        return self.noun

    @property
    def free_radius(self) -> Scalar:
        """That of its vertex in a bowl, infinite on a mound."""
        return self.radius if self.radius > 0 else math.inf

    def key_numbers(self) -> list[str]:
        """Return the radius of curvature at the vertex."""
        return [f"radius at the vertex {wording.length(abs(self.radius))}"]

    def height(self, x: Scalar, y: Scalar) -> Scalar:
        """Return r²/(2b), m."""
        return 0.5 * (x * x + y * y) / self.radius

    def derivatives(self, x: Scalar, y: Scalar) -> tuple[Slopes, Bends]:
        """Return the slopes x/b and y/b, and 1/b both ways."""
        b = self.radius
        return (x / b, y / b), (1.0 / b, 0.0, 1.0 / b)
