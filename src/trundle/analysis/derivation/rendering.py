"""A derivation as text for a terminal, as Markdown, as LaTeX, as HTML and as what JSON can hold."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ...display import Markup, fold, joined, mathml, paragraph, section, table
from .printers import FormulaPrinter, TextPrinter, split
from .symbols import MEANINGS

if TYPE_CHECKING:
    from .steps import Derivation, Step

_MARGIN = "   "
_PROVED = (
    "{count} equations. Each is proved: its two sides are computed from what the rolling law itself returns for "
    "symbols, and their difference is exactly 0."
)


def text(derivation: Derivation, width: int) -> str:
    """Return a derivation for a terminal.

    Examples
    --------
    >>> import trundle as tr
    >>> print(text(tr.derive("turntable"), 80).splitlines()[0])
    Ball on a level turntable
    """
    printer = TextPrinter(width - 2 * len(_MARGIN))
    lines = [derivation.title, "─" * len(derivation.title), *_wrapped(derivation.introduction, width, ""), ""]
    rows = [
        (_in_line(symbol), f"{meaning}, {unit}" if unit != "1" else meaning)
        for symbol, meaning, unit in _symbols_of(derivation)
    ]
    broad = max((_columns(name) for name, _ in rows), default=0)
    lines += [f"{_MARGIN}{name}{' ' * (broad - _columns(name))}  {meaning}" for name, meaning in rows]
    for number, step in enumerate(derivation.steps, 1):
        lines += ["", f"{number}. {step.title}", *_wrapped(_said(step, _in_line), width, _MARGIN)]
        for equation in step.equations:
            lines += ["", *(f"{_MARGIN * 2}{line}".rstrip() for line in printer.doprint(equation.formula).split("\n"))]
    if derivation.numbers:
        lines += ["", "With the scenario's numbers", ""]
        lines += [
            f"{_MARGIN * 2}{_in_line(n.symbol)} = {_value(n.value)} {n.unit}".rstrip() for n in derivation.numbers
        ]
    lines += ["", *_wrapped(_PROVED.format(count=derivation.count), width, "")]
    return "\n".join(lines) + "\n"


def markdown(derivation: Derivation) -> str:
    """Return a derivation in Markdown; each formula is a block between lines of ``$$``.

    Examples
    --------
    >>> import trundle as tr
    >>> print(markdown(tr.derive("turntable")).splitlines()[0])
    # Ball on a level turntable
    """
    printer = FormulaPrinter()

    def inline(expression: Any) -> str:
        return f"${printer.doprint(expression)}$"

    lines = [
        f"# {derivation.title}",
        "",
        derivation.introduction,
        "",
        "| symbol | meaning | unit |",
        "| --- | --- | --- |",
    ]
    lines += [f"| {inline(symbol)} | {meaning} | {unit} |" for symbol, meaning, unit in _symbols_of(derivation)]
    for number, step in enumerate(derivation.steps, 1):
        lines += ["", f"## {number}. {step.title}", "", _said(step, inline)]
        for equation in step.equations:
            lines += ["", "$$", printer.doprint(equation.formula), "$$"]
    if derivation.numbers:
        lines += ["", "## With the scenario's numbers", ""]
        lines += [f"- {inline(n.symbol)} = {_value(n.value)} {n.unit}".rstrip() for n in derivation.numbers]
    return "\n".join([*lines, "", _PROVED.format(count=derivation.count), ""])


def latex(derivation: Derivation) -> str:
    r"""Return a derivation as a fragment of LaTeX.

    Examples
    --------
    >>> import trundle as tr
    >>> print(latex(tr.derive("turntable")).splitlines()[1])
    \section*{Ball on a level turntable}
    """
    printer = FormulaPrinter()

    def inline(expression: Any) -> str:
        return f"${printer.doprint(expression)}$"

    lines = ["% needs \\usepackage{amsmath}", rf"\section*{{{_escaped(derivation.title)}}}"]
    lines += [_escaped(derivation.introduction), ""]
    meanings = [f"{inline(symbol)}: {_escaped(meaning)}" for symbol, meaning, _ in _symbols_of(derivation)]
    lines += ["Here " + "; ".join(meanings) + "."]
    for number, step in enumerate(derivation.steps, 1):
        lines += ["", rf"\subsection*{{{number}. {_escaped(step.title)}}}", _said(step, inline, _escaped)]
        for equation in step.equations:
            lines += [r"\[", printer.doprint(equation.formula), r"\]"]
    if derivation.numbers:
        values = [rf"{inline(n.symbol)} = {_latex_number(n.value)}~{_escaped(n.unit)}" for n in derivation.numbers]
        lines += ["", r"\subsection*{With the scenario's numbers}", "; ".join(values) + "."]
    return "\n".join([*lines, "", _PROVED.format(count=derivation.count), ""])


def shown(derivation: Derivation) -> Markup:
    """Return a derivation as a notebook shows it, its formulas as MathML.

    Examples
    --------
    >>> import trundle as tr
    >>> shown(tr.derive("turntable")).count("<math") > 20
    True
    """
    symbols = [(mathml(latex_of(symbol)), meaning, unit) for symbol, meaning, unit in _symbols_of(derivation)]
    values = [(mathml(latex_of(n.symbol)), f"{_value(n.value)} {n.unit}") for n in derivation.numbers]
    steps = [section(f"{number}. {step.title}", shown_step(step)) for number, step in enumerate(derivation.steps, 1)]
    return joined(
        [
            paragraph(derivation.introduction),
            fold("Symbols", table(symbols, ("symbol", "meaning", "unit"))),
            *steps,
            section("With the scenario's numbers", table(values)),
            paragraph(_PROVED.format(count=derivation.count)),
        ]
    )


def shown_step(step: Step) -> Markup:
    """Return one step as a notebook shows it: its sentence, and its equations."""
    told = _pieces(step, lambda expression: mathml(latex_of(expression)))
    return joined([paragraph(*told), *(mathml(latex_of(one.formula), display=True) for one in step.equations)])


def latex_of(expression: Any) -> str:
    """Return a formula in LaTeX, without dollar signs."""
    return str(FormulaPrinter().doprint(expression))


def as_dict(derivation: Derivation) -> dict[str, Any]:
    """Return a derivation as nested dictionaries, lists, strings and numbers.

    Examples
    --------
    >>> import trundle as tr
    >>> as_dict(tr.derive("turntable"))["steps"][0]["equations"][0]["residual"]
    '0'
    """
    formula, plain = FormulaPrinter(), TextPrinter()

    def inline(expression: Any) -> str:
        return f"${formula.doprint(expression)}$"

    def equation(one: Any) -> dict[str, str]:
        residual = set(one.residual) if hasattr(one.residual, "shape") else {one.residual}
        shown = ", ".join(sorted(map(str, residual)))
        return {"latex": formula.doprint(one.formula), "text": plain.doprint(one.formula), "residual": shown}

    return {
        "name": derivation.name,
        "title": derivation.title,
        "introduction": derivation.introduction,
        "symbols": [
            {"latex": formula.doprint(symbol), "text": _in_line(symbol), "meaning": meaning, "unit": unit}
            for symbol, meaning, unit in _symbols_of(derivation)
        ],
        "steps": [
            {"title": step.title, "sentence": _said(step, inline), "equations": list(map(equation, step.equations))}
            for step in derivation.steps
        ],
        "numbers": [
            {
                "latex": formula.doprint(n.symbol),
                "text": _in_line(n.symbol),
                "value": [n.value.real, n.value.imag] if isinstance(n.value, complex) else n.value,
                "unit": n.unit,
            }
            for n in derivation.numbers
        ],
    }


def _said(step: Step, inline: Callable[[Any], str], plain: Callable[[str], str] = str) -> str:
    """Put the formulas of a sentence in their places."""
    return "".join(_pieces(step, inline, plain))


def _pieces(step: Step, inline: Callable[[Any], str], plain: Callable[[str], str] = str) -> list[str]:
    pieces = re.split(r"\{(\w+)\}", step.sentence)
    return [inline(step.words[piece]) if i % 2 else plain(piece) for i, piece in enumerate(pieces)]


def _symbols_of(derivation: Derivation) -> list[tuple[Any, str, str]]:
    used = set().union(
        *(equation.formula.free_symbols for step in derivation.steps for equation in step.equations), [None]
    )
    return [(symbol, meaning, unit) for symbol, (meaning, unit) in MEANINGS.items() if symbol in used]


_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def _in_line(expression: Any) -> str:
    """Return an expression on one line of text."""
    if getattr(expression, "is_Relational", False):
        return f"{_in_line(expression.lhs)} = {_in_line(expression.rhs)}"
    shown = TextPrinter(1000).doprint(expression)
    if "\n" not in shown:
        return shown
    if expression.is_Pow and expression.exp.is_Integer:
        return _in_line(expression.base) + str(expression.exp).translate(_RAISED)
    if expression.is_Mul or expression.is_Rational:
        negative, above, below = split(expression)
        over = "⋅".join(map(_in_line, above)) + ("/" + "/".join(map(_in_line, below)) if below else "")
        return "-" + over if negative else over
    return str(expression)


def _columns(shown: str) -> int:
    from unicodedata import combining

    return sum(not combining(character) for character in shown)


def _wrapped(sentence: str, width: int, margin: str) -> list[str]:
    return textwrap.wrap(sentence, width, initial_indent=margin, subsequent_indent=margin)


def _value(value: Any) -> str:
    if isinstance(value, complex):
        return f"{value.real:.6g} {'-' if value.imag < 0 else '+'} {abs(value.imag):.6g} i"
    return f"{value:.6g}"


def _latex_number(value: Any) -> str:
    shown = re.sub(r"e([+-])0*(\d+)", lambda m: rf" \times 10^{{{m[1].strip('+')}{m[2]}}}", _value(value))
    return f"${shown}$"


_SPECIAL = {"²": "$^2$", "³": "$^3$", "%": r"\%", "&": r"\&", "#": r"\#", "_": r"\_", "×": r"$\times$"}


def _escaped(plain: str) -> str:
    return "".join(_SPECIAL.get(character, character) for character in plain)
