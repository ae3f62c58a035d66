"""A motion gone through once from its start to the end of a period, with its slopes by the start and by a number."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import InvalidValueError, SolverError, UnknownNameError
from ...mechanics.duals import Dual, slopes_of, value_of
from ...mechanics.parameters import numbers, parameters, with_numbers
from ...mechanics.system import RollingSystem, State
from ...solve.contact_state import ContactState
from ...solve.samples import FLIGHT, Array
from ...solve.transitions import PhaseStart
from ...units import UNITS
from ..sensitivities.following import VariationalRun
from ..steady.symmetry import COUNT, group_matrix, moved_by
from .asked import integrator, scale_of
from .tangents import beginning, tangents
from .volume import slopes_at

Period = float | Callable[[RollingSystem], Any]
_ASKS = (0.0, 0.371, 0.713)  # shares of a period at which the law is asked whether it knows the time
_KNOWS, _RANK = 1e-11, 1e-7


@dataclass(frozen=True)
class Move:
    """A shift and a turn that change nothing that matters, by which a motion is brought back after a period."""

    rows: Array  # (k, 9): the symmetries, of which it is made, as shares
    matrix: Array  # (11, 11), on (p, q, Ω, 1)

    @classmethod
    def none(cls) -> Move:
        """Return what leaves everything where it is."""
        return cls(np.zeros((0, COUNT)), np.eye(11))

    def onward(self, shares: Array) -> Move:
        """Return it with a little more of each symmetry."""
        return Move(self.rows, group_matrix(shares @ self.rows) @ self.matrix) if len(self.rows) else self

    @property
    def turned(self) -> float:
        """By how much all has turned about the support's axis in a period, rad, to within whole turns."""
        return float(np.arctan2(-self.matrix[1, 0], self.matrix[0, 0])) + 0.0


@dataclass(frozen=True)
class Returned:
    """What has become of a start after a period, in units of the scale."""

    start: State  # from where
    phase: PhaseStart  # how it starts
    scale: Array  # (size,): what is large of each number of the state
    basis: Array  # (size, d): of what may be different at the start
    end: Array  # (size,): the state there, brought back
    residual: Array  # (d,): how far it is from the start, along the basis
    monodromy: Array  # (d, d): how differences at the start are there
    flow: Array  # (d,): how fast it moves there, for a period one unit of time longer
    by_number: Array  # (d,): how it changes with the number of the system that is varied
    by_number_at_start: Array  # (size,): how the state at the start changes with it, to stay on the support
    events: int  # on the way
    move: Move  # by which the end has been brought back
    symmetric: Array  # (d, k): how the end goes with a little more of each symmetry

    @property
    def essential(self) -> Array:
        """The monodromy without the directions along symmetries, which only say where the motion is."""
        if not self.symmetric.size:
            return self.monodromy
        U, sizes, _ = np.linalg.svd(self.symmetric, full_matrices=True)
        across = U[:, int((sizes > _RANK * max(float(sizes.max()), 1e-300)).sum()) :]
        return np.asarray(across.T @ self.monodromy @ across)

    @property
    def numbers(self) -> Array:
        """The state at the start in units of the scale."""
        return np.array(self.phase.state_vector, dtype=float) / self.scale


def number_of(system: RollingSystem, name: str) -> tuple[int, float, str]:
    """Return which of a system's numbers has a name, its value and its SI unit.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05)
    >>> number_of(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), table), "support.tilt")[1:]
    (0.05, 'rad')
    """
    known = parameters(system)
    names = [one.name for one in known]
    if name not in names:
        raise UnknownNameError("number of the system", str(name), names)
    i = names.index(name)
    return i, numbers(system)[i], UNITS[known[i].dimension][0] or "1"


def with_number(system: RollingSystem, which: int, value: Any) -> RollingSystem:
    """Return a system with another value of one of its numbers."""
    values: list[Any] = list(numbers(system))
    values[which] = value
    return with_numbers(system, values)


def put_down(system: RollingSystem, like: PhaseStart, values: Array, time: float) -> State:
    """Return the state that is meant by numbers of a law that are a little off: on the support, with |q| = 1."""
    at = like.law.unpack(system, time, values)
    if like.law.code == FLIGHT:
        return at.state
    at = ContactState.of(system, at.state).over(0.0)
    return like.law.unpack(system, time, like.law.state_vector(at)).state


