"""Periodic orbits while a number of the system changes: pseudo-arclength continuation [keller1977]."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Plottable, Serializable, pairs, table
from ...errors import InvalidValueError, SolverError
from ...mechanics import checks
from ...mechanics.parameters import parameters
from ...mechanics.system import RollingSystem
from ...solve.samples import Array
from .orbit import CLOSED, FOUND, PeriodicOrbit, described, shortest
from .returning import Move, Period, Returned, go_round, number_of, put_down, with_number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STEPS = 12  # of Newton's method, at each point
_RANK = 1e-7
_GROWS, _SHRINKS = 1.4, 0.5
_LEAST = 1e-5  # of the first step
_ROUNDS = 40  # to locate a bifurcation
_SHARP = 1e-13  # of a step


@dataclass(frozen=True, repr=False)
class OrbitBranch(Plottable, Serializable):
    """A family of periodic orbits, along one number of the system.

    Parameters
    ----------
    title : str
        Of the scenario; empty where there is none.
    name, unit : str
        Of the number, and its SI unit.
    orbits : tuple of PeriodicOrbit
        In the order of the branch; where it has a fold, the number goes back.
    values : array (n,)
        Of the number at each.
    folds : tuple of float
        Where two orbits meet and vanish: the number turns round.
    period_doublings : tuple of float
        Where a multiplier passes −1.
    stopped : tuple of str
        Why the branch ends at its beginning and at its end.

    Examples
    --------
    See `PeriodicOrbit.along`.
    """

    title: str
    name: str
    unit: str
    orbits: tuple[PeriodicOrbit, ...]
    values: Array = field(compare=False)
    folds: tuple[float, ...]
    period_doublings: tuple[float, ...]
    stopped: tuple[str, str]

    def __str__(self) -> str:
        lines = [self.title] if self.title else []
        return "\n".join([*lines, self._words, *(f"{name}: {fact}" for name, fact in self._facts)])

    @property
    def _words(self) -> str:
        return f"{len(self.orbits)} periodic orbits along {self.name}"

    @property
    def _facts(self) -> list[tuple[str, str]]:
        unit = "" if self.unit == "1" else f" {self.unit}"
        facts = [("from", f"{self.values[0]:.8g}{unit}: {self.stopped[0]}")]
        facts.append(("to", f"{self.values[-1]:.8g}{unit}: {self.stopped[1]}"))
        for name, found in (("folds", self.folds), ("period doublings", self.period_doublings)):
            facts.append((name, ", ".join(f"{value:.10g}{unit}" for value in found) or "none"))
        return facts

    def _headline(self) -> Headline:
        return Headline(self.title, self._words)

    def _parts(self) -> Iterator[Markup]:
        yield pairs(self._facts)
        shown = range(0, len(self.orbits), max(1, len(self.orbits) // 12))
        rows = [(f"{self.values[i]:.6g}", f"{self.orbits[i].period:.6g}", self.orbits[i].verdict) for i in shown]
        yield table(rows, (f"{self.name}, {self.unit}", "period, s", "verdict"), numbers=(0, 1))

    def as_dict(self) -> dict[str, Any]:
        """Return the branch in SI units and plain types, for JSON.

        Returns
        -------
        dict
            Without the states.
        """
        return {
            "title": self.title,
            "name": self.name,
            "unit": self.unit,
            "values": self.values.tolist(),
            "periods": [orbit.period for orbit in self.orbits],
            "verdicts": [orbit.verdict for orbit in self.orbits],
            "largest_multiplier": [abs(orbit.multipliers[0]) for orbit in self.orbits],
            "folds": list(self.folds),
            "period_doublings": list(self.period_doublings),
            "stopped": list(self.stopped),
        }

    def plot(self) -> Figure:
        """Draw the branch: where the orbits are at their start, what is stable drawn through, and the multipliers."""
        from matplotlib.figure import Figure

        from ...views.plots.sheet import BLUE, FAINT, VERMILION

        figure = Figure(figsize=(7.0, 6.0), layout="constrained")
        upper, lower = figure.subplots(2, 1, sharex=True)
        states = np.array([[*orbit.state.position, *orbit.state.velocity] for orbit in self.orbits])
        which = int(np.argmax(np.ptp(states, axis=0)))
        unstable = np.array([orbit.verdict == "unstable" for orbit in self.orbits])
        for mask, colour, dash, said in (
            (~unstable, BLUE, "-", "not unstable"),
            (unstable, VERMILION, "--", "unstable"),
        ):
            upper.plot(self.values, np.where(mask, states[:, which], np.nan), dash, color=colour, label=said)
        unit = "m" if which < 3 else "m/s"
        upper.set_ylabel(f"{'position' if which < 3 else 'velocity'} {'xyz'[which % 3]} at the start, {unit}")
        upper.legend(fontsize=8, frameon=False)
        sizes = np.array([[abs(one) for one in orbit.multipliers] for orbit in self.orbits])
        lower.plot(self.values, sizes, ".", markersize=3, color=BLUE)
        lower.axhline(1.0, color=FAINT, linewidth=0.8, zorder=0)
        for panel in (upper, lower):
            for value in (*self.folds, *self.period_doublings):
                panel.axvline(value, color=FAINT, linewidth=0.8, zorder=0)
        lower.set_ylabel("size of the multipliers")
        lower.set_xlabel(f"{self.name}{'' if self.unit == '1' else f', {self.unit}'}")
        figure.suptitle(self.title, fontsize=11)
        return figure


@dataclass(frozen=True)
class _Point:
    """One orbit of a branch, with the direction in which this goes on: state, period and number, in units."""

    orbit: PeriodicOrbit
    value: float
    period: Period
    direction: Array

    @property
    def doubling(self) -> float:
        """What passes zero where a multiplier passes −1."""
        M = self.orbit.returned.essential
        return float(np.linalg.det(0.5 * (M + np.eye(len(M)))))


class _Family:
    """The orbits of a system along one of its numbers."""

    def __init__(self, orbit: PeriodicOrbit, which: int, size: float) -> None:
        self.first, self.which, self.size = orbit, which, size  # size: of the number
        self.driven, self.rate = orbit.driven, orbit.rate
        self.time = orbit.state.time

    def at(self, state: Any, period: Period, value: float, move: Move) -> tuple[RollingSystem, Returned]:
        """Return a system with a value of the number, and a start gone through a period."""
        system = with_number(self.first.system, self.which, value)
        return system, go_round(system, state, period, self.which, None, self.rate, move)

    def columns(self, now: Returned) -> Array:
        """Return the slopes of what must be nothing by start, period, symmetries and number, in units."""
        parts = [now.monodromy - np.eye(now.residual.size)]
        if not self.driven:
            parts.append(now.flow[:, None] / self.rate)
        parts.append(now.symmetric)
        return np.hstack([*parts, now.by_number[:, None] * self.size])

    def ambient(self, now: Returned, move: Array) -> Array:
        """Return a step along the basis, in period and in number, as one of the state's numbers."""
        d = now.residual.size
        on_support = now.by_number_at_start * self.size * move[-1]
        return np.concatenate([now.basis @ move[:d] + on_support, move[d:]])

    def on_basis(self, now: Returned, step: Array) -> Array:
        """Return the same the other way round."""
        m = now.scale.size
        on_support = now.by_number_at_start * self.size * step[-1]
        return np.concatenate([now.basis.T @ (step[:m] - on_support), step[m:]])

    def along(self, now: Returned, direction: Array) -> Array:
        """Return how far each of `ambient`'s shares leads in a direction."""
        state, rest = np.split(direction, [now.scale.size])
        row = np.concatenate([now.basis.T @ state, rest])
        row[-1] += state @ now.by_number_at_start * self.size
        return row

    def begin(self, way: float) -> _Point:
        """Return the orbit to begin with, and how it goes on with more or less of the number."""
        value = self.value_of(self.first.system)
        system, now = self.at(self.first.state, self.first.asked_period, value, self.first.returned.move)
        columns = self.columns(now)
        move = np.append(np.linalg.lstsq(columns[:, :-1], -columns[:, -1], rcond=_RANK)[0], 1.0)
        direction = self.ambient(now, way * move / np.linalg.norm(move))
        found = described(self.first.title, system, now, self.first.asked_period, self.driven, self.rate)
        return _Point(found, value, self.first.asked_period, direction)

    def value_of(self, system: RollingSystem) -> float:
        """Return the number."""
        from ...mechanics.parameters import numbers

        return numbers(system)[self.which]

    def on(self, point: _Point, length: float) -> _Point | None:
        """Return the orbit a step on; None where Newton's method does not find it."""
        before = point.orbit.returned
        m = before.scale.size
        guess = np.concatenate([before.numbers, self._tail(point)]) + length * point.direction
        here = guess.copy()
        last = np.inf
        for _ in range(_STEPS):
            period: Period = point.period if self.driven else float(here[m]) / self.rate
            value = float(here[-1]) * self.size
            move = before.move.onward(here[here.size - 1 - len(before.move.rows) : -1])
            try:
                system = with_number(self.first.system, self.which, value)
                start = put_down(system, before.phase, before.scale * here[:m], self.time)
                system, now = self.at(start, period, value, move)
            except (SolverError, InvalidValueError, ArithmeticError):
                return None
            if now.scale.size != m:
                return None
            scaled = np.concatenate([now.numbers * now.scale / before.scale, here[m:]])
            arc = self.along(now, point.direction)
            missing = np.append(now.residual, point.direction @ (scaled - guess))
            size = float(np.linalg.norm(missing))
            if size < FOUND or (size < CLOSED and size > 0.5 * last):
                return self._point(point, system, now, period, value)
            if size > 2 * last:
                return None
            last = size
            step = shortest(np.vstack([self.columns(now), arc]), -missing)
            here = scaled + self.ambient(now, step)
        return None

    def _tail(self, point: _Point) -> Array:
        own = [] if self.driven else [float(point.period) * self.rate]  # type: ignore[arg-type]
        still = np.zeros(len(point.orbit.returned.move.rows))  # what there is of each symmetry beyond the point's own
        return np.array([*own, *still, point.value / self.size])

    def _point(self, before: _Point, system: RollingSystem, now: Returned, period: Period, value: float) -> _Point:
        """Return an orbit that was found; the direction is the old one, as far as it stays on the branch."""
        _, sizes, basis = np.linalg.svd(self.columns(now))
        sizes = np.append(sizes, np.zeros(len(basis) - len(sizes)))
        free = basis[sizes <= _RANK * max(sizes[0], 1.0)].T
        old = self.on_basis(now, before.direction)
        new = free @ (free.T @ old)
        direction = self.ambient(now, new / np.linalg.norm(new))
        found = described(self.first.title, system, now, period, self.driven, self.rate)
        return _Point(found, value, period, direction)


