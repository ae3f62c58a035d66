"""The ideal demonstration: a ball that circles on a level table, and how theory says its circle fares."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from trundle.wording import with_unit

from ...errors import InvalidValueError
from ...mechanics.algebra import Vector
from ...mechanics.loads import Drag, Load, RollingResistance
from ...mechanics.motions import Motion, Spin
from ...mechanics.parts import words_of
from ...mechanics.system import RollingSystem, State
from .resisted import ResistedCircle


@dataclass(frozen=True)
class Fate:
    """What theory says of a ball's circle: the path stays within `radius` + `sway` of a centre."""

    centre: Callable[[float], complex]  # of the time, s: x + iy, m
    radius: Callable[[float], float]  # of the time: m
    sway: float  # how far the ball may be off that circle, m
    saying: str  # in words

    def reach(self, time: float) -> float:
        """Return the distance from the axis that the ball cannot exceed, m."""
        return abs(self.centre(time)) + self.radius(time) + self.sway

    def leaves(self, rim: float, horizon: float) -> float:
        """Return when the reach meets the rim, s; infinite where it does not within the horizon."""
        steps = 4000
        last = next((i for i in range(steps + 1) if self.reach(horizon * i / steps) >= rim), None)
        if last is None:
            return math.inf
        low, high = horizon * max(last - 1, 0) / steps, horizon * last / steps
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.reach(middle) >= rim else (middle, high)
        return high


