"""Whether an expression is zero, decided by polynomial algebra: a proof, not a guess of `simplify`.

Sines, exponentials, roots and other functions are taken as unknowns of their own, and the relations between them
(sin² + cos² = 1, a root squared, i² = −1, sn² + cn² = 1, dn² + m sn² = 1) are put in as squares. What then vanishes
as a polynomial is zero. The test can miss a zero that needs another relation; it never takes a non-zero for zero.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any


def exact(expression: Any) -> Any:
    """Return an expression with its floats, such as the 0.5 and 2.0 of the algebra, as the rationals they are.

    Examples
    --------
    >>> import sympy
    >>> exact(0.5 * sympy.Symbol("x"))
    x/2
    """
    import sympy as sp

    return _rebuilt(sp.sympify(expression), lambda part: sp.Rational(float(part)) if part.is_Float else part)


def _rebuilt(expression: Any, change: Callable[[Any], Any]) -> Any:
    """Change an expression from its leaves up, what occurs many times only once."""
    memory: dict[Any, Any] = {}

    def visit(part: Any) -> Any:
        if part not in memory:
            arguments = [visit(argument) for argument in part.args]
            same = all(new is old for new, old in zip(arguments, part.args, strict=True))
            memory[part] = change(part if same else part.func(*arguments))
        return memory[part]

    return visit(expression)


def numerator(expression: Any, squares: Mapping[Any, Any] | None = None) -> Any:
    """Return the numerator of an expression in normal form: 0 if and only if the relations known here make it zero.

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

    Examples
    --------
    >>> import sympy
    >>> x = sympy.Symbol("x")
    >>> is_zero(sympy.exp(sympy.I * x) - sympy.cos(x) - sympy.I * sympy.sin(x))
    True
    """
    return bool(numerator(expression, squares) == 0)


def normal_form(expression: Any, squares: Mapping[Any, Any] | None = None) -> Any:
    """Return an expression as one quotient in lowest terms, with the relations known here put in.

    Examples
    --------
    >>> import sympy
    >>> x, y = sympy.symbols("x y")
    >>> normal_form((sympy.sin(y) ** 2 + sympy.cos(y) ** 2) * (x**2 - 1) / (x - 1))
    x + 1
    """
    from .polynomials import Quotients

    plain, known, names = _unknowns(with_plain_roots(exact(expression)), dict(squares or {}))
    return Quotients(plain, known).expression.xreplace(names)


def with_plain_roots(expression: Any) -> Any:
    """Return an expression with each square root of a polynomial taken of its normal form, so that equal roots meet.

    Examples
    --------
    >>> import sympy
    >>> x, y, t = sympy.symbols("x y t", real=True)
    >>> c, s = sympy.cos(t), sympy.sin(t)
    >>> with_plain_roots(1 / sympy.sqrt((c * x - s * y) ** 2 + (s * x + c * y) ** 2))
    1/sqrt(x**2 + y**2)
    """
    import sympy as sp

    from .polynomials import Quotients

    def plain(base: Any) -> Any:
        rational, known, names = _unknowns(base, {})
        quotients = Quotients(rational, known)
        return quotients.numerator.xreplace(names) if quotients.is_polynomial else base

    def change(part: Any) -> Any:
        if part.is_Pow and part.exp.is_Rational and not part.exp.is_Integer:
            return sp.Pow(plain(part.base), part.exp)
        return part

    return _rebuilt(expression, change)


def _unknowns(expression: Any, squares: dict[Any, Any]) -> tuple[Any, dict[Any, Any], dict[Any, Any]]:
    """Put symbols in the place of functions and roots; return also their squares, and the way back."""
    import sympy as sp

    from .jacobi import squares_of

    expression = expression.replace(sp.exp, _exponential).replace(sp.tanh, lambda u: sp.sinh(u) / sp.cosh(u))
    names: dict[Any, Any] = {}
    known = dict(squares)

    def unknown(thing: Any) -> Any:
        return names.setdefault(thing, sp.Dummy(real=True))

    memory: dict[Any, Any] = {}

    def visit(part: Any) -> Any:
        if part not in memory:
            memory[part] = visited(part)
        return memory[part]

    def visited(part: Any) -> Any:
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
