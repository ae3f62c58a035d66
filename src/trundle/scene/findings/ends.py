"""Findings of motions that end: slip that friction ends, rolling that resistance ends."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...mechanics.system import RollingSystem
from ...solve.exact import SlidingSphere, SphereComingToRest, SphereInFlight
from ...solve.samples import ROLLING, SLIPPING, Samples
from ...wording import as_ratio
from .finding import Finding
from .fits import Seen, acceleration, zero_ahead


def gripping(form: SlidingSphere, system: RollingSystem, samples: Samples) -> Iterator[Finding]:
    """Compare when, where and how fast a sphere grips with T11; measured from where the slip of the samples ends."""
    predicted = float(form.grips_at)
    slips = samples.phase == SLIPPING
    count = int(np.argmin(slips)) if not slips.all() else slips.size
    if not math.isfinite(predicted):
        yield from _slipping_on(form, samples.part(slice(0, count)))
        return
    if count < 3:
        return
    part = samples.part(slice(0, count))
    V, carried, u = part.speeds(system)
    slip = np.broadcast_to((V + carried - u).norm(), part.time.shape)
    time = part.time - samples.time[0]
    gripped = zero_ahead(time, slip) if slips.size > count or slip[-1] < 0.5 * slip[0] else None
    yield Finding("Time at which it grips", "t_g", predicted, gripped, "s", "where the slip, drawn on, ends")
    if gripped is None or slips.size <= count:
        return
    r, velocity, _, _ = form.motion_at(predicted)
    way = math.hypot(float(r.x) - float(form.position[0]), float(r.y) - float(form.position[1]))
    course = np.polynomial.polynomial.polyfit(
        time, part.position[:, :2], min(6 if system.support.tilt else 2, count - 1)
    )
    there = np.polynomial.polynomial.polyval(gripped, course)
    gone = float(np.linalg.norm(there - part.position[0, :2]))
    yield Finding("Distance to there", "d_g", way, gone, "m", "from start to grip, straight", max(way, form.radius))
    after = samples.part(slice(count, None))
    rolls = int(np.argmin(after.phase == ROLLING)) if not (after.phase == ROLLING).all() else after.time.size
    pushed = float(system.support.tilt) != 0 or bool(system.loads)
    if rolls > 3 and not pushed:
        path = after.position[:rolls, :2]
        speed = float(np.linalg.norm(path[-1] - path[0]) / (after.time[rolls - 1] - after.time[0]))
        final = math.hypot(float(velocity.x), float(velocity.y))
        started = math.hypot(*map(float, form.velocity))
        plain = not any(form.angular_velocity[:2]) and started > 0
        note = f"{as_ratio(1 / (1 + float(form.inertia_ratio)))} of the start's" if plain else ""
        yield Finding("Speed after it grips", "v_g", final, speed, "m/s", note, max(final, started))


def _slipping_on(form: SlidingSphere, part: Samples) -> Iterator[Finding]:
    """Compare the acceleration of a sphere that slips for ever, where it slips straight: F/m − μN/m along the slip."""
    pull, slip = complex(*map(float, form.force[:2])), complex(*map(float, form.slip))
    aside = abs((pull * slip.conjugate()).imag)
    if part.time.size < 4 or not slip or aside > 1e-12 * abs(pull) * abs(slip):
        return
    predicted = (pull - float(form.friction) * -float(form.force[2]) * slip / abs(slip)) / float(form.mass)
    yield Finding("Acceleration while it slips", r"\dot v", abs(predicted), abs(acceleration(Seen.of(part))), "m/s²")


def stopping(form: SphereComingToRest, samples: Samples) -> Iterator[Finding]:
    """Compare when and where a sphere comes to rest with T14b."""
    rolls = samples.phase == ROLLING
    count = int(np.argmin(rolls)) if not rolls.all() else rolls.size
    part, predicted = samples.part(slice(0, count)), float(form.stops_at)
    time = part.time - samples.time[0]
    speed = np.hypot(part.velocity[:, 0], part.velocity[:, 1])
    if math.isfinite(predicted) and count < rolls.size:
        yield Finding(
            "Time at which it stops", "t_s", predicted, zero_ahead(time, speed), "s", "where its speed, drawn on, ends"
        )
        gone = float(np.linalg.norm(samples.position[-1, :2] - samples.position[0, :2]))
        yield Finding("Way to there", "d_s", float(form.way), gone, "m")
    elif count > 3:
        from_start = float(form.deceleration + form.gamma * form.speed + form.eta * form.speed**2)
        slowed = -float(np.gradient(speed[:3], time[:3], edge_order=2)[0])
        yield Finding(
            "Deceleration at the start", r"-\dot v_0", from_start, slowed, "m/s²", "by the first three samples"
        )


def landing(form: SphereInFlight, seen: Seen, samples: Samples) -> Iterator[Finding]:
    """Compare when and where a flight over a plane ends with T11a; measured by the parabola of the samples."""
    predicted = float(form.ends_at.get("land", math.inf))
    landed = seen.time.size < samples.time.size
    if not (math.isfinite(predicted) and landed) or tuple(form.across) != (0.0, 0.0, 1.0):
        return
    course = np.polynomial.polynomial.polyfit(seen.time, seen.at.position, 2)
    heights = course[:, 2] - np.array([float(form.radius), 0.0, 0.0])
    lands = float(np.max(np.polynomial.polynomial.polyroots(heights).real))
    yield Finding("Time at which it lands", "t_l", predicted, lands, "s", "by the parabola through its heights")
    ahead = form.motion_at(predicted)[0]
    way = math.hypot(float(ahead.x) - float(form.position[0]), float(ahead.y) - float(form.position[1]))
    if way:
        there = np.asarray(np.polynomial.polynomial.polyval(lands, course[:, :2]))
        gone = float(np.linalg.norm(there - samples.position[0, :2]))
        yield Finding("Distance to there", "d_l", way, gone, "m")
