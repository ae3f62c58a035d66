"""Mistakes of units, axes and conventions: the motion may be right, and its numbers mean something else."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.shapes import concentric_sphere
from ..mechanics.surfaces import Plane
from .diagnosing import Case, Trial
from .examining import GAP, TURN, Series
from .motion import turning_of
from .reading import from_frame
from .record import Array, orientation_from
from .slopes import SIGMAS

_MOST_RADIANS = 1e4  # of turning that are added up to an orientation


def units(case: Case) -> Iterator[Trial]:
    """Try other units of time, length and angle."""
    theirs, tell = case.theirs, {series.name for series in case.failing}
    for factor, unit in ((1e-3, "ms"), (1e-6, "µs"), (60.0, "minutes")):
        yield Trial("time-unit", f"The time column is in {unit}, not in s.", replace(theirs, time=theirs.time * factor))
    for factor, unit in ((1e-3, "mm"), (1e-2, "cm")):
        position = theirs.position * factor
        if not theirs.height_given:
            position = np.column_stack([position[:, :2], theirs.position[:, 2]])
        for velocity in [theirs.velocity] if theirs.velocity is None else [theirs.velocity, theirs.velocity * factor]:
            changed = replace(theirs, position=position, velocity=velocity)
            yield Trial("length-unit", f"Positions are in {unit}, not in m.", changed)
    if theirs.angular_velocity is None or tell == {GAP}:
        return
    for factor, unit in ((math.pi / 180, "deg/s"), (math.pi / 30, "rpm"), (2 * math.pi, "turns per second")):
        changed = replace(theirs, angular_velocity=theirs.angular_velocity * factor)
        name = "degrees-for-radians" if unit == "deg/s" else "rate-unit"
        yield Trial(name, f"Ω is in {unit}, not in rad/s.", changed)
    changed = replace(theirs, angular_velocity=-theirs.angular_velocity)
    yield Trial("sign-of-angular-velocity", "Ω has the wrong sign: a ball rolling along +x turns about +y.", changed)


def places(case: Case) -> Iterator[Trial]:
    """Try another point of the body, and another frame."""
    theirs = case.theirs
    offset = np.broadcast_to(case.motion.contact.offset.array(), case.motion.position.shape)
    if theirs.height_given and concentric_sphere(case.system.body.shape) and np.ptp(offset, axis=0).max() == 0.0:
        a = float(case.system.body.radius)
        yield Trial(
            "contact-for-centre",
            f"The position is that of the contact, not of the centre: it is off by the radius, {a:g} m.",
            replace(theirs, position=theirs.position - offset[0]),
        )
    rate = case.system.support.motion.steady_rate
    if rate:
        yield Trial(
            "corotating-frame",
            "The motion is given in the frame that turns with the table, not in the inertial one.",
            from_frame(theirs, case.system, "corotating"),
        )
        if theirs.velocity is not None or theirs.angular_velocity is not None:
            turned = from_frame(replace(theirs, velocity=None, angular_velocity=None), case.system, "corotating")
            kept = replace(theirs, position=turned.position, orientation=theirs.orientation)
            yield Trial(
                "corotating-frame",
                "Positions are given in the frame that turns with the table, velocities in the inertial one.",
                kept,
            )
    if case.system.support.tilt and theirs.height_given:
        yield Trial(
            "world-frame",
            "The motion is given in world axes, the third one vertical, not in those of the tilted support.",
            from_frame(theirs, case.system, "world"),
        )


def body_axes(case: Case) -> Iterator[Trial]:
    """Try Ω along the axes of the body: in the column, or where the orientation was integrated."""
    theirs = case.theirs
    if theirs.angular_velocity is None or theirs.doubt is not None:
        return
    name = "body-axes-for-space-axes"
    if theirs.orientation is not None:
        Q = Quaternion.of(theirs.orientation).matrix()
        spun = (Q @ Vector.of(theirs.angular_velocity)).array()
        text = "Ω has its components along the axes of the body; it was taken for the one along space axes."
        yield Trial(name, text, replace(theirs, angular_velocity=spun))
        turned, error, _ = turning_of(theirs, case.motion.index)
        Q = Quaternion.of(theirs.orientation[case.motion.index]).matrix()
        own = (Q.transpose @ Vector.of(turned)).array() - case.motion.angular_velocity
        size = float(np.linalg.norm(turned, axis=1).max())
        asked = case.tolerance * size
        bound = asked + error + case.motion.angular_velocity_error
        match = Series(TURN, case.motion.time, own, size, bound, asked, "Qᵀ 2 q̇ q* against Ω")
        text = (
            "The orientation was integrated as q̇ = ½ q Ω, which is for body axes, from an Ω along space axes: "
            "that is q̇ = ½ Ω q."
        )
        yield Trial(name, text, replace(theirs, orientation=None), extra=(match,))
        return
    span = float(theirs.time[-1] - theirs.time[0])
    if span * float(np.linalg.norm(theirs.angular_velocity, axis=1).max()) > _MOST_RADIANS:
        return
    q0 = case.start.orientation if case.start is not None else (1.0, 0.0, 0.0, 0.0)
    q, doubt = orientation_from(theirs.time, theirs.angular_velocity, q0, body_axes=True)
    spun = (Quaternion.of(q).matrix() @ Vector.of(theirs.angular_velocity)).array()
    doubt = doubt * np.linalg.norm(theirs.angular_velocity, axis=1)
    text = "Ω has its components along the axes of the body, which starts along those of the support frame."
    yield Trial(name, text, replace(theirs, angular_velocity=spun, doubt=doubt))


def quaternions(case: Case) -> Iterator[Trial]:
    """Try another order of the quaternion's parts, and the inverse rotation."""
    q = case.theirs.orientation
    if q is None or case.theirs.doubt is not None:
        return
    xyzw = q[:, [3, 0, 1, 2]]
    yield Trial("quaternion-order", "Quaternions are in the order x, y, z, w.", replace(case.theirs, orientation=xyzw))
    inverse = [1.0, -1.0, -1.0, -1.0]
    for parts, more in ((q, ""), (xyzw, ", in the order x, y, z, w")):
        yield Trial(
            "inverse-orientation",
            f"The orientation is its inverse: it takes space components to those of the body{more}.",
            replace(case.theirs, orientation=parts * inverse),
        )


