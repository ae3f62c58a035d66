"""What a check found: a card like that of trundle's own runs, the first time it goes wrong, and the likely mistake."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ...display import Displayed, Headline, Markup, Plottable, number, pairs, paragraph
from ...verify import Card

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Mistake(Displayed):
    """A mistake that explains what was found.

    Parameters
    ----------
    name : str
        Short, for programs: "wrong-inertia-ratio".
    says : str
        What the mistake is, with the numbers that fit.
    check : str
        The figure of the card that it explains.
    before, after, bound : float
        That figure as it is, as it is once the mistake is allowed for, and the most that is then allowed.
    numbers : dict
        What was fitted, by name, in SI.
    named : bool
        Whether what was fitted is a number with a reason, such as k = 2/3; a free number explains more easily.
    removes : float
        Share of all that is off that is gone once the mistake is allowed for.

    Examples
    --------
    >>> print(Mistake("angles-in-degrees", "Ω is in deg/s.", "no slip", 0.9, 1e-9, 1e-5))
    Ω is in deg/s. (no slip: 0.9 as it is, 1e-09 with that undone)
    """

    name: str
    says: str
    check: str
    before: float
    after: float
    bound: float
    numbers: dict[str, float] = field(default_factory=dict)
    named: bool = True
    removes: float = 1.0

    def _headline(self) -> Headline:
        return Headline(self.name, self.says)

    def _parts(self) -> Iterator[Markup]:
        values = [(self.check, number(self.before, 2)), ("with that undone", number(self.after, 1))]
        yield pairs([*values, ("at most", number(self.bound, 2)), *((k, number(v)) for k, v in self.numbers.items())])

    def __str__(self) -> str:
        return f"{self.says} ({self.check}: {self.before:.2g} as it is, {self.after:.1g} with that undone)"


@dataclass(frozen=True, repr=False)
class Check(Card, Plottable):
    """The card of somebody else's motion or equations.

    Parameters
    ----------
    title, method, figures
        As of a `Card`.
    first_failure : float or None
        The first instant at which a figure is beyond its bound, s; None where all hold, or there is no time.
    likely : tuple of Mistake
        Each explains all that was found, alone or as several at once; more than one where the data cannot tell them
        apart.
    nearest : tuple of Mistake
        Where none explains all: those that explain most of it.
    blind : tuple of str
        Mistakes of the textbook that the data could not show if they had been made.
    decides : bool
        Whether any line could be told, and the data could have shown most of the mistakes of the textbook; where not,
        nothing that holds means anything.
    remark : str
        What else there is to say.
    apart : str
        How far their body is from ours in the end, in plain units.
    worst_state : dict or None
        Of a check of equations: the state at which they are furthest from the law.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("level-turntable-nudged").run()
    >>> checked = tr.check(run, "level-turntable-nudged")
    >>> checked.answer, checked.passed, checked.first_failure, checked.likely
    ('holds', True, None, ())
    """

    first_failure: float | None = None
    likely: tuple[Mistake, ...] = ()
    nearest: tuple[Mistake, ...] = ()
    blind: tuple[str, ...] = ()
    decides: bool = True
    remark: str = ""
    apart: str = ""
    worst_state: dict[str, Any] | None = None
    _drawn: Any = field(default=None, compare=False, repr=False)

    @property
    def answer(self) -> str:
        """The verdict in a word or two: "holds", "fails", or "cannot decide"."""
        if self.failures:
            return "fails"
        return "holds" if self.decides else "cannot decide"

    @property
    def passed(self) -> bool:
        """Whether no figure failed, and the data could have shown it."""
        return self.answer == "holds"

    @property
    def outcome(self) -> str:
        """What came of the checks, in words."""
        return super().outcome if self.decides or self.failures else "these data cannot decide"

    @property
    def verdict(self) -> str:
        """What was found beyond the figures, in lines."""
        lines = [self.apart] if self.apart else []
        lines += [] if self.first_failure is None else [f"first goes wrong at t = {self.first_failure:.6g} s"]
        if len(self.likely) == 1:
            lines.append(f"likely: {self.likely[0]}")
        elif self.likely:
            lines.append("each of these explains it, and what was given cannot tell them apart:")
            lines += [f"  - {mistake}" for mistake in self.likely]
        if self.remark:
            lines.append(self.remark)
        lines += [f"  - {mistake} It takes away {mistake.removes:.1%} of what is off." for mistake in self.nearest]
        if self.blind and not self.failures:
            could = "These data could not show" if self.decides else "They would look the same with"
            lines += [f"{could}:", *(f"  - {says}" for says in self.blind)]
        if self.worst_state is not None and not self.passed:
            lines.append("furthest off in this state:")
            lines += [f"  {name} = {value}" for name, value in self.worst_state.items()]
        return "\n".join(lines)

    def __str__(self) -> str:
        return "\n".join(filter(None, [super().__str__(), self.verdict]))

    def _parts(self) -> Iterator[Markup]:
        yield paragraph(self.verdict)
        yield from super()._parts()

    def as_dict(self) -> dict[str, Any]:
        """Return the card, the verdict, the first failure and the mistakes as plain dictionaries."""
        names = ("name", "says", "check", "before", "after", "bound", "numbers", "named", "removes")
        found = {
            "answer": self.answer,
            "first_failure": self.first_failure,
            "likely": [{name: getattr(mistake, name) for name in names} for mistake in self.likely],
            "nearest": [{name: getattr(mistake, name) for name in names} for mistake in self.nearest],
            "could_not_show": list(self.blind),
            "apart": self.apart,
            "remark": self.remark,
        }
        return super().as_dict() | found

    def plot(self) -> Figure:
        """Draw the residuals over time beside their bounds, and their path over ours.

        Raises
        ------
        TrundleError
            For a check of equations, which has no path.

        Examples
        --------
        >>> import trundle as tr
        >>> run = tr.Scenario.load("level-turntable-nudged").run()
        >>> tr.check(run, "level-turntable-nudged").plot().axes[-1].get_title(loc="left")
        'Path of the centre, support frame'
        """
        from ...errors import TrundleError
        from .figure import draw

        if self._drawn is None:
            raise TrundleError("A check of equations has no path to draw: print it instead.")
        return draw(self, self._drawn)
