"""Rolling slowly along a line, by turning about one axis: place, orientation and work as functions of the turn.

It is the whole of what a cylinder can do, and a section through what a ball can do.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import SolverError
from ...mechanics.algebra import ZERO, Quaternion, Vector
from ...mechanics.contact import Contact, contact_at, roll
from ...mechanics.system import RollingSystem
from ...solve.roots import root
from . import rest

Array = NDArray[np.float64]

TOLERANCE = 1e-13  # of the integration along the line
PER_TURN = 360  # places at which roots are bracketed
ROOT = 1e-12  # share of the scale below which the work is nothing
LOOKS, LOOKS_A_RADIAN = 6000, 250  # that it may take: more take a body that all but fits a hollow no further
NEAR = 1e-6  # rad: roots nearer than this are one


@dataclass(frozen=True)
class Line:
    """The line along which a body rolls when it turns about one axis, fixed in space."""

    system: RollingSystem  # its support at rest
    time: float  # s
    q: Quaternion  # the orientation at angle 0
    axis: Vector  # unit vector; positive angles turn about it
    low: float  # the angle from which it is known, rad
    high: float  # the angle up to which
    _numbers: Callable[[Any], Array] = field(repr=False)

    def place(self, angle: Any) -> tuple[Vector, Quaternion]:
        """Return contact point and orientation at an angle, or at an array of them."""
        numbers = self._numbers(angle)
        return Vector(*numbers[:3]), _turned(self.axis, angle, self.q)

    def distance(self, angle: Any) -> Any:
        """Return how far the contact has come along the support since angle 0, m."""
        return self._numbers(angle)[3]

    def work(self, angle: Any) -> Any:
        """Return the virtual work of the loads for each radian of rolling on, J/rad."""
        p, q = self.place(angle)
        contact = contact_at(self.system, self.time, p, q)
        return rest.virtual_work(self.system, self.time, contact, q, self.axis)

    def energy(self, angle: Any) -> Any:
        """Return the work done against the loads since angle 0, J: their energy, where they have one."""
        return self._numbers(angle)[5]

    @cached_property
    def angles(self) -> Array:
        """Angles close enough to see every root between them, rad."""
        count = max(2 * PER_TURN, math.ceil(PER_TURN * (self.high - self.low) / (2 * math.pi)))
        return np.linspace(self.low, self.high, count + 1)

    @cached_property
    def works(self) -> Array:
        """The virtual work at `angles`, J/rad."""
        return np.broadcast_to(self.work(self.angles), self.angles.shape).copy()

    @cached_property
    def scale(self) -> float:
        """What the virtual work is small against, J/rad."""
        places = [self.place(angle) for angle in self.angles[:: max(1, self.angles.size // 8)]]
        return max(rest.torque_scale(self.system, self.time, p, q) for p, q in places)

    @cached_property
    def straight(self) -> bool:
        """Whether the support is a plane all along the line."""
        p, q = self.place(self.angles)
        S = contact_at(self.system, self.time, p, q).shape_operator
        return all(not np.any(row.norm()) for row in S.rows)

    @property
    def flat(self) -> bool:
        """Whether no work is done anywhere."""
        return float(np.abs(self.works).max()) <= ROOT * self.scale

    def roots(self) -> list[float]:
        """Return the angles at which the virtual work changes sign, rad; none where it vanishes everywhere."""
        if self.flat:
            return []
        works, angles = self.works, self.angles
        found = [float(angle) for angle, work in zip(angles, works, strict=True) if abs(work) <= 1e-3 * self._small]
        found += [
            root(lambda x: float(self.work(x)), angles[i], angles[i + 1], 1e-15)
            for i in np.flatnonzero(works[:-1] * works[1:] < 0)
        ]
        return [root for root in _apart(sorted(found)) if all(abs(root - ledge) > NEAR for ledge in self.ledges)]

    @cached_property
    def ledges(self) -> list[float]:
        """The angles at which the virtual work touches zero without changing sign, rad."""
        from scipy.optimize import minimize_scalar

        if self.flat:
            return []
        size = np.abs(self.works)
        lowest = np.flatnonzero((size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:])) + 1
        # Half a step from a double root the work is of second order in the step.
        near = min(2 * self.scale * (self.angles[1] - self.angles[0]) ** 2, 1e-3 * float(size.max())) + self._small
        found = []
        for i in lowest[size[lowest] < near]:
            if self.works[i - 1] * self.works[i + 1] > 0:
                best = minimize_scalar(
                    lambda x: abs(float(self.work(x))),
                    bounds=(float(self.angles[i - 1]), float(self.angles[i + 1])),
                    method="bounded",
                    options={"xatol": 1e-9},
                )
                if best.fun <= self._small:
                    found.append(float(best.x))
        return found

    @property
    def _small(self) -> float:
        return ROOT * self.scale

    def sides(self, angle: float) -> tuple[float, float]:
        """Return the sign of the virtual work a little before an angle and a little after it."""
        step = 1e-3
        before, after = (float(self.work(angle + side)) for side in (-step, step))
        small = ROOT * self.scale
        return tuple(0.0 if abs(w) <= small else math.copysign(1.0, w) for w in (before, after))  # type: ignore[return-value]


def roll_line(
    system: RollingSystem, time: float, p: Vector, q: Quaternion, axis: Vector, most: tuple[float, float]
) -> Line:
    """Roll a body both ways from a place, turning it about a fixed axis.

    Parameters
    ----------
    system : RollingSystem
        Its support at rest.
    time : float
        s.
    p, q : Vector, Quaternion
        Where it starts.
    axis : Vector
        Along the support: positive angles move the body along axis × n.
    most : (float, float)
        How far it turns either way on a support that does not come round, rad, and at most on one that does: there it
        ends half way round the support, or three quarters where it starts under it.

    Returns
    -------
    Line
        To the rim, if that is nearer.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import E_Y
    >>> level = tr.RollingSystem(tr.Body.hoop(0.1, 1.0), tr.Support(tr.Plane()))
    >>> line = roll_line(level, 0.0, ZERO, Quaternion(1.0, 0.0, 0.0, 0.0), E_Y, (3.0, 3.0))
    >>> round(float(line.distance(2.0)), 12), line.flat
    (0.2, True)
    """
    halves = {sign: _half(system, time, p, q, axis, sign, most) for sign in (-1.0, 1.0)}

    def numbers(angle: Any) -> Array:
        at = np.asarray(angle, dtype=float)
        return np.where(at < 0, halves[-1.0].sol(np.minimum(at, 0.0)), halves[1.0].sol(np.maximum(at, 0.0)))

    low, high = float(halves[-1.0].t[-1]), float(halves[1.0].t[-1])
    return Line(system, time, q, axis, low, high, numbers)


def _half(
    system: RollingSystem, time: float, p: Vector, q: Quaternion, axis: Vector, sign: float, most: tuple[float, float]
) -> Any:
    """Integrate (p, distance, turn of the normal, work against the loads) over the angle."""
    from scipy.integrate import solve_ivp

    looks = itertools.count()

    def rates(angle: float, y: Array) -> list[float]:
        if next(looks) > LOOKS + LOOKS_A_RADIAN * abs(angle):
            return [math.nan] * y.size
        now = _turned(axis, angle, q)
        try:
            contact = contact_at(system, time, Vector(*y[:3]), now)
            moves, leans = _onward(contact, axis)
            onward = axis.cross(contact.normal)
            against = -rest.virtual_work(system, time, contact, now, axis)
        except (ArithmeticError, ValueError):  # a trial beyond the end of a formula: a shorter step stays before it
            return [math.nan] * y.size
        return [*moves, moves.dot(onward), leans.dot(onward), against]

    ends: list[Any] = _ends(system, time, p, q, axis, sign, most, rates)
    for event in ends:
        event.terminal = True
    size = contact_at(system, time, p, q).offset.norm() + p.norm()
    energy = rest.torque_scale(system, time, p, q)
    scales = np.array([size, size, size, size, 1.0, max(energy, 1e-300)])
    with np.errstate(over="ignore", invalid="ignore"):  # where nothing acts, any work is beyond measure
        done = solve_ivp(
            rates,
            (0.0, sign * most[1]),
            [*p, 0.0, 0.0, 0.0],
            "DOP853",
            rtol=TOLERANCE,
            atol=TOLERANCE * scales,
            max_step=math.pi / 6,
            dense_output=True,
            events=ends,
        )
    if not done.success and done.t.size < 2:
        raise SolverError(f"the body cannot be rolled along the support from where it starts: {done.message}")
    return done  # it also ends where no step is short enough: at a crease, or the end of a formula


def _ends(
    system: RollingSystem,
    time: float,
    p: Vector,
    q: Quaternion,
    axis: Vector,
    sign: float,
    most: tuple[float, float],
    rates: Callable[[float, Array], list[float]],
) -> list[Callable[[float, Array], float]]:
    """Return what falls through zero where a half of the line ends."""
    begin = roll(system, time, p, q, ZERO)
    # From under a support, where nothing stays, look past its other side from either hand.
    furthest = math.pi if begin.reaction.dot(begin.contact.normal) >= 0 else 1.5 * math.pi

    def comes_round(_: float, y: Array) -> float:
        return furthest - abs(y[4])

    def does_not_come_round(angle: float, y: Array) -> float:
        pace = sign * math.copysign(1.0, y[4]) * rates(angle, y)[4]  # rad of the normal for one of the body
        return max(most[0] - abs(angle), pace * (most[1] - abs(angle)) - (furthest - abs(y[4])))

    def has_room(angle: float, y: Array) -> float:
        now = _turned(axis, angle, q)
        try:
            return float(rest.room(system, contact_at(system, time, Vector(*y[:3]), now), now))
        except (ArithmeticError, ValueError):
            return -1.0

    return [comes_round, does_not_come_round, has_room]


def _onward(contact: Contact, axis: Vector) -> tuple[Vector, Vector]:
    """Return how the contact moves and how the normal leans for each radian."""
    moves = contact.rates(ZERO, axis, contact.rolling_velocity(axis))[0]
    return moves, contact.shape_operator @ moves


def _turned(axis: Vector, angle: Any, q: Quaternion) -> Quaternion:
    half = np.asarray(angle) / 2 if np.ndim(angle) else float(angle) / 2
    s = np.sin(half)
    return Quaternion(np.cos(half), axis.x * s, axis.y * s, axis.z * s) * q


def _apart(angles: list[float]) -> list[float]:
    kept: list[float] = []
    for angle in angles:
        if not kept or angle - kept[-1] > NEAR:
            kept.append(angle)
    return kept
