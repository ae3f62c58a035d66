"""A run with its derivatives: the variational equations of each phase, and across each event its own law in duals.

At an event the instant itself depends on the parameters: g(t*, y, θ) = 0 gives dt*/dθ = −(∂g/∂y Y + ∂g/∂θ)/ġ. There the
state is a dual, and what follows from it is worked out by the same functions as in any run. Back at a fixed instant the
derivatives are less by the new rates times dt*/dθ: together, the saltation matrix (Leine and Nijmeijer 2004).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...errors import InvalidValueError, SolverError
from ...mechanics.algebra import ZERO, Vector
from ...mechanics.duals import Dual, slopes_of, stacked, unstacked, value_of
from ...mechanics.kinks import kinks_and_jolts
from ...mechanics.parameters import with_numbers
from ...mechanics.placing import SLIP_TOLERANCE
from ...mechanics.slipping import slip
from ...mechanics.system import RollingSystem, State
from ...solve import corner_events, corners, focal, phases, runge_kutta, taylor, transitions
from ...solve.contact_state import ContactState
from ...solve.laws import CONTACT, CORNER, Law, SlippingLaw, state_turning
from ...solve.phases import Follows, Integrate, Segment
from ...solve.samples import RESTING, ROLLING, SLIPPING, Array, Progress, Samples
from ...solve.transitions import JOLT, PhaseStart, ZeroCrossing
from ...solve.variational import VariationalLaw, VariedSystem
from .outputs import Slopes, slopes_of_samples

_BRINK = 1e-7  # share of all friction that may be left for a contact to be taken as on the brink of slipping
_BEFORE = 1e-2  # share of the time in which the motion changes, at which one looks how an event function falls
_GRAZES = 1e-2  # share of that fall by which it falls on at its zero: less is grazing
# Share of the time in which the motion changes, at which one looks at the rates beside a corner of a load, and how much
# farther off once more; the share of the rates that is rounding.
_BESIDE, _WIDER, _STEADY = 1e-9, 8.0, 1e-12
_LEFT = 1e-3  # share of a slip that is all but nothing, of which less has no direction
_SLIPS = 1e-9  # share of a velocity's slope by which a start may begin to slip


@dataclass(frozen=True)
class Followed:
    """A run and its derivatives."""

    samples: Samples  # of the run
    slopes: Slopes  # of each quantity, (n, components, parameters)
    instants: Array  # (events, parameters): of when each event comes


def follow(
    system: RollingSystem,
    start: State,
    times: Array,
    in_duals: tuple[RollingSystem, State],
    names: Sequence[str],
    tolerance: float | None = None,
    progress: Progress | None = None,
    *,
    of_motion: bool = False,
) -> Followed:
    """Follow a body through its phases with the derivatives by some parameters.

    Parameters
    ----------
    system, start : RollingSystem, State
        In numbers.
    times : array (n,)
        Ascending, s.
    in_duals : tuple of RollingSystem, State
        The same in duals.
    names : sequence of str
        Of the parameters.
    tolerance : float, optional
        Of the method, Taylor's where it can be had; absent: its own.
    progress : callable, optional
        Told the fraction done.
    of_motion : bool
        Whether only slopes of the motion are asked for, and of no force.
    """
    method: Any = method_for(system)
    integrate: Integrate = (
        partial(taylor.integrate, shared=taylor.Shared()) if method is taylor else runge_kutta.integrate
    )
    duals, first = in_duals
    begins = transitions.at_start(duals, first)
    run = _Run(integrate, system, times, duals, begins, len(names), of_motion=of_motion)
    check_start(duals, begins, first, names)
    samples = run.solve(start, method.TOLERANCE if tolerance is None else tolerance, progress)
    return Followed(samples, run.slopes(samples), run.instants(samples))


def check_brink(system: RollingSystem, now: PhaseStart) -> None:
    """Refuse a body that holds on the brink of slipping: with a little less friction it moves another way."""
    if now.law.code not in (ROLLING, RESTING) or system.support.friction is None:
        return
    stops = now.law.event_functions(system, now.time, now.state_vector, now.event_parameters)
    most = float(system.support.friction) * float(stops["lift"])
    if abs(float(stops["slip"])) <= _BRINK * most**2 and most > 0:
        raise no_derivative(now.time, "friction holds the body with nothing to spare")


def no_derivative(time: float, why: str) -> SolverError:
    """Return the refusal of a motion at an instant."""
    return SolverError(
        f"At t = {time:.9g} s the motion has no derivative: {why}. Ask for a shorter run, or change a number."
    )


def method_for(system: RollingSystem) -> Any:
    """Return the method that takes steps: Taylor's, where it is to be had and the surface is a formula."""
    return taylor if taylor.available() and system.support.surface.analytic else runge_kutta


