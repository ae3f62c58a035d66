"""Dormand and Prince's Runge-Kutta method of order 8: every platform, and the check on Taylor's method.

SciPy takes the steps; where there are many, and numba is installed, a compiled loop goes on with them.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Protocol

import numpy as np

from ..errors import SolverError
from ..mechanics.duals import Dual, has_duals, slopes_of, values_of
from ..mechanics.system import RollingSystem, State
from . import corners, phases
from .compiled_steps import LOOKS, LOW, CompiledDOP853, StuckError, available, places
from .dense import Keep, Leg, TooMany
from .laws import Law
from .patience import Patience
from .phases import Integrate, Segment, cut
from .roots import root
from .samples import AT_ONCE, Array, Progress, Samples
from .tracing import PythonLaw, python_law
from .transitions import PhaseStart, ZeroCrossing

TOLERANCE = 1e-12
FINEST = 1e-13  # SciPy's own limit is 2e-14
_ASIDE = 1e-12  # s
_SERIES = np.linalg.inv(np.polynomial.chebyshev.chebvander(2 * places() - 1, LOOKS - 1))  # of what goes through them
_SURELY = 10.0  # times its last two coefficients that the polynomial is off at most
_BLUR = 0.05  # share of a step within which a polynomial through these finds where a stop is lowest
_SINGULAR = ("curved", "edge", "end", "jam")  # stops at which a law is singular
_ALL_BUT = 1e-3  # share of what was left of such a stop at first
_PATIENCE: dict[str, Any] = {"steps": 1e7, "spare": 5e3, "name": "The Runge-Kutta method"}  # an hour, and seconds
_CLOSE = 1e-9  # share of the time by which a step may begin before an instant at which the law is singular
_BRIEF = 1e5  # steps of a law that mostly holds for an instant only: some seconds
_LOOSELY = 1e-5  # share of what a step has gone, to which a loose stop is looked for
_FIRST_STEP = 1e-12  # s
_OF_A_VECTOR = 1e-3  # share of a vector's size that no error of a part of it is smaller than
_OF_A_BRIEF = 0.03  # the same of a law that works slopes out by differences: less is their rounding
_STABLE = 3.0  # times as long as what dies out takes: half of where the method becomes unstable
_RATES = 15  # evaluations of the law in a step of SciPy's
OF_A_STEP = 12_500.0  # products that take as long as a step of the compiled loop, whatever the law
_OF_SCIPY = 5e5  # products that take as long as a step of SciPy's, without the law
_TOO_MANY_IN_SERIES = 10_000  # steps of series, from where brief laws were handed on: a second
_BEGINNING = 20  # steps, after which one sees how many there will be
_GROWING = 1.5  # times as long as the last one: then the next will be longer yet
WORTH_THE_LOOP = 1000.0  # steps of SciPy's, which take about as long as to import numba


@dataclass
class Taken:
    """What a run has come through: steps of each law one by one."""

    steps: Counter[type[Law]] = field(default_factory=Counter)
    in_series: int = 0  # steps by series from where a brief law was handed on to them
    handed_on: bool = False  # whether the last stretch was one of a brief law

    @property
    def too_soon(self) -> bool:
        """Whether brief laws seem to have been handed on too soon: series took long from there on."""
        return self.in_series > _TOO_MANY_IN_SERIES

    def worth_the_loop(self, law: Law, stepper: Any) -> bool:
        """Take account of a step of a law, and tell whether there have been many, or many seem to come.

        While steps grow nothing is known.
        """
        self.steps[type(law)] += 1
        done, coming = self.steps[type(law)], (stepper.t_bound - stepper.t) / stepper.h_abs
        seen = done >= _BEGINNING and stepper.h_abs <= _GROWING * stepper.step_size
        return done > WORTH_THE_LOOP or (seen and WORTH_THE_LOOP < coming < _most_steps(law))

    def copy(self) -> Taken:
        """Return another that goes on from here."""
        return Taken(Counter(self.steps), self.in_series)


class Path(Protocol):
    """Steps, and the polynomials through them."""

    @property
    def t_old(self) -> float:
        """When they begin."""

    @property
    def t(self) -> float:
        """When they end."""

    @property
    def count(self) -> int:
        """How many they are."""

    @property
    def plain(self) -> bool:
        """Whether it is known that no event function comes near zero in them."""

    def __call__(self, times: Any) -> Array:
        """Return the states at an instant, (variables,), or some, (variables, n)."""


@dataclass(frozen=True)
class _OneStep:
    """A step of SciPy's, or none, where a run begins."""

    t_old: float
    t: float
    polynomial: Callable[[Any], Array]
    count: int = 1
    plain: bool = False

    def __call__(self, times: Any) -> Array:
        return self.polynomial(times)


