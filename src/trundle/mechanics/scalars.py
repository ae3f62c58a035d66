"""One set of functions for every kind of scalar: float, NumPy or Array-API array, mpmath, heyoka, SymPy.

The mechanics is written once over whatever supports + - * /; what else it needs (square root, sine, a choice
between two values) is looked up here from the scalars themselves.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from typing import Any

Scalar = Any  # float | numpy.ndarray | Array-API array | mpmath.mpf | heyoka.expression | sympy.Expr


def is_number(value: Any) -> bool:
    """Tell whether a scalar is a plain real number, whose value can be looked at, rather than a symbol or an array.

    Examples
    --------
    >>> import sympy
    >>> is_number(0.4), is_number(sympy.Symbol("k"))
    (True, False)
    """
    return isinstance(value, (int, float)) or (type(value).__module__ == "numpy" and getattr(value, "ndim", None) == 0)


def is_zero(value: Any) -> bool:
    """Tell whether a scalar is known to be zero: a number 0, never a symbol or an array that happens to vanish.

    Examples
    --------
    >>> import numpy as np
    >>> is_zero(0.0), is_zero(np.zeros(3))
    (True, False)
    """
    if type(value) is float:  # nearly always, and asked of each element of each matrix
        return value == 0.0
    return is_number(value) and bool(value == 0)


def as_float(value: Any) -> Any:
    """Return a plain number as Python's float, and any other scalar as it is.

    Examples
    --------
    >>> as_float(2), as_float("x")
    (2.0, 'x')
    """
    if type(value) is float:
        return value
    return float(value) if is_number(value) else value


def leaves(values: tuple[Any, ...]) -> Iterator[Any]:
    """Go through nested tuples and yield what is in them.

    Examples
    --------
    >>> list(leaves((1.0, (2.0, 3.0))))
    [1.0, 2.0, 3.0]
    """
    for value in values:
        if isinstance(value, tuple):
            yield from leaves(value)
        else:
            yield value


class _Python:
    """Python floats: the math module under the names that the arrays' namespaces use."""

    sqrt, sin, cos, exp, expm1, round = math.sqrt, math.sin, math.cos, math.exp, math.expm1, round
    tan, log, abs, hypot, atan2 = math.tan, math.log, abs, math.hypot, math.atan2

    @staticmethod
    def where(condition: Any, yes: Any, no: Any) -> Any:
        return yes if condition else no


class _Heyoka:
    """heyoka expressions, whose choice is `select` between two expressions."""

    def __init__(self) -> None:
        import heyoka

        self.sqrt, self.sin, self.cos = heyoka.sqrt, heyoka.sin, heyoka.cos
        self.exp, self.expm1, self.tan, self.log = heyoka.exp, heyoka.expm1, heyoka.tan, heyoka.log
        self.atan2 = heyoka.atan2
        self._heyoka = heyoka

    def abs(self, x: Any) -> Any:
        return self.where(self._heyoka.lt(x, 0.0), -x, x)

    def hypot(self, x: Any, y: Any) -> Any:
        return self.sqrt(x * x + y * y)

    def where(self, condition: Any, yes: Any, no: Any) -> Any:
        expression = self._heyoka.expression
        as_expression = [v if isinstance(v, expression) else expression(float(v)) for v in (yes, no)]
        return self._heyoka.select(condition, *as_expression)


class _SymPy:
    """SymPy expressions."""

    exact = True  # computes with as many digits as asked, so definitions need no care against rounding

    def __init__(self) -> None:
        import sympy

        self.sqrt, self.sin, self.cos, self.exp = sympy.sqrt, sympy.sin, sympy.cos, sympy.exp
        self.tan, self.log, self.abs, self.atan2 = sympy.tan, sympy.log, sympy.Abs, sympy.atan2
        self._sympy = sympy

    def hypot(self, x: Any, y: Any) -> Any:
        return self._sympy.sqrt(x**2 + y**2)

    def expm1(self, x: Any) -> Any:
        return self._sympy.exp(x) - 1

    def where(self, condition: Any, yes: Any, no: Any) -> Any:
        return self._sympy.Piecewise((yes, condition), (no, True))


class _Mpmath:
    """mpmath numbers."""

    exact = True

    def __init__(self) -> None:
        import mpmath

        self.sqrt, self.sin, self.cos = mpmath.sqrt, mpmath.sin, mpmath.cos
        self.exp, self.expm1, self.tan, self.log = mpmath.exp, mpmath.expm1, mpmath.tan, mpmath.log
        self.abs, self.hypot, self.atan2 = abs, mpmath.hypot, mpmath.atan2

    @staticmethod
    def where(condition: Any, yes: Any, no: Any) -> Any:
        return yes if condition else no


class _ComplexStep:
    """NumPy's functions for complex arrays whose small imaginary part is a slope's: all are analytic."""

    def __init__(self, real: Any) -> None:
        self._numpy = real

    def __getattr__(self, name: str) -> Any:
        return getattr(self._numpy, name)

    def abs(self, x: Any) -> Any:
        return self._numpy.where(self._numpy.real(x) < 0, -x, x)

    def hypot(self, x: Any, y: Any) -> Any:
        return self._numpy.sqrt(x * x + y * y)

    def atan2(self, y: Any, x: Any) -> Any:
        a, b = self._numpy.real(x), self._numpy.real(y)
        turn = a * self._numpy.imag(y) - b * self._numpy.imag(x)
        return self._numpy.atan2(b, a) + 1j * turn / (a * a + b * b)


def namespace(*values: Any) -> Any:
    """Return the functions (sqrt, sin, cos, tan, exp, expm1, log, where) that fit the given scalars.

    Examples
    --------
    >>> namespace(4.0).sqrt(4.0)
    2.0
    """
    for value in values:
        if type(value) is not float:
            break
    else:  # asked at each root that plain numbers take
        return _Python
    others = [value for value in leaves(values) if type(value) is not float and not is_number(value)]
    if not others:
        return _Python
    kinds = {type(value).__name__ for value in others}
    if "Jet" in kinds:
        from .jets import JetFunctions

        return JetFunctions(namespace(*(value.value if type(value).__name__ == "Jet" else value for value in others)))
    if "Dual" in kinds:
        from .duals import DualFunctions

        return DualFunctions
    if any(getattr(getattr(value, "dtype", None), "kind", "") == "c" for value in others):
        return _ComplexStep(sys.modules["numpy"])
    for value in others:
        if hasattr(value, "__array_namespace__"):
            return value.__array_namespace__()
        if hasattr(type(value), "scalar_functions"):
            return type(value).scalar_functions()
        package = type(value).__module__.partition(".")[0]
        if package in _SYMBOLIC:
            return _SYMBOLIC[package]()
    return _Python


_SYMBOLIC = {"heyoka": _Heyoka, "sympy": _SymPy, "mpmath": _Mpmath}


def less(a: Any, b: Any) -> Any:
    """Compare two scalars, a < b, in the form that `where` of their namespace takes.

    Examples
    --------
    >>> less(1.0, 2.0)
    True
    """
    heyoka = sys.modules.get("heyoka")
    if heyoka is not None and (isinstance(a, heyoka.expression) or isinstance(b, heyoka.expression)):
        return heyoka.lt(a, b)
    return a < b
