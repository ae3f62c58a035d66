"""Where the growth vector drops: places at which the brackets of a generic point give less."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, islice
from typing import TYPE_CHECKING, Any

import sympy as sp

from ...errors import InvalidValueError, UnknownNameError
from .flag import Span, Vector, bracket, kernel
from .functions import prepare
from .tower import Tower, tidy

if TYPE_CHECKING:
    from .analysis import ConstraintAnalysis

Places = dict[sp.Symbol, sp.Expr]
MINORS = 6  # looked at where brackets do not reach everywhere


def growth_at(found: ConstraintAnalysis, values: dict[Any, Any], levels: int | None = None) -> tuple[int, ...]:
    """Return the growth vector where some coordinates have given values; the others stay generic.

    The coordinates are counted from there, q = value + s, so that s = 0 can be put into everything exactly. All
    brackets are kept: one that is a combination of others elsewhere need not be one here.

    Examples
    --------
    Martinet's constraint needs one bracket more on its surface y = 0:

    >>> from trundle.analysis.holonomy.system import PfaffianSystem
    >>> x, y, z = sp.symbols("x y z")
    >>> found = PfaffianSystem((x, y, z), [[-(y**2), 0, 1]]).analyse()
    >>> found.growth, growth_at(found, {y: 0})
    ((2, 3), (2, 2, 3))
    """
    q = found.system.coordinates
    at = _named(values, q)
    shift = {c: sp.Dummy(str(c), real=c.is_real) for c in at}
    moved = {c: at[c] + shift[c] for c in at}
    new = tuple(shift.get(c, c) for c in q)
    here = dict.fromkeys(shift.values(), sp.Integer(0))
    limit = len(found.growth) + 2 if levels is None else levels
    tower, first = _regular(found, moved, new, here) or _afresh(found, moved, new, here)
    return tuple(_growth(tower, first, here, limit, found.growth[-1]))


def _regular(found: ConstraintAnalysis, moved: Places, new: Any, here: Places) -> tuple[Tower, list[Vector]] | None:
    """Return the generic fields in the new coordinates, if they are finite and independent at the place."""
    q = found.system.coordinates
    fields = []
    for field in found.fields:
        rates = [
            rate - sum(sp.diff(moved[c] - s, other) * r for other, r in zip(q, field.components, strict=True))
            if c in moved
            else rate
            for c, s, rate in zip(q, new, field.components, strict=True)
        ]
        fields.append([_turned(sp.sympify(rate).subs(moved, simultaneous=True)) for rate in rates])
    try:
        tower = Tower([e for field in fields for e in field], new)
        vectors = [tuple(tower(e) for e in field) for field in fields]
        span = Span(tower)
        regular = all(span.add(tower.held(vector, here)) for vector in vectors)
    except InvalidValueError:  # a pole
        return None
    return (tower, vectors) if regular else None


def _afresh(found: ConstraintAnalysis, moved: Places, new: Any, here: Places) -> tuple[Tower, list[Vector]]:
    """Return fields found anew with a minor that does not vanish at the place."""
    q = found.system.coordinates
    jacobian = sp.Matrix([[sp.diff(moved.get(c, c), s) for s in new] for c in q])
    rows = found.system.rows.extract(list(found.kept), list(range(len(q)))).subs(moved, simultaneous=True) * jacobian
    rows = sp.Matrix(*rows.shape, [_turned(e) for e in rows])
    fields = kernel(Tower(rows, new), rows, here)
    if not fields and found.rank < len(q):
        place = ", ".join(f"{c} = {value - s}" for (c, value), s in zip(moved.items(), here, strict=True))
        remedy = "No growth vector is defined where the rank of A(q) drops."
        raise InvalidValueError("values", "must leave the constraints independent", place, remedy)
    tower = Tower([e for field in fields for e in field], new)
    return tower, [tuple(tower(e) for e in field) for field in fields]


def _turned(e: sp.Expr) -> sp.Expr:
    """Take constant angles out of sums of angles."""
    return prepare(sp.expand_trig(e)) if e.has(sp.pi) else prepare(e)


def _growth(tower: Tower, first: list[Vector], here: Places, limit: int, most: int) -> list[int]:
    span = Span(tower)
    for vector in first:
        span.add(tower.held(vector, here))
    growth, before = [len(span.vectors)], first
    while growth[-1] < most and len(growth) < limit:
        pairs = [(x, y) for x in first for y in before] if len(growth) > 1 else list(combinations(first, 2))
        before = [v for v in dict.fromkeys(bracket(tower, x, y) for x, y in pairs) if any(v)]
        for vector in before:
            span.add(tower.held(vector, here))
        growth.append(len(span.vectors))
    return growth


def _named(values: dict[Any, Any], q: tuple[sp.Symbol, ...]) -> Places:
    names = {str(c): c for c in q}
    for name in values:
        if str(name) not in names:
            raise UnknownNameError("coordinate", str(name), list(names))
    at = {names[str(name)]: sp.sympify(value) for name, value in values.items()}
    if any(value.free_symbols & set(at) for value in at.values()):
        raise InvalidValueError("values", "must not depend on each other", str(values))
    return at


def special_places(found: ConstraintAnalysis) -> Iterator[tuple[Places, tuple[int, ...]]]:
    """Yield surfaces on which the growth vector differs from the generic one.

    Where a level of the flag drops, the generic basis of its last level fails, too; so the candidates are the factors
    of that basis's determinant and the poles of its fields.

    Examples
    --------
    >>> from trundle.analysis.holonomy.system import PfaffianSystem
    >>> x, y, z = sp.symbols("x y z")
    >>> list(special_places(PfaffianSystem((x, y, z), [[-(y**2), 0, 1]]).analyse()))
    [({y: 0}, (2, 2, 3))]
    """
    q = found.system.coordinates
    told: list[Places] = []
    for factor in _factors(found):
        for place in _solved(factor, q):
            if place in told:
                continue
            told.append(place)
            try:
                growth = growth_at(found, place)
            except InvalidValueError:  # the constraints depend on each other there, or it is no exact place
                continue
            if growth != found.growth:
                yield place, growth


def _factors(found: ConstraintAnalysis) -> list[sp.Expr]:
    """Return what vanishes where the generic basis fails."""
    q = found.system.coordinates
    matrix = sp.Matrix([list(field.components) for field in (*found.fields, *found.brackets)])
    below = sp.Integer(1)
    for entry in matrix:
        below = sp.lcm(below, sp.denom(sp.together(entry)))
    columns = islice(combinations(range(len(q)), matrix.shape[0]), MINORS)
    minors = [tidy(matrix[:, chosen].det(method="berkowitz")) for chosen in columns] if matrix else []
    shortest = min((minor for minor in minors if minor != 0), key=sp.count_ops, default=sp.Integer(1))
    factors: list[sp.Expr] = []
    for part in (below, sp.numer(sp.together(shortest))):
        for piece in sp.Mul.make_args(sp.factor(part)):
            base = piece.as_base_exp()[0]
            if base.free_symbols & set(q) and base not in factors:
                factors.append(base)
    return factors


def _solved(factor: sp.Expr, q: tuple[sp.Symbol, ...]) -> list[Places]:
    """Solve factor = 0 for one coordinate; nothing where SymPy has no exact solution that a tower knows."""
    for coordinate in sorted(factor.free_symbols & set(q), key=q.index):
        try:
            solutions = sp.solve(factor, coordinate)
        except NotImplementedError:
            continue
        places = [{coordinate: value} for value in solutions if value.is_real is not False and _plain(value)]
        if places:
            return places
    return []


def _plain(value: sp.Expr) -> bool:
    return not value.has(sp.I, sp.Piecewise, sp.acos, sp.asin, sp.atan, sp.log)
