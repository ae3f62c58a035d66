"""What is printed is what was proved: the LaTeX is read back by a small parser of its own and compared in numbers."""

from __future__ import annotations

import json
import math
import re
import unicodedata
from functools import cache
from typing import Any

import numpy as np
import pytest
import sympy as sp
from tests.derivation.derived import derived

import trundle as tr
from trundle.analysis.derivation.printers import latex_name
from trundle.analysis.derivation.topics import TOPICS
from trundle.analysis.derivation.vectors import Dot, evaluate

SHOWN = [*TOPICS, "real-demonstration"]
# All of it is in KaTeX's table of supported functions.
KATEX = {
    *(r"\frac", r"\left", r"\right", r"\sin", r"\cos", r"\tanh", r"\cosh", r"\sqrt", r"\operatorname", r"\times"),
    *(r"\cdot", r"\vec", r"\hat", r"\dot", r"\ddot", r"\begin", r"\end", r"\\", r"\,", r"\infty", r"\ell", r"\alpha"),
    *(r"\gamma", r"\epsilon", r"\zeta", r"\theta", r"\kappa", r"\lambda", r"\mu", r"\nu", r"\rho", r"\varrho"),
    *(r"\omega", r"\Omega", r"\phi", r"\varphi"),
}
TOKEN = re.compile(r"\\begin\{pmatrix\}|\\end\{pmatrix\}|\\\\|\\,|\\[A-Za-z]+|\d+(?:\.\d+)?|.")


def number_for(name: str) -> float:
    """Return some number for a symbol, the same whenever it is asked for; positive, so that roots are real."""
    return 0.2 + 0.7 * float(np.random.default_rng(list(name.encode())).uniform())


@cache
def vector_for(name: str) -> Any:
    return np.array([number_for(name + axis) - 0.5 for axis in "123"])


def function_for(name: str, *arguments: Any) -> Any:
    """Return the value of a function; for Jacobi's it need only tell them and their arguments apart."""
    if hasattr(math, name):
        return getattr(math, name)(*arguments)
    u, parameter = arguments
    return {"sn": 1.0, "cn": 2.0, "dn": 3.0}[name] + math.sin(u) + 0.3 * parameter


