"""A derivation: ordered steps of equations, each with the residual that proves it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from ...display import Displayed, Headline, Markup, Serializable, mathml
from ...errors import TrundleError


class DerivationError(TrundleError):
    """An equation of a derivation does not hold for what the rolling law returns."""


@dataclass(frozen=True)
class Equation(Displayed):
    """An equation as it is printed, and its residual.

    Examples
    --------
    >>> import sympy
    >>> Equation(sympy.Eq(sympy.Symbol("a"), 1, evaluate=False), sympy.Integer(0)).holds
    True
    """

    formula: Any  # both sides, as they are printed
    # left side minus right side with the rolling law's own expressions put in, in normal form: 0 is a proof
    residual: Any = field(repr=False)

    @property
    def holds(self) -> bool:
        """Whether the residual is exactly 0, in each component."""
        parts = self.residual if hasattr(self.residual, "shape") else [self.residual]
        return all(part == 0 for part in parts)

    def _headline(self) -> Headline:
        return Headline("", "proved" if self.holds else "NOT proved", self.holds)

    def _parts(self) -> Iterator[Markup]:
        from .rendering import latex_of

        yield mathml(latex_of(self.formula), display=True)


@dataclass(frozen=True, repr=False)
class Step(Displayed):
    """One step: what is done, in a sentence, and the equations that come of it.

    Examples
    --------
    >>> Step("Newton", "The law of momentum.", ()).residuals
    ()
    """

    title: str  # a few words
    sentence: str  # what is done; `{name}` stands for an expression of `words`
    equations: tuple[Equation, ...]  # in order
    words: Mapping[str, Any] = field(default_factory=dict)  # the expressions of the sentence

    @property
    def residuals(self) -> tuple[Any, ...]:
        """One for each equation; all are 0."""
        return tuple(equation.residual for equation in self.equations)

    def _headline(self) -> Headline:
        proved = all(equation.holds for equation in self.equations)
        return Headline(self.title, "proved" if proved else "NOT proved", proved)

    def _parts(self) -> Iterator[Markup]:
        from .rendering import shown_step

        yield shown_step(self)


@dataclass(frozen=True)
class Number:
    """A quantity of the derivation with its value in a scenario.

    Examples
    --------
    >>> import sympy
    >>> Number(sympy.Symbol("kappa"), 0.9963, "rad/s").unit
    'rad/s'
    """

    symbol: Any
    value: Any
    unit: str


@dataclass(frozen=True, repr=False)
class Derivation(Serializable):
    """How the motion of a rolling body follows from Newton's and Euler's laws, each line of it proved.

    Parameters
    ----------
    name, title : str
        What it is asked for by, and its heading.
    introduction : str
        What is derived.
    steps : tuple of Step
        In order.
    numbers : tuple of Number
        Of a scenario, where they are asked for.

    Raises
    ------
    DerivationError
        If an equation has a residual other than 0.

    Examples
    --------
    >>> import trundle as tr
    >>> derivation = tr.derive("turntable")
    >>> [step.title for step in derivation.steps][:3]
    ["Newton's law", "Euler's law", 'The rolling condition']
    >>> {residual for step in derivation.steps for residual in step.residuals if residual.is_Number}
    {0}
    """

    name: str
    title: str
    introduction: str
    steps: tuple[Step, ...]
    numbers: tuple[Number, ...] = ()

    def __post_init__(self) -> None:
        checked(self.name, self.steps)

    @property
    def count(self) -> int:
        """How many equations it has."""
        return sum(len(step.equations) for step in self.steps)

    def text(self, width: int = 100) -> str:
        """Return the derivation for a terminal, in Unicode, at most `width` columns wide where lines can break."""
        from .rendering import text

        return text(self, width)

    def markdown(self) -> str:
        """Return the derivation in Markdown, with formulas that GitHub, Jupyter and KaTeX render."""
        from .rendering import markdown

        return markdown(self)

    def latex(self) -> str:
        r"""Return the derivation as a fragment of LaTeX, to ``\input`` where amsmath is loaded."""
        from .rendering import latex

        return latex(self)

    def as_dict(self) -> dict[str, Any]:
        """Return the derivation as what JSON can hold; the LaTeX in it is of the kind that KaTeX renders."""
        from .rendering import as_dict

        return as_dict(self)

    def __str__(self) -> str:
        return self.text()

    def _headline(self) -> Headline:
        return Headline(self.title, f"each of {self.count} equations proved", True)

    def _parts(self) -> Iterator[Markup]:
        from .rendering import shown

        yield shown(self)

    def _repr_markdown_(self) -> str:
        return self.markdown()


def checked(name: str, steps: Iterable[Step]) -> tuple[Step, ...]:
    """Go through the steps of a derivation, up to the first that does not hold.

    Examples
    --------
    >>> checked("nothing", [Step("Newton", "The law of momentum.", ())])[0].title
    'Newton'
    """
    done = []
    for step in steps:
        for equation in step.equations:
            if not equation.holds:
                raise DerivationError(
                    f"The step {step.title!r} of {name!r} does not hold for what the rolling law returns: "
                    f"{equation.formula} leaves the residual {equation.residual}."
                )
        done.append(step)
    return tuple(done)


class Proof:
    """Makes equations and works out their residuals from the values of the symbols in them.

    Parameters
    ----------
    values : mapping
        What the rolling law, or a closed form, gives for each vector and scalar.
    squares : mapping, optional
        As for `zero.numerator`.

    Examples
    --------
    >>> import sympy
    >>> x, y = sympy.symbols("x y")
    >>> Proof({y: x**2}).equation(y + 1, 1 + x * x).residual
    0
    """

    def __init__(self, values: Mapping[Any, Any], squares: Mapping[Any, Any] | None = None) -> None:
        self.values, self.squares = dict(values), dict(squares or {})

    def equation(self, left: Any, right: Any) -> Equation:
        """Return the equation of two sides with its residual."""
        import sympy as sp

        from .vectors import evaluate
        from .zero import numerator

        both = [evaluate(sp.sympify(side), self.values) for side in (left, right)]
        if isinstance(both[0], sp.MatrixBase) and both[1] == 0:
            right, both[1] = sp.ZeroMatrix(3, 1), sp.zeros(3, 1)
        residual = both[0] - both[1]
        if isinstance(residual, sp.MatrixBase):
            proved = residual.applyfunc(lambda part: numerator(part, self.squares)).as_immutable()
        else:
            proved = numerator(residual, self.squares)
        return Equation(sp.Eq(left, right, evaluate=False), proved)

    def constant(self, left: Any, right: Any, rates: Mapping[Any, Any]) -> Equation:
        """Return an equation between two integrals; its residual is the rate at which they part."""
        import sympy as sp

        from .zero import numerator

        parting = sum((left - right).diff(symbol) * rate for symbol, rate in rates.items())
        return Equation(sp.Eq(left, right, evaluate=False), numerator(parting.xreplace(self.values), self.squares))

    def at(self, values: Mapping[Any, Any]) -> Proof:
        """Return the proof for chosen values of some symbols, such as k = 2/5."""
        put_in = {
            name: value.xreplace(dict(values)) if hasattr(value, "xreplace") else value
            for name, value in self.values.items()
        }
        return Proof({**put_in, **values}, self.squares)
