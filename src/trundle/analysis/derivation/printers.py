"""Formulas in print: SymPy's printers, with the order of terms and factors kept as physicists write them.

Signs are taken from the numerical factor alone, so that what is printed is term by term what was proved.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any
from unicodedata import normalize

import sympy as sp
from sympy.printing.latex import LatexPrinter
from sympy.printing.pretty.pretty import PrettyPrinter
from sympy.printing.pretty.pretty_symbology import greek_unicode
from sympy.printing.pretty.stringpict import prettyForm, stringPict

_NAME = re.compile(r"(?P<base>[A-Za-z]+?)(?P<accent>ddot|dot|hat)?(?:_(?P<sub>\w+))?")
_ACCENT_MARK = {"dot": "\u0307", "ddot": "\u0308", "hat": "\u0302", None: ""}
_GREEK = greek_unicode | {"varphi": "φ", "varrho": "ϱ", "varpi": "ϖ", "oo": "∞", "ell": "ℓ", "phi": "ϕ"}
_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
# What stands before what in a product: numbers, mass, inertia, lengths, rates, gravity, then all else.
_FIRST = ("k", "I", "m", "J", "a", "b", "ell", "c", "gamma", "omega", "lambda", "lambda_0", "kappa", "g")


def _parts(name: str) -> tuple[str, str | None, str]:
    match = _NAME.fullmatch(name)
    if match is None:
        return name, None, ""
    return match["base"], match["accent"], match["sub"] or ""


def unicode_name(name: str) -> str:
    """Return the name of a symbol in Unicode.

    Examples
    --------
    >>> unicode_name("Omegadot_x"), unicode_name("zeta_0")
    ('Ω̇_x', 'ζ₀')
    """
    base, accent, sub = _parts(name)
    index = "" if not sub else sub.translate(_LOWERED) if sub.isdigit() else "_" + _GREEK.get(sub, sub)
    return normalize("NFC", _GREEK.get(base, base) + _ACCENT_MARK[accent]) + index


def latex_name(name: str, *, arrow: bool = False) -> str:
    r"""Return the name of a symbol in LaTeX, with an arrow if it is a vector.

    Examples
    --------
    >>> print(latex_name("Vdot", arrow=True), latex_name("zeta_0"))
    \dot{\vec{V}} \zeta_{0}
    """
    base, accent, sub = _parts(name)
    text = "\\" + base if base in _GREEK else base
    if arrow and accent != "hat":
        text = rf"\vec{{{text}}}"
    if accent:
        text = rf"\{accent}{{{text}}}"
    index = r"\infty" if sub == "oo" else "\\" + sub if sub in _GREEK else sub
    return f"{text}_{{{index}}}" if sub else text


def _place(factor: Any) -> tuple[int, int]:
    base = factor.base if factor.is_Pow else factor
    if base.is_Number or base is sp.I:
        return (0, 0) if base.is_Number else (1, 0)
    if isinstance(factor, sp.exp) or base.is_Add:
        return (2, 99) if base.is_Add else (4, 0)
    name = base.name if base.is_Symbol else ""
    return (2, _FIRST.index(name)) if name in _FIRST else (3, 0)


def _flat(expression: Any) -> Iterator[Any]:
    """Yield the factors of a product, those of products in it too."""
    for factor in sp.Mul.make_args(expression):
        if factor.is_Mul:
            yield from _flat(factor)
        else:
            yield factor


def split(expression: Any) -> tuple[bool, list[Any], list[Any]]:
    """Take a product apart.

    Examples
    --------
    >>> a, g = sp.symbols("a g")
    >>> split(-2 * g / (3 * a))
    (True, [2, g], [3, a])
    """
    number, above, below = sp.Integer(1), [], []
    for factor in _flat(expression):
        if factor.is_Rational:
            number *= factor
        elif factor.is_Pow and factor.exp.is_Rational and factor.exp < 0:
            below.append(sp.Pow(factor.base, -factor.exp))
        else:
            above.append(factor)
    above, below = sorted(above, key=_place), sorted(below, key=_place)
    if abs(number.p) != 1 or not above:
        above.insert(0, sp.Integer(abs(number.p)))
    if number.q != 1:
        below.insert(0, sp.Integer(number.q))
    return bool(number < 0), above, below


def _vector_parts(expression: Any) -> tuple[bool, list[Any], list[Any], Any]:
    """Take a multiple of a vector apart: sign, factors above and below, the vector."""
    scale = sp.Mul(*(part for part in expression.args if not part.is_Matrix))
    negative, above, below = split(scale)
    if above == [1] and not below:
        above = []
    return negative, above, below, expression.args[-1]


class TextPrinter(PrettyPrinter):
    """Prints formulas for a terminal.

    Examples
    --------
    >>> x, g = sp.symbols("x g")
    >>> print(TextPrinter().doprint(sp.Eq(x, -2 * g)))
    x = -2⋅g
    """

    def __init__(self, columns: int = 96) -> None:
        super().__init__({"use_unicode": True, "order": "none", "num_columns": columns, "wrap_line": True})

    def _print_Symbol(self, symbol: Any, **_: Any) -> Any:
        return prettyForm(unicode_name(symbol.name))

    def _print_MatrixSymbol(self, symbol: Any) -> Any:
        return self._print_Symbol(symbol)

    def _print_ImaginaryUnit(self, _: Any) -> Any:
        return prettyForm("i")

    def _print_Infinity(self, _: Any) -> Any:
        return prettyForm("∞")

    def _print_ZeroMatrix(self, _: Any) -> Any:
        return prettyForm("0")

    def _print_ExpBase(self, power: Any) -> Any:
        return prettyForm("e") ** self._print(power.args[0])

    def _factors(self, factors: list[Any]) -> Any:
        forms = []
        for factor in factors:
            form = self._print(factor)
            forms.append(prettyForm(*form.parens()) if factor.is_Add and len(factors) > 1 else form)
        result = forms[0]
        for form in forms[1:]:
            result = prettyForm(*prettyForm(*result.right("⋅")).right(form))
        return result

    def _quotient(self, above: list[Any], below: list[Any]) -> Any:
        form = self._factors(above)
        if not below:
            return form
        stacked, _ = stringPict.stack(form, stringPict.LINE, self._factors(below))
        return prettyForm(stacked, baseline=form.height(), binding=prettyForm.DIV)

    def _print_Mul(self, expression: Any) -> Any:
        negative, above, below = split(expression)
        form = self._quotient(above, below)
        return prettyForm(*form.left("-"), binding=prettyForm.NEG) if negative else form

    def _print_Rational(self, number: Any) -> Any:
        return prettyForm(str(number)) if number.is_Integer else self._print_Mul(number)

    def _sum(self, terms: list[tuple[bool, Any]]) -> Any:
        (negative, result), *rest = terms
        if negative:
            result = prettyForm(*result.left("-"))
        for negative, form in rest:
            result = prettyForm(*prettyForm(*result.right(" - " if negative else " + ")).right(form))
        result.binding = prettyForm.ADD
        return result

    def _print_Add(self, expression: Any, **_: Any) -> Any:
        terms = []
        for term in expression.args:
            negative, above, below = split(term)
            terms.append((negative, self._quotient(above, below)))
        return self._sum(terms)

    def _multiple(self, expression: Any) -> tuple[bool, Any]:
        if not expression.is_MatMul:
            return False, self._print(expression)
        negative, above, below, vector = _vector_parts(expression)
        form = self._print(vector)
        if vector.is_MatAdd:
            form = prettyForm(*form.parens())
        if not above:
            return negative, form
        scale = self._quotient(above, below)
        if len(above) == 1 and not below and above[0].is_Add:
            scale = prettyForm(*scale.parens())
        return negative, prettyForm(*prettyForm(*scale.right("⋅")).right(form))

    def _print_MatMul(self, expression: Any) -> Any:
        negative, form = self._multiple(expression)
        return prettyForm(*form.left("-")) if negative else form

    def _print_MatAdd(self, expression: Any) -> Any:
        return self._sum([self._multiple(term) for term in expression.args])


class FormulaPrinter(LatexPrinter):
    r"""Prints formulas in the part of LaTeX that KaTeX renders.

    Examples
    --------
    >>> x, g = sp.symbols("x g")
    >>> print(FormulaPrinter().doprint(sp.Eq(x, -g / 2)))
    x = - \frac{g}{2}
    """

    def __init__(self) -> None:
        super().__init__({"order": "none", "imaginary_unit": "i"})

    def _print_Symbol(self, symbol: Any, style: str = "plain") -> str:  # noqa: ARG002
        return latex_name(symbol.name)

    def _print_MatrixSymbol(self, symbol: Any) -> str:
        return latex_name(symbol.name, arrow=True)

    def _print_ZeroMatrix(self, _: Any) -> str:
        return "0"

    def _factors(self, factors: list[Any]) -> str:
        texts = []
        for factor in factors:
            text = self._print(factor)
            texts.append(rf"\left({text}\right)" if factor.is_Add and len(factors) > 1 else text)
        return " ".join(texts)

    def _quotient(self, above: list[Any], below: list[Any]) -> str:
        text = self._factors(above)
        return rf"\frac{{{text}}}{{{self._factors(below)}}}" if below else text

    def _print_Mul(self, expression: Any) -> str:
        negative, above, below = split(expression)
        return ("- " if negative else "") + self._quotient(above, below)

    def _print_Rational(self, number: Any) -> str:
        return str(number) if number.is_Integer else self._print_Mul(number)

    @staticmethod
    def _sum(terms: list[tuple[bool, str]]) -> str:
        (negative, result), *rest = terms
        result = ("- " if negative else "") + result
        return result + "".join((" - " if negative else " + ") + text for negative, text in rest)

    def _print_Add(self, expression: Any, order: Any = None) -> str:  # noqa: ARG002
        terms = []
        for term in expression.args:
            negative, above, below = split(term)
            terms.append((negative, self._quotient(above, below)))
        return self._sum(terms)

    def _multiple(self, expression: Any) -> tuple[bool, str]:
        if not expression.is_MatMul:
            return False, self._print(expression)
        negative, above, below, vector = _vector_parts(expression)
        text = self._print(vector)
        if vector.is_MatAdd:
            text = rf"\left({text}\right)"
        if not above:
            return negative, text
        scale = self._quotient(above, below)
        if len(above) == 1 and not below and above[0].is_Add:
            scale = rf"\left({scale}\right)"
        return negative, f"{scale} {text}"

    def _print_MatMul(self, expression: Any) -> str:
        negative, text = self._multiple(expression)
        return ("- " if negative else "") + text

    def _print_MatAdd(self, expression: Any) -> str:
        return self._sum([self._multiple(term) for term in expression.args])

    def _print_MatrixBase(self, matrix: Any) -> str:
        rows = r" \\ ".join(" & ".join(self._print(part) for part in matrix.row(i)) for i in range(matrix.rows))
        return rf"\begin{{pmatrix}} {rows} \end{{pmatrix}}"

    def _print_ImmutableDenseMatrix(self, matrix: Any) -> str:
        return self._print_MatrixBase(matrix)
