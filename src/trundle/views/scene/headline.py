"""The phenomenon of a run as one number in one sentence: by theory beside the samples, or by two ways through these."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trundle.wording import Unit, unit_for

from ...mechanics.algebra import Vector
from ...mechanics.quantities import angle_between, is_ball
from ...mechanics.system import RollingSystem
from ...solve.exact.finding import Finding
from ...solve.samples import Event, Samples
from .columns import material
from .curves import slip_of, third_axis, upwards

Array = NDArray[np.float64]
Quantity = Callable[[RollingSystem, Samples], Array]

KINDS = {"m": "length", "m/s": "speed", "s": "time", "N": "force", "rad": "angle"}  # that have units of several sizes
_NOTHING = 1e-12  # SI: rounding
_CLEAR = 0.5  # cosine or share from which a direction is plain
_SEEN = 0.2  # of the first spin, from which it counts as spin the other way
_LEAST_ROUNDS = 2.0
_BOTH = "by its closed form; and from the samples"
_EVEN = 0.03  # by which the times of an oscillation differ, and it still has a period
_NODS = 0.3  # degrees through which an axis has to nod
_UNTOLD = 0.25  # turns between two samples by which two ways of counting part where these are too far apart to tell
_CUT_OFF = 0.01  # share of a path that its chords may cut off
_MOVES = 1e-3  # of the body's own size that a centre has to go


@dataclass(frozen=True)
class Headline:
    """One number that says what happens, and the same number from elsewhere.

    Examples
    --------
    >>> Headline("drifts {} along the slope's level", "m/s", 0.0368, 0.0368, True, "").as_dict()["text"]
    "drifts 3.68 cm/s along the slope's level"
    """

    text: str  # a sentence with `{}` for the number and its unit
    unit: str  # SI, or °; empty of a number without one
    measured: float  # from the samples
    other: float | None  # the same by theory, or by another way through the samples
    predicted: bool  # whether the other is by theory
    how: str  # how the two were found

    def as_dict(self) -> dict[str, Any]:
        """Return it as a scene's header holds it: in words, both numbers in the unit that suits them."""
        unit = Unit(1.0, self.unit)
        if self.unit in KINDS:
            unit = unit_for(abs(self.measured) if abs(self.measured) >= _NOTHING else 1.0, KINDS[self.unit])

        def said(value: float) -> str:
            value = 0.0 if abs(value) < _NOTHING else value
            return unit.after(f"{value / unit.scale:.4g}".replace("-", "−"))

        return {
            "said": self.text,
            "unit": self.unit,
            "text": self.text.format(said(self.measured)),
            "other": None if self.other is None else said(self.other),
            "predicted": self.predicted,
            "how": self.how,
        }


def headline_of(system: RollingSystem, samples: Samples, findings: Sequence[Finding]) -> dict[str, Any] | None:
    """Return what a run shows: what its closed form says first, or else what the samples show; None of no motion.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("tippe-top").run()
    >>> headline_of(run.system, run.samples, ())["text"].partition(" after ")[0]
    'turns upside down'
    """
    for found in findings:
        if found.said and found.measured is not None:
            told = Headline(found.said, found.unit, found.measured, found.predicted, True, found.note or _BOTH)
            return told.as_dict()
    if samples.time.size < 4:
        return None
    seen = next(_seen(system, samples), None)
    return None if seen is None else seen.as_dict()


def _seen(system: RollingSystem, samples: Samples) -> Iterator[Headline]:
    """Yield what the samples show, the most striking first."""
    if not is_ball(system):
        yield from _inversion(system, samples)
        yield from _reversal(system, samples)
    yield from _events(system, samples)
    rounds = next(_rounds(system, samples), None) if not is_ball(system) else None
    if rounds is not None and rounds.unit:
        yield rounds
    yield from _oscillation(system, samples)
    if rounds is not None:
        yield rounds
    yield from _way(samples)


# --- spin and axis ------------------------------------------------------------------------------------------