def follow(orbit: PeriodicOrbit, name: str, lowest: Any, highest: Any, step: float | None, most: int) -> OrbitBranch:
    """Follow an orbit along a number of its system, both ways."""
    which, value, unit = number_of(orbit.system, name)
    dimension = parameters(orbit.system)[which].dimension
    ends = (lowest, highest)
    if None in ends and value == 0:
        raise InvalidValueError("lowest", f"must be given, as well as `highest`: {name} is 0 now", lowest)
    low, high = (
        factor * value if end is None else float(checks.real(end, dimension, key))
        for end, factor, key in zip(ends, (0.5, 2.0) if value >= 0 else (2.0, 0.5), ("lowest", "highest"), strict=True)
    )
    if not low <= value <= high or low == high:
        raise InvalidValueError("lowest", f"must lie, with `highest`, about what {name} is, {value:g}", (low, high))
    family = _Family(orbit, which, high - low)
    sides = [_side(family, way, low, high, step or 1 / 40, most) for way in (-1.0, 1.0)]
    back, forth = ([*points] for points, _, _ in sides)
    points = [*back[:0:-1], *forth]
    folds = [value for _, found, _ in sides for kind, value in found if kind == "fold"]
    doublings = [value for _, found, _ in sides for kind, value in found if kind == "doubling"]
    values = np.array([point.value for point in points])
    stopped = sides[0][2], sides[1][2]
    orbits = tuple(point.orbit for point in points)
    return OrbitBranch(orbit.title, name, unit, orbits, values, tuple(sorted(folds)), tuple(sorted(doublings)), stopped)


