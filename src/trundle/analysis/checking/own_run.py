"""Trundle's own run from their start, and how far theirs moves away from it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import SolverError, TrundleError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.contact import contact_at
from ...mechanics.system import RollingSystem, State
from ...solve import methods
from ...solve.samples import Samples
from .chance import longest
from .examining import INSTANTS, LAW_SHARE
from .motion import Motion, instants, motion_of
from .record import Array, ExternalTrajectory
from .series import Series
from .slopes import SIGMAS

_MOST_RADIANS = 1e4  # of turning that a run of ours follows
_MOST_EVENTS = 20  # of a run of ours: the least error of a start makes others of more
_FIRST = 4  # instants that are tried first
_PLACES, _SPEEDS, _SPIN, _TURNS = slice(0, 2), slice(2, 4), 4, slice(5, 8)  # of the numbers of a start
_NUMBERS = 8
_SMALL = (1e-7, 1e-3)  # of the scale of a number, between which it is stepped
_STRAIGHT = 0.02  # of the path's extent: what a change of the start may do before it is followed again
_ROUNDS = 3
OWN_RUN = "our own run from the same start"


@dataclass(frozen=True)
class OwnRun:
    """Trundle's run from their start, at the instants that were looked at."""

    position: Array  # (m, 3): where our body is, m; the last instants are missing where ours runs off a rim
    method: str = ""  # that made it
    remark: str = ""  # why there is none, where there is none
    after: float = float("nan")  # when the last instant is, s
    distance: float = float("nan")  # how far apart the two are then, m
    angle: float = float("nan")  # how far turned, rad; not a number where they gave no orientation
    start: State | None = None  # from which it goes all along


@dataclass(frozen=True)
class _Start:
    """Where a run of ours may start: their first state, the numbers that may change, and by how much they may."""

    system: RollingSystem
    at: Motion
    free: Array  # which of the numbers
    spread: Array
    most: Array
    step: Array

    def run(self, numbers: Array, count: int) -> tuple[Samples, str]:
        """Run from a start off theirs by some numbers, at the first instants."""
        state = _state(self.system, self.at, numbers)
        method, samples = methods.run("auto", self.system, state, self.at.time[:count])
        ended = sum(event.final for event in samples.events)
        return samples.part(slice(0, samples.time.size - ended)), method.name  # the last is where the support ends


def own_run(
    system: RollingSystem, theirs: ExternalTrajectory, tolerance: float, start: State | None, *, closest: bool = False
) -> tuple[Series | None, OwnRun]:
    """Run the system from their start, as near as its noise allows, or as it is; follow how far theirs moves away.

    The second is tried where the first fails, or where the closest is asked for.
    """
    n = theirs.time.size
    at = motion_of(system, theirs, start, np.unique(np.linspace(0, n - 1, min(n, INSTANTS)).round().astype(int)))
    parts = slice(None) if theirs.height_given else slice(0, 2)
    found, remark = [], ""
    for written in (False, True):  # samples far apart show no noise, and are exact as they are
        try:
            first = _as_written(system, theirs, at) if written else at
            found.append(_followed(system, theirs, first, tolerance, parts))
        except TrundleError as error:
            remark = remark or str(error).partition("\n")[0]
        except NotImplementedError:  # a surface of somebody's own
            remark = "the surface has no coordinates to place a body by"
        if found and found[-1][0].worst <= 1 and not closest:
            break
    if not found:
        return None, OwnRun(np.empty((0, 3)), remark=remark)
    return min(found, key=lambda one: one[0].worst)


def _as_written(system: RollingSystem, theirs: ExternalTrajectory, at: Motion) -> Motion:
    """Return their motion by what they wrote at its instants, with no mean over samples."""
    names = ("position", "velocity", "angular_velocity", "orientation")
    arrays = {name: getattr(theirs, name) for name in names}
    parts = {name: getattr(at, name) if one is None else one[at.index] for name, one in arrays.items()}
    now = instants(system, at.time, parts, None if at.turning_known else at.spin)
    return replace(at, **{name: getattr(now, name) for name in (*names, "contact")})


