"""Bodies whose inertia ratio has a name."""

from __future__ import annotations

from typing import Any

import sympy as sp

NAMES = {
    sp.Rational(2, 5): "homogeneous ball",
    sp.Rational(2, 3): "thin spherical shell",
    sp.Rational(1, 2): "homogeneous cylinder",
    sp.Integer(1): "hoop",
}


def named_ratio(ratio: Any) -> tuple[Any, str] | None:
    """Return an inertia ratio as a fraction with the name of the body, if it is one of the common ones.

    Examples
    --------
    >>> named_ratio(0.4)
    (2/5, 'homogeneous ball')
    """
    return next(((known, name) for known, name in NAMES.items() if float(known) == float(ratio)), None)
