"""What adds up over a run: the first integrals of the system, at some of their instants."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.invariants import Invariant, Record, invariants_of
from ...mechanics.loads import BodyMotion
from ...mechanics.system import RollingSystem, State
from .chance import longest
from .comparisons import sensitivity_of
from .examining import LAW_SHARE
from .motion import Instants, motion_of
from .record import Array, ExternalTrajectory
from .series import Series
from .windows import spread_of

_INSTANTS = 48  # looked at


def integrals(
    system: RollingSystem, theirs: ExternalTrajectory, tolerance: float, start: State | None
) -> Iterator[Series]:
    """Compare each integral that the system has with its value at the first instant."""
    n = theirs.time.size
    at = motion_of(system, theirs, start, np.unique(np.linspace(0, n - 1, min(n, _INSTANTS)).round().astype(int)))
    for integral in invariants_of(system):
        if integral.name.startswith("spin") and not at.turning_known:
            continue  # it would be our own assumption that is found again
        terms, sizes = integral.sized_terms(system, _record(system, at))
        if not terms:  # it has nothing to say of this motion
            continue
        reacts, (value,) = sensitivity_of(system, _values(system, integral), at)
        gains = reacts.gains[0]
        parts = [(at.sources[name], gain * at.estimates[name].spread) for name, gain in gains.items()]
        spread = spread_of(parts, {source: np.ones(1) for source, _ in parts})
        bias = reacts.curvature[0] + sum(gain * at.estimates[name].bias for name, gain in gains.items())
        freedom = min(at.estimates[name].freedom for name in gains)
        times = longest(len(value), freedom, value.shape[1])
        size = max(1e-300, *(float(np.abs(_rows(term, at.time.size)).max()) for term in sizes))
        asked = LAW_SHARE * tolerance * size
        bound = asked + bias + bias[0] + times * np.hypot(spread, spread[0])
        note = f"{integral.formula} stays the same"
        yield Series(f"drift of the {integral.name}", at.time, value - value[0], size, bound, asked, note)


def _record(system: RollingSystem, at: Instants) -> Record:
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


def _values(system: RollingSystem, integral: Invariant) -> Callable[[Instants], tuple[Array, ...]]:
    def values(at: Instants) -> tuple[Array, ...]:
        terms = integral.terms(system, _record(system, at))
        return (np.asarray(sum(_rows(term, at.time.size) for term in terms), dtype=float),)

    return values


def _rows(term: Any, count: int) -> Array:
    array = term.array() if isinstance(term, Vector) else np.asarray(term, dtype=float)
    if array.ndim < 2 and not isinstance(term, Vector):  # one number, or one an instant
        array = array[..., None]
    return np.broadcast_to(array, (count, array.shape[-1])).astype(float)