def check_start(system: RollingSystem, begins: PhaseStart, first: State, names: Sequence[str]) -> None:
    """Refuse numbers of a start that alone would make slip what rolls, lift what slips, or turn what does not turn."""
    given = ContactState.of(system, first)
    scale = given.scale(system)
    turning = state_turning(given.contact, given.Omega)
    if system.resisted and value_of(turning.norm() * given.arm) <= SLIP_TOLERANCE * scale:
        rule = "must name numbers that change alone without turning a body that does not turn at the start"
        remedy = "A resistance acts against either way at once, and so there is no derivative."
        _refuse(turning * given.arm, given, scale, names, rule, remedy)
    if begins.law.code in (ROLLING, RESTING):
        at = begins.law.unpack(system, begins.time, begins.state_vector)  # its slope, too: a support may be faster then
        rule = "must name numbers that change alone without making a body slip that rolls at the start"
        remedy = 'Both velocities are given: let one follow, by `spin` or by `velocity = "rolling"`.'
        _refuse(given.V - at.V, given, scale, names, rule, remedy)
    elif begins.law.code == SLIPPING:
        rule = "must name numbers that change alone without lifting a body that slips at the start, or pressing it on"
        remedy = "It would come off one way and land the other. Let it start above the support, by `height`."
        _refuse(given.contact.normal * given.approach, given, scale, names, rule, remedy)


def _refuse(apart: Vector, at: ContactState, scale: float, names: Sequence[str], rule: str, remedy: str) -> None:
    """Refuse a number that changes what must stay nothing, m/s, beside a speed of the motion."""
    count = len(names)
    rows = [slopes_of(part, count) for part in apart]
    sizes = [slopes_of(part, count) for part in (*at.V, *at.Omega)]
    for j, name in enumerate(names):
        if max(abs(row[j]) for row in rows) > _SLIPS * max(scale, *(abs(row[j]) for row in sizes)):
            raise InvalidValueError("wrt", rule, name, remedy)


