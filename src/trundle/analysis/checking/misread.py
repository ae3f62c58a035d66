"""Mistakes of units, axes and conventions: the motion may be right, and its numbers mean something else."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.shapes import concentric_sphere
from ...mechanics.system import RollingSystem, State
from .aligning import Aligned, aligned
from .case import Case
from .comparisons import TURN
from .examining import GAP
from .mistakes import Suspect
from .motion import turned_to_space, turning_of, with_orientation
from .reading import from_frame
from .record import Array, ExternalTrajectory
from .series import Series
from .slopes import SIGMAS

_MOST_RADIANS = 1e4  # of turning that are added up to an orientation
_TIME, _LENGTH, _OMEGA, _PLACE, _FRAME, _TURNED, _AXES = (
    frozenset({part}) for part in ("time", "length", "Ω", "place", "frame", "orientation", "axes")
)


def misreadings(case: Case) -> Iterator[Suspect]:
    """Yield what their numbers may mean instead, the commonest first."""
    for some in (_units, _body_axes, _places, _quaternions, _holonomic):
        yield from some(case)


def _times(theirs: ExternalTrajectory, factors: dict[str, float]) -> ExternalTrajectory:
    changed = {name: getattr(theirs, name) for name in factors}
    return replace(theirs, **{name: array * factors[name] for name, array in changed.items() if array is not None})


def _longer(theirs: ExternalTrajectory, factor: float, names: tuple[str, ...]) -> ExternalTrajectory:
    changed = _times(theirs, dict.fromkeys(names, factor))
    if theirs.height_given:
        return changed
    return replace(changed, position=np.column_stack([changed.position[:, :2], theirs.position[:, 2]]))


def _units(case: Case) -> Iterator[Suspect]:
    """Try other units of time, length and angle."""
    theirs = case.theirs
    for factor, unit in ((1e-3, "ms"), (1e-6, "µs"), (60.0, "minutes")):
        says = f"The time column is in {unit}, not in s."
        yield Suspect("time-unit", says, _TIME, theirs=partial(_times, factors={"time": factor}))
    for factor, unit in ((1e-3, "mm"), (1e-2, "cm")):
        for names in (("position",), ("position", "velocity"))[: 1 if theirs.velocity is None else 2]:
            says = f"Positions are in {unit}, not in m."
            yield Suspect("length-unit", says, _LENGTH, theirs=partial(_longer, factor=factor, names=names))
    if theirs.angular_velocity is None or {one.name for one in case.failing} == {GAP}:
        return
    for factor, unit in ((math.pi / 180, "deg/s"), (math.pi / 30, "rpm"), (2 * math.pi, "turns per second")):
        name = "degrees-for-radians" if unit == "deg/s" else "rate-unit"
        undo = partial(_times, factors={"angular_velocity": factor})
        yield Suspect(name, f"Ω is in {unit}, not in rad/s.", _OMEGA, theirs=undo)
    says = "Ω has the wrong sign: a ball rolling along +x turns about +y."
    yield Suspect("sign-of-angular-velocity", says, _OMEGA, theirs=partial(_times, factors={"angular_velocity": -1.0}))


def _places(case: Case) -> Iterator[Suspect]:
    """Try another point of the body, and another frame."""
    theirs, system, offset = case.theirs, case.system, case.motion.offset
    if theirs.height_given and concentric_sphere(system.body.shape) and np.ptp(offset, axis=0).max() == 0.0:
        a = float(system.body.radius)
        says = f"The position is that of the contact, not of the centre: it is off by the radius, {a:g} m."
        yield Suspect("contact-for-centre", says, _PLACE, theirs=partial(_moved, by=offset[0]))
    if system.support.motion.steady_rate:
        says = "The motion is given in the frame that turns with the table, not in the inertial one."
        turned = partial(from_frame, system=system, frame="corotating")
        yield Suspect("corotating-frame", says, _FRAME, theirs=turned)
        if theirs.velocity is not None or theirs.angular_velocity is not None:
            says = "Positions are given in the frame that turns with the table, velocities in the inertial one."
            yield Suspect("corotating-frame", says, _FRAME, theirs=partial(_only_places, turned=turned))
    if system.support.tilt and theirs.height_given:
        says = "The motion is given in world axes, the third one vertical, not in those of the tilted support."
        yield Suspect("world-frame", says, _FRAME, theirs=partial(from_frame, system=system, frame="world"))


def _moved(theirs: ExternalTrajectory, by: Array) -> ExternalTrajectory:
    return replace(theirs, position=theirs.position - by)


def _only_places(
    theirs: ExternalTrajectory, turned: Callable[[ExternalTrajectory], ExternalTrajectory]
) -> ExternalTrajectory:
    path = turned(replace(theirs, velocity=None, angular_velocity=None))
    return replace(theirs, position=path.position)


def _body_axes(case: Case) -> Iterator[Suspect]:
    """Try Ω along the axes of the body: in the column, or where the orientation was integrated."""
    theirs, start, name = case.theirs, case.start, "body-axes-for-space-axes"
    if theirs.angular_velocity is None or "angular_velocity" in theirs.doubts:
        return
    if theirs.orientation is not None and "orientation" not in theirs.doubts:
        says = "Ω has its components along the axes of the body; it was taken for the one along space axes."
        yield Suspect(name, says, _AXES, theirs=_spun, textbook=True)
        says = (
            "The orientation was integrated as q̇ = ½ q Ω, which is for body axes, from an Ω along space axes: "
            "that is q̇ = ½ Ω q."
        )
        undo = partial(_without_orientation, system=case.system, start=start)
        yield Suspect(name, says, _TURNED | _AXES, theirs=undo, further=partial(_own_axes, case))
        return
    span = float(theirs.time[-1] - theirs.time[0])
    if span * float(np.linalg.norm(theirs.angular_velocity, axis=1).max()) > _MOST_RADIANS:
        return
    at = aligned(case)
    undo = partial(_spun_by_itself, at=at, keep="orientation" in theirs.doubts)
    q0 = dict(zip(("qw", "qx", "qy", "qz"), map(float, at.start), strict=True))
    says = "Ω has its components along the axes of the body; "
    if at.given:
        says += "they start along those of the support frame." if start is None else "they start as the scenario says."
        yield Suspect(name, says, _AXES, theirs=undo, textbook=True)
    else:
        says += f"they start turned by q = ({', '.join(f'{part:.4g}' for part in q0.values())}), which was fitted."
        yield Suspect(name, says, _AXES, theirs=undo, numbers=q0, named=False, textbook=True)


def _spun(theirs: ExternalTrajectory) -> ExternalTrajectory:
    assert theirs.orientation is not None  # noqa: S101  who yields it has looked
    Q = Quaternion.of(theirs.orientation).matrix()
    return replace(theirs, angular_velocity=(Q @ Vector.of(theirs.angular_velocity)).array())


def _spun_by_itself(theirs: ExternalTrajectory, at: Aligned, keep: bool) -> ExternalTrajectory:
    spun = turned_to_space(theirs, tuple(at.start))
    if not at.given:
        spun = replace(spun, doubts={name: one.fitted(spun.time, at.unsure) for name, one in spun.doubts.items()})
    return spun if keep else replace(spun, orientation=None)


def _without_orientation(theirs: ExternalTrajectory, system: RollingSystem, start: State | None) -> ExternalTrajectory:
    """Return what they gave without the orientation, unless the law needs one: then with that of their Ω."""
    return with_orientation(system, replace(theirs, orientation=None), start)


def _own_axes(case: Case, _: object) -> tuple[Series, ...]:
    """Compare the slope of the orientation, along the axes of the body, with Ω."""
    index = case.motion.index
    turned = turning_of(case.theirs, index)
    Q = Quaternion.of(case.motion.orientation).matrix()
    own = (Q.transpose @ Vector.of(turned.values)).array() - case.motion.angular_velocity
    size = float(np.linalg.norm(turned.values, axis=1).max())
    asked = case.tolerance * size
    bound = asked + turned.error + case.motion.estimates["angular_velocity"].error
    return (Series(TURN, case.motion.time, own, size, bound, asked, "Qᵀ 2 q̇ q* against Ω"),)


def _quaternions(case: Case) -> Iterator[Suspect]:
    """Try another order of the quaternion's parts, and the inverse rotation."""
    if case.theirs.orientation is None or "orientation" in case.theirs.doubts:
        return
    order, inverse = [3, 0, 1, 2], [1.0, -1.0, -1.0, -1.0]
    same = [1.0, 1.0, 1.0, 1.0]
    for name, says, parts, signs in (
        ("quaternion-order", "Quaternions are in the order x, y, z, w", order, same),
        ("inverse-orientation", _INVERSE, [0, 1, 2, 3], inverse),
        ("inverse-orientation", f"{_INVERSE}, in the order x, y, z, w", order, inverse),
    ):
        yield Suspect(name, f"{says}.", _TURNED, theirs=partial(_quaternion, parts=parts, signs=signs))


