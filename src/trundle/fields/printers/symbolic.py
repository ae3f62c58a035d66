"""SymPy, and by it LaTeX: the equations as one reads them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Any

from ...mechanics.scalars import namespace
from ...solve.tape import Node
from ..routines import Routine

_READABLE = 400  # operations: more are not read without names for what comes again
_FEW = 3  # operations that need no name of their own


def expressions(routine: Routine, values: Sequence[Any], definitions: list[tuple[Any, Any]] | None = None) -> list[Any]:
    """Return the outputs of a routine as SymPy expressions of the values of its inputs.

    Given a list, what comes more than once gets a name w1, w2, ..., and its definition is added to the list.

    Examples
    --------
    >>> import sympy
    >>> import trundle as tr
    >>> from trundle.fields.routines import PhaseRoutines
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> rates = PhaseRoutines(level, "rolling", ()).rates()
    >>> expressions(rates, sympy.symbols("x:30", real=True))[2]
    0
    """
    import sympy

    made: dict[int, Any] = {}
    xp, steps = namespace(sympy.Symbol("x")), routine.tape.steps
    needed = routine.tape.needed(routine.outputs)
    used = Counter(part.index for i in needed for part in steps[i][1:] if isinstance(part, Node))

    def operand(part: Any) -> Any:
        return made[part.index] if isinstance(part, Node) else exactly(part)

    for index in needed:
        operation, *operands = steps[index]
        if operation == "input":
            made[index] = values[operands[0]]
            continue
        parts = [operand(part) for part in operands]
        found = _OPERATORS[operation](*parts) if operation in _OPERATORS else getattr(xp, operation)(*parts)
        if definitions is not None and used[index] > 1 and found.is_Boolean is not True and found.count_ops() > _FEW:
            name = sympy.Symbol(f"w{len(definitions) + 1}", real=True)
            definitions.append((name, found))
            found = name
        made[index] = found
    return [operand(part) for part in routine.outputs]


_OPERATORS: dict[str, Any] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "neg": lambda a: -a,
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
}


def exactly(number: float) -> Any:
    """Return a number as a formula has it: 1/2 and 2, not 0.5 and 2.0.

    Examples
    --------
    >>> exactly(0.5), exactly(-2.0)
    (1/2, -2)
    """
    import sympy

    near = sympy.Rational(number).limit_denominator(1000)
    return near if float(near) == number else sympy.Float(number)


def symbols(names: Sequence[str]) -> list[Any]:
    """Return a symbol for each name: its last word, with as many before it as tell it from the others.

    Examples
    --------
    >>> symbols(["body.radius", "support.motion.rate", "loads[0].value.x", "support.radius", "Omega_x"])
    [body_radius, rate, value_x, support_radius, Omega_x]
    """
    import sympy

    words = [re.findall(r"\w+", name) for name in names]
    counts = [1 if len(word[-1]) > 1 else 2 for word in words]
    while True:
        short = ["_".join(word[-n:]) for word, n in zip(words, counts, strict=True)]
        many = Counter(short)
        longer = [n + (many[s] > 1 and n < len(word)) for n, s, word in zip(counts, short, words, strict=True)]
        if longer == counts:
            return [sympy.Symbol(name, real=True) for name in short]
        counts = longer


def simplified(rates: Sequence[Any]) -> list[Any]:
    """Return expressions that are short enough for it in their simplest form."""
    import sympy

    return [sympy.simplify(rate) if sympy.count_ops(rate) < _READABLE else rate for rate in rates]


def readable(routine: Routine) -> bool:
    """Tell whether the outputs can be read with nothing named: how long they are is counted without writing them."""
    lengths: dict[int, int] = {}
    for index in routine.tape.needed(routine.outputs):
        _, *operands = routine.tape.steps[index]
        lengths[index] = 1 + sum(lengths[part.index] for part in operands if isinstance(part, Node))
    return sum(lengths[part.index] for part in routine.outputs if isinstance(part, Node)) < _READABLE


def latex(names: Sequence[Any], rates: Sequence[Any], definitions: Sequence[tuple[Any, Any]], roman: Any) -> str:
    """Print equations of motion, one a line, what they are written with first; some names stand upright."""
    import sympy

    upright = {symbol: _upright(symbol.name) for symbol in roman if len(symbol.name.partition("_")[0]) > 1}

    def text(part: Any) -> str:
        return str(sympy.latex(part, symbol_names=upright))

    rows = [(text(name), text(what)) for name, what in definitions]
    for name, rate in zip(names, rates, strict=True):
        letter, _, index = name.name.partition("_")
        below = f"_{{{index}}}" if index else ""
        rows.append((rf"\dot{{{sympy.latex(sympy.Symbol(letter))}}}{below}", text(rate)))
    lines = " \\\\\n".join(f"    {left} &= {right}" for left, right in rows)
    return f"\\begin{{align*}}\n{lines}\n\\end{{align*}}\n"


def _upright(name: str) -> str:
    word, _, index = name.partition("_")
    below = index.replace("_", r"\,")
    return rf"\mathrm{{{word}}}" + (rf"_{{\mathrm{{{below}}}}}" if index else "")