def holonomic(case: Case) -> Iterator[Trial]:
    """Try an orientation that was computed from the displacement, as if rolling could be integrated."""
    theirs, body = case.theirs, case.system.body
    if theirs.orientation is None or theirs.doubt is not None or not concentric_sphere(body.shape):
        return
    if not isinstance(case.system.support.surface, Plane) or not body.is_isotropic_sphere:
        return
    index, a = case.motion.index, float(body.radius)
    q = theirs.orientation[index]
    noise = theirs.slope("orientation", index).noise + case.motion.position_error / a
    for from_start in (True, False):
        moved = theirs.position[index] - (theirs.position[0] if from_start else 0.0)
        before = Quaternion.of(theirs.orientation[0]) if from_start else Quaternion(1.0, 0.0, 0.0, 0.0)
        size = max(float(np.linalg.norm(moved[:, :2], axis=1).max()) / a, 1.0)
        asked = 10 * case.tolerance * size
        for how, turn in _from_displacement(moved[:, 0] / a, moved[:, 1] / a):
            off = 2 * (turn * before * Quaternion.of(q).conjugate).array()[:, 1:]
            bound = asked + 2 * SIGMAS * noise
            match = Series(TURN, case.motion.time, off, size, bound, asked, "angle from that of the displacement")
            text = (
                f"The constraint was taken for a holonomic one: the orientation is {how}, "
                "a function of the place alone. It depends on the way there; integrate q̇ = ½ Ω q."
            )
            yield Trial("holonomic-constraint", text, replace(theirs, orientation=None), extra=(match,))


def _from_displacement(x: Array, y: Array) -> Iterator[tuple[str, Quaternion]]:
    """Return the orientations that a displacement over the radius could be mistaken to give."""
    zero, angle = np.zeros_like(x), np.hypot(x, y)
    sine = np.sinc(angle / (2 * np.pi)) / 2  # sin(θ/2)/θ
    about_y = Quaternion(np.cos(x / 2), zero, np.sin(x / 2), zero)
    about_x = Quaternion(np.cos(y / 2), -np.sin(y / 2), zero, zero)
    at_once = Quaternion(np.cos(angle / 2), -y * sine, x * sine, zero)
    yield "one turn by |d|/a about n×d, d the net displacement", at_once
    yield "a turn by x/a and then one by y/a", about_x * about_y
    yield "a turn by y/a and then one by x/a", about_y * about_x


READINGS = (units, places, body_axes, quaternions, holonomic)

__all__ = ["READINGS"]
