"""What adds up over a run: the integrals of the system, and the distance from trundle's own run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import TrundleError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.invariants import Invariant, Record, invariants_of
from ..mechanics.loads import BodyMotion
from ..mechanics.system import RollingSystem
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


def _value(system: RollingSystem, integral: Invariant, at: Motion) -> tuple[Array, float]:
    state = BodyMotion(
        at.time,
        system.body.mass,
        Vector.of(at.position),
        Vector.of(at.velocity),
        Quaternion.of(at.orientation),
        Vector.of(at.angular_velocity),
    )
    terms = [_rows(term, at.time.size) for term in integral.terms(system, Record(state, at.contact.point))]
    size = max(float(np.abs(term).max()) for term in terms)
    if integral.unit == "rad/s":  # a spin of next to nothing is little beside Ω, not beside itself
        size = max(size, float(np.linalg.norm(at.angular_velocity, axis=1).max()))
    return np.asarray(sum(terms), dtype=float), max(size, 1e-300)


def _rows(term: Any, count: int) -> Array:
    array = term.array() if isinstance(term, Vector) else np.asarray(term, dtype=float)[..., None]
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
        tried = [(_run(system, at, step, len(where))[0].position, times) for step, times in _steps(at)]
    except TrundleError as error:
        return None, OwnRun(np.empty((0, 3)), remark=str(error).partition("\n")[0])
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


def _steps(at: Motion) -> list[tuple[Array, float]]:
    """Return small steps of x, y, V_x, V_y and spin, one at a time, and how many of them their start may be off."""
    extent = max(float(np.ptp(at.position, axis=0).max()), _arm(at))
    speed = max(float(np.linalg.norm(at.velocity, axis=1).max()), extent / float(at.time[-1] - at.time[0]))
    errors = [e[0] for e in (at.position_error, at.velocity_error, at.angular_velocity_error)]
    found = []
    for place, error, scale in zip(
        range(5), np.repeat(errors, [2, 2, 1]), [extent, extent, speed, speed, speed / _arm(at)], strict=True
    ):
        size = min(float(error), 1e-3 * scale)
        if size > 0 and (place < 4 or at.turning_known):
            found.append((np.eye(5)[place] * size, float(error) / size))
    return found


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
    x, y, vx, vy = np.concatenate([at.position[0, :2], at.velocity[0, :2]]) + step[:4]
    normal = np.broadcast_to(at.contact.normal.array(), at.position.shape)[0]
    spin = float(at.angular_velocity[0] @ normal) + step[4]
    state = system.place((float(x), float(y)), (float(vx), float(vy)), spin, orientation=tuple(at.orientation[0]))
    state = replace(state, time=float(at.time[0]))
    method = methods.choose("auto", system, state)
    samples = methods.solver(method)(system, state, at.time[:count], methods.tolerance_of(method))
    return samples.part(slice(0, samples.time.size - len(samples.events))), method  # the last is at the rim
