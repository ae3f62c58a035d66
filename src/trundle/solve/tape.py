"""A recorder of arithmetic: run a law once on recorders, and get it back as flat text, of Python or another language.

Equal operations on equal operands are recorded once, so the text is as long as the law has different steps, whatever
the body and the support. A power is recorded as products and a hypotenuse as a square root: these are the same to the
last bit in every language, and the functions of a library are not.
"""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, field, replace
from numbers import Real
from typing import Any

from ..mechanics.surfaces.splines import Pieces, evaluated

_LONGEST = 300  # characters of an expression: Python reads no more than 200 brackets in each other


@dataclass(frozen=True)
class Dialect:
    """How a language writes what a tape holds."""

    variable: Callable[[int], str] = "x[{}]".format  # the name of an input, by its place
    # what the functions are called whose name in the language is not that on the tape
    functions: Mapping[str, str] = field(default_factory=dict)
    choice: str = "where({}, {}, {})"  # one of two values, with places for the condition and the two
    number: Callable[[float], str] = repr  # a number as it is written


@dataclass(frozen=True)
class Loop:
    """What is done again and again, on a tape of its own."""

    tape: Tape  # its inputs are the numbers that change, and then those that stay
    outputs: tuple[Any, ...]  # what becomes of the numbers that change; as long as the first is above 0 it goes on


@dataclass(frozen=True)
class WrittenLoop:
    """The same as text, with names that do not depend on where it stands."""

    targets: tuple[str, ...]  # what the numbers that change are called afterwards
    start: tuple[str, ...]  # how these begin
    given: tuple[str, ...]  # how those that stay are given
    changing: tuple[str, ...]  # what the former are called within
    staying: tuple[str, ...]  # what the latter are called within
    lines: list[Any]  # one pass, as `Tape.written` has it
    results: list[str]  # of it


