"""What a path shows by itself: rates, circles, swings and ends, from samples without a look at the formula."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.system import RollingSystem
from ..samples import Samples
from .circle import MeasuredCircle, measure
from .finding import Finding

Array = NDArray[np.float64]
Path = NDArray[np.complex128]

_FITTED = 240  # points, about
TOO_LITTLE = "the run shows too little of it to measure"
BEGINS_TO_SLIP = ("Angle from the top where it begins to slip", r"\theta_s", "begins to slip {} from the top")
COMES_OFF = ("Angle from the top where it comes off", r"\theta_l", "comes off {} from the top")
_PHASE = 0.5  # rad of the motion's own pace between two points of a fit


@dataclass(frozen=True)
class Seen:
    """A run in the support frame, and the stretch that its first phase lasts, at an even step.

    Parameters
    ----------
    system : RollingSystem
        What moves.
    samples : Samples
        Of all the run.
    at : Samples
        Of that stretch.
    time : (n,) array
        Since the start, s.
    """

    system: RollingSystem
    samples: Samples
    at: Samples
    time: Array

    @staticmethod
    def of(system: RollingSystem, samples: Samples) -> Seen:
        """Take what lies before the first event, less a last step that is shorter than the others."""
        ends = [event.time for event in samples.events if not event.final]
        count = int(np.searchsorted(samples.time, ends[0])) if ends else samples.time.size
        time = samples.time[:count] - samples.time[0]
        if count > 2 and time[-1] - time[-2] < 0.999 * (time[1] - time[0]):
            count -= 1
        return Seen(system, samples, samples.part(slice(0, count)), time[:count])

    @property
    def step(self) -> float:
        """Between two samples, s."""
        return float(self.time[1] - self.time[0]) if self.time.size > 1 else math.inf

    @property
    def way(self) -> float:
        """Length of the way that the centre takes, m."""
        return float(np.linalg.norm(np.diff(self.at.position, axis=0), axis=1).sum())

    @property
    def zeta(self) -> Path:
        """The centre over the plane of the first two axes as x + iy, m."""
        return self.at.position[:, 0] + 1j * self.at.position[:, 1]

    @property
    def forces(self) -> tuple[Array, Array]:
        """N and |f| of the contact force, of all the run, N."""
        force, normals = self.samples.contact_force, self.samples.normals(self.system)
        normal = np.sum(force * normals, axis=1)
        return normal, np.linalg.norm(force - normal[:, None] * normals, axis=1)

    def every(self, pace: float) -> slice:
        """Return which samples a fit takes: not too many, and none so far apart that the motion could hide."""
        stride = max(1, self.time.size // _FITTED)
        if pace > 0:
            stride = max(1, min(stride, int(_PHASE / (pace * self.step))))
        return slice(0, stride * _FITTED * 2, stride)


def circle(seen: Seen, pace: float) -> MeasuredCircle | None:
    """Fit a drifting circle to a path; None where it shows too little of one."""
    some = seen.every(pace)
    found = measure(seen.time[some], seen.zeta[some])
    if found is None or found.rate_error > 1e-5 * abs(found.rate):
        return None
    return found


def exponent(seen: Seen, pace: float) -> tuple[complex, complex] | None:
    """Return λ and φ of a path that obeys ζ̈ = λζ̇ + φ: its steps follow each other as d′ = e^{λh} d + c."""
    some = seen.every(pace)
    steps, h = np.diff(seen.zeta[some]), seen.step * (some.step or 1)
    if steps.size < 4:
        return None
    design = np.column_stack([steps[:-1], np.ones(steps.size - 1)])
    (factor, rest), _, rank, _ = np.linalg.lstsq(design, steps[1:], rcond=1e-12)
    if rank < 2 or factor == 0:
        return None
    rate = complex(np.log(factor) / h)
    return rate, complex(rest / h * rate / (factor - 1))


def two_exponents(seen: Seen, pace: float) -> list[complex]:
    """Return the two exponents of ζ = A e^{s₁t} + B e^{s₂t} + C, the faster first, 1/s; none where it shows fewer."""
    stride = max(1, min(seen.time.size // 24, int(_PHASE / (pace * seen.step)) if pace > 0 else 1))
    z, h = seen.zeta[::stride], seen.step * stride
    if z.size < 8:
        return []
    design = np.column_stack([z[1:-1], z[:-2], np.ones(z.size - 2)])
    (a, b, _), _, rank, _ = np.linalg.lstsq(design, z[2:], rcond=1e-13)
    if rank < 2:
        return []
    roots = np.roots([1.0, -a, -b])
    return sorted((complex(np.log(root) / h) for root in roots if root != 0), key=abs, reverse=True)


def even_rate(time: Array, values: Array) -> float | None:
    """Return ν of x = A + B cos νt + C sin νt: of three values at even steps, x₀ + x₂ = 2x₁ cos νh + c."""
    stride = max(1, values.size // _FITTED)
    x, h = values[::stride], float(time[1] - time[0]) * stride
    if x.size < 6:
        return None
    design = np.column_stack([x[1:-1], np.ones(x.size - 2)])
    twice, _ = np.linalg.lstsq(design, x[2:] + x[:-2], rcond=None)[0]
    return float(math.acos(0.5 * twice) / h) if abs(twice) < 2 else None


def acceleration(seen: Seen) -> complex:
    """Return the acceleration of a path that is a parabola in time, m/s²."""
    t = seen.time / seen.time[-1]
    square = np.polynomial.polynomial.polyfit(t, np.column_stack([seen.zeta.real, seen.zeta.imag]), 2)[2]
    return complex(*square) * 2 / float(seen.time[-1]) ** 2


def crossings(time: Array, values: Array) -> Array:
    """Return when values rise through 0, by a cubic through the four samples about each."""
    rising = np.flatnonzero((values[:-1] < 0) & (values[1:] >= 0))
    return np.array([_root(time[max(i - 1, 0) : i + 3], values[max(i - 1, 0) : i + 3], time[i]) for i in rising])


def _root(t: Array, x: Array, near: float) -> float:
    """Return where the polynomial through a few points is 0: that of t as a function of x."""
    middle = t[0]
    powers = np.vander(x, len(x))
    return float(middle + np.linalg.solve(powers, t - middle)[-1]) if np.ptp(x) > 0 else float(near)


def swing(time: Array, angle: Array) -> tuple[float | None, float]:
    """Return the time of one swing, s, if one is seen, and the largest departure from 0, rad."""
    found = crossings(time, angle)
    period = float((found[-1] - found[0]) / (len(found) - 1)) if len(found) > 1 else None
    i = int(np.argmax(np.abs(angle)))
    if not 0 < i < len(angle) - 1:
        return period, float(abs(angle[i]))
    a, b, c = np.abs(angle[i - 1 : i + 2])
    bend = a - 2 * b + c
    return period, float(b - (c - a) ** 2 / (8 * bend)) if bend < 0 else float(b)


def round_time(time: Array, angle: Array) -> float | None:
    """Return the time of one round of an angle that grows or falls, s; None where it shows less than one."""
    turned = np.abs(angle - angle[0]) / (2 * math.pi)
    rounds = math.floor(float(turned[-1]))
    if rounds < 1:
        return None
    i = int(np.searchsorted(turned, rounds))
    part = slice(max(i - 2, 0), i + 2)
    return _root(time[part], turned[part] - rounds, time[i]) / rounds


def zero_ahead(time: Array, values: Array) -> float | None:
    """Return when values that fall to 0 behind the last sample reach it, drawn on through the last few."""
    if values.size < 3 or not values[-1] < values[-2] < values[-3]:
        return None
    if values.size < 4:
        return float(time[-1] + values[-1] * (time[-1] - time[-2]) / (values[-2] - values[-1]))
    return _root(time[-4:], values[-4:], time[-1])


def slope(time: Array, values: Any) -> Any:
    """Return the rate of change along a stretch by its two ends."""
    return (values[-1] - values[0]) / (time[-1] - time[0])


def conic(seen: Seen) -> tuple[complex, float | None]:
    """Fit a conic to a path; return its centre, and its eccentricity unless the path is too short or straight."""
    middle, size = np.mean(seen.zeta), float(np.max(np.abs(seen.zeta - np.mean(seen.zeta))))
    if not size > 0:
        return complex(middle), None
    z = (seen.zeta[seen.every(0.0)] - middle) / size
    x, y = z.real, z.imag
    design = np.column_stack([x * x, x * y, y * y, x, y, np.ones_like(x)])
    _, sizes, rows = np.linalg.svd(design, full_matrices=False)
    if len(sizes) < 6 or sizes[-2] < 1e-7 * sizes[0]:
        return complex(middle), None
    a, b, c, d, e, f = rows[-1]
    centre = np.linalg.solve([[2 * a, b], [b, 2 * c]], [-d, -e])
    level = -(f + 0.5 * float(np.dot([d, e], centre)))  # of λ₁u² + λ₂v², counted from the centre
    one, other = np.linalg.eigvalsh([[a, 0.5 * b], [0.5 * b, c]]) / level
    # The main axis of an ellipse is its longer one, that of a hyperbola the one that it crosses.
    along, across = (min(one, other), max(one, other)) if one * other > 0 else (max(one, other), min(one, other))
    return complex(middle + size * complex(*centre)), math.sqrt(max(0.0, 1.0 - float(along / across)))


def angle_where(what: tuple[str, str, str], predicted: float, time: Array, angle: Array, falling: Array) -> Finding:
    """Compare the angle where a force that falls reaches 0, rad, both drawn on behind the last samples before."""
    end, measured = zero_ahead(time, falling), None
    if end is not None:
        course = np.polynomial.polynomial.polyfit(time[-3:] - time[-1], angle[-3:], 2)
        measured = math.degrees(float(np.polynomial.polynomial.polyval(end - time[-1], course)))
    (name, symbol, said), note = what, "drawn on behind the last samples before"
    return Finding(name, symbol, math.degrees(predicted), measured, "°", note=note, said=said)


def needed_friction(predicted: float | None, at: Samples, friction: Any = None, normals: Any = None) -> Finding:
    """Compare the largest |f|/N of the samples with a prediction."""
    force = at.contact_force
    normal = force[:, 2] if normals is None else np.sum(force * normals, axis=1)
    along = np.sqrt(np.maximum(np.sum(force * force, axis=1) - normal * normal, 0.0))
    if normals is None:
        along = np.hypot(force[:, 0], force[:, 1])
    pressed = normal > 1e-9 * float(np.max(np.abs(normal), initial=0.0))
    share = float(np.max(along[pressed] / normal[pressed])) if pressed.any() else None
    note = "largest |f|/N while it rolls"
    if friction is not None:
        note += f"; there is {float(friction):g}"
    return Finding("Friction needed", r"\mu", predicted, share, "", note=note, scale=max(predicted or 0.0, 1e-3))
