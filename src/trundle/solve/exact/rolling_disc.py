"""How a disc or hoop nods on a level plane: its lean in one quadrature, by the Legendre functions of T10.

The two constants of the linear pair give both other rates as functions of the lean, and the energy gives the lean's
own. A closed form of the lean, not of the time; the period is an integral.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import OutOfDomainError, SolverError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.invariants.legendre import Rim, covers, rim_of, transfer, upright_rates
from ...mechanics.system import RollingSystem, State
from ..roots import root

_NODES = 4096  # of the quadrature, at most
_DOMAIN = (
    "The Legendre form T10 covers a disc or hoop on its sharp rim, alike about its axis, on a level plane at rest, "
    "under gravity alone."
)


@dataclass(frozen=True)
class Nodding:
    """How the lean of a disc or hoop goes up and down, in one quadrature.

    Parameters
    ----------
    rim : Rim
        The body.
    spin, turning : float
        The two constants: Ω·e and Ω·n with the disc upright, rad/s.
    energy : float
        ½mV² + ½Ω·JΩ + m g z, J.
    weight : float
        m g, N.
    """

    rim: Rim
    spin: float
    turning: float
    energy: float
    weight: float

    @staticmethod
    def of(system: RollingSystem, start: State) -> Nodding:
        """Read the constants from a start."""
        rim = rim_of(system.body)
        if rim is None or not covers(system):
            raise OutOfDomainError(_DOMAIN)
        q, Omega, V = Quaternion(*start.orientation), Vector(*start.angular_velocity), Vector(*start.velocity)
        spin, turning = (float(sum(terms)) for terms in upright_rates(rim, q, Omega))
        weight = float(system.body.mass * system.gravity)
        J = system.body.inertia_in_space(q.matrix())
        energy = 0.5 * system.body.mass * V.dot(V) + 0.5 * Omega.dot(J @ Omega) + weight * start.position[2]
        return Nodding(rim, spin, turning, float(energy), weight)

    def rates(self, x: Any) -> tuple[Any, Any]:
        """Return ω₃ and η at x = e·n, rad/s."""
        a, b, c, d = transfer(x, self.rim)
        return a * self.spin + b * self.turning, c * self.spin + d * self.turning

    def square(self, x: Any) -> Any:
        """Return ẋ², 1/s², by the energy; negative where the disc cannot be."""
        rim, room = self.rim, 1.0 - np.square(x)
        spin, eta = self.rates(x)
        about_axis = rim.along + rim.mass * rim.radius**2
        left = self.energy - 0.5 * rim.across * np.square(eta) / room - 0.5 * about_axis * np.square(spin)
        left = left - self.weight * rim.radius * np.sqrt(room)
        return 2.0 * room * left / (rim.across + rim.mass * rim.radius**2)

    def turning_points(self, x: float) -> tuple[float, float]:
        """Return the lowest and highest x = e·n between which the disc nods, about one that it passes."""
        grid = np.sort(np.append(np.tanh(np.linspace(-12, 12, 4001)), x))
        square = self.square(grid)
        low, high = (self._end(grid, square, int(np.searchsorted(grid, x)), step) for step in (-1, 1))
        return low, high

    def _end(self, grid: Any, square: Any, here: int, step: int) -> float:
        """Return where ẋ² falls to 0, going from a place of the grid to one side."""
        i, scale = here, float(np.abs(square[np.abs(grid) < 0.99]).max())
        if square[here] <= 1e-12 * scale and not square[here + step] > 0:
            return float(grid[here])  # it starts at this turning point
        i += step * (square[here] <= 0)
        while 0 <= i + step < grid.size and square[i + step] > 0:
            i += step
        if not 0 <= i + step < grid.size:
            raise SolverError("The disc falls flat: its lean has no turning point before.")
        ends = sorted((float(grid[i]), float(grid[i + step])))
        return root(lambda u: float(self.square(u)), ends[0], ends[1], 1e-16)

    def period(self, x: float) -> float:
        """Return the time in which the lean goes down and up again, s."""
        low, high = self.turning_points(x)
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        known, nodes = math.inf, 16
        while nodes <= _NODES:
            phi = (np.arange(nodes) + 0.5) * math.pi / nodes
            at = middle - half * np.cos(phi)
            value = float(np.mean(half * np.sin(phi) / np.sqrt(self.square(at))) * 2 * math.pi)
            if abs(value - known) <= 1e-12 * abs(value):
                return value
            known, nodes = value, 2 * nodes
        raise SolverError("The quadrature of T10 did not settle: the motion comes too near to one that never returns.")
