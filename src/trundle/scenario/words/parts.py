"""What the words of every part have in common: numbers, written bare, and refusals."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ...errors import ScenarioError
from ...mechanics.expressions import Expression

Words = dict[str, Any]
Describe = dict[type, Callable[[Any, str], Words]]  # what writes a thing of each type, under the name of its key


def one_of(words: dict[type, Callable[[Any, str], Words]], thing: Any, key: str) -> Words:
    """Return the words of a thing, by the entry for its type.

    Parameters
    ----------
    words : dict
        What writes a thing of each type.
    thing : object
        A surface, motion or load.
    key : str
        Its place in the file, for messages.

    Returns
    -------
    dict
        Its table.

    Raises
    ------
    ScenarioError
        If the format has no words for its type.

    Examples
    --------
    >>> one_of({float: lambda thing, key: {"kind": key}}, 1.0, "load")
    {'kind': 'load'}
    """
    if type(thing) not in words:
        raise wordless(key, thing)
    return words[type(thing)](thing, key)


def number_of(value: Any, key: str) -> float:
    """Return a number as a file can hold it, finite and one.

    Parameters
    ----------
    value : object
        Of a system.
    key : str
        Its place in the file, for messages.

    Returns
    -------
    float
        The number.

    Raises
    ------
    ScenarioError
        If it is an array, a symbol or not finite.

    Examples
    --------
    >>> number_of(2, "gravity")
    2.0
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        remedy = "Describe one member at a time."
        raise ScenarioError(key, "must be one number to be written to a file", value, remedy) from None
    if not math.isfinite(number):
        raise ScenarioError(key, "must be a finite number", value)
    return number


def numbers_of(values: Any, key: str) -> list[Any]:
    """Return numbers, and formulas as their texts.

    Parameters
    ----------
    values : iterable
        Of a system.
    key : str
        Their place in the file, for messages.

    Returns
    -------
    list
        Of float and str.

    Examples
    --------
    >>> numbers_of((1, 2.5), "value")
    [1.0, 2.5]
    """
    return [
        value.text if isinstance(value, Expression) else number_of(value, f"{key}[{i}]")
        for i, value in enumerate(values)
    ]


def wordless(key: str, thing: Any) -> ScenarioError:
    """Return the error of a part that the format has no words for.

    Parameters
    ----------
    key : str
        Its place in the file.
    thing : object
        The part.

    Returns
    -------
    ScenarioError
        To be raised.

    Examples
    --------
    >>> print(wordless("body", 1.0))
    `body` must be of a kind that the scenario format has words for; got 'float'. Keep it in Python.
    """
    kind = type(thing).__name__
    return ScenarioError(key, "must be of a kind that the scenario format has words for", kind, "Keep it in Python.")
