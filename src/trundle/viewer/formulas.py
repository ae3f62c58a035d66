"""Formulas of a scene, in LaTeX, as the MathML that browsers draw by themselves."""

from __future__ import annotations

import re
from functools import lru_cache
from html import escape


@lru_cache(maxsize=256)
def mathml(latex: str, *, display: bool = False) -> str:
    r"""Return a formula as markup; what cannot be converted stands there as it was written.

    Parameters
    ----------
    latex : str
        Without dollar signs.
    display : bool
        Whether it stands on a line of its own.

    Returns
    -------
    str
        A `math` element.

    Examples
    --------
    >>> mathml("k < 1").count("<mi>"), mathml(r"\frac"), mathml("")
    (1, '<code>\\frac</code>', '')
    """
    if not latex:
        return ""
    from latex2mathml import converter, exceptions

    found = [kind for kind in vars(exceptions).values() if isinstance(kind, type) and issubclass(kind, Exception)]
    refusals: tuple[type[Exception], ...] = (IndexError, KeyError, *found)
    safe = _for_converter(latex)
    try:
        return converter.convert(safe, display="block" if display else "inline")
    except refusals:
        return f"<code>{escape(latex)}</code>"


def _for_converter(latex: str) -> str:
    """Say in other words what the converter does not know, or takes for markup."""
    text = latex.replace("<", r"\lt ").replace(">", r"\gt ").replace("{aligned}", "{split}")
    text = re.sub(r"\\(arg|sgn)(?![a-zA-Z])", r"\\operatorname{\1}", text)
    text = re.sub(r"\\(sin|cos)(?![a-zA-Z])(\^\d)?", r"\\,\\\1\2\\,", text)  # which it sets without room
    return re.sub(r"\\math(?:rm|sf)\{((?:[^{}]|\{[^{}]*\})*)\}", lambda found: _upright(found[1]), text)


def _upright(unit: str) -> str:
    """Return upright letters as text, so that a unit of one letter is upright, too."""
    return "{" + re.sub(r"(\\[a-zA-Z]+|\\.)|([a-zA-Z/]+)", lambda m: m[1] or rf"\text{{{m[2]}}}", unit) + "}"
