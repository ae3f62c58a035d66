"""A run beside another: the same method again, and a closed form beside a numerical method."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from ..errors import OutOfDomainError, TurnsTooFastError
from ..mechanics.system import RollingSystem, State
from ..solve.dense import Dense
from ..solve.exact import ClosedForm
from ..solve.methods import Method
from ..solve.runge_kutta import FINEST
from ..solve.samples import FLIGHT, SLIPPING, Event, Samples
from .bounds import (
    A_ROUNDING,
    A_STEP,
    EXACT,
    SINGULAR,
    SOLVER,
    Array,
    before_a_singular_end,
    bound_of,
    largest,
    own_sizes,
    pace_of,
    sizes_of,
    turned_in,
)
from .card import CardFigure, checked
from .each_sample import EachSample
from .friction import normal_and_friction, slip_of
from .growth import MOST, NEAR_THE_END, Growth, alike, at_the_same_times, growth, numerical, parted, same_events
from .landings import landings_of

_INSTANTS = 200
_EVENTS_BEFORE, _EVENTS_AFTER = 3, 5  # the first by which two runs differ, over which a small change is followed
_WORK_FOLLOWED = 2e9  # products, in all of a dozen runs: a second or two
_WORK_FINER = 1.5e9  # products, up to which a run is followed more finely: a second or two
_OF_SPEEDS = 4e-16  # of those at the contact, that slip is their difference: two roundings
_RUNS = 12  # about: the run itself, and one for each way in which its state can change
_MOST_RADIANS = 50_000.0  # of turning that a cross-check follows


def same_again(
    system: RollingSystem, start: State, ours: Samples, again: Samples, method: Method, kept: Dense | None
) -> Iterator[CardFigure]:
    """Compare samples with the same method run again: then what is checked of that run holds for them."""
    end, (ours, theirs) = float(max(ours.time[-1], again.time[-1])), at_the_same_times(ours, again)
    turned, sizes = turned_in(ours), sizes_of(system, ours)
    sizes |= {"contact": sizes["position"]}
    coarser = method
    if method.name == "taylor" and any(event.kind == "slip" for event in ours.events):
        coarser = replace(method, tolerance=max(method.tolerance, FINEST))  # so the first moments of slip are followed
    both = Compared(system, start, ours, theirs, coarser, method, sizes, turned, kept, end)
    turned_apart = both.turns * both.bound / both.angle_bound
    said = f"gives the same motion, force, orientation and events at {ours.time.size} instants"
    yield both.figure("the method run again", np.maximum(both.share, turned_apart), both.bound, said)
    told = both.alike & (ours.time < both.parts)  # from other events on they may be in any phase
    other = int(((ours.phase != theirs.phase) & told).sum())
    if ours.events or other or (ours.phase != ours.phase[0]).any():
        yield checked("phase", other, 0, "samples in another phase than the method run again has")


def finer(system: RollingSystem, start: State, at: Samples, method: Method, kept: Dense | None) -> Iterator[CardFigure]:
    """Compare a Runge-Kutta run with one of a smaller tolerance: how exact it is, its tolerance alone does not say."""
    if method.name != "runge-kutta" or method.tolerance <= FINEST or kept is None:
        return
    with_more = replace(method, tolerance=max(FINEST, method.tolerance / 10))
    some = at.part(slice(None, None, max(1, at.time.size // _INSTANTS)))
    some = some.part(kept.work_until(some.time) <= _WORK_FINER)
    if some.time.size < 2:
        return
    theirs = with_more.solve(system, start, some.time)
    end, (ours, theirs) = float(max(some.time[-1], theirs.time[-1])), at_the_same_times(some, theirs)
    both = Compared(system, start, ours, theirs, method, method, sizes_of(system, ours), turned_in(at), kept, end)
    said = f"beside a run of tolerance {with_more.tolerance:g}, at {ours.time.size} instants"
    if kept.work > _WORK_FINER:
        said += f" up to {some.time[-1]:.6g} s"
    yield both.figure("accuracy reached", both.share, both.bound, said)


def cross_check(
    system: RollingSystem,
    start: State,
    at: Samples,
    method: Method,
    motion: ClosedForm | None,
    kept: Dense | None = None,
) -> Iterator[CardFigure]:
    """Compare a closed form with a numerical method, whichever of the two made the run."""
    if motion is None:
        return
    other = numerical(method) if method.name == "exact" else Method.of("exact")
    finer = numerical(method)
    name = f"closed form against {'Taylor' if finer.name == 'taylor' else 'Runge-Kutta'}"
    span, speed = float(at.time[-1] - start.time), largest(at.angular_velocity)
    times = start.time + np.linspace(0.0, min(span, _MOST_RADIANS / max(speed, 1e-300)), _INSTANTS)
    ours = method.solve(system, start, times)
    solve: Callable[[Array], Samples] = partial(other.solve, system, start)
    if method.name == "exact":  # what the other takes says how far changed starts can be followed
        solve = other.dense(system, start, float(times[-1]))
        kept = solve if isinstance(solve, Dense) else None
    try:
        theirs = solve(times)
    except TurnsTooFastError:  # nothing to compare with
        return
    except OutOfDomainError:  # the run comes into a phase that no closed form covers: up to there
        times = times[times < min((event.time for event in ours.events), default=times[-1])]
        if not times.size:
            return
        try:
            ours, theirs = method.solve(system, start, times), solve(times)
        except OutOfDomainError as error:  # which happens at another instant, or to one of them only
            yield checked(name, np.inf, 0.0, str(error).partition(". ")[0])
            return
    end, (ours, theirs) = float(max(ours.time[-1], theirs.time[-1])), at_the_same_times(ours, theirs)
    turned = speed * float(ours.time[-1] - start.time)
    both = Compared(system, start, ours, theirs, finer, finer, sizes_of(system, ours), turned, kept, end)
    over = f"over {ours.time[-1] - start.time:g} s, {ours.time.size} instants"
    yield both.figure(name, both.share, both.bound, f"position, velocity, Ω, force, events; {over}")
    alone = "; exact from the place alone" if motion.fixed_axis_rotation(0.0) is not None else ""
    note = f"angle between the two, after {turned:.3g} rad{alone}"
    allowed = 100 * finer.tolerance * max(10.0, turned)  # the error of Ω added up over the turning
    yield both.figure(f"{name}, orientation", both.turns, allowed, note, "rad")


@dataclass(frozen=True)
class Compared:
    """Two runs from one start at the same times."""

    system: RollingSystem  # what moved
    start: State  # from where
    ours: Samples
    theirs: Samples  # at the same times
    method: Method  # the coarser of the two
    follower: Method  # follows changed starts
    sizes: dict[str, float]  # against what a difference of each quantity is small or not
    turned: float  # by about how many radians the body turned
    kept: Dense | None = None  # a run by the method that follows changed starts, gone through once
    end: float = -np.inf  # s, of the longer of the two, of which the shorter may have ended at an event

    @property
    def bound(self) -> float:
        """The share that the method may be off; more than a hundredth says nothing."""
        return min(bound_of(self.method, self.turned), MOST)

    @property
    def _steps(self) -> float:
        """About how many steps it took, each with an error of its own: one a radian, or as many as were counted."""
        if self.kept is not None:
            return max(self.turned, self.kept.steps)
        return max(self.turned, pace_of(self.system, self.ours) * float(self.ours.time[-1] - self.start.time))

    @property
    def angle_bound(self) -> float:
        """The angle that the method may be off, rad: rounding, and the error of Ω, add up over the turning."""
        return max(EXACT, 1e-15 * self.turned, 100 * self.method.tolerance * self.turned)

    @cached_property
    def parts(self) -> float:
        """When something first happened to one of them alone, s."""
        return parted(self.ours, self.theirs, self.end)

    @cached_property
    def alike(self) -> NDArray[np.bool_]:
        """Which samples can be compared: those between the same events."""
        return alike(self.ours, self.theirs)

    @cached_property
    def share(self) -> Array:
        """The difference at each sample, as a share; at a singular end only the orientation says something."""
        known = self.alike.copy()
        known[before_a_singular_end(self.ours).time.size :] = False
        blurred = {"contact_force": self._swung, "contact": self._passed_on}
        apart = _difference(self.ours, self.theirs, self.sizes, blurred)
        return np.where(known, apart, 0.0)

    @cached_property
    def _swung(self) -> Array:
        """How far friction swings between the two, N: of slip that is all but over, a rounding is a large part."""
        which = np.flatnonzero((self.ours.phase == SLIPPING) & (self.theirs.phase == SLIPPING))
        found = np.zeros(self.ours.time.size)
        if which.size:
            ours, theirs = self.ours.part(which), self.theirs.part(which)
            (s, speeds), (other, _) = slip_of(self.system, ours), slip_of(self.system, theirs)
            apart = np.linalg.norm(s - other, axis=1) + _OF_SPEEDS * speeds
            slower = np.minimum(np.linalg.norm(s, axis=1), np.linalg.norm(other, axis=1))
            friction = np.linalg.norm(normal_and_friction(self.system, ours)[1], axis=1)
            found[which] = friction * np.minimum(2.0, 2 * apart / np.maximum(slower, 1e-300))
        return found

    @cached_property
    def _passed_on(self) -> Array:
        """How far what the place may be off moves a nearest point in flight, m: by a focal point, anywhere."""
        which = np.flatnonzero((self.ours.phase == FLIGHT) & (self.theirs.phase == FLIGHT))
        found = np.zeros(self.ours.time.size)
        if which.size and "contact" in self.sizes:
            each = EachSample(self.system, self.ours.part(which), self.bound)
            gap = (each.apart[0] * each.normals).sum(axis=1)
            determinant = np.abs(each.touch.relative_curvature_determinant(gap))
            with np.errstate(divide="ignore"):
                found[which] = self.bound * self.sizes["position"] / determinant
        return found

    @cached_property
    def turns(self) -> Array:
        """The largest of the angle between the orientations, rad, and the shares of the support's angle and rate."""
        coordinates = np.abs(self.ours.support_coordinates - self.theirs.support_coordinates)
        coordinates = coordinates / own_sizes(self.system, self.ours, self.sizes)
        return np.maximum(self.angle, np.where(self.alike, coordinates.max(axis=1, initial=0.0), 0.0))

    @cached_property
    def angle(self) -> Array:
        """The angle between the orientations, rad, each with the sign that is continuous from the start on."""
        ours, theirs = self.ours.orientation, self.theirs.orientation
        side = np.sign(ours[0] @ theirs[0]) if len(ours) else 1.0
        apart = 2 * np.linalg.norm(ours - side * theirs, axis=1)
        return np.where(self.alike, apart, 0.0)

    @cached_property
    def growth(self) -> Growth:
        """What the motion does to a small difference; worked out only where the plain bound does not hold.

        Not over all of a run of many events, or of many steps, but from shortly before it holds no longer to shortly
        after: up to there a difference is as small as it was seen to be.
        """
        events = np.array([event.time for event in self.theirs.events if not event.final])
        apart = min(self._apart_from, float(self.ours.time[-1]))
        met = int(np.searchsorted(events, self._apart_from))
        begin, end = met - _EVENTS_BEFORE, met + _EVENTS_AFTER
        before, upto = self._affordable(apart, events[begin] if begin > 0 else -np.inf)
        if end < events.size:
            upto &= self.ours.time < events[end]
        if before < 0:
            return growth(self.system, self.start, self.ours.part(upto), self.follower, self.sizes, self.kept)
        start = self.theirs.state(before)
        carried = np.maximum(self.share, self.turns * self.bound / self.angle_bound)[: before + 1]
        upto &= self.ours.time >= start.time
        grown = growth(self.system, start, self.ours.part(upto), self.follower, self.sizes, self.kept)
        return replace(grown, carried=float(carried.max()), skipped=int(np.searchsorted(events, start.time)))

    def _affordable(self, apart: float, first: float) -> tuple[int, NDArray[np.bool_]]:
        """Return from which sample, -1 for the start, up to which others a small change is followed in a dozen runs.

        From before an event, s, and shortly before they are apart, s. All of the runs together take no more work than a
        second or two; or, where that does not lead from one sample to the next, than the run itself took.
        """
        times = self.ours.time
        if self.kept is None:
            return int(np.searchsorted(times, first)) - 1, np.ones(times.size, dtype=bool)
        taken, most = self.kept.work_until(times), _WORK_FOLLOWED / _RUNS
        here = float(self.kept.work_until(np.array([apart]))[0])
        now = int(np.searchsorted(times, apart))
        before = int(max(np.searchsorted(times, first), np.searchsorted(taken, here - most / 2))) - 1
        if before >= 0 and here - taken[before] > most:
            before = now - 1
        begun = float(taken[before]) if before >= 0 else 0.0
        least = float(taken[min(now, times.size - 1)])
        upto: NDArray[np.bool_] = taken <= max(begun + most, min(least, begun + self.kept.work / _RUNS))
        return before, upto

    @cached_property
    def _apart_from(self) -> float:
        """When the two are first farther apart than the plain bounds, s."""
        apart = (self.share > self.bound) | (self.turns > self.angle_bound)
        count = self._shifts.size
        shifted = [
            event.time for event, by in zip(self.ours.events[:count], self._shifts, strict=True) if by > self.bound
        ]
        return min([self.parts, *self.ours.time[apart][:1].tolist(), *shifted[:1]])

    @cached_property
    def _shifts(self) -> Array:
        """How far events of the same kinds are apart: their times as a share of the run, their states of the sizes."""
        count = same_events(self.ours.events, self.theirs.events)
        pairs = zip(self.ours.events[:count], self.theirs.events, strict=False)
        span = max(float(self.ours.time[-1] - self.start.time), 1e-300)
        return np.array([max(abs(mine.time - other.time) / span, self._apart(mine, other)) for mine, other in pairs])

    def _apart(self, mine: Event, other: Event) -> float:
        """Return how far the states at an event differ, as a share."""
        pairs = [(mine.before, other.before), (mine.after, other.after)]
        # At a singular end a rounding of the lean is more than one of the place, of the contact and of V.
        singular = mine.kind in SINGULAR
        told = ("angular_velocity",) if singular else ("position", "velocity", "angular_velocity")
        sizes = {field: self.sizes[field] for field in told}
        moved = np.subtract(mine.contact or other.contact or 0.0, other.contact or mine.contact or 0.0) * (not singular)
        apart = [
            float(np.linalg.norm(np.subtract(getattr(one, field), getattr(its, field)))) / max(size, 1e-300)
            for one, its in pairs
            if one is not None and its is not None
            for field, size in {**sizes, "orientation": self.angle_bound / self.bound}.items()
        ]
        return max(float(np.linalg.norm(moved)) / max(self.sizes["position"], 1e-300), *apart)

    @cached_property
    def _delays(self) -> Array:
        """Each landing's time, and how many times larger an error of the place in flight shows at it, and after it.

        A change of the start does not show it: what lifted off was in contact, whatever the start. By an error δ of the
        gap it comes down δ/|sₙ| later, which is long where it all but grazes the support, and at another speed. A
        rounding of ρ, too, turns a body that is light to turn.
        """
        span = max(float(self.ours.time[-1] - self.start.time), 1e-300)
        size, speed, force = (max(self.sizes[field], 1e-300) for field in ("position", "velocity", "contact_force"))
        turning = self.turned / span * self.bound / self.angle_bound
        pace = max(1 / span, speed / size, force / (float(self.system.body.mass) * speed), turning)
        turns = A_ROUNDING * SOLVER / (A_STEP * self.bound) * size / max(self.sizes["angular_velocity"], 1e-300)
        rows = []
        for landing in landings_of(self.system, self.ours.events[: self._shifts.size]):
            if landing.jolted:
                continue
            closing = max(-float(landing.comes @ landing.n), 1e-300)
            jumps = float(np.linalg.norm(landing.goes - landing.comes)) / speed
            turned = turns * float(np.linalg.norm(landing.impulse) / np.linalg.eigvalsh(landing.J)[0])
            after = max(size * landing.pull / closing**2 * jumps, turned)
            rows.append((landing.before.time, size * pace / closing, after))
        return np.array(rows).reshape(-1, 3)

    def _delayed(self, times: Array) -> Array:
        """Return how many times larger an error of the place in flight shows at given times."""
        landed, then, after = self._delays.T
        past = np.concatenate([[0.0], np.maximum.accumulate(after)])[np.searchsorted(landed, times, side="right")]
        return np.max([past, *(late * (times == at) for at, late in zip(landed, then, strict=True))], axis=0)

    def _undecided(self, grown: Growth) -> float:
        """Return when one of the two touches the support by less than an error of its place; infinite where none does.

        What it strikes at a speed s, pulled at a, it would have entered by s²/2a.
        """
        known = self._shifts.size
        for run in (self.ours, self.theirs):
            for landing in landings_of(self.system, run.events[: known + 1]):
                time, closing = landing.before.time, float(landing.comes @ landing.n)
                place = grown.widened(self.bound, self._steps, grown.at(np.array([time]))) * self.sizes["position"]
                if not landing.jolted and closing**2 < 2 * landing.pull * float(place[0]):
                    return time
        return np.inf

    def figure(self, name: str, share: Array, bound: float, said: str, unit: str = "") -> CardFigure:
        """Return the figure of a difference: where a plain bound does not hold, with what the motion magnifies."""
        parts = self.parts
        plain = max(float(np.max(share, initial=0.0)), float(np.max(self._shifts, initial=0.0)) * bound / self.bound)
        if plain <= bound and parts == np.inf:
            return checked(name, plain, bound, said, unit)
        grown = self.growth
        undecided = self._undecided(grown)
        until = min(grown.told_until(bound, self._steps), np.nextafter(undecided, -np.inf))
        events = np.array([event.time for event in self.ours.events[: self._shifts.size]])
        magnified = np.maximum(grown.at(self.ours.time), self._delayed(self.ours.time))
        allowed = grown.widened(bound, self._steps, magnified)
        told = (self.ours.time <= until) & ((allowed < MOST) | (allowed <= bound))
        until = min([until, *self.ours.time[(self.ours.time <= until) & ~told][:1].tolist()])
        last = float(self.ours.time[-1])
        later = np.pad(grown.shifted, (grown.skipped, max(0, events.size - grown.skipped - grown.shifted.size)))
        later = np.max([later[: events.size], grown.at(events), self._delayed(events)], axis=0)  # times and states
        allowed_then = grown.widened(bound, self._steps, later)
        sooner = NEAR_THE_END * (last - self.start.time)
        known = (np.minimum(events, max(self.end, last) - sooner) <= until) & (
            (allowed_then < MOST) | (allowed_then <= bound)
        )
        alone = [np.inf] if min(parts, last) <= until and parts < np.inf else []  # something happened to one of them
        values = np.concatenate([share[told], self._shifts[known] * bound / self.bound, alone])
        bounds = np.concatenate([allowed[told], allowed_then[known], [bound] * len(alone)])
        worst = int(np.argmax(values / bounds)) if values.size else 0
        said += (
            f"; a change of the start shows {grown.at(np.array([min(until, self.ours.time[-1])]))[0]:.2g} times larger"
        )
        if until < self.ours.time[-1]:
            why = (
                "up to which a change is followed"
                if until == grown.times[-1]
                else "where a rounding decides whether it touches"
                if until >= np.nextafter(undecided, -np.inf)
                else "where a rounding has grown too large"
            )
            said += f"; nothing can be told beyond t = {until:.6g} s, {why}"
        if told.sum() < 2:
            return CardFigure(name, float(np.max(share)), unit, note=f"{said}: no verdict")
        return checked(name, float(values[worst]), float(bounds[worst]), said, unit)


def _difference(ours: Samples, theirs: Samples, sizes: dict[str, float], blurred: dict[str, Array]) -> Array:
    """Return the largest difference at each sample as a share of the quantity's size, but for what is blurred."""
    shares = [
        np.maximum(np.linalg.norm(getattr(ours, field) - getattr(theirs, field), axis=1) - blurred.get(field, 0.0), 0.0)
        / max(size, 1e-300)
        for field, size in sizes.items()
    ]
    return np.max(shares, axis=0)


__all__ = ["cross_check", "finer", "same_again"]
