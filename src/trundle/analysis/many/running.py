"""Many members of one system in one call: initial states and parameters varied, one dataset over member and time."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValueError, TrundleError
from ...mechanics.finiteness import check_finite, varies
from ...mechanics.kinks import has_kinks
from ...mechanics.overlap import fits_anywhere
from ...mechanics.parameters import parameters, structure_of
from ...mechanics.system import RollingSystem, State
from ...simulation import labels
from ...simulation.memory import check_room
from ...simulation.simulate import are_states, check_start, check_state, described, simulate
from ...solve import taylor
from ...solve.ensemble import numbers_of
from ...solve.laws import RollingLaw
from ...solve.methods import Method
from ...solve.samples import Event, Progress, Samples
from ...solve.sampling import MOST_SAMPLES, check_clock, sample_times
from ...solve.transitions import PhaseStart
from ...solve.walls import reach, slack
from ...units import UNITS
from .on_device import ERROR, OnDevice, check_device

if TYPE_CHECKING:
    import xarray

    from ...simulation.trajectory import Trajectory
    from ...solve.ensemble import Block

_LOOKS = 17  # at each member, at most
ENDED = -1  # the phase of a member whose run is over


def simulate_many(
    systems: RollingSystem | Sequence[RollingSystem],
    starts: State | Sequence[State],
    duration: Any,
    every: Any,
    *,
    workers: int | None = 1,
    progress: Progress | None = None,
    known: Mapping[str, Any] | None = None,
    title: str = "",
    device: str | None = None,
) -> xarray.Dataset:
    """Run many members of one system and return them as one dataset over member and time.

    Members go through Taylor's method eight at a time, phase by phase: those that roll, slip, fly or rest are each
    taken together. A straight roller, and members with a formula that has kinks in the time, are run by `simulate` one
    by one: the result is the same either way to rounding, only slower.

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
    known : mapping of str to sequence, optional
        What else you know of the members, one value for each, such as the seeds that they were drawn with.
    title : str
        For figures and files.
    device : str, optional
        "gpu" or "cpu": members that roll all the way go through DOP853 in JAX there, thousands at a time, and each has
        an `error`; absent: Taylor's method.

    Returns
    -------
    xarray.Dataset
        The variables of `Trajectory.data` over `member` and `time`. Coordinates over `member` are every number in which
        the systems differ, as "body.radius" with its unit, the starts, as "start.position", and what is `known`; the
        attribute `scenario` is the first member as a scenario file. For each member there are `end`, the time its run
        reached, `events`, how many there were, `ending`, what ended it early, or nothing, and `reason`, the same in
        words. After its end a member is NaN, its phase −1. Its events and its card are, to rounding, those of
        `simulate` for that member alone. Where `simulate` would refuse a member, its ending is "refused", and where it
        would break down, "failed": such a member is NaN throughout, and the others are what they are without it.

    Raises
    ------
    InvalidValueError
        If the systems are not of one structure, the starts not at one time, or there would be too many samples: what
        is wrong with the call, not with one member.

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
    instants = sample_times(duration, every)
    _check(systems, starts, instants.size, every, workers)
    check_clock(systems[0], starts[0], float(instants[1]))
    told = {**varied(systems), **_of_starts(systems[0], starts), **_checked(known or {}, len(systems))}
    where = None if device is None else check_device(device)
    result = run_members(systems, starts, duration, every, workers=workers, progress=progress, where=where)
    title, scenario = _described(systems[0], starts[0], result.times, title)
    method = Method.of("taylor") if where is None else Method("runge-kutta", ERROR)
    return result.dataset(told, labels.attributes(title, method) | {"scenario": scenario})


