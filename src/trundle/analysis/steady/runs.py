"""What runs of the system itself say of a nudge: the flow's slope by differences of whole runs."""

from __future__ import annotations

import numpy as np

from ...errors import SolverError
from ...solve import methods
from ...solve.samples import Event
from .finding import Relative
from .flow import WIDTHS, Array, Flow, differences
from .modes import Reduced, fastest, modes_of
from .symmetry import TURN, group_matrix

_LONGEST = 2.0  # time constants for which a nudged run goes on
_GOOD = 1e-8  # agreement that smaller nudges need not better


def carried(flow: Flow, y: Array, times: Array) -> tuple[Array, Event | None]:
    """Return the states that a run passes through while it rolls, in the frame of the flow, and what ends that."""
    method = methods.Method.of(methods.choose("taylor", flow.system, flow.state(y)))
    run = method.solve(flow.system, flow.state(y), flow.time + times)
    states = np.hstack([run.contact, run.orientation, run.angular_velocity]).T
    if len(times) and np.sum(states[3:7, 0] * y[3:7]) < 0 and times[0] == 0:
        states[3:7] = -states[3:7]
    end = run.events[0] if run.events else None
    if end is not None:
        states = states[:, : np.searchsorted(flow.time + times, end.time)]
    for i, t in enumerate(times[: states.shape[1]]):
        back = group_matrix(-flow.turning * t * TURN)[:10, :10]
        states[:, i] = back @ states[:, i]
    return states, end


def carried_to(flow: Flow, y: Array, time: float) -> Array:
    """Return the state to which a run leads, in the frame of the flow."""
    states, end = carried(flow, y, np.array([time]))
    if end is not None:
        raise does_not_return(end)
    return states[:, 0]


def does_not_return(end: Event) -> SolverError:
    """Return what to say of a run that rolls no more before it can be compared with its start."""
    return SolverError(f"The motion does not come back: it {end.text}.")


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
            end = move @ np.append(carried_to(flow, flow.put_back(state), time), 1.0)
            ends.append(_same_sheet(end[:10], sheet))
        return np.stack(ends, axis=1)

    return differences(after, y, directions, rough=rough, wide=wide)


def reference(flow: Flow, y: Array, time: float, move: Array) -> Array:
    """Return where a run is after a time, brought back by a move."""
    return np.asarray((move @ np.append(carried_to(flow, y, time), 1.0))[:10])


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
    end = carried(flow, y, np.array([time]))[1]
    if end is not None:  # as at a rim: while all of them still roll
        time = 0.5 * (end.time - flow.time)
    back = group_matrix(-time * relative.shares)
    nudges = flow.scale[:, None] * reduced.basis
    expected, least = expm(time * reduced.matrix), np.inf
    for wide in WIDTHS:  # where the law bends strongly a nudge must be small
        moved = slope_of_run(flow, y, nudges, time, back, wide=wide) / flow.scale[:, None]
        least = min(least, float(np.abs(reduced.basis.T @ moved - expected).max() / np.abs(expected).max()))
        if least < _GOOD:
            break
    return least
