"""Jacobi's elliptic functions by their complementary parameter, so that nothing is lost near the separatrix.

SciPy's `ellipj` takes m, and a float holds no m closer to 1 than 1e-16; here m₁ = 1 − m may be as small as it likes.
"""

from __future__ import annotations

from typing import Any

from ...mechanics.duals import Dual, value_of
from ...mechanics.scalars import Scalar, is_number, less, namespace

_MOST_STEPS = 40


def elliptic(u: Scalar, complement: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """Return sn u, cn u and dn u by descending arithmetic-geometric means (Bulirsch, Numer. Math. 7, 78 (1965)).

    Examples
    --------
    >>> [round(part, 12) for part in elliptic(1.0, 1.0)]  # sin 1, cos 1, 1
    [0.841470984808, 0.540302305868, 1.0]
    >>> [round(part, 12) for part in elliptic(1.0, 0.0)]  # tanh 1, sech 1, sech 1
    [0.761594155956, 0.648054273664, 0.648054273664]
    """
    xp = namespace(u, complement)
    hyperbolic = complement <= 0
    means = _means(xp, xp.where(hyperbolic, complement + 1, complement))
    c = means[-1][2]
    angle = c * u
    sine, cosine = xp.sin(angle), xp.cos(angle)
    at_zero = sine == 0
    a = cosine / xp.where(at_zero, sine + 1, sine)
    c = c * a
    dn = sine * 0 + 1
    for upper, lower, _ in reversed(means):
        a, c = a * c, c * dn
        dn = (lower + a) / (upper + a)
        a = c / upper
    sn = 1 / xp.sqrt(c * c + 1)
    sn = xp.where(at_zero, sine, xp.where(less(sine, 0), -sn, sn))
    cn = xp.where(at_zero, cosine, c * sn)
    dn = xp.where(at_zero, sine * 0 + 1, dn)
    grown, shrunk = xp.exp(xp.where(less(u, 0), u, -u)), xp.where(less(u, 0), sine * 0 - 1, sine * 0 + 1)
    square = grown * grown  # e^(−2|u|): tanh and sech without overflow
    sech = 2 * grown / (1 + square)
    tanh = -shrunk * xp.expm1(-2 * u * shrunk) / (1 + square)
    return (
        xp.where(hyperbolic, tanh, sn),
        xp.where(hyperbolic, sech, cn),
        xp.where(hyperbolic, sech, dn),
    )


def _means(xp: Any, complement: Scalar) -> list[tuple[Scalar, Scalar, Scalar]]:
    """Return the steps (a, b, (a + b)/2) of the arithmetic-geometric mean of 1 and √m₁."""
    # The next step squares it; slopes are as far off as what is left times theirs.
    near = 1e-16 if hasattr(xp, "exact") or isinstance(complement, Dual) else 1e-9
    a, b = complement * 0 + 1, xp.sqrt(complement)
    steps = []
    for _ in range(_MOST_STEPS):
        mean = (a + b) / 2
        steps.append((a, b, mean))
        apart = abs(value_of(a) - value_of(b)) <= near * value_of(a)
        if apart if is_number(apart) or isinstance(apart, bool) else bool(apart.all()):
            break
        a, b = mean, xp.sqrt(a * b)
    return steps
