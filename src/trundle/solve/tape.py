"""A recorder of arithmetic: run a law once on recorders, and get it back as one flat Python function.

Equal operations on equal operands are recorded once, so the function is as long as the law has different steps,
whatever the body and the support.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

_LONGEST = 300  # characters of an expression: Python reads no more than 200 brackets in each other


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
        self.known: dict[tuple[Any, ...], Node] = {}
        self.size = 0

    def inputs(self, count: int) -> list[Node]:
        """Return so many variables."""
        first, self.size = self.size, self.size + count
        return [self.record("input", first + i) for i in range(count)]

    def record(self, operation: str, *operands: Any) -> Node:
        """Return the result of an operation, the earlier one where the same was done before."""
        key = _key(operation, operands)
        if key not in self.known:
            self.known[key] = Node(self, len(self.steps))
            self.steps.append((operation, *operands))
        return self.known[key]

    def has(self, operation: str, *operands: Any) -> bool:
        """Tell whether an operation was recorded before."""
        return _key(operation, operands) in self.known

    def function(self, outputs: Sequence[Any]) -> Callable[[Sequence[float]], list[float]]:
        """Return the function of the inputs that gives the outputs."""
        needed = self.needed(outputs)
        uses = [*outputs, *(part for i in needed for part in self.steps[i][1:])]
        used = Counter(part.index for part in uses if isinstance(part, Node))
        lines, names = ["def traced(x):"], dict[int, str]()
        for i in needed:
            names[i] = _written(self.steps[i], names)
            if used[i] > 1 or len(names[i]) > _LONGEST:  # what is used once stands where it is used: twice as fast
                lines.append(f"    v{i} = {names[i]}")
                names[i] = f"v{i}"
        source = "\n".join([*lines, f"    return [{', '.join(_name(part, names) for part in outputs)}]"])
        place: dict[str, Any] = dict(_PYTHON)
        exec(source, place)  # noqa: S102  operators, numbers and the names of `_PYTHON`, nothing else
        return place["traced"]

    def needed(self, outputs: Sequence[Any]) -> list[int]:
        """Return the steps that the outputs lean on, in order."""
        waiting, found = [part.index for part in outputs if isinstance(part, Node)], set()
        while waiting:
            index = waiting.pop()
            if index not in found:
                found.add(index)
                waiting += [part.index for part in self.steps[index][1:] if isinstance(part, Node)]
        return sorted(found)


def _key(operation: str, operands: Sequence[Any]) -> tuple[Any, ...]:
    return (operation, *(part.index if isinstance(part, Node) else ("number", part) for part in operands))


class Node:
    """A scalar whose arithmetic is recorded."""

    __slots__ = ("index", "tape")
    __array_ufunc__ = None

    def __init__(self, tape: Tape, index: int) -> None:
        self.tape, self.index = tape, index

    @staticmethod
    def scalar_functions() -> Any:
        """Return the functions that `trundle.mechanics.scalars.namespace` finds for it."""
        return _Functions

    def __add__(self, other: Any) -> Any:
        return self if _is(other, 0) else self._with(_sum, self, other)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        return self if _is(other, 0) else self._with(_difference, self, other)

    def __rsub__(self, other: Any) -> Any:
        return -self if _is(other, 0) else self._with(_difference, other, self)

    def __mul__(self, other: Any) -> Any:
        if _is(other, 0):
            return 0.0
        if _is(other, 1):
            return self
        return -self if _is(other, -1) else self._with(_product, self, other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        return self if _is(other, 1) else self._with(_quotient, self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return 0.0 if _is(other, 0) else self._with(_quotient, other, self)

    def _with(self, operation: Callable[[Tape, Any, Any], Any], a: Any, b: Any) -> Any:
        """Record an operation with another scalar; vectors, matrices and jets know better."""
        known = all(isinstance(part, (int, float, Node)) for part in (a, b))
        return operation(self.tape, a, b) if known else NotImplemented

    def __neg__(self) -> Any:
        return self.minus or self.tape.record("neg", self)

    @property
    def minus(self) -> Any:
        """What this is the negative of, or None."""
        operation, *operands = self.tape.steps[self.index]
        return operands[0] if operation == "neg" else None

    def __pow__(self, power: int) -> Any:
        return self if power == 1 else self.tape.record("**", self, power)

    def __abs__(self) -> Any:
        return self.tape.record("abs", self)

    def __lt__(self, other: Any) -> Any:
        return self._with(lambda tape, a, b: tape.record("<", a, b), self, other)

    def __gt__(self, other: Any) -> Any:
        return self._with(lambda tape, a, b: tape.record(">", a, b), self, other)


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
    "hypot": math.hypot,
    "atan2": math.atan2,
    "where": _where,
}
_Functions = type("_Functions", (), {name: _function(name) for name in _PYTHON})


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


def _name(part: Any, names: dict[int, str]) -> str:
    return names[part.index] if isinstance(part, Node) else repr(float(part))


def _written(step: tuple[Any, ...], names: dict[int, str]) -> str:
    operation, *operands = step
    if operation == "input":
        return f"x[{operands[0]}]"
    if operation == "neg":
        return f"(-{_name(operands[0], names)})"
    if operation == "**":
        return f"({_name(operands[0], names)} ** {int(operands[1])})"
    written = [_name(part, names) for part in operands]
    return f"{operation}({', '.join(written)})" if operation in _PYTHON else f"({f' {operation} '.join(written)})"
