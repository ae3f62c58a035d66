"""Many members of one system in one call: initial states and parameters varied, one dataset over member and time."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import labels
from .errors import InvalidValueError, SolverError, TrundleError
from .mechanics.parameters import structure_of
from .mechanics.system import RollingSystem, State
from .simulation import simulate
from .solve import taylor
from .solve.methods import Method
from .solve.samples import Progress
from .solve.sampling import MOST_SAMPLES, check_clock, sample_times

if TYPE_CHECKING:
    import xarray

    from .solve.ensemble import Block

ENDED = -1  # the phase of a member whose run is over


def simulate_many(
    systems: RollingSystem | Sequence[RollingSystem],
    starts: State | Sequence[State],
    duration: Any,
    every: Any,
    *,
    workers: int | None = 1,
    progress: Progress | None = None,
) -> xarray.Dataset:
    """Run many members of one system and return them as one dataset over member and time.

    Members that roll all the way go through Taylor's method eight at a time. A member that starts in another phase, or
    comes to an event, is run by `simulate` instead, phase by phase: the result is the same either way, only slower.

    Parameters
    ----------
    systems : RollingSystem or sequence of RollingSystem
        One for each member, or one for all. They may differ in their numbers, not in what they are made of.
    starts : State or sequence of State
        One for each member, or one for all; all at the same time.
    duration : float or quantity
        Length of the runs, s.
    every : float or quantity
        Step between samples, s; the end is always sampled.
    workers : int, optional
        Threads; None: as many as there are processors.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    xarray.Dataset
        The variables of `Trajectory.data` over `member` and `time`, and for each member `end`, the time its run
        reached, `events`, how many there were, and `ending`, what ended it early, or nothing. After its end a member
        is NaN, its phase −1. Its events and its card are those of `simulate` for that member alone.

    Raises
    ------
    InvalidValueError
        If the systems are not of one structure, or a start is refused; the message names the member.
    SolverError
        If a member breaks down.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin("33.3 rpm"))
    >>> balls = [tr.RollingSystem(tr.Body.solid_sphere(a, 0.1), table) for a in (0.01, 0.02, 0.03)]
    >>> runs = tr.simulate_many(balls, [ball.place((0.1, 0.0)) for ball in balls], duration=1.0, every=0.5)
    >>> dict(runs.position.sizes)
    {'member': 3, 'time': 3, 'axis': 3}
    """
    systems, starts = _members(systems, starts)
    since = sample_times(duration, every)
    check_clock(systems[0], starts[0], float(since[1]))
    times = starts[0].time + since
    _check(systems, starts, times.size, workers)
    result = _Result(len(systems), times, progress)
    rest = _rolled(result, systems, starts, times, workers) if _batched(systems[0]) else range(len(systems))
    for member in rest:
        result.put_alone(member, systems[member], starts[member], duration, every)
    return result.dataset()


def _members(systems: Any, starts: Any) -> tuple[list[RollingSystem], list[State]]:
    """Return as many systems as starts."""
    many_systems = [systems] if isinstance(systems, RollingSystem) else _listed(systems, "systems", RollingSystem)
    many_starts = [starts] if isinstance(starts, State) else _listed(starts, "starts", State)
    if len(many_systems) == 1:
        many_systems *= len(many_starts)
    if len(many_starts) == 1:
        many_starts *= len(many_systems)
    if len(many_systems) != len(many_starts):
        rule = f"must be one, or as many as the systems, {len(many_systems)}"
        raise InvalidValueError("starts", rule, len(many_starts))
    return many_systems, many_starts


def _listed(values: Any, key: str, kind: type) -> list[Any]:
    found = list(values) if isinstance(values, Iterable) else [values]
    for i, value in enumerate(found):
        if not isinstance(value, kind):
            raise InvalidValueError(f"{key}[{i}]", f"must be a {kind.__name__}", value)
    if not found:
        raise InvalidValueError(key, "must have at least one member", values)
    return found


def _check(systems: list[RollingSystem], starts: list[State], instants: int, workers: int | None) -> None:
    first = structure_of(systems[0])
    for i, system in enumerate(systems):
        if system is not systems[0] and structure_of(system) != first:
            remedy = "Members differ in numbers only; run other bodies, supports or loads in another call."
            raise InvalidValueError(f"systems[{i}]", "must be made of the same parts as systems[0]", system, remedy)
    for i, start in enumerate(starts):
        if start.time != starts[0].time or len(start.support) != len(starts[0].support):
            rule = f"must be at the time of starts[0], {starts[0].time:g} s, with as many support coordinates"
            raise InvalidValueError(f"starts[{i}]", rule, start)
    if len(systems) * instants > MOST_SAMPLES:
        rule = f"must leave at most {MOST_SAMPLES:,} samples of all members together"
        most = max(MOST_SAMPLES // len(systems), 2)
        remedy = f"Ask each of the {len(systems):,} members for {most:,} instants or fewer, or part the members."
        raise InvalidValueError("every", rule, f"{len(systems) * instants:,}", remedy)
    if workers is not None and (not isinstance(workers, int) or workers < 1):
        raise InvalidValueError("workers", "must be a whole number, 1 or more, or None", workers)


def _batched(system: RollingSystem) -> bool:
    """Tell whether heyoka can take members of such a system eight at a time.

    Resistances that bring a body to rest make nearly every run an event; a straight roller is checked one by one.
    """
    resisted = any(load.stops for load in system.loads)
    return taylor.available() and system.support.surface.analytic and not resisted and system.body.shape.axis is None


def _rolled(
    result: _Result, systems: list[RollingSystem], starts: list[State], times: Any, workers: int | None
) -> list[int]:
    """Run the members that roll, and return those that are left."""
    from .solve import ensemble

    states, rolls = ensemble.rolling_from(systems, starts)
    members = np.flatnonzero(rolls).tolist()
    count = min(workers or ensemble.cores(), -(-len(members) // ensemble.LANES) or 1)
    stopped = ensemble.integrate(systems, states, members, times, result.put, workers=count) if members else []
    return sorted([*np.flatnonzero(~rolls).tolist(), *stopped])


class _Result:
    """The arrays of all members, filled as the members come in."""

    def __init__(self, members: int, times: Any, progress: Progress | None) -> None:
        self.members, self.times, self.progress = members, times, progress
        self.template: xarray.Dataset | None = None
        self.arrays: dict[str, Any] = {}
        self.end = np.full(members, float(times[-1]))
        self.events = np.zeros(members, dtype=np.int32)
        self.ending = np.full(members, "", dtype=object)
        self.done, self.lock = 0, threading.Lock()

    def put(self, block: Block) -> None:
        """Take the members of a block that rolled to the end."""
        data = labels.dataset(block.system, block.samples, {})
        count = block.members.size
        with self.lock:
            self._begin_with(data)
            for name, array in self.arrays.items():
                values = data[name].values
                array[block.members] = values.reshape(-1, count, *values.shape[1:]).swapaxes(0, 1)
            self._tell(count)

    def put_alone(self, member: int, system: RollingSystem, start: State, duration: Any, every: Any) -> None:
        """Run one member by itself, through all its phases."""
        method = "taylor" if system.support.surface.analytic else "runge-kutta"
        try:
            run = simulate(system, start, duration, every, method=method, scenario="")
        except InvalidValueError as error:
            key = error.key.replace("start", f"starts[{member}]", 1) if error.key.startswith("start") else error.key
            raise InvalidValueError(key, error.rule, error.received, error.remedy) from None
        except TrundleError as error:
            raise SolverError(f"Member {member}: {error}") from None
        reached = run.data.time.values  # the last may be the instant of the event that ended it, between two samples
        count = min(reached.size, self.times.size)
        kept = int((reached[:count] == self.times[:count]).sum())
        with self.lock:
            self._begin_with(run.data)
            for name, array in self.arrays.items():
                array[member, :kept] = run.data[name].values[:kept]
            self.end[member] = reached[-1]
            self.events[member] = len(run.events)
            if run.events and reached[-1] < self.times[-1]:
                self.ending[member] = run.events[-1].kind
            self._tell(1)

    def _begin_with(self, data: xarray.Dataset) -> None:
        """Make room, once it is known which variables there are."""
        if self.template is not None:
            return
        self.template = data
        for name, variable in data.data_vars.items():
            shape, kind = (self.members, self.times.size, *variable.shape[1:]), variable.dtype
            self.arrays[str(name)] = np.full(shape, ENDED if kind.kind == "i" else np.nan, dtype=kind)

    def _tell(self, count: int) -> None:
        self.done += count
        if self.progress is not None:
            self.progress(self.done / self.members)

    def dataset(self) -> xarray.Dataset:
        """Return all members as one dataset."""
        import pandas as pd
        import xarray

        assert self.template is not None  # noqa: S101  there is at least one member
        facts = {name: (self.template[name].dims, dict(self.template[name].attrs)) for name in self.arrays}
        phase = facts["phase"][1]
        phase["flag_values"] = np.append(phase["flag_values"], np.int8(ENDED))
        phase["flag_meanings"] += " ended"
        variables = {name: (("member", *facts[name][0]), array, facts[name][1]) for name, array in self.arrays.items()}
        about = {
            "end": (("member",), self.end, {"long_name": "time that the run reached", "units": "s"}),
            "events": (("member",), self.events, {"long_name": "events on the way", "units": "1"}),
            "ending": (("member",), self.ending, {"long_name": "event that ended the run early"}),
        }
        template = self.template
        coordinates: dict[str, Any] = {name: template[name] for name in ("axis", "quaternion")}
        time = (("time",), pd.Index(self.times), {"long_name": "time", "units": "s", "axis": "T"})
        coordinates |= {"member": pd.RangeIndex(self.members), "time": time}
        attributes = {"Conventions": "CF-1.11", **labels.attributes("", Method.of("taylor"))}
        return xarray.Dataset({**variables, **about}, coords=coordinates, attrs=attributes)


__all__ = ["simulate_many"]
