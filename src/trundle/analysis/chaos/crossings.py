"""Poincaré sections: the states of a motion where a condition holds, found as events are, to the last digits."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValueError, OutOfDomainError, SolverError
from ...mechanics import checks
from ...mechanics.system import State
from ...simulation import labels
from ...solve import methods
from ...solve.methods import Method
from ...solve.samples import Array, Event, Progress, Samples
from .asked import Asked
from .conditions import Condition
from .section import PoincareSection

if TYPE_CHECKING:
    import xarray

_A_JUMP = 1e-6  # of the largest value of the function: what is more at a zero has jumped across it at an event
_STEPS_OF_MOMENT = 4.0  # looks in the time in which the motion changes
_AT_ONCE = 20_000  # instants looked at together
_MOST = 20_000_000
_CLOSER = 9  # looks where the function all but reaches zero between two
_TRIES = 6
_ROUNDS = 80


def poincare_section(
    system: Any,
    section: Any = None,
    start: State | None = None,
    duration: Any = None,
    *,
    period: Any = None,
    way: str = "rising",
    every: Any = None,
    method: str = "auto",
    tolerance: float | None = None,
    progress: Progress | None = None,
) -> PoincareSection:
    """Return the states of a motion where a condition holds, or once in each period.

    The condition is looked for on the polynomials of the method's steps, and located like any event, to 1e-12.

    Parameters
    ----------
    system : RollingSystem, Scenario, str or path
        A system, a scenario, the name of one that ships, or a file.
    section : str or callable, optional
        ``"position.z rising through 10 mm"``, with any scalar quantity of a run's dataset, "rising", "falling" or
        "crossing"; a kind of event, such as ``"land"``, for the states just behind it; or a function that takes a
        dataset like `Trajectory.data` and returns a number for each instant, where that passes zero.
    start : State, optional
        Absent: the scenario's, or ``system.place()``.
    duration : float or quantity, optional
        How long to follow the motion, s; absent: as long as the scenario runs.
    period : float or quantity, optional
        Instead of a section: a stroboscope, once in each period of a support that moves in a periodic way, s.
    way : str
        Of a function: "rising", "falling" or "crossing".
    every : float or quantity, optional
        How closely it is looked, s; absent: four times in the time in which the motion changes. Two crossings that lie
        closer together are seen where the function turns round between them.
    method : str
        As for `simulate`.
    tolerance : float, optional
        Of the method; absent: its own.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    PoincareSection
        The states as a labelled dataset.

    Raises
    ------
    InvalidValueError
        If the section or a number is refused.
    UnknownNameError
        If there is no such quantity.
    SolverError
        If the motion cannot be followed.

    Examples
    --------
    >>> import trundle as tr
    >>> plane = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> rolling = plane.place(velocity=(0.5, 0.0))
    >>> section = tr.poincare_section(plane, "position.x rising through 25 cm", rolling, "2 s")
    >>> section.data.time.values.tolist()
    [0.5]
    """
    asked = Asked.of(system, start)
    length = asked.duration(duration)
    if (section is None) == (period is None):
        rule = "must be given, or `period` instead"
        raise InvalidValueError("section", rule, section, 'Write for instance "position.z rising through 0".')
    motion = PoincareMotion(asked, length, method, tolerance)
    if period is not None:
        step = float(checks.positive(period, "time", "period"))
        if step > length:
            raise InvalidValueError("period", f"must not be longer than the motion ({length:g} s)", period)
        return motion.strobed(step)
    return motion.crossings(Condition.of(section, asked.system, way), every, progress)


class PoincareMotion:
    """A motion that is gone through once, and read at any instants."""

    def __init__(self, asked: Asked, length: float, method: str, tolerance: float | None) -> None:
        self.asked, self.length = asked, length
        self.end = asked.start.time + length
        self.events: tuple[Event, ...] = ()  # seen so far
        self.method, self.dense = self._followed(method, tolerance)

    def _followed(self, method: str, tolerance: float | None) -> tuple[Method, Callable[[Array], Samples]]:
        system, start = self.asked.system, self.asked.start
        methods.check_tolerance(tolerance)
        if method == "auto":
            with suppress(OutOfDomainError):
                exact = Method.of("exact")
                known = exact.dense(system, start, self.end)
                known(np.array([start.time, self.end]))
                return exact, known
            method = "taylor" if system.support.surface.analytic else "runge-kutta"
        chosen = Method.of(methods.choose(method, system, start), tolerance)
        return chosen, chosen.dense(system, start, self.end)

    def strobed(self, step: float) -> PoincareSection:
        """Return the section once in each period."""
        count = int(self.length / step * (1 + 1e-12))
        samples = self.at(np.array(self.asked.start.time + step * np.arange(1, count + 1), dtype=float))
        return self.told(samples, np.zeros(samples.time.size), f"once in {step:.9g} s", 0)

    def crossings(self, condition: Condition, every: Any, progress: Progress | None = None) -> PoincareSection:
        """Return the section of a condition."""
        if condition.event:
            return self.told_of_events(condition)
        given = every is not None
        step = float(checks.positive(every, "time", "every")) if given else self.asked.moment / _STEPS_OF_MOMENT
        if self.length / step > _MOST:
            raise InvalidValueError("every", f"must leave at most {_MOST:,} looks", every, "Look less often.")
        return _crossings(self, condition, min(step, self.length / 20), progress)

    @property
    def last(self) -> State:
        """The state at the end of the motion, or at its last event where that ended it."""
        return self.at(np.array([self.asked.start.time, self.end])).state(-1)

    def at(self, times: Array) -> Samples:
        """Return the samples at ascending instants that the motion has come to, s."""
        samples = self.dense(times)
        if len(samples.events) > len(self.events):
            self.events = samples.events
        return samples.part(slice(0, min(times.size, samples.time.size)))

    def dataset(self, samples: Samples) -> xarray.Dataset:
        """Return samples with labels."""
        about = labels.attributes(self.asked.title, self.method)
        return labels.dataset(self.asked.system, samples, about)

    def value(self, condition: Condition, times: Array) -> Array:
        """Return the function at some instants; not a number behind the end of the motion."""
        assert condition.function is not None  # noqa: S101 (told apart by `event`)
        found = np.full(times.size, np.nan)
        samples = self.at(times)
        values = np.asarray(condition.function(self.dataset(samples)), dtype=float)
        if values.shape != samples.time.shape:
            rule = f"must return a number for each of the {samples.time.size} instants"
            raise InvalidValueError("section", rule, f"an array of shape {values.shape}")
        found[: values.size] = values
        return found

    def told(self, samples: Samples, residual: Array, condition: str, jumps: int) -> PoincareSection:
        """Return the section."""
        last = self.events[-1] if self.events else None
        final = last is not None and last.final
        data = self.dataset(samples)
        data["residual"] = (
            "time",
            residual,
            {"long_name": "what is left of the function of the section", "units": "1"},
        )
        length = last.time - self.asked.start.time if final and last is not None else self.length
        ended = last.text if final and last is not None else ""
        return PoincareSection(self.asked.title, condition, self.asked.system, length, ended, jumps, data)

    def told_of_events(self, condition: Condition) -> PoincareSection:
        """Return the states just behind the events of a kind."""
        import xarray

        self.at(np.array([self.asked.start.time, self.end]))
        found = [event for event in self.events if event.kind == condition.event and event.after is not None]
        facts = labels.facts(self.asked.system)
        arrays: dict[str, Any] = {
            name: np.array([getattr(event.after, name) for event in found], dtype=float).reshape(-1, size)
            for name, size in (("position", 3), ("velocity", 3), ("angular_velocity", 3), ("orientation", 4))
        }
        arrays["contact"] = np.array([event.contact for event in found], dtype=float).reshape(-1, 3)
        times = np.array([event.time for event in found])
        variables = {name: (*facts[name][:1], array, facts[name][1]) for name, array in arrays.items()}
        data = xarray.Dataset(variables, coords=labels.coordinates(times), attrs={"title": self.asked.title})
        empty = self.told(self.at(np.array([self.asked.start.time])).part(slice(0, 0)), np.zeros(0), "", 0)
        data["residual"] = ("time", np.zeros(times.size))
        return PoincareSection(
            self.asked.title, f"behind each {condition.event}", self.asked.system, empty.duration, empty.ended, 0, data
        )


def _crossings(motion: PoincareMotion, condition: Condition, step: float, progress: Progress | None) -> PoincareSection:
    """Look for where the function passes zero, and locate each place."""
    begin, count = motion.asked.start.time, int(np.ceil(motion.length / step))
    edges = np.linspace(begin, motion.end, count + 1)
    lows, highs, largest = [], [], 0.0
    for first in range(0, count, _AT_ONCE):
        times = edges[first : first + _AT_ONCE + 1]
        values = motion.value(condition, times)
        for _ in range(_TRIES):
            looks = times.size
            times, values = _closer(motion, condition, times, values)
            if times.size == looks:
                break
        known = np.isfinite(values)
        largest = max(largest, float(np.abs(values[known]).max(initial=0.0)))
        here = np.flatnonzero(_passes(values[:-1], values[1:], condition.way))
        lows += list(zip(times[here], values[here], strict=True))
        highs += list(zip(times[here + 1], values[here + 1], strict=True))
        if progress is not None:
            progress(min(1.0, (first + _AT_ONCE) / count))
        if not known.all():
            break
    if largest == 0.0 and not lows:
        raise SolverError(f"The function of the section is zero throughout ({condition.text}): it is no section.")
    instants, left = _located(motion, condition, np.array(lows).reshape(-1, 2), np.array(highs).reshape(-1, 2))
    share = left / max(largest, 1e-300)
    sound = share <= _A_JUMP
    samples = motion.at(instants[sound])
    return motion.told(samples, share[sound], condition.text, int((~sound).sum()))


def _passes(before: Array, behind: Array, way: str) -> Any:
    with np.errstate(invalid="ignore"):
        rises, falls = (before < 0) & (behind >= 0), (before > 0) & (behind <= 0)
    return rises if way == "rising" else falls if way == "falling" else rises | falls


def _closer(motion: PoincareMotion, condition: Condition, times: Array, values: Array) -> tuple[Array, Array]:
    """Look more closely where the function turns round near zero between two looks."""
    sizes = np.abs(values)
    with np.errstate(invalid="ignore", divide="ignore"):
        alike = (np.sign(values[:-2]) == np.sign(values[1:-1])) & (np.sign(values[1:-1]) == np.sign(values[2:]))
        turns = alike & (sizes[1:-1] <= sizes[:-2]) & (sizes[1:-1] <= sizes[2:])
        bend = values[:-2] - 2 * values[1:-1] + values[2:]
        lowest = values[1:-1] - (values[2:] - values[:-2]) ** 2 / (8 * bend)
        near = turns & (lowest * np.sign(values[1:-1]) <= 0.1 * sizes[1:-1])
    if not near.any():
        return times, values
    spots = np.flatnonzero(near) + 1
    inner = np.linspace(0.0, 1.0, _CLOSER + 2)[1:-1]
    pairs = [(times[i - 1], times[i]) for i in spots] + [(times[i], times[i + 1]) for i in spots]
    more = np.concatenate([low + (high - low) * inner for low, high in pairs])
    together = np.union1d(times, more)
    return together, motion.value(condition, together)


def _located(motion: PoincareMotion, condition: Condition, lows: Array, highs: Array) -> tuple[Array, Array]:
    """Locate the zero between each two instants, all at once: false position that halves the end which stays."""
    a, fa, b, fb = *lows.T, *highs.T
    if not a.size:
        return np.zeros(0), np.zeros(0)
    best = np.where(np.abs(fa) < np.abs(fb), a, b)
    left = np.minimum(np.abs(fa), np.abs(fb))
    side = np.zeros(a.size)
    for turn in range(_ROUNDS):
        with np.errstate(divide="ignore", invalid="ignore"):
            middle = b - fb * (b - a) / (fb - fa)
        middle = np.where(np.isfinite(middle) & (middle > a) & (middle < b) & (turn % 8 != 7), middle, 0.5 * (a + b))
        open_ = (b - a > 2 * np.spacing(np.abs(b))) & (left > 0) & (middle > a) & (middle < b)
        if not open_.any():
            break
        f = np.full(a.size, np.nan)
        f[open_] = motion.value(condition, middle[open_])
        better = open_ & (np.abs(f) < left)
        best, left = np.where(better, middle, best), np.where(better, np.abs(f), left)
        same = np.sign(f) == np.sign(fa)
        up, down = open_ & same, open_ & ~same
        fb = np.where(up & (side == 1), 0.5 * fb, fb)
        fa = np.where(down & (side == -1), 0.5 * fa, fa)
        a, fa = np.where(up, middle, a), np.where(up, f, fa)
        b, fb = np.where(down, middle, b), np.where(down, f, fb)
        side = np.where(up, 1.0, np.where(down, -1.0, side))
    order = np.argsort(best)
    return best[order], left[order]