def knows_the_time(system: RollingSystem, now: PhaseStart, period: float) -> bool:
    """Tell whether a law is another at other times."""
    times = now.time + period * np.array(_ASKS)
    states = np.tile(np.array(now.state_vector, dtype=float), (times.size, 1))
    slopes = slopes_at(system, now.law, times, states)
    largest = max(float(np.abs(slopes[:, :, :-1]).max()), 1e-300)
    return bool(np.abs(slopes[:, :, -1]).max() > _KNOWS * largest)


def go_round(
    system: RollingSystem,
    start: State,
    period: Period,
    which: int | None,
    tolerance: float | None,
    rate: float,
    move: Move,
) -> Returned:
    """Follow a start through a period with its slopes.

    Parameters
    ----------
    system, start : RollingSystem, State
        From where.
    period : float or callable
        s; or what it is of a system.
    which : int or None
        The number of the system that is varied.
    tolerance : float or None
        Of the method.
    rate : float
        A rate at which the motion changes, 1/s.
    move : Move
        What is done with the end before it is compared with the start.
    """
    now = beginning(system, start)
    at = ContactState.of(system, start)
    scale = scale_of(system, now.law, at.arm, rate)
    basis = tangents(system, now, scale)
    count = basis.shape[1] + (which is not None)
    duals = system
    if which is not None:
        duals = with_number(system, which, Dual(numbers(system)[which], (*(0.0,) * basis.shape[1], 1.0)))
    length = period(duals) if callable(period) else period
    own = _by_number_at_start(duals, now, count) if which is not None else np.zeros(scale.size)
    rows = np.hstack([scale[:, None] * basis, own[:, None]])[:, :count]
    seeds: Any = [Dual(float(y), tuple(row)) for y, row in zip(now.state_vector, rows.tolist(), strict=True)]
    end = start.time + float(value_of(length))
    integrate, error = integrator(system, "auto", tolerance, start.time, end)
    run = VariationalRun(integrate, system, np.array([end]), duals, replace(now, state_vector=seeds), count)
    samples = run.solve(start, error, None)
    if samples.events and samples.events[-1].final:
        raise SolverError(f"The motion {samples.events[-1].text}, before the period is over: it does not come back.")
    law, _, state = run.here
    if type(law) is not type(now.law):
        raise SolverError("The period ends in another phase than it began: begin at another instant of the motion.")
    values = np.array([float(value_of(one)) for one in state])
    slopes = np.array([slopes_of(one, count) for one in state], dtype=float)
    if len(move.rows):
        values = (move.matrix @ np.append(values, 1.0))[:-1]
        slopes = move.matrix[:-1, :-1] @ slopes
    if values[3:7] @ np.array(now.state_vector[3:7]) < 0:  # the same orientation
        values[3:7], slopes[3:7] = -values[3:7], -slopes[3:7]
    flow = np.array([float(part) for part in law.rates(system, end, values.tolist())])
    symmetric = np.zeros((basis.shape[1], len(move.rows)))
    for i, row in enumerate(move.rows):
        symmetric[:, i] = basis.T @ (moved_by(row, values) / scale)
    by_number = np.zeros(basis.shape[1])
    if which is not None:
        longer = float(slopes_of(length, count)[-1])
        by_number = basis.T @ ((slopes[:, -1] + flow * longer - own) / scale)
    return Returned(
        start,
        now,
        scale,
        basis,
        values,
        basis.T @ ((values - np.array(now.state_vector, dtype=float)) / scale),
        basis.T @ (slopes[:, : basis.shape[1]] / scale[:, None]),
        basis.T @ (flow / scale),
        by_number,
        own / scale,
        len(samples.events),
        move,
        symmetric,
    )


def _by_number_at_start(duals: RollingSystem, now: PhaseStart, count: int) -> Array:
    """Return how the numbers of a start change with a number of the system, so that it stays where it may be."""
    at = ContactState.of(duals, now.start)
    if now.law.code != FLIGHT:
        at = at.over(0.0)
    return np.array([float(slopes_of(one, count)[-1]) for one in now.law.state_vector(at)])


def checked_period(period: Any, system: RollingSystem) -> Period:
    """Return a period as it is used, or say what is wrong with it."""
    from ...mechanics import checks

    if callable(period):
        found = value_of(period(system))
        if not (isinstance(found, (int, float)) and np.isfinite(found) and found > 0):
            raise InvalidValueError("period", "must return a time above 0, s", found)
        return period
    if period is None:
        remedy = "Give that of the support, or about how long the motion takes to come back."
        raise InvalidValueError("period", "must be given", period, remedy)
    return float(checks.positive(period, "time", "period"))
