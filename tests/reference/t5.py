"""A sphere on a plane in fifty digits, written from the theory page alone: T5, its rates, Ω and the contact force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mpmath
from mpmath import mpc, mpf

DIGITS = 90  # φ₂ at |λt| = 1e-18 loses 36 of them: more than fifty are left
ULP = 2.0**-52
SMALLEST = 2.0**-1022  # below it floats have fewer digits


@dataclass(frozen=True)
class Quantity:
    """A value (a complex number for the two components in the plane), its terms' magnitudes, and its rate of change."""

    value: Any
    terms: Any
    rate: Any

    def bound(self, t: Any, phases: float = 1.0) -> float:
        """Return what a float may be off: 1e-13 of the terms, and the last place of the phase κt."""
        return float(mpf("1e-13") * self.terms + phases * ULP * abs(t * self.rate) + SMALLEST)


@dataclass(frozen=True)
class Ball:
    """The numbers of one ball, in the order of the closed form's own."""

    radius: float
    mass: float
    inertia_ratio: float
    rate: float
    position: tuple[float, float]
    velocity: tuple[float, float] = (0.0, 0.0)
    spin: float = 0.0
    force: tuple[float, float, float] = (0.0, 0.0, 0.0)
    torque: tuple[float, float, float] = (0.0, 0.0, 0.0)
    drag: float = 0.0

    def at(self, time: Any) -> dict[str, Quantity]:
        """Return position, velocity, angular velocity and contact force at one time."""
        with mpmath.workdps(DIGITS):
            return self._at(mpf(time))

    def _at(self, t: Any) -> dict[str, Quantity]:
        a, m, k, omega, c = map(mpf, (self.radius, self.mass, self.inertia_ratio, self.rate, self.drag))
        z0, v0, F = mpc(*self.position), mpc(*self.velocity), mpc(*self.force[:2])
        kx, ky, kz = map(mpf, self.torque)
        kappa, gamma = omega * k / (1 + k), c / (m * (1 + k))
        lam, phi = mpc(-gamma, kappa), (F + mpc(ky, -kx) / a) / (m * (1 + k))
        turned, phi1, phi2 = entire(lam * t)
        moved, pushed = t * phi1 * v0, t * t * phi2 * phi
        zeta = z0 + moved + pushed
        kept, gained = turned * v0, t * phi1 * phi
        V = kept + gained
        A = lam * V + phi
        terms_z = abs(z0) + abs(moved) + abs(pushed)
        terms_v = abs(kept) + abs(gained)
        terms_a = abs(lam) * terms_v + abs(phi)
        jerk = lam * A
        return {
            "position": Quantity(zeta, terms_z, V),
            "velocity": Quantity(V, terms_v, A),
            "angular_velocity": Quantity(
                (1j * V + omega * zeta) / a, (terms_v + abs(omega) * terms_z) / a, (1j * A + omega * V) / a
            ),
            "contact_force": Quantity(m * A - F + c * V, m * terms_a + abs(F) + c * terms_v, m * jerk + c * A),
            "spin": Quantity(
                self.spin + kz * t / (k * m * a * a), abs(self.spin) + abs(kz * t / (k * m * a * a)), mpf(0)
            ),
        }


def entire(z: Any) -> tuple[Any, Any, Any]:
    """Return eᶻ, φ₁(z) = (eᶻ − 1)/z and φ₂(z) = (φ₁(z) − 1)/z."""
    if z == 0:
        return mpc(1), mpc(1), mpc(0.5)
    turned = mpmath.exp(z)
    phi1 = (turned - 1) / z
    return turned, phi1, (phi1 - 1) / z
