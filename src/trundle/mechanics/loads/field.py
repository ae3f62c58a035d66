"""A force field given by its potential energy."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

from ... import wording
from ..algebra import Vector
from ..expressions import Expression
from ..parts import Formula
from ..scalars import Scalar, is_number, leaves
from ..seams import lengths
from .base import BodyMotion, Load

VARIABLES = ("x", "y", "z", "t")
_LOOKS = tuple((10.0 ** (i % 5 - 3), 0.3 + 2.1 * i, 0.7 + 1.3 * i) for i in range(40))  # size, m, and two angles


@dataclass(frozen=True)
class Potential(Load):
    """A force −∇U on the centre of mass, from a formula for U.

    Parameters
    ----------
    formula : str
        U in J, in the place x, y, z of the centre of mass in the inertial support frame, m, and the time t, s. With t
        in it there is a force, but no energy that is kept.

    Examples
    --------
    >>> from trundle.mechanics.loads import at_rest
    >>> trap = Potential("0.5*3*(x**2 + y**2) + 0.2*x")
    >>> trap.force(at_rest(1.0))
    Vector(x=-0.2, y=-0.0, z=-0.0)
    """

    formula: Annotated[Any, Formula(VARIABLES, "U in J, in x, y, z of the centre in m and the time t in s.")]
    kind = "potential"

    def key_numbers(self) -> list[str]:
        """Return its formula."""
        return [f"potential U = {wording.cut(self.formula.text)}"]

    def force(self, motion: BodyMotion) -> Vector:
        """Return −∇U."""
        x, y, z = motion.position
        return -Vector(*self.formula.gradient(("x", "y", "z"), x=x, y=y, z=z, t=motion.time))

    def potential(self, motion: BodyMotion) -> Scalar | None:
        """Return U; None where it depends on the time."""
        x, y, z = motion.position
        return None if "t" in self.formula.variables else self.formula.at(x=x, y=y, z=z, t=motion.time)

    @property
    def corners(self) -> tuple[Callable[[BodyMotion], Vector], ...]:
        """What stands between bars, or is squared under a root, but for what the time alone decides."""
        return tuple(
            partial(_vector, parts)
            for parts in lengths(self.formula.tree)
            if any(Expression(part, "").variables - {"t"} for part in parts)
        )

    @property
    def symmetric(self) -> bool:
        """Whether U is the same all around the third axis, x ∂U/∂y = y ∂U/∂x wherever one looks."""
        if not {"x", "y"} & self.formula.variables:
            return True
        if not all(isinstance(part, str) or is_number(part) for part in leaves((self.formula.tree,))):
            return False
        looks = [_around(self.formula, *look) for look in _LOOKS]
        told = [(off, size) for off, size in looks if size > 0]
        return bool(told) and all(off <= 1e-12 * size for off, size in told)

    @property
    def leaves_spin(self) -> bool:
        """True: it acts at the centre of mass."""
        return True


def _vector(parts: tuple[Any, ...], motion: BodyMotion) -> Vector:
    """Return the values of up to three parts of a formula."""
    x, y, z = motion.position
    values = [Expression(part, "").at(x=x, y=y, z=z, t=motion.time) for part in parts]
    return Vector(*values, *[0.0] * (3 - len(values)))


def _around(formula: Expression, size: float, along: float, up: float) -> tuple[float, float]:
    """Return x ∂U/∂y − y ∂U/∂x at a place, and the size of its terms; 0 where U is not finite."""
    x, y, z = size * math.cos(along), size * math.sin(along), size * math.sin(up)
    try:
        u, v = formula.gradient(("x", "y"), x=x, y=y, z=z, t=up)
    except (ArithmeticError, ValueError):
        return 0.0, 0.0
    off, terms = abs(x * v - y * u), abs(x * v) + abs(y * u)
    return (off, terms) if math.isfinite(terms) else (0.0, 0.0)
