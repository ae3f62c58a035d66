"""How n goes round in a Chaplygin ball whose momentum is upright: its constants, and what follows from the time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.scalars import namespace
from .jacobi import elliptic

if TYPE_CHECKING:
    from .upright_chaplygin_ball import UprightChaplyginBall

_DIGITS = 60  # for the constants: near the separatrix they are small differences
_FORMS = 64  # whose constants are kept


@dataclass(frozen=True)
class Constants:
    """What follows from the start once and for all; all floats, or all mpmath's."""

    radius: Any
    mass: Any
    normal_force: Any
    px: Any  # where the centre starts
    py: Any
    complement: Any  # m₁
    parameter: Any  # m
    scale: Any  # λ, 1/s, with the sign of L
    u0: Any
    middle: Any  # 0 if ψ belongs to the axis that n circles, 1 if to the other extreme one
    steady: Any  # ψ̇ = steady + extra/(1 − ν sn²)
    extra: Any
    nu: Any
    outward: Any  # Ω = upright n + (outward h u + sideways sn o v)/√(1 − ν sn²), u over the plane along the axis
    sideways: Any
    upright: Any
    third0: Any  # the integral of the third kind up to u₀
    psi: Any  # ψ₀
    rate: Any  # 2π over the half round, rad/s, and what the float leaves
    rate_rest: Any
    gain: Any  # of ψ over the half round, and half a turn where that turns u over; less whole turns
    gain_rest: Any
    ga: Any  # n in the body: ga cn, gb sn, gc dn along its axes
    gb: Any
    gc: Any
    a_x: Any  # these axes among the principal ones
    a_y: Any
    a_z: Any
    c_x: Any
    c_y: Any
    c_z: Any

    @staticmethod
    def of(form: UprightChaplyginBall, t: Any = 0.0) -> Constants:
        """Return the constants as floats, or as mpmath's numbers if the time is one."""
        import mpmath

        turning = replace(form, position=(0.0, 0.0), normal_force=0.0)  # neither has a part in how it turns
        found = _worked_out(turning, max(_DIGITS, mpmath.mp.dps))
        plain = form.radius, form.mass, form.normal_force, *form.position
        if type(t).__module__.startswith("mpmath"):
            return Constants(*map(mpmath.mpf, plain), *found)
        return Constants(*map(float, (*plain, *found)))

    @property
    def followed(self) -> Vector:
        """The axis that ψ belongs to."""
        first, third = Vector(self.a_x, self.a_y, self.a_z), Vector(self.c_x, self.c_y, self.c_z)
        return first if self.middle else third

    def at(self, t: Any, parity: Any) -> Now:
        """Return what repeats; sn and cn have changed their signs after an odd number of half rounds, parity −1."""
        return Now(self, *elliptic(self.u0 + self.scale * t, self.complement), parity)


@dataclass(frozen=True)
class Now:
    """What repeats in the motion, at a time: each is worked out where it is asked for."""

    constants: Constants
    sn: Any
    cn: Any
    dn: Any
    parity: Any

    @cached_property
    def _square(self) -> Any:
        return 1 - self.constants.nu * self.sn * self.sn

    @cached_property
    def _over(self) -> Any:
        """Its root, with the sign of Ω over the plane."""
        flips = self.parity if self.constants.middle else 1
        return namespace(self._square).sqrt(self._square) * flips

    @property
    def _h_and_o(self) -> tuple[Any, Any]:
        return (self.cn, self.dn) if self.constants.middle else (self.dn, self.cn)

    @property
    def along(self) -> Any:
        """Ω over the plane, along the axis, rad/s."""
        return self.constants.outward * self._h_and_o[0] / self._over

    @property
    def across(self) -> Any:
        """The same across it."""
        return self.constants.sideways * self.sn * self._h_and_o[1] / self._over

    @property
    def along_rate(self) -> Any:
        """How fast `along` grows as seen from the axis, rad/s²."""
        c, (h, o) = self.constants, self._h_and_o
        of_h = 1 if c.middle else c.parameter
        return c.scale * c.outward * self.sn * o * (c.nu * h * h / self._square - of_h) / self._over

    @property
    def across_rate(self) -> Any:
        """The same of `across`."""
        c, (h, o), s = self.constants, self._h_and_o, self.sn
        of_o = c.parameter if c.middle else 1
        return c.scale * c.sideways * h * (o * o - of_o * s * s + c.nu * s * s * o * o / self._square) / self._over

    @property
    def precession(self) -> Any:
        """ψ̇, rad/s."""
        return self.constants.steady + self.constants.extra / self._square

    @property
    def normal(self) -> Vector:
        """The normal along the principal axes."""
        c = self.constants
        first, third = Vector(c.a_x, c.a_y, c.a_z), Vector(c.c_x, c.c_y, c.c_z)
        circled = first * (c.ga * self.cn) + third.cross(first) * (c.gb * self.sn)
        return circled * self.parity + third * (c.gc * self.dn)


