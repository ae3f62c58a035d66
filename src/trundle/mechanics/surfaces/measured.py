"""Surfaces through tables of numbers, as somebody measured them: of revolution, and height fields."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...errors import InvalidValueError
from .. import checks
from ..algebra import Vector
from ..scalars import Scalar, namespace
from .over_plane import Bends, OverPlane, Slopes, around_axis
from .splines import Spline, ascending, lengths

_THROUGH = "Write for instance tr.{}."


class Profile(Spline):
    """The spline in r² through points (r, z): smooth at the axis, too.

    Parameters
    ----------
    r, z : sequence of floats or quantities
        Distances from the axis, four at least and ascending, none negative, and the heights there, m.

    Examples
    --------
    >>> round(Profile([0.0, 0.1, 0.2, 0.3], [0.0, 0.01, 0.04, 0.09])((0.0225,)), 12)
    0.0225
    """

    def __init__(self, r: Any, z: Any) -> None:
        self.r, heights = ascending(r, "r"), lengths(z, "z")
        if self.r[0] < 0:
            raise InvalidValueError("r", "must not be negative", self.r[0], "It is the distance from the axis.")
        if len(heights) != len(self.r):
            raise InvalidValueError("z", f"must have as many values as r, {len(self.r)}", list(heights))
        super().__init__((tuple(radius * radius for radius in self.r),), heights)


class Grid(Spline):
    """The spline through heights z[i][j] at (x[i], y[j]).

    Parameters
    ----------
    x, y : sequence of floats or quantities
        Four at least and ascending, m.
    z : sequence of sequences of floats or quantities
        A row for each x, with a height for each y, m.

    Examples
    --------
    >>> from itertools import product
    >>> side = [0.0, 1.0, 2.0, 3.0]
    >>> round(Grid(side, side, [[x * y for y in side] for x in side])((1.5, 2.5)), 12)
    3.75
    """

    def __init__(self, x: Any, y: Any, z: Any) -> None:
        axes = (ascending(x, "x"), ascending(y, "y"))
        if isinstance(z, str) or not hasattr(z, "__len__") or len(z) != len(axes[0]):
            shown = len(z) if hasattr(z, "__len__") else z
            raise InvalidValueError("z", f"must have a row for each x, {len(axes[0])}", shown, "A row runs along y.")
        rows = tuple(lengths(row, f"z[{i}]") for i, row in enumerate(z))
        for i, row in enumerate(rows):
            if len(row) != len(axes[1]):
                raise InvalidValueError(f"z[{i}]", f"must have a height for each y, {len(axes[1])}", len(row))
        super().__init__(axes, rows)


@dataclass(frozen=True)
class RevolutionTable(OverPlane):
    """The surface of revolution through points (r, z); `Revolution.through` makes one.

    Parameters
    ----------
    profile : Profile
        The spline through the points. The surface ends at the last of them and, unless it is on the axis, the first.

    Examples
    --------
    >>> dish = RevolutionTable(Profile([0.0, 0.1, 0.2, 0.3], [0.0, 0.01, 0.04, 0.09]))
    >>> round(dish.point(0.15, 0.0).z, 12), dish.domain_margin(dish.point(0.15, 0.0)) > 0
    (0.0225, True)
    """

    profile: Profile
    table_of = "revolution"
    noun = "surface of revolution"
    analytic = False
    recordable = True
    axisymmetric = True
    domain_end = "the end of the table"

    def __post_init__(self) -> None:
        example = _THROUGH.format("Revolution.through(r, z)")
        checks.instance(self.profile, Profile, "profile", example)

    @property
    def given(self) -> dict[str, Any]:
        """The points, as `Revolution.through` takes them."""
        return {"r": list(self.profile.r), "z": list(self.profile.values)}

    def height(self, x: Scalar, y: Scalar) -> Scalar:
        """Return z, m."""
        return self.profile((x * x + y * y,))

    def derivatives(self, x: Scalar, y: Scalar) -> tuple[Slopes, Bends]:
        """Return the derivatives of the spline."""
        square = x * x + y * y
        return around_axis(x, y, self.profile((square,), (1,)), self.profile((square,), (2,)))

    def domain_margin(self, p: Vector) -> Scalar:
        """Return what falls through 0 at the ends of the table, m²."""
        square, (first, last) = p.x * p.x + p.y * p.y, (self.profile.r[0], self.profile.r[-1])
        room = last * last - square
        return room if first == 0 else room * (square - first * first) / (last * last)


@dataclass(frozen=True)
class HeightTable(OverPlane):
    """The height field through a grid of heights; `HeightField.through` makes one.

    Parameters
    ----------
    grid : Grid
        The spline through the heights. The surface ends where the grid does.

    Examples
    --------
    >>> side = [-1.0, 0.0, 1.0, 2.0]
    >>> saddle = HeightTable(Grid(side, side, [[x * y for y in side] for x in side]))
    >>> round(saddle.point(0.5, 0.5).z, 12)
    0.25
    """

    grid: Grid
    table_of = "height-field"
    analytic = False
    recordable = True
    axisymmetric = False
    domain_end = "the end of the table"

    def __post_init__(self) -> None:
        checks.instance(self.grid, Grid, "grid", _THROUGH.format("HeightField.through(x, y, z)"))

    @property
    def given(self) -> dict[str, Any]:
        """The heights, as `HeightField.through` takes them."""
        x, y = self.grid.axes
        return {"x": list(x), "y": list(y), "z": [list(row) for row in self.grid.values]}

    def height(self, x: Scalar, y: Scalar) -> Scalar:
        """Return z, m."""
        return self.grid((x, y))

    def derivatives(self, x: Scalar, y: Scalar) -> tuple[Slopes, Bends]:
        """Return the derivatives of the spline."""
        at = (x, y)
        return self.slopes(x, y), (self.grid(at, (2, 0)), self.grid(at, (1, 1)), self.grid(at, (0, 2)))

    def slopes(self, x: Scalar, y: Scalar) -> Slopes:
        """Return the first derivatives of the spline."""
        return self.grid((x, y), (1, 0)), self.grid((x, y), (0, 1))

    def domain_margin(self, p: Vector) -> Scalar:
        """Return what falls through 0 at the edges of the grid: a + b − √(a² + b²) of what is left both ways, a and b.

        It is positive where both are; a product would be beyond a corner, too.
        """
        a, b = (
            (value - axis[0]) * (axis[-1] - value) / (axis[-1] - axis[0]) ** 2
            for value, axis in zip((p.x, p.y), self.grid.axes, strict=True)
        )
        return a + b - namespace(a, b).sqrt(a * a + b * b)
