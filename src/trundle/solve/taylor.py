"""Taylor's method to the last digit, by heyoka: one compiled integrator a structure, kept in the user's cache."""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from ..errors import SolverError
from ..mechanics.parameters import numbers
from ..mechanics.scalars import as_float
from ..mechanics.system import RollingSystem, State
from . import corners, phases, runge_kutta, transitions
from .charts import CHART, LAWS_OWN, Chart
from .dense import Keep, Leg, TooMany
from .integrators import IN_HASTE, TOLERANCE, UNROLLED, WITH_CARE, borrowed, ready
from .kept_series import KeptSeries
from .lowering import Lowered
from .patience import Patience
from .phases import Integrate, Segment, cut
from .roots import until_one_falls
from .samples import AT_ONCE, Array, Progress, Samples
from .transitions import PhaseStart, ZeroCrossing

_CHUNKS = 100  # of a run at most
_LEAST_CHUNK = 1000  # instants
# Steps at most, and in units of `Lowered.cost`, between which progress is told and Ctrl-C is heard
_AT_ONCE, _WORK_AT_ONCE = 10_000, 5_000_000
# A law's first steps in a run are made by code that is compiled in haste: it takes four times as long for a step, and a
# tenth of a second to compile where what is made with care takes half to two. How long they are, and how its event
# functions fall, tells how many are to come, and whether better code is worth its compilation to two runs: most are
# made again for their card. The steps are counted anew in each run, so that it has the same digits whatever is compiled
# already. A short law is compiled with care at once.
# Steps: to see whether they grow, and whether an event function still falls; then so many, or a share of those done
_FIRST_LOOK, _NEXT_LOOK = 100, (25, 0.05)
_GROWING = 1.5  # times as long as the mean of some: then the next will be longer yet
# Steps to come, so many and so many over `Lowered.cost`: of laws from 120 to 1600 a step is 0.1 μs shorter for each of
# it, and the compilation 1.1 ms to 1.5 ms longer, and a fifth of a second. Half of them are to be done first: where
# slip ends, or a body lands, fewer come than it seems.
_WORTH_CARE, _SEEN = (6000.0, 3.5e5), 0.5
# Steps to come, so many and so many for the square of it: to unroll a law of 200 takes 2 s or 3 s, a long one a
# minute. A share of them is to be done first: where slip begins steps are a thousand times shorter than they will be.
_WORTH_UNROLLING, _DONE = (5e4, 5.0), 0.01
# Times as short as on the mean: where steps go on getting shorter they seem to be ever more, and come to an end first.
_SHORTENING = 2.0
_SHORT_LAW = 100  # by `Lowered.cost`
_SLOWER = {IN_HASTE: 3.0, WITH_CARE: 1.0, UNROLLED: 0.5}  # times, than what is made with care
_OF_ANY_STEP = 3e4  # products that take as long as what is not the law
# A minute, and some seconds, in steps of a law as short as those that are compiled with care at once.
_PATIENCE: dict[str, Any] = {"steps": 3e6, "spare": 1e5, "name": "Taylor's method"}
_OF_A_SHORT_STEP = 5e4  # products
_BACK = 1e-6  # of the time to come: a stretch of the same run begins a rounding before the last one's end at most
_STRAIGHT, _YOUNG, GROWN = 1e-9, 8, 1e12  # sine of an angle; steps at a time, of slip until it has grown so much
LONGEST = 100.0  # s without a new reference of time, at most
_PARTS = 10  # of a stretch that is kept, between which rounding's share is taken out


def available() -> bool:
    """Tell whether heyoka can be imported here.

    Examples
    --------
    >>> available() in (True, False)
    True
    """
    from importlib.util import find_spec

    return find_spec("heyoka") is not None


