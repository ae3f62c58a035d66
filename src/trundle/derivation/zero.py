"""Whether an expression is zero, decided by polynomial algebra: a proof, not a guess of `simplify`.

Sines, exponentials, roots and other functions are taken as unknowns of their own, and the relations between them
(sin² + cos² = 1, a root squared, i² = −1, sn² + cn² = 1, dn² + m sn² = 1) are put in as squares. What then vanishes
as a polynomial is zero. The test can miss a zero that needs another relation; it never takes a non-zero for zero.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def exact(expression: Any) -> Any:
    """Return an expression with its floats, such as the 0.5 and 2.0 of the algebra, as the rationals they are.

    Parameters
    ----------
    expression : sympy expression or number
        Anything the mechanics returns.

    Returns
    -------
    sympy.Expr
        The same without floats.

    Examples
    --------
    >>> import sympy
    >>> exact(0.5 * sympy.Symbol("x"))
    x/2
    """
    import sympy as sp

    expression = sp.sympify(expression)
    return expression.xreplace({number: sp.Rational(float(number)) for number in expression.atoms(sp.Float)})


def numerator(expression: Any, squares: Mapping[Any, Any] | None = None) -> Any:
    """Return the numerator of an expression in normal form: 0 if and only if the relations known here make it zero.

    Parameters
    ----------
    expression : sympy expression
        A rational function of symbols, functions and roots.
    squares : mapping, optional
        What the square of a symbol is, such as that of the first component of a unit quaternion.

    Returns
    -------
    sympy.Expr
        Expanded.

    Raises
    ------
    ZeroDivisionError
        If a denominator is zero.

    Examples
    --------
    >>> import sympy
    >>> x, y = sympy.symbols("x y")
    >>> numerator(1 / (1 + x) - (1 - x) / (1 - x**2))
    0
    >>> numerator(sympy.sin(y) ** 2 - 1)
    -cos(y)**2
    """
    import sympy as sp

    from .polynomials import Quotients

    expression = exact(expression)
    if expression.has(sp.nan, sp.zoo, sp.oo):
        raise ZeroDivisionError(f"{expression} has no value")
    plain, known, names = _unknowns(expression, dict(squares or {}))
    return Quotients(plain, known).numerator.xreplace(names)


def is_zero(expression: Any, squares: Mapping[Any, Any] | None = None) -> bool:
    """Tell whether an expression is zero.

    Parameters
    ----------
    expression, squares
        As for `numerator`.

    Returns
    -------
    bool
        True is proved; False means that it is not zero, or that a relation is missing here.

    Examples
    --------
    >>> import sympy
    >>> x = sympy.Symbol("x")
    >>> is_zero(sympy.exp(sympy.I * x) - sympy.cos(x) - sympy.I * sympy.sin(x))
    True
    """
    return bool(numerator(expression, squares) == 0)


def _unknowns(expression: Any, squares: dict[Any, Any]) -> tuple[Any, dict[Any, Any], dict[Any, Any]]:
    """Put symbols in the place of functions and roots; return also their squares, and the way back."""
    import sympy as sp

    from .jacobi import squares_of

    expression = expression.replace(sp.exp, _exponential).replace(sp.tanh, lambda u: sp.sinh(u) / sp.cosh(u))
    names: dict[Any, Any] = {}
    known = dict(squares)

    def unknown(thing: Any) -> Any:
        return names.setdefault(thing, sp.Dummy(real=True))

    def visit(part: Any) -> Any:
        if part is sp.I:
            known[unknown(part)] = sp.Integer(-1)
            return unknown(part)
        if part.is_Atom:
            return part
        if part.is_Pow and part.exp.is_Rational and not part.exp.is_Integer:
            root = sp.Pow(part.base, sp.Rational(1, part.exp.q))
            symbol = unknown(root)
            if part.exp.q == 2:
                known[symbol] = visit(part.base)
            return symbol**part.exp.p
        if part.is_Function or part.is_Derivative:
            if isinstance(part, (sp.sin, sp.cos)):
                part = part.func(sp.factor(part.args[0]))
            symbol = unknown(part)
            if isinstance(part, sp.sin):
                known[symbol] = 1 - unknown(sp.cos(part.args[0])) ** 2
            for square_of, value in squares_of(part):
                known[unknown(square_of)] = visit(value)
            return symbol
        return part.func(*(visit(argument) for argument in part.args))

    plain = visit(expression)
    return plain, known, {symbol: thing for thing, symbol in names.items()}


def _exponential(power: Any) -> Any:
    """Write e to a complex power by sine and cosine, and e to a sum as a product."""
    import sympy as sp

    real, imaginary = sp.expand(power).as_independent(sp.I, as_Add=True)
    turned = sp.expand(-sp.I * imaginary)
    growth = sp.Mul(*(sp.exp(sp.factor(term), evaluate=False) for term in sp.Add.make_args(real) if term != 0))
    return growth if turned == 0 else growth * (sp.cos(sp.factor(turned)) + sp.I * sp.sin(sp.factor(turned)))
