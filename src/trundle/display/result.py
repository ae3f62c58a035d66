"""What makes a result show itself: as HTML in a notebook, as its text on a terminal, as one line among other things."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from .markup import Markup, escaped, joined, verdict

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Headline:
    """What a result says first.

    Parameters
    ----------
    title : str
        What it is about; empty where it has no name.
    words : str
        What came of it.
    good : bool or None
        The verdict on it; None where it is neither good nor bad, or not known.

    Examples
    --------
    >>> Headline("Ball on a table", "every check held", True).good
    True
    """

    title: str = ""
    words: str = ""
    good: bool | None = None


class Displayed:
    """A result that shows itself. It says its headline and its parts; all else is the same for every result.

    Examples
    --------
    >>> class Answer(Displayed):
    ...     def _headline(self):
    ...         return Headline("6 × 7", "42")
    >>> Answer(), "42" in Answer()._repr_html_()
    (<Answer: 6 × 7, 42>, True)
    """

    def _headline(self) -> Headline:
        """Return what is said first; it has to be there at once."""
        return Headline()

    def _parts(self) -> Iterable[Markup]:
        """Return what stands below the headline in a notebook."""
        return ()

    def __repr__(self) -> str:
        head = self._headline()
        said = ", ".join(filter(None, (head.title, head.words)))
        return f"<{type(self).__name__}: {said}>" if said else f"<{type(self).__name__}>"

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        """Tell IPython's terminal: alone the whole text that `print` shows, within other things the one line."""
        printer.text(str(self) if len(printer.stack) == 1 and not cycle else repr(self))

    def _repr_html_(self) -> str:
        head = self._headline()
        kind = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(self).__name__).capitalize()
        name = f"<b>{escaped(head.title)}</b> <small>{kind}</small>" if head.title else f"<b>{kind}</b>"
        said = joined(filter(None, (Markup(name), verdict(head.good, head.words))), " · ")
        parts = joined(self._parts())
        return f'<div class="trundle-shown"><style>{_style()}</style><p class="trundle-head">{said}</p>{parts}</div>'


class Plottable(Displayed):
    """A result that can be drawn."""

    def plot(self) -> Figure:
        """Draw it.

        Returns
        -------
        matplotlib.figure.Figure
            Needs neither a display nor pyplot: notebooks show it, and `savefig` saves it.
        """
        raise NotImplementedError


class Serializable(Displayed):
    """A result that says all of itself in plain types."""

    def as_dict(self) -> dict[str, Any]:
        """Return what is said, in SI units.

        Returns
        -------
        dict
            As JSON takes it; the command prints it with ``--json``.
        """
        raise NotImplementedError


@lru_cache(maxsize=1)
def _style() -> str:
    return " ".join((files(__package__) / "style.css").read_text(encoding="utf-8").split())
