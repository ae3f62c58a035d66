"""Small frozen records that are made millions of times in a run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar, dataclass_transform

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