def _inversion(system: RollingSystem, at: Samples) -> Iterator[Headline]:
    """Tell when an axis that stood upright has turned over for good."""
    up, axis = upwards(system), third_axis(at)
    height = axis @ up
    if min(abs(height[0]), abs(height[-1])) < _CLEAR or height[0] * height[-1] > 0:
        return
    rate = np.cross(at.angular_velocity, axis) @ up
    how = "where its axis passes the horizontal: by its orientation; and by the integral of its angular velocity"
    first, other = (_crossings(at.time, way) for way in (height, height[0] + _integral(at.time, rate)))
    yield Headline("turns upside down after {}", "s", _since(at, first[-1]), _last(at, other), False, how)


def _reversal(system: RollingSystem, at: Samples) -> Iterator[Headline]:
    """Tell when a body that was spun about the vertical spins the other way."""
    up, time = upwards(system), at.time
    spin = at.angular_velocity @ up
    if abs(spin[0]) < _CLEAR * max(float(np.linalg.norm(at.angular_velocity[0])), 1e-300):
        return
    share = spin / spin[0]
    back = np.flatnonzero(share < -_SEEN)
    if not back.size:
        return
    end = int(back[0])
    begin = int(np.flatnonzero(share[:end] > _SEEN)[-1])
    by_orientation, by_turning = _headings(at, up, _most_level(at, up))
    how = "where the heading turns back: by the orientation; and by the integral of the angular velocity"
    part = slice(begin, end + 1)
    first, other = (_since(at, _peak(time[part], way[part] * spin[0])) for way in (by_orientation, by_turning))
    yield Headline("reverses its spin after {}", "s", first, other, False, how)


def _rounds(system: RollingSystem, at: Samples) -> Iterator[Headline]:
    """Tell how often, or how evenly, the axis of a leaning body goes round."""
    up, axis = upwards(system), third_axis(at)
    leans = _lean(axis, up)
    if not ((leans > _NODS) & (leans < 180.0 - _NODS)).all():
        return
    rounds = [(way - way[0]) / (2 * math.pi) for way in _headings(at, up, axis)]
    if np.max(np.abs(np.diff(rounds[0] - rounds[1]))) > _UNTOLD:
        return
    first, other = (abs(float(way[-1])) for way in rounds)
    if first < _LEAST_ROUNDS:
        return
    how, duration = "by the orientation; and by the integral of the angular velocity", _since(at, at.time[-1])
    uneven = np.ptp(rounds[0] - rounds[0][-1] * (at.time - at.time[0]) / duration)
    if uneven < _EVEN:
        yield Headline("goes round every {}", "s", duration / first, duration / other, False, how)
    else:
        yield Headline(f"its axis goes round {{}} times in {duration:.4g} s", "", first, other, False, how)


def _headings(at: Samples, up: Array, axis: Array) -> tuple[Array, Array]:
    """Return the angle of an axis of the body about the vertical, rad: by orientation, and by the angular velocity."""
    level = axis - np.outer(axis @ up, up)
    rate = np.cross(level, np.cross(at.angular_velocity, axis)) @ up / np.sum(level * level, axis=1)
    seen = np.unwrap(_azimuth(axis, up))
    return seen, seen[0] + _integral(at.time, rate)


def _most_level(at: Samples, up: Array) -> Array:
    """Return one of the body's axes (n, 3) that lies about level: heading is seen by it."""
    w, x, y, z = at.orientation.T
    first = np.column_stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])
    third = third_axis(at)
    return min((first, third), key=lambda axis: float(np.max(np.abs(axis @ up))))


def _lean(axis: Array, up: Array) -> Array:
    """Return the angle of a direction from the vertical, degrees."""
    return np.asarray(angle_between(Vector.of(axis), Vector(*up)), dtype=float)


def _azimuth(axis: Array, up: Array) -> Array:
    """Return the angle of a direction about the vertical, rad."""
    level = np.array([up[2], 0.0, -up[0]])
    return np.arctan2(axis @ np.cross(up, level), axis @ level)


# --- events -------------------------------------------------------------------------------------------------


