"""The first integrals of a run: each must stay the same over every stretch of a phase that it survives."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ..mechanics.algebra import Vector
from ..mechanics.contact import contact_at
from ..mechanics.invariants import Invariant, Record, invariants_of
from ..mechanics.system import RollingSystem
from ..solve.methods import Method
from ..solve.samples import FLIGHT, ROLLING, SLIPPING, Samples
from .bounds import EXACT, Array, before_a_singular_end, bound_of, largest, pace_of, speed_of, turned_in
from .card import CardFigure, checked

_ROUNDING = 3e-16  # of a speed, or of a coordinate
_NUDGE = 1e-8  # of a coordinate, by which it is moved to see how far its rounding shows
_MEANWHILE = {"rolling": "while it rolls", "slipping": "while it slips", "flight": "in flight"}


def drifts(system: RollingSystem, at: Samples, method: Method) -> Iterator[CardFigure]:
    """Check each first integral over every stretch of a phase that it survives."""
    if at.phase[-1] != FLIGHT:  # where it touches, a rounding of the place is no longer one of the rest
        at = before_a_singular_end(at)
    bound, phases = bound_of(method, turned_in(at)), set()
    worst: dict[str, tuple[float, Any, set[str]]] = {}
    for part, phase in _runs_of_a_phase(at):
        record = Record(part.motion(system), Vector.of(part.contact), part.support_columns)
        phases.add(phase)
        for integral in invariants_of(system, phases=(phase,)):
            terms, sizes = integral.sized_terms(system, record)
            if not terms:  # it has nothing to say of this stretch
                continue
            total = _sum_of(terms, part.time.size)
            drift = drift_of(total, sizes)
            if drift > bound:
                stirred = integral.sized_terms(system, _stirred(system, part, record))[1]
                by_place = _shown_of_place(system, part, record, integral, total)
                drift = min(drift, drift_of(total, [*stirred, by_place / bound]))
            known = worst.get(integral.name, (0.0, integral, set()))
            worst[integral.name] = max(known[0], drift), integral, known[2] | {phase}
    for name, (drift, integral, held) in worst.items():
        while_ = "" if held == phases else f" {' and '.join(_MEANWHILE[phase] for phase in sorted(held))}"
        yield checked(f"drift of the {name}", drift, bound, f"{integral.formula} stays the same{while_}")


def _stirred(system: RollingSystem, at: Samples, record: Record) -> Record:
    """Return a motion with V and Ω of the size by which rounding of the speeds at the contact shows, over the bound.

    A body that hardly moves on a support that moves fast is the small difference of the two. Roundings add up as a
    random walk of about a step a radian.
    """
    V = _ROUNDING / EXACT * math.sqrt(max(1.0, turned_in(at))) * speed_of(system, at)
    Omega = V / largest(at.contact - at.position)
    motion = record.motion
    moved = replace(
        motion,
        velocity=motion.velocity + Vector(V, V, V),
        angular_velocity=motion.angular_velocity + Vector(Omega, Omega, Omega),
    )
    return replace(record, motion=moved)


def _shown_of_place(system: RollingSystem, at: Samples, record: Record, integral: Invariant, total: Array) -> float:
    """Return by how much rounding of the place may move a first integral between a stretch's first instant and another.

    A coordinate is rounded as a share of itself, about once a radian of the fastest rotation, and how far it shows the
    integral itself tells: deep in a narrow funnel a ball goes round the axis at a small share of its height, and the
    height that it carries its spin along is the small difference of two.
    """
    moved = np.zeros(3)
    for i, direction in enumerate(np.eye(3)):
        steps = _NUDGE * np.abs(at.contact[:, i])
        steps[0] = 0.0
        terms = integral.terms(system, _shifted(system, at, record, Vector.of(steps[:, None] * direction)))
        moved[i] = np.abs(_sum_of(terms, at.time.size) - total).max() if terms else 0.0
    turns = pace_of(system, at) * float(np.ptp(at.time))
    return _ROUNDING / _NUDGE * math.sqrt(max(1.0, turns)) * float(moved.sum())


def _shifted(system: RollingSystem, at: Samples, record: Record, shift: Vector) -> Record:
    """Return a motion whose contact has moved a little, and the body with it, as it touches there."""
    motion, place = record.motion, record.contact + shift
    if at.phase[0] == FLIGHT:
        moved = replace(motion, position=motion.position + shift)
        return replace(record, motion=moved, contact=place)
    here, there = (
        contact_at(system, at.time, point, motion.orientation, record.support_coordinates)
        for point in (record.contact, place)
    )
    centre = motion.position + (there.centre - here.centre)
    turned = there.rolling_velocity(motion.angular_velocity) - here.rolling_velocity(motion.angular_velocity)
    moved = replace(motion, position=centre, velocity=motion.velocity + turned, normal=there.normal)
    return replace(record, motion=moved, contact=place)


def _runs_of_a_phase(at: Samples) -> Iterator[tuple[Samples, str]]:
    """Return the samples between events, with the phase of each part by its name."""
    names = {ROLLING: "rolling", SLIPPING: "slipping", FLIGHT: "flight"}
    changes = [event.time for event in at.events if not event.final]
    for index in np.split(np.arange(at.time.size), np.searchsorted(at.time, changes)):
        if index.size > 1 and int(at.phase[index[0]]) in names:
            yield at.part(index), names[int(at.phase[index[0]])]


def _sum_of(terms: list[Any], count: int) -> Array:
    return np.sum([_as_array(term, count) for term in terms], axis=0)


def _as_array(term: Any, count: int) -> Array:
    array = term.array() if isinstance(term, Vector) else np.asarray(term, dtype=float)
    return np.broadcast_to(array, (count, *array.shape[1:])) if array.ndim else np.full(count, float(array))


def drift_of(values: Any, sizes: Any) -> float:
    """Return by how much of the largest of its terms a sum changes.

    Examples
    --------
    >>> drift_of(np.array([2.0, 2.0, 3.0]), (np.array([4.0, 4.0, 4.0]),))
    0.25
    """
    change = np.abs(values - values[0]).max()
    size = max((float(np.abs(_as_array(term, len(values))).max()) for term in sizes), default=0.0)
    return 0.0 if change == 0 else float(change / max(size, 1e-300))