def run_members(
    systems: Sequence[RollingSystem],
    starts: Sequence[State],
    duration: Any,
    every: Any,
    *,
    method: str = "auto",
    workers: int | None = 1,
    progress: Progress | None = None,
    where: Any = None,
    unrolled: bool = False,
) -> Runs:
    """Run as many systems as starts, of one structure and at one time, and return their arrays.

    By "auto" and "taylor" they go as `simulate_many` says; by any other method of `simulate` each goes alone. Unrolled
    loops are worth their compilation where thousands follow.
    """
    times = starts[0].time + sample_times(duration, every)
    result = Runs(systems[0], len(systems), times, progress)
    rest: Iterable[int] = range(len(systems))
    if method in ("auto", "taylor"):
        method = "taylor" if systems[0].support.surface.analytic else "runge-kutta"
        if _batched(systems[0]) and (where is not None or taylor.available()):
            rest = _together(result, systems, starts, times, workers, where, unrolled)
    for member in rest:
        result.put_alone(member, systems[member], starts[member], duration, every, method)
    return result


def varied(systems: Sequence[RollingSystem]) -> dict[str, Any]:
    """Return the numbers in which systems of one structure differ, each a labelled coordinate over the members.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane())
    >>> balls = [tr.RollingSystem(tr.Body.solid_sphere(a, 0.1), table) for a in (0.1, 0.2)]
    >>> [(name, values.tolist()) for name, (_, values, _) in varied(balls).items()]
    [('body.radius', [0.1, 0.2])]
    """
    if all(system is systems[0] for system in systems):
        return {}
    values = np.array(numbers_of(systems))
    return {
        name: (("member",), column, {"units": UNITS[dimension][0] or "1"})
        for (name, dimension), column in zip(parameters(systems[0]), values.T, strict=True)
        if not (column == column[0]).all()
    }


def _of_starts(system: RollingSystem, starts: list[State]) -> dict[str, Any]:
    """Return the starts as labelled coordinates over the members."""
    found: dict[str, Any] = {}
    for name, size, unit in _START:
        dims = ("member", "axis" if size == 3 else "quaternion")
        found[f"start.{name}"] = (dims, _column([getattr(start, name) for start in starts], size), {"units": unit})
    names, kinds = labels.coordinate_names(system), system.support.motion.coordinate_kinds
    coordinates = _column([start.support for start in starts], len(names))
    for name, kind, column in zip(names, kinds, coordinates.T, strict=True):
        found[f"start.{name}"] = (("member",), column, {"units": UNITS[kind][0]})
    return found


def _column(rows: list[Any], size: int) -> Any:
    """Return an array of as many numbers for each member; not a number where a start has others."""
    with suppress(TypeError, ValueError):
        array = np.array(rows, dtype=float)
        if array.shape == (len(rows), size):
            return array
    return np.full((len(rows), size), np.nan) if len(rows) == 1 else np.vstack([_column([row], size) for row in rows])


_START = (("position", 3, "m"), ("velocity", 3, "m s-1"), ("angular_velocity", 3, "rad s-1"), ("orientation", 4, "1"))


def _checked(known: Mapping[str, Any], members: int) -> dict[str, Any]:
    """Return what else is known of the members as coordinates."""
    for name, values in known.items():
        if np.ndim(values) != 1 or len(values) != members:
            raise InvalidValueError(f"known[{name!r}]", f"must have a value for each of the {members} members", values)
    return {name: (("member",), np.asarray(values)) for name, values in known.items()}


def _described(system: RollingSystem, start: State, times: Any, title: str) -> tuple[str, str]:
    """Return title and TOML text of a member, if it can be put down at all."""
    try:
        return described(system, start, times, "auto", title)
    except InvalidValueError:
        return title, ""


def _members(systems: Any, starts: Any) -> tuple[list[RollingSystem], list[State]]:
    """Return as many systems as starts."""
    many_systems = [systems] if isinstance(systems, RollingSystem) else listed(systems, "systems", RollingSystem)
    many_starts = [starts] if isinstance(starts, State) else listed(starts, "starts", State)
    if len(many_systems) == 1:
        many_systems *= len(many_starts)
    if len(many_starts) == 1:
        many_starts *= len(many_systems)
    if len(many_systems) != len(many_starts):
        rule = f"must be one, or as many as the systems, {len(many_systems)}"
        raise InvalidValueError("starts", rule, len(many_starts))
    return many_systems, many_starts