def _normal_force(system: RollingSystem, at: Samples) -> Array:
    return np.sum(at.contact_force * at.normals(system), axis=1)


def _held_by_friction(system: RollingSystem, at: Samples) -> Array:
    """Return the friction that is left, μN − |f|, N."""
    normals = at.normals(system)
    along = np.sum(at.contact_force * normals, axis=1)
    across = np.linalg.norm(at.contact_force - along[:, None] * normals, axis=1)
    return float(system.support.friction or 0.0) * along - across


def _slip_speed(system: RollingSystem, at: Samples) -> Array:
    return np.linalg.norm(slip_of(system, at), axis=1)


def _speed(_: RollingSystem, at: Samples) -> Array:
    return np.linalg.norm(at.velocity, axis=1)


def _to_the_end(system: RollingSystem, at: Samples) -> Array:
    margin = system.support.surface.domain_margin(Vector.of(material(at, at.support(system), at.contact)))
    return np.broadcast_to(np.asarray(np.nan if margin is None else margin, dtype=float), at.time.shape)


def _to_the_rim(system: RollingSystem, at: Samples) -> Array:
    place = material(at, at.support(system), at.contact)
    return float(system.support.surface.rim or 0.0) - np.hypot(place[:, 0], place[:, 1])


def _to_the_edge(system: RollingSystem, at: Samples) -> Array:
    """Return how far the shape's own edge is."""
    turned = [Vector.of(part) for part in np.moveaxis(_body_axes(at), 1, 0)]
    normal = Vector.of(at.normals(system))
    margin = system.body.shape.validity_margin(-Vector(*(axis.dot(normal) for axis in turned)))
    return np.broadcast_to(np.asarray(np.nan if margin is None else margin, dtype=float), at.time.shape)