def solve(
    system: RollingSystem, start: State, times: Array, tolerance: float = TOLERANCE, progress: Progress | None = None
) -> Samples:
    """Integrate the laws of contact and return the states at the given times; every event is located as it happens.

    Examples
    --------
    >>> import numpy as np
    >>> import trundle as tr
    >>> slope = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), tilt=0.1))
    >>> x = solve(slope, slope.place(), np.array([1.0])).position[0, 0]
    >>> print(round(x / (9.80665 * np.sin(0.1) / 2), 12))  # (5/7) g sin α
    0.714285714286
    """
    return phases.solve(partial(integrate, shared=Shared()), system, start, times, tolerance, progress)


def integrate(
    system: RollingSystem,
    now: PhaseStart,
    times: Array,
    tolerance: float,
    progress: Progress | None = None,
    shared: Shared | None = None,
) -> Iterator[Segment]:
    """Follow one law to its first stop."""
    shared = Shared() if shared is None else shared
    if now.law.brief:
        brief, shared.brief.handed_on = before_series(now, late=shared.brief.too_soon), True
        yield from runge_kutta.integrate(system, brief, times, runge_kutta.FINEST, progress, shared.brief)
        return
    goes_on: PhaseStart | None = now
    while goes_on is not None:
        now, goes_on = goes_on, None
        with _begun(system, now, float(times[-1]) if times.size else now.time, tolerance, shared) as run:
            run.progress = progress
            try:
                for chunk, states, reached in _propagate(run, times):
                    if reached is None:
                        yield Segment(chunk, states, None)
                        times = times[chunk.size :]
                        continue
                    stop = run.stop(reached)
                    kept, _ = cut(chunk, stop.time)
                    goes_on = _in_another_chart(system, run.now, stop)
                    yield Segment(kept, states[: kept.size], stop if goes_on is None else None)
                    _, times = cut(times, stop.time)
            except SolverError:  # at an instant at which the law is singular, which its steps came to by a rounding
                if not _ends_singular(system, run.now, run):
                    raise
                yield from runge_kutta.integrate(system, run.now, times, runge_kutta.FINEST, progress)


def before_series(now: PhaseStart, *, late: bool = False) -> PhaseStart:
    """Return a brief law as it is followed where series go on."""
    return replace(now, law=now.law.before_series(late=late))


def _in_another_chart(system: RollingSystem, now: PhaseStart, stop: ZeroCrossing) -> PhaseStart | None:
    """Return how the same law goes on where a chart ends; None at any other stop."""
    if stop.name != CHART:
        return None
    return transitions.later(system, now, stop.time, stop.state_vector)


@dataclass
class _Effort:
    """What is done for the speed of a law's steps in one run, by what they have shown so far."""

    cost: int  # of the law
    tolerance: float = TOLERANCE  # of a step
    level: int = IN_HASTE
    steps: int = 0
    gone: float = 0.0  # s, in them
    pace: float = 0.0  # 1/s, of the last of them
    pause: int = _FIRST_LOOK  # steps to the next look

    def __post_init__(self) -> None:
        if self.cost <= _SHORT_LAW:
            self.level = WITH_CARE

    @property
    def of_the_law(self) -> float:
        """How many products the law takes in a step: a coefficient of order n is a sum of n for each operation."""
        order = math.ceil(1 - math.log(self.tolerance) / 2)
        return self.cost * order * (order + 3) / 2

    def products(self, level: int) -> float:
        """Return how many products of code that is made with care take as long as a step of code of a level."""
        return _OF_ANY_STEP + _SLOWER[level] * self.of_the_law

    @property
    def settled(self) -> bool:
        """Whether a first look has found better code than what is made in haste; unrolled code may still come."""
        return self.level != IN_HASTE and self.steps >= _FIRST_LOOK

    def after(self, steps: int, lasted: float) -> None:
        """Take account of steps."""
        self.steps, self.gone = self.steps + steps, self.gone + lasted
        self.pace = steps / lasted if lasted > 0 else 0.0

    def look(self, left: float, holds: Callable[[], float] = lambda: math.inf, *, growing: bool = False) -> None:
        """Decide by how many more steps there seem to be in the time left to the run, s, for which the law holds, s.

        While steps grow nothing is known, nor where there seem to be more than patience allows, and a share of them is
        to be done first; but where there have been as many as are worth it, there may be as many again.
        """
        self.pause = _FIRST_LOOK if growing else max(_NEXT_LOOK[0], int(_NEXT_LOOK[1] * self.steps))
        coming, most = self.pace * left, _PATIENCE["steps"] * _OF_A_SHORT_STEP / self.products(UNROLLED)
        careful = _WORTH_CARE[0] + _WORTH_CARE[1] / self.cost
        worth = _WORTH_UNROLLING[0] + _WORTH_UNROLLING[1] * self.cost**2
        shortening = self.pace * self.gone > _SHORTENING * self.steps
        if most >= coming > worth and self.steps > _DONE * worth and not shortening:
            self.level = UNROLLED
        elif self.level == IN_HASTE:
            seen = not growing and careful < coming <= most and self.steps > _SEEN * careful
            if self.steps > careful or (seen and self.pace * holds() > careful):
                self.level = WITH_CARE


