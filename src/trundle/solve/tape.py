"""A recorder of arithmetic: run a law once on recorders, and get it back as one flat Python function.

Equal operations on equal operands are recorded once, so the function is as long as the law has different steps,
whatever the body and the support.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any


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
        key = (operation, *(part.index if isinstance(part, Node) else ("number", part) for part in operands))
        if key not in self.known:
            self.known[key] = Node(self, len(self.steps))
            self.steps.append((operation, *operands))
        return self.known[key]

    def function(self, outputs: Sequence[Any]) -> Callable[[Sequence[float]], list[float]]:
        """Return the function of the inputs that gives the outputs."""
        lines = [f"    v{i} = {_written(self.steps[i])}" for i in self._needed(outputs)]
        returned = ", ".join(map(_name, outputs))
        source = "\n".join(["def traced(x):", *lines, f"    return [{returned}]"])
        place: dict[str, Any] = dict(_PYTHON)
        exec(source, place)  # noqa: S102  operators, numbers and the names of `_PYTHON`, nothing else
        return place["traced"]

    def _needed(self, outputs: Sequence[Any]) -> list[int]:
        """Return the steps that the outputs lean on, in order."""
        waiting, found = [part.index for part in outputs if isinstance(part, Node)], set()
        while waiting:
            index = waiting.pop()
            if index not in found:
                found.add(index)
                waiting += [part.index for part in self.steps[index][1:] if isinstance(part, Node)]
        return sorted(found)


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
        return self if _is(other, 0) else self._with("+", self, other)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Any:
        return self if _is(other, 0) else self._with("-", self, other)

    def __rsub__(self, other: Any) -> Any:
        return -self if _is(other, 0) else self._with("-", other, self)

    def __mul__(self, other: Any) -> Any:
        if _is(other, 0):
            return 0.0
        if _is(other, 1):
            return self
        return -self if _is(other, -1) else self._with("*", self, other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        return self if _is(other, 1) else self._with("/", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return 0.0 if _is(other, 0) else self._with("/", other, self)

    def _with(self, operation: str, *operands: Any) -> Any:
        """Record an operation with another scalar; vectors, matrices and jets know better."""
        known = all(isinstance(part, (int, float, Node)) for part in operands)
        return self.tape.record(operation, *operands) if known else NotImplemented

    def __neg__(self) -> Any:
        operation, *operands = self.tape.steps[self.index]
        return operands[0] if operation == "neg" else self.tape.record("neg", self)

    def __pow__(self, power: int) -> Any:
        return self if power == 1 else self.tape.record("**", self, power)

    def __abs__(self) -> Any:
        return self.tape.record("abs", self)

    def __lt__(self, other: Any) -> Any:
        return self.tape.record("<", self, other)

    def __gt__(self, other: Any) -> Any:
        return self.tape.record(">", self, other)


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


def _is(value: Any, number: float) -> bool:
    return isinstance(value, (int, float)) and value == number


def _name(part: Any) -> str:
    return f"v{part.index}" if isinstance(part, Node) else repr(float(part))


def _written(step: tuple[Any, ...]) -> str:
    operation, *operands = step
    if operation == "input":
        return f"x[{operands[0]}]"
    if operation == "neg":
        return f"-{_name(operands[0])}"
    if operation == "**":
        return f"{_name(operands[0])} ** {int(operands[1])}"
    names = [_name(part) for part in operands]
    return f"{operation}({', '.join(names)})" if operation in _PYTHON else f" {operation} ".join(names)