class Tape:
    """The operations recorded so far.

    Examples
    --------
    >>> tape = Tape()
    >>> x, y = tape.inputs(2)
    >>> tape.function([x * y + 1.0, x * y])([3.0, 2.0])
    [7.0, 6.0]
    """

    def __init__(self) -> None:
        self.steps: list[tuple[Any, ...]] = []
        self.leaning: list[tuple[int, ...]] = []  # the steps that each leans on
        self.known: dict[tuple[Any, ...], Node] = {}
        self.loops: list[Loop] = []
        self.size = 0

    def inputs(self, count: int) -> list[Node]:
        """Return so many variables."""
        first, self.size = self.size, self.size + count
        return [self.record("input", first + i) for i in range(count)]

    def record(self, operation: str, *operands: Any) -> Node:
        """Return the result of an operation, the earlier one where the same was done before."""
        key = _key(operation, operands)
        known = self.known.get(key)
        if known is None:
            known = self.known[key] = Node(self, len(self.steps), operands[0] if operation == "neg" else None)
            self.steps.append((operation, *operands))
            self.leaning.append(tuple([part.index for part in operands if isinstance(part, Node)]))
        return known

    def has(self, operation: str, *operands: Any) -> bool:
        """Tell whether an operation was recorded before."""
        return _key(operation, operands) in self.known

    def function(self, outputs: Sequence[Any]) -> Callable[[Sequence[float]], list[float]]:
        """Return the function of the inputs that gives the outputs."""
        lines, results = self.written(outputs, Dialect())
        worked_out = [f"    {name} = {text}" for name, text in lines]
        text = ["def traced(x):", *worked_out, f"    return [{', '.join(results)}]"]
        return defined("\n".join([*self._tables(outputs), *text]))

    def _tables(self, outputs: Sequence[Any]) -> list[str]:
        """Return the lines that define the tables which steps lean on."""
        found = [part for i in self.needed(outputs) for part in self.steps[i][1:] if isinstance(part, Pieces)]
        return [
            f"{name} = table({numbers!r})"
            for pieces in dict.fromkeys(found)
            for name, numbers in zip(_names(pieces), (pieces.x, pieces.y, pieces.terms), strict=True)
        ]

    def written(self, outputs: Sequence[Any], dialect: Dialect, prefix: str = "v") -> tuple[list[Any], list[str]]:
        """Return the steps that lead to the outputs, each a name and its text, and then the texts of the outputs.

        A loop is a `WrittenLoop` among the steps.

        Examples
        --------
        >>> tape = Tape()
        >>> x, y = tape.inputs(2)
        >>> tape.written([x * y + 1.0, x * y], Dialect("xy".__getitem__))
        ([('v2', '(x * y)')], ['(v2 + 1.0)', 'v2'])
        """
        needed = self.needed(outputs)
        uses = [*outputs, *(part for i in needed for part in self.steps[i][1:] * (1 + (self.steps[i][0] == "loop")))]
        used = Counter(part.index for part in uses if isinstance(part, Node))
        lines, names = list[Any](), dict[int, str]()
        for i in needed:
            name = f"{prefix}{i}"
            if self.steps[i][0] == "loop":
                lines.append(self._written_loop(i, name, names, dialect))
                names[i] = name
                continue
            names[i] = _written(self.steps[i], names, dialect)
            if used[i] > 1 or len(names[i]) > _LONGEST:  # what is used once stands where it is used: twice as fast
                lines.append((name, names[i]))
                names[i] = name
        return lines, [_name(part, names, dialect) for part in outputs]

    def _written_loop(self, index: int, name: str, names: dict[int, str], dialect: Dialect) -> WrittenLoop:
        _, which, *operands = self.steps[index]
        loop, texts = self.loops[which], [_name(part, names, dialect) for part in operands]
        size = len(loop.outputs)
        changing, staying = (
            tuple(f"{letter}{i}" for i in range(n)) for letter, n in (("c", size), ("g", len(texts) - size))
        )
        inner = replace(dialect, variable=[*changing, *staying].__getitem__)
        targets = tuple(f"{name}_{i}" for i in range(size))
        given = tuple(texts[:size]), tuple(texts[size:])
        return WrittenLoop(targets, *given, changing, staying, *loop.tape.written(loop.outputs, inner, "w"))

    def needed(self, outputs: Sequence[Any], done: Container[int] = ()) -> list[int]:
        """Return the steps that the outputs lean on, in order, without those that are done, and what these lean on."""
        waiting, found = [part.index for part in outputs if isinstance(part, Node)], set[int]()
        leaning = self.leaning
        while waiting:
            index = waiting.pop()
            if index not in found and index not in done:
                found.add(index)
                waiting += leaning[index]
        return sorted(found)


def repeated(body: Callable[..., Sequence[Any]], start: Sequence[Any], given: Sequence[Any]) -> list[Any]:
    """Return what becomes of some numbers that a body changes again and again while the first is above 0.

    Parameters
    ----------
    body : callable
        Takes the numbers that change and then those that stay, and returns the first.
    start, given : sequence of scalars
        Floats, or what a tape recorded: then the loop is recorded, too.

    Examples
    --------
    >>> def halved(left, x, by):
    ...     return left - 1.0, x / by
    >>> repeated(halved, (3.0, 8.0), (2.0,))
    [0.0, 1.0]
    >>> tape = Tape()
    >>> count, x = tape.inputs(2)
    >>> (*_, loop), results = tape.written(repeated(halved, (count, x), (2.0,)), Dialect("nx".__getitem__))
    >>> loop.changing, loop.results, results
    (('c0', 'c1'), ['(c0 - 1.0)', '(c1 / g0)'], ['v2_0', 'v2_1'])
    """
    tapes = [part.tape for part in (*start, *given) if isinstance(part, Node)]
    if not tapes:
        now = list(start)
        while now[0] > 0:
            now = list(body(*now, *given))
        return now
    tape, inner = tapes[0], Tape()
    tape.loops.append(Loop(inner, tuple(body(*inner.inputs(len(start) + len(given))))))
    done = tape.record("loop", len(tape.loops) - 1, *start, *given)
    return [tape.record("part", done, i) for i in range(len(start))]


