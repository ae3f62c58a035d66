"""How a Chaplygin ball with two equal moments nods: its constants, and where it is at a time, by Kepler's equation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ...mechanics.algebra import Vector
from ...mechanics.scalars import namespace
from .kepler import inverse_of, precisely
from .phi import phase

if TYPE_CHECKING:
    from .chaplygin_ball import ChaplyginBall

_DIGITS = 120  # for the constants: where M is nearly upright they are small differences
_LEVEL = "1e-40"  # of M at least: only where it is upright to all digits is it tipped so, by less than any digit shows
_NOTHING = "1e-25"  # of 1: what so small a tip makes of nothing
_FORMS = 64  # whose constants are kept


@dataclass(frozen=True)
class Constants:
    """What follows from the start once and for all; all floats, or all mpmath's."""

    radius: Any
    mass: Any
    normal_force: Any
    px: Any  # where the centre starts
    py: Any
    mx: Any  # direction of the level part of M
    my: Any
    beta: Any  # D (1/(J₃ + D) − 1/(J₁ + D)): y² = α − βx²
    root: Any  # √α, α = J₁/(J₁ + D)
    cosine: Any  # C(φ₀) and S(φ₀): the middle of the swing
    sine: Any
    size: Any  # κ = S(ψ) at its end
    rest: Any  # k' = √(1 − βκ²)
    lead: Any  # b
    rate: Any  # ν, rad/s, and what the float leaves
    rate_rest: Any
    mean0: Any  # η₀ + b Φ(η₀)
    lag0: Any  # Φ(η₀)
    angle0: Any  # ψ(η₀)
    even: Any  # M̂·e = even C(ψ) + odd S(ψ), for the level part of M
    odd: Any
    turning: Any  # n×M̂·e = turning cos η
    nod: Any  # ẋ = nod cos η
    level: Any  # |M level|/(J₁ + D)
    ring: Any  # Ω = level M̂ + ring e/y, over the plane
    upright: Any  # Ω·n = upright + twist x/y
    twist: Any
    drift: Any  # a Ω over the plane, on average along M̂, m/s
    swing: Any  # and what comes and goes
    sway: Any

    @staticmethod
    def of(form: ChaplyginBall, t: Any = 0.0) -> Constants:
        """Return the constants as floats, or as mpmath's numbers if the time is one."""
        import mpmath

        found = _worked_out(form, max(_DIGITS, 2 * mpmath.mp.dps))
        return Constants(*found) if _is_mpmath(t) else Constants(*map(float, found))

    def at(self, t: Any) -> Now:
        """Return where the nutation is."""
        gone0 = self.mean0 - self.lead * self._lag(0 * self.size + 1)
        if _is_mpmath(t):
            import mpmath

            gone, turn = gone0 + (self.rate + self.rate_rest) * t, 2 * mpmath.pi
            gone = gone - turn * mpmath.floor(gone / turn)
            floats = Constants(*(float(part) for part in vars(self).values()))
            near = inverse_of(floats._mean, np.array([float(gone)]), np.array([2 * np.pi]))[0]
            eta = precisely(self._mean, gone, float(near))
        else:
            _, turned = phase((self.rate, self.rate_rest), np.asarray(t, dtype=float))
            gone = gone0 + turned
            gone = np.maximum(gone - 2 * np.pi * np.floor(gone / (2 * np.pi)), 0.0)
            eta = inverse_of(self._mean, gone, np.full_like(gone, 2 * np.pi))
        xp = namespace(eta)
        return self._now(xp.sin(eta), xp.cos(eta))

    def _mean(self, eta: Any) -> tuple[Any, Any]:
        """Return η + b Φ(η) less its value at 0, and its slope."""
        xp = namespace(eta)
        S = self.size * xp.sin(eta)
        value = eta + self.lead * (self._lag(xp.cos(eta)) - self._lag(0 * self.size + 1))
        return value, 1 - self.lead * S / xp.sqrt(1 - self.beta * S * S)

    def _lag(self, cosine: Any) -> Any:
        return arc(self.size * cosine / self.rest, -self.beta)

    def _now(self, sine: Any, cosine: Any) -> Now:
        S = self.size * sine
        C = namespace(S).sqrt(1 - self.beta * S * S)
        y = self.root * (self.cosine * C - self.beta * self.sine * S)
        x = self.root * (self.sine * C + self.cosine * S)
        lag, angle = self._lag(cosine), arc(S, self.beta)
        return Now(x, y, self.nod * cosine, lag, angle, self.even * C + self.odd * S, self.turning * cosine)


