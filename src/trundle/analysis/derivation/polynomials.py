"""Quotients of polynomials in many symbols, some with known squares: quick, where SymPy's own forms are slow."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp
from sympy.polys.rings import PolyElement, ring

Factors = dict[PolyElement, int]


class Quotients:
    """A rational expression over one common denominator, which is kept in factors.

    Parameters
    ----------
    expression : sympy.Expr
        Made of symbols, rationals, sums, products and whole powers.
    squares : mapping
        What the square of a symbol is.

    Raises
    ------
    ZeroDivisionError
        If a denominator is zero.

    Examples
    --------
    >>> x, s = sp.symbols("x s")
    >>> Quotients(1 / s - s / (1 + x), {s: 1 + x}).numerator
    0
    """

    def __init__(self, expression: Any, squares: Mapping[Any, Any]) -> None:
        symbols = set(expression.free_symbols).union(*(square.free_symbols for square in squares.values()), squares)
        ordered = sorted(symbols, key=lambda symbol: symbol.sort_key())
        self._ring, *generators = ring(ordered or [sp.Dummy()], sp.QQ)
        self._generator = dict(zip(ordered, generators, strict=False))
        self._known: list[tuple[int, PolyElement]] = []
        self._memory: dict[Any, tuple[PolyElement, Factors]] = {}
        for symbol, square in squares.items():
            value, below = self._quotient(sp.sympify(square))
            if below:
                raise ValueError(f"the square of {symbol} must be a polynomial; it is {square}")
            self._known.append((ordered.index(symbol), value))
        self._memory.clear()
        self._above, self._below = self._quotient(expression)

    @property
    def numerator(self) -> Any:
        """What stands over the common denominator; 0 where the expression is 0."""
        return self._above.as_expr()

    @property
    def expression(self) -> Any:
        """The quotient in lowest terms."""
        above, below = self._above, self._ring.one
        for factor, times in self._below.items():
            for _ in range(times):
                common = above.gcd(factor)
                above, below = above.exquo(common), below * factor.exquo(common)
        return above.as_expr() / below.as_expr()

    @property
    def is_polynomial(self) -> bool:
        """Whether there is no common denominator."""
        return not self._below

    def _quotient(self, expression: Any) -> tuple[PolyElement, Factors]:
        if expression not in self._memory:
            self._memory[expression] = self._worked_out(expression)
        return self._memory[expression]

    def _worked_out(self, expression: Any) -> tuple[PolyElement, Factors]:
        if expression.is_Rational:
            return self._ring.ground_new(sp.QQ(expression.p, expression.q)), {}
        if expression.is_Symbol:
            return self._generator[expression], {}
        if expression.is_Add:
            return self._sum([self._quotient(term) for term in expression.args])
        if expression.is_Mul:
            above = self._ring.one
            below: Factors = {}
            for factor in expression.args:
                value, under = self._quotient(factor)
                above = self._reduced(above * value)
                below = _product(below, under)
            return above, below
        if expression.is_Pow and expression.exp.is_Integer:
            above, below = self._quotient(expression.base)
            power = int(expression.exp)
            if power < 0:
                above, below = self._inverse(above, below)
            result = self._ring.one
            for _ in range(abs(power)):
                result = self._reduced(result * above)
            return result, {factor: abs(power) * times for factor, times in below.items()}
        raise TypeError(f"{expression} is no rational expression")

    def _sum(self, terms: list[tuple[PolyElement, Factors]]) -> tuple[PolyElement, Factors]:
        common: Factors = {}
        for _, below in terms:
            for factor, times in below.items():
                common[factor] = max(common.get(factor, 0), times)
        above = self._ring.zero
        for value, below in terms:
            part = value
            for factor, times in common.items():
                for _ in range(times - below.get(factor, 0)):
                    part = self._reduced(part * factor)
            above += part
        return above, common if above else {}

    def _inverse(self, above: PolyElement, below: Factors) -> tuple[PolyElement, Factors]:
        if not above:
            raise ZeroDivisionError("a denominator is zero")
        result = self._ring.ground_new(1 / above.LC)
        for factor, times in below.items():
            for _ in range(times):
                result = self._reduced(result * factor)
        shared = [min(powers) for powers in zip(*above.monoms(), strict=True)]
        factors: Factors = {}
        rest = above.monic()
        if any(shared):
            rest = self._ring.from_dict(
                {tuple(n - s for n, s in zip(powers, shared, strict=True)): c for powers, c in rest.terms()}
            )
            factors = {self._ring.gens[i]: times for i, times in enumerate(shared) if times}
        return result, _product(factors, {} if rest == 1 else {rest: 1})

    def _reduced(self, polynomial: PolyElement) -> PolyElement:
        """Put in the squares until each symbol that has one occurs at most once in a product."""
        again = bool(self._known)
        while again:
            again = False
            for i, square in self._known:
                if polynomial and max(powers[i] for powers in polynomial) >= 2:
                    polynomial, again = self._with_square(polynomial, i, square), True
        return polynomial

    def _with_square(self, polynomial: PolyElement, i: int, square: PolyElement) -> PolyElement:
        by_power: dict[int, dict[tuple[int, ...], Any]] = {}
        for powers, coefficient in polynomial.terms():
            half, odd = divmod(powers[i], 2)
            by_power.setdefault(half, {})[(*powers[:i], odd, *powers[i + 1 :])] = coefficient
        result, power, done = self._ring.zero, self._ring.one, 0
        for half in sorted(by_power):
            for _ in range(half - done):
                power *= square
            done = half
            result += self._ring.from_dict(by_power[half]) * power
        return result


def _product(one: Factors, other: Factors) -> Factors:
    result = dict(one)
    for factor, times in other.items():
        result[factor] = result.get(factor, 0) + times
    return result
