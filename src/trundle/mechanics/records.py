"""Small frozen records that are made millions of times in a run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any, TypeVar, dataclass_transform

T = TypeVar("T")


@dataclass_transform(frozen_default=True)
def frozen_record(*, eq: bool = True) -> Callable[[type[T]], type[T]]:
    """Make a class a dataclass that type checkers hold to be frozen, and that is made at a plain one's price.

    A dataclass that Python itself keeps frozen takes four times as long to make, and the mechanics makes little else.

    Examples
    --------
    >>> @frozen_record()
    ... class Pair:
    ...     first: float
    ...     second: float
    >>> Pair(1.0, 2.0)
    Pair(first=1.0, second=2.0)
    """
    return dataclass(slots=True, eq=eq, unsafe_hash=eq)


def remembered(function: Callable[[Any], T]) -> Callable[[Any], T]:
    """Let a frozen part keep what a function of it returned: as a cached property, of a part that knows nothing of it.

    Examples
    --------
    >>> @dataclass(frozen=True)
    ... class Side:
    ...     length: float
    >>> @remembered
    ... def square(side):
    ...     print("multiplied")
    ...     return side.length**2
    >>> side = Side(3.0)
    >>> square(side), square(side)
    multiplied
    (9.0, 9.0)
    """
    name = f"{function.__module__}.{function.__qualname__}"  # no attribute of a part is named so

    @wraps(function)
    def answer(part: Any) -> T:
        kept = getattr(part, "__dict__", None)
        if kept is None:  # it has no room for that
            return function(part)
        if name not in kept:
            kept[name] = function(part)
        found: T = kept[name]
        return found

    return answer
