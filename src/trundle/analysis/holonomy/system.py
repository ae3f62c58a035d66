"""Constraints as a user writes them: coordinates and rows of A(q), checked and named."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import sympy as sp

from ...display import Displayed, Headline, Markup
from ...errors import InvalidValueError

if TYPE_CHECKING:
    from .analysis import ConstraintAnalysis


@dataclass(frozen=True)
class Telling:
    """What is said of a shipped system besides its equations."""

    title: str = ""
    coordinates: str = ""  # what they are
    verdict: str = ""  # what the verdict means here
    brackets: Mapping[str, str] = field(default_factory=dict)  # bracket -> what it does, in words
    also: tuple[tuple[str, str], ...] = ()  # brackets to be shown though they lead to nothing new
    chart: str = ""  # where the coordinates themselves fail


@dataclass(frozen=True, repr=False)
class PfaffianSystem(Displayed):
    """Constraints A(q) q̇ = 0 on the velocities of a mechanical system.

    Parameters
    ----------
    coordinates : sequence of sympy.Symbol
        q. Every other symbol in the rows is a constant.
    rows : sequence of rows of sympy.Expr, or sympy.Matrix
        A(q): a row for each constraint, a column for each coordinate. Rows may depend on each other.
    motions : mapping from str to sequence of sympy.Expr, optional
        Fields that span the motions which the constraints allow, each with a name; absent: trundle finds some.
    telling : Telling
        Words about the system.

    Raises
    ------
    InvalidValueError
        If the shape is wrong, a coefficient is not exact or not of a known kind, or a motion breaks a constraint.

    Examples
    --------
    A cylinder that rolls along a plane, the lecture's first example:

    >>> x, phi, a = sp.symbols("x phi a")
    >>> found = PfaffianSystem((x, phi), [[1, -a]]).analyse()
    >>> found.verdict, found.integrals
    ('holonomic', (-a*phi + x,))
    """

    coordinates: tuple[sp.Symbol, ...]
    rows: Any
    motions: Any = None
    telling: Telling = field(default_factory=Telling)

    def __post_init__(self) -> None:
        coordinates = _coordinates(self.coordinates)
        object.__setattr__(self, "coordinates", coordinates)
        object.__setattr__(self, "rows", _matrix(self.rows, len(coordinates)))
        motions = {} if self.motions is None else dict(self.motions)
        for name, components in motions.items():
            if len(components) != len(coordinates):
                raise InvalidValueError(
                    f"motions[{name!r}]", f"must have {len(coordinates)} components", len(components)
                )
            motions[name] = tuple(sp.sympify(component) for component in components)
        object.__setattr__(self, "motions", motions)

    def __str__(self) -> str:
        from .report import report_system

        return report_system(self)

    def _headline(self) -> Headline:
        rows, columns = self.rows.shape
        return Headline(self.telling.title, f"{rows} constraint{'s' * (rows != 1)} on {columns} coordinates")

    def _parts(self) -> Iterator[Markup]:
        from .report import shown_system

        yield shown_system(self)

    @classmethod
    def of_velocities(
        cls, coordinates: Sequence[Any], velocities: Sequence[Any], constraints: Sequence[Any]
    ) -> PfaffianSystem:
        """Read constraints that are written with velocities, each an expression that must vanish.

        Parameters
        ----------
        coordinates : sequence of sympy.Symbol or functions of time
            q; functions such as those of `sympy.physics.mechanics.dynamicsymbols` become symbols of the same name.
        velocities : sequence of sympy.Symbol or derivatives
            q̇, in the same order.
        constraints : sequence of sympy.Expr
            Linear in the velocities, without a term that holds none.

        Returns
        -------
        PfaffianSystem
            The same constraints as A(q) q̇ = 0.

        Raises
        ------
        InvalidValueError
            If a constraint is not linear in the velocities, or a term of it holds none.

        Examples
        --------
        >>> x, phi, v, w, a = sp.symbols("x phi v w a")
        >>> PfaffianSystem.of_velocities((x, phi), (v, w), [v - a * w]).rows
        Matrix([[1, -a]])
        """
        if len(coordinates) != len(velocities):
            rule = f"must be as many as the coordinates, {len(coordinates)}"
            raise InvalidValueError("velocities", rule, len(velocities))
        rates = [sp.Dummy(f"rate{i}") for i in range(len(velocities))]
        places = {c: sp.Symbol(c.func.__name__) for c in coordinates if not isinstance(c, sp.Symbol)}
        rows = []
        for i, constraint in enumerate(constraints):
            e = sp.sympify(constraint).subs(dict(zip(velocities, rates, strict=True))).subs(places)
            row = [sp.diff(e, rate) for rate in rates]
            if any(entry.has(*rates) for entry in row):
                remedy = "Only constraints of the form A(q) q̇ = 0 are decided."
                raise InvalidValueError(
                    f"constraints[{i}]", "must be linear in the velocities", str(constraint), remedy
                )
            rest = sp.expand(e - sum(entry * rate for entry, rate in zip(row, rates, strict=True)))
            if sp.simplify(rest) != 0:
                remedy = (
                    "For a support that moves, take the time t as a coordinate too: "
                    "a·q̇ + b = 0 becomes a·dq + b dt = 0, with 1 for t's own velocity."
                )
                rule = "must have a velocity in each term (it is affine)"
                raise InvalidValueError(f"constraints[{i}]", rule, str(rest), remedy)
            rows.append(row)
        return cls(tuple(places.get(c, c) for c in coordinates), rows)

    @classmethod
    def load(cls, name: str) -> PfaffianSystem:
        """Return a system that ships with the package.

        Parameters
        ----------
        name : str
            One of `names()`.

        Returns
        -------
        PfaffianSystem
            The system.

        Raises
        ------
        UnknownNameError
            If there is none of that name; the message lists them.

        Examples
        --------
        >>> PfaffianSystem.load("sphere").coordinates
        (x, y, phi, theta, psi)
        """
        from .shipped import load

        return load(name)

    @classmethod
    def names(cls) -> list[str]:
        """Return the names of the systems that ship with the package.

        Returns
        -------
        list of str
            In the order of a lecture.

        Examples
        --------
        >>> PfaffianSystem.names()[0]
        'cylinder'
        """
        from .names import NAMES

        return list(NAMES)

    def analyse(self) -> ConstraintAnalysis:
        """Decide what the constraints leave free, and whether they can be integrated.

        Returns
        -------
        ConstraintAnalysis
            Rank, fields, brackets, growth vector, verdict, integrals. `print` it.

        Raises
        ------
        InvalidValueError
            If a coefficient is of no kind that can be decided exactly.

        Examples
        --------
        >>> x, y, phi = sp.symbols("x y phi")
        >>> skate = PfaffianSystem((x, y, phi), [[sp.sin(phi), -sp.cos(phi), 0]])
        >>> skate.analyse().growth
        (2, 3)
        """
        from .analysis import analyse

        return analyse(self)


def _coordinates(given: Any) -> tuple[sp.Symbol, ...]:
    try:
        coordinates = tuple(given)
    except TypeError:
        coordinates = (given,)
    if not coordinates or not all(isinstance(c, sp.Symbol) for c in coordinates):
        remedy = "Functions of time are read by PfaffianSystem.of_velocities."
        raise InvalidValueError("coordinates", "must be SymPy symbols, at least one", str(given), remedy)
    if len({str(c) for c in coordinates}) < len(coordinates):
        raise InvalidValueError("coordinates", "must have different names", str(given))
    return coordinates


def _matrix(given: Any, size: int) -> sp.ImmutableMatrix:
    try:
        rows = given.tolist() if hasattr(given, "tolist") else [list(row) for row in given]
        matrix = sp.ImmutableMatrix(len(rows), size, [sp.sympify(entry) for row in rows for entry in row])
    except (TypeError, ValueError, sp.SympifyError):
        remedy = f"Give a list of rows, each with {size} coefficients."
        raise InvalidValueError(
            "rows", "must be a matrix with a column for each coordinate", str(given), remedy
        ) from None
    if any(len(row) != size for row in rows):
        widths = ", ".join(str(len(row)) for row in rows)
        raise InvalidValueError("rows", f"must each have {size} coefficients, one for each coordinate", widths)
    return matrix
