"""The verification card: the figures that say why a trajectory can be trusted."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class CardFigure:
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

    def __str__(self) -> str:
        verdict = {True: "ok", False: "FAIL", None: "-"}[self.passed]
        value = f"{self.value:.6g} {self.unit}" if self.passed is None else f"{self.value:.2g} {self.unit}"
        if self.bound is not None and self.passed is None:
            value = f"{self.value:.2g} {self.unit}"
        limit = "" if self.bound is None else f"at most {self.bound:.2g}"
        return f"{verdict:<5} {self.name:<40}  {value.strip():<16} {limit:<15}  {self.note}".rstrip()


def checked(name: str, value: float, bound: float, note: str, unit: str = "") -> CardFigure:
    """Return a figure that passes where its value is at most its bound.

    Parameters
    ----------
    name, value, bound, note, unit
        As of `CardFigure`.

    Returns
    -------
    CardFigure
        With its verdict.

    Examples
    --------
    >>> checked("no slip", 3e-16, 1e-12, "").passed
    True
    """
    value = float(value)
    return CardFigure(name, value, unit, bound, bool(value <= bound), note)


@dataclass(frozen=True)
class Card:
    """What was checked of a run, and how well it held.

    Parameters
    ----------
    title : str
        Of the run.
    method : str
        With equation and source, or tolerance.
    figures : tuple of CardFigure
        The checks.

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

    @property
    def passed(self) -> bool:
        """Whether no figure failed."""
        return all(figure.passed is not False for figure in self.figures)

    @property
    def failures(self) -> tuple[CardFigure, ...]:
        """The figures that failed."""
        return tuple(figure for figure in self.figures if figure.passed is False)

    @property
    def summary(self) -> str:
        """The verdict in a line."""
        return "every check held" if self.passed else f"{len(self.failures)} of the checks FAILED"

    def __getitem__(self, name: str) -> CardFigure:
        for figure in self.figures:
            if figure.name == name:
                return figure
        from ..errors import UnknownNameError

        raise UnknownNameError("figure of the card", name, [figure.name for figure in self.figures])

    def __str__(self) -> str:
        lines = [self.title or "Verification card", f"method: {self.method}", *map(str, self.figures), self.summary]
        return "\n".join(lines)

    def as_dict(self) -> dict[str, Any]:
        """Return the card as plain dictionaries; numbers that are not finite become text."""
        figures = [{key: _plain(value) for key, value in asdict(figure).items()} for figure in self.figures]
        return {"title": self.title, "method": self.method, "passed": self.passed, "figures": figures}

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
        data = json.loads(text)
        for figure in data["figures"]:
            figure.update({key: float(figure[key]) for key in ("value", "bound") if figure[key] is not None})
        figures = [CardFigure(**figure) for figure in data["figures"]]
        return Card(data["title"], data["method"], tuple(figures))


def _plain(value: Any) -> Any:
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value