@dataclass(frozen=True)
class Now:
    """Where the nutation is: x = e·n, y, ẋ, Φ, ψ, and e over the plane along M and across it."""

    x: Any
    y: Any
    x_rate: Any
    lag: Any
    angle: Any
    ahead: Any
    aside: Any

    def axis(self, c: Constants) -> Vector:
        """Return e."""
        return Vector(c.mx * self.ahead - c.my * self.aside, c.my * self.ahead + c.mx * self.aside, self.x)


def arc(sine: Any, curvature: Any) -> Any:
    """Return the angle φ with S(φ) = sine, S = sin(√βφ)/√β or, where β is negative, sinh(√−βφ)/√−β.

    Examples
    --------
    >>> import math
    >>> float(arc(0.5, 1.0)) == math.asin(0.5), float(arc(0.5, -1.0)) == math.asinh(0.5), arc(0.5, 0.0)
    (True, True, 0.5)
    """
    if not curvature:
        return sine
    functions, asin, asinh = np, "arcsin", "arcsinh"
    if _is_mpmath(sine):
        import mpmath

        functions, asin, asinh = mpmath, "asin", "asinh"
    root = functions.sqrt(abs(curvature))
    return getattr(functions, asin if curvature > 0 else asinh)(root * sine) / root


@lru_cache(maxsize=_FORMS)
def _worked_out(form: ChaplyginBall, digits: int) -> tuple[Any, ...]:
    """Return the fields of `Constants` as mpmath numbers."""
    import mpmath

    given = (form.radius, form.mass, form.across, form.along, form.normal_force)
    with mpmath.workdps(digits):
        a, m, J1, J3, N = map(mpmath.mpf, given)
        px, py = map(mpmath.mpf, form.position)
        e, Omega = (Vector(*map(mpmath.mpf, triple)) for triple in (form.axis, form.angular_velocity))
        e = e / e.norm()
        D, spin = m * a * a, Omega.dot(e)
        A1, A3 = 1 / (J1 + D), 1 / (J3 + D)
        alpha, beta = J1 * A1, D * (A3 - A1)
        root = mpmath.sqrt(alpha)
        M = Omega / A1 + e * ((J3 - J1) * spin)
        M = Vector(M.x, M.y, M.z - D * Omega.z)
        tip = mpmath.mpf(_LEVEL) * (M.norm() or 1 / A1)
        tipped = mpmath.hypot(M.x, M.y) < tip
        if tipped:
            M = Vector(tip, mpmath.mpf(0), M.z)
        level = mpmath.hypot(M.x, M.y)
        mx, my = M.x / level, M.y / level
        x = e.z
        y = mpmath.sqrt(alpha - beta * x * x)
        C, mu = (M.dot(e) + D / J1 * M.z * x) / y, M.z / alpha
        # The middle of the swing, by the double angle.
        w = level**2 + mu**2 - beta * C * C
        R = mpmath.sqrt(w * w + 4 * beta * (C * mu) ** 2)
        cosine = mpmath.sqrt((1 + w / R) / 2)
        sine = C * mu / (R * cosine)
        S0, nodding = (x * cosine - y * sine) / root, e.y * M.x - e.x * M.y  # S(ψ₀) and ẋ₀/A₁
        wide = mpmath.sqrt(alpha * R)
        size = mpmath.hypot(S0, nodding / wide)
        eta0 = mpmath.atan2(S0 * wide, nodding) if size else mpmath.mpf(0)
        rest = mpmath.sqrt(1 - beta * size * size)
        lead, rate = beta * sine / cosine, A1 * mpmath.sqrt(R) / cosine
        lag0 = arc(size * mpmath.cos(eta0) / rest, -beta)
        high = mpmath.mpf(float(rate))
        B = A3 - A1
        ring = B * alpha * C
        sway = a * ring / (A1 * level)
        even, odd = root * (C * cosine - mu * sine) / level, -root * (C * beta * sine + mu * cosine) / level
        way, turning = a * ring / (A1 * mpmath.sqrt(R) * root), size * wide / level
        drift, swing = a * A1 * level + way * rate * even, -way * (even * lead + odd)
        twist = B * C
        if tipped:  # take the tip out again
            none, nothing = 0 * level, mpmath.mpf(_NOTHING)
            level = drift = none
            if max(abs(even), abs(odd) * size, abs(turning)) < nothing:  # e is upright, too
                even = odd = turning = swing = sway = none
            if abs(C) < nothing * abs(mu):  # or level
                ring = twist = swing = sway = none
        return (
            a, m, N, px, py, mx, my, beta, root, cosine, sine, size, rest, lead,
            high, rate - high, eta0 + lead * lag0, lag0, arc(S0, beta), even, odd,
            turning, A1 * size * wide, A1 * level, ring, M.z / J1, twist, drift, swing, sway,
        )  # fmt: skip


def _is_mpmath(t: Any) -> bool:
    return type(t).__module__.partition(".")[0] == "mpmath"
