"""The functions that coefficients may be made of, and how they are written before they are taken apart."""

from __future__ import annotations

from math import lcm
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from ...errors import InvalidValueError

WHAT_MAY_STAND = (
    "Allowed are numbers, symbols, + − × ÷, integer powers, square roots, and sin, cos, tan, sinh, cosh, tanh and exp "
    "of sums of products of symbols."
)


def prepare(expression: Any) -> sp.Expr:
    """Write an expression in the functions that the field knows: sin, cos, exp, powers.

    Examples
    --------
    >>> prepare(sp.tan(sp.Symbol("x")))
    sin(x)/cos(x)
    """
    e = sp.sympify(expression)
    if not isinstance(e, sp.Expr):
        raise refusal(e)
    if e.has(sp.Float):
        remedy = "Write it as sympy.Rational(1, 10) or as a symbol."
        raise InvalidValueError("constraints", "must hold exact numbers only", str(e), remedy)
    for old, new in (
        (sp.tan, lambda z: sp.sin(z) / sp.cos(z)),
        (sp.cot, lambda z: sp.cos(z) / sp.sin(z)),
        (sp.sec, lambda z: 1 / sp.cos(z)),
        (sp.csc, lambda z: 1 / sp.sin(z)),
        (sp.sinh, lambda z: (sp.exp(z) - sp.exp(-z)) / 2),
        (sp.cosh, lambda z: (sp.exp(z) + sp.exp(-z)) / 2),
        (sp.tanh, lambda z: (sp.exp(2 * z) - 1) / (sp.exp(2 * z) + 1)),
    ):
        if e.has(old):
            e = e.replace(old, new)
    _check_made_of(e)
    return e


def on_circles(expression: sp.Expr) -> sp.Expr:
    """Expand, and put 1 − cos² for every sin²: quick, and enough for products of rotations.

    Examples
    --------
    >>> x, y = sp.symbols("x y")
    >>> on_circles(y * sp.sin(x) ** 2 + y * sp.cos(x) ** 2)
    y
    """
    e = sp.expand(expression)
    for sine in sorted(e.atoms(sp.sin), key=str):
        cosine = sp.cos(sine.args[0])
        e = sp.expand(
            e.replace(
                lambda p, s=sine: p.is_Pow and p.base == s and p.exp.is_Integer and p.exp > 1,
                lambda p, s=sine, c=cosine: (1 - c**2) ** (p.exp // 2) * s ** (p.exp % 2),
            )
        )
    return e


def _check_made_of(e: sp.Expr) -> None:
    for part in sp.preorder_traversal(e):
        if part in (sp.zoo, sp.oo, -sp.oo, sp.nan):
            raise InvalidValueError("constraints", "must be finite", str(e), "A coefficient divides by zero.")
        fine = (
            part.is_Rational
            or part.is_Symbol
            or part is sp.pi
            or part.is_Add
            or part.is_Mul
            or isinstance(part, (sp.sin, sp.cos, sp.exp))
            or (part.is_Pow and part.exp.is_Rational and part.exp.q in (1, 2))
        )
        if not fine or (isinstance(part, (sp.sin, sp.cos, sp.exp)) and not _plain(part.args[0])):
            raise refusal(part)


def _plain(argument: sp.Expr) -> bool:
    """Whether an argument is a sum of products of powers of symbols: no two of them then depend on each other."""
    return all(
        all(
            factor.is_Symbol or (factor.is_Pow and factor.base.is_Symbol and factor.exp.is_Integer)
            for factor in sp.Mul.make_args(base)
        )
        for _, base in terms(argument)
    )


def terms(argument: sp.Expr) -> list[tuple[sp.Rational, sp.Expr]]:
    """Split an argument into rational multiples of products."""
    return [term.as_coeff_Mul(rational=True) for term in sp.Add.make_args(sp.expand(argument))]


def kernels(prepared: list[sp.Expr]) -> tuple[dict[sp.Expr, int], dict[sp.Expr, int], set[sp.Expr]]:
    """Collect bases of angles and of exponents, each with its common denominator, and radicands."""
    angles: dict[sp.Expr, int] = {}
    powers: dict[sp.Expr, int] = {}
    roots: set[sp.Expr] = set()
    for e in prepared:
        for part in sp.preorder_traversal(e):
            if isinstance(part, (sp.sin, sp.cos, sp.exp)):
                kind = powers if isinstance(part, sp.exp) else angles
                for number, base in terms(part.args[0]):
                    kind[base] = lcm(kind.get(base, 1), int(number.q))
            elif part.is_Pow and part.exp.is_Rational and part.exp.q == 2:
                roots.add(part.base)
    return angles, powers, roots


def constants(e: sp.Expr) -> set[sp.Expr]:
    """Return the symbols of an expression, and π if it holds it."""
    return set(e.free_symbols) | ({sp.pi} if e.has(sp.pi) else set())


def refusal(part: Any) -> InvalidValueError:
    """Return what is raised for a part that cannot be decided exactly."""
    if isinstance(part, AppliedUndef):
        return InvalidValueError("constraints", "must hold known functions only", str(part), WHAT_MAY_STAND)
    return InvalidValueError("constraints", "must be of a kind that can be decided exactly", str(part), WHAT_MAY_STAND)