def solve(
    system: RollingSystem, start: State, times: Array, tolerance: float = TOLERANCE, progress: Progress | None = None
) -> Samples:
    """Integrate the laws of contact and return the states at the given times; every event is located as it happens.

    Examples
    --------
    >>> import trundle as tr
    >>> slope = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), tilt=0.1))
    >>> x = solve(slope, slope.place(), np.array([1.0])).position[0, 0]
    >>> print(round(x / (9.80665 * np.sin(0.1) / 2), 9))  # (5/7) g sin α
    0.714285714
    """
    return phases.solve(partial(integrate, taken=Taken()), system, start, times, tolerance, progress)


def integrate(
    system: RollingSystem,
    now: PhaseStart,
    times: Array,
    tolerance: float,
    progress: Progress | None = None,
    taken: Taken | None = None,
) -> Iterator[Segment]:
    """Follow one law to its first stop, given what the run has come through before."""
    # It counts from where the law begins to hold: far from 0 no step would be short enough.
    end = float(times[-1]) - now.time if times.size else 0.0
    rows = _Rows(times - now.time, len(now.state_vector))
    for piece in _integrated(system, now, rows, end, tolerance, progress, taken):
        here, times = times[: piece.times.size], times[piece.times.size :]
        if piece.stop is None:
            yield replace(piece, times=here)
            continue
        stop = replace(piece.stop, time=now.time + piece.stop.time)
        before, _ = cut(here, stop.time)
        yield Segment(before, piece.states[: before.size], stop)


def keeping() -> tuple[Keep, Callable[[], Integrate]]:
    """Return the way through all stretches of one run that keeps the polynomials of their steps, and one beside it."""
    taken = Taken()
    return partial(dense, taken=taken), lambda: partial(integrate, taken=taken.copy())


def dense(
    system: RollingSystem, now: PhaseStart, end: float, tolerance: float, most: int, taken: Taken | None = None
) -> Leg | TooMany:
    """Follow one law to its first stop, and keep the polynomial of each step."""
    paths = _Paths(np.asarray(now.state_vector, dtype=float), most)

    def work() -> float:
        each = python_law(system, now.law).work * (_RATES + LOOKS)
        by_scipy = sum(isinstance(path, _OneStep) * path.count for path in paths.paths)
        return by_scipy * (_OF_SCIPY + each) + (paths.count - by_scipy) * OF_A_STEP

    try:
        *_, last = _integrated(system, now, paths, end - now.time, tolerance, None, taken)
    except _TooManyError:
        time = now.time + paths.reached
        begins = now.time + paths.when
        return TooMany(lambda times: paths.at(times - now.time), paths.count, work(), begins, time, paths.last)
    stop = None if last.stop is None else replace(last.stop, time=now.time + last.stop.time)
    return Leg(lambda times: paths.at(times - now.time), stop, paths.count, work(), now.time + paths.when)


