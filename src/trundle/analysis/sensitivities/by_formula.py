"""Derivatives of a closed form: its own formula on duals, and the turn of the body by one quadrature."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.duals import Dual, slopes_of, value_of
from ...mechanics.system import RollingSystem, State
from ...solve import closed_form, transitions
from ...solve.exact import ClosedForm, form_of_phase
from ...solve.samples import Array
from .following import Followed, check_brink, check_start
from .outputs import sampled, stacked_slopes

_NODES, _MOST_NODES = 16, 4_000_000  # of Gauss's rule, for each radian of the fastest rate; of a run
_PHASE = 1.0  # rad


def follow_formula(
    system: RollingSystem, start: State, times: Array, in_duals: tuple[RollingSystem, State], names: Sequence[str]
) -> Followed | None:
    """Return a run and its derivatives by one closed form; None where none covers all of it, or by floats only."""
    now = transitions.at_start(system, start)
    form = form_of_phase(now.law.code, system, now.start, now.state_vector)
    if form is None or not form.differentiable:
        return None
    samples = closed_form.solve(system, start, times)
    nodes = _nodes(times, max(form.max_rate(float(times[-1] - times[0])), _fastest(samples.angular_velocity)))
    if samples.events or nodes is None:
        return None
    check_brink(system, now)
    duals, first = in_duals
    begins, count = transitions.at_start(duals, first), len(names)
    check_start(duals, begins, first, names)
    varied = type(form).from_state_vector(duals, begins.start, begins.state_vector)
    (r, V, Omega, R), _ = varied.motion_and_support_at(times - start.time)
    q = _turned(form, varied, start, begins.start, times, nodes, count)
    point = closed_form._contact(duals, now.law, times, r, q, ())
    found = sampled(now.law, r, V, Omega, R, q, point, _material_velocity(duals, times, point), ())
    return Followed(samples, stacked_slopes(found, times.size, count), np.empty((0, count)))


def _material_velocity(system: RollingSystem, times: Array, point: Vector) -> Vector:
    return system.support.motion.at(times).material_velocity(point)


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
