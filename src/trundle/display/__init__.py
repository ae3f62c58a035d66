"""What results look like in a notebook: a title, a verdict, tables and formulas, as HTML that suits any theme."""

from .formulas import mathml
from .markup import (
    Markup,
    escaped,
    fold,
    joined,
    number,
    numbers,
    pairs,
    paragraph,
    records,
    section,
    table,
    verdict,
)
from .result import Displayed, Headline, Plottable, Serializable

__all__ = [
    "Displayed",
    "Headline",
    "Markup",
    "Plottable",
    "Serializable",
    "escaped",
    "fold",
    "joined",
    "mathml",
    "number",
    "numbers",
    "pairs",
    "paragraph",
    "records",
    "section",
    "table",
    "verdict",
]
