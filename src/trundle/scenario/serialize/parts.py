"""What the words of every part have in common: numbers, written bare, and refusals."""

from __future__ import annotations

import math
from typing import Any

from ...errors import ScenarioError
from ...mechanics.algebra import Vector
from ...mechanics.expressions import Expression
from ...mechanics.parts import Part, defaults_of, fields_of

Words = dict[str, Any]


def words_of(part: Part, key: str) -> Words:
    """Return the words of a part by its fields; what stands at its default is left out.

    Examples
    --------
    >>> from trundle.mechanics.motions import Shake
    >>> words_of(Shake((0.002, 0.0, 0.0), 30.0), "support.motion")
    {'kind': 'shake', 'amplitude': [0.002, 0.0, 0.0], 'rate': 30.0}
    """
    if part.table_of:
        return {"kind": part.table_of, **part.given}
    if "kind" not in vars(type(part)):
        raise wordless(key, part)
    words, defaults = {"kind": part.kind}, defaults_of(type(part))
    for name, field in fields_of(type(part)).items():
        value, place = getattr(part, name), f"{key}.{name}"
        default = defaults.get(name)
        if value is not None and (default is None or value != field.read(default, name)):
            words[name] = word_of(value, place)
    return words


def word_of(value: Any, place: str) -> Any:
    """Return what stands in a file for the value of a field.

    Examples
    --------
    >>> word_of((1, 2.5), "position")
    [1.0, 2.5]
    """
    if isinstance(value, str):
        return value
    if isinstance(value, Expression):
        return value.text
    if isinstance(value, tuple) and all(isinstance(part, Part) for part in value):
        return [words_of(part, f"{place}[{i}]") for i, part in enumerate(value)]
    return numbers_of(value, place) if isinstance(value, (tuple, Vector)) else number_of(value, place)


def number_of(value: Any, key: str) -> float:
    """Return a number as a file can hold it, finite and one.

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

    Examples
    --------
    >>> print(wordless("body", 1.0))
    `body` must be of a kind that the scenario format has words for; got 'float'. Keep it in Python.
    """
    kind = type(thing).__name__
    return ScenarioError(key, "must be of a kind that the scenario format has words for", kind, "Keep it in Python.")