class VariationalRun:
    """A run with how its state changes with some parameters, from phase to phase.

    Parameters
    ----------
    method : callable
        The way through one stretch.
    system : RollingSystem
        In numbers.
    times : array (n,)
        Ascending, s.
    duals : RollingSystem
        The same in duals, where its numbers depend on the parameters.
    begins : PhaseStart
        How it starts, in duals.
    count : int
        How many parameters there are.
    """

    def __init__(
        self,
        method: Integrate,
        system: RollingSystem,
        times: Array,
        duals: RollingSystem,
        begins: PhaseStart,
        count: int,
    ) -> None:
        self.method, self.system, self.times, self.duals, self.count = method, system, times, duals, count
        self.varied = VariedSystem.of(duals)
        self.begins: PhaseStart | None = begins  # in duals, where an event was
        self.here: tuple[Law, float, list[Any]]  # where the derivatives are known, and by which law they go on
        self.before: list[Any]  # the state that was known last before a stop
        self.turned = -math.inf  # when a corner was passed last

    def solve(self, start: State, tolerance: float, progress: Progress | None) -> Samples:
        """Follow the body from its start through its phases."""
        self.bends = kinks_and_jolts(self.system, start.time, float(self.times[-1]))
        given: Any = {"remember": self.remember, "bends": self.bends}
        return phases.solve(self.integrate, self.system, start, self.times, tolerance, progress, **given)

    # What `phases.solve` asks for

    def integrate(
        self, system: RollingSystem, now: PhaseStart, times: Array, tolerance: float, progress: Progress | None
    ) -> Iterator[Segment]:
        """Follow one law to its first stop, with its variational equations."""
        size = len(now.state_vector)
        law = VariationalLaw(now.law, size, self.count)
        state = self._state(now)
        begin = PhaseStart(law, now.start, stacked(state, self.count), now.event_parameters)
        self.here = now.law, now.time, state
        self.event_parameters = (*now.event_parameters, *corners.directions(system, now))
        for piece in self.method(self.varied, begin, times, tolerance, progress):
            if piece.times.size:
                self.keep(now.law, piece)
                self.here = now.law, float(piece.times[-1]), unstacked(piece.states[-1].tolist(), size)
            stop = piece.stop
            if stop is not None:
                self.before, self.here = self.here[2], (now.law, stop.time, unstacked(stop.state_vector.tolist(), size))
                self.stopped(now.law, stop)
                stop = ZeroCrossing(stop.time, stop.name, stop.state_vector[:size])
            yield Segment(piece.times, piece.states[:, :size], stop)

    def remember(self, follows: Follows, law: Law, stop: ZeroCrossing) -> PhaseStart | None:
        """Return what follows a stop, and keep the same in duals."""
        found = follows()
        if stop.name.startswith(CORNER):  # there the same goes on
            self._turn_corner(law, stop)
        elif found is not None:
            self.begins = phases.following_stop(self.duals, law, self._crossing(law, stop))
        return found

    def keep(self, law: Law, piece: Segment) -> None:
        """Take note of states with their derivatives."""

    def stopped(self, law: Law, stop: ZeroCrossing) -> None:
        """Take note of where a law ended, the state with its derivatives."""

    # Derivatives at an instant

    def _state(self, now: PhaseStart) -> list[Dual]:
        """Return the state in duals at which a phase begins, for a fixed instant."""
        if self.begins is not None:
            begins, self.begins = self.begins, None
            self.here = begins.law, float(value_of(begins.time)), self._at_fixed_time(now, begins)
        law, time, state = self.here
        if now.time > time:
            state = law.rk4_step(self.duals, time, state, now.time - time)
        if type(law) is not type(now.law) or len(state) != len(now.state_vector):
            raise no_derivative(now.time, "what follows there hangs on a rounding")
        slopes = [slopes_of(part, self.count) for part in state]
        check_brink(self.system, now)
        if not np.isfinite(np.array(slopes, dtype=float)).all():
            raise no_derivative(now.time, "what follows has no slope there")
        return [Dual(float(number), row) for number, row in zip(now.state_vector, slopes, strict=True)]

    def _at_fixed_time(self, now: PhaseStart, begins: PhaseStart) -> list[Dual]:
        """Return a state that is known where an event comes, as it changes at a fixed instant."""
        moved = slopes_of(begins.time, self.count)
        numbers = [float(value_of(number)) for number in begins.state_vector]
        rates = [0.0] * len(numbers)
        if any(moved):
            rates = [float(rate) for rate in now.law.rates(self.system, float(value_of(begins.time)), numbers)]
        found = []
        for number, rate, part in zip(numbers, rates, begins.state_vector, strict=True):
            pairs = zip(slopes_of(part, self.count), moved, strict=True)
            found.append(Dual(number, tuple(float(slope) - rate * shift for slope, shift in pairs)))
        return found

    def _crossing(self, law: Law, stop: ZeroCrossing) -> ZeroCrossing:
        """Return a stop in duals: when it comes, and the state then."""
        _, _, state = self.here
        kink = next((kink for kink in self.bends if kink.time == stop.time), None)
        if kink is not None:  # a kink is where it is, whatever the parameters
            numbers: Any = np.array(state, dtype=object)
            known = transitions.jolted(self.duals, law, kink, numbers) if stop.name == JOLT else None
            return ZeroCrossing(stop.time, stop.name, numbers, known)
        if stop.name in law.handed_on or focal.is_focal(law, stop):  # the same motion goes on, wherever it is taken up
            return ZeroCrossing(stop.time, stop.name, np.array(state, dtype=object))
        state = self._with_direction(law, state)
        rates = [float(rate) for rate in law.rates(self.system, stop.time, [one.value for one in state])]
        moved = self._moved(law, stop, state, rates)
        pairs = zip(state, rates, strict=True)
        there = [
            Dual(one.value, tuple(s + rate * m for s, m in zip(one.slopes, moved, strict=True))) for one, rate in pairs
        ]
        return ZeroCrossing(Dual(stop.time, moved), stop.name, np.array(there, dtype=object))  # type: ignore[arg-type]

    def _turn_corner(self, law: Law, stop: ZeroCrossing) -> None:
        """Let the derivatives jump where a load does: when that is depends on the parameters."""
        _, _, state = self.here
        numbers = [one.value for one in state]
        step = _BESIDE * law.unpack(self.system, stop.time, numbers).moment(self.system)
        last, self.turned = self.turned, stop.time
        if stop.time - last <= step:  # come to already, a rounding before it is passed, or another in the same place
            return
        rates = law.rates(self.system, stop.time, numbers)

        def beside(h: float) -> Array:
            at = [y + h * rate for y, rate in zip(numbers, rates, strict=True)]
            return np.array(law.rates(self.system, stop.time + h, at), dtype=float)

        before, jumps = beside(-step), beside(step) - beside(-step)
        farther = float(np.abs(beside(_WIDER * step) - beside(-_WIDER * step)).max())
        if _WIDER / 2 * np.abs(jumps).max() < farther or np.abs(jumps).max() <= _STEADY * np.abs(before).max():
            return  # what jumps does so however near one looks
        moved = self._moved(law, stop, state, before.tolist())
        slopes = [
            tuple(slope - jump * shift for slope, shift in zip(one.slopes, moved, strict=True))
            for one, jump in zip(state, jumps.tolist(), strict=True)
        ]
        self.here = law, stop.time, [Dual(one.value, row) for one, row in zip(state, slopes, strict=True)]

    def _with_direction(self, law: Law, state: list[Dual]) -> list[Dual]:
        """Return the same with a slip less than all but nothing, as it was, where only rounding is left of it."""
        if "grip" not in law.ends:
            return state
        first, last = len(CONTACT), len(CONTACT) + 3
        near, *direction = self.event_parameters[law.weightless :][:4]
        size, slips = _LEFT * math.sqrt(near), state[first:last]
        if math.hypot(*(one.value for one in slips)) > size:
            return state
        before = [one.value for one in self.before[first:last]]
        length = math.hypot(*before)
        if length > math.sqrt(near):  # it may have turned since it began
            direction = [part / length for part in before]
        slips = [Dual(size * part, one.slopes) for part, one in zip(direction, slips, strict=True)]
        return [*state[:first], *slips, *state[last:]]

    def _moved(self, law: Law, stop: ZeroCrossing, state: list[Dual], rates: list[float]) -> tuple[float, ...]:
        """Return how the instant of a stop changes with the parameters."""
        ahead = [Dual(one.value, (*one.slopes, rate)) for one, rate in zip(state, rates, strict=True)]
        time = Dual(stop.time, (*(0.0,) * self.count, 1.0))
        numbers = [Dual(value_of(one), (*slopes_of(one, self.count), 0.0)) for one in self.varied.scalars()]
        system = with_numbers(self.system, numbers)
        found = corner_events.all_event_functions(system, law, time, ahead, self.event_parameters)
        *slopes, falls = (float(slope) for slope in slopes_of(found[stop.name], self.count + 1))
        self._check_crossing(law, stop, [one.value for one in state], falls)
        return tuple(-slope / falls for slope in slopes)

    def _check_crossing(self, law: Law, stop: ZeroCrossing, numbers: list[float], falls: float) -> None:
        """Refuse an event that is only just reached: with other numbers it may not come at all."""
        if stop.name.startswith("near "):  # a square, of what is all but nothing
            return
        wait = _BEFORE * law.unpack(self.system, stop.time, numbers).moment(self.system)
        try:
            before = law.rk4_step(self.system, stop.time, numbers, -wait)
            stops = corner_events.all_event_functions(self.system, law, stop.time - wait, before, self.event_parameters)
        except (ArithmeticError, ValueError):  # a step back from where the law is singular leads anywhere
            return
        if not abs(falls) * wait > _GRAZES * abs(float(stops[stop.name])):
            raise no_derivative(stop.time, f"the event there ({stop.name}) is only just reached")


