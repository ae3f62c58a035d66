"""T12 with slip: where a ball that rolls off the top of a dome begins to slip, and where it leaves the dome then."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..roots import root


@dataclass(frozen=True)
class OffADome:
    """A ball that rolls from the top of a fixed dome, slips where friction gives way, and leaves it (T12b, T12c).

    Parameters
    ----------
    inertia_ratio : float
        k = I/(m a²).
    friction : float
        μ, static and kinetic.
    speed : float
        v²/(gℓ) of the centre on the top, less than 1.

    Examples
    --------
    >>> rough, slick = OffADome(0.4, 1e6), OffADome(0.4, 1e-9)
    >>> round(math.cos(rough.lifts_at), 6), round(math.cos(slick.lifts_at), 6)  # 10/17 and 2/3
    (0.588235, 0.666667)
    """

    inertia_ratio: float
    friction: float
    speed: float = 0.0

    @property
    def slips_at(self) -> float:
        """θ of (3 + k)μ cos θ − k sin θ = μ[2 + (1 + k)v²/(gℓ)], rad from the top (T12b)."""
        k, mu = self.inertia_ratio, self.friction
        size, lean = math.hypot((3 + k) * mu, k), math.atan2(k, (3 + k) * mu)
        return math.acos(mu * (2 + (1 + k) * self.speed) / size) - lean

    def rolling(self, angle: float) -> float:
        """Return ℓθ̇²/g at an angle from the top while it rolls, from the energy."""
        return self.speed + 4 * math.sin(0.5 * angle) ** 2 / (1 + self.inertia_ratio)

    def slipping(self, angle: float) -> float:
        """Return ℓθ̇²/g while it slips: u = [(4μ² − 2) cos θ − 6μ sin θ]/(1 + 4μ²) + C e^{2μθ} (T12c).

        Examples
        --------
        >>> dome = OffADome(0.4, 0.3)
        >>> round(dome.slipping(dome.slips_at) - dome.rolling(dome.slips_at), 15)
        0.0
        """
        begin = self.slips_at
        rest = self.rolling(begin) - self._driven(begin)
        return self._driven(angle) + rest * math.exp(2 * self.friction * (angle - begin))

    def _driven(self, angle: float) -> float:
        mu = self.friction
        return ((4 * mu * mu - 2) * math.cos(angle) - 6 * mu * math.sin(angle)) / (1 + 4 * mu * mu)

    @property
    def lifts_at(self) -> float:
        """θ at which the normal force has gone, cos θ = u(θ), rad from the top."""

        def left(angle: float) -> float:
            return math.cos(angle) - self.slipping(angle)

        begin = self.slips_at
        end = min(0.5 * math.pi, begin + 300 / self.friction)  # no exponential overflows on the way
        return root(left, begin, end)
