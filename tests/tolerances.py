"""The bounds that comparisons are held to; docs/conventions.md says what each is for."""

from __future__ import annotations

from typing import Any

ULP = 2.0**-52


def EXACT(ulps: float, scale: Any) -> Any:
    """Return some units in the last place of a quantity of that scale.

    Examples
    --------
    >>> EXACT(4, 2.0) == 2.0**-49
    True
    """
    return ulps * ULP * scale


def SOLVER(multiple: float, tolerance: float, scale: Any = 1.0) -> Any:
    """Return a multiple of the tolerance that a solver was asked for, for a quantity of that scale.

    Examples
    --------
    >>> SOLVER(100, 1e-12, 2.0)
    2e-10
    """
    return multiple * tolerance * scale
