"""Exact arithmetic with the coefficients of constraints: rational functions of quantities that no equation links.

A coefficient such as cos φ / (1 + sin² φ) is a rational function of u = tan(φ/2); another may hold an exponential or
a square root. Each such quantity becomes one generator of a field of rational functions, with known derivatives, and
the generators are algebraically independent (square roots but for their own equation). So an expression is zero
exactly if its numerator is, and no simplification has to be trusted.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import combinations
from typing import Any

import sympy as sp
from sympy.polys.fields import FracField

from ...errors import InvalidValueError
from .functions import constants, kernels, on_circles, prepare, refusal, terms

LONGEST = 120  # operations; to make longer expressions short takes longer than to decide with them
PRIME = (1 << 61) - 1  # probes are taken modulo this prime: what is not zero there is not zero at all


class Tower:
    """The field in which the coefficients of one constraint system live.

    Parameters
    ----------
    expressions : iterable of sympy.Expr
        Everything that will be converted must be made of the same functions.
    coordinates : sequence of sympy.Symbol
        The coordinates; every other symbol is a constant.

    Examples
    --------
    >>> phi = sp.Symbol("phi")
    >>> tower = Tower([sp.sin(phi), sp.cos(phi)], [phi])
    >>> tower.is_zero(tower(sp.sin(phi) ** 2 + sp.cos(phi) ** 2 - 1))
    True
    """

    def __init__(self, expressions: Iterable[sp.Expr], coordinates: Sequence[sp.Symbol]) -> None:
        self.coordinates = tuple(coordinates)
        prepared = [prepare(expression) for expression in expressions]
        angles, powers, roots = kernels(prepared)
        symbols = sorted({s for e in prepared for s in constants(e)} | set(self.coordinates), key=str)
        names = [str(s) for s in symbols] + [f"_{i}" for i in range(len(angles) + len(powers) + len(roots))]
        self._field = FracField(names, sp.QQ, sp.polys.orderings.lex)
        gens = list(self._field.gens)
        self._symbols = dict(zip(symbols, gens, strict=False))
        rest = iter(gens[len(symbols) :])
        self._angles = {base: (next(rest), parts) for base, parts in angles.items()}
        self._powers = {base: (next(rest), parts) for base, parts in powers.items()}
        self._roots: dict[sp.Expr, Any] = {}
        self._radicands: list[tuple[Any, Any]] = []
        for base in sorted(roots, key=sp.count_ops):
            self._roots[base] = next(rest)
            self._radicands.append((self._roots[base], self(base, prepared=True)))
        self._check_roots()
        self._derivatives = [self._chain(coordinate) for coordinate in self.coordinates]
        draw = random.Random(20)  # noqa: S311  a fixed seed: the same answer every time
        self._probe = [draw.randrange(1, PRIME) for _ in gens]

    @property
    def zero(self) -> Any:
        """The element 0."""
        return self._field.zero

    @property
    def one(self) -> Any:
        """The element 1."""
        return self._field.one

    def __call__(self, expression: Any, prepared: bool = False) -> Any:
        """Convert an expression to an element of the field."""
        return self._convert(sp.sympify(expression) if prepared else prepare(expression))

    def _convert(self, e: sp.Expr) -> Any:
        if e.is_Rational:
            return self._field.ground_new(sp.QQ(e.p, e.q))
        if e in self._symbols:
            return self._symbols[e]
        if e.is_Add or e.is_Mul:
            parts = [self._convert(part) for part in e.args]
            whole = parts[0]
            for part in parts[1:]:
                whole = whole + part if e.is_Add else whole * part
            return whole
        if isinstance(e, sp.exp):
            return self._exponential(e.args[0])
        if e.is_Pow:
            return self._power(*e.as_base_exp())
        if isinstance(e, (sp.sin, sp.cos)):
            c, s = self._turn(e.args[0])
            return s if isinstance(e, sp.sin) else c
        raise refusal(e)

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> Any:
        if exponent.is_Integer:
            element, count = self._convert(base), int(exponent)
        else:
            element, count = self._roots[base], int(2 * exponent)
        if count < 0 and self.is_zero(element):
            raise InvalidValueError("constraints", "must not divide by zero", str(base**exponent))
        return element**count

    def _exponential(self, argument: sp.Expr) -> Any:
        whole = self.one
        for number, base in terms(argument):
            element, parts = self._powers[base]
            whole = whole * element ** int(number * parts)
        return whole

    def _turn(self, argument: sp.Expr) -> tuple[Any, Any]:
        """Return cos and sin of an angle from the tangents of its parts' halves."""
        cosine, sine = self.one, self.zero
        for number, base in terms(argument):
            u, parts = self._angles[base]
            c, s = (1 - u**2) / (1 + u**2), 2 * u / (1 + u**2)
            count = int(number * parts)
            s = s if count > 0 else -s
            for _ in range(abs(count)):
                cosine, sine = cosine * c - sine * s, sine * c + cosine * s
        return cosine, sine

    # Differentiation

    def _chain(self, coordinate: sp.Symbol) -> list[tuple[Any, Any]]:
        """Return each generator that depends on a coordinate, and its derivative."""
        chain = [(self._symbols[coordinate], self.one)]
        for base, (u, parts) in self._angles.items():
            chain.append((u, (1 + u**2) / 2 * self._convert(sp.diff(base, coordinate)) / parts))
        for base, (power, parts) in self._powers.items():
            chain.append((power, power * self._convert(sp.diff(base, coordinate)) / parts))
        for root, radicand in self._radicands:
            chain.append((root, _along(radicand, chain) / (2 * root)))
        return [(generator, rate) for generator, rate in chain if rate]

    def derivative(self, element: Any, index: int) -> Any:
        """Return the derivative along a coordinate, by its index."""
        return _along(element, self._derivatives[index])

    # Zero or not

    def is_zero(self, element: Any) -> bool:
        """Tell whether an element is zero, exactly."""
        return self._vanishes(element, len(self._radicands))

    def _vanishes(self, element: Any, roots: int) -> bool:
        if not element:
            return True
        if not roots:
            return False
        root, radicand = self._radicands[roots - 1]
        index = self._field.gens.index(root)
        halves = [self.zero, self.zero]  # of the numerator, less and with one factor of the root
        for monomial, coefficient in element.numer.terms():
            power = monomial[index]
            rest = self._field.ring.from_terms([((*monomial[:index], 0, *monomial[index + 1 :]), coefficient)])
            halves[power % 2] += self._field(rest) * radicand ** (power // 2)
        return all(self._vanishes(half, roots - 1) for half in halves)

    def _check_roots(self) -> None:
        """Refuse roots that are no roots: then their equation would have factors, and zero more than one meaning."""
        for count in range(1, len(self._radicands) + 1):
            for chosen in combinations(self._radicands, count):
                product = self.one
                for _, radicand in chosen:
                    product = product * radicand
                constant, factors = (product.numer * product.denom).factor_list()
                if all(power % 2 == 0 for _, power in factors) and sp.sqrt(sp.QQ.to_sympy(constant)).is_Rational:
                    names = ", ".join(f"sqrt({base})" for base, root in self._roots.items() if root in dict(chosen))
                    remedy = "Write its root with the sign that you mean, and each root once."
                    raise InvalidValueError("constraints", "must not hold a root of a perfect square", names, remedy)

    def probed(self, element: Any) -> int | None:
        """Return the value at a random point modulo a large prime; None where that cannot be had."""
        if self._radicands:
            return None
        below = _at(element.denom, self._probe)
        return _at(element.numer, self._probe) * pow(below, -1, PRIME) % PRIME if below else None

    def held(self, vector: tuple[Any, ...], here: dict[sp.Symbol, Any]) -> tuple[Any, ...]:
        """Put zero for some coordinates into the elements of a vector.

        Angles and exponents that hold such a coordinate are products with it, and so vanish with it.
        """
        values = []
        for symbol in here:
            values.append((self._symbols[symbol], 0))
            for bases, value in ((self._angles, 0), (self._powers, 1)):
                for base, (generator, _) in bases.items():
                    if symbol in base.free_symbols:
                        values.append((generator, value))
        held = []
        for element in vector:
            above, below = element.numer, element.denom
            for generator, value in values:
                above, below = above.subs(generator.numer, value), below.subs(generator.numer, value)
            if not below:
                remedy = "Take other coordinates there."
                raise InvalidValueError("values", "must be a place where the fields are finite", "a pole", remedy)
            held.append(self._field(above) / self._field(below))
        return tuple(held)

    # Back to expressions, and linear algebra over the constants

    def expression(self, element: Any) -> sp.Expr:
        """Write an element in SymPy's functions again."""
        written: dict[Any, sp.Expr] = {generator: symbol for symbol, generator in self._symbols.items()}
        for base, (generator, parts) in self._angles.items():
            written[generator] = sp.sin(base / parts) / (1 + sp.cos(base / parts))
        for base, (generator, parts) in self._powers.items():
            written[generator] = sp.exp(base / parts)
        for base, generator in self._roots.items():
            written[generator] = sp.sqrt(base)
        values = [written[generator] for generator in self._field.gens]
        return _summed(element.numer, values) / _summed(element.denom, values)

    def constant_relations(self, columns: Sequence[Sequence[Any]]) -> list[list[sp.Expr]]:
        """Find the constant coefficients c_k with Σ c_k column_k = 0, where each column holds elements.

        The elements of each row are brought to one denominator; then each product of what varies gives an equation.
        """
        varying = self._varying()
        equations: dict[Any, dict[int, Any]] = {}
        for place in range(len(columns[0])):
            entries = [column[place] for column in columns]
            below = self.one.numer
            for entry in entries:
                below = below.lcm(entry.denom)
            for k, entry in enumerate(entries):
                numerator = self._reduced(entry.numer * below.exquo(entry.denom))
                for monomial, coefficient in numerator.terms():
                    key = (place, *(m if v else 0 for m, v in zip(monomial, varying, strict=True)))
                    rest = tuple(0 if v else m for m, v in zip(monomial, varying, strict=True))
                    constant = self._field(self._field.ring.from_terms([(rest, coefficient)]))
                    row = equations.setdefault(key, {})
                    row[k] = row.get(k, self.zero) + constant
        return self._null_space(list(equations.values()), len(columns))

    def _varying(self) -> list[bool]:
        moved = {generator for chain in self._derivatives for generator, _ in chain}
        return [generator in moved for generator in self._field.gens]

    def _reduced(self, numerator: Any) -> Any:
        """Lower the powers of roots where their radicand is a polynomial; where it is not, leave them."""
        for root, radicand in self._radicands:
            if radicand.denom == 1:
                numerator = numerator.rem(root.numer**2 - radicand.numer)
        return numerator

    def _null_space(self, equations: list[dict[int, Any]], size: int) -> list[list[sp.Expr]]:
        solved: dict[int, dict[int, Any]] = {}  # pivot -> its row without the pivot, reduced
        for equation in equations:
            row = {k: value for k, value in equation.items() if value}
            for pivot, other in solved.items():
                if factor := row.pop(pivot, None):
                    _subtract(row, other, factor)
            if not row:
                continue
            pivot = max(row)
            scale = row.pop(pivot)
            row = {k: value / scale for k, value in row.items()}
            for other in solved.values():
                if factor := other.pop(pivot, None):
                    _subtract(other, row, factor)
            solved[pivot] = row
        basis = []
        for free in range(size):
            if free not in solved:
                solution = [self.zero] * size
                solution[free] = self.one
                for pivot, row in solved.items():
                    solution[pivot] = -row.get(free, self.zero)
                basis.append([self.expression(entry) for entry in _cleared(solution)])
        return basis


def _subtract(row: dict[int, Any], other: dict[int, Any], factor: Any) -> None:
    for k, value in other.items():
        left = row.pop(k, factor.field.zero) - factor * value
        if left:
            row[k] = left


def _cleared(solution: list[Any]) -> list[Any]:
    """Multiply by the common denominator."""
    below = solution[0].field.one.numer
    for entry in solution:
        below = below.lcm(entry.denom)
    return [entry * solution[0].field(below) for entry in solution]


def _summed(polynomial: Any, values: list[sp.Expr]) -> sp.Expr:
    return sp.Add(
        *(
            sp.QQ.to_sympy(coefficient) * sp.Mul(*(v**p for v, p in zip(values, monomial, strict=True)))
            for monomial, coefficient in polynomial.terms()
        )
    )


def _along(element: Any, chain: list[tuple[Any, Any]]) -> Any:
    total = element.field.zero
    for generator, rate in chain:
        slope = element.diff(generator)
        if slope:
            total = total + slope * rate
    return total


def _at(polynomial: Any, values: list[int]) -> int:
    total = 0
    for monomial, coefficient in polynomial.terms():
        term = int(coefficient.numerator) * pow(int(coefficient.denominator), -1, PRIME)
        for value, power in zip(values, monomial, strict=True):
            if power:
                term = term * pow(value, power, PRIME) % PRIME
        total += term
    return total % PRIME


@lru_cache(maxsize=512)
def tidy(expression: sp.Expr) -> sp.Expr:
    """Write an expression shorter where SymPy can, in functions that the field knows; the same function always.

    Examples
    --------
    >>> x = sp.Symbol("x")
    >>> tidy(sp.sin(x) ** 2 + sp.cos(x) ** 2 + x / x**2)
    (x + 1)/x
    """
    longer = on_circles(expression)
    plain = not longer.has(sp.sin, sp.cos)
    if not plain and longer.count_ops() > LONGEST:
        return sp.factor_terms(longer)
    short = sp.factor_terms(sp.cancel(longer if plain else sp.trigsimp(longer)))
    if plain or short == longer:
        return short
    try:
        tower = Tower([short, longer], [])
        return short if tower.is_zero(tower(short) - tower(longer)) else longer
    except InvalidValueError:
        return longer