class _Run(VariationalRun):
    """What is known of the derivatives on the way through a run."""

    def __init__(
        self,
        method: Integrate,
        system: RollingSystem,
        times: Array,
        duals: RollingSystem,
        begins: PhaseStart,
        count: int,
        *,
        of_motion: bool = False,
    ) -> None:
        super().__init__(method, system, times, duals, begins, count)
        self.of_motion = of_motion
        self.pieces: list[tuple[Array, Slopes]] = []
        self.events = list(begins.events)
        before = begins.across or begins
        state = np.array(stacked(before.state_vector, count), dtype=float)
        # The start, and where phases ended: the law before, the state stacked with its derivatives, and what follows.
        time = float(value_of(before.time))
        self.stops: list[tuple[Law, float, Array, PhaseStart | None]] = [(before.law, time, state, begins)]

    def keep(self, law: Law, piece: Segment) -> None:
        """Keep the derivatives of the samples."""
        slopes = slopes_of_samples(self.duals, law, piece.times, piece.states, self.count, self.of_motion)
        self.pieces.append((piece.times, slopes))

    def stopped(self, law: Law, stop: ZeroCrossing) -> None:
        """Keep where a law ended."""
        self.stops.append((law, stop.time, stop.state_vector, None))
        self.ending = stop.name

    def remember(self, follows: Follows, law: Law, stop: ZeroCrossing) -> PhaseStart | None:
        """Return what follows a stop, and keep it and its events."""
        found = super().remember(follows, law, stop)
        if self.begins is not None:
            self.stops[-1] = (*self.stops[-1][:3], self.begins)
            self.events += self.begins.events
        return found

    # Derivatives of the samples

    def instants(self, samples: Samples) -> Array:
        """Return how the instant of each event changes with the parameters."""
        times = [event.time for event in self.events]
        if samples.events and samples.events[-1].final:
            law, time, numbers, _ = self.stops[-1]
            state = unstacked(numbers.tolist(), numbers.size // (1 + self.count))
            times.append(
                self._crossing(law, ZeroCrossing(time, self.ending, np.array([one.value for one in state]))).time
            )
        return np.array([slopes_of(time, self.count) for time in times], dtype=float).reshape(-1, self.count)

    def slopes(self, samples: Samples) -> Slopes:
        """Return the derivatives at each sample."""
        known = np.concatenate([times for times, _ in self.pieces]) if self.pieces else np.empty(0)
        names = self.pieces[0][1] if self.pieces else {}
        columns = {name: np.concatenate([slopes[name] for _, slopes in self.pieces]) for name in names}
        order = np.argsort(known, kind="stable")
        places = np.searchsorted(known[order], samples.time)
        found = np.minimum(places, max(known.size - 1, 0))
        columns = {name: column[order[found]] for name, column in columns.items()}
        for i in np.flatnonzero(known[order[found]] != samples.time).tolist():
            self._fill(columns, i, float(samples.time[i]), int(samples.phase[i]))
        return columns

    def _fill(self, columns: Slopes, i: int, time: float, phase: int) -> None:
        """Work out the derivatives at a sample on an event, or in the short step across one, by the law before it."""
        law, since, state, follows = next(stop for stop in reversed(self.stops) if stop[1] <= time)
        size = state.size // (1 + self.count)
        moved = law.rk4_step(self.duals, since, unstacked(state.tolist(), size), time - since)
        row = np.array([stacked(moved, self.count)], dtype=float)
        found = slopes_of_samples(self.duals, law, np.array([time]), row, self.count, self.of_motion)
        for name, slopes in found.items():
            columns[name][i] = slopes[0]
        if self.of_motion:
            return
        if phase == SLIPPING != law.code and follows is not None and follows.law.code == SLIPPING:  # all but zero
            p, q, Omega, _, coordinates = law.split(moved)
            hat = follows.law.direction(self.duals, follows.time, follows.state_vector)
            held = isinstance(follows.law, SlippingLaw) and follows.law.held
            R = slip(self.duals, time, p, q, Omega, ZERO, coordinates, hat, held=held).reaction
            columns["contact_force"][i] = [slopes_of(part, self.count) for part in R]