def _side(
    family: _Family, way: float, low: float, high: float, step: float, most: int
) -> tuple[list[_Point], list[tuple[str, float]], str]:
    """Follow one way: the points, the bifurcations found, and why it ends."""
    points, first = [family.begin(way)], step
    found: list[tuple[str, float]] = []
    while len(points) < most:
        here = points[-1]
        there = family.on(here, step)
        if there is None:
            step *= _SHRINKS
            if step < _LEAST * first:
                return points, found, "no orbit is found beyond it"
            continue
        found += list(_between(family, here, there, step))
        points.append(there)
        if not low < there.value < high:
            return points, [one for one in found if low <= one[1] <= high], "the end that was asked for"
        step = min(step * _GROWS, 2 * first)
    return points, found, f"{most} points"


def _between(family: _Family, here: _Point, there: _Point, step: float) -> Iterator[tuple[str, float]]:
    """Yield the bifurcations between two points."""
    tests: tuple[tuple[str, Callable[[_Point], float]], ...] = (
        ("fold", lambda point: float(point.direction[-1])),
        ("doubling", lambda point: point.doubling),
    )
    for kind, test in tests:
        if test(here) * test(there) < 0:
            located = _located(family, here, there, step, test)
            if located is not None:
                yield kind, located


def _located(
    family: _Family, here: _Point, there: _Point, step: float, test: Callable[[_Point], float]
) -> float | None:
    """Return the number where a function of the point passes zero: the method of Brent, on the length of the step."""
    from scipy.optimize import brentq

    known = {0.0: here, step: there}

    def at(length: float) -> float:
        if length not in known:
            point = family.on(here, length)
            if point is None:
                raise SolverError("lost")
            known[length] = point
        return test(known[length])

    try:
        root = brentq(at, 0.0, step, xtol=_SHARP * step, rtol=1e-15, maxiter=_ROUNDS, disp=False)
        at(root)
    except SolverError:
        return None
    return known[root].value
