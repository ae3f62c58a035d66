"""Periodic orbits: found by Newton's method, through all events, with their Floquet multipliers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Serializable, pairs
from ...errors import SolverError
from ...mechanics.system import RollingSystem, State
from ...solve.samples import Array
from .asked import Asked
from .returning import Period, Returned, checked_period, go_round, knows_the_time, put_down

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
    system: Any, start: State | None = None, period: Any = None, *, tolerance: float | None = None
) -> PeriodicOrbit:
    """Find the periodic orbit next to a start, through all events, and its Floquet multipliers.

    It comes back exactly. A motion that comes back but for a shift or a turn, as a coin's that nods and drifts, is one
    for `periodic_motion`.

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
    driven = callable(meant) or knows_the_time(asked.system, _phase(asked), length)
    return refined(asked, asked.start, meant if driven else length, driven, tolerance, rate)


def _phase(asked: Asked) -> Any:
    from .tangents import beginning

    return beginning(asked.system, asked.start)


def refined(
    asked: Asked, start: State, period: Period, driven: bool, tolerance: float | None, rate: float
) -> PeriodicOrbit:
    """Return the orbit next to a guess: Newton's method, of all steps that close it the shortest."""
    system, best, last = asked.system, None, math.inf
    guess = 0.0 if callable(period) else float(period)
    for _ in range(STEPS):
        now = go_round(system, start, period, None, tolerance, rate)
        size = float(np.linalg.norm(now.residual))
        if best is None or size < best[0]:
            best = (size, now, period)
        if size < FOUND or (best[0] < CLOSED and size > 0.5 * last):
            break
        last = size
        columns = now.monodromy - np.eye(now.residual.size)
        if not driven:
            columns = np.hstack([columns, now.flow[:, None] * (_CHEAP / rate)])
        move = shortest(columns, -now.residual)
        if not driven:
            longer, known = float(move[-1]) * _CHEAP / rate, float(period)  # type: ignore[arg-type]
            part = min(1.0, _PART * known / max(abs(longer), 1e-300))
            period, move = known + part * longer, part * move[:-1]
            if not guess / _FAR <= period <= guess * _FAR:
                break
        start = moved(system, now, move)
    if best is None or best[0] > CLOSED:
        left = math.inf if best is None else best[0]
        raise SolverError(
            f"No motion that closes was found near the start: the best fails by {left:.1e} of its size. Begin nearer "
            "to one, give a better `period`, or ask `periodic_motion` for what comes back but for a shift and a turn."
        )
    if not driven and np.linalg.norm(best[1].flow) < _STILL * rate:
        raise SolverError("What was found stands still: any time is a period of it. Begin further away from rest.")
    return described(asked.title, system, best[1], best[2], driven, rate)


def described(
    title: str, system: RollingSystem, now: Returned, period: Period, driven: bool, rate: float
) -> PeriodicOrbit:
    """Return what a start that closes is as an orbit."""
    values = sorted((complex(one) for one in np.linalg.eigvals(now.monodromy)), key=lambda one: (-abs(one), one.imag))
    length = float(period(system)) if callable(period) else period
    size = float(np.linalg.norm(now.residual))
    return PeriodicOrbit(title, system, now.start, length, driven, tuple(values), size, now.events, now, period, rate)


def shortest(columns: Array, right: Array) -> Array:
    """Return the shortest step that solves linear equations, at most so long."""
    step = np.linalg.lstsq(columns, right, rcond=RANK)[0]
    return np.asarray(step * min(1.0, LONGEST / max(float(np.linalg.norm(step)), 1e-300)))


def moved(system: RollingSystem, now: Returned, move: Array) -> State:
    """Return a start a step along the basis away."""
    values = now.scale * (now.numbers + now.basis @ move)
    return put_down(system, now.phase, values, now.start.time)
