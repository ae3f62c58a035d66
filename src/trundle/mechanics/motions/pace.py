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

    Examples
    --------
    >>> from trundle.mechanics.expressions import Expression
    >>> round(largest(Expression.parse("0.1*sin(3*t)", ("t",), "angle"), 0.0, 10.0).pace, 3)
    3.0
    """
    import numpy as np

    times = start + (end - start) * (np.arange(_LOOKS) + 0.5) / _LOOKS
    with np.errstate(all="ignore"):  # a formula may have no value here or there
        parts = [np.broadcast_to(np.asarray(part, dtype=float), times.shape) for part in course(value, times)]
    sizes = np.abs(parts)
    found = sizes[:, np.isfinite(sizes).all(axis=0)]
    return Sizes(*found.max(axis=1, initial=0.0).tolist())
