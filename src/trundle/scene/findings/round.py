"""Findings of bodies that roll round: in and on cylinders, bowls and domes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from ...mechanics.system import RollingSystem
from ...solve.exact import BallInLeaningCylinder, BallInUprightCylinder, CylinderOnCylinder, OffADome, SphereOnSphere
from ...solve.samples import FLIGHT, ROLLING, Samples
from .finding import Finding
from .fits import Array, Seen, even_rate, round_time, slope, swing, zero_ahead


def across_cylinder(form: CylinderOnCylinder, system: RollingSystem, seen: Seen, samples: Samples) -> Iterator[Finding]:
    """Compare with the pendulum T6."""
    if not any(event.kind == "lift" for event in samples.events):
        yield from _pendulum(form, seen, _from_pull(form, seen.at.position))
    else:
        from_top = np.abs((_from_pull(form, samples.position)) % (2 * math.pi) - math.pi)
        yield from _let_go(form, from_top, system, samples)


def along_cylinder(form: BallInLeaningCylinder, seen: Seen) -> Iterator[Finding]:
    """Compare with the pendulum, and the way along the axis in one swing (T8)."""
    pendulum = form.pendulum
    angle = _from_pull(pendulum, seen.at.position)
    yield from _pendulum(pendulum, seen, angle)
    advance = float(form.advance)
    if math.isfinite(advance) and advance and seen.time[-1] >= pendulum.period:
        gone = float(np.interp(float(pendulum.period), seen.time, seen.at.position[:, 2]) - seen.at.position[0, 2])
        size = float(np.ptp(seen.at.position[:, 2]))
        yield Finding("Way along the axis in one swing", r"\Delta z", advance, gone, "m", "", size)


def on_sphere(form: SphereOnSphere, system: RollingSystem, seen: Seen, samples: Samples) -> Iterator[Finding]:
    """Compare with the pendulum T12, and with where a dome lets the ball go."""
    leaves = any(event.kind in ("slip", "lift") for event in samples.events)
    if not leaves:
        yield from _pendulum(form.pendulum, seen, _on_circle(form, seen.at.position))
    if form.side < 0 or not leaves:
        return
    from_top = np.abs(np.abs(_on_circle(form, samples.position)) - math.pi)
    friction = system.support.friction
    if friction is None:
        yield from _let_go(form.pendulum, from_top, system, samples)
    elif system.support.kinetic_friction in (None, friction):
        k, above = float(form.inertia_ratio), -math.cos(float(form.angle))
        speed = float(form.mass) * float(form.length) * float(form.angular_rate) ** 2 / float(form.pull)
        # As if it had started on the top, with the energy that it has.
        dome = OffADome(k, float(friction), speed - 2 * (1 - above) / (1 + k))
        yield from _giving_way(dome, from_top, system, samples)


def _giving_way(dome: OffADome, from_top: Array, system: RollingSystem, samples: Samples) -> Iterator[Finding]:
    """Compare where friction gives way, and where the normal force has gone, with T12b and T12c."""
    normal, along = _forces(system, samples)
    rolls = int(np.argmax(samples.phase != ROLLING))
    room = dome.friction * normal - along
    name, symbol = "Angle from the top where it begins to slip", r"\theta_s"
    yield _angle(name, symbol, dome.slips_at, samples.time[:rolls], from_top[:rolls], room[:rolls])
    flying = samples.phase == FLIGHT
    if flying.any():
        part = slice(rolls, int(np.argmax(flying)))
        name, symbol = "Angle from the top where it comes off", r"\theta_l"
        yield _angle(name, symbol, dome.lifts_at, samples.time[part], from_top[part], normal[part])


def _pendulum(form: CylinderOnCylinder, seen: Seen, angle: Array) -> Iterator[Finding]:
    if seen.time.size < 6 or not np.ptp(angle) > 0:
        return
    period = float(form.period)
    if form.goes_round:
        yield Finding("Time of one round", "T", _finite(period), round_time(seen.time, angle), "s")
        return
    measured, largest = swing(seen.time, angle)
    if math.isfinite(period):
        note = "" if measured else "the run shows less than one"
        yield Finding("Time of one swing", "T", period, measured, "s", note)
    pull = math.hypot(*map(float, form.force))
    if pull and seen.time[-1] >= 0.5 * period:
        heavy = float(form.mass) * float(form.length) * (1 + float(form.inertia_ratio))
        cosine = math.cos(float(form.angle)) - 0.5 * heavy * float(form.angular_rate) ** 2 / pull
        yield Finding("Amplitude", r"\theta_{\max}", math.degrees(math.acos(cosine)), math.degrees(largest), "°")


def _let_go(form: CylinderOnCylinder, from_top: Array, system: RollingSystem, samples: Samples) -> Iterator[Finding]:
    """Compare where the normal force has gone: from the top, cos θ = [2 cos θ₀ + (1 + k)v²/(gℓ)]/(3 + k)."""
    k, pull = float(form.inertia_ratio), math.hypot(*map(float, form.force))
    speed = float(form.mass) * float(form.length) * float(form.angular_rate) ** 2 / pull
    cosine = (-2 * math.cos(float(form.angle)) + (1 + k) * speed) / (3 + k)
    flying = samples.phase == FLIGHT
    if abs(cosine) <= 1 and flying.any():
        part = slice(0, int(np.argmax(flying)))
        normal, _ = _forces(system, samples)
        name, symbol = "Angle from the top where it comes off", r"\theta_l"
        yield _angle(name, symbol, math.acos(cosine), samples.time[part], from_top[part], normal[part])


def _forces(system: RollingSystem, samples: Samples) -> tuple[Array, Array]:
    """Return N and |f| of the contact force."""
    force, normals = samples.contact_force, samples.normals(system)
    normal = np.sum(force * normals, axis=1)
    return normal, np.linalg.norm(force - normal[:, None] * normals, axis=1)


def _angle(name: str, symbol: str, predicted: float, time: Array, angle: Array, falling: Array) -> Finding:
    """Take the angle where a force that falls reaches 0, both drawn on behind the last samples before."""
    end, measured = zero_ahead(time, falling), None
    if end is not None:
        course = np.polynomial.polynomial.polyfit(time[-3:] - time[-1], angle[-3:], 2)
        measured = math.degrees(float(np.polynomial.polynomial.polyval(end - time[-1], course)))
    return Finding(name, symbol, math.degrees(predicted), measured, "°", "drawn on behind the last samples before")


def upright(form: BallInUprightCylinder, seen: Seen) -> Iterator[Finding]:
    """Compare going round and bobbing with T7."""
    x, y, z = seen.at.position.T
    round_ = float(slope(seen.time, np.unwrap(np.arctan2(y, x))))
    yield Finding("Rate of going round", r"\dot\theta", float(form.angular_rate), round_, "rad/s")
    if not form.angular_rate:
        return
    amplitude = float(form.amplitude)
    found = even_rate(seen.time, z) if amplitude > 1e-9 * abs(form.length) else None
    predicted = abs(float(form.bobbing_rate))
    yield Finding("Rate of bobbing", r"\nu", predicted, found, "rad/s")
    ratio = None if found is None else found / abs(round_)
    note = "of bobbing to going round, whatever the radii"
    yield Finding("Ratio of the two", r"\sqrt{k/(1+k)}", float(form.frequency_ratio), ratio, "", note)
    if found is not None and found * seen.time[-1] >= 2 * math.pi:
        wave = found * seen.time
        design = np.column_stack([np.ones_like(wave), np.cos(wave), np.sin(wave)])
        _, c, s = np.linalg.lstsq(design, z, rcond=None)[0]
        yield Finding("Height that it bobs through", r"2z_1", 2 * amplitude, float(2 * math.hypot(c, s)), "m")


def _from_pull(form: CylinderOnCylinder, position: Array) -> Array:
    """Return the angle of the centre about the third axis from the direction of the pull, without jumps, rad."""
    fx, fy = (float(part) for part in form.force)
    angle = np.unwrap(np.arctan2(position[:, 1], position[:, 0]))
    angle = angle - math.atan2(fy, fx)
    return np.asarray(angle - 2 * math.pi * np.round(angle[0] / (2 * math.pi)))


def _on_circle(form: SphereOnSphere, position: Array) -> Array:
    """Return the angle of the centre along its great circle from the direction of the pull, rad."""
    arm = position - np.array([0.0, 0.0, -float(form.side) * float(form.track_radius)])
    first, second = (np.array([float(part) for part in axis]) for axis in (form.first, form.second))
    return np.asarray(np.unwrap(np.arctan2(arm @ second, arm @ first)))


def _finite(value: Any) -> float | None:
    return float(value) if math.isfinite(value) else None
