"""What runs of the system itself say of a nudge: the flow's slope by differences of whole runs."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...solve import methods
from .finding import Relative
from .flow import WIDTHS, Array, Flow, differences
from .modes import Reduced, fastest, modes_of
from .symmetry import TURN, group_matrix

_LONGEST = 2.0  # time constants for which a nudged run goes on
_GOOD = 1e-8  # agreement that smaller nudges need not better


def carried(flow: Flow, y: Array, times: Any) -> Array:
    """Return the states that a run passes through, in the frame of the flow."""
    method = methods.Method.of(methods.choose("taylor", flow.system, flow.state(y)))
    instants = np.atleast_1d(np.asarray(times, dtype=float))
    run = method.solve(flow.system, flow.state(y), flow.time + instants)
    states = np.hstack([run.contact, run.orientation, run.angular_velocity]).T
    if len(instants) and np.sum(states[3:7, 0] * y[3:7]) < 0 and instants[0] == 0:
        states[3:7] = -states[3:7]
    for i, t in enumerate(instants):
        back = group_matrix(-flow.turning * t * TURN)[:10, :10]
        states[:, i] = back @ states[:, i]
    return states if np.ndim(times) else states[:, 0]


def slope_of_run(
    flow: Flow,
    y: Array,
    directions: Array,
    time: float,
    move: Array,
    *,
    rough: bool = False,
    wide: float = WIDTHS[0],
) -> Array:
    """Return how nudges have moved on after a time, seen after a finite move that brings the run back."""
    sheet = reference(flow, y, time, move)

    def after(states: Array) -> Array:
        ends = []
        for state in states.T:
            end = move @ np.append(carried(flow, flow.put_back(state), time), 1.0)
            ends.append(_same_sheet(end[:10], sheet))
        return np.stack(ends, axis=1)

    return differences(after, y, directions, rough=rough, wide=wide)


def reference(flow: Flow, y: Array, time: float, move: Array) -> Array:
    """Return where a run is after a time, brought back by a move."""
    return np.asarray((move @ np.append(carried(flow, y, time), 1.0))[:10])


def _same_sheet(y: Array, other: Array) -> Array:
    """Return the state with that sign of its quaternion which is nearer to another's."""
    if float(np.sum(y[3:7] * other[3:7])) < 0:
        y = y.copy()
        y[3:7] = -y[3:7]
    return y


def check(relative: Relative, reduced: Reduced) -> float:
    """Return how far nudged runs are from what the linear law says of them, as a share."""
    from scipy.linalg import expm

    flow, y = relative.flow, relative.y
    time = _LONGEST / max(fastest(modes_of(reduced, flow.rate)), 0.2 * flow.rate)
    back = group_matrix(-time * relative.shares)
    nudges = flow.scale[:, None] * reduced.basis
    expected, least = expm(time * reduced.matrix), np.inf
    for wide in WIDTHS:  # where the law bends strongly a nudge must be small
        moved = slope_of_run(flow, y, nudges, time, back, wide=wide) / flow.scale[:, None]
        least = min(least, float(np.abs(reduced.basis.T @ moved - expected).max() / np.abs(expected).max()))
        if least < _GOOD:
            break
    return least