@dataclass
class Shared:
    """What the stretches of one run share."""

    efforts: dict[str, _Effort] = field(default_factory=dict)  # for each law
    end: float = math.inf  # of the run, s
    brief: runge_kutta.Taken = field(default_factory=runge_kutta.Taken)  # what it has come through of brief laws
    passes: Patience = field(init=False)  # with slip that is at its slowest and goes on
    _patience: Patience | None = None

    def patience(self, begin: float, end: float) -> Patience:
        """Return what refuses to go on for too long, over all of the run; of another one where the time goes back."""
        if self._patience is None or self._patience.time - begin > _BACK * (end - begin):
            self._patience, self.end = Patience(begin, end, **_PATIENCE), end
            self.passes = Patience(begin, end, **phases.PATIENCE)
        return self._patience

    def effort(self, key: str, cost: int, tolerance: float) -> _Effort:
        """Return what is done for a law."""
        return self.efforts.setdefault(key, _Effort(cost, tolerance))

    def another(self) -> Shared:
        """Return the same for another run of this system: for it, too, is there what was made with care."""
        efforts = {key: _Effort(one.cost, one.tolerance, one.level) for key, one in self.efforts.items()}
        return Shared(efforts, brief=self.brief.copy())


def first_steps(
    system: RollingSystem, now: PhaseStart, end: float, tolerance: float, count: int
) -> tuple[float, float, tuple[str, ...]]:
    """Return how long its first steps are, s, how many products one takes, and the names of the event functions."""
    with _begun(system, now, end, tolerance, Shared()) as run:
        _, _, _, taken, *_ = run.integrator.propagate_until(end - now.time, max_steps=count)
        gone = float(run.integrator.time)
        return gone / max(taken, 1), run.effort.of_the_law, run.lowered.event_functions


def keeping() -> tuple[Keep, Callable[[], Integrate]]:
    """Return the way through all stretches of one run that keeps the polynomials of their steps, and one beside it."""
    shared = Shared()
    return partial(dense, shared=shared), lambda: partial(integrate, shared=shared.another())


def dense(
    system: RollingSystem,
    now: PhaseStart,
    end: float,
    tolerance: float,
    most: int,
    shared: Shared | None = None,
) -> Leg | TooMany:
    """Follow one law to its first stop, and keep the polynomial of each step."""
    shared = Shared() if shared is None else shared
    if now.law.brief:
        brief, shared.brief.handed_on = before_series(now, late=shared.brief.too_soon), True
        return runge_kutta.dense(system, brief, end, runge_kutta.FINEST, most, shared.brief)
    legs: list[Leg | TooMany] = []
    ends: list[float] = []
    goes_on: PhaseStart | None = now
    while goes_on is not None:
        now, goes_on = goes_on, None
        left = most - sum(each.steps for each in legs)
        leg = _dense_in_chart(system, now, end, tolerance, left, shared)
        legs.append(leg)
        if isinstance(leg, Leg) and leg.stop is not None:
            goes_on = _in_another_chart(system, now, leg.stop)
            ends += [leg.stop.time] if goes_on is not None else []
    return _joined(legs, ends) if ends else leg