_INVERSE = "The orientation is its inverse: it takes space components to those of the body"


def _quaternion(theirs: ExternalTrajectory, parts: list[int], signs: list[float]) -> ExternalTrajectory:
    assert theirs.orientation is not None  # noqa: S101  who yields it has looked
    return replace(theirs, orientation=theirs.orientation[:, parts] * signs)


def _holonomic(case: Case) -> Iterator[Suspect]:
    """Try an orientation that was computed from the displacement, as if rolling could be integrated."""
    theirs, body = case.theirs, case.system.body
    if theirs.orientation is None or "orientation" in theirs.doubts or not concentric_sphere(body.shape):
        return
    if not case.system.support.surface.flat or not body.is_isotropic_sphere:
        return
    index, a = case.motion.index, float(body.radius)
    q, where = theirs.orientation[index], case.motion.estimates["position"]
    noise = case.motion.estimates["orientation"].noise + where.noise / a
    for from_start in (True, False):
        moved = theirs.position[index] - (theirs.position[0] if from_start else 0.0)
        before = Quaternion.of(theirs.orientation[0]) if from_start else Quaternion(1.0, 0.0, 0.0, 0.0)
        size = max(float(np.linalg.norm(moved[:, :2], axis=1).max()) / a, 1.0)
        asked = 10 * case.tolerance * size
        for how, turn in _from_displacement(moved[:, 0] / a, moved[:, 1] / a):
            off = 2 * (turn * before * Quaternion.of(q).conjugate).array()[:, 1:]
            bound = asked + 2 * SIGMAS * noise
            match = Series(TURN, case.motion.time, off, size, bound, asked, "angle from that of the displacement")
            matches = partial(_given, match)
            says = (
                f"The constraint was taken for a holonomic one: the orientation is {how}, "
                "a function of the place alone. It depends on the way there; integrate q̇ = ½ Ω q."
            )
            undo = partial(_without_orientation, system=case.system, start=case.start)
            yield Suspect("holonomic-constraint", says, _TURNED | _AXES, theirs=undo, further=matches)


def _given(match: Series, _: object) -> tuple[Series, ...]:
    return (match,)


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
