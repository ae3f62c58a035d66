"""T7: a ball that rolls round inside or outside an upright cylinder, and bobs: the golfer's dilemma."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...mechanics.algebra import Vector
from ...mechanics.scalars import Scalar, is_number, is_zero, namespace
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .domain import FORCES, that
from .finding import Finding
from .fits import Seen, even_rate, slope
from .formula import Lines, number, quantity
from .phi import exponentials, phase, two_product
from .round_cylinder import ON_CYLINDER, frequency_ratio, numbers_of, pull, vectors_of

_BOBS = "bobs {} times a round"


@dataclass(frozen=True)
class BallInUprightCylinder(ClosedForm):
    """The angle grows evenly, θ = θ₀ + θ̇t; the height swings at ν = θ̇ √(k/(1 + k)), whatever the radii (T7).

    A ball that goes round in a fixed or steadily turning cylinder never falls out of it: it comes up again. Every
    number may be a float, or an array of members that broadcasts against the times.

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²), of the ball.
    track_radius : float or array
        b of the cylinder, m.
    side : float or array
        +1 outside, −1 inside: ℓ = b + side·a.
    rate : float or array
        ω of the cylinder about its axis, rad/s.
    angle, angular_rate : float or array
        θ and θ̇ of the centre at t = 0, rad and rad/s, from the first axis towards the second.
    height, climb : float or array
        z and ż of the centre at t = 0, along the axis, m and m/s.
    spin : float or array
        Ω·n at t = 0, rad/s.
    force : triple of float or array
        Constant force, weight included, N; only its third component may be other than zero.

    Examples
    --------
    A solid ball goes round √(7/2) = 1.87 times while it goes down and comes up once:

    >>> ball = BallInUprightCylinder(0.02, 0.05, 0.4, 0.06, -1.0, 0.0, 0.0, 20.0, force=(0.0, 0.0, -0.49))
    >>> round(ball.bobbing_period / (2 * math.pi / 20.0), 12) == round(math.sqrt(7 / 2), 12)
    True
    >>> ball.motion_at(ball.bobbing_period)[0].z < 1e-15
    True
    """

    radius: Scalar
    mass: Scalar
    inertia_ratio: Scalar
    track_radius: Scalar
    side: Scalar
    rate: Scalar
    angle: Scalar
    angular_rate: Scalar
    height: Scalar = 0.0
    climb: Scalar = 0.0
    spin: Scalar = 0.0
    force: tuple[Scalar, Scalar, Scalar] = (0.0, 0.0, 0.0)

    name = "ball round an upright cylinder"
    equation = "T7"
    source = "Gualtieri et al., Golfer's dilemma, Am. J. Phys. 74, 497 (2006); theory page, T7"
    conditions = (
        *ON_CYLINDER,
        that(
            lambda system: pull(system)[:2] == (0, 0),
            ", with every force along that axis",
            "gravity or a force pulls across the cylinder's axis",
            FORCES,
        ),
    )

    impossible_events = frozenset({"lift", "curved"})  # N is constant

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> BallInUprightCylinder:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> hole = tr.RollingSystem(tr.Body.solid_sphere("21 mm", "46 g"), tr.Support(tr.Cylinder("54 mm")))
        >>> round(BallInUprightCylinder.of(hole, hole.place(velocity=("1 m/s", 0.0))).bobbing_rate, 4)
        16.1977
        """
        cls.check_domain(system, start)
        return cls(**numbers_of(system, start))

    # The constants of the motion

    @property
    def length(self) -> Scalar:
        """ℓ = b + side·a, of the centre from the axis, m."""
        return self.track_radius + self.side * self.radius

    @property
    def frequency_ratio(self) -> Scalar:
        """√(k/(1 + k)), of bobbing to going round: √(2/7) for a solid ball."""
        return frequency_ratio(self.inertia_ratio)[0]

    @property
    def bobbing_rate(self) -> Scalar:
        """ν = θ̇ √(k/(1 + k)), rad/s."""
        return self._bobbing_pair[0]

    @property
    def bobbing_period(self) -> float:
        """2π/|ν|, s; infinite where the ball does not go round, and falls."""
        return math.inf if is_zero(self.angular_rate) else 2 * math.pi / abs(self.bobbing_rate)

    @property
    def amplitude(self) -> Scalar:
        """Of the bobbing, m."""
        xp = namespace(self.climb, self.bobbing_rate)
        return xp.sqrt((self.climb / self.bobbing_rate) ** 2 + self._below**2)

    @property
    def _below(self) -> Scalar:
        return self._push / (self.bobbing_rate * self.bobbing_rate)

    @property
    def _push(self) -> Scalar:
        """z̈ at t = 0, m/s²."""
        share = self.inertia_ratio / (1 + self.inertia_ratio)
        return self._fall + share * self.angular_rate * self.side_twist

    @property
    def _fall(self) -> Scalar:
        return self.force[2] / (self.mass * (1 + self.inertia_ratio))

    @property
    def side_twist(self) -> Scalar:
        """σ = a Ω·n at t = 0, m/s."""
        return self.radius * self.spin

    @property
    def _bobbing_pair(self) -> tuple[Scalar, Scalar]:
        ratio, rest = frequency_ratio(self.inertia_ratio)
        if not (is_number(self.angular_rate) or hasattr(self.angular_rate, "__array_namespace__")):
            return self.angular_rate * ratio, 0.0
        rate, error = two_product(self.angular_rate, ratio)
        return rate, error + self.angular_rate * rest

    @property
    def period(self) -> float:
        """Time of one round where the height stays; infinite elsewhere: the two rates have no common measure, s."""
        numbers = (self.angular_rate, self.climb, self._push)
        if not all(is_number(part) for part in numbers) or is_zero(self.angular_rate):
            return math.inf
        level = self.climb == 0 and abs(self._push) <= 4 * 2.0**-52 * abs(self._fall)
        return 2 * math.pi / abs(self.angular_rate) if level else math.inf

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return θ̇, than which the bobbing is slower, 1/s."""
        return abs(float(self.angular_rate))

    def repeats(self, stop: str) -> float:
        """Return the period of the bobbing for the friction."""
        return float(self.bobbing_period) if stop == "slip" else self.period

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        Not going round, it falls along the wall with (5/7) g:

        >>> ball = BallInUprightCylinder(0.02, 1.0, 0.4, 0.06, -1.0, 0.0, 0.0, 0.0, force=(0.0, 0.0, -9.8))
        >>> round(ball.motion_at(1.0)[0].z, 12)
        -3.5
        """
        out = self._out(t)
        y, turned = (0.0, 0.0) if is_zero(self.angular_rate) else phase(self._bobbing_pair, t)
        e, phi1, phi2 = exponentials(0.0, y, turned)
        cosine, t_sine, tt_versine = e.re, t * phi1.re, t * t * phi2.re  # cos νt, sin νt/ν, (1 − cos νt)/ν²
        share, rate, fall, twist0 = (
            self.inertia_ratio / (1 + self.inertia_ratio), self.angular_rate, self._fall, self.side_twist,
        )  # fmt: skip
        push = self._push
        z = self.height + self.climb * t_sine + push * tt_versine
        climb = self.climb * cosine + push * t_sine
        twist = twist0 * cosine - rate * (self.climb * t_sine + fall * tt_versine)
        return vectors_of(self, out, (rate, 0.0), (z, climb, fall + share * rate * twist), twist)

    def position_at(self, t: Any) -> Vector:
        """Return the centre in the inertial support frame, m, at a time since the start, s."""
        return self.motion_at(t)[0]

    def _out(self, t: Any) -> Vector:
        turned = 0.0 * t if is_zero(self.angular_rate) else phase((self.angular_rate, 0.0), t)[1]
        xp, of_start = namespace(turned), namespace(self.angle, turned)
        c, s, c0, s0 = xp.cos(turned), xp.sin(turned), of_start.cos(self.angle), of_start.sin(self.angle)
        return Vector(c * c0 - s * s0, s * c0 + c * s0, 0.0)

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return the rate of bobbing."""
        root = rf"\sqrt{{{number(self.inertia_ratio / (1 + self.inertia_ratio))}}}"
        shown = rf"\nu = {root}\cdot {quantity(self.angular_rate, 'rad/s')} = {quantity(self.bobbing_rate, 'rad/s')}"
        return [(r"\nu = \sqrt{\frac{k}{1+k}}\;\dot\theta", shown)]

    def promised(self, said: str) -> Scalar | None:
        """Return how often it bobs a round."""
        return self.frequency_ratio if said == _BOBS else None

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare going round and bobbing."""
        x, y, z = seen.at.position.T
        round_ = float(slope(seen.time, np.unwrap(np.arctan2(y, x))))
        yield Finding("Rate of going round", r"\dot\theta", float(self.angular_rate), round_, "rad/s")
        if not self.angular_rate:
            return
        amplitude = float(self.amplitude)
        found = even_rate(seen.time, z) if amplitude > 1e-9 * abs(self.length) else None
        yield Finding("Rate of bobbing", r"\nu", abs(float(self.bobbing_rate)), found, "rad/s")
        ratio = None if found is None else found / abs(round_)
        note = "of bobbing to going round, whatever the radii"
        predicted = float(self.frequency_ratio)
        yield Finding("Ratio of the two", r"\sqrt{k/(1+k)}", predicted, ratio, "", note=note, said=_BOBS)
        if found is not None and found * seen.time[-1] >= 2 * math.pi:
            wave = found * seen.time
            design = np.column_stack([np.ones_like(wave), np.cos(wave), np.sin(wave)])
            _, c, s = np.linalg.lstsq(design, z, rcond=None)[0]
            yield Finding("Height that it bobs through", r"2z_1", 2 * amplitude, float(2 * math.hypot(c, s)), "m")
