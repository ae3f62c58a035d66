"""Derivatives of any function of a few variables, first and second, exact: numbers that carry their slopes along.

A jet is a value with its gradient and its Hessian; arithmetic on jets follows the product and chain rules. Because
the parts of a jet are any scalars, a surface or a shape given by one formula has its derivatives as floats, arrays,
heyoka expressions and SymPy symbols alike (forward accumulation: Griewank and Walther 2008, chapter 3).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from .records import frozen_record
from .scalars import Scalar, less, namespace


@frozen_record(eq=False)
class Jet:
    """A value, its gradient and its Hessian in a few variables.

    Examples
    --------
    >>> x, y = jets((3.0, 2.0))
    >>> (x * x * y).value, (x * x * y).gradient, (x * x * y).hessian
    (18.0, (12.0, 9.0), (4.0, 6.0, 0.0))
    """

    value: Scalar  # f
    gradient: tuple[Scalar, ...]  # ∂f/∂x_i
    hessian: tuple[Scalar, ...]  # ∂²f/∂x_i∂x_j for i ≤ j, row by row

    __array_ufunc__ = None  # so that array * Jet asks Jet

    def through(self, f: Scalar, first: Scalar, second: Scalar) -> Jet:
        """Return f of this jet, from f, f′ and f″ at its value: the chain rule."""
        g = self.gradient
        pairs = _pairs(len(g))
        bent = (first * h + second * (g[i] * g[j]) for h, (i, j) in zip(self.hessian, pairs, strict=True))
        return Jet(f, tuple(first * slope for slope in g), tuple(bent))

    def __add__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.value + other, self.gradient, self.hessian)
        return Jet(
            self.value + other.value,
            tuple(a + b for a, b in zip(self.gradient, other.gradient, strict=True)),
            tuple(a + b for a, b in zip(self.hessian, other.hessian, strict=True)),
        )

    __radd__ = __add__

    def __neg__(self) -> Jet:
        return Jet(-self.value, tuple(-slope for slope in self.gradient), tuple(-bend for bend in self.hessian))

    def __sub__(self, other: Any) -> Jet:
        return self + (-other)

    def __rsub__(self, other: Any) -> Jet:
        return -self + other

    def __mul__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            return Jet(
                self.value * other,
                tuple(slope * other for slope in self.gradient),
                tuple(bend * other for bend in self.hessian),
            )
        a, b, g, h = self.value, other.value, self.gradient, other.gradient
        slopes = tuple(x * b + a * y for x, y in zip(g, h, strict=True))
        bends = (
            p * b + a * q + (g[i] * h[j] + g[j] * h[i])
            for p, q, (i, j) in zip(self.hessian, other.hessian, _pairs(len(g)), strict=True)
        )
        return Jet(a * b, slopes, tuple(bends))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Jet:
        return self * (other**-1 if isinstance(other, Jet) else 1.0 / other)

    def __rtruediv__(self, other: Any) -> Jet:
        return self**-1 * other

    def __pow__(self, power: int) -> Jet:
        x = self.value
        if power == 0:
            return self * 0.0 + 1.0
        if power == 1:
            return self
        second = power * (power - 1.0) * (1.0 if power == 2 else x ** (power - 2))
        return self.through(x**power, power * x ** (power - 1), second)

    def __abs__(self) -> Jet:
        return JetFunctions(namespace(self.value)).abs(self)


class JetFunctions:
    """The functions of `scalars.namespace` for jets, over those of the jets' own parts.

    Examples
    --------
    >>> (x,) = jets((0.0,))
    >>> namespace(x).sin(x).gradient
    (1.0,)
    """

    def __init__(self, inner: Any) -> None:
        self._inner = inner
        self.exact = getattr(inner, "exact", False)

    def sqrt(self, x: Any) -> Any:
        """Return √x."""
        return self._of(x, "sqrt", lambda v, f: (0.5 / f, -0.25 / (f * v)))

    def sin(self, x: Any) -> Any:
        """Return sin x."""
        return self._of(x, "sin", lambda v, f: (self._inner.cos(v), -f))

    def cos(self, x: Any) -> Any:
        """Return cos x."""
        return self._of(x, "cos", lambda v, f: (-self._inner.sin(v), -f))

    def tan(self, x: Any) -> Any:
        """Return tan x."""
        return self._of(x, "tan", lambda v, f: (1.0 + f * f, 2.0 * f * (1.0 + f * f)))  # noqa: ARG005

    def exp(self, x: Any) -> Any:
        """Return e to the x."""
        return self._of(x, "exp", lambda v, f: (f, f))  # noqa: ARG005

    def expm1(self, x: Any) -> Any:
        """Return e to the x, less 1."""
        return self._of(x, "expm1", lambda v, f: (f + 1.0, f + 1.0))  # noqa: ARG005

    def log(self, x: Any) -> Any:
        """Return the natural logarithm."""
        return self._of(x, "log", lambda v, f: (1.0 / v, -1.0 / (v * v)))  # noqa: ARG005

    def abs(self, x: Any) -> Any:
        """Return |x|; its slope at 0 is that to the right in a single variable, and else that of x."""
        if not isinstance(x, Jet):
            return self._inner.abs(x)
        return x.through(self._inner.abs(x.value), self._sign(x), 0.0)

    def hypot(self, x: Any, y: Any) -> Any:
        """Return √(x² + y²)."""
        return self.sqrt(x * x + y * y)

    def atan2(self, y: Any, x: Any) -> Any:
        """Return the angle of the point (x, y)."""
        a, b = (v.value if isinstance(v, Jet) else v for v in (y, x))
        template = y if isinstance(y, Jet) else x
        zero = template * 0.0
        dy, dx = (v - v.value if isinstance(v, Jet) else zero for v in (y, x))
        # Along the arc, and in it: the angle seen from where the point is, to second order.
        square = a * a + b * b
        along, out = (dy * b - dx * a) * (1.0 / square), (dx * b + dy * a) * (1.0 / square)
        return along - along * out + self._inner.atan2(a, b)

    def where(self, condition: Any, yes: Any, no: Any) -> Any:
        """Return one of two jets, part by part."""
        template = yes if isinstance(yes, Jet) else no
        if not isinstance(template, Jet):
            return self._inner.where(condition, yes, no)
        yes, no = (v if isinstance(v, Jet) else template * 0.0 + v for v in (yes, no))

        def pick(a: Any, b: Any) -> Any:
            return self._inner.where(condition, a, b)

        return Jet(
            pick(yes.value, no.value),
            tuple(map(pick, yes.gradient, no.gradient)),
            tuple(map(pick, yes.hessian, no.hessian)),
        )

    def _of(self, x: Any, name: str, slopes: Callable[[Any, Any], tuple[Any, Any]]) -> Any:
        function = getattr(self._inner, name)
        if not isinstance(x, Jet):
            return function(x)
        f = function(x.value)
        return x.through(f, *slopes(x.value, f))

    def _sign(self, x: Jet) -> Any:
        v = x.value
        if len(x.gradient) == 1:
            zero = v == 0  # never, of a symbol
            v = (x.gradient[0] if zero else v) if isinstance(zero, bool) else self._inner.where(zero, x.gradient[0], v)
        return self._inner.where(less(v, 0.0), -1.0, 1.0)


def jets(values: Sequence[Scalar]) -> tuple[Jet, ...]:
    """Return variables to compute with: each with slope 1 in itself.

    Examples
    --------
    >>> jets((2.0,))[0].gradient
    (1.0,)
    """
    n = len(values)
    flat = (0.0,) * len(_pairs(n))
    return tuple(Jet(v, tuple(1.0 if i == j else 0.0 for j in range(n)), flat) for i, v in enumerate(values))


@cache
def _pairs(n: int) -> tuple[tuple[int, int], ...]:
    return tuple((i, j) for i in range(n) for j in range(i, n))
