"""The findings in words: as plain text, as HTML and as LaTeX."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp
from sympy.printing.pretty.pretty_symbology import pretty_symbol, pretty_use_unicode
from sympy.printing.str import StrPrinter

from ...display import Markup, joined, mathml, pairs

if TYPE_CHECKING:
    from .analysis import ConstraintAnalysis, Field
    from .system import PfaffianSystem

WIDTH = 96
LONGEST = 300  # operations in a field that is printed
TOO_LONG = "too long to print; see its components"
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
        return TOO_LONG
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


@dataclass(frozen=True)
class _Finding:
    """One thing that is said, as text; where it is a formula, in LaTeX besides."""

    text: str
    latex: str = ""
    label: str = ""  # before the formula
    note: str = ""  # behind it


_Findings = Iterator[tuple[str, list[_Finding]]]  # each name with what is said under it


def report(found: ConstraintAnalysis) -> str:
    """Write the findings as plain text.

    Examples
    --------
    >>> from trundle.analysis.holonomy.system import PfaffianSystem
    >>> print(report(PfaffianSystem.load("cylinder").analyse()).splitlines()[3])
    constraint    dx − a dφ = 0
    """
    return _text(found.system.telling.title, [*_given(found.system), *_found(found)])


def report_system(system: PfaffianSystem) -> str:
    """Write coordinates and constraints as plain text; as `report`."""
    return _text(system.telling.title, _given(system))


def shown(found: ConstraintAnalysis) -> Markup:
    """Return the findings as a notebook shows them, the formulas as MathML."""
    return _markup([*_given(found.system), *_found(found)])


def shown_system(system: PfaffianSystem) -> Markup:
    """Return coordinates and constraints as a notebook shows them."""
    return _markup(_given(system))


def _text(title: str, findings: Iterable[tuple[str, list[_Finding]]]) -> str:
    lines = [title, ""] if title else []
    for name, said in findings:
        for i, one in enumerate(said):
            whole = f"{one.label}:  {one.text}" if one.label else f"{one.text}{one.note and f'   {one.note}'}"
            head = f"{'' if i else name:<14}"
            wrapped = textwrap.wrap(
                whole, WIDTH, initial_indent=head, subsequent_indent=" " * 14, break_long_words=False
            )
            lines += [head + whole] if one.latex and not one.note else wrapped
    return "\n".join(line.rstrip() for line in lines)


def _markup(findings: Iterable[tuple[str, list[_Finding]]]) -> Markup:
    def line(one: _Finding) -> Markup:
        formula = mathml(one.latex) if one.latex else one.text
        return joined([f"{one.label}:  " if one.label else "", formula, f"  {one.note}" if one.note else ""])

    return pairs((name, joined(map(line, said), "\n")) for name, said in findings)


def _given(system: PfaffianSystem) -> _Findings:
    q, rows = system.coordinates, system.rows.tolist()
    yield "coordinates", [_Finding(system.telling.coordinates or ", ".join(text_of(c) for c in q))]
    forms = [_Finding(f"{form_of(row, q)} = 0", f"{_latex_sum(_terms(row, q), 'd{}')} = 0") for row in rows]
    yield "constraint" + "s" * (len(rows) > 1), forms or [_Finding("none")]


def _found(found: ConstraintAnalysis) -> _Findings:
    q, telling = found.system.coordinates, found.system.telling
    yield "rank", [_Finding(_rank(found))]
    yield "free motions", [_motion(field, q) for field in found.fields] or [_Finding("none")]
    yield "growth", [_Finding(f"({', '.join(map(str, found.growth))})  {_growth(found)}")]
    brackets = [[_motion(field, q), *[_Finding(field.words)] * bool(field.words)] for field in _brackets(found)]
    yield "brackets", [one for several in brackets for one in several]
    verdict = [f"{found.verdict.upper()}. {_meaning(found)}", telling.verdict]
    yield "verdict", [_Finding(text) for text in verdict if text]
    yield "constant", _constants(found)
    yield "but", _special(found)


def _brackets(found: ConstraintAnalysis) -> tuple[Field, ...]:
    return (*found.also, *found.brackets)


def _motion(field: Field, q: tuple[sp.Symbol, ...]) -> _Finding:
    text = field_of(field, q)
    rates = [rf"\dot{{{_latex(c)}}} = {_latex(e)}" for e, c in _terms(field.components, q)]
    return _Finding(text, "" if text == TOO_LONG else r",\quad ".join(rates), field.name)


def _constants(found: ConstraintAnalysis) -> list[_Finding]:
    q, proved = found.system.coordinates, "(proved: its differential is a combination of the rows)"
    kept = [_collected(f, q) for f in found.integrals]
    said = [_Finding(f"{text_of(f)} = const.", rf"{_latex(f)} = \text{{const.}}", note=proved) for f in kept]
    if missing := found.integrable - len(kept):
        more = "more exist" if kept else "exist"
        rest = "by Frobenius's theorem; no closed form of a kind that is tried here fits."
        said.append(_Finding(f"{missing} {more}{'s' * (missing == 1)} {rest}"))
    return said


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


def _special(found: ConstraintAnalysis) -> list[_Finding]:
    said = []
    for place, growth in found.special:
        where = ", ".join(f"{text_of(k)} = {text_of(v)}" for k, v in place.items())
        said.append(f"({', '.join(map(str, growth))}) where {where}")
    if not found.looks_for_special:
        said.append("Places where the growth vector differs were not looked for: the brackets are too long.")
    if found.special and found.system.telling.chart:
        said.append(found.system.telling.chart)
    return [_Finding(text) for text in said]


def latex(found: ConstraintAnalysis) -> str:
    r"""Write the findings as LaTeX, to be set with amsmath.

    Examples
    --------
    >>> from trundle.analysis.holonomy.system import PfaffianSystem
    >>> print(latex(PfaffianSystem.load("cylinder").analyse()).splitlines()[1])
    &dx - a\,d\phi = 0 && \text{constraint}\\
    """
    q = found.system.coordinates
    lines = [(_latex_sum(_terms(row, q), "d{}") + " = 0", "constraint") for row in found.system.rows.tolist()]
    fields = (*found.fields, *found.brackets)
    lines += [(_latex_sum(_terms(field.components, q), r"\partial_{{{}}}"), field.name) for field in fields]
    lines += [(f"{_latex(f)} = \\text{{const.}}", "integrated") for f in found.integrals]
    body = "\\\\\n".join(f"&{left} && \\text{{{right}}}" for left, right in lines)
    growth = ", ".join(map(str, found.growth))
    return (
        f"\\begin{{align*}}\n{body}\n\\end{{align*}}\nRank {found.rank}, growth vector $({growth})$: {found.verdict}."
    )


def _latex(e: sp.Expr) -> str:
    return str(sp.latex(e, fold_func_brackets=True))


def _terms(entries: Iterable[sp.Expr], q: tuple[sp.Symbol, ...]) -> list[tuple[sp.Expr, sp.Symbol]]:
    return [(entry, c) for entry, c in zip(entries, q, strict=True) if entry != 0]


def _latex_sum(terms: list[tuple[sp.Expr, sp.Symbol]], basis: str) -> str:
    text = ""
    for entry, c in terms:
        negative = _negative(entry)
        size = -entry if negative else entry
        written = _latex(size)
        factor = "" if size == 1 else (rf"\left({written}\right)\," if size.is_Add else rf"{written}\,")
        sign = (" - " if negative else " + ") if text else ("-" if negative else "")
        text += sign + factor + basis.format(_latex(c))
    return text or "0"
