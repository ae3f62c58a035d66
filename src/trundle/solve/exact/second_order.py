"""The solutions of ÿ = λẏ + μy with complex constants, smooth where exponents coincide or vanish.

With G(0) = 0 and Ġ(0) = 1 every solution is y = y₀(Ġ − λG) + ẏ₀G, and a constant push φ adds φ∫G.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial
from typing import Any

import numpy as np

_TERMS = 22  # of the power series below |s₁t| = 1: the next would be 1e-20
_HYPERBOLIC = [1 / factorial(2 * n + 1) for n in range(11)]  # sinh z/z in z²


@dataclass(frozen=True)
class Fundamental:
    """The solution with y(0) = 0, ẏ(0) = 1, its rate and its integral, and the solution with y(0) = 1, ẏ(0) = 0.

    Examples
    --------
    >>> at_once = fundamental(0.0, -1.0, 2.0)  # sin, cos, 1 − cos, cos
    >>> abs(at_once.G - np.sin(2.0)) + abs(at_once.H - 1 + np.cos(2.0)) < 1e-15
    np.True_
    """

    G: Any
    G_rate: Any
    H: Any
    U: Any


def fundamental(lam: Any, mu: Any, t: Any) -> Fundamental:
    """Return the solutions at given times.

    Examples
    --------
    >>> fundamental(0.0, 0.0, 3.0).H  # free: t²/2
    np.complex128(4.5+0j)
    """
    if type(t).__module__.partition(".")[0] == "mpmath":
        return _precisely(lam, mu, t)
    lam, mu, t = (np.asarray(part, dtype=complex) for part in (lam, mu, t))
    half = 0.5 * lam
    apart = np.sqrt(half * half + mu)
    apart = np.where((half.conjugate() * apart).real < 0, -apart, apart)  # so that s₁ is a sum, not a difference
    fast = half + apart
    slow = np.where(fast == 0, 0.0, -mu / np.where(fast == 0, 1.0, fast))  # s₁s₂ = −μ
    near = np.abs(fast * t) < 1
    series = _series(np.where(near, lam * t, 0.0), np.where(near, mu * t * t, 0.0), t)
    coincident = np.abs(apart * t) < 1
    z2 = np.where(coincident, (apart * t) ** 2, 0.0)
    ratio = sum((c * z2**n for n, c in reversed(list(enumerate(_HYPERBOLIC)))), 0.0 * z2)
    e1, e2, between = np.exp(fast * t), np.exp(slow * t), np.where(coincident, 1.0, 2 * apart)
    G = np.where(coincident, t * np.exp(half * t) * ratio, (e1 - e2) / between)
    H = (G - t * _phi1(slow * t)) / np.where(near, 1.0, fast)
    far = (G, e1 + slow * G, H, e2 - slow * G)
    return Fundamental(*(np.where(near, a, b)[()] for a, b in zip(series, far, strict=True)))


def _series(lam_t: Any, mu_tt: Any, t: Any) -> tuple[Any, Any, Any, Any]:
    """Return G, Ġ, H, U as power series: the coefficients gₙ of tⁿ/n! obey gₙ₊₁ = λgₙ + μgₙ₋₁."""
    before, now = 0.0 * lam_t, 0.0 * lam_t + 1.0  # gₙtⁿ⁻¹/n!, and the same of n − 1 over t times …
    G, rate, H = 0.0 * lam_t, 0.0 * lam_t, 0.0 * lam_t
    for n in range(1, _TERMS + 1):
        G, rate, H = G + now, rate + n * now, H + now / (n + 1)
        before, now = now, lam_t * now / (n + 1) + mu_tt * before / (n * (n + 1))
    return t * G, rate, t * t * H, 1.0 + mu_tt * H


def _phi1(z: Any) -> Any:
    small = np.abs(z) < 1
    near, away = np.where(small, z, 0.0), np.where(small, 1.0, z)
    series = sum((near**n / factorial(n + 1) for n in range(19, -1, -1)), 0.0 * near)
    return np.where(small, series, (np.exp(away) - 1) / away)


def _precisely(lam: Any, mu: Any, t: Any) -> Fundamental:
    """Use the definitions, with enough digits to spare that no care is needed."""
    import mpmath

    lam, mu = mpmath.mpmathify(lam), mpmath.mpmathify(mu)
    with mpmath.extradps(3 * mpmath.mp.dps):
        root = mpmath.sqrt(lam * lam / 4 + mu)
        shift = mpmath.mpf(10) ** (-mpmath.mp.dps // 3) * (1 + abs(lam)) if root == 0 else 0
        root = root + shift  # coincident exponents are taken a little apart
        s1, s2 = lam / 2 + root, lam / 2 - root
        G = (mpmath.exp(s1 * t) - mpmath.exp(s2 * t)) / (s1 - s2)
        slow, fast = sorted((s1, s2), key=abs)
        slope = mpmath.exp(fast * t) + slow * G
        part = t if slow == 0 else mpmath.expm1(slow * t) / slow
        H = t * t / 2 if fast == 0 else (G - part) / fast
        U = mpmath.exp(slow * t) - slow * G
    return Fundamental(+G, +slope, +H, +U)