@dataclass(frozen=True)
class Polhode:
    """How n goes round in the body, in many digits; of its axes a, b, c the second is the middle one, c circled."""

    inertia: tuple[Any, Any, Any]  # J + D along them
    axes: tuple[Vector, Vector, Vector]  # among the principal ones
    normal: tuple[Any, Any, Any]  # n along them, at the start
    out: Quaternion  # from the principal axes to the support frame
    inverse: Any  # Ω·n/L
    over_a: Any  # 1 − I_a Ω·n/L and I_c Ω·n/L − 1, which carry the sign of I_c − I_a
    over_c: Any
    complement: Any  # m₁

    @staticmethod
    def of(form: UprightChaplyginBall) -> Polhode:
        """Read it from a ball."""
        import mpmath

        with mpmath.workdps(max(_DIGITS, mpmath.mp.dps)):
            a, m = mpmath.mpf(form.radius), mpmath.mpf(form.mass)
            I = [mpmath.mpf(J) + m * a * a for J in form.moments]
            four = [mpmath.mpf(part) for part in form.orientation]
            size = mpmath.sqrt(sum(part * part for part in four))
            q = Quaternion(*(part / size for part in four))
            up = q.matrix().c  # n along the principal axes
            inverse = sum(g * g / i for g, i in zip(up, I, strict=True))
            low, mid, high = sorted(range(3), key=lambda i: I[i])
            ia, ic = (low, high) if inverse * I[mid] < 1 else (high, low)
            Ia, Ib, Ic = I[ia], I[mid], I[ic]
            first, third = _unit(ia, 1), _unit(ic, -1 if [*up][ic] < 0 else 1)
            second = third.cross(first)
            ya, yb, yc = up.dot(first), up.dot(second), up.dot(third)
            over_c = ya * ya * (Ic / Ia - 1) + yb * yb * (Ic / Ib - 1)
            over_a = yc * yc * (1 - Ia / Ic) + yb * yb * (1 - Ia / Ib)
            short = ya * ya * (1 - Ib / Ia) + yc * yc * (1 - Ib / Ic)  # 1 − I_b Ω·n/L
            complement = (Ic - Ia) * short / ((Ic - Ib) * over_a) if over_a else mpmath.mpf(0)
            return Polhode((Ia, Ib, Ic), (first, second, third), (ya, yb, yc), q, inverse, over_a, over_c, complement)


@lru_cache(maxsize=_FORMS)
def _worked_out(form: UprightChaplyginBall, digits: int) -> tuple[Any, ...]:
    """Return the fields of `Constants` from `complement` on as mpmath numbers."""
    import mpmath

    with mpmath.workdps(digits):
        L, n = mpmath.mpf(form.momentum), Polhode.of(form)
        (Ia, Ib, Ic), (first, _, third) = n.inertia, n.axes
        wide_a, wide_b = mpmath.sqrt(Ia / abs(Ic - Ia)), mpmath.sqrt(Ib / abs(Ic - Ib))
        side = mpmath.mpf(1 if Ic > Ia else -1)
        ga, gb = wide_a * mpmath.sqrt(abs(n.over_c)), side * wide_b * mpmath.sqrt(abs(n.over_c))
        gc = mpmath.sqrt(Ic * n.over_a / (Ic - Ia))
        parameter = (Ib - Ia) * n.over_c / ((Ic - Ib) * n.over_a)
        scale = L * mpmath.sqrt((Ic - Ib) * n.over_a / (Ia * Ib * Ic))
        angle = mpmath.atan2(side * n.normal[1] / wide_b, n.normal[0] / wide_a)
        u0 = mpmath.ellipf(angle, parameter)
        # The axis that ψ belongs to is not to come upright, nor nearly: it is a, if the middle moment is close to c's.
        middle = (Ic * (Ib - Ia) - Ia * (Ic - Ib)) * side > 0
        if middle:
            lean = mpmath.sqrt(1 - ga * ga)
            steady, nu, extra = L / Ia, -ga * ga / lean**2, L * (n.inverse - 1 / Ia) / lean**2
            outward, sideways = -lean * extra * ga, L * (1 / Ib - 1 / Ic) * gb * gc / lean
        else:
            steady, nu, extra = L / Ic, 1 - (wide_b / wide_a) ** 2, L * (1 / Ia - 1 / Ic)
            outward, sideways = -ga * extra * gc, L * (1 / Ia - 1 / Ib) * gb
        out = n.out.matrix() @ (first if middle else third)
        K, tau = mpmath.ellipk(parameter), 2 * mpmath.pi
        rate = mpmath.pi * abs(scale) / K
        gain = tau / rate * (steady + extra * mpmath.ellippi(nu, parameter) / K) + (mpmath.pi if middle else 0)
        gain = gain - tau * mpmath.nint(gain / tau)
        rate_high, gain_high = mpmath.mpf(float(rate)), mpmath.mpf(float(gain))
        return (
            n.complement, parameter, scale, u0, mpmath.mpf(int(middle)), steady, extra, nu,
            outward, sideways, L * n.inverse, mpmath.ellippi(nu, angle, parameter), mpmath.atan2(out.y, out.x),
            rate_high, rate - rate_high, gain_high, gain - gain_high, ga, gb, gc, *first, *third,
        )  # fmt: skip


def _unit(i: int, sign: int) -> Vector:
    import mpmath

    return Vector(*(mpmath.mpf(sign if j == i else 0) for j in range(3)))


def precession(c: Constants, t: Any) -> Any:
    """Return ψ since the start by the integral of the third kind, in mpmath's numbers."""
    import mpmath

    u = c.u0 + c.scale * t
    sn, cn, _ = elliptic(u, c.complement)
    angle, tau = mpmath.atan2(sn, cn), 2 * mpmath.pi
    angle = angle + tau * mpmath.nint((u * mpmath.pi / (2 * mpmath.ellipk(c.parameter)) - angle) / tau)
    return c.steady * t + c.extra / c.scale * (mpmath.ellippi(c.nu, angle, c.parameter) - c.third0)
