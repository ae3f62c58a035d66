"""The verification card: the figures that say why a trajectory can be trusted."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ..display import Displayed, Headline, Markup, Serializable, number, paragraph, table, verdict


@dataclass(frozen=True)
class CardFigure(Displayed):
    """One checked number.

    Parameters
    ----------
    name : str
        What was checked.
    value : float
        What came out.
    unit : str
        Its unit; empty for a ratio.
    bound : float or None
        The most that is allowed; None where the number only informs.
    passed : bool or None
        Whether it held; None where the number only informs.
    note : str
        How it was measured, or what it means.

    Examples
    --------
    >>> print(CardFigure("no slip", 3e-16, "", 1e-13, True, "share of the speed"))
    ok    no slip                                   3e-16            at most 1e-13    share of the speed
    """

    name: str
    value: float
    unit: str = ""
    bound: float | None = None
    passed: bool | None = None
    note: str = ""

    @property
    def digits(self) -> int:
        """How many digits of the value say something: few of an error, more of a measured quantity."""
        return 6 if self.passed is None and self.bound is None else 2

    @property
    def outcome(self) -> str:
        """Whether it held, in a word; empty where it only informs."""
        return {True: "holds", False: "FAILS", None: ""}[self.passed]

    def __str__(self) -> str:
        verdict = {True: "ok", False: "FAIL", None: "-"}[self.passed]
        value = f"{self.value:.{self.digits}g} {self.unit}".strip()
        limit = "" if self.bound is None else f"at most {self.bound:.2g}"
        return f"{verdict:<5} {self.name:<40}  {value:<16} {limit:<15}  {self.note}".rstrip()

    def _headline(self) -> Headline:
        return Headline(self.name, self.outcome, self.passed)

    def _parts(self) -> Iterator[Markup]:
        yield table_of([self])


def table_of(figures: Iterable[CardFigure]) -> Markup:
    r"""Return figures as the table that notebooks and saved pages show.

    Examples
    --------
    >>> table_of([checked("no slip", 3e-16, 1e-12, "")]).count("✓\xa0holds")
    1
    """
    rows = [
        (
            verdict(figure.passed, figure.outcome),
            figure.name,
            number(figure.value, figure.digits, figure.unit),
            number(figure.bound, 2),
            figure.note,
        )
        for figure in figures
    ]
    return table(rows, ("", "check", "value", "at most", "how"), numbers=(2, 3))


def checked(name: str, value: float, bound: float, note: str, unit: str = "") -> CardFigure:
    """Return a figure that passes where its value is at most its bound.

    Examples
    --------
    >>> checked("no slip", 3e-16, 1e-12, "").passed
    True
    """
    value = float(value)
    return CardFigure(name, value, unit, bound, bool(value <= bound), note)


@dataclass(frozen=True, repr=False)
class Card(Serializable):
    """What was checked of a run, and how well it held.

    Parameters
    ----------
    title : str
        Of the run.
    method : str
        With equation and source, or tolerance.
    figures : tuple of CardFigure
        The checks.
    origin : str
        Where the card of a run that was loaded comes from: saved with it, or made anew. Cards that say the same are
        equal, whatever their origin.

    Examples
    --------
    >>> import trundle as tr
    >>> card = tr.Scenario.load("level-turntable-nudged").run().card()
    >>> card.passed, tr.Card.from_json(card.as_json()) == card
    (True, True)
    """

    title: str
    method: str
    figures: tuple[CardFigure, ...]
    origin: str = field(default="", compare=False, kw_only=True)

    @property
    def passed(self) -> bool:
        """Whether no figure failed."""
        return all(figure.passed is not False for figure in self.figures)

    @property
    def failures(self) -> tuple[CardFigure, ...]:
        """The figures that failed."""
        return tuple(figure for figure in self.figures if figure.passed is False)

    @property
    def outcome(self) -> str:
        """What came of the checks, in words."""
        return "every check held" if self.passed else f"{len(self.failures)} of the checks FAILED"

    def __getitem__(self, name: str) -> CardFigure:
        for figure in self.figures:
            if figure.name == name:
                return figure
        from ..errors import UnknownNameError

        raise UnknownNameError("figure of the card", name, [figure.name for figure in self.figures])

    def __str__(self) -> str:
        origin = [f"origin: {self.origin}"] if self.origin else []
        head = [self.title or "Verification card", f"method: {self.method}", *origin]
        return "\n".join([*head, *map(str, self.figures), self.outcome])

    def _headline(self) -> Headline:
        return Headline(self.title, self.outcome, self.passed)

    def _parts(self) -> Iterator[Markup]:
        yield paragraph(f"method: {self.method}")
        if self.origin:
            yield paragraph(f"origin: {self.origin}")
        yield table_of(self.figures)

    def as_dict(self) -> dict[str, Any]:
        """Return the card as plain dictionaries; numbers that are not finite become text."""
        figures = [{key: _plain(value) for key, value in asdict(figure).items()} for figure in self.figures]
        origin = {"origin": self.origin} if self.origin else {}
        return {"title": self.title, "method": self.method, **origin, "passed": self.passed, "figures": figures}

    def as_json(self) -> str:
        """Return the card as JSON text."""
        return json.dumps(self.as_dict(), ensure_ascii=False, allow_nan=False)

    @staticmethod
    def from_json(text: str) -> Card:
        """Read a card back.

        Parameters
        ----------
        text : str
            What `as_json` wrote.

        Returns
        -------
        Card
            Equal to the one written.
        """
        return Card.from_dict(json.loads(text))

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> Card:
        """Read a card back from plain dictionaries.

        Parameters
        ----------
        data : mapping
            What `as_dict` made.

        Returns
        -------
        Card
            Equal to the one described.
        """
        floats = ("value", "bound")
        figures = []
        for figure in data["figures"]:
            given: dict[str, Any] = {**figure, **{key: float(figure[key]) for key in floats if figure[key] is not None}}
            figures.append(CardFigure(**given))
        return Card(data["title"], data["method"], tuple(figures), origin=data.get("origin", ""))


def _plain(value: Any) -> Any:
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value
