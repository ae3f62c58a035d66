"""The rolling law as a flow on ten numbers (p, q, Ω), its slopes, and the surface on which these numbers live.

Nothing of the mechanics is written again: the rates are those of `roll`, and slopes come from a step along the
imaginary axis through the same functions, which loses no digits however small it is. Where a formula does not bear
complex numbers, differences of the eighth order take its place.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.contact import Rolling, contact_at, normal_at, roll
from ...mechanics.system import RollingSystem, State
from . import symmetry

Array = NDArray[np.float64]
Function = Callable[[Any], Any]

STEP = 1e-30  # along the imaginary axis, in units of the state's own scale
WIDTHS = (4e-3, 8e-4, 1.6e-4)  # between the points of a difference, likewise; narrower where the law bends more
_EIGHTH = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))  # weights of the central difference of order 8
_AGREE = 1e-7  # to which the two kinds of slope agree where both are sound


@dataclass(frozen=True)
class Flow:
    """The rates of (p, q, Ω) in a frame that stands still or turns with the support."""

    system: RollingSystem  # its support at rest or turning steadily
    time: float  # at which the law is read, s
    turning: float  # the rate of the frame about the support's axis, rad/s; 0 where the law is the same at all times
    scale: Array  # (10,): what is large of p, q and Ω, in their units
    by_complex_step: bool = True  # whether slopes come from a step along the imaginary axis

    @property
    def length(self) -> float:
        """What is large of a length here, m."""
        return float(self.scale[0])

    @property
    def rate(self) -> float:
        """What is large of an angular velocity here, rad/s."""
        return float(self.scale[9])

    def law(self, y: Any) -> Rolling:
        """Return what the rolling law says of one state, (10,), or of many, (10, n)."""
        return roll(self.system, self.time, Vector(*y[:3]), Quaternion(*y[3:7]), Vector(*y[7:]))

    def rates(self, y: Any) -> Any:
        """Return the rates of the ten numbers in the frame, same shape."""
        now = self.law(y)
        parts = [*now.point_rate, *now.orientation_rate, *now.angular_acceleration]
        rates = np.stack([np.broadcast_to(part, np.shape(y)[1:]) for part in parts])
        return rates if self.turning == 0 else rates - self.turning * symmetry.moved_by(symmetry.TURN, y)

    def slopes(self, function: Function, y: Array, directions: Array) -> Array:
        """Return the derivatives of a function of the ten numbers along some directions."""
        if self.by_complex_step:
            return np.imag(function(y[:, None] + 1j * STEP * directions)) / STEP
        return differences(function, y, directions)

    def tangent(self, y: Array) -> Array:
        """Return a basis of the moves that keep the body on the support and |q| = 1: (10, 8), in units of scale."""
        n = normal_at(self.system, self.time, Vector(*y[:3]))
        rows = np.zeros((2, 10))
        rows[0, :3], rows[1, 3:7] = [float(part) for part in n], y[3:7]
        return np.linalg.svd(rows)[2][2:].T

    def put_back(self, y: Array) -> Array:
        """Return the nearest state with the contact on the support and q of length 1."""
        p = Vector(*(float(part) for part in y[:3]))
        for _ in range(8):
            gap, steep, n = self._gap(p)
            if abs(gap) <= 1e-16 * self.length or steep == 0:
                break
            p = p - n * (gap / steep)
        q = y[3:7] / np.linalg.norm(y[3:7])
        return np.array([*p, *q, *y[7:]], dtype=float)

    def _gap(self, p: Vector) -> tuple[float, float, Vector]:
        """Return φ(p), its slope along the normal, and the normal."""
        support = self.system.support
        pose, n = support.motion.at(self.time), normal_at(self.system, self.time, p)
        own = pose.local(p)
        up = (pose.rotation.transpose @ n) * (1e-4 * self.length)
        level = support.surface.level
        return float(level(own)), float((level(own + up) - level(own - up)) / (2e-4 * self.length)), n

    def state(self, y: Array) -> State:
        """Return a start for `trundle.simulate`."""
        contact = contact_at(self.system, self.time, Vector(*map(float, y[:3])), Quaternion(*map(float, y[3:7])))
        V = contact.rolling_velocity(Vector(*map(float, y[7:])))
        q = tuple(float(part) for part in y[3:7])
        return State(triple(contact.centre), triple(V), triple(Vector(*y[7:])), q, self.time)  # type: ignore[arg-type]


def differences(
    function: Function, y: Array, directions: Array, *, rough: bool = False, wide: float = WIDTHS[0]
) -> Array:
    """Return derivatives along directions by central differences of the eighth order, or roughly, of the second."""
    total: Any = 0.0
    wide = 0.1 * wide if rough else wide
    for count, weight in ((1, 0.5),) if rough else _EIGHTH:
        step = count * wide * directions
        total = total + weight * (function(y[:, None] + step) - function(y[:, None] - step))
    return np.asarray(total, dtype=float) / wide


def bears_complex_numbers(flow: Flow, y: Array) -> bool:
    """Tell whether the law's formulas give true slopes when stepped along the imaginary axis."""
    directions = np.diag(flow.scale)
    try:
        exact = flow.slopes(flow.rates, y, directions)
    except (TypeError, ValueError):
        return False
    size = np.abs(exact).max(axis=1) + 1e-3 * flow.scale * flow.rate
    rough = (differences(flow.rates, y, directions, wide=wide) for wide in WIDTHS)
    return any(bool(np.all(np.abs(exact - one) <= _AGREE * size[:, None])) for one in rough)


def scale_of(system: RollingSystem, y: Array, time: float) -> Array:
    """Return what is large of p, q and Ω: the body's size, 1, and the fastest of its rates."""
    contact = contact_at(system, time, Vector(*y[:3]), Quaternion(*y[3:7]))
    length = float(contact.offset.norm())
    force = system.loads_on(_still(system, time, y))[0].norm() / system.body.mass
    turning = system.support.motion.mean_rate
    rate = max(float(np.linalg.norm(y[7:])), abs(float(turning)), math.sqrt(float(force) / length), 1e-3)
    return np.array([length] * 3 + [1.0] * 4 + [rate] * 3)


def _still(system: RollingSystem, time: float, y: Array) -> Any:
    from ...mechanics.loads import BodyMotion

    zero = Vector(0.0, 0.0, 0.0)
    contact = contact_at(system, time, Vector(*y[:3]), Quaternion(*y[3:7]))
    return BodyMotion(time, system.body.mass, contact.centre, zero, Quaternion(*y[3:7]), zero, contact.normal)


def triple(v: Vector) -> tuple[float, float, float]:
    """Return a vector's components as plain numbers."""
    return float(v.x) + 0.0, float(v.y) + 0.0, float(v.z) + 0.0
