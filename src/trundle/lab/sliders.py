"""How far the slider of a number goes, from an example of it and from what it may be."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ..errors import InvalidValueError
from ..scenario.fields import Measure
from ..units import UNITS, to_si

_DECADE, _TIMES = 10.0, 5.0
_HALVINGS = 50


def slider(measure: Measure, example: float | None) -> dict[str, Any]:
    """Return the ends of a slider, SI, and whether it goes by decades.

    A number that must be positive goes from a tenth of its example to ten times that, by decades; any other goes five
    times as far as its example, to both sides if it may be negative. None goes further than it may, and no angle
    further than half a turn, which is how far one goes that has no example.

    Parameters
    ----------
    measure : Measure
        What the number is.
    example : float, optional
        A usual size of it, SI; absent: that of its dimension.

    Returns
    -------
    dict
        `min`, `max` and `decades`.

    Examples
    --------
    >>> slider(Measure("mass", "positive"), 0.5)
    {'min': 0.05, 'max': 5.0, 'decades': True}
    >>> slider(Measure("velocity"), 0.2)
    {'min': -1.0, 'max': 1.0, 'decades': False}
    """
    usual = abs(example or (math.pi if measure.kind == "angle" else to_si(UNITS[measure.kind][1], measure.kind, "")))

    def may_be(number: float) -> bool:
        try:
            measure(number)
        except InvalidValueError:
            return False
        return True

    decades = not may_be(0.0) and not may_be(-usual)
    highest = usual * (_DECADE if decades else _TIMES)
    if measure.kind == "angle":
        highest = min(highest, math.pi)
    highest = _last(may_be, usual, highest)
    if decades:
        return {"min": usual / _DECADE, "max": highest, "decades": True}
    lowest = _last(may_be, -usual, -highest) if may_be(-usual) else 0.0
    return {"min": lowest, "max": highest, "decades": False}


def _last(may_be: Callable[[float], bool], good: float, end: float) -> float:
    """Return the last number on the way from a good one to an end that may be."""
    if may_be(end):
        return end
    for _ in range(_HALVINGS):
        middle = 0.5 * (good + end)
        good, end = (middle, end) if may_be(middle) else (good, middle)
    return good