def listed(values: Any, key: str, kind: type) -> list[Any]:
    """Return a list of one or more things of one kind."""
    found = list(values) if isinstance(values, Iterable) else [values]
    for i, value in enumerate(found):
        if not isinstance(value, kind):
            raise InvalidValueError(f"{key}[{i}]", f"must be a {kind.__name__}", value)
    if not found:
        raise InvalidValueError(key, "must have at least one member", values)
    return found


def check_structures(systems: list[RollingSystem]) -> None:
    """Refuse systems that are not made of the same parts."""
    first = structure_of(systems[0])
    for i, system in enumerate(systems):
        if system is not systems[0] and structure_of(system) != first:
            remedy = "Members differ in numbers only; run other bodies, supports or loads in another call."
            raise InvalidValueError(f"systems[{i}]", "must be made of the same parts as systems[0]", system, remedy)


def _check(systems: list[RollingSystem], starts: list[State], instants: int, every: Any, workers: int | None) -> None:
    check_structures(systems)
    if not (isinstance(starts[0].time, (int, float)) and math.isfinite(starts[0].time)):
        raise InvalidValueError("starts[0].time", "must be a finite number, s", starts[0].time)
    for i, start in enumerate(starts):
        if start.time != starts[0].time:
            raise InvalidValueError(f"starts[{i}].time", f"must be that of starts[0], {starts[0].time:g} s", start.time)

    def fewer(most: int) -> str:
        each = max(most // len(systems), 2)
        return f"ask each of the {len(systems):,} members for {each:,} instants or fewer, or part the members"

    if len(systems) * instants > MOST_SAMPLES:
        rule, count = f"must leave at most {MOST_SAMPLES:,} samples of all members together", len(systems) * instants
        raise InvalidValueError("every", rule, every, f"It makes {count:,}; {fewer(MOST_SAMPLES)}.")
    check_room(len(systems) * instants, labels.size_of(systems[0]), "every", every, fewer)
    if workers is not None and (not isinstance(workers, int) or workers < 1):
        raise InvalidValueError("workers", "must be a whole number, 1 or more, or None", workers)


def _batched(system: RollingSystem) -> bool:
    """Tell whether members of such a system can be taken many at a time.

    A straight roller is checked one by one, and each member comes to a kink of its own formulas at its own instant.
    """
    alone = system.body.shape.axis is not None or has_kinks(system)
    return system.support.surface.analytic and not alone


def _together(
    result: Runs,
    systems: Sequence[RollingSystem],
    starts: Sequence[State],
    times: Any,
    workers: int | None,
    device: Any,
    unrolled: bool,
) -> list[int]:
    """Run many members at a time, on a device or by heyoka, and return those that are left."""
    from ...solve import ensemble

    sound = _sound(systems, starts, times)  # `simulate` says what is wrong with the others
    if not sound:
        return list(range(len(systems)))
    found, plainly = ensemble.rolling_from([systems[i] for i in sound], [starts[i] for i in sound])
    states = np.full((len(systems), found.shape[1]), np.nan)
    states[sound] = found
    simple = [plainly[row] and not (systems[i].resisted or systems[i].corners) for row, i in enumerate(sound)]
    rolling = [i for i, rolls in zip(sound, simple, strict=True) if rolls]
    left = set(range(len(systems)))
    tolerance = taylor.TOLERANCE if device is None else ERROR
    if rolling and device is not None:
        stopped, errors = OnDevice(systems, states, times, device).follow(rolling, result.put)
        result.error = np.full(len(systems), np.nan)
        result.error[rolling] = errors
        result.error[stopped] = np.nan
        left -= set(rolling).difference(stopped)
    if taylor.available():
        rolls = {i: PhaseStart(RollingLaw(), starts[i], states[i].tolist()) for i in rolling if i in left}
        left -= _by_heyoka(result, systems, starts, times, rolls, left.intersection(sound), workers, unrolled)
    return sorted(left | _through_walls(result, systems, left, tolerance))


def _by_heyoka(
    result: Runs,
    systems: Sequence[RollingSystem],
    starts: Sequence[State],
    times: Any,
    rolls: dict[int, PhaseStart],
    which: set[int],
    workers: int | None,
    unrolled: bool,
) -> set[int]:
    """Run members many at a time, of which some are known to roll, and return those that are done."""
    from ...solve import ensemble

    begins: dict[int, State | PhaseStart] = {**rolls}
    for i in which.difference(rolls):
        if _passes(check_start, systems[i], starts[i], float(times[-1])):
            begins[i] = starts[i]
    if not begins:
        return set()
    count = min(workers or ensemble.cores(), -(-len(begins) // ensemble.LANES))
    _, events = ensemble.integrate(systems, begins, times, result.put, workers=count, unrolled=unrolled)
    result.put_events(events)
    return set(events)


def _through_walls(result: Runs, systems: Sequence[RollingSystem], left: set[int], tolerance: float) -> set[int]:
    """Return members, of those that are done, of which a part is below the surface in a sample: each is run alone."""
    found, of = set[int](), dict[int, list[int]]()
    for member, system in enumerate(systems):
        if member not in left:
            of.setdefault(id(system), []).append(member)
    for members in of.values():
        system = systems[members[0]]
        if not fits_anywhere(system):
            whose, samples = result.looks(members)
            found.update(whose[reach(system, samples) > slack(tolerance)].tolist())
    if result.error is not None:
        result.error[list(found)] = np.nan
    return found


def _sound(systems: Sequence[RollingSystem], starts: Sequence[State], times: Any) -> list[int]:
    """Return the members of which start and formulas in the time are numbers, throughout the run."""
    finite: dict[int, bool] = {}  # of each system, once
    for system in systems if varies(systems[0]) else ():
        if id(system) not in finite:
            finite[id(system)] = _passes(check_finite, system, float(times[0]), float(times[-1]))
    plain = are_states(systems[0], starts)
    pairs = [(i, system, starts[i]) for i, system in enumerate(systems) if finite.get(id(system), True)]
    return [i for i, system, start in pairs if plain or _passes(check_state, system, start)]


def _passes(check: Callable[..., None], *given: Any) -> bool:
    try:
        check(*given)
    except InvalidValueError:
        return False
    return True


class Runs:
    """The arrays of all members, filled as the members come in; `happened` holds (kind, time) of each one's events."""

    def __init__(self, system: RollingSystem, members: int, times: Any, progress: Progress | None) -> None:
        self.times, self.progress = times, progress
        self.facts, self.coordinate_names = labels.facts(system), labels.coordinate_names(system)
        sizes = {"time": times.size, "axis": 3, "quaternion": 4}
        self.arrays = {
            name: np.full(
                (members, *(sizes[dim] for dim in dims)),
                ENDED if name == "phase" else np.nan,
                dtype=np.int8 if name == "phase" else np.float64,
            )
            for name, (dims, _) in self.facts.items()
        }
        self.end = np.full(members, float(times[-1]))
        self.events = np.zeros(members, dtype=np.int32)
        self.ending, self.reason = (np.full(members, "", dtype=object) for _ in range(2))
        self.happened: list[list[tuple[str, float]]] = [[] for _ in range(members)]
        self.error: Any = None
        self.done, self.told, self.lock = np.zeros(members), 0.0, threading.Lock()

    def put(self, block: Block) -> None:
        """Take members that rolled through some of the instants."""
        for name, values in labels.columns(block.system, block.samples).items():
            self.arrays[name][block.members, block.rows] = values
        self._tell(block.members, (block.rows + 1) / self.times.size)

    def put_events(self, happened: Mapping[int, tuple[Event, ...]]) -> None:
        """Take what happened to members that were followed together, and where their runs ended."""
        for member, events in happened.items():
            if not events:
                continue
            last = events[-1]
            self.events[member] = len(events)
            self.happened[member] = [(event.kind, event.time) for event in events]
            if last.final:
                self.end[member], self.ending[member], self.reason[member] = last.time, last.kind, last.text
        self._tell(list(happened), 1.0)

    def looks(self, members: Sequence[int]) -> tuple[Any, Samples]:
        """Return some samples of some members, evenly from the first to the last that each has, and whose they are."""
        counts = (self.arrays["phase"][members] != ENDED).sum(axis=1)
        evenly = [np.unique(np.linspace(0, count - 1, _LOOKS).astype(int)) for count in counts if count]
        which = [member for member, count in zip(members, counts, strict=True) if count]
        whose, rows = np.repeat(which, [each.size for each in evenly]), np.concatenate([*evenly, np.zeros(0, int)])
        names = [field.name for field in fields(Samples) if field.name in self.arrays]
        known = {name: self.arrays[name][whose, rows] for name in names}
        support = [self.arrays[name][whose, rows] for name in self.coordinate_names]
        coordinates = np.stack(support, axis=1) if support else np.zeros((rows.size, 0))
        return whose, Samples(self.times[rows], **known, support_coordinates=coordinates)

    def put_alone(
        self, member: int, system: RollingSystem, start: State, duration: Any, every: Any, method: str
    ) -> None:
        """Run one member by itself, through all its phases; what `simulate` has against it becomes its ending."""
        run, refused = None, None
        try:
            run = simulate(system, start, duration, every, method=method, scenario="")
        except InvalidValueError as error:
            key = error.key.replace("start", f"starts[{member}]", 1) if error.key.startswith("start") else error.key
            refused = "refused", str(InvalidValueError(key, error.rule, error.received, error.remedy))
        except TrundleError as error:
            refused = "failed", str(error)
        except (ArithmeticError, ValueError) as error:  # a load of somebody's own divides by nothing, for one
            refused = "failed", f"{type(error).__name__}: {error}"
        for name, array in self.arrays.items():  # it may have come some way with others
            array[member] = ENDED if name == "phase" else np.nan
        if refused is not None:
            self.end[member], (self.ending[member], self.reason[member]) = np.nan, refused
        if run is not None:
            self._take(member, run)
        self._tell(member, 1.0)

    def _take(self, member: int, run: Trajectory) -> None:
        """Take a run that a member made by itself."""
        reached = run.data.time.values  # the last may be the instant of the event that ended it, between two samples
        count = min(reached.size, self.times.size)
        kept = int((reached[:count] == self.times[:count]).sum())
        for name, array in self.arrays.items():
            array[member, :kept] = run.data[name].values[:kept]
        self.end[member], self.events[member] = reached[-1], len(run.events)
        self.happened[member] = [(event.kind, event.time) for event in run.events]
        if run.events and reached[-1] < self.times[-1]:
            self.ending[member], self.reason[member] = run.events[-1].kind, run.events[-1].text

    def _tell(self, members: Any, share: Any) -> None:
        with self.lock:
            self.done[members] = share
            self.told = max(self.told, float(self.done.mean()))
            if self.progress is not None:
                self.progress(self.told)

    def dataset(self, told: dict[str, Any], attributes: dict[str, Any]) -> xarray.Dataset:
        """Return all members as one dataset, with what is told of them."""
        import pandas as pd
        import xarray

        phase = self.facts["phase"][1]
        phase["flag_values"] = np.append(phase["flag_values"], np.int8(ENDED))
        phase["flag_meanings"] += " ended"
        variables = {name: (("member", *dims), self.arrays[name], said) for name, (dims, said) in self.facts.items()}
        about = {
            "end": (("member",), self.end, {"long_name": "time that the run reached", "units": "s"}),
            "events": (("member",), self.events, {"long_name": "events on the way", "units": "1"}),
            "ending": (("member",), self.ending, {"long_name": "what ended the run early"}),
            "reason": (("member",), self.reason, {"long_name": "what ended the run early, in words"}),
        }
        if self.error is not None:
            said = "error, as a share of the largest of a kind; NaN: run by itself, by Taylor's method"
            about["error"] = (("member",), self.error, {"long_name": said, "units": "1"})
        coordinates = {**labels.coordinates(self.times), "member": pd.RangeIndex(self.end.size), **told}
        return xarray.Dataset({**variables, **about}, coords=coordinates, attrs=attributes)


__all__ = ["simulate_many"]