def _followed(
    system: RollingSystem, theirs: ExternalTrajectory, at: Motion, tolerance: float, parts: slice
) -> tuple[Series, OwnRun]:
    """Follow ours from one of their starts."""
    where = theirs.position[at.index]
    begin = _begin(system, theirs, at)
    most, method = _as_far_as_may_be(begin)
    ours, moved, numbers = _nearest(begin, where, parts, most)
    count = ours.time.size
    if count < 2:
        raise SolverError("ours leaves the support at once")
    found = _apart(theirs, at, ours, method, parts)
    if count == at.time.size:
        found = replace(found, start=_state(system, at, numbers))
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(at.position, axis=0), axis=1))])[:count]
    size = max(_extent(at), float(way[-1]) * 1e-3, 1e-9 * at.arm)
    asked = LAW_SHARE * tolerance * (size + way)
    noise = at.estimates["position"]
    distance = (where[:count] - ours.position)[:, parts]
    times = longest(count, noise.freedom, distance.shape[1])
    bound = asked + times * noise.noise[:count] + SIGMAS * moved**2 / size
    note = f"distance between the two paths, share of their extent; ours: {method}"
    return Series(OWN_RUN, at.time[:count], distance, size, bound, float(asked[-1]), note), found


def _apart(theirs: ExternalTrajectory, at: Motion, ours: Samples, method: str, parts: slice) -> OwnRun:
    last = ours.time.size - 1
    sample = at.index[last]
    distance = float(np.linalg.norm((theirs.position[sample] - ours.position[last])[parts]))
    angle = float("nan")
    if theirs.orientation is not None:
        turn = Quaternion(*theirs.orientation[sample]) * Quaternion(*ours.orientation[last]).conjugate
        angle = float(2 * np.arctan2(np.linalg.norm([turn.x, turn.y, turn.z]), abs(turn.w)))
    return OwnRun(ours.position, method, "", float(at.time[last] - at.time[0]), distance, angle)


def _extent(at: Motion) -> float:
    return float(np.ptp(at.position, axis=0).max())


def _begin(system: RollingSystem, theirs: ExternalTrajectory, at: Motion) -> _Start:
    """Return which numbers of the start their samples leave open, and by how much."""
    extent = max(_extent(at), at.arm)
    speed = max(float(np.linalg.norm(at.velocity, axis=1).max()), extent / float(at.time[-1] - at.time[0]))
    scale = np.array([extent, extent, speed, speed, speed / at.arm, 1.0, 1.0, 1.0])
    free, spread, bias = np.zeros(_NUMBERS, dtype=bool), np.zeros(_NUMBERS), np.zeros(_NUMBERS)
    names: dict[str, Any] = {"position": _PLACES, "velocity": _SPEEDS, "angular_velocity": _SPIN, "orientation": _TURNS}
    if system.body.is_isotropic_sphere or "orientation" in theirs.doubts:
        del names["orientation"]  # it does not matter, or is known at the first sample
    for name, places in names.items():
        if name in at.estimates:
            free[places] = True
            spread[places], bias[places] = at.estimates[name].spread[0], at.estimates[name].bias[0]
    axis = _axis(system, at)
    if axis is not None:  # a cylinder has but one way to go
        across = [abs(float(d @ axis)) < 0.5 for d in _directions(system, at)]
        free[:] = [*across, *across, False, False, False, False]
    most = SIGMAS * spread + bias
    free &= most > 0
    return _Start(system, at, free, np.maximum(spread, 0.2 * bias), most, np.clip(most, *(s * scale for s in _SMALL)))


def _as_far_as_may_be(begin: _Start) -> tuple[int, str]:
    """Run for longer and longer, as long as the body does not turn more often than is worth following."""
    at = begin.at
    count = min(_FIRST, at.time.size)
    while True:
        samples, method = begin.run(np.zeros(_NUMBERS), count)
        if len(samples.events) > _MOST_EVENTS:
            raise SolverError(f"ours comes to {len(samples.events)} events, too many to compare")
        span = float(samples.time[-1] - at.time[0])
        turned = 4 * span * float(np.linalg.norm(samples.angular_velocity, axis=1).max())
        if count == at.time.size or samples.time.size < count or turned > _MOST_RADIANS:
            return count, method
        count = min(2 * count, at.time.size)


