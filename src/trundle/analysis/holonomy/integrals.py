"""Functions that the constraints keep constant: found by undetermined coefficients, each proved before it is shown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations_with_replacement
from typing import Any

import sympy as sp

from .flag import Span, Vector
from .functions import prepare
from .tower import Tower, tidy

TERMS = 60  # candidates tried at once
POINTS = 3  # random places that stand for all, before an answer is proved


def integrals(tower: Tower, closed: Sequence[Vector], rows: Sequence[Sequence[sp.Expr]]) -> list[sp.Expr]:
    """Find functions that no motion along a closed set of fields changes.

    Examples
    --------
    >>> x, y = sp.symbols("x y")
    >>> tower = Tower([x, y], [x, y])
    >>> integrals(tower, [(tower(x), tower(-y))], [[y, x]])
    [x*y]
    """
    q = tower.coordinates
    wanted = len(q) - len(closed)
    rows = [[prepare(entry) for entry in row] for row in rows]
    found: list[sp.Expr] = [c for i, c in enumerate(q) if all(not vector[i] for vector in closed)]
    span = Span(tower)
    for function in found:
        span.add(_gradient(tower, function))
    search = (_sums, _factored)
    for method in search:
        if len(found) >= wanted:
            break
        for function in method(tower, closed, rows):
            if len(found) >= wanted:
                break
            try:
                gradient = _gradient(tower, function)
            except Exception:  # noqa: BLE001, S112  a candidate outside the field: SymPy's integrals may be anything
                continue
            if is_constant(tower, closed, gradient) and span.add(gradient):
                found.append(_normal(function, rows, q))
    return found


def _normal(function: sp.Expr, rows: Sequence[Sequence[sp.Expr]], q: Sequence[sp.Symbol]) -> sp.Expr:
    """Drop a rational factor and a sign, which mean nothing in f = const; a single row that is df keeps its own."""
    plain = sp.factor_terms(function).as_coeff_Mul(rational=True)[1]
    plain = sp.expand(plain).primitive()[1] if plain.is_Add else plain
    slopes = [(sp.diff(plain, c), entry) for c, entry in zip(q, rows[0], strict=True)]
    ratio = next((tidy(entry / slope) for slope, entry in slopes if slope != 0), sp.Integer(1))
    wrong = ratio.is_negative if len(rows) == 1 and ratio.is_number else plain.could_extract_minus_sign()
    return -plain if wrong else plain


def is_constant(tower: Tower, closed: Sequence[Vector], gradient: Vector) -> bool:
    """Prove that no field changes a function: df is then in the row space of the constraints."""
    for vector in closed:
        total = tower.zero
        for slope, component in zip(gradient, vector, strict=True):
            if slope and component:
                total = total + slope * component
        if not tower.is_zero(total):
            return False
    return True


def _gradient(tower: Tower, function: sp.Expr) -> Vector:
    return tuple(tower(sp.diff(function, q)) for q in tower.coordinates)


def _atoms(tower: Tower, rows: Iterable[Sequence[sp.Expr]]) -> tuple[list[sp.Expr], list[sp.Expr]]:
    """Return what appears in the constraints: coordinates and functions; and the factors of coefficients."""
    atoms: list[sp.Expr] = list(tower.coordinates)
    factors: list[sp.Expr] = []
    for row in rows:
        for entry in row:
            for part in sp.preorder_traversal(entry):
                if isinstance(part, (sp.sin, sp.cos, sp.exp)) and part.free_symbols & set(tower.coordinates):
                    angle = not isinstance(part, sp.exp)
                    twins = [sp.sin(part.args[0]), sp.cos(part.args[0])] if angle else [part, 1 / part]
                    atoms += [twin for twin in twins if twin not in atoms]
                if part.is_Pow and part.exp.is_Rational and part.exp.q == 2:
                    root = sp.sqrt(part.base)
                    atoms += [root] if root not in atoms else []
            for side in sp.fraction(sp.together(entry)):
                for factor in sp.Mul.make_args(sp.factor(side)):
                    base = factor.as_base_exp()[0]
                    if base.free_symbols & set(tower.coordinates) and base not in factors:
                        factors.append(base)
    return atoms, factors


def _sums(tower: Tower, closed: Sequence[Vector], rows: Sequence[Sequence[sp.Expr]]) -> Iterable[sp.Expr]:
    """Try sums of products of what appears, with constant coefficients; then logarithms of its factors besides."""
    atoms, factors = _atoms(tower, rows)
    logs = [sp.log(f) for f in dict.fromkeys([*factors, *tower.coordinates])]
    for degree, extra in ((1, []), (1, logs), (2, []), (2, logs), (3, [])):
        terms = [
            sp.Mul(*chosen) for count in range(1, degree + 1) for chosen in combinations_with_replacement(atoms, count)
        ]
        terms = list(dict.fromkeys(terms + extra))
        if len(terms) > TERMS:
            continue
        for coefficients in _constant_sums(tower, closed, terms):
            yield _readable(coefficients, terms)


def _constant_sums(tower: Tower, closed: Sequence[Vector], terms: Sequence[sp.Expr]) -> list[list[sp.Expr]]:
    """Return coefficients, free of coordinates, of the sums of terms that no field changes at random places."""
    slopes = []
    for term in terms:
        gradient = [sp.diff(term, q) for q in tower.coordinates]
        slopes.append(gradient)
    shared = Tower([entry for gradient in slopes for entry in gradient] + list(_used(tower, closed)), tower.coordinates)
    fields = [[shared(tower.expression(component)) for component in vector] for vector in closed]
    columns = []
    for gradient in slopes:
        entries = [shared(entry) for entry in gradient]
        columns.append([_dot(shared, entries, vector) for vector in fields])
    return shared.constant_relations(columns)


def _used(tower: Tower, closed: Sequence[Vector]) -> Iterable[sp.Expr]:
    return (tower.expression(component) for vector in closed for component in vector)


def _dot(tower: Tower, first: Sequence[Any], second: Sequence[Any]) -> Any:
    total = tower.zero
    for a, b in zip(first, second, strict=True):
        if a and b:
            total = total + a * b
    return total


def _readable(coefficients: Sequence[sp.Expr], terms: Sequence[sp.Expr]) -> sp.Expr:
    """Write a sum; one of logarithms alone as the product whose logarithm it is."""
    used = [(c, t) for c, t in zip(coefficients, terms, strict=True) if c != 0]
    if all(isinstance(t, sp.log) and c.is_Integer for c, t in used):
        return sp.Mul(*(t.args[0] ** c for c, t in used))
    return sp.Add(*(c * t for c, t in used))


def _factored(tower: Tower, closed: Sequence[Vector], rows: Sequence[Sequence[sp.Expr]]) -> Iterable[sp.Expr]:
    """Look for an integrating factor of a single constraint, a product of powers, and integrate."""
    if len(tower.coordinates) - len(closed) != 1:
        return
    form = _annihilator(tower, closed, rows)
    q = tower.coordinates
    atoms, factors = _atoms(tower, [form, *rows])
    terms = [sp.log(f) for f in dict.fromkeys([*factors, *q])] + [a for a in atoms if a.free_symbols & set(q)]
    pairs = [(i, j) for i in range(len(q)) for j in range(i)]
    # d(μω) = 0 is linear in log μ = Σ c_k b_k: dω + Σ c_k db_k∧ω = 0.
    columns_of = [[sp.diff(form[i], q[j]) - sp.diff(form[j], q[i]) for i, j in pairs]]
    for term in terms:
        slope = [sp.diff(term, c) for c in q]
        columns_of.append([slope[j] * form[i] - slope[i] * form[j] for i, j in pairs])
    shared = Tower([entry for column in columns_of for entry in column], q)
    for solution in shared.constant_relations([[shared(entry) for entry in column] for column in columns_of]):
        if solution[0] == 0:
            continue
        factor = sp.Mul(
            *(
                t.args[0] ** (c / solution[0]) if isinstance(t, sp.log) else sp.exp(c / solution[0] * t)
                for c, t in zip(solution[1:], terms, strict=True)
            )
        )
        yield _potential([sp.simplify(factor * part) for part in form], q)


def _annihilator(tower: Tower, closed: Sequence[Vector], rows: Sequence[Sequence[sp.Expr]]) -> list[sp.Expr]:
    """Return the one form that all fields satisfy, by the minors of the fields."""
    if len(rows) == 1:
        return list(rows[0])
    matrix = sp.Matrix([[tower.expression(component) for component in vector] for vector in closed])
    size = len(tower.coordinates)
    form = []
    for i in range(size):
        others = [j for j in range(size) if j != i]
        form.append((-1) ** i * matrix[:, others].det(method="berkowitz") if closed else sp.Integer(i == 0))
    return [tidy(part) for part in form]


def _potential(form: Sequence[sp.Expr], q: Sequence[sp.Symbol]) -> sp.Expr:
    """Integrate a closed form coordinate by coordinate."""
    potential = sp.Integer(0)
    for part, c in zip(form, q, strict=True):
        rest = sp.simplify(part - sp.diff(potential, c))
        potential = potential + sp.integrate(rest, c)
    return potential
