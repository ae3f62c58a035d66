"""What adds up over a run: the integrals of the system, and the distance from trundle's own run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import TrundleError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import touch
from ..mechanics.invariants import Invariant, Record, invariants_of
from ..mechanics.loads import BodyMotion
from ..mechanics.system import RollingSystem, State
from ..solve import methods
from ..solve.samples import Samples
from .examining import LAW_SHARE, Series
from .motion import Motion
from .record import Array, Theirs

_MOST_RADIANS = 1e4  # of turning that a run of ours follows
_FIRST = 4  # instants that are tried first
OWN_RUN = "our own run from the same start"


@dataclass(frozen=True)
class OwnRun:
    """Trundle's run from their first sample, at the instants that were looked at.

    Parameters
    ----------
    position : array (m, 3)
        Where our body is, m; the last instants are missing where ours runs off a rim.
    method : str
        That made it.
    remark : str
        Why there is none, where there is none.
    """

    position: Array
    method: str = ""
    remark: str = ""


def integrals(system: RollingSystem, at: Motion, tolerance: float) -> Iterator[Series]:
    """Compare each integral that the system has with its value at the first instant.

    Parameters
    ----------
    system : RollingSystem
        Says which integrals it has.
    at : Motion
        Their motion.
    tolerance : float
        As for `examine`.

    Yields
    ------
    Series
        The drift, with a bound that holds what their errors can do to it.
    """
    for integral in invariants_of(system):
        if integral.name.startswith("spin") and not at.turning_known:
            continue  # it would be our own assumption that is found again
        if not integral.terms(system, _record(system, at)):  # it has nothing to say of this motion
            continue
        value, size = _value(system, integral, at)
        doubt = np.zeros(at.time.size)
        for name in ("position", "velocity", "angular_velocity"):
            error = getattr(at, f"{name}_error")
            for e in np.eye(3):
                moved = replace(at, **{name: getattr(at, name) + error[:, None] * e})
                doubt += np.abs(_value(system, integral, moved)[0] - value).max(axis=1)
        asked = LAW_SHARE * tolerance * size
        residual = value - value[0]
        note = f"{integral.formula} stays the same"
        yield Series(f"drift of the {integral.name}", at.time, residual, size, asked + doubt + doubt[0], asked, note)


def _record(system: RollingSystem, at: Motion) -> Record:
    state = BodyMotion(
        at.time,
        system.body.mass,
        Vector.of(at.position),
        Vector.of(at.velocity),
        Quaternion.of(at.orientation),
        Vector.of(at.angular_velocity),
        at.contact.normal,
        at.contact.support.angular_velocity,
    )
    return Record(state, at.contact.point)


def _value(system: RollingSystem, integral: Invariant, at: Motion) -> tuple[Array, float]:
    terms, sizes = integral.sized_terms(system, _record(system, at))
    size = max(float(np.abs(_rows(term, at.time.size)).max()) for term in sizes)
    return np.asarray(sum(_rows(term, at.time.size) for term in terms), dtype=float), max(size, 1e-300)


def _rows(term: Any, count: int) -> Array:
    array = term.array() if isinstance(term, Vector) else np.asarray(term, dtype=float)
    if array.ndim < 2 and not isinstance(term, Vector):  # one number, or one an instant
        array = array[..., None]
    return np.broadcast_to(array, (count, array.shape[-1])).astype(float)


def own_run(system: RollingSystem, theirs: Theirs, at: Motion, tolerance: float) -> tuple[Series | None, OwnRun]:
    """Run the system from their first sample and follow how far theirs moves away from it.

    Parameters
    ----------
    system : RollingSystem
        What is said to move.
    theirs : Theirs
        Says whether the height is theirs.
    at : Motion
        Their motion.
    tolerance : float
        Of it, as a share of the way travelled.

    Returns
    -------
    series : Series or None
        The distance; its bound holds what the error of their first sample can do.
    run : OwnRun
        Ours.
    """
    try:
        where, method = _as_far_as_may_be(system, at)
        tried = [(_run(system, at, step, len(where))[0].position, times) for step, times in _steps(system, at)]
    except TrundleError as error:
        return None, OwnRun(np.empty((0, 3)), remark=str(error).partition("\n")[0])
    except NotImplementedError:  # a surface of somebody's own
        return None, OwnRun(np.empty((0, 3)), remark="the surface has no coordinates to place a body by")
    count = min([len(where), *(len(one) for one, _ in tried)])
    if count < 2:
        return None, OwnRun(np.empty((0, 3)), remark="ours leaves the support at once")
    moved = sum(times * np.linalg.norm(one[:count] - where[:count], axis=1) for one, times in tried)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(at.position, axis=0), axis=1))])
    distance = (at.position - where[0])[:count] - (where - where[0])[:count]
    size = max(float(np.ptp(at.position, axis=0).max()), float(way[-1]) * 1e-3, 1e-9 * _arm(at))
    asked = LAW_SHARE * tolerance * size
    bound = asked + LAW_SHARE * tolerance * way[:count] + at.position_error[:count] + np.asarray(moved)
    note = f"distance between the two paths, share of their extent; ours: {method}"
    distance = distance[:, :2] if not theirs.height_given else distance
    asked += LAW_SHARE * tolerance * float(way[-1])
    return Series(OWN_RUN, at.time[:count], distance, size, bound, asked, note), OwnRun(where, method)


def _arm(at: Motion) -> float:
    return float(np.linalg.norm(at.offset, axis=1).max())


def _steps(system: RollingSystem, at: Motion) -> list[tuple[Array, float]]:
    """Return small steps of place and V along the surface and of the spin, and how many of them they may be off."""
    extent = max(float(np.ptp(at.position, axis=0).max()), _arm(at))
    speed = max(float(np.linalg.norm(at.velocity, axis=1).max()), extent / float(at.time[-1] - at.time[0]))
    errors = [e[0] for e in (at.position_error, at.velocity_error, at.angular_velocity_error)]
    scales = [extent, extent, speed, speed, speed / _arm(at)]
    free = [True, True, True, True, at.turning_known]
    axis = _axis(system, at)
    if axis is not None:  # a cylinder has but one way to go
        across = [abs(float(d @ axis)) < 0.5 for d in _directions(system, at)]
        free = [*across, *across, False]
    found = []
    for place, error in enumerate(np.repeat(errors, [2, 2, 1])):
        size = min(float(error), 1e-3 * scales[place])
        if size > 0 and free[place]:
            found.append((np.eye(5)[place] * size, float(error) / size))
    return found


def _axis(system: RollingSystem, at: Motion) -> Array | None:
    """Return the axis of a cylinder at the first instant, in space; None for a body that touches at a point."""
    axis = system.body.shape.axis
    return None if axis is None else np.array([*(Quaternion(*at.orientation[0]).matrix() @ axis)], dtype=float)


def _directions(system: RollingSystem, at: Motion) -> list[Array]:
    """Return the two directions along the surface at the first contact, in space."""
    now = system.support.motion.at(float(at.time[0]))
    own = now.rotation.transpose @ (_first(at.contact.point) - now.origin)
    return [np.array([*(now.rotation @ d)], dtype=float) for d in system.support.surface.directions(own)]


def _first(vector: Vector) -> Vector:
    return Vector(*(float(np.ravel(part)[0]) for part in vector))


def _as_far_as_may_be(system: RollingSystem, at: Motion) -> tuple[Array, str]:
    """Run for longer and longer, as long as the body does not turn more often than is worth following."""
    count = min(_FIRST, at.time.size)
    while True:
        samples, method = _run(system, at, np.zeros(5), count)
        span = float(samples.time[-1] - at.time[0])
        turned = 4 * span * float(np.linalg.norm(samples.angular_velocity, axis=1).max())
        if count == at.time.size or samples.time.size < count or turned > _MOST_RADIANS:
            return samples.position, method
        count = min(2 * count, at.time.size)


def _run(system: RollingSystem, at: Motion, step: Array, count: int) -> tuple[Samples, str]:
    state = _start(system, at, step)
    method, samples = methods.run("auto", system, state, at.time[:count])
    ended = sum(event.final for event in samples.events)
    return samples.part(slice(0, samples.time.size - ended)), method.name  # the last is where the support ends


def _start(system: RollingSystem, at: Motion, step: Array) -> State:
    """Return the start on the support, rolling, that is nearest to their first sample, a step away."""
    time, q = float(at.time[0]), Quaternion(*map(float, at.orientation[0]))
    first, second = (Vector(*d) for d in _directions(system, at))
    surface, now = system.support.surface, system.support.motion.at(time)
    point = _first(at.contact.point) + first * step[0] + second * step[1]
    own = surface.point(*surface.coordinates_of(now.rotation.transpose @ (point - now.origin)))
    contact = touch(system, time, now.origin + now.rotation @ own, q)
    system.check_rim(contact, at.position[0].tolist())
    rho, n = contact.offset, contact.normal
    relative = Vector(*at.velocity[0]) + first * step[2] + second * step[3]
    relative = relative - contact.support.material_velocity(contact.point)
    across = relative.cross(rho) / rho.dot(rho)
    spin = float(Vector(*at.angular_velocity[0]).dot(n)) + step[4]
    Omega = across + rho * ((spin - across.dot(n)) / rho.dot(n))
    axis = _axis(system, at)
    if axis is not None:
        Omega = Vector(*axis) * Omega.dot(Vector(*axis))
    V = contact.rolling_velocity(Omega)
    where, moving, turning = (tuple(float(part) for part in v) for v in (contact.centre, V, Omega))
    return State(_three(where), _three(moving), _three(turning), (q.w, q.x, q.y, q.z), time)


def _three(parts: tuple[float, ...]) -> tuple[float, float, float]:
    return parts[0], parts[1], parts[2]
