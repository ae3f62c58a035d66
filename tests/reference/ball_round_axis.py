"""A ball on a surface of revolution that turns steadily, worked out by hand: none of trundle's mechanics is used.

The contact is at the distance s from the axis and the angle φ about it, the meridian z = h(s) leans by ψ = atan h′(s),
and the body is above. With t along the meridian, e_φ around the axis and n the normal, the centre is at p + a n and

    V = ω×p − Ω×ρ,  ρ = −a n,
    V·t = ṡ (√(1 + h′²) − a ψ′),  V·e_φ = (s − a sin ψ) φ̇,  ṅ = −ψ̇ t − sin ψ φ̇ e_φ,
    I Ω̇ = −a n×(m V̇ − F),  so that  P V̇ (1 + k) = k P(ω×ṗ + a Ω×ṅ) + P F/m,

P being the projection on the surface: Newton's and Euler's laws with the constraint differentiated once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

Array = Any
G = 9.80665


@dataclass(frozen=True)
class Around:
    """A ball of radius a and ratio k on the meridian h(s), given by its slope and bend; the support turns at ω."""

    a: float
    k: float
    rate: float
    height: Callable[[float], float]
    slope: Callable[[float], float]
    bend: Callable[[float], float]

    def frame(self, s: float, phi: float) -> tuple[Array, Array, Array, Array]:
        """Return p, t, e_φ and n."""
        psi = np.arctan(self.slope(s))
        out, around = np.array([np.cos(phi), np.sin(phi), 0]), np.array([-np.sin(phi), np.cos(phi), 0])
        up = np.array([0, 0, 1.0])
        point = s * out + self.height(s) * up
        return point, np.cos(psi) * out + np.sin(psi) * up, around, -np.sin(psi) * out + np.cos(psi) * up

    def rates(self, _: float, state: Array) -> Array:
        """Return the rates of s, φ and Ω."""
        s, phi, Omega, a = state[0], state[1], state[2:], self.a
        p, t, around, n = self.frame(s, phi)
        psi, psi_slope = np.arctan(self.slope(s)), self.bend(s) / (1 + self.slope(s) ** 2)
        omega = np.array([0, 0, self.rate])
        V = np.cross(omega, p) + a * np.cross(Omega, n)
        s_rate = V @ t / (np.hypot(1, self.slope(s)) - a * psi_slope)
        phi_rate = V @ around / (s - a * np.sin(psi))
        n_rate = -psi_slope * s_rate * t - np.sin(psi) * phi_rate * around
        p_rate = V - a * n_rate
        along = np.eye(3) - np.outer(n, n)
        known = np.cross(omega, p_rate) + a * np.cross(Omega, n_rate)
        fall = np.array([0, 0, -G])
        acceleration = along @ (self.k * known + fall) / (1 + self.k) + n * (known @ n)
        Omega_rate = -np.cross(n, acceleration - fall) / (self.k * a)
        return np.array([s_rate, phi_rate, *Omega_rate])

    def solve(self, position: Array, Omega: Array, times: Array) -> Array:
        """Return the centre at each time, from the contact's first x and y."""
        first = [np.hypot(*position), np.arctan2(position[1], position[0]), *Omega]
        done = solve_ivp(self.rates, (0, times[-1]), first, "DOP853", times, rtol=1e-12, atol=1e-13)
        assert done.success
        frames = (self.frame(s, phi) for s, phi in done.y[:2].T)
        return np.array([p + self.a * n for p, _, _, n in frames])
