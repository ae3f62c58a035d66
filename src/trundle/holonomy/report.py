"""The findings in words: as plain text and as LaTeX."""

from __future__ import annotations

import re
import textwrap
from typing import TYPE_CHECKING

import sympy as sp
from sympy.printing.pretty.pretty_symbology import pretty_symbol, pretty_use_unicode
from sympy.printing.str import StrPrinter

if TYPE_CHECKING:
    from .analysis import ConstraintAnalysis, Field

WIDTH = 96
LONGEST = 300  # operations in a field that is printed
_POWERS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


class _Hand(StrPrinter):
    """SymPy's own text, but a sum does not begin with a minus where it need not."""

    def _print_Add(self, expr: sp.Add, order: str | None = None) -> str:
        terms = list(self._as_ordered_terms(expr, order=order))
        first = next((i for i, term in enumerate(terms) if not term.could_extract_minus_sign()), 0)
        text = ""
        for term in [terms[first], *terms[:first], *terms[first + 1 :]]:
            part = f"({self._print(term)})" if term.is_Add else self._print(term)
            text += part if not text else f" - {part[1:]}" if part.startswith("-") else f" + {part}"
        return text


def text_of(e: sp.Expr) -> str:
    """Write an expression on one line, as it is written by hand.

    Parameters
    ----------
    e : sympy.Expr
        What to write.

    Returns
    -------
    str
        Greek letters as such, small powers raised.

    Examples
    --------
    >>> phi, a = sp.symbols("phi a")
    >>> text_of(-(a**2) * sp.sin(phi) / 2)
    '−a² sin φ/2'
    """
    text = _Hand().doprint(e)
    text = re.sub(r"[A-Za-z]\w*", lambda name: _letters(name[0]), text)
    text = re.sub(r"\*\*(\d+)", lambda power: power[1].translate(_POWERS), text)
    text = re.sub(r"\b(sin|cos|tan|log|exp)([⁰¹²³⁴⁵⁶⁷⁸⁹]*)\(([^()+\- ]+)\)([⁰¹²³⁴⁵⁶⁷⁸⁹]*)", r"\1\4 \3", text)
    return text.replace("**", "^").replace("*", " ").replace("-", "−")


def _letters(name: str) -> str:
    """Return a symbol's name in Greek letters, whatever SymPy made of the standard output when it was loaded."""
    before = pretty_use_unicode(True)
    try:
        return str(pretty_symbol(name))
    finally:
        pretty_use_unicode(before)


def form_of(row: list[sp.Expr], q: tuple[sp.Symbol, ...]) -> str:
    """Write a row as a Pfaffian form, such as dx − a dφ."""
    return _linear([(entry, f"d{text_of(c)}") for entry, c in zip(row, q, strict=True)])


def field_of(field: Field, q: tuple[sp.Symbol, ...]) -> str:
    """Write a field by its rates, as a list of those that are not zero."""
    if sum(sp.count_ops(entry) for entry in field.components) > LONGEST:
        return "too long to print; see its components"
    dotted = [(entry, f"{text_of(c)}\u0307") for entry, c in zip(field.components, q, strict=True)]
    shown = [f"{name} = {text_of(entry)}" for entry, name in dotted if entry != 0]
    return ",  ".join(shown) or "nothing"


def _linear(terms: list[tuple[sp.Expr, str]]) -> str:
    text = ""
    for entry, name in terms:
        if entry == 0:
            continue
        negative = _negative(entry)
        size = -entry if negative else entry
        factor = "" if size == 1 else f"({text_of(size)}) " if size.is_Add else f"{text_of(size)} "
        sign = (" − " if negative else " + ") if text else ("−" if negative else "")
        text += f"{sign}{factor}{name}"
    return text or "0"


def _negative(e: sp.Expr) -> bool:
    return all(bool(term.could_extract_minus_sign()) for term in sp.Add.make_args(e))


def report(found: ConstraintAnalysis) -> str:
    """Write the findings as plain text.

    Parameters
    ----------
    found : ConstraintAnalysis
        The findings.

    Returns
    -------
    str
        Lines of at most 96 characters where the formulas let them.

    Examples
    --------
    >>> from trundle.holonomy.system import PfaffianSystem
    >>> print(report(PfaffianSystem.load("cylinder").analyse()).splitlines()[3])
    constraint    dx − a dφ = 0
    """
    q, telling = found.system.coordinates, found.system.telling
    rows = found.system.rows.tolist()
    lines = [telling.title, ""] if telling.title else []
    lines += _entry("coordinates", telling.coordinates or ", ".join(text_of(c) for c in q))
    lines += _entries("constraint" + "s" * (len(rows) > 1), [f"{form_of(row, q)} = 0" for row in rows] or ["none"])
    lines += _entry("rank", _rank(found))
    lines += _entries("free motions", [f"{f.name}:  {field_of(f, q)}" for f in found.fields] or ["none"])
    lines += _entry("growth", f"({', '.join(map(str, found.growth))})  {_growth(found)}")
    shown = (*found.also, *found.brackets)
    for field in shown:
        lines += _entries("brackets" if field is shown[0] else "", [f"{field.name}:  {field_of(field, q)}"])
        lines += _entry("", field.words) if field.words else []
    lines += _entry("verdict", f"{found.verdict.upper()}. {_meaning(found)}")
    lines += _entry("", telling.verdict) if telling.verdict else []
    for f in found.integrals:
        lines += _entry(
            "constant",
            f"{text_of(_collected(f, q))} = const.   (proved: its differential is a combination of the rows)",
        )
    if missing := found.integrable - len(found.integrals):
        more = (
            f"{missing} more exist{'s' * (missing == 1)}"
            if found.integrals
            else f"{missing} exist{'s' * (missing == 1)}"
        )
        lines += _entry("", f"{more} by Frobenius's theorem; no closed form of a kind that is tried here fits.")
    lines += _special(found)
    return "\n".join(line.rstrip() for line in lines)