def _key(operation: str, operands: Sequence[Any]) -> tuple[Any, ...]:
    return (operation, *[part.index if isinstance(part, Node) else ("number", part) for part in operands])


class Node:
    """A scalar whose arithmetic is recorded."""

    __slots__ = ("index", "minus", "tape")
    __array_ufunc__ = None

    def __init__(self, tape: Tape, index: int, minus: Any = None) -> None:
        self.tape, self.index = tape, index
        self.minus = minus  # what this is the negative of

    @staticmethod
    def scalar_functions() -> Any:
        """Return the functions that `trundle.mechanics.scalars.namespace` finds for it."""
        return _Functions

    def __add__(self, other: Any) -> Any:
        return self if _is(other, 0) else self._with(_sum, other)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        return self if _is(other, 0) else self._with(_difference, other)

    def __rsub__(self, other: Any) -> Any:
        return -self if _is(other, 0) else self._with(_difference, other, first=False)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, (int, float)) and other in (0, 1, -1):
            return (0.0 if other == 0 else self) if other >= 0 else -self
        return self._with(_product, other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        return self if _is(other, 1) else self._with(_quotient, other)

    def __rtruediv__(self, other: Any) -> Any:
        return 0.0 if _is(other, 0) else self._with(_quotient, other, first=False)

    def _with(self, operation: Callable[[Tape, Any, Any], Any], other: Any, *, first: bool = True) -> Any:
        """Record an operation with another scalar; vectors, matrices and jets know better."""
        if not isinstance(other, (Node, float, int)):
            return NotImplemented
        return operation(self.tape, self, other) if first else operation(self.tape, other, self)

    def __neg__(self) -> Any:
        return self.tape.record("neg", self) if self.minus is None else self.minus

    def __bool__(self) -> bool:
        raise TypeError("What is recorded has no value to decide by: choose by `where` of `scalars.namespace`.")

    def __pow__(self, power: float) -> Any:
        if not isinstance(power, Real):
            return NotImplemented
        if power < 0:
            return 1.0 / self**-power
        if power % 1 == 0.5:
            return self ** (power - 0.5) * _Functions.sqrt(self)
        if power % 1:
            return _Functions.exp(power * _Functions.log(self))
        half = self ** (power // 2) if power > 1 else 1.0
        return half * half * self if power % 2 else half * half

    def __abs__(self) -> Any:
        return self.tape.record("abs", self)

    def __lt__(self, other: Any) -> Any:
        return self._with(lambda tape, a, b: tape.record("<", a, b), other)

    def __gt__(self, other: Any) -> Any:
        return self._with(lambda tape, a, b: tape.record(">", a, b), other)


# One form for what is the same to the last bit: factors and summands in the order in which they came up, signs outside.


def _sum(tape: Tape, a: Any, b: Any) -> Any:
    if _minus(b) is not None:
        return -tape.record("+", *_ordered(_minus(a), _minus(b))) if _minus(a) is not None else a - _minus(b)
    return b - _minus(a) if _minus(a) is not None else tape.record("+", *_ordered(a, b))


def _difference(tape: Tape, a: Any, b: Any) -> Any:
    if _minus(b) is not None:
        return a + _minus(b)
    if _minus(a) is not None:
        return -(_minus(a) + b)
    return -tape.record("-", b, a) if tape.has("-", b, a) else tape.record("-", a, b)


def _product(tape: Tape, a: Any, b: Any) -> Any:
    if _minus(a) is not None or _minus(b) is not None:
        return -(-a * b) if _minus(a) is not None else -(a * -b)
    return tape.record("*", *_ordered(a, b))


def _quotient(tape: Tape, a: Any, b: Any) -> Any:
    if _minus(a) is not None or _minus(b) is not None:
        return -(-a / b) if _minus(a) is not None else -(a / -b)
    return tape.record("/", a, b)


def _minus(part: Any) -> Any:
    return part.minus if isinstance(part, Node) else None


def _ordered(a: Any, b: Any) -> tuple[Any, Any]:
    return (a, b) if not isinstance(b, Node) or (isinstance(a, Node) and a.index <= b.index) else (b, a)


def _function(name: str) -> Callable[..., Any]:
    def recorded(*operands: Any) -> Any:
        tapes = [part.tape for part in operands if isinstance(part, Node)]
        return tapes[0].record(name, *operands) if tapes else _PYTHON[name](*operands)

    return staticmethod(recorded)


def _hypot(x: Any, y: Any) -> Any:
    return _Functions.sqrt(x * x + y * y)


def _where(condition: Any, yes: Any, no: Any) -> Any:
    """Return one of two values; each is worked out, so neither may fail where the other is meant."""
    return yes if condition else no


_PYTHON: dict[str, Callable[..., Any]] = {
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "exp": math.exp,
    "expm1": math.expm1,
    "log": math.log,
    "abs": abs,
    "atan2": math.atan2,
    "where": _where,
    "spline": evaluated,
}


def defined(text: str, name: str = "traced", file: str = "<tape>", **functions: Any) -> Callable[..., Any]:
    r"""Return the function whose text a tape has written, with other names than Python's functions.

    Examples
    --------
    >>> defined("def traced(x):\n    return [sqrt(x[0])]")([4.0])
    [2.0]
    """
    place: dict[str, Any] = _PYTHON | {"table": tuple} | functions
    exec(compile(text, file, "exec"), place)  # noqa: S102  operators, numbers and the names of `place`, nothing else
    return place[name]


_Functions: Any = type("_Functions", (), {**{name: _function(name) for name in _PYTHON}, "hypot": staticmethod(_hypot)})


def apply(tape: Tape, operation: str, *operands: Any) -> Any:
    """Return the result of an operation given by its name, as `Tape.steps` keeps it.

    Examples
    --------
    >>> tape = Tape()
    >>> (x,) = tape.inputs(1)
    >>> tape.function([apply(tape, "*", x, 3.0)])([2.0])
    [6.0]
    """
    return _ARITHMETIC[operation](*operands) if operation in _ARITHMETIC else tape.record(operation, *operands)


_ARITHMETIC: dict[str, Callable[..., Any]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "neg": lambda a: -a,
}


def _is(value: Any, number: float) -> bool:
    return isinstance(value, (int, float)) and value == number


def _names(pieces: Pieces) -> list[str]:
    """Return what the tables of pieces are called: no others have these names."""
    digest = hashlib.sha256(repr((pieces.x, pieces.y, pieces.terms)).encode()).hexdigest()[:32]
    return [f"{part}_{digest}" for part in ("x", "y", "terms")]


def _name(part: Any, names: dict[int, str], dialect: Dialect) -> str:
    if isinstance(part, Pieces):
        return ", ".join(_names(part))
    return names[part.index] if isinstance(part, Node) else dialect.number(float(part))


def _written(step: tuple[Any, ...], names: dict[int, str], dialect: Dialect) -> str:
    operation, *operands = step
    if operation == "input":
        return dialect.variable(operands[0])
    written = [_name(part, names, dialect) for part in operands]
    if operation == "part":
        return f"{written[0]}_{operands[1]}"
    if operation == "neg":
        return f"(-{written[0]})"
    if operation == "where":
        return dialect.choice.format(*written)
    if operation in _PYTHON:
        return f"{dialect.functions.get(operation, operation)}({', '.join(written)})"
    return f"({f' {operation} '.join(written)})"