def _body_axes(at: Samples) -> Array:
    """Return the body's three axes (n, 3, 3) in the support frame, one a row."""
    w, x, y, z = at.orientation.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
        [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
        [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


# What is told of each kind of event, and what falls to nothing there.
_TOLD: dict[str, tuple[str, Quantity]] = {
    "lift": ("leaves the support after {}", _normal_force),
    "slip": ("begins to slip after {}", _held_by_friction),
    "grip": ("slips for {}, then rolls", _slip_speed),
    "stop": ("comes to rest after {}", _speed),
    "rim": ("runs off the rim after {}", _to_the_rim),
    "end": ("reaches the end of the surface after {}", _to_the_end),
    "edge": ("goes over its edge after {}", _to_the_edge),
    "spot": ("stops rolling after {}", _speed),
}


def _events(system: RollingSystem, at: Samples) -> Iterator[Headline]:
    """Tell of the first event of a kind that has words: not of a stop that lasts for no time."""
    for event, behind in zip_longest(at.events, at.events[1:]):
        passes = event.kind == "stop" and behind is not None and behind.time == event.time
        if event.kind in _TOLD and not passes:
            text, quantity = _TOLD[event.kind]
            how = "by the event; and by the samples before it, drawn on"
            since = event.time - float(at.time[0])
            jumps = any(other.kind == "stop" and other.time == event.time for other in at.events if other is not event)
            drawn = None if jumps else _drawn_on(system, at, event, quantity)
            yield Headline(text, "s", since, drawn, False, how)
            return


def _drawn_on(system: RollingSystem, at: Samples, event: Event, quantity: Quantity) -> float | None:
    """Return when a quantity falls to nothing, by a parabola through its last values before an event."""
    before = np.flatnonzero(at.time < event.time)
    before = before[at.phase[before] == at.phase[before[-1]]][-4:] if before.size else before
    if before.size < 4:
        return None
    some = at.part(before)
    values = quantity(system, some)
    if not np.isfinite(values).all():
        return None
    roots = np.roots(np.polyfit(some.time - event.time, values, 2))
    step = float(some.time[-1] - some.time[-2])
    near = [float(root.real) for root in roots if abs(root.imag) <= step and abs(root.real) <= 2 * step]
    return event.time - float(at.time[0]) + min(near, key=abs) if near else None


# --- what comes again ---------------------------------------------------------------------------------------


def _oscillation(system: RollingSystem, at: Samples) -> Iterator[Headline]:
    """Tell the period of what goes to and fro evenly."""
    up, size = upwards(system), float(np.linalg.norm(at.contact[0] - at.position[0]))
    least = _MOVES * size
    signals = [
        ("swings out and in every {}", np.hypot(at.position[:, 0], at.position[:, 1]), least),
        ("rises and falls every {}", at.position @ up, least),
    ]
    if not is_ball(system):
        signals.reverse()
        axis = third_axis(at)
        signals.insert(0, ("nods every {}", _lean(axis, up), _NODS))
    how = "by how often it passes its middle; and by its peaks"
    for text, values, needed in signals:
        if float(np.ptp(values)) < needed:
            continue
        crossings, tops = _rises(at.time, values), _peaks(at.time, values)
        if crossings.size > 2 and tops.size > 1 and _even(crossings) and _even(tops):
            yield Headline(text, "s", _mean_step(crossings), _mean_step(tops), False, how)
            return


def _rises(time: Array, values: Array) -> Array:
    """Return when a signal rises through its middle."""
    off = values - 0.5 * (np.max(values) + np.min(values))
    return _crossings(time, off, rising=True)


def _peaks(time: Array, values: Array) -> Array:
    """Return when a signal is highest in each swing: above its middle, by a parabola through three samples."""
    high = values > 0.5 * (np.max(values) + np.min(values))
    inner = np.flatnonzero(high[1:-1] & (values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])) + 1
    return np.array([_peak(time[i - 1 : i + 2], values[i - 1 : i + 2]) for i in inner])


def _mean_step(times: Array) -> float:
    return float(times[-1] - times[0]) / (times.size - 1)


def _even(times: Array) -> bool:
    steps = np.diff(times)
    return bool(np.ptp(steps) <= _EVEN * np.mean(steps))


def _way(at: Samples) -> Iterator[Headline]:
    """Tell how far it goes."""
    steps = np.linalg.norm(np.diff(at.position, axis=0), axis=1)
    speed, chords = np.linalg.norm(at.velocity, axis=1), float(steps.sum())
    bends = angle_between(Vector.of(at.velocity[:-1]), Vector.of(at.velocity[1:]))
    # A chord of an arc that turns by θ is shorter by the share θ²/24.
    if not chords or np.sum(steps * np.radians(bends) ** 2) / 24 > _CUT_OFF * chords:
        return
    duration = float(at.time[-1] - at.time[0])
    how = "along its path: from sample to sample; and by the integral of its speed"
    yield Headline("goes {} in " + f"{duration:.4g} s", "m", chords, float(_integral(at.time, speed)[-1]), False, how)


# --- of curves ----------------------------------------------------------------------------------------------


def _integral(time: Array, rate: Array) -> Array:
    """Return the integral of a rate from the first sample on."""
    steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(time)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _crossings(time: Array, values: Array, *, rising: bool = False) -> Array:
    """Return when values pass through zero; a sample may be zero itself."""
    steps = np.diff((values >= 0).astype(int))
    at = np.flatnonzero(steps > 0 if rising else steps)
    share = values[at] / (values[at] - values[at + 1])
    return np.asarray(time[at] + share * (time[at + 1] - time[at]), dtype=float)


def _peak(time: Array, values: Array) -> float:
    """Return when values are largest, by a parabola through the three samples about the top."""
    top = int(np.argmax(values))
    if not 0 < top < values.size - 1:
        return float(time[top])
    around = slice(top - 1, top + 2)
    t = time[around] - time[top]
    square, slope, _ = np.polyfit(t, values[around] - values[top], 2)
    return float(time[top]) if square >= 0 else float(time[top] - slope / (2 * square))


def _since(at: Samples, time: float) -> float:
    return float(time - at.time[0])


def _last(at: Samples, times: Array) -> float | None:
    return _since(at, times[-1]) if times.size else None
