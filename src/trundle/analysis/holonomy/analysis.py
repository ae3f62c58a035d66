"""What constraints leave free, and the verdict: decided exactly, with the evidence."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from ...display import Headline, Markup, Serializable
from ...errors import InvalidValueError
from .flag import Span, Vector, bracket, flag, independent_rows, kernel, vanishes
from .functions import prepare
from .integrals import integrals, is_constant
from .system import PfaffianSystem
from .tower import Tower, tidy

MOST_OPERATIONS = 250  # in brackets that are searched for special places
MOST_TO_TIDY = 250  # in a component of a bracket that is written short
HOLONOMIC, NONHOLONOMIC, PARTLY, FREE = "holonomic", "nonholonomic", "partly holonomic", "unconstrained"


@dataclass(frozen=True)
class Field:
    """A motion that the constraints allow, or the bracket of two: its rate along each coordinate."""

    name: str
    components: tuple[sp.Expr, ...]
    level: int = 1
    words: str = ""


@dataclass(frozen=True, repr=False)
class ConstraintAnalysis(Serializable):
    """The findings about a Pfaffian system.

    Examples
    --------
    >>> found = PfaffianSystem.load("sphere").analyse()
    >>> found.rank, found.growth, found.verdict
    (2, (3, 5), 'nonholonomic')
    """

    system: PfaffianSystem
    rank: int  # generic rank of A
    kept: tuple[int, ...]  # rows that the others follow from
    fields: tuple[Field, ...]  # they span what is allowed
    pairs: tuple[tuple[int, int, int], ...]  # brackets that lead to something new: level, and positions of the two
    growth: tuple[int, ...]  # generic ranks of the flag
    integrals: tuple[sp.Expr, ...]  # functions that stay constant, each proved

    @property
    def size(self) -> int:
        """How many coordinates there are."""
        return len(self.system.coordinates)

    @property
    def integrable(self) -> int:
        """How many independent functions of the coordinates stay constant."""
        return self.size - self.growth[-1]

    @property
    def verdict(self) -> str:
        """The word for it: holonomic, nonholonomic, partly holonomic, or unconstrained."""
        if self.rank == 0:
            return FREE
        if len(self.growth) == 1:
            return HOLONOMIC
        return PARTLY if self.integrable else NONHOLONOMIC

    @cached_property
    def brackets(self) -> tuple[Field, ...]:
        """The brackets that lead to something new, level by level, written to be read."""
        told = list(self.fields)
        for level, i, j in self.pairs:
            name = f"[{told[i].name}, {told[j].name}]"
            components = lie_bracket(told[i].components, told[j].components, self.system.coordinates)
            told.append(Field(name, components, level, self.system.telling.brackets.get(name, "")))
        return tuple(told[len(self.fields) :])

    @cached_property
    def also(self) -> tuple[Field, ...]:
        """Brackets that a shipped system shows besides, though they lead to nothing new."""
        named = {field.name: field for field in self.fields}
        told = []
        for first, second in self.system.telling.also:
            components = lie_bracket(named[first].components, named[second].components, self.system.coordinates)
            name = f"[{first}, {second}]"
            told.append(Field(name, components, 2, self.system.telling.brackets.get(name, "")))
        return tuple(told)

    @cached_property
    def special(self) -> tuple[tuple[dict[sp.Symbol, sp.Expr], tuple[int, ...]], ...]:
        """Where the growth vector differs: values of a coordinate, and the growth vector there.

        Only surfaces of one dimension less are looked for, those where a determinant of the flag has a factor that
        vanishes and that can be solved for one coordinate; and none where the brackets are too long for that.
        """
        from .special import special_places

        return tuple(special_places(self)) if self.looks_for_special else ()

    @property
    def looks_for_special(self) -> bool:
        """Whether the brackets are short enough for `special` to look for places."""
        return sum(sp.count_ops(e) for field in self.brackets for e in field.components) <= MOST_OPERATIONS

    def growth_at(self, values: dict[Any, Any], levels: int | None = None) -> tuple[int, ...]:
        """Return the growth vector where some coordinates have given values, and the others are generic.

        Parameters
        ----------
        values : dict
            Coordinates, or their names, and exact values.
        levels : int, optional
            How many levels to look at; absent: up to the generic number and two more.

        Returns
        -------
        tuple of int
            Ranks of the flag there.

        Raises
        ------
        InvalidValueError
            If a name is no coordinate, or the constraints depend on each other there.

        Examples
        --------
        >>> trailers = PfaffianSystem.load("trailers").analyse()
        >>> trailers.growth_at({"delta_1": sp.pi / 2})
        (2, 3, 4, 4, 5)
        """
        from .special import growth_at

        return growth_at(self, values, levels)

    def is_integral(self, function: sp.Expr) -> bool:
        """Prove or refute that a function stays constant whatever motion the constraints allow.

        Parameters
        ----------
        function : sympy.Expr
            Of the coordinates and the constants in the rows.

        Returns
        -------
        bool
            True if and only if df vanishes along every allowed motion, identically.

        Examples
        --------
        >>> cylinder = PfaffianSystem.load("cylinder")
        >>> x, phi = cylinder.coordinates
        >>> cylinder.analyse().is_integral(x - phi)
        False
        """
        q = self.system.coordinates
        slopes = [sp.diff(sp.sympify(function), c) for c in q]
        components = [field.components for field in self.fields]
        tower = Tower([*slopes, *(entry for field in components for entry in field)], q)
        fields = [tuple(tower(entry) for entry in field) for field in components]
        return is_constant(tower, fields, tuple(tower(slope) for slope in slopes))

    def as_dict(self) -> dict[str, Any]:
        """Return the findings as text and numbers, for JSON."""
        shown = {str(q): None for q in self.system.coordinates}

        def told(field: Field) -> dict[str, Any]:
            rates = {name: str(e) for name, e in zip(shown, field.components, strict=True) if e != 0}
            return {"name": field.name, "level": field.level, "rates": rates}

        return {
            "title": self.system.telling.title,
            "coordinates": list(shown),
            "rows": [[str(entry) for entry in row] for row in self.system.rows.tolist()],
            "rank": self.rank,
            "growth": list(self.growth),
            "verdict": self.verdict,
            "integrable": self.integrable,
            "integrals": [str(f) for f in self.integrals],
            "fields": [told(field) for field in self.fields],
            "brackets": [told(field) for field in self.brackets],
            "special": [{"where": {str(k): str(v) for k, v in w.items()}, "growth": list(g)} for w, g in self.special],
        }

    def __str__(self) -> str:
        from .report import report

        return report(self)

    def _headline(self) -> Headline:
        return Headline(self.system.telling.title, self.verdict.upper())

    def _parts(self) -> Iterator[Markup]:
        from .report import shown

        yield shown(self)

    def _repr_latex_(self) -> str:
        return self.latex()

    def latex(self) -> str:
        """Return the findings as LaTeX."""
        from .report import latex

        return latex(self)


def analyse(system: PfaffianSystem) -> ConstraintAnalysis:
    """Decide what a Pfaffian system leaves free, and whether it can be integrated.

    Examples
    --------
    >>> analyse(PfaffianSystem.load("skate")).growth
    (2, 3)
    """
    q = system.coordinates
    rows = [[prepare(entry) for entry in row] for row in system.rows.tolist()]
    plain = Tower((entry for row in rows for entry in row), q)
    kept = independent_rows(plain, rows)
    matrix = sp.Matrix(len(kept), len(q), [entry for i in kept for entry in rows[i]])
    motions = dict(system.motions) or _named(kernel(plain, matrix))
    tower = Tower((e for part in (*rows, *motions.values()) for e in part), q)
    vectors = [tuple(tower(entry) for entry in motion) for motion in motions.values()]
    if system.motions:
        _check_motions(tower, system, vectors, len(q) - len(kept))
    steps, growth = flag(tower, vectors)
    fields = tuple(Field(name, tuple(components)) for name, components in motions.items())
    pairs = tuple((step.level, *step.pair) for step in steps if step.pair)
    closed = [step.vector for step in steps]
    constant = integrals(tower, closed, [rows[i] for i in kept]) if growth[-1] < len(q) else []
    return ConstraintAnalysis(
        system,
        len(kept),
        tuple(kept),
        fields,
        pairs,
        tuple(growth),
        tuple(constant),
    )


def _named(fields: list[list[sp.Expr]]) -> dict[str, list[sp.Expr]]:
    return {f"X{i}": field for i, field in enumerate(fields, 1)}


def _check_motions(tower: Tower, system: PfaffianSystem, vectors: list[Vector], free: int) -> None:
    names = list(system.motions)
    for name, vector in zip(names, vectors, strict=True):
        for i, row in enumerate(system.rows.tolist()):
            if not is_constant(tower, [vector], tuple(tower(entry) for entry in row)):
                raise InvalidValueError(f"motions[{name!r}]", "must obey every constraint", f"row {i} is broken")
    span = Span(tower)
    if len(vectors) != free or not all(span.add(vector) for vector in vectors):
        rule = f"must be {free} independent fields, as many as the constraints leave free"
        raise InvalidValueError("motions", rule, ", ".join(names))


def lie_bracket(first: tuple[sp.Expr, ...], second: tuple[sp.Expr, ...], q: tuple[sp.Symbol, ...]) -> tuple[Any, ...]:
    """Return [X, Y] = (∂Y) X − (∂X) Y in SymPy's own functions, written short.

    Examples
    --------
    >>> x, y = sp.symbols("x y")
    >>> lie_bracket((sp.Integer(1), sp.Integer(0)), (sp.Integer(0), x), (x, y))
    (0, 1)
    """
    parts = []
    for a, b in zip(first, second, strict=True):
        total = sp.Add(*(sp.diff(b, c) * u - sp.diff(a, c) * v for c, u, v in zip(q, first, second, strict=True)))
        parts.append(tidy(total) if total.count_ops() <= MOST_TO_TIDY else total)
    return tuple(parts)


__all__ = ["ConstraintAnalysis", "Field", "analyse", "bracket", "lie_bracket", "vanishes"]
