"""A charged particle in crossed fields, by the textbook's formulas: gyration about a guiding centre that drifts.

Nothing here knows of a ball. The formulas are those of [jackson1999], sections 12.2 and 12.3, and for a medium that
resists the drift of a charge that collides, [chen2016], chapter 5.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...display import Displayed, Markup, number, numbers, pairs
from ...errors import InvalidValueError, OutOfDomainError
from ...mechanics import checks

Array = NDArray[np.float64]
ELEMENTARY_CHARGE = 1.602176634e-19  # C, exact by definition (26th CGPM, 2018)
ELECTRON_MASS = 9.1093837139e-31  # kg, CODATA 2022
_TERMS = 22  # of the power series below one radian: 1/22! is 1e-21


@dataclass(frozen=True)
class ChargedParticle(Displayed):
    """A slow charged particle in a uniform magnetic field along n and a uniform electric field across it.

    It obeys the Lorentz force, M dv/dt = Q(E + v×B) − C v, in the plane that n is the normal of.

    Parameters
    ----------
    mass : float or quantity
        M, kg.
    charge : float
        Q, C; negative for an electron.
    magnetic_field : float
        B along the third axis, T; positive points at whoever looks down on the plane.
    electric_field : pair of float
        E in the plane, V/m.
    position : pair of float or quantities
        At t = 0, m.
    velocity : pair of float or quantities
        At t = 0, m/s.
    resistance : float or quantity
        C of a medium that slows it by −C v, kg/s.

    Raises
    ------
    InvalidValueError
        If a number is not finite, the mass is not positive or the charge is zero.

    Examples
    --------
    An electron that starts at rest in crossed fields comes to rest once in each turn, E/B times the period further on:

    >>> electron = ChargedParticle(ELECTRON_MASS, -ELEMENTARY_CHARGE, 0.01, (100.0, 0.0))
    >>> x, y = electron.position_at(electron.period)
    >>> round(float(y / (electron.drift_velocity[1] * electron.period)), 12)
    1.0
    """

    mass: float
    charge: float
    magnetic_field: float
    electric_field: tuple[float, float] = (0.0, 0.0)
    position: tuple[float, float] = (0.0, 0.0)
    velocity: tuple[float, float] = (0.0, 0.0)
    resistance: float = 0.0

    def __post_init__(self) -> None:
        def store(name: str, value: Any) -> None:
            object.__setattr__(self, name, value)

        store("mass", checks.positive(self.mass, "mass", "mass"))
        store("charge", checks.real(self.charge, "number", "charge"))
        if self.charge == 0:
            raise InvalidValueError("charge", "must not be zero", self.charge, "No field turns what has no charge.")
        store("magnetic_field", checks.real(self.magnetic_field, "number", "magnetic_field"))
        store("electric_field", checks.components(self.electric_field, "number", "electric_field", 2))
        store("position", checks.components(self.position, "length", "position", 2))
        store("velocity", checks.components(self.velocity, "velocity", "velocity", 2))
        store("resistance", checks.non_negative(self.resistance, "damping", "resistance"))

    def _parts(self) -> Iterator[Markup]:
        way = "out of the plane" if self.magnetic_field > 0 else "into the plane" if self.magnetic_field else ""
        yield pairs(
            [
                ("mass M", number(self.mass, unit="kg")),
                ("charge Q", number(self.charge, unit="C")),
                ("magnetic field B", number(self.magnetic_field, unit=f"T along n, {way}".rstrip(", "))),
                ("electric field E", numbers(self.electric_field, unit="V/m")),
                ("at first at", numbers(self.position, unit="m")),
                ("with the velocity", numbers(self.velocity, unit="m/s")),
                ("resistance C", number(self.resistance, unit="kg/s")),
                ("one turn", number(self.period, unit="s") if self.magnetic_field else ""),
            ]
        )

    # What the fields say

    @property
    def gyration_rate(self) -> float:
        """−QB/M, the cyclotron frequency with its sense: a positive charge turns clockwise about B, rad/s."""
        return -self.charge * self.magnetic_field / self.mass

    @property
    def period(self) -> float:
        """2πM/|QB|, the time of one turn, whatever the speed, s; infinite where there is no magnetic field."""
        turning = abs(self.charge * self.magnetic_field)
        return 2 * math.pi * self.mass / turning if turning else math.inf

    @property
    def drift_velocity(self) -> tuple[float, float]:
        """The velocity of the guiding centre, m/s: E×B/B², the same for every charge and mass.

        In a medium that resists it is the velocity at which the forces balance, Q(E + v×B) = C v.
        """
        self._need_balance()
        (ex, ey), b = self.electric_field, self.magnetic_field
        if self.resistance == 0.0:
            return ey / b, -ex / b
        # v = Q [C E + Q E×B]/(C² + Q²B²), divided by the larger of the two that are squared.
        c, h = self.resistance, self.charge * b
        size = max(c, abs(h))
        scale = self.charge / size / ((c / size) ** 2 + (h / size) ** 2)
        return scale * (c / size * ex + h / size * ey), scale * (c / size * ey - h / size * ex)

    @property
    def larmor_radius(self) -> float:
        """M|v − v_drift|/|QB|, the radius of the turns, m; without a medium it stays the same."""
        self._need_gyration()
        (vx, vy), (ux, uy) = self.velocity, self.drift_velocity
        return self.mass * math.hypot(vx - ux, vy - uy) / abs(self.charge * self.magnetic_field)

    def guiding_centre(self, t: Any) -> tuple[Any, Any]:
        """Return the point about which the particle turns, r + M(v − v_drift)×B/(QB²), which drifts steadily.

        Parameters
        ----------
        t : float or array
            Time, s.

        Returns
        -------
        x, y : float or array
            m.

        Raises
        ------
        OutOfDomainError
            If there is no magnetic field, or a medium: then nothing turns steadily.

        Examples
        --------
        >>> ChargedParticle(1.0, 1.0, -2.0, velocity=(0.0, 1.0)).guiding_centre(3.0)
        (-0.5, 0.0)
        """
        self._need_gyration()
        (x, y), (vx, vy), (ux, uy) = self.position, self.velocity, self.drift_velocity
        arm = self.mass / (self.charge * self.magnetic_field)
        return x + arm * (vy - uy) + ux * t, y - arm * (vx - ux) + uy * t

    def potential_energy(self, x: Any, y: Any) -> Any:
        """Return −Q E·r, J: constant along the lines across E, as height is along level lines."""
        return -self.charge * (self.electric_field[0] * x + self.electric_field[1] * y)

    def _need_gyration(self) -> None:
        if self.magnetic_field == 0.0 or self.resistance > 0.0:
            raise OutOfDomainError(
                "A guiding centre exists only in a magnetic field, without a medium that resists; "
                f"here B = {self.magnetic_field:g} T and C = {self.resistance:g} kg/s."
            )

    def _need_balance(self) -> None:
        if self.magnetic_field == 0.0 and self.resistance == 0.0:
            raise OutOfDomainError("Without a magnetic field and a medium nothing holds the charge to a steady drift.")

    # Its motion

    def position_at(self, t: Any) -> tuple[Any, Any]:
        """Return where the particle is.

        Parameters
        ----------
        t : float or array
            Time since the start, s.

        Returns
        -------
        x, y : float or array
            m.

        Examples
        --------
        Without a magnetic field it falls along E:

        >>> ChargedParticle(2.0, 4.0, 0.0, (3.0, 0.0)).position_at(1.0)
        (3.0, 0.0)
        """
        x, y, _, _ = self._motion(t)
        return x, y

    def velocity_at(self, t: Any) -> tuple[Any, Any]:
        """Return how fast the particle moves, m/s, at times t in s; as `position_at`."""
        _, _, vx, vy = self._motion(t)
        return vx, vy

    def _motion(self, t: Any) -> tuple[Any, Any, Any, Any]:
        times = np.asarray(t, dtype=float)
        turned = np.abs(self.gyration_rate * times) + self.resistance / self.mass * np.abs(times)
        near = turned < 1.0
        parts = np.empty((4, *times.shape))
        if np.any(near):
            parts[:, near] = self._series(times[near])
        if not np.all(near):
            parts[:, ~near] = self._gyration(times[~near])
        return tuple(parts) if times.ndim else tuple(float(part) for part in parts)  # type: ignore[return-value]

    def _gyration(self, t: Array) -> Array:
        """Return position and velocity as those of a circle, or spiral, about a drifting centre."""
        (x, y), (vx, vy), (ux, uy) = self.position, self.velocity, self.drift_velocity
        rate, decay = self.gyration_rate, self.resistance / self.mass
        c, s, fading = np.cos(rate * t), np.sin(rate * t), np.exp(-decay * t)
        wx, wy = vx - ux, vy - uy  # the velocity of the gyration, at first and then
        nx, ny = fading * (c * wx - s * wy), fading * (s * wx + c * wy)
        # Its arm: the gyration is the arm's derivative, w = (rate n× − decay) arm.
        size = rate * rate + decay * decay
        gone_x, gone_y = nx - wx, ny - wy
        dx, dy = (rate * gone_y - decay * gone_x) / size, (-rate * gone_x - decay * gone_y) / size
        return np.stack([x + ux * t + dx, y + uy * t + dy, ux + nx, uy + ny])

    def _series(self, t: Array) -> Array:
        """Return the same by the power series of the motion: each derivative of the force follows from the last.

        From M dv/dt = Q(E + v×B) − C v the acceleration obeys M da/dt = Q a×B − C a, and so does each derivative.
        It holds for B = 0, too, where it ends after the acceleration.
        """
        (x, y), (vx, vy), (ex, ey) = self.position, self.velocity, self.electric_field
        turn, decay = self.charge * self.magnetic_field / self.mass, self.resistance / self.mass
        push = self.charge / self.mass
        ax, ay = push * ex + turn * vy - decay * vx, push * ey - turn * vx - decay * vy
        moved = np.zeros((4, *t.shape))
        power = np.ones_like(t)  # tⁿ/n!
        terms = []
        for n in range(1, _TERMS + 1):
            power = power * t / n
            terms.append(np.stack([ax * power * t / (n + 1), ay * power * t / (n + 1), ax * power, ay * power]))
            ax, ay = turn * ay - decay * ax, -turn * ax - decay * ay
        for term in reversed(terms):  # the small ones first
            moved += term
        return moved + np.stack([x + vx * t, y + vy * t, np.full_like(t, vx), np.full_like(t, vy)])
