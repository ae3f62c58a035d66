"""The inside of an ellipsoid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ... import wording
from ...errors import InvalidValueError
from ..algebra import Matrix, Vector
from ..parts import POSITIVE, Number, Numbers
from ..scalars import Scalar, is_number, leaves, namespace
from .base import Surface, check_upright, tangential

_AXES = ("40 cm", "30 cm", "25 cm")


@dataclass(frozen=True)
class EllipsoidalBowl(Surface):
    """The inside of an ellipsoid with semi-axes A, B, C along the three axes, its lowest point at the origin.

    Parameters
    ----------
    semi_axes : sequence of 3 floats or quantities
        A, B and C, m. At the lowest point its radii of curvature are A²/C and B²/C: a ball must be smaller.
    depth : float or quantity, optional
        Height of the edge over the lowest point, m, at most C; absent: the ellipsoid is closed.

    Examples
    --------
    >>> bowl = EllipsoidalBowl(("50 cm", "40 cm", "25 cm"))
    >>> round(bowl.point(0.3, 0.0).z, 15), bowl.axisymmetric
    (0.05, False)
    """

    semi_axes: Annotated[
        tuple[Scalar, Scalar, Scalar],
        Numbers(Number("length", POSITIVE), "Along the three axes.", example=_AXES, label="Semi-axis"),
    ]
    depth: Annotated[
        Scalar | None, Number("length", POSITIVE, "Height of the edge over the lowest point; absent: closed.", "20 cm")
    ] = None
    kind = "ellipsoidal-bowl"
    label = "Elliptic bowl"
    where, noun, ground = "in", "elliptic bowl", "bowl"
    domain_end = "the edge of the bowl"

    def __post_init__(self) -> None:
        given = self.depth
        super().__post_init__()
        object.__setattr__(self, "semi_axes", tuple(self.semi_axes))
        axes, depth = self.semi_axes, self.depth
        if is_number(depth) and is_number(axes[2]) and depth > axes[2]:
            remedy = f"The third semi-axis is {axes[2]:g} m; a depth of that makes half an ellipsoid."
            raise InvalidValueError("depth", "must be at most the third semi-axis", given, remedy)

    def key_numbers(self) -> list[str]:
        """Return its semi-axes."""
        return [f"semi-axes {wording.length(*self.semi_axes)}"]

    @property
    def axisymmetric(self) -> bool:
        """Whether the first two semi-axes are equal numbers."""
        a, b, _ = self.semi_axes
        return is_number(a) and is_number(b) and bool(a == b)

    @property
    def free_radius(self) -> Scalar:
        """The least radius of curvature, at the ends of the longest axis: the square of the shortest over it."""
        return min(self.semi_axes) ** 2 / max(self.semi_axes)

    def _bends(self) -> tuple[Scalar, Scalar, Scalar]:
        """Return C/A², C/B² and 1/C, 1/m: the second derivatives of −φ."""
        a, b, c = self.semi_axes
        return c / (a * a), c / (b * b), 1.0 / c

    def level(self, p: Vector) -> Scalar:
        """Return φ = z − z²/(2C) − C(x²/A² + y²/B²)/2, m, of slope 1 at the lowest point."""
        k, l, m = self._bends()
        return p.z - 0.5 * (k * (p.x * p.x) + l * (p.y * p.y) + m * (p.z * p.z))

    def _slope(self, p: Vector) -> Vector:
        k, l, m = self._bends()
        return Vector(-(k * p.x), -(l * p.y), 1.0 - m * p.z)

    def normal(self, p: Vector) -> Vector:
        """Return n = ∇φ/|∇φ|."""
        slope = self._slope(p)
        return slope / slope.norm()

    def shape_operator(self, p: Vector) -> Matrix:
        """Return S = P H P/|∇φ| with H = −diag(C/A², C/B², 1/C)."""
        slope = self._slope(p)
        length = slope.norm()
        return tangential(Matrix.diagonal(*self._bends()), slope / length) * (-1.0 / length)

    def domain_margin(self, p: Vector) -> Scalar | None:
        """Return how far below the edge the point is, m; without an edge, None."""
        return None if self.depth is None else self.depth - p.z

    def point(self, u: Scalar, v: Scalar) -> Vector:
        """Return the point at x and y, m, on the lower half."""
        a, b, c = self.semi_axes
        square = u * u / (a * a) + v * v / (b * b)
        return Vector(u, v, c * square / (1.0 + namespace(*leaves((u, v, a, b, c))).sqrt(1.0 - square)))

    def check_tilt(self, tilt: float, received: Any) -> None:
        """Refuse a bowl whose axis does not point up."""
        check_upright(tilt, received)
