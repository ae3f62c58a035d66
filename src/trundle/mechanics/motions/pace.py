"""How large a formula in the time gets and how fast it changes, as looks at it show."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..expressions import course

_LOOKS = 400


class Sizes(NamedTuple):
    """The largest sizes of a formula and of its first and second rate in an interval of time."""

    value: float
    rate: float
    bend: float

    @property
    def pace(self) -> float:
        """How fast it changes, 1/s: ν for sin νt, 0 for a steady growth."""
        return self.bend / self.rate if self.rate > 0 else 0.0


def largest(value: Any, start: float, end: float) -> Sizes:
    """Return the largest sizes of a number or formula in the time, wherever in an interval it is finite.

    Parameters
    ----------
    value : float or Expression
        The number or formula in t.
    start, end : float
        The interval, s.

    Returns
    -------
    Sizes
        As equally spaced looks show them.

    Examples
    --------
    >>> from trundle.mechanics.expressions import Expression
    >>> round(largest(Expression.parse("0.1*sin(3*t)", ("t",), "angle"), 0.0, 10.0).pace, 3)
    3.0
    """
    found = []
    for i in range(_LOOKS):
        try:
            found.append([abs(float(part)) for part in course(value, start + (end - start) * (i + 0.5) / _LOOKS)])
        except (ArithmeticError, ValueError):
            continue
    return Sizes(*(max((each[i] for each in found), default=0.0) for i in range(3)))
