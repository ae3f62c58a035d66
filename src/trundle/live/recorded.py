"""Numbers that remember how they came about: what is decided is decided by their values, the rest is on a tape."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..mechanics.duals import Dual, value_of
from ..mechanics.scalars import is_number, namespace


class Recorded(Dual):
    """A number with the step of a tape that makes it, for what must look at numbers on its way, as placing does.

    Where the numbers of another case would be decided otherwise, the tape is not theirs: whoever uses it must compare.

    Parameters
    ----------
    value : float
        What it is.
    step : Node or float
        How it comes about.

    Examples
    --------
    >>> from trundle.solve.tape import Tape
    >>> tape = Tape()
    >>> (x,) = tape.inputs(1)
    >>> y = Recorded(3.0, x)
    >>> found = y * y if y > 1.0 else -y
    >>> found.value, tape.function([found.step])([2.0])
    (9.0, [4.0])
    """

    __slots__ = ("step",)

    def __init__(self, value: float, step: Any) -> None:
        super().__init__(value, ())
        self.step = step

    def __repr__(self) -> str:
        return f"Recorded({self.value!r})"

    @staticmethod
    def scalar_functions() -> Any:
        """Return the functions that `trundle.mechanics.scalars.namespace` finds for it."""
        return _Functions

    def __add__(self, other: Any) -> Any:
        return _made(lambda a, b: a + b, self, other)

    def __radd__(self, other: Any) -> Any:
        return _made(lambda a, b: a + b, other, self)

    def __sub__(self, other: Any) -> Any:
        return _made(lambda a, b: a - b, self, other)

    def __rsub__(self, other: Any) -> Any:
        return _made(lambda a, b: a - b, other, self)

    def __mul__(self, other: Any) -> Any:
        return _made(lambda a, b: a * b, self, other)

    def __rmul__(self, other: Any) -> Any:
        return _made(lambda a, b: a * b, other, self)

    def __truediv__(self, other: Any) -> Any:
        return _made(lambda a, b: a / b, self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _made(lambda a, b: a / b, other, self)

    def __pow__(self, power: int) -> Any:
        return Recorded(self.value**power, self.step**power)

    def __neg__(self) -> Recorded:
        return Recorded(-self.value, -self.step)

    def __abs__(self) -> Any:
        return Recorded(abs(self.value), abs(self.step))

    def __float__(self) -> float:
        raise TypeError("a number on the way is wanted as a plain number")


def step_of(x: Any) -> Any:
    """Return how a number comes about; a plain number is its own step.

    Examples
    --------
    >>> step_of(2.0), step_of(Recorded(3.0, 4.0))
    (2.0, 4.0)
    """
    return x.step if isinstance(x, Recorded) else x


def _made(operation: Callable[[Any, Any], Any], a: Any, b: Any) -> Any:
    """Work out both what comes of two numbers and how; vectors, matrices and jets know better."""
    if not all(is_number(x) or isinstance(x, Recorded) for x in (a, b)):
        return NotImplemented
    return Recorded(operation(value_of(a), value_of(b)), operation(step_of(a), step_of(b)))


class _Functions:
    """The functions of `scalars.namespace`: of the values, and of the steps."""

    @staticmethod
    def where(condition: Any, yes: Any, no: Any) -> Any:
        return yes if condition else no


def _function(name: str) -> Any:
    def applied(*given: Any) -> Any:
        values, steps = ([part(x) for x in given] for part in (value_of, step_of))
        return Recorded(getattr(namespace(*values), name)(*values), getattr(namespace(*steps), name)(*steps))

    return staticmethod(applied)


for _name in ("sqrt", "sin", "cos", "tan", "exp", "expm1", "log", "abs", "hypot", "atan2"):
    setattr(_Functions, _name, _function(_name))
