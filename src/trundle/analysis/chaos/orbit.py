"""Periodic orbits: found by Newton's method, through all events, with their Floquet multipliers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Serializable, pairs
from ...errors import InvalidValueError, SolverError
from ...mechanics.system import RollingSystem, State
from ...solve.laws import RollingLaw
from ...solve.samples import Array
from ...solve.transitions import PhaseStart
from ..steady.finding import scale_of
from ..steady.flow import Flow, bears_complex_numbers
from ..steady.periodic import bringing_back
from ..steady.symmetry import COUNT, common, symmetries
from .asked import Asked
from .returning import Move, Period, Returned, checked_period, go_round, knows_the_time, put_down
from .tangents import beginning

if TYPE_CHECKING:
    from .branch import OrbitBranch

FOUND = 1e-11  # closing error in units of the scale: as good as it gets
CLOSED = 1e-9  # likewise: what is more has not closed
STEPS = 30
LONGEST = 0.3  # step of Newton's method in units of the scale
RANK = 1e-8
_CHEAP = 1e3  # how much rather the period is changed than the state: a swing that does not close need not be smaller
_PART, _FAR = 0.2, 4.0  # of a period: the longest step in it, and how far from the guess it may end
_STILL = 1e-9  # of the rate: what moves less stands still
_ASKED = (0.0, 0.29, 0.61)  # shares of a period at which a law that knows the time is asked for its symmetries
_ONE = 1e-4  # from 1: a multiplier that differs less is 1, for several of them that are 1 part by the root of rounding


@dataclass(frozen=True, repr=False)
class PeriodicOrbit(Serializable):
    """A motion that comes back to where it was, and what becomes of nudges in a period.

    Parameters
    ----------
    title : str
        Of the scenario; empty where there is none.
    system : RollingSystem
        What moves.
    state : State
        One instant of it: a start for `trundle.simulate`.
    period : float
        s.
    driven : bool
        Whether the period is that of what drives the motion; else it is the motion's own, and was found.
    multipliers : tuple of complex
        Floquet's: by which nudges are multiplied in one period, the largest first.
    residual : float
        How far it fails to close, in units of the scale.
    events : int
        In each period.
    turned : float
        By how much all has turned about the support's axis in a period, rad, to within whole turns, where it comes back
        but for a shift and a turn; else 0.

    Examples
    --------
    A ball swings in a trough like a pendulum:

    >>> import trundle as tr
    >>> trough = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    >>> swing = tr.periodic_orbit(trough, trough.place(position=(0.001, 0.0)), period=1.5)
    >>> round(swing.period / (2 * math.pi * math.sqrt(1.4 * 0.4 / 9.80665)), 6)
    1.0
    >>> swing.verdict
    'neutral'
    """

    title: str
    system: RollingSystem
    state: State
    period: float
    driven: bool
    multipliers: tuple[complex, ...]
    residual: float
    events: int
    turned: float
    returned: Returned = field(repr=False, compare=False)
    asked_period: Period = field(repr=False, compare=False)
    rate: float = field(repr=False, compare=False)

    @property
    def free(self) -> int:
        """How many multipliers are 1: along the motion, a symmetry, or a family of such motions."""
        return sum(abs(one - 1) < _ONE for one in self.multipliers)

    @property
    def verdict(self) -> str:
        """The words "unstable", "stable", "stable to first order" or "neutral", from the multipliers that are not 1."""
        sizes = [abs(one) for one in self.multipliers if abs(one - 1) >= _ONE]
        if not sizes:
            return "neutral"
        if max(sizes) > 1 + 1e-6:
            return "unstable"
        return "stable" if max(sizes) < 1 - 1e-6 else "stable to first order"

    def along(
        self, name: str, lowest: Any = None, highest: Any = None, *, step: float | None = None, most: int = 200
    ) -> OrbitBranch:
        """Follow the orbit while a number of the system changes, also round folds.

        Parameters
        ----------
        name : str
            Such as "support.tilt"; an unknown one is answered with all there are.
        lowest, highest : float or quantity, optional
            Where to stop; absent: half and twice what the number is.
        step : float, optional
            Of the first step, as a share of the range; absent: a fortieth.
        most : int
            Points, either way.

        Returns
        -------
        OrbitBranch
            With folds and period doublings located.

        Examples
        --------
        >>> import trundle as tr
        >>> trough = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
        >>> swing = tr.periodic_orbit(trough, trough.place(position=(0.001, 0.0)), period=1.5)
        >>> branch = swing.along("gravity", 9.0, 10.0)
        >>> branch.folds, branch.period_doublings
        ((), ())
        """
        from .branch import follow

        return follow(self, name, lowest, highest, step, most)

    def __str__(self) -> str:
        lines = [self.title] if self.title else []
        lines.append(f"periodic orbit, {self.verdict}")
        return "\n".join([*lines, *(f"{name}: {fact}" for name, fact in self._facts)])

    @property
    def _facts(self) -> list[tuple[str, str]]:
        own = "of what drives it" if self.driven else "its own"
        others = [one for one in self.multipliers if abs(one - 1) >= _ONE]
        facts = [("period", f"{self.period:.10g} s, {own}"), ("closes to", f"{self.residual:.1e}")]
        if len(self.returned.move.rows):
            facts.append(("but for a shift, and a turn by", f"{math.degrees(self.turned):.10g}°"))
        facts.append(("multipliers", ", ".join(complex_in_words(one) for one in others) or "none but 1"))
        if self.free:
            facts.append(("and 1", f"{self.free} times"))
        if self.events:
            facts.append(("events in a period", str(self.events)))
        return facts

    def _headline(self) -> Headline:
        return Headline(self.title, self.verdict)

    def _parts(self) -> Iterator[Markup]:
        yield pairs(self._facts)

    def as_dict(self) -> dict[str, Any]:
        """Return everything in SI units and plain types, for JSON.

        Returns
        -------
        dict
            Multipliers as pairs of real and imaginary part.

        Examples
        --------
        >>> import trundle as tr
        >>> trough = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
        >>> tr.periodic_orbit(trough, trough.place(position=(0.001, 0.0)), period=1.5).as_dict()["driven"]
        False
        """
        return {
            "title": self.title,
            "period": self.period,
            "driven": self.driven,
            "multipliers": [[one.real, one.imag] for one in self.multipliers],
            "verdict": self.verdict,
            "residual": self.residual,
            "events": self.events,
            "turned": self.turned,
            "state": {
                "position": self.state.position,
                "velocity": self.state.velocity,
                "angular_velocity": self.state.angular_velocity,
                "orientation": self.state.orientation,
                "time": self.state.time,
            },
        }


def complex_in_words(value: complex) -> str:
    """Return a complex number as text.

    Examples
    --------
    >>> complex_in_words(-0.5 + 0j), complex_in_words(0.25 - 0.5j)
    ('-0.5', '0.25 - 0.5i')
    """
    if abs(value.imag) <= 1e-9 * max(1.0, abs(value)):
        return f"{value.real:.8g}"
    return f"{value.real:.8g} {'-' if value.imag < 0 else '+'} {abs(value.imag):.8g}i"


def periodic_orbit(
    system: Any,
    start: State | None = None,
    period: Any = None,
    *,
    relative: bool = False,
    tolerance: float | None = None,
) -> PeriodicOrbit:
    """Find the periodic orbit next to a start, through all events, and its Floquet multipliers.

    It comes back exactly, or, where you say so, but for a shift and a turn, as a coin's does that nods and drifts. How
    long such a motion takes `periodic_motion` finds by itself.

    Parameters
    ----------
    system : RollingSystem, Scenario, str or path
        A system, a scenario, the name of one that ships, or a file.
    start : State, optional
        Where the search begins; absent: the scenario's, or ``system.place()``.
    period : float, quantity or callable
        Where the law depends on the time, the period that is meant, s: that of the support, or a multiple; a function
        of the system where a number changes it. Elsewhere about how long the motion takes to come back: what it is
        exactly is found.
    relative : bool
        Whether it may come back shifted and turned, by a move that changes nothing that matters: a symmetry of the
        law. Multipliers along symmetries are left out. The motion has to begin and end with rolling.
    tolerance : float, optional
        Of the method; absent: its own.

    Returns
    -------
    PeriodicOrbit
        With its multipliers by the variational equations, and its verdict.

    Raises
    ------
    SolverError
        If Newton's method finds nothing that closes, or the motion ends before a period is over.

    Source: Floquet's theorem, see [hairer1993], section I.12; through events by saltation matrices, [leine2004].

    Examples
    --------
    >>> import trundle as tr
    >>> inside = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> swing = tr.periodic_orbit(inside, inside.place(position=(0.01, 0.0)), period=1.5)
    >>> swing.residual < 1e-9
    True
    """
    asked = Asked.of(system, start)
    meant = checked_period(period, asked.system)
    length = float(meant(asked.system)) if callable(meant) else meant
    rate = 1 / asked.moment
    now = beginning(asked.system, asked.start)
    driven = callable(meant) or knows_the_time(asked.system, now, length)
    move = _first_move(asked, now, length, driven, tolerance) if relative else Move.none()
    return refined(asked, asked.start, meant if driven else length, driven, tolerance, rate, move)


def _first_move(asked: Asked, now: PhaseStart, length: float, driven: bool, tolerance: float | None) -> Move:
    """Return the shift and turn that bring a motion as near to its start as may be after about a period."""
    if not isinstance(now.law, RollingLaw) or len(now.state_vector) != COUNT + 1:
        rule = "may be true only where the body rolls at the start, on a support that is not free to turn"
        raise InvalidValueError("relative", rule, True)
    y, times = np.array(now.state_vector, dtype=float), now.time + length * np.array(_ASKED)
    system = replace(asked.system, support=replace(asked.system.support, friction=None))
    flow = Flow(system, now.time, 0.0, scale_of(system, y, now.time))
    flow = replace(flow, by_complex_step=bears_complex_numbers(flow, y))
    kept = common([symmetries(replace(flow, time=time), y) for time in times.tolist()[: len(times) if driven else 1]])
    end = go_round(asked.system, asked.start, length, None, tolerance, flow.rate, Move.none()).end
    return Move(kept, bringing_back(flow, y, kept, end)[0])


def refined(
    asked: Asked, start: State, period: Period, driven: bool, tolerance: float | None, rate: float, move: Move
) -> PeriodicOrbit:
    """Return the orbit next to a guess: Newton's method, of all steps that close it the shortest."""
    system, best, last = asked.system, None, math.inf
    guess = 0.0 if callable(period) else float(period)
    for _ in range(STEPS):
        now = go_round(system, start, period, None, tolerance, rate, move)
        size = float(np.linalg.norm(now.residual))
        if best is None or size < best[0]:
            best = (size, now, period)
        if size < FOUND or (best[0] < CLOSED and size > 0.5 * last):
            break
        last = size
        columns = np.hstack([now.monodromy - np.eye(now.residual.size), _CHEAP * now.symmetric])
        if not driven:
            columns = np.hstack([columns, now.flow[:, None] * (_CHEAP / rate)])
        step = shortest(columns, -now.residual)
        if not driven:
            longer, known = float(step[-1]) * _CHEAP / rate, float(period)  # type: ignore[arg-type]
            part = min(1.0, _PART * known / max(abs(longer), 1e-300))
            period, step = known + part * longer, part * step[:-1]
            if not guess / _FAR <= period <= guess * _FAR:
                break
        start = moved(system, now, step[: now.residual.size])
        move = move.onward(_CHEAP * step[now.residual.size :])
    if best is None or best[0] > CLOSED:
        left = math.inf if best is None else best[0]
        raise SolverError(
            f"No motion that closes was found near the start: the best fails by {left:.1e} of its size. Begin nearer "
            "to one, give a better `period`, or ask with `relative=True` for one but for a shift and a turn."
        )
    if not driven and np.linalg.norm(best[1].flow) < _STILL * rate:
        raise SolverError("What was found stands still: any time is a period of it. Begin further away from rest.")
    return described(asked.title, system, best[1], best[2], driven, rate)


def described(
    title: str, system: RollingSystem, now: Returned, period: Period, driven: bool, rate: float
) -> PeriodicOrbit:
    """Return what a start that closes is as an orbit."""
    values = sorted((complex(one) for one in np.linalg.eigvals(now.essential)), key=lambda one: (-abs(one), one.imag))
    length = float(period(system)) if callable(period) else period
    size = float(np.linalg.norm(now.residual))
    own = tuple(values), size, now.events, now.move.turned
    return PeriodicOrbit(title, system, now.start, length, driven, *own, now, period, rate)


def shortest(columns: Array, right: Array) -> Array:
    """Return the shortest step that solves linear equations, at most so long."""
    step = np.linalg.lstsq(columns, right, rcond=RANK)[0]
    return np.asarray(step * min(1.0, LONGEST / max(float(np.linalg.norm(step)), 1e-300)))


def moved(system: RollingSystem, now: Returned, move: Array) -> State:
    """Return a start a step along the basis away."""
    values = now.scale * (now.numbers + now.basis @ move)
    return put_down(system, now.phase, values, now.start.time)