def _nearest(begin: _Start, where: Array, parts: slice, count: int) -> tuple[Samples, Array, Array]:
    """Return the run that is nearest to theirs, of those whose starts theirs might be, and what the start may do to it.

    The numbers of that start come last.

    Gauss's and Newton's method; what is known of the start stands beside what the path says, each by its noise.
    """
    numbers = np.zeros(_NUMBERS)
    which = np.flatnonzero(begin.free)
    ours, _ = begin.run(numbers, count)
    moved = np.zeros(ours.time.size)
    for _ in range(_ROUNDS):
        beside = [begin.run(numbers + begin.step[i] * np.eye(_NUMBERS)[i], ours.time.size)[0] for i in which]
        m = min([ours.time.size, *(run.time.size for run in beside)])
        if m < 2 or not which.size:
            return ours.part(slice(0, m)), moved[:m], numbers
        slopes = [(run.position[:m] - ours.position[:m]) / begin.step[i] for run, i in zip(beside, which, strict=True)]
        moved = np.sqrt(
            sum((np.linalg.norm(s, axis=1) * begin.spread[i]) ** 2 for s, i in zip(slopes, which, strict=True))
        )
        changed = _change(begin, numbers, np.array(slopes)[..., parts], (where[:m] - ours.position[:m])[:, parts])
        path = ours.position[:m] + sum(s * changed[i] for s, i in zip(slopes, which, strict=True))
        far = float(np.linalg.norm(path - ours.position[:m], axis=1).max()) > _STRAIGHT * _extent(begin.at)
        numbers = numbers + changed
        if not far:
            return replace(ours.part(slice(0, m)), position=path), moved, numbers
        ours, _ = begin.run(numbers, m)
        moved = moved[: ours.time.size]
    return ours, moved, numbers


def _change(begin: _Start, numbers: Array, slopes: Array, apart: Array) -> Array:
    """Return the change of the start's numbers that brings our path nearest to theirs, within what they leave open."""
    which = np.flatnonzero(begin.free)
    noise = np.maximum(begin.at.estimates["position"].noise[: apart.shape[0]], 1e-300)
    spread = np.maximum(begin.spread[which], 1e-3 * begin.most[which])
    rows = (slopes / noise[:, None]).reshape(which.size, -1).T * spread
    known = np.vstack([rows, np.eye(which.size)])
    target = np.concatenate([(apart / noise[:, None]).ravel(), -numbers[which] / spread])
    change = np.zeros(_NUMBERS)
    change[which] = np.linalg.lstsq(known, target)[0] * spread
    return np.clip(numbers + change, -begin.most, begin.most) - numbers


def _axis(system: RollingSystem, at: Motion) -> Array | None:
    """Return the axis of a cylinder at the first instant, in space; None for a body that touches at a point."""
    axis = system.body.shape.axis
    return None if axis is None else np.array([*(Quaternion(*at.orientation[0]).matrix() @ axis)], dtype=float)


def _directions(system: RollingSystem, at: Motion) -> list[Array]:
    """Return the two directions along the surface at the first contact, in space."""
    now = system.support.motion.at(float(at.time[0]))
    own = now.local(_first(at.contact.point))
    return [np.array([*(now.rotation @ d)], dtype=float) for d in system.support.surface.directions(own)]


def _first(vector: Vector) -> Vector:
    return Vector(*(float(np.ravel(part)[0]) for part in vector))


def _state(system: RollingSystem, at: Motion, numbers: Array) -> State:
    """Return the start on the support, rolling, that is nearest to their first state, some numbers away."""
    time = float(at.time[0])
    small = Quaternion(1.0, *(0.5 * float(part) for part in numbers[_TURNS]))
    turned = (small * Quaternion(*map(float, at.orientation[0]))).array()
    q = Quaternion(*(float(part) for part in turned / np.linalg.norm(turned)))
    first, second = (Vector(*d) for d in _directions(system, at))
    surface, now = system.support.surface, system.support.motion.at(time)
    point = _first(at.contact.point) + first * numbers[0] + second * numbers[1]
    own = surface.point(*surface.coordinates_of(now.local(point)))
    contact = contact_at(system, time, now.origin + now.rotation @ own, q)
    system.check_rim(contact, at.position[0].tolist())
    rho, n = contact.offset, contact.normal
    relative = Vector(*at.velocity[0]) + first * numbers[2] + second * numbers[3]
    relative = relative - contact.support.material_velocity(contact.point)
    across = relative.cross(rho) / rho.dot(rho)
    spin = float(Vector(*at.angular_velocity[0]).dot(n)) + numbers[_SPIN]
    Omega = across + rho * ((spin - across.dot(n)) / rho.dot(n))
    axis = _axis(system, at)
    if axis is not None:
        Omega = Vector(*axis) * Omega.dot(Vector(*axis))
    V = contact.rolling_velocity(Omega)
    where, moving, turning = (tuple(float(part) for part in v) for v in (contact.centre, V, Omega))
    return State(_three(where), _three(moving), _three(turning), (q.w, q.x, q.y, q.z), time)


def _three(parts: tuple[float, ...]) -> tuple[float, float, float]:
    return parts[0], parts[1], parts[2]
