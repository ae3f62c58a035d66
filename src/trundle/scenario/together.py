"""Checks that do not depend on each other, made together, so that a reader is told of all that fail."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from ..errors import InvalidValueError, ScenarioError


def each_checked(check: Callable[[Any, str], Any], values: Sequence[Any], key: str = "") -> tuple[Any, ...]:
    """Check each of a list of values, and tell of all that are wrong.

    Examples
    --------
    >>> each_checked(lambda value, key: float(value), ["1", 2])
    (1.0, 2.0)
    """
    return tuple(tell_all(*(partial(check, value, f"{key}[{index}]") for index, value in enumerate(values))))


def tell_all(*checks: Callable[[], Any]) -> list[Any]:
    """Make some checks that do not depend on each other, and tell of all that fail.

    Examples
    --------
    >>> tell_all(lambda: 1, lambda: 2)
    [1, 2]
    """
    made: list[Any] = []
    wrong: list[InvalidValueError] = []
    for check in checks:
        try:
            made.append(check())
        except InvalidValueError as error:
            wrong += [error, *getattr(error, "others", ())]
    if wrong:
        raise wrong[0] if len(wrong) == 1 else ScenarioError.of(wrong)
    return made
