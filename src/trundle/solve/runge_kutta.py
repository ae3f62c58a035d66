"""Dormand and Prince's Runge-Kutta method of order 8, by SciPy: every platform, and the check on Taylor's method."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ..errors import SolverError
from ..mechanics.system import RollingSystem, State
from . import corners, phases
from .dense import Keep, Leg, TooMany
from .patience import Patience
from .phases import Integrate, Segment, cut
from .roots import root
from .samples import AT_ONCE, Array, Progress, Samples
from .tracing import python_law
from .transitions import PhaseStart, ZeroCrossing

TOLERANCE = 1e-12
FINEST = 1e-13  # SciPy's own limit is 2e-14
_ASIDE = 1e-12  # s
_LOOKS = 8  # at the stops in each step
_PLACES = -np.cos(np.pi * np.arange(_LOOKS) / (_LOOKS - 1))  # Chebyshev's points, from −1 to 1
_SERIES = np.linalg.inv(np.polynomial.chebyshev.chebvander(_PLACES, _LOOKS - 1))  # of the polynomial through them
_SURELY = 10.0  # times its last two coefficients that the polynomial is off at most
_LOW = 0.5  # share of how much its looks differ: where all are higher, a stop is nowhere near zero between them
_BLUR = 0.05  # share of a step within which a polynomial through these finds where a stop is lowest
_SINGULAR = ("curved", "edge", "end", "jam")  # stops at which a law is singular
_ALL_BUT = 1e-3  # share of what was left of such a stop at first
_PATIENCE: dict[str, Any] = {"steps": 1e7, "spare": 5e3, "name": "The Runge-Kutta method"}  # an hour, and seconds
_BRIEF = 3e3  # steps of a law that holds for an instant only
_FIRST_STEP = 1e-12  # s

Path = Callable[[Array], Array]  # of a step: its state at some times, (variables, n)


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
    return phases.solve(integrate, system, start, times, tolerance, progress)


def integrate(
    system: RollingSystem, now: PhaseStart, times: Array, tolerance: float, progress: Progress | None = None
) -> Iterator[Segment]:
    """Follow one law to its first stop."""
    # It counts from where the law begins to hold: far from 0 no step would be short enough.
    end = float(times[-1]) - now.time if times.size else 0.0
    for piece in _integrated(system, now, _Rows(times - now.time, len(now.state_vector)), end, tolerance, progress):
        here, times = times[: piece.times.size], times[piece.times.size :]
        if piece.stop is None:
            yield replace(piece, times=here)
            continue
        stop = replace(piece.stop, time=now.time + piece.stop.time)
        before, _ = cut(here, stop.time)
        yield Segment(before, piece.states[: before.size], stop)


def keeping() -> tuple[Keep, Callable[[], Integrate]]:
    """Return the way through all stretches of one run that keeps the polynomials of their steps, and one beside it."""
    return dense, lambda: integrate


def dense(system: RollingSystem, now: PhaseStart, end: float, tolerance: float, most: int) -> Leg | TooMany:
    """Follow one law to its first stop, and keep the polynomial of each step."""
    paths = _Paths(np.asarray(now.state_vector, dtype=float), most)
    try:
        *_, last = _integrated(system, now, paths, end - now.time, tolerance, None)
    except _TooManyError:
        time = now.time + paths.reached
        return TooMany(lambda times: paths.at(times - now.time), len(paths.paths), time, paths.last)
    stop = None if last.stop is None else replace(last.stop, time=now.time + last.stop.time)
    return Leg(lambda times: paths.at(times - now.time), stop, len(paths.paths))


def _integrated(
    system: RollingSystem,
    now: PhaseStart,
    rows: _Rows | _Paths,
    end: float,
    tolerance: float,
    progress: Progress | None,
) -> Iterator[Segment]:
    """Follow one law to its first stop; all times count from its beginning."""
    from scipy.integrate import DOP853, Radau

    law, begin = now.law, now.time
    traced = python_law(system, law, (*now.event_parameters, *corners.directions(system, now)), begin, now.state_vector)
    size, y0 = len(now.state_vector), np.asarray(now.state_vector, dtype=float)
    end = max(end, float(np.spacing(begin)))  # some way to go

    def rates(since: float, y: Array) -> Array:
        try:
            return np.array(traced.rates(begin + since, y.tolist()))
        except (ArithmeticError, ValueError):  # a trial beyond the end of a formula: a shorter step stays before it
            return np.full(size, np.nan)

    def stops(since: float, y: Array) -> Array:
        try:
            return np.array(traced.event_functions(begin + since, y.tolist()))
        except (ArithmeticError, ValueError):
            return np.full(len(traced.names), np.nan)

    told = None if progress is None else lambda since: progress(begin + since)
    patience = Patience(begin, begin + end, **_PATIENCE | ({"steps": _BRIEF, "spare": _BRIEF} if law.brief else {}))
    steps = partial(_steps, rows=rows, stops=stops, names=traced.names, begin=begin, patience=patience, progress=told)
    try:
        at = law.unpack(system, begin, y0)
        scale = _scale(y0, at.arm, at.scale(system))
        given: dict[str, Any] = {"rtol": tolerance, "atol": tolerance * scale}
        if not law.stiff(y0):
            yield from steps(DOP853(rates, 0.0, y0, end, **given))
            return
        # Its first steps must be as short as the law is stiff: across a jump of direction there are other solutions.
        first = Radau(rates, 0.0, y0, end, first_step=min(_FIRST_STEP, end), **given)
        for piece in steps(first, until=lambda y: not law.stiff(y)):
            stop = piece.stop
            if stop is None or stop.name:
                yield piece
                continue
            yield Segment(piece.times, piece.states, None)
            yield from steps(DOP853(rates, stop.time, stop.state_vector, end, **given))
    except (ZeroDivisionError, ValueError, OverflowError) as error:
        raise SolverError(f"The Runge-Kutta method broke down on the way to t = {begin + end:g} s: {error}.") from None


def _scale(y0: Array, arm: float, speed: float) -> Array:
    """Return against what an error of each number is small or not: its own size, or a share of its vector's.

    What begins is small, not its rate's rounding: that is a share of the body's size, and of all accelerations at hand.
    """
    place, turning = max(_size(y0[:3]), arm), max(_size(y0[7:10]), 0.1 * speed / arm)
    rest = max(1e-3 * _size(y0[10:]), 1e-4 * speed)
    least = [*[1e-3 * place] * 3, *[1.0] * 4, *[1e-3 * turning] * 3, *[rest] * 99]
    return np.maximum(np.abs(y0), least[: y0.size])


def _size(part: Array) -> float:
    return float(np.abs(part).max(initial=0.0))


def _steps(
    stepper: Any,
    *,
    rows: _Rows | _Paths,
    stops: Any,
    names: tuple[str, ...],
    begin: float,
    patience: Patience,
    progress: Progress | None,
    until: Callable[[Array], bool] = lambda _: False,
) -> Iterator[Segment]:
    """Take steps to the end or the first stop; states are read off each step's own polynomial.

    Where `until` says so of a state, they end after the step, at a stop without a name.
    """
    y = stepper.y
    yield from rows.take(stepper.t, lambda t: np.tile(y[:, None], t.size))
    first = values = stops(stepper.t, stepper.y)
    while stepper.status == "running":
        message = stepper.step()
        patience.after(1, begin + float(stepper.t))
        if stepper.status == "failed" or not np.isfinite(stepper.y).all():
            near = _singular(names, values, first)
            if near is None:
                raise SolverError(_broken(stepper, begin, message))
            yield rows.rest(ZeroCrossing(float(stepper.t), near, stepper.y.copy()), before=stepper.t)
            return
        path = stepper.dense_output()
        found = _first_stop(path, stops, values)
        reach = stepper.t if found is None else found[0]
        yield from rows.take(reach, path, before=found is not None)
        if found is not None:
            yield rows.rest(ZeroCrossing(found[0], names[found[1]], path(found[0])))
            return
        if until(stepper.y) and stepper.status == "running":
            yield rows.rest(ZeroCrossing(float(stepper.t), "", stepper.y.copy()))
            return
        values = stops(stepper.t, stepper.y)
        if progress is not None:
            progress(float(stepper.t))
    yield rows.rest(None)


class _Rows:
    """The states at some times, filled in as the steps pass them, and given on in blocks."""

    def __init__(self, times: Array, size: int) -> None:
        self.times, self.begun, self.done = times, 0, 0
        self.states = np.empty((min(times.size, AT_ONCE), size))

    def take(self, reach: float, path: Path, *, before: bool = False) -> Iterator[Segment]:
        """Fill in the states up to where a step ends, or before a stop in it, and yield each block that is full."""
        upto = int(np.searchsorted(self.times, reach, side="left" if before else "right"))
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
        self.y0, self.most = y0, most
        self.begins: list[float] = []
        self.paths: list[Path] = []

    def take(self, reach: float, path: Path, *, before: bool = False) -> Iterator[Segment]:  # noqa: ARG002
        """Keep one more."""
        if len(self.paths) == self.most:
            raise _TooManyError
        self.begins.append(getattr(path, "t_old", reach))
        self.paths.append(path)
        yield from ()

    @property
    def reached(self) -> float:
        """How far they lead."""
        return float(getattr(self.paths[-1], "t", self.begins[-1]))

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


def _singular(names: tuple[str, ...], values: Array, first: Array) -> str | None:
    """Return the end at which the law is singular that it has all but come to: no step leads nearer."""
    shares = {
        name: value / begin
        for name, value, begin in zip(names, values, first, strict=True)
        if name in _SINGULAR and begin > 0
    }
    nearest = min(shares, key=lambda name: shares[name], default=None)
    return nearest if nearest is not None and shares[nearest] < _ALL_BUT else None


def _broken(stepper: Any, begin: float, message: str | None) -> str:
    """Say when and where the method broke down."""
    near = ", ".join(f"{part:.6g}" for part in stepper.y[:3])
    why = str(message or "The rates are no longer finite.").rstrip(".")
    return (
        f"The Runge-Kutta method broke down at t = {begin + stepper.t:.9g} s, near ({near}) m on the support: {why}. "
        "Look for a surface, a body or a load that is not smooth there."
    )


def _first_stop(path: Any, stops: Any, begin: Array) -> tuple[float, int] | None:
    """Return the first instant in a step at which a stop falls through zero, also where it rises again at once."""
    if not begin.size:
        return None
    looks = 0.5 * (path.t_old + path.t) + 0.5 * (path.t - path.t_old) * _PLACES
    looks[[0, -1]] = path.t_old, path.t
    between = path(looks[1:]).T
    values = np.array([begin, *(stops(t, y) for t, y in zip(looks[1:], between, strict=True))])
    falls, low = ((values[:-1] >= 0) & (values[1:] < 0)).any(axis=0), np.fmin.reduce(values) < _LOW * np.ptp(values, 0)
    found: tuple[float, int] | None = None
    # Those that seem to come first are looked for first: of what comes later no more is asked.
    for which in sorted(np.flatnonzero(falls | low).tolist(), key=lambda which: _about(looks, values[:, which])):

        def at(t: float, which: int = which) -> float:
            value, aside = float(stops(t, path(t))[which]), 0.0
            while math.isnan(value) and aside < _ASIDE:  # just on the corner of a load, where it has no direction
                aside = max(4 * aside, 4 * float(np.spacing(t)))
                value = float(stops(t + aside, path(t + aside))[which])
            return value

        fall = _fall(at, looks, values[:, which], np.inf if found is None else found[0])
        if fall is not None:
            found = fall, which
    return found


def _about(looks: Array, values: Array) -> float:
    """Return about when a function falls through zero: on the line between two looks; infinite where it does not."""
    first = int(np.argmax((values[:-1] >= 0) & (values[1:] < 0)))
    high, fell = values[first], values[first + 1]
    return float(np.interp(0.0, [fell, high], [looks[first + 1], looks[first]])) if high >= 0 > fell else np.inf


def _fall(function: Callable[[float], float], looks: Array, values: Array, before: float) -> float | None:
    """Return where a function first falls through zero before an instant, given it at Chebyshev's points of a step."""
    falls = np.flatnonzero((values[:-1] >= 0) & (values[1:] < 0))
    inside = values[: falls[0] + 1] if falls.size else values
    # What lies between the looks is hardly lower than the lowest of them, beside how much they differ.
    if np.nanmin(inside, initial=np.inf) < _LOW * np.ptp(values) and (inside >= 0).all():
        upto = min(before, looks[falls[0]]) if falls.size else before
        for low in _minima(function, looks, values, upto):
            if function(low) < 0:
                return _sooner(function, looks[np.searchsorted(looks, low) - 1], low, before)
    if not falls.size:
        return None
    first = int(falls[0])
    return _sooner(function, looks[first], looks[first + 1], before)


def _sooner(function: Callable[[float], float], begin: float, end: float, before: float) -> float | None:
    """Return where a function falls through zero between two instants, if it is before a third."""
    if begin >= before or (end > before and function(before) >= 0):
        return None
    return root(function, begin, min(end, before))


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
