"""Surfaces of revolution z(r), by a formula."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, Any

from ... import wording
from ..algebra import Vector
from ..expressions import Expression
from ..jets import Jet, jets
from ..parts import POSITIVE, Formula, Lengths, Number
from ..scalars import Scalar, namespace
from ..seams import seams, to_the_next
from .measured import Profile, RevolutionTable
from .over_plane import Bends, OverPlane, Slopes, around_axis
from .parity import in_square, is_even

_VARIABLES = ("r", "r2")
# Added to r² so that a formula that is smooth at the axis, but not written in r², has its limit there, not 0/0.
_NOTHING = 1e-300


@dataclass(frozen=True)
class Revolution(OverPlane):
    """The surface z = f(r) about the third axis, r the distance from it; a formula in r, or in r2 = r².

    A surface of revolution is smooth at the axis where f is even. A formula that is even as it is written, such as
    ``0.2*r**2`` or ``sqrt(1 + r*r)``, is rearranged in r². Taylor's method needs that where the body comes near the
    axis: of any other formula, such as ``cos(r)``, it sees the square root in r = √(x² + y²).

    Parameters
    ----------
    formula : str or Expression
        f in m, of r in m or r2 in m². With f(0) = 0 the origin lies on the surface.
    rim : float or quantity, optional
        Distance of the edge from the axis, m; absent: it has none.

    Examples
    --------
    >>> Revolution("r**2 - r**4").point(0.3, 0.4).z
    0.1875
    """

    formula: Annotated[Any, Formula(_VARIABLES, "z in r or r2 = r².", "0.5*r**2 - 0.8*r**4")]
    rim: Annotated[
        Scalar | None, Number("length", POSITIVE, "Of a formula: distance of the edge from the axis.", "40 cm")
    ] = None
    kind = "revolution"
    label = "Surface of revolution"
    noun = "surface of revolution"
    points = MappingProxyType(
        {
            "r": Lengths("Distances from the axis, four at least, ascending."),
            "z": Lengths("Heights there; the surface is a smooth spline through them."),
        }
    )
    axisymmetric = True
    domain_end = "where the surface's formula ends or has a crease or an apex"

    def key_numbers(self) -> list[str]:
        """Return its formula."""
        return [f"z = {wording.cut(self.formula.text)}"]

    @staticmethod
    def through(r: Any, z: Any) -> RevolutionTable:
        """Return the surface through points (r, z), a smooth spline.

        Parameters
        ----------
        r, z : sequence of floats or quantities
            Distances from the axis, four at least and ascending, none negative, and the heights there, m. Six and more
            make a quintic spline (C⁴), fewer a cubic one (C²).

        Returns
        -------
        RevolutionTable
            It ends at the last point and, unless that is on the axis, at the first.

        Examples
        --------
        >>> dish = Revolution.through(["0 cm", "10 cm", "20 cm", "30 cm"], [0, 0.01, 0.04, 0.09])
        >>> round(dish.normal(dish.point(0.0, 0.2)).y / dish.normal(dish.point(0.0, 0.2)).z, 12)
        -0.4
        """
        return RevolutionTable(Profile(r, z))

    def _square(self, x: Scalar, y: Scalar) -> Scalar:
        return x * x + y * y

    def height(self, x: Scalar, y: Scalar) -> Scalar:
        """Return f, m."""
        square, even = self._square(x, y), in_square(self.formula.tree)
        if even is not None:
            return Expression(even, self.formula.text).at(r2=square)
        return self.formula.at(r=namespace(square).sqrt(square + _NOTHING), r2=square)

    def derivatives(self, x: Scalar, y: Scalar) -> tuple[Slopes, Bends]:
        """Return the derivatives by way of r², or of r where the formula needs it."""
        square, even = self._square(x, y), in_square(self.formula.tree)
        if even is not None:
            _, first, second = _differentiated(Expression(even, self.formula.text), r2=square)
            return around_axis(x, y, first, second)
        r = namespace(square).sqrt(square + _NOTHING)
        (variable,) = jets((r,))
        _, first, second = _parts(self.formula.at(r=variable, r2=variable * variable))
        # df/d(r²) is f′/(2r); by way of the unit vector e nothing overflows.
        e, f, around = x / r, y / r, first / r
        bend = second - around
        return (first * e, first * f), (around + bend * (e * e), bend * (e * f), around + bend * (f * f))

    def domain_margin(self, p: Vector) -> Scalar | None:
        """Return about how far a crease is, an apex or the end of the formula, m; None where it has none of them."""
        even = in_square(self.formula.tree)
        if even is not None:
            return to_the_next(seams(even), r2=self._square(*jets((p.x, p.y))))
        square = self._square(p.x, p.y)
        (r,) = jets((namespace(square).sqrt(square + _NOTHING),))
        apex = [] if is_even(self.formula.tree) else ["r"]
        return to_the_next([*seams(self.formula.tree), *apex], r=r, r2=r * r)


def _differentiated(formula: Expression, **variable: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    ((name, value),) = variable.items()
    return _parts(formula.at(**{name: jets((value,))[0]}))


def _parts(f: Any) -> tuple[Scalar, Scalar, Scalar]:
    return (f.value, f.gradient[0], f.hessian[0]) if isinstance(f, Jet) else (f, 0.0, 0.0)