@dataclass(frozen=True)
class Demonstration:
    """A ball on a level table that turns steadily, without loads, and its start: a circle for ever.

    Examples
    --------
    >>> import trundle as tr
    >>> scenario = tr.Scenario.load("level-turntable-nudged")
    >>> show = Demonstration.of(scenario.system(), scenario.start_state())
    >>> print(f"{show.fate().radius(0.0):.4f} m about {show.fate().centre(0.0).real:.4f} m")
    0.1004 m about 0.0996 m
    """

    system: RollingSystem  # the table, perfect
    # `position`, `velocity`: of the ball's centre at the start, x + iy, m and m/s
    position: complex
    velocity: complex
    spin: float  # Ω·n, rad/s

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> Demonstration:
        """Take the shortcomings out of a system."""
        _check(system)
        support, motion = system.support, system.support.motion
        n = motion.at(start.time).rotation @ support.surface.normal(Vector(0.0, 0.0, 0.0))
        level = replace(support, tilt=0.0, motion=Spin(motion.mean_rate))
        over = Vector(*start.position) - n * system.body.radius  # the place that it was put down on
        return cls(
            replace(system, support=level, loads=()),
            complex(over.x, over.y),
            complex(*start.velocity[:2]),
            float(Vector(*start.angular_velocity).dot(n)),
        )

    @property
    def rate(self) -> float:
        """ω, rad/s."""
        return float(self.system.support.motion.mean_rate)

    @property
    def kappa(self) -> float:
        """κ = ω k/(1 + k), the rate of the circle, rad/s (T5)."""
        k = float(self.system.body.inertia_ratio)
        return self.rate * k / (1 + k)

    @property
    def round_time(self) -> float:
        """Time of one circle, s."""
        return 2 * math.pi / abs(self.kappa)

    @property
    def rim(self) -> float:
        """Distance of the rim from the axis, m."""
        return float(self.system.support.surface.rim)  # type: ignore[arg-type]

    def speed_in_air(self, air_rate: float) -> float:
        """Return the speed through air that turns at a rate, root mean square over the circle, m/s."""
        fate = self.fate()
        return math.hypot((self.kappa - air_rate) * fate.radius(0.0), air_rate * abs(fate.centre(0.0)))

    def on(self, motion: Motion | None = None, tilt: float = 0.0, load: Load | None = None) -> RollingSystem:
        """Return the system with one thing changed."""
        support = replace(self.system.support, tilt=tilt, motion=motion or self.system.support.motion)
        return replace(self.system, support=support, loads=() if load is None else (load,))

    def start(self, system: RollingSystem) -> State:
        """Put the ball down as at the start on a system that differs by a shortcoming."""
        (x, y), (u, v) = ((z.real, z.imag) for z in (self.position, self.velocity))
        return system.place((x, y), (u, v), spin=self.spin)

    # What theory says

    def _circle(self, drift: complex, at: complex, velocity: complex, sway: float, saying: str) -> Fate:
        """Return a steady circle through a place at a velocity, its centre drifting (T5e)."""
        arm = (velocity - drift) / (1j * self.kappa)
        return Fate(lambda t: at - arm + drift * t, lambda t: abs(arm), sway, saying)  # noqa: ARG005

    def fate(self) -> Fate:
        """Return the circle on the perfect table."""
        return self._circle(0j, self.position, self.velocity, 0.0, "circles for ever")

    def tilted(self, angle: float) -> Fate:
        """Return the circle on a table that leans: its centre drifts at g sin α/(ω k), level (T5e)."""
        k, g = float(self.system.body.inertia_ratio), float(self.system.gravity)
        drift = 1j * g * math.sin(angle) / (self.rate * k)
        return self._circle(
            drift, self.position, self.velocity, 0.0, f"drifts sideways at {with_unit(abs(drift), 'speed')}"
        )

    def in_air(self, coefficient: float, air_rate: float) -> Fate:
        """Return the circle in air that is still or turns: ζ̈ = (iκ − γ) ζ̇ + iγω_a ζ.

        Of the two roots of λ² = (iκ − γ)λ + iγω_a, the one near iκ is the circle and the one near 0 its centre.
        """
        body = self.system.body
        gamma = coefficient / (float(body.mass) * (1 + float(body.inertia_ratio)))
        half, product = (1j * self.kappa - gamma) / 2, 1j * gamma * air_rate
        root = cmath.sqrt(half * half + product)
        circle = max(half + root, half - root, key=abs)
        centre = -product / circle  # from the product of the roots: their difference would lose its digits
        arm = (self.velocity - centre * self.position) / (circle - centre)
        rest = self.position - arm
        if circle.real > 0:
            saying = f"circle grows e-fold in {with_unit(1 / circle.real, 'time')}"
        elif air_rate == 0 and gamma > 0:
            saying = f"circle halves in {with_unit(math.log(2) / gamma, 'time')}"
        else:
            saying = "circle does not grow"
        return Fate(
            lambda t: rest * cmath.exp(centre * t),
            lambda t: abs(arm) * math.exp(min(circle.real * t, 600.0)),  # far beyond any rim
            0.0,
            saying,
        )

    def resisted(self, offset: float) -> Fate:
        """Return the circle against resistance to rolling, averaged over a round; it sways by what that leaves out."""
        body, (c, arm) = self.system.body, (self.fate().centre(0.0), self.fate().radius(0.0))
        pull = offset * float(self.system.gravity) / (float(body.radius) * (1 + float(body.inertia_ratio)))
        pace = pull / abs(self.kappa)
        circle = ResistedCircle(self.rate, self.kappa, pace, abs(c), arm)
        way = c / abs(c) if c else 1.0
        return Fate(
            lambda t: way * circle.at(t)[0],
            lambda t: circle.at(t)[1],
            4 * pull / self.kappa**2,
            f"centre comes in, circle grows, by {with_unit(pace, 'speed')} at most",
        )

    def wobbling(self, angle: float) -> Fate:
        """Return the circle on a table askew by ε, to first order: a sway of ε[g + kaω(ω − Ω_n)]/ω², no drift."""
        body, omega = self.system.body, self.rate
        lift = float(body.inertia_ratio) * float(body.radius) * omega * (omega - self.spin)
        sway = 1j * angle * (float(self.system.gravity) + lift) / omega**2
        lean = -1j * angle * float(body.radius)  # the ball stands on the table, its centre beside the place below it
        at, velocity = self.position + lean - sway, self.velocity - 1j * omega * sway
        return self._circle(0j, at, velocity, abs(sway), f"sways by {with_unit(abs(sway), 'length', 2)}")

    def uneven(self, variation: float, variation_rate: float) -> Fate:
        """Return the circle on a table of rate ω(1 + ε sin νt): ζ̇ − iκ(t)ζ is constant, and so the rest a quadrature.

        With δ = εκ/ν the parts of e^{−iΘ}, Θ = κt + δ(1 − cos νt), are Bessel's J_n(δ) at the rates nν − κ. They sway
        and no more, unless one of the rates is 0: then the circle grows without end.
        """
        from scipy.special import jv

        kappa, delta = self.kappa, variation * self.kappa / variation_rate
        constant = self.velocity - 1j * kappa * self.position
        most = 8 + math.ceil(1.5 * min(abs(delta), 1e3))
        rates = {n: n * variation_rate - kappa for n in range(-most, most + 1)}
        parts = {n: 1j**n * complex(jv(n, delta)) * cmath.exp(-1j * delta) for n in rates}
        slow = [n for n in rates if abs(rates[n]) < 0.02 * abs(kappa)]
        quick = [n for n in rates if n not in slow]
        arm = self.position - constant * sum((parts[n] / (1j * rates[n]) for n in quick), 0j)
        centre = constant * sum((abs(parts[n]) ** 2 / (1j * rates[n]) for n in quick), 0j)
        shares = [abs(parts[n] / rates[n]) * (1 + abs(parts[n])) for n in quick if n]
        around = abs(constant) * (sum(shares) + min(abs(delta) + delta**2, 2.0) / abs(kappa))

        def growing(t: float) -> float:
            beat = sum((parts[n] * _integral(1j * rates[n], t) for n in slow), 0j)
            return abs(complex(arm + constant * beat))

        saying = (
            "in step with the circle, which grows"
            if slow and constant != 0
            else f"sways by {with_unit(around, 'length', 2)} at most"
        )
        return Fate(lambda t: centre, growing, around, saying)  # noqa: ARG005


def _integral(rate: complex, time: float) -> complex:
    """Return ∫₀ᵗ e^{rate·s} ds."""
    turned = rate * time
    return time * (1 + turned / 2) if abs(turned) < 1e-8 else (cmath.exp(turned) - 1) / rate


def _check(system: RollingSystem) -> None:
    support = system.support
    if not (system.body.is_isotropic_sphere and system.body.shape.axis is None and support.surface.flat):
        shown = f"{system.body.shape.noun_of(system.body)} on {support.surface.word}"
        raise InvalidValueError("scenario", "must be a ball on a plane", shown)
    if support.motion.coordinates:
        remedy = "Give it a `spin`, an `uneven-spin` or a `wobble`."
        raise InvalidValueError(
            "support.motion", "must turn the table steadily on the whole", support.motion.word, remedy
        )
    if not support.motion.mean_rate:
        raise InvalidValueError("support.motion", "must turn the table", support.motion.word)
    if support.surface.rim is None:
        raise InvalidValueError("support.rim", "must be given", None, 'Write for instance rim = "0.5 m".')
    others = [load for load in system.loads if not isinstance(load, (Drag, RollingResistance))]
    if others:
        rule = "must hold drag and rolling resistance only"
        raise InvalidValueError("loads", rule, words_of(others), "Leave the others out.")
