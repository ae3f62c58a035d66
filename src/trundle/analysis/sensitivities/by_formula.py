"""Derivatives of a closed form: its own formula on duals, and the turn of the body by one quadrature."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.duals import Dual, beside, slopes_of, strictly, value_of
from ...mechanics.system import RollingSystem, State
from ...solve import closed_form, transitions
from ...solve.exact import ClosedForm, form_of_phase
from ...solve.samples import RESTING, Array
from ...solve.transitions import PhaseStart
from .following import Followed, check_brink, check_start
from .outputs import sampled, stacked_slopes

_NODES, _MOST_NODES = 16, 4_000_000  # of Gauss's rule, for each radian of the fastest rate; of a run
_PHASE = 1.0  # rad
Moved = tuple[tuple[Vector, Vector, Vector, Vector], tuple[Any, ...]]
_BESIDE = 1e-7  # share of a number by which it is changed to see whether a form covers that, too


def follow_formula(
    system: RollingSystem, start: State, times: Array, in_duals: tuple[RollingSystem, State], names: Sequence[str]
) -> Followed | None:
    """Return a run and its derivatives by one closed form; None where none covers all of it, or has derivatives."""
    form, now = form_throughout(system, start, float(times[-1]))
    if form is None or now.law.code == RESTING:  # whose contact is searched for, in floats
        return None
    check_brink(system, now)
    duals, first = in_duals
    if any(slopes_of(first.time, len(names))):  # forms count from the start
        return None
    begins, count = transitions.at_start(duals, first), len(names)
    check_start(duals, begins, first, names)
    varied = form_in_duals(type(form), duals, begins, count)
    if varied is None:
        return None
    samples = closed_form.solve(system, start, times)
    nodes = _nodes(times, max(form.max_rate(float(times[-1] - times[0])), _fastest(samples.angular_velocity)))
    if nodes is None:
        return None
    moved = motion_in_duals(varied, times - start.time)
    if moved is None:
        return None
    (r, V, Omega, R), grown = moved
    q = _turned(form, varied, start, begins.start, times, nodes, count)
    coordinates = tuple(of_start + gone for of_start, gone in zip(begins.start.support, grown, strict=True))
    point = closed_form._contact(duals, now.law, times, r, q, coordinates)
    carried = duals.support.motion.at(times, *coordinates).material_velocity(point)
    found = sampled(now.law, r, V, Omega, R, q, point, carried, coordinates)
    return Followed(samples, stacked_slopes(found, times.size, count), np.empty((0, count)))


def form_throughout(system: RollingSystem, start: State, end: float) -> tuple[ClosedForm | None, PhaseStart]:
    """Return the closed form of all of a run and how it begins; no form where none covers it, or an event comes."""
    now = transitions.at_start(system, start)
    form = form_of_phase(now.law.code, system, now.start, now.state_vector)
    if form is None or now.events or closed_form._first_stop(system, now, form, end - now.time) is not None:
        return None, now
    return form, now


def form_in_duals(form: type[ClosedForm], system: RollingSystem, begins: PhaseStart, count: int) -> ClosedForm | None:
    """Return a form with its slopes by some parameters; None where it holds for the numbers alone, not beside them.

    So it is where it asks that a number be 0, and a parameter changes that. Conditions leave room for rounding, and are
    asked a little beside.
    """
    given = system, begins.start
    for j in range(count):
        step = _BESIDE * min((abs(size) for size in _sizes(given, j) if abs(size) > _BESIDE), default=1.0)
        for way in (step, -step):
            with suppress(InvalidValueError):  # a number at its limit has one side
                if form.violations(*beside(given, j, way)):
                    return None
    try:
        with strictly():
            return form.from_state_vector(*given, begins.state_vector)
    except TypeError:  # it is read by floats only
        return None


def motion_in_duals(form: ClosedForm, t: Array) -> Moved | None:
    """Return the motion in duals, and the coordinates of the support; None where the formula takes floats only."""
    try:
        with strictly():
            motion, grown = form.motion_and_support_at(t)
            slopes = [slope for part in motion for one in part for slope in getattr(one, "slopes", ())]
            known = all(bool(np.isfinite(slope).all()) for slope in slopes)
    except TypeError:
        return None
    return (motion, grown) if known else None


def _sizes(thing: Any, j: int) -> Iterator[float]:
    """Yield how far a parameter would have to change for each number to change by as much as it is."""
    if is_dataclass(thing):
        for field in fields(thing):
            yield from _sizes(getattr(thing, field.name), j)
    elif isinstance(thing, tuple):
        for part in thing:
            yield from _sizes(part, j)
    elif isinstance(thing, Dual) and np.any(thing.slopes[j]):
        yield float(np.ravel(value_of(thing))[0] / np.ravel(thing.slopes[j])[0])


def _fastest(angular_velocity: Array) -> float:
    return float(np.linalg.norm(angular_velocity, axis=1).max())


def _nodes(times: Array, rate: float) -> tuple[Array, Array, Any] | None:
    """Return the instants and weights of Gauss's rule between each two samples, and in which interval each is."""
    gaps = np.diff(times)
    panels = np.maximum(1, np.ceil(gaps * rate / _PHASE)).astype(int)
    if _NODES * panels.sum() > _MOST_NODES:
        return None
    x, w = np.polynomial.legendre.leggauss(_NODES)
    which = np.repeat(np.arange(gaps.size), panels)
    first = np.concatenate([[0], np.cumsum(panels)[:-1]]) if gaps.size else np.empty(0)
    width = gaps[which] / panels[which]
    begin = times[:-1][which] + (np.arange(which.size) - first[which]) * width
    instants = (begin[:, None] + width[:, None] * (0.5 + 0.5 * x)).ravel()
    return instants, (0.5 * width[:, None] * w).ravel(), np.repeat(which, _NODES)


def _turned(
    form: ClosedForm,
    varied: ClosedForm,
    start: State,
    first: State,
    times: Array,
    nodes: tuple[Array, Array, Any],
    count: int,
) -> Quaternion:
    """Return the orientation in duals.

    A small turn φ of the body, in space, changes as φ̇ = Ω×φ + δΩ: on the axes of the body it is the integral of δΩ.
    """
    instants, weights, which = nodes
    every = np.concatenate([times, instants])
    order = np.argsort(every, kind="stable")
    q = np.empty((every.size, 4))
    q[order] = closed_form.orientations(form, start, every[order])
    Q, at_nodes = Quaternion.of(q[: times.size]), Quaternion.of(q[times.size :])
    changes: Any = varied.motion_at(instants - start.time)[2]
    begin = [Dual(value_of(part), slopes_of(part, count)) for part in first.orientation]
    slopes = []
    for j in range(count):
        change = Vector(*(np.broadcast_to(slopes_of(part, count)[j], instants.shape) for part in changes))
        on_body = (at_nodes.matrix().transpose @ change).array() * weights[:, None]
        gone = np.zeros((times.size, 3))
        np.add.at(gone, which + 1, on_body)
        at_first = Quaternion(*(part.slopes[j] for part in begin)) * Quaternion(*start.orientation).conjugate
        turn = Quaternion(*start.orientation).matrix().transpose @ (Vector(at_first.x, at_first.y, at_first.z) * 2.0)
        turned = Q.matrix() @ (Vector.of(np.cumsum(gone, axis=0)) + turn)
        slopes.append([0.5 * part for part in Quaternion(0.0, *turned) * Q])
    return Quaternion(*(Dual(part, tuple(row[i] for row in slopes)) for i, part in enumerate(Q)))
