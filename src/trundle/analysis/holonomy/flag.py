"""Rank, fields of possible motion, and the flag of their Lie brackets, each decided exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import sympy as sp

from .tower import PRIME, Tower, tidy

Vector = tuple[Any, ...]  # elements of a tower, one for each coordinate
MINORS = 200  # sets of pivots looked at, for fields that read well


@dataclass(frozen=True)
class Step:
    """A field of the flag: the motion that it is, or the bracket of two that come before it."""

    vector: Vector
    level: int
    pair: tuple[int, int] | None = None  # positions in the flag of the two whose bracket this is


class Span:
    """A growing list of vectors, each independent of those before it.

    A probe at a random point proves independence; where the probe finds none, elimination in the field decides.

    Examples
    --------
    >>> x = sp.Symbol("x")
    >>> tower = Tower([x], [x])
    >>> span = Span(tower)
    >>> [span.add((tower(a), tower(b))) for a, b in ((1, x), (x, x**2), (0, 1))]
    [True, False, True]
    """

    def __init__(self, tower: Tower) -> None:
        self.tower = tower
        self.vectors: list[Vector] = []
        self._exact: list[tuple[int, Vector]] = []  # rows in echelon form, with their pivots
        self._done = 0
        self._probes: list[tuple[int, list[int]]] = []

    def add(self, vector: Vector) -> bool:
        """Take a vector in if it is independent of the others, and tell whether it was."""
        probe = [self.tower.probed(entry) for entry in vector]
        known = [value for value in probe if value is not None]
        seen = len(known) == len(probe) and len(self._probes) == len(self.vectors) and self._add_probe(known)
        if not seen and (len(self.vectors) == len(vector) or not self._is_new(vector)):
            return False
        self.vectors.append(vector)
        return True

    def _add_probe(self, row: list[int]) -> bool:
        for pivot, other in self._probes:
            factor = row[pivot]
            row = [(a - factor * b) % PRIME for a, b in zip(row, other, strict=True)]
        found = next((i for i, value in enumerate(row) if value), None)
        if found is None:
            return False
        scale = pow(row[found], -1, PRIME)
        self._probes.append((found, [value * scale % PRIME for value in row]))
        return True

    def _is_new(self, vector: Vector) -> bool:
        for late in self.vectors[self._done :]:
            self._reduce(late)
            self._done += 1
        return self._reduce(vector, keep=False)

    def _reduce(self, vector: Vector, keep: bool = True) -> bool:
        zero = self.tower.is_zero
        for pivot, row in self._exact:
            factor = vector[pivot]
            if not zero(factor):
                vector = tuple(a - factor * b for a, b in zip(vector, row, strict=True))
        found = [i for i, entry in enumerate(vector) if not zero(entry)]
        if found and keep:
            pivot = min(found, key=lambda i: len(vector[i].numer) + len(vector[i].denom))
            scale = vector[pivot]
            self._exact.append((pivot, tuple(entry / scale for entry in vector)))
        return bool(found)


def bracket(tower: Tower, first: Vector, second: Vector) -> Vector:
    """Return the Lie bracket [X, Y] = (∂Y) X − (∂X) Y.

    Examples
    --------
    >>> x, y = sp.symbols("x y")
    >>> tower = Tower([x], [x, y])
    >>> [str(c) for c in bracket(tower, (tower(1), tower(0)), (tower(0), tower(x)))]
    ['0', '1']
    """
    parts = []
    for a, b in zip(first, second, strict=True):
        total = tower.zero
        for i, (x, y) in enumerate(zip(first, second, strict=True)):
            if x:
                total = total + tower.derivative(b, i) * x
            if y:
                total = total - tower.derivative(a, i) * y
        parts.append(total)
    return tuple(parts)


def flag(tower: Tower, fields: Sequence[Vector]) -> tuple[list[Step], list[int]]:
    """Add brackets to fields until nothing new comes.

    Each level adds the brackets of the fields with what was new on the level before. A level that adds nothing proves
    that the fields so far are closed under brackets, since they then are so over the field of all coefficients.

    Examples
    --------
    >>> x, y, z = sp.symbols("x y z")
    >>> tower = Tower([y], [x, y, z])
    >>> forward, aside = (tower(1), tower(0), tower(y)), (tower(0), tower(1), tower(0))
    >>> flag(tower, [forward, aside])[1]
    [2, 3]
    """
    span = Span(tower)
    steps = [Step(vector, 1) for vector in fields if span.add(vector)]
    motions, size = list(range(len(steps))), len(tower.coordinates)
    growth, new = [len(steps)], motions
    while new and len(steps) < size:
        level, before, new = len(growth) + 1, new, []
        for i in motions:
            for j in before:
                if len(steps) == size or (level == 2 and j <= i):
                    continue
                vector = bracket(tower, steps[i].vector, steps[j].vector)
                if span.add(vector):
                    new.append(len(steps))
                    steps.append(Step(vector, level, (i, j)))
        if new:
            growth.append(len(steps))
    return steps, growth


def independent_rows(tower: Tower, rows: Sequence[Sequence[sp.Expr]]) -> list[int]:
    """Return which rows to keep so that none follows from the others.

    Examples
    --------
    >>> x = sp.Symbol("x")
    >>> independent_rows(Tower([x], [x]), [[x, 1], [x**2, x], [1, 0]])
    [0, 2]
    """
    span = Span(tower)
    return [i for i, row in enumerate(rows) if span.add(tuple(tower(entry) for entry in row))]


def kernel(tower: Tower, rows: sp.Matrix, at: dict[sp.Symbol, Any] | None = None) -> list[list[sp.Expr]]:
    """Return fields without denominators that span the motions which the constraints allow.

    With pivot columns P and minor d = det A_P each free coordinate j has the field d e_j − adj(A_P) A_j. The pivots
    whose minor is simplest are taken.

    Examples
    --------
    >>> phi = sp.Symbol("phi")
    >>> kernel(Tower([sp.sin(phi)], [phi]), sp.Matrix([[sp.sin(phi), -sp.cos(phi)]]))
    [[cos(phi), sin(phi)]]
    """
    count, size = rows.shape
    if count == 0:
        return [[sp.Integer(int(i == j)) for i in range(size)] for j in range(size)]
    found = None
    for number, pivots in enumerate(combinations(range(size), count)):
        if number > MINORS and found:
            break
        minor = tidy(rows[:, pivots].det(method="berkowitz"))
        held = minor.subs(at) if at else minor
        if vanishes(held):
            continue
        cost = (len(minor.free_symbols & set(tower.coordinates)), sp.count_ops(minor), number)
        if found is None or cost < found[0]:
            found = (cost, pivots, minor)
        if cost[:2] == (0, 0):
            break
    if found is None:
        return []
    _, pivots, minor = found
    adjugate = rows[:, pivots].adjugate()
    return [_field(rows, pivots, minor, adjugate, j) for j in range(size) if j not in pivots]


def _field(rows: sp.Matrix, pivots: tuple[int, ...], minor: sp.Expr, adjugate: sp.Matrix, j: int) -> list[sp.Expr]:
    field = [sp.Integer(0)] * rows.shape[1]
    field[j] = minor
    for i, entry in zip(pivots, -(adjugate * rows[:, j]), strict=True):
        field[i] = tidy(entry)
    for factor in _factors(minor):
        parts = [sp.cancel(entry / factor) for entry in field]
        if all(sp.denom(part).is_number or not _shares(sp.denom(part), factor) for part in parts):
            field = parts
    return field


def _factors(e: sp.Expr) -> list[sp.Expr]:
    factors: list[sp.Expr] = []
    for factor in sp.Mul.make_args(sp.factor(e)):
        base, power = factor.as_base_exp()
        factors += [base] * int(power) if power.is_Integer and power > 0 else [factor]
    return factors


def _shares(denominator: sp.Expr, factor: sp.Expr) -> bool:
    return bool(denominator.free_symbols & factor.free_symbols)


def vanishes(e: sp.Expr) -> bool:
    """Tell exactly whether an expression in any of the known functions is zero.

    Examples
    --------
    >>> x = sp.Symbol("x")
    >>> vanishes(sp.sin(2 * x) - 2 * sp.sin(x) * sp.cos(x))
    True
    """
    if e == 0:
        return True
    if e.is_Rational:
        return False
    tower = Tower([e], [])
    return tower.is_zero(tower(e))