def first_steps(system: RollingSystem, now: PhaseStart, end: float, tolerance: float, count: int) -> float:
    """Return how long its steps are after the first few, which are too short, s; ∞ where there are not so many."""
    paths = _Paths(np.asarray(now.state_vector, dtype=float), count)
    with suppress(_TooManyError):
        _ = list(_integrated(system, now, paths, end - now.time, tolerance, None))
        return math.inf
    return (paths.reached - paths.begins[count // 2]) / (len(paths.begins) - count // 2)


def _traced(system: RollingSystem, now: PhaseStart) -> PythonLaw:
    """Return a law as it begins to hold on plain numbers."""
    given = (*now.event_parameters, *corners.directions(system, now))
    return python_law(system, now.law, given, now.time, now.state_vector)


def _integrated(
    system: RollingSystem,
    now: PhaseStart,
    rows: _Rows | _Paths,
    end: float,
    tolerance: float,
    progress: Progress | None,
    taken: Taken | None = None,
) -> Iterator[Segment]:
    """Follow one law to its first stop; all times count from its beginning."""
    taken = Taken() if taken is None else taken
    law, begin, traced = now.law, now.time, _traced(system, now)
    y0 = np.asarray(now.state_vector, dtype=float)
    end = max(end, float(np.spacing(begin)))  # some way to go

    def stops(since: float, y: Array) -> Array:
        try:
            return np.array(traced.event_functions(begin + since, y.tolist()))
        except (ArithmeticError, ValueError):
            return np.full(len(traced.names), np.nan)

    longest = _longest_step(system, begin)
    patience = Patience(begin, begin + end, **_PATIENCE | {"steps": _most_steps(law)})
    try:
        at = law.unpack(system, begin, y0)
        least = tolerance * _scale(y0, at.arm, at.scale(system), _OF_A_BRIEF if law.brief else _OF_A_VECTOR)
        least[y0.size - law.unwatched :] = np.inf

        def onward(since: float, y: Array, until: float) -> Iterator[Path]:
            paths = _paths(law, traced, begin, since, y, until, tolerance, least, taken, longest)
            return _watched(paths, patience, progress, begin)

        # What is briefly followed is handed on: no finer than the clock shows its end.
        nearest = max(1e-300, 0.5 * math.ulp(begin)) if law.brief else 1e-300
        yield from _follow(onward, y0, end, rows, stops, traced.names, law.handed_on, nearest)
    except StuckError as stuck:
        raise SolverError(_broken(stuck, begin)) from None
    except (ZeroDivisionError, ValueError, OverflowError) as error:
        raise SolverError(f"The Runge-Kutta method broke down on the way to t = {begin + end:g} s: {error}.") from None


def _watched(paths: Iterable[Path], patience: Patience, progress: Progress | None, begin: float) -> Iterator[Path]:
    """Give steps on as long as patience lasts, and tell how far they have led."""
    for path in paths:
        patience.after(path.count, begin + path.t)
        yield path
        if progress is not None:
            progress(begin + path.t)


def _paths(
    law: Law,
    traced: PythonLaw,
    begin: float,
    t: float,
    y: Array,
    end: float,
    tolerance: float,
    least: Array,
    taken: Taken,
    longest: float,
) -> Iterator[Path]:
    """Take steps to the end; those of a law that is stiff, and the first of any other, one by one."""
    from scipy.integrate import DOP853, Radau

    given: dict[str, Any] = {"rtol": tolerance, "atol": least}

    def rates(since: float, y: Array) -> Array:
        try:
            return np.array(traced.rates(begin + since, y.tolist()))
        except (ArithmeticError, ValueError):  # a trial beyond the end of a formula: a shorter step stays before it
            return np.full(y.size, np.nan)

    if law.stiff(y):
        # Its first steps must be as short as the law is stiff: across a jump of direction there are other solutions.
        stiff = Radau(rates, t, y, end, first_step=min(_FIRST_STEP, end - t), **given)
        yield from _one_by_one(stiff, lambda: not law.stiff(stiff.y))
        t, y = float(stiff.t), stiff.y
    if t < end:
        if law.lasts < end - t:
            given["first_step"] = law.lasts
        with np.errstate(over="ignore", invalid="ignore"):  # of a first step that is tried
            stepper = DOP853(rates, t, y, end, max_step=longest, **given)
        enough = partial(taken.worth_the_loop, law, stepper)
        compiles = traced.compiled is not None and available()
        yield from _one_by_one(stepper, lambda: enough() and compiles)
        if stepper.status == "running" and traced.compiled is not None:
            yield from CompiledDOP853(traced.compiled(), stepper, begin, tolerance, least, longest)


def _longest_step(system: RollingSystem, time: float) -> float:
    """Return how long a step may be beside a bearing that ends an axle's turning, s.

    At steps that its dying out alone would let grow an explicit method is all but unstable, and leaves the rate
    trembling by a ten-millionth of what it was.
    """
    motion = system.support.motion
    if not motion.free:
        return math.inf
    motion = values_of(motion) if has_duals(motion) else motion
    still = (*[0.0] * (len(motion.coordinates) - 1), Dual(0.0, (1.0,)))
    damped = -slopes_of(motion.axle_torque(time, still), 1)[0] / motion.inertia
    return _STABLE / damped if damped > 0 else math.inf


def _one_by_one(stepper: Any, until: Callable[[], bool]) -> Iterator[Path]:
    """Take steps of SciPy's to the end, or to where it is said after one that they are enough."""
    while stepper.status == "running":
        with np.errstate(over="ignore", invalid="ignore"):  # of a step that is refused, or ends in words
            message = stepper.step()
        if stepper.status == "failed" or not np.isfinite(stepper.y).all():
            raise StuckError(float(stepper.t), stepper.y.copy(), message or "The rates are no longer finite.")
        yield _OneStep(float(stepper.t_old), float(stepper.t), stepper.dense_output())
        if until():
            return


def _most_steps(law: Law) -> float:
    """Return how many steps of a law are waited for at most."""
    return _BRIEF if law.brief else float(_PATIENCE["steps"])


def _scale(y0: Array, arm: float, speed: float, share: float) -> Array:
    """Return against what an error of each number is small or not: its own size, or a share of its vector's.

    What begins is small, not its rate's rounding: that is a share of the body's size, and of all accelerations at hand.
    """
    place, turning = max(_size(y0[:3]), arm), max(_size(y0[7:10]), 0.1 * speed / arm)
    rest = max(1e-3 * _size(y0[10:]), 0.1 * share * speed)
    least = [*[share * place] * 3, *[1.0] * 4, *[share * turning] * 3, *[rest] * y0.size]
    return np.maximum(np.abs(y0), least[: y0.size])


def _size(part: Array) -> float:
    return float(np.abs(part).max(initial=0.0))


def _follow(
    onward: Callable[[float, Array, float], Iterator[Path]],
    y0: Array,
    end: float,
    rows: _Rows | _Paths,
    stops: Any,
    names: tuple[str, ...],
    handed_on: tuple[str, ...],
    nearest: float,
) -> Iterator[Segment]:
    """Go along steps to the end or the first stop; states are read off the steps' own polynomials."""
    yield from rows.take(_OneStep(0.0, 0.0, lambda t: np.tile(y0[:, None], t.size), count=0))
    loose = frozenset(i for i, name in enumerate(names) if name in handed_on)
    first, paths = stops(0.0, y0), onward(0.0, y0, end)
    try:
        while (path := next(paths, None)) is not None:
            found = None if path.plain else _first_stop(path, stops, nearest, loose)
            if found is not None and names[found[1]] in _SINGULAR and found[0] > path.t_old + _CLOSE * found[0]:
                # A step across an instant at which the law is singular says little of the way there.
                halfway, y = 0.5 * (path.t_old + found[0]), path(np.array([path.t_old]))[:, 0]
                for nearer in onward(path.t_old, y, halfway):
                    yield from rows.take(nearer)
                    y = nearer(np.array([nearer.t]))[:, 0]
                paths = onward(halfway, y, end)
                continue
            yield from rows.take(path, before=None if found is None else found[0])
            if found is not None:
                yield rows.rest(ZeroCrossing(found[0], names[found[1]], path(found[0])))
                return
    except StuckError as stuck:
        near = _singular(names, stops(stuck.t, stuck.y), first)
        if near is None:
            raise
        yield rows.rest(ZeroCrossing(stuck.t, near, stuck.y), before=stuck.t)
        return
    yield rows.rest(None)


class _Rows:
    """The states at some times, filled in as the steps pass them, and given on in blocks."""

    def __init__(self, times: Array, size: int) -> None:
        self.times, self.begun, self.done = times, 0, 0
        self.states = np.empty((min(times.size, AT_ONCE), size))

    def take(self, path: Path, before: float | None = None) -> Iterator[Segment]:
        """Fill in the states up to where steps end, or before a stop in them, and yield each block that is full."""
        right = np.searchsorted(self.times, path.t, side="right")
        upto = int(right if before is None else np.searchsorted(self.times, before, side="left"))
        while self.done < upto:
            if self.done - self.begun == len(self.states):
                yield self.rest(None)
            some = min(upto, self.begun + len(self.states))
            self.states[self.done - self.begun : some - self.begun] = path(self.times[self.done : some]).T
            self.done = some

    def rest(self, stop: ZeroCrossing | None, before: float = np.inf) -> Segment:
        """Return what has not been given on: the last row is always in it."""
        times, _ = cut(self.times[self.begun : self.done], before)
        states, self.begun, self.states = self.states[: times.size], self.done, np.empty_like(self.states)
        return Segment(times, states, stop)


class _TooManyError(Exception):
    """More steps than are kept."""


class _Paths:
    """The polynomials of all steps, in place of states at some times."""

    def __init__(self, y0: Array, most: int) -> None:
        self.y0, self.most, self.count = y0, most, 0
        self.begins: list[float] = []
        self.paths: list[Path] = []

    def take(self, path: Path, before: float | None = None) -> Iterator[Segment]:  # noqa: ARG002
        """Keep some more."""
        self.count += path.count
        self.begins.append(path.t_old)
        self.paths.append(path)
        if self.count > self.most:
            raise _TooManyError
        yield from ()

    @property
    def when(self) -> Array:
        """When the steps begin."""
        return np.concatenate([np.linspace(path.t_old, path.t, path.count, endpoint=False) for path in self.paths])

    @property
    def reached(self) -> float:
        """How far they lead."""
        return self.paths[-1].t

    @property
    def last(self) -> Array:
        """The state there."""
        return self.paths[-1](np.array([self.reached]))[:, 0]

    def rest(self, stop: ZeroCrossing | None, before: float = np.inf) -> Segment:  # noqa: ARG002
        """Return the stop alone."""
        return Segment(np.empty(0), np.empty((0, self.y0.size)), stop)

    def at(self, times: Array) -> Array:
        """Return the states at some times."""
        which = np.maximum(np.searchsorted(self.begins, times, side="right") - 1, 0)
        states = np.empty((times.size, self.y0.size))
        for i in np.unique(which):
            states[which == i] = self.paths[i](times[which == i]).T
        return states


def nearly_singular(system: RollingSystem, now: PhaseStart, time: float, y: Array) -> bool:
    """Tell whether a law, followed to a state, has all but come to an end at which it is singular."""
    traced = _traced(system, now)
    first, there = (np.array(traced.event_functions(*at)) for at in ((now.time, now.state_vector), (time, y.tolist())))
    return _singular(traced.names, there, first) is not None


def _singular(names: tuple[str, ...], values: Array, first: Array) -> str | None:
    """Return the end at which the law is singular that it has all but come to: no step leads nearer."""
    shares = {
        name: value / begin
        for name, value, begin in zip(names, values, first, strict=True)
        if name in _SINGULAR and begin > 0
    }
    nearest = min(shares, key=lambda name: shares[name], default=None)
    return nearest if nearest is not None and shares[nearest] < _ALL_BUT else None


def _broken(stuck: StuckError, begin: float) -> str:
    """Say when and where the method broke down."""
    near = ", ".join(f"{part:.6g}" for part in stuck.y[:3])
    why = stuck.why.rstrip(".")
    return (
        f"The Runge-Kutta method broke down at t = {begin + stuck.t:.9g} s, near ({near}) m on the support: {why}. "
        "Look for a surface, a body or a load that is not smooth there."
    )


def _first_stop(
    path: Path, stops: Any, nearest: float = 1e-300, loose: frozenset[int] = frozenset()
) -> tuple[float, int] | None:
    """Return the first instant in a step at which a stop falls through zero, also where it rises again at once.

    Of a loose one, about where it falls from one look to the next.
    """
    looks = path.t_old + (path.t - path.t_old) * places()
    looks[-1] = path.t
    values = np.array([stops(t, y) for t, y in zip(looks, path(looks).T, strict=True)])
    if not values.size:
        return None
    falls, low = ((values[:-1] >= 0) & (values[1:] < 0)).any(axis=0), np.fmin.reduce(values) < LOW * np.ptp(values, 0)
    found: tuple[float, int] | None = None

    def at(which: int, t: float) -> float:
        value, aside = float(stops(t, path(t))[which]), 0.0
        while math.isnan(value) and aside < _ASIDE:  # just on the corner of a load, where it has no direction
            aside = max(4 * aside, 4 * float(np.spacing(t)))
            value = float(stops(t + aside, path(t + aside))[which])
        return value

    # Those that seem to come first are looked for first: of what comes later no more is asked.
    for which in sorted(np.flatnonzero(falls | low).tolist(), key=lambda which: _about(looks, values[:, which])):
        before = np.inf if found is None else found[0]
        if which in loose:
            fall = _loose_fall(partial(at, which), looks, values[:, which], before)
        else:
            fall = _fall(partial(at, which), looks, values[:, which], before, nearest)
        if fall is not None:
            found = fall, which
    return found if found is None else _first_of(found, at, stops(found[0], path(found[0])), looks, values, nearest)


def _first_of(
    found: tuple[float, int],
    at: Callable[[int, float], float],
    there: Array,
    looks: Array,
    values: Array,
    nearest: float,
) -> tuple[float, int]:
    """Return a stop, or one that fell through zero before it and is below zero there, if it is at no look.

    Friction gives way before a body lifts off; a look beyond that sees it hold again, for (μN)² grows on both sides.
    """
    last = int(np.searchsorted(looks, found[0])) - 1  # of the looks before it
    for which in np.flatnonzero((there < 0) & (values[last] >= 0)).tolist() if last >= 0 else ():
        if which != found[1] and at(which, found[0]) < 0:
            found = root(partial(at, which), looks[last], found[0], nearest), which
    return found


def _about(looks: Array, values: Array) -> float:
    """Return about when a function falls through zero: on the line between two looks; infinite where it does not."""
    first = int(np.argmax((values[:-1] >= 0) & (values[1:] < 0)))
    high, fell = values[first], values[first + 1]
    return float(np.interp(0.0, [fell, high], [looks[first + 1], looks[first]])) if high >= 0 > fell else np.inf


def _fall(
    function: Callable[[float], float], looks: Array, values: Array, before: float, nearest: float
) -> float | None:
    """Return where a function first falls through zero before an instant, given it at Chebyshev's points of a step."""
    falls = np.flatnonzero((values[:-1] >= 0) & (values[1:] < 0))
    inside = values[: falls[0] + 1] if falls.size else values
    # What lies between the looks is hardly lower than the lowest of them, beside how much they differ.
    if np.nanmin(inside, initial=np.inf) < LOW * np.ptp(values) and (inside >= 0).all():
        upto = min(before, looks[falls[0]]) if falls.size else before
        for low in _minima(function, looks, values, upto):
            if function(low) < 0:
                return _sooner(function, looks[np.searchsorted(looks, low) - 1], low, before, nearest)
    if not falls.size:
        return None
    first = int(falls[0])
    return _sooner(function, looks[first], looks[first + 1], before, nearest)


def _loose_fall(function: Callable[[float], float], looks: Array, values: Array, before: float) -> float | None:
    """Return about where a function falls through zero from one look to the next, if it is before an instant."""
    falls = np.flatnonzero((values[:-1] >= 0) & (values[1:] < 0))
    if not falls.size:
        return None
    begin, end = looks[falls[0]], looks[falls[0] + 1]
    return _sooner(function, begin, end, before, _LOOSELY * (end - looks[0]))


def _sooner(
    function: Callable[[float], float], begin: float, end: float, before: float, nearest: float
) -> float | None:
    """Return where a function falls through zero between two instants, if it is before a third."""
    if begin >= before or (end > before and function(before) >= 0):
        return None
    return root(function, begin, min(end, before), nearest)


def _minima(function: Callable[[float], float], looks: Array, values: Array, before: float) -> list[float]:
    """Return where a function may be below zero between its looks, in order: where the polynomial through them is low.

    It is as far from the function as its last coefficients are large, about: these become smaller by about one factor.
    """
    from numpy.polynomial import chebyshev
    from scipy.optimize import minimize_scalar

    series = _SERIES @ values
    slope = chebyshev.chebder(series)
    roots = chebyshev.chebroots(np.trim_zeros(slope, "b")) if slope.any() else np.empty(0)
    level = np.sort(roots.real[(np.abs(roots.imag) < _BLUR) & (np.abs(roots.real) < 1)])
    clear = chebyshev.chebval(level, series) > _SURELY * np.abs(series[-2:]).sum()
    rises = chebyshev.chebval(level, chebyshev.chebder(slope)) > 0
    begin, end = looks[0], looks[-1]
    found = []
    for middle in 0.5 * (begin + end) + 0.5 * (end - begin) * level[rises & ~clear]:
        bounds = max(begin, middle - _BLUR * (end - begin)), min(end, middle + _BLUR * (end - begin))
        options = {"xatol": 1e-9 * (end - begin)}
        if bounds[0] < before:
            found.append(float(minimize_scalar(function, bounds=bounds, method="bounded", options=options).x))
    return [low for low in found if low < before]
