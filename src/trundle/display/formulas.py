"""Formulas in LaTeX as the MathML that browsers draw by themselves."""

from __future__ import annotations

import re
from functools import lru_cache
from html import escape
from typing import Any

from .markup import Markup

# The parts of an element, and what stands before each where its markup is taken out.
_SPELLED = {"mfrac": ("", "/"), "msup": ("", "^"), "msub": ("", "_"), "msubsup": ("", "_", "^"), "mroot": ("√", "^1/")}


@lru_cache(maxsize=256)
def mathml(latex: str, *, display: bool = False) -> Markup:
    r"""Return a formula as markup; what cannot be converted stands there as it was written.

    Examples
    --------
    >>> mathml("k < 1").count("<mi>"), mathml(r"\frac"), mathml("")
    (1, '<code>\\frac</code>', '')
    """
    if not latex:
        return Markup()
    from xml.etree.ElementTree import tostring
    from xml.sax.saxutils import unescape

    from latex2mathml import converter, exceptions

    found = [kind for kind in vars(exceptions).values() if isinstance(kind, type) and issubclass(kind, Exception)]
    refusals: tuple[type[Exception], ...] = (IndexError, KeyError, *found)
    safe = _for_converter(latex)
    try:
        formula = converter.convert_to_element(safe, display="block" if display else "inline")
    except refusals:
        return Markup(f"<code>{escape(latex)}</code>")
    for element in list(formula.iter()):
        _spell_out(element)
    return Markup(unescape(tostring(formula, encoding="unicode")))  # its texts are escaped already


def _spell_out(element: Any) -> None:
    """Put signs into a fraction, power, index, root or matrix that say the same without the markup."""
    parts = list(element)
    if element.tag == "mtr" and parts:
        for part in parts:
            part.append(_plain("; " if part is parts[-1] else " "))
    elif element.tag == "msqrt":
        element[:] = [_plain("√("), _row(*parts), _plain(")")]
    for i, sign in enumerate(_SPELLED.get(element.tag, ())):
        opened, closed = ("(", ")") if sum(bool(one.text) for one in parts[i].iter()) > 1 else ("", "")
        element[i] = _row(_plain(sign + opened), parts[i], _plain(closed))


def _row(*parts: Any) -> Any:
    from xml.etree.ElementTree import Element

    row = Element("mrow")
    row.extend(part for part in parts if part.text or len(part))
    return row


def _plain(sign: str) -> Any:
    from xml.etree.ElementTree import Element

    hidden = Element("mtext", {"class": "trundle-plain"})
    hidden.text = sign
    return hidden


def _for_converter(latex: str) -> str:
    """Say in other words what the converter does not know, or takes for markup."""
    text = latex.replace("<", r"\lt ").replace(">", r"\gt ").replace("{aligned}", "{split}")
    text = re.sub(r"\\(arg|sgn)(?![a-zA-Z])", r"\\operatorname{\1}", text)
    functions = r"\\(sin|cos|tan|log)(?![a-zA-Z])(\^(?:\d|\{[^{}]*\}))?"  # which it sets without room
    text = re.sub(functions, lambda found: f"\\text{{\u2009}}{found[0]}\\text{{\u2009}}", text)
    return re.sub(r"\\math(?:rm|sf)\{((?:[^{}]|\{[^{}]*\})*)\}", lambda found: _upright(found[1]), text)


def _upright(unit: str) -> str:
    """Return upright letters as text, so that a unit of one letter is upright, too."""
    return "{" + re.sub(r"(\\[a-zA-Z]+|\\.)|([a-zA-Z/]+)", lambda m: m[1] or rf"\text{{{m[2]}}}", unit) + "}"