class Reader:
    """Reads a formula in LaTeX and works out its value: numbers, complex numbers and vectors."""

    def __init__(self, text: str) -> None:
        self.tokens = [word for word in TOKEN.findall(text) if not word.isspace() and word != r"\,"]
        self.at = 0

    def peek(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        word = self.peek()
        assert word, "ends too early"
        assert not wanted or word == wanted, f"{wanted} wanted at {self.tokens[self.at :]}"
        self.at += 1
        return word

    def total(self) -> Any:
        sign = -1 if self.peek() == "-" else 1
        if sign < 0:
            self.take()
        value = sign * self.product()
        while self.peek() in ("+", "-"):
            sign = 1 if self.take() == "+" else -1
            value = value + sign * self.product()
        return value

    def product(self) -> Any:
        """A product; a cross product binds all that follows it, and what stands before it, but for scalars."""
        scale: Any = 1.0
        held: Any = None
        while self.peek() not in ("", "+", "-", "=", "}", "&", r"\\", r"\right", r"\end{pmatrix}", ","):
            if self.peek() == r"\times":
                self.take()
                held = np.cross(held, self.vector_after())
                continue
            if self.peek() == r"\cdot":
                self.take()
                held = np.dot(held, self.factor())
                continue
            factor = self.factor()
            if np.ndim(factor) == 0:
                scale = scale * factor
            else:
                held = factor if held is None else held @ factor
        return scale if held is None else scale * held

    def vector_after(self) -> Any:
        value = self.factor()
        while np.ndim(value) == 2:
            value = value @ self.factor()
        return value

    def factor(self) -> Any:
        value = self.atom()
        if self.peek() == "^":
            self.take()
            value = value ** self.group()
        return value

    def group(self) -> Any:
        self.take("{")
        value = self.total()
        self.take("}")
        return value

    def bracket(self) -> Any:
        self.take(r"\left")
        kind = self.take()
        values = [self.total()]
        while self.peek() == ",":
            self.take()
            values.append(self.total())
        self.take(r"\right")
        self.take()
        return abs(values[0]) if kind == "|" else tuple(values) if len(values) > 1 else values[0]

    def atom(self) -> Any:
        word = self.peek()
        if word == r"\left":
            return self.bracket()
        if word == "{":
            return self.group()
        self.take()
        if re.fullmatch(r"[\d.]+", word):
            return float(word)
        if word == r"\frac":
            above = self.group()
            return above / self.group()
        if word == r"\sqrt":
            return self.group() ** 0.5
        if word in (r"\sin", r"\cos", r"\tanh", r"\cosh", r"\operatorname"):
            return self.function(word)
        if word == r"\begin{pmatrix}":
            return self.column()
        if word == "e" and self.peek() == "^":
            self.take()
            return np.exp(self.group())
        if word == "i":
            return 1j
        return self.named(word)

    def function(self, word: str) -> Any:
        name = word[1:]
        if word == r"\operatorname":
            self.take("{")
            name = self.take() + self.take()
            self.take("}")
        power = 1.0
        if self.peek() == "^":
            self.take()
            power = self.group()
        wrapped = self.peek() == "{"
        if wrapped:
            self.take()
        arguments = self.bracket()
        if wrapped:
            self.take("}")
        arguments = arguments if isinstance(arguments, tuple) else (arguments,)
        return function_for(name, *arguments) ** power

    def column(self) -> Any:
        rows = [self.total()]
        while self.peek() == r"\\":
            self.take()
            rows.append(self.total())
        self.take(r"\end{pmatrix}")
        return np.array(rows)

    def named(self, word: str) -> Any:
        text = word
        if word in (r"\vec", r"\hat", r"\dot", r"\ddot"):
            text += self.verbatim()
        if self.peek() == "_":
            text += self.take() + self.verbatim()
        assert text in NAMES, f"{text} is the name of nothing"
        return NAMES[text]

    def verbatim(self) -> str:
        text, depth = self.take("{"), 1
        while depth:
            word = self.take()
            depth += {"{": 1, "}": -1}.get(word, 0)
            text += word
        return text


NAMES: dict[str, Any] = {}


def value_of(side: Any) -> Any:
    """Return the value of one side of a formula as SymPy holds it, and note what each name in it stands for."""
    values: dict[Any, Any] = {}
    for symbol in side.free_symbols:
        if isinstance(symbol, sp.MatrixSymbol):
            if symbol.shape == (3, 3):
                found = np.array([vector_for(symbol.name + row) for row in "abc"])
                NAMES[latex_name(symbol.name, arrow=True)] = found
                values[symbol] = sp.Matrix(found)
            else:
                found = vector_for(symbol.name)
                NAMES[latex_name(symbol.name, arrow=True)] = found
                values[symbol] = sp.Matrix(found)
        else:
            found = float(symbol.name) if symbol.name[0].isdigit() else number_for(symbol.name)
            NAMES[latex_name(symbol.name)] = found
            values[symbol] = sp.Float(found)
    result = evaluate(side, values)
    if isinstance(result, sp.MatrixBase):
        return np.array(result.applyfunc(numerically).tolist(), dtype=complex).ravel()
    return complex(numerically(result))


def numerically(expression: Any) -> Any:
    return expression.replace(
        lambda part: part.is_Function and part.func.__name__ in ("sn", "cn", "dn"),
        lambda part: sp.Float(function_for(part.func.__name__, *map(float, part.args))),
    ).evalf()


@pytest.mark.parametrize("name", SHOWN)
def test_the_latex_says_what_was_proved(name: str) -> None:
    shown = derived(name).as_dict()
    for step, printed in zip(derived(name).steps, shown["steps"], strict=True):
        for equation, one in zip(step.equations, printed["equations"], strict=True):
            left, right = one["latex"].split(" = ")
            for side, text in ((equation.formula.lhs, left), (equation.formula.rhs, right)):
                wanted = value_of(side)
                reader = Reader(text)
                found = reader.total()
                assert not reader.peek(), f"{reader.tokens[reader.at :]} is left of {text}"
                assert np.allclose(np.asarray(found) * 1.0, wanted, rtol=1e-9, atol=1e-9), one["latex"]


@pytest.mark.parametrize("name", SHOWN)
def test_the_latex_is_of_the_kind_that_katex_renders(name: str) -> None:
    shown = derived(name).as_dict()
    texts = [one["latex"] for step in shown["steps"] for one in step["equations"]]
    texts += [symbol["latex"] for symbol in shown["symbols"]]
    texts += [part for step in shown["steps"] for part in re.findall(r"\$(.*?)\$", step["sentence"])]
    for text in texts:
        assert set(re.findall(r"\\[A-Za-z]+|\\\\|\\,", text)) <= KATEX
        assert text.isascii()
        assert text.count(r"\left") == text.count(r"\right")
        depths = np.cumsum([{"{": 1, "}": -1}.get(character, 0) for character in text])
        assert depths.min() >= 0
        assert depths[-1] == 0


@pytest.mark.parametrize("name", SHOWN)
def test_the_text_fits_a_terminal_of_100_columns(name: str) -> None:
    for line in derived(name).text().splitlines():
        assert sum(not unicodedata.combining(character) for character in line) <= 100, line
    assert "{" not in derived(name).text()


@pytest.mark.parametrize("name", SHOWN)
def test_the_latex_fragment_is_plain_text_and_whole(name: str) -> None:
    fragment = derived(name).latex()
    assert fragment.isascii()  # no package for Greek letters in text is asked for
    assert fragment.count(r"\[") == fragment.count(r"\]")
    assert fragment.count("$") % 2 == 0
    assert fragment.count("{") == fragment.count("}")


def test_markdown_has_each_formula_in_a_block_of_its_own() -> None:
    lines = derived("turntable").markdown().splitlines()
    marks = [i for i, line in enumerate(lines) if line == "$$"]
    assert len(marks) == 2 * sum(len(step.equations) for step in derived("turntable").steps)
    for begin, end in zip(marks[::2], marks[1::2], strict=True):
        assert end == begin + 2
        assert lines[begin - 1] == ""
    assert derived("turntable")._repr_markdown_() == derived("turntable").markdown()


def test_what_the_dictionary_holds_is_json() -> None:
    shown = tr.derive("tilted-turntable", with_numbers=True).as_dict()
    assert json.loads(json.dumps(shown)) == shown
    assert {one["residual"] for step in shown["steps"] for one in step["equations"]} == {"0"}
    drift = next(number for number in shown["numbers"] if number["text"] == "v_d")
    assert drift["unit"] == "m/s"
    assert drift["value"][0] == pytest.approx(0.0, abs=1e-15)


def test_a_scalar_product_is_read_back() -> None:
    left, right = sp.MatrixSymbol("u", 3, 1), sp.MatrixSymbol("v", 3, 1)
    from trundle.analysis.derivation.printers import FormulaPrinter

    wanted = value_of(Dot(left, right))
    assert Reader(FormulaPrinter().doprint(Dot(left, right))).total() == pytest.approx(wanted.real)
