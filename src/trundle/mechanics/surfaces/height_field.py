"""Height fields z(x, y), by a formula."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, Any

from ... import wording
from ..algebra import Vector
from ..jets import jets
from ..parts import POSITIVE, Formula, Lengths, Number
from ..scalars import Scalar
from ..seams import seams, to_the_next
from .measured import Grid, HeightTable
from .over_plane import OverPlane


@dataclass(frozen=True)
class HeightField(OverPlane):
    """The surface z = h(x, y), by a formula in x and y.

    It never counts as symmetric about the axis; write a `Revolution` for one that is. A run ends where the contact
    comes to a crease, as ``abs`` makes it, or to the end of the formula.

    Parameters
    ----------
    formula : str or Expression
        h in m, of x and y in m. With h(0, 0) = 0 the origin lies on the surface.
    rim : float or quantity, optional
        Distance of the edge from the axis, m; absent: it has none.

    Examples
    --------
    >>> HeightField("0.2*x*cos(2*y)").point(0.5, 0.0).z
    0.1
    """

    formula: Annotated[Any, Formula(("x", "y"), "z in x and y.", "0.02*sin(10*x)*cos(8*y)")]
    rim: Annotated[
        Scalar | None, Number("length", POSITIVE, "Of a formula: distance of the edge from the axis.", "0.5 m")
    ] = None
    kind = "height-field"
    label = "Hills"
    points = MappingProxyType(
        {
            "x": Lengths("Along the first axis, four at least, ascending."),
            "y": Lengths("Along the second axis, four at least, ascending."),
            "z": Lengths("A list for each x with a height for each y.", rows=True),
        }
    )
    axisymmetric = False
    domain_end = "where the surface's formula ends or has a crease"

    def key_numbers(self) -> list[str]:
        """Return its formula."""
        return [f"z = {wording.cut(self.formula.text)}"]

    @staticmethod
    def through(x: Any, y: Any, z: Any) -> HeightTable:
        """Return the surface through a grid of heights, a smooth spline.

        Parameters
        ----------
        x, y : sequence of floats or quantities
            Four at least and ascending, m. Six and more make a quintic spline (C⁴), fewer a cubic one (C²).
        z : sequence of sequences of floats or quantities
            A row for each x, with a height for each y, m.

        Returns
        -------
        HeightTable
            It ends where the grid does.

        Examples
        --------
        >>> side = [-0.2, -0.1, 0.0, 0.1, 0.2]
        >>> saddle = HeightField.through(side, side, [[x * x - y * y for y in side] for x in side])
        >>> round(saddle.point(0.15, 0.05).z, 12)
        0.02
        """
        return HeightTable(Grid(x, y, z))

    def height(self, x: Scalar, y: Scalar) -> Scalar:
        """Return h, m."""
        return self.formula.at(x=x, y=y)

    def domain_margin(self, p: Vector) -> Scalar | None:
        """Return about how far the nearest crease is, or the end of the formula, m; None where it has neither."""
        x, y = jets((p.x, p.y))
        return to_the_next(seams(self.formula.tree), x=x, y=y)