def _joined(legs: list[Leg | TooMany], ends: list[float]) -> Leg | TooMany:
    """Return legs of one law as one, the last of them: they are in different charts, or by another method at last."""
    steps, work = sum(each.steps for each in legs), sum(each.work for each in legs)
    begins = np.concatenate([each.begins for each in legs])

    def states(times: Array) -> Array:
        parts = np.split(times, np.searchsorted(times, ends))
        return np.vstack([leg.states(part) for leg, part in zip(legs, parts, strict=True)])

    return replace(legs[-1], states=states, steps=steps, work=work, begins=begins)


def _dense_in_chart(
    system: RollingSystem, now: PhaseStart, end: float, tolerance: float, most: int, shared: Shared
) -> Leg | TooMany:
    """Follow one law to its first stop, or to where its chart ends, and keep the polynomial of each step."""
    with _begun(system, now, end, tolerance, shared) as run:
        run.kept, stop = KeptSeries(now.time, run.integrator.state.copy()), None
        kept, to_law = run.kept, run.to_law

        def states(times: Array) -> Array:
            return to_law(times, kept.at(times))

        part = min(LONGEST, (end - now.time) / _PARTS)
        while stop is None and run.reference < end:
            until = min(end, max(run.reference + part, math.nextafter(run.reference, end)))
            try:
                reached = run.go_to(until - run.reference)
            except SolverError:
                if not _ends_singular(system, run.now, run):
                    raise
                onward = runge_kutta.dense(system, run.now, end, runge_kutta.FINEST, most)
                if run.now is now:
                    return onward
                before = Leg(states, None, kept.steps, run.work(kept.steps), kept.when[kept.when < run.now.time])
                return _joined([before, onward], [run.now.time])
            if reached is not None:
                stop = run.stop(reached)
            elif kept.steps > most and until < end:
                (there,) = to_law(np.array([until]), run.integrator.state[None].copy())
                return TooMany(states, kept.steps, run.work(kept.steps), kept.when, until, there)
            else:
                run.tidy(until)
        return Leg(states, stop, kept.steps, run.work(kept.steps), kept.when)


@contextlib.contextmanager
def _begun(system: RollingSystem, now: PhaseStart, end: float, tolerance: float, shared: Shared) -> Iterator[_Run]:
    """Lend what integrates a law, at its beginning."""
    lowered, key = ready(system, now.law, tolerance, now.state_vector)
    with contextlib.ExitStack() as lent:

        def borrow(level: int) -> Any:
            return lent.enter_context(borrowed(lowered, key, tolerance, level))

        run = _Run(borrow, shared.effort(key, lowered.cost, tolerance), system, lowered, now)
        run.patience, run.passes = shared.patience(now.time, end), shared.passes
        run.end, run.lasted = shared.end, lasted(system, now)
        run.after_brief, shared.brief.handed_on = shared.brief if shared.brief.handed_on else None, False
        yield run


def lasted(system: RollingSystem, now: PhaseStart) -> float:
    """Return for how long slip or turning seems to have lasted that grows straight from all but nothing, s; else ∞.

    Where it goes straight its speed has no singularity, and only rounding in the series would say how near it came to
    nothing. By what of that is left, a step would be far too short, or, between two zeros, far too long.
    """
    found, first = math.inf, len(now.event_parameters) - now.law.ending
    for i, stop in enumerate(now.law.ends):
        found = min(found, _lasted_to(system, now, stop, now.event_parameters[first + 4 * i]))
    return found


