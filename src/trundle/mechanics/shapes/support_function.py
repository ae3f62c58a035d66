"""Shapes of the user's own, given by their support function as a formula."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any

from ... import wording
from ..algebra import Matrix, RotatedTensor, Vector
from ..expressions import Expression
from ..jets import Jet, jets
from ..scalars import is_number, leaves, namespace
from .base import CENTRE, Shape, moved, on_third_axis

NAMES = ("nu_x", "nu_y", "nu_z")


@dataclass(frozen=True)
class SupportFunction(Shape):
    """A smooth convex body given by its support function h(ν) = X(ν)·ν, in metres.

    h says how far the body reaches in the direction of the outward unit normal ν = (nu_x, nu_y, nu_z). With it go the
    support map X = ∇h and the inverse curvature ∂X/∂ν = ∇∇h, of h continued so that h(λν) = λ h(ν)
    ([schneider2014], sections 1.7 and 2.5); both are exact derivatives. The formula only needs to be right for vectors
    of length 1.

    Parameters
    ----------
    formula : str
        h in nu_x, nu_y and nu_z, m; see `Expression` for what may stand in it.
    centre : Vector, optional
        The origin that h is reckoned from, from the centre of mass in the body frame, m; absent: the two coincide.

    Raises
    ------
    InvalidValueError
        If the body is not convex, has an edge or a flat face, or h is not finite; the direction is named.

    Examples
    --------
    >>> egg = SupportFunction("0.03 + 0.004*nu_z**3")
    >>> egg.support_map(Vector(0.0, 0.0, 1.0)).z
    0.034
    """

    formula: Any  # an Expression once it is made
    centre: Annotated[Any, CENTRE] = None  # a Vector or None

    def __post_init__(self) -> None:
        if not isinstance(self.formula, Expression):
            object.__setattr__(self, "formula", Expression.parse(self.formula, NAMES, "support_function"))
        super().__post_init__()
        if _in_numbers(self.formula.tree):
            _check(self.formula)

    def key_numbers(self) -> list[str]:
        """Return the formula."""
        return [f"body h = {wording.cut(self.formula.text)}"]

    def parameters(self) -> dict[str, Any]:
        """Return h and the centre."""
        return {"support_function": self.formula, "centre": self.centre}

    @property
    def axisymmetric(self) -> bool:
        """Whether h changes with no turn about the third axis by more than rounding, and its centre lies on it."""
        return on_third_axis(self.centre) and _in_numbers(self.formula.tree) and _axisymmetric(self.formula)

    def support_map(self, nu: Vector) -> Vector:
        """Return X = c + ∇h."""
        return moved(self.centre, Vector(*support(self.formula, nu).gradient))

    def support_gradient(self, nu: Vector) -> Matrix:
        """Return ∇∇h."""
        return _matrix(support(self.formula, nu))

    def contact(self, Q: Matrix, n: Vector) -> tuple[Vector, RotatedTensor]:
        """Return ρ and C, as for every shape, from one evaluation of h."""
        h = support(self.formula, -(Q.transpose @ n))
        return Q @ moved(self.centre, Vector(*h.gradient)), RotatedTensor(Q, _matrix(h))


def support(formula: Expression, nu: Vector) -> Jet:
    """Return h, continued with h(λν) = λ h(ν), with its first and second derivatives at ν.

    Examples
    --------
    >>> support(Expression.parse("2.0", NAMES, "h"), Vector(0.0, 0.0, 1.0)).gradient
    (0.0, 0.0, 2.0)
    """
    x, y, z = jets(tuple(nu))
    length = namespace(x, y, z).sqrt(x * x + y * y + z * z)
    found: Jet = length * formula.at(**dict(zip(NAMES, (x / length, y / length, z / length), strict=True)))
    return found


def _matrix(h: Jet) -> Matrix:
    xx, xy, xz, yy, yz, zz = h.hessian
    return Matrix(Vector(xx, xy, xz), Vector(xy, yy, yz), Vector(xz, yz, zz))


def _in_numbers(tree: Any) -> bool:
    return all(isinstance(leaf, str) or is_number(leaf) for leaf in leaves((tree,)))


@cache
def _check(formula: Expression) -> None:
    from .convexity import check_convex

    check_convex(lambda nu: support(formula, nu), formula.text)


@cache
def _axisymmetric(formula: Expression) -> bool:
    from .convexity import looks_the_same_all_round

    return looks_the_same_all_round(lambda nu: formula.at(**dict(zip(NAMES, nu, strict=True))))