def _collected(f: sp.Expr, q: tuple[sp.Symbol, ...]) -> sp.Expr:
    return sp.collect(f, q) if f.is_polynomial(*q) else f


def _rank(found: ConstraintAnalysis) -> str:
    rows = len(found.system.rows.tolist())
    spare = rows - found.rank
    also = f" ({spare} of the {rows} rows follow{'s' * (spare == 1)} from the others)" if spare else ""
    free = found.growth[0]
    return f"{found.rank}{also}: of {found.size} directions {free} stay{'s' * (free == 1)} free"


def _growth(found: ConstraintAnalysis) -> str:
    if len(found.growth) == 1:
        return "no bracket leads out of what is free already"
    depth = len(found.growth) - 1
    return f"directions reached with brackets of up to {depth + 1} motions, at a generic place"


def _meaning(found: ConstraintAnalysis) -> str:
    left = found.integrable
    if found.verdict == "unconstrained":
        return "Nothing is constrained."
    if found.verdict == "holonomic":
        which = "The constraint can" if found.rank == 1 else "All constraints can"
        return f"{which} be integrated, and {_count(left, 'coordinate')} eliminated."
    if found.verdict == "nonholonomic":
        return (
            "No function of the coordinates stays constant: none of them can be eliminated, and from a generic place "
            "every place around it can be reached (theorem of Chow and Rashevskii)."
        )
    return (
        f"Of {found.rank} constraints {left} can be integrated, in combination; the other {found.rank - left} cannot, "
        "and eliminate nothing."
    )


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'s' * (number != 1)}"


def _special(found: ConstraintAnalysis) -> list[str]:
    lines: list[str] = []
    for place, growth in found.special:
        where = ", ".join(f"{text_of(k)} = {text_of(v)}" for k, v in place.items())
        lines += _entry("but" if not lines else "", f"({', '.join(map(str, growth))}) where {where}")
    if not found.looks_for_special:
        lines += _entry("", "Places where the growth vector differs were not looked for: the brackets are too long.")
    if found.special and found.system.telling.chart:
        lines += _entry("", found.system.telling.chart)
    return lines


def _entry(name: str, text: str) -> list[str]:
    return textwrap.wrap(
        text, WIDTH, initial_indent=f"{name:<14}", subsequent_indent=" " * 14, break_long_words=False
    ) or [name]


def _entries(name: str, texts: list[str]) -> list[str]:
    return [f"{name if i == 0 else '':<14}{text}" for i, text in enumerate(texts)]


def latex(found: ConstraintAnalysis) -> str:
    r"""Write the findings as LaTeX, to be set with amsmath.

    Parameters
    ----------
    found : ConstraintAnalysis
        The findings.

    Returns
    -------
    str
        An ``align*`` environment and a line of text.

    Examples
    --------
    >>> from trundle.holonomy.system import PfaffianSystem
    >>> print(latex(PfaffianSystem.load("cylinder").analyse()).splitlines()[1])
    &dx - a\,d\phi = 0 && \text{constraint}\\
    """
    q = found.system.coordinates
    lines = []
    for row in found.system.rows.tolist():
        terms = [(e, c) for e, c in zip(row, q, strict=True) if e != 0]
        lines.append((_latex_sum(terms, "d{}") + " = 0", "constraint"))
    for field in (*found.fields, *found.brackets):
        terms = [(e, c) for e, c in zip(field.components, q, strict=True) if e != 0]
        lines.append((_latex_sum(terms, r"\partial_{{{}}}"), field.name))
    lines += [(f"{sp.latex(f)} = \\text{{const.}}", "integrated") for f in found.integrals]
    body = "\\\\\n".join(f"&{left} && \\text{{{right}}}" for left, right in lines)
    growth = ", ".join(map(str, found.growth))
    return (
        f"\\begin{{align*}}\n{body}\n\\end{{align*}}\nRank {found.rank}, growth vector $({growth})$: {found.verdict}."
    )


def _latex_sum(terms: list[tuple[sp.Expr, sp.Symbol]], basis: str) -> str:
    text = ""
    for entry, c in terms:
        negative = _negative(entry)
        size = -entry if negative else entry
        written = sp.latex(size)
        factor = "" if size == 1 else (rf"\left({written}\right)\," if size.is_Add else rf"{written}\,")
        sign = (" - " if negative else " + ") if text else ("-" if negative else "")
        text += sign + factor + basis.format(sp.latex(c))
    return text or "0"