def _lasted_to(system: RollingSystem, now: PhaseStart, stop: str, near: float) -> float:
    """Return the same of slip or of turning, given the square of what is all but nothing."""
    law, numbers_now = now.law, list(map(float, now.state_vector))
    v = law.shrinking(system, now.time, numbers_now, stop).array()
    if v @ v > GROWN * near:
        return math.inf
    rate = law.shrinking_rate(system, now.time, numbers_now, stop).array()
    length, change = float(np.linalg.norm(v)), float(np.linalg.norm(rate))
    straight = float(np.linalg.norm(np.cross(v, rate))) <= _STRAIGHT * length * change and v @ rate > 0
    return length / change if straight else math.inf


class _Run:
    """An integrator on its way; its own time counts from a reference that moves along."""

    def __init__(
        self,
        borrow: Callable[[int], Any],
        effort: _Effort,
        system: RollingSystem,
        lowered: Lowered,
        now: PhaseStart,
    ) -> None:
        self.borrow, self.lowered, self.system, self.now = borrow, lowered, system, now
        self.corners = corners.directions(system, now)
        self.to_law = partial(to_law, lowered.chart, system)
        self.effort, self.level = effort, effort.level
        self.effort.pause = _FIRST_LOOK
        self.integrator = borrow(self.level)
        self.patience: Patience
        self.passes: Patience
        self.after_brief: runge_kutta.Taken | None = None  # where it goes on with what a brief law has begun
        self.progress: Progress | None = None
        self.kept: KeptSeries | None = None  # where the polynomials of its steps are kept
        self.lasted, self.begun, self.end = math.inf, now.time, math.inf
        self.integrator.state[:] = lowered.chart.of_law(system, now.time, now.state_vector)
        self._refer_to(now.time)

    @property
    def time(self) -> float:
        """The time reached, s."""
        return self.reference + float(self.integrator.time)

    @property
    def state_vector(self) -> Array:
        """The law's numbers at the time reached."""
        (state,) = self.to_law(np.array([self.time]), self.integrator.state[None].copy())
        return np.asarray(state)

    def stop(self, reached: int) -> ZeroCrossing:
        """Return the stop that it has come to."""
        return ZeroCrossing(self.time, self.lowered.event_functions[reached], self.state_vector)

    def work(self, steps: int) -> float:
        """Return how much work so many steps are, products of code that is made with care."""
        return steps * self.effort.products(self.level)

    def tidy(self, time: float) -> None:
        """Count from here on, and take rounding's share out of φ(p) = 0 and |q| = 1."""
        self._refer_to(time)
        tidied = self.lowered.tidy([0.0, *self.integrator.state.tolist(), *self.values])
        self.integrator.state[:] = self.lowered.chart.reduced(tidied)

    def go_to(self, until: float) -> int | None:
        """Propagate to a time since the reference; return which terminal event came first if one did."""
        while True:
            given = self._at_once()
            if self.kept is not None:
                given |= {"write_tc": True, "callback": self.kept.take}
            outcome, _, _, steps, *_ = self.integrator.propagate_until(until, **given)
            more, reached = self._after(outcome, steps)
            if not more:
                return reached

    def go_through(self, since: Array) -> Iterator[tuple[Array, int | None]]:
        """Yield the states at times since the reference, the first of them now, and the terminal event if one came.

        They come in parts, each up to where slip or turning was at its slowest: from there on a stretch may begin.
        """
        parts: list[Array] = []
        done = 0
        while True:
            ahead = np.concatenate([[self.integrator.time], since[done:]]) if done else since
            given, before = self._at_once(), self.now
            outcome, _, _, steps, *_, found = self.integrator.propagate_grid(ahead, **given)
            found = found.reshape(-1, self.integrator.state.size)[bool(done) :]
            parts.append(found)
            done += len(found)
            more, reached = self._after(outcome, steps)
            if not more:
                yield np.vstack(parts), reached
                return
            while done < since.size and since[done] <= self.integrator.time:  # a rounding before a step's end
                parts.append(self.integrator.state[None].copy())
                done += 1
            if done == since.size:
                yield np.vstack(parts), None
                return
            if self.now is not before:
                yield np.vstack(parts), None
                parts = []

    def _at_once(self) -> dict[str, Any]:
        """Return how many steps to make before anything else is looked at, and how long they may be.

        After the first of them, take what is made for more. A stop has ended the stretch, so that nothing is known of
        one that the other would have to know.
        """
        if self.effort.level != self.level:
            last, self.integrator, self.level = self.integrator, self.borrow(self.effort.level), self.effort.level
            self.integrator.state[:], self.integrator.pars[:] = last.state, last.pars
            self.integrator.dtime = last.dtime
        self.counted_from = self.time
        most = min(_AT_ONCE, _WORK_AT_ONCE // self.effort.cost + 1) if self.effort.settled else self.effort.pause
        longest = self.lasted + (self.time - self.begun)
        if longest > GROWN * self.lasted:
            self.lasted = longest = math.inf
        return {"max_steps": most if longest == math.inf else min(most, _YOUNG), "max_delta_t": longest}

    def _after(self, outcome: Any, steps: int) -> tuple[bool, int | None]:
        """Tell whether there is more to do after so many steps, and if not, which terminal event ended it, if one."""
        reached = self._missed(outcome)
        if reached is None and self._is_cut(outcome, steps):
            return True, None
        if reached is None:
            reached = _event(self, outcome)
        passed = reached is not None and self._passed(reached)
        return passed, None if passed else reached

    def _passed(self, reached: int) -> bool:
        """Go on where slip or turning was only at its slowest, and tell whether it was.

        Whoever follows derivatives is to be told of each stop.
        """
        stop = self.stop(reached)
        if self.now.law.variational or stop.name.removeprefix("near ") not in self.now.law.ends:
            return False
        same = transitions.going_on(self.system, self.now.law, stop)
        if same is None or corners.beyond(self.system, same) is not same:
            return False
        self.passes.after(1, stop.time)
        self.now, self.begun, self.lasted = same, same.time, math.inf
        self._give()
        self.integrator.reset_cooldowns()
        return True

    def _missed(self, outcome: Any) -> int | None:
        """Return the end of slip or turning that was passed over, from where on its steps get shorter without end.

        Zeros are looked for in the series of one step, which differs at its end by a rounding from that of the next: a
        zero there may be in neither.
        """
        import heyoka

        if outcome != heyoka.taylor_outcome.step_limit:
            return None
        law, time, state = self.now.law, self.time, self.state_vector.tolist()
        for name in law.ends:
            v, rate = (of(self.system, time, state, name) for of in (law.shrinking, law.shrinking_rate))
            if v.dot(rate) < 0:
                found = law.event_functions(self.system, time, state, self.now.event_parameters)
                if found[f"near {name}"] < 0:
                    return self.lowered.event_functions.index(f"near {name}")
        return None

    def _is_cut(self, outcome: Any, steps: int) -> bool:
        """Tell whether there is more to do, after so many steps that somebody may have lost patience meanwhile."""
        import heyoka

        now = self.time
        self.effort.after(steps, now - self.counted_from)
        if self.after_brief is not None:
            self.after_brief.in_series += steps
        goes_on = outcome in (heyoka.taylor_outcome.step_limit, heyoka.taylor_outcome.time_limit)
        if goes_on and self.effort.steps >= _FIRST_LOOK:
            growing = self.integrator.last_h * self.effort.pace > _GROWING
            self.effort.look(self.end - now, self._holds, growing=growing)
        limited = outcome == heyoka.taylor_outcome.step_limit
        if limited and self.integrator.last_h == 0:  # the terms of the series are greater than any float
            steps = int(_PATIENCE["steps"])
        self.patience.after(steps, now, self.effort.products(self.level) / _OF_A_SHORT_STEP)
        if not limited:
            return False
        if self.progress is not None:
            self.progress(now)
        return True

    def _holds(self) -> float:
        """Return for how long the law seems to hold, s: until an event function comes to zero that falls as it fell."""
        there = (self.begun, self.now.state_vector), (self.time, self.state_vector)
        before, now = (self._event_functions(*at) for at in there)
        return until_one_falls(before, now, self.time - self.begun)

    def _event_functions(self, time: float, state: Sequence[float] | Array) -> Array:
        found = self.now.law.event_functions(self.system, time, list(map(float, state)), self.now.event_parameters)
        return np.array(list(map(as_float, found.values())))

    def _refer_to(self, time: float) -> None:
        self.reference, self.integrator.time = time, 0.0
        if self.kept is not None:
            self.kept.refer_to(time)
        self._give()

    def _give(self) -> None:
        """Tell the integrator its numbers."""
        given = [*self.system.once(numbers), *self.now.event_parameters, *self.corners]
        self.values = self.lowered.values(given, self.reference)
        self.integrator.pars[:] = self.values[: self.lowered.parameters]


def to_law(chart: Chart, system: RollingSystem, times: Array, states: Array) -> Array:
    """Return a law's numbers at some times, given those of a chart."""
    if chart == LAWS_OWN:
        return states
    columns = chart.to_law(system, times, tuple(states.T))
    found = np.empty((times.size, len(columns)))
    for i, column in enumerate(columns):
        found[:, i] = column
    return found


def _propagate(run: _Run, times: Array) -> Iterator[tuple[Array, Array, int | None]]:
    """Yield the times and the states there, a chunk after the other, and last which terminal event came, if one did."""
    for chunk in chunks(times):
        while run.reference < chunk[0]:  # also where rounding does not tell the two instants apart: it must begin there
            until = min(float(chunk[0]), run.reference + LONGEST)
            ended = run.go_to(until - run.reference)
            if ended is not None:
                yield chunk[:0], run.to_law(chunk[:0], np.empty((0, run.integrator.state.size))), ended
                return
            run.tidy(until)
        since, which = chunk - run.reference, np.arange(chunk.size)
        if (since[1:] <= since[:-1]).any():  # two instants may be one: what is left of a difference is rounded
            since, which = np.unique(since, return_inverse=True)
        done = 0
        for states, ended in run.go_through(since):
            here = slice(*np.searchsorted(which, (done, done + len(states))))
            yield chunk[here], run.to_law(chunk[here], states[which[here] - done]), ended
            if ended is not None:
                return
            done += len(states)
        if run.progress is not None:
            run.progress(float(chunk[-1]))


def chunks(times: Array, most: int = _CHUNKS, size: int = AT_ONCE) -> Iterator[Array]:
    """Part the instants, where it can be into no more parts than `most`, so that none is long after its part's first.

    No part has more than `size`.
    """
    count = max(min(most, max(1, times.size // _LEAST_CHUNK)), -(-times.size // size))
    edges = np.arange(count + 1) * times.size // count
    for first, last in itertools.pairwise(edges.tolist()):
        part = times[first:last]
        if part.size and part[-1] - part[0] < LONGEST:
            yield part
        elif part.size:
            which = np.floor((part - part[0]) / LONGEST)
            yield from np.split(part, np.flatnonzero(np.diff(which)) + 1)


def _ends_singular(system: RollingSystem, now: PhaseStart, run: _Run) -> bool:
    """Tell whether a method that does not get on, or breaks down, has all but come to where its law is singular."""
    state = run.state_vector
    return not np.isfinite(state).all() or runge_kutta.nearly_singular(system, now, run.time, state)


def _event(run: _Run, outcome: Any) -> int | None:
    """Return which terminal event ended it, None if none did; refuse a breakdown."""
    import heyoka

    if outcome == heyoka.taylor_outcome.time_limit:
        return None
    if int(outcome) >= 0 or int(outcome) < -1000:
        when = f"at t = {run.time:.9g} s" if math.isfinite(run.time) else f"after t = {run.reference:.9g} s"
        raise SolverError(
            f"Taylor's method broke down {when} ({outcome}): the rates are no longer finite. "
            "Look for a support or load that jumps, or a surface too curved for the body."
        )
    return -int(outcome) - 1
