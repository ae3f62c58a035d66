"""Vector equations as SymPy expressions, so that what is printed is what is put to the proof.

A vector is a 3×1 matrix symbol; sums keep the order in which they are written.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp
from sympy.printing.pretty.stringpict import prettyForm


def vector(name: str) -> Any:
    """Return a vector by its name, in which `dot`, `ddot` and `hat` are accents.

    Examples
    --------
    >>> sp.pretty(vector("Omegadot"), use_unicode=True)
    'Ω̇'
    """
    return sp.MatrixSymbol(name, 3, 1)


class Cross(sp.MatrixExpr):
    """The vector product of two vectors, left as it is written.

    Examples
    --------
    >>> sp.pretty(Cross(vector("n"), vector("R")), use_unicode=True)
    'n×R'
    """

    shape = (sp.Integer(3), sp.Integer(1))

    def __new__(cls, left: Any, right: Any) -> Any:
        """Hold both factors."""
        return sp.Expr.__new__(cls, left, right)

    def _factors(self, printer: Any) -> Any:
        for factor in self.args:
            yield isinstance(factor, (sp.MatAdd, sp.MatMul)) or type(factor) is Cross, printer._print(factor)

    def _latex(self, printer: Any) -> str:
        parts = [rf"\left({text}\right)" if bracket else text for bracket, text in self._factors(printer)]
        return r" \times ".join(parts)

    def _pretty(self, printer: Any) -> Any:
        parts = [prettyForm(*form.parens()) if bracket else form for bracket, form in self._factors(printer)]
        return prettyForm(*prettyForm(*parts[0].right("×")).right(parts[1]), binding=prettyForm.MUL)

    def _sympystr(self, printer: Any) -> str:
        return f"cross({', '.join(printer._print(factor) for factor in self.args)})"


class Dot(sp.Expr):
    """The scalar product of two vectors, left as it is written.

    Examples
    --------
    >>> sp.pretty(Dot(vector("n"), vector("R")), use_unicode=True)
    '(n·R)'
    """

    is_commutative = True

    def __new__(cls, left: Any, right: Any) -> Any:
        """Hold both factors."""
        return sp.Expr.__new__(cls, left, right)

    def _latex(self, printer: Any) -> str:
        return rf"\left({printer._print(self.args[0])} \cdot {printer._print(self.args[1])}\right)"

    def _pretty(self, printer: Any) -> Any:
        left, right = (printer._print(factor) for factor in self.args)
        return prettyForm(*prettyForm(*prettyForm(*left.right("·")).right(right)).parens())

    def _sympystr(self, printer: Any) -> str:
        return f"dot({', '.join(printer._print(factor) for factor in self.args)})"


class Times(Cross):
    """A matrix times a vector, left as it is written.

    Examples
    --------
    >>> sp.pretty(Times(sp.MatrixSymbol("J", 3, 3), vector("Omega")), use_unicode=True)
    'J⋅Ω'
    """

    def _latex(self, printer: Any) -> str:
        parts = [rf"\left({text}\right)" if bracket else text for bracket, text in self._factors(printer)]
        return r" \, ".join(parts)

    def _pretty(self, printer: Any) -> Any:
        parts = [prettyForm(*form.parens()) if bracket else form for bracket, form in self._factors(printer)]
        return prettyForm(*prettyForm(*parts[0].right("⋅")).right(parts[1]), binding=prettyForm.MUL)

    def _sympystr(self, printer: Any) -> str:
        return "*".join(printer._print(factor) for factor in self.args)


def total(*terms: Any) -> Any:
    """Add terms, scalars or vectors, in the order in which they are given; known zeros drop out.

    Examples
    --------
    >>> x, y = sp.symbols("x y")
    >>> sp.pretty(total(y, 0, x), order="none")
    'y + x'
    """
    given = [part for term in map(sp.sympify, terms) for part in (term.args if term.is_Add else (term,))]
    kept = [term for term in given if term != 0]
    if len(kept) < 2:
        return kept[0] if kept else sp.Integer(0)
    if any(getattr(term, "is_Matrix", False) for term in kept):
        return sp.MatAdd(*kept)
    return sp.Add(*kept, evaluate=False)


def times(factor: Any, v: Any) -> Any:
    """Return a multiple of a vector as it is written; a multiple of a multiple is one multiple.

    Examples
    --------
    >>> sp.pretty(times(-1, times(sp.Symbol("m"), vector("V"))), use_unicode=True)
    '-m⋅V'
    """
    if isinstance(v, sp.MatMul):
        return times(factor * sp.Mul(*v.args[:-1]), v.args[-1])
    return v if factor == 1 else sp.MatMul(sp.sympify(factor), v)


def evaluate(expression: Any, values: Mapping[Any, Any]) -> Any:
    """Put values in the place of vectors and scalars.

    Examples
    --------
    >>> n, R = vector("n"), vector("R")
    >>> evaluate(Cross(n, R), {n: sp.Matrix([0, 0, 1]), R: sp.Matrix(sp.symbols("R_x:z"))}).T
    Matrix([[-R_y, R_x, 0]])
    """
    if isinstance(expression, sp.MatrixSymbol):
        return values[expression]
    if isinstance(expression, Times):
        left, right = (evaluate(factor, values) for factor in expression.args)
        return left * right
    if isinstance(expression, Cross):
        left, right = (evaluate(factor, values) for factor in expression.args)
        return left.cross(right)
    if isinstance(expression, Dot):
        left, right = (evaluate(factor, values) for factor in expression.args)
        return (left.T * right)[0, 0]
    if isinstance(expression, sp.MatAdd):
        parts = [evaluate(part, values) for part in expression.args]
        return sum(parts[1:], parts[0])
    if isinstance(expression, sp.MatMul):
        scale, result = sp.Integer(1), None
        for part in expression.args:
            value = evaluate(part, values)
            if isinstance(value, sp.MatrixBase):
                result = value if result is None else result * value
            else:
                scale *= value
        return scale if result is None else result * scale
    if isinstance(expression, sp.ZeroMatrix):
        return sp.zeros(3, 1)
    if isinstance(expression, sp.MatrixBase):
        return sp.Matrix(expression).applyfunc(lambda part: evaluate(part, values))
    products = {dot: evaluate(dot, values) for dot in expression.atoms(Dot)}
    scalars = {name: value for name, value in values.items() if not isinstance(name, sp.MatrixSymbol)}
    return expression.xreplace(products).xreplace(scalars)
