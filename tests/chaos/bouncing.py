"""A ball that bounces once in each period of a shaken table: all of it in closed form.

With the table at h = A sin ωt, Γ = Aω²/g, the ball comes off at V = gT/2 and strikes at −gT/2, T = 2πn/ω, so that
V (1 − e)/(1 + e) = ḣ. Going through one flight and one landing to first order gives the matrix of a period, of
determinant e² and trace 1 + e² + (1 + e)² ḧ/g.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

import trundle as tr

G = 9.80665


@dataclass(frozen=True)
class Bouncing:
    restitution: float
    Gamma: float
    n: int = 1
    frequency: float = 20.0  # Hz
    radius: float = 0.01
    upper: bool = False  # the other of the two phases, which is never stable

    @staticmethod
    def least(e: float, n: int = 1) -> float:
        """Γ at which such a motion first is: the fold."""
        return math.pi * n * (1 - e) / (1 + e)

    @staticmethod
    def doubling(e: float, n: int = 1) -> float:
        """Γ at which its period doubles: the trace is −1 − e²."""
        return math.hypot(Bouncing.least(e, n), 2 * (1 + e * e) / (1 + e) ** 2)

    @property
    def rate(self) -> float:
        return 2 * math.pi * self.frequency

    @property
    def period(self) -> float:
        return self.n / self.frequency

    @property
    def phase(self) -> float:
        """ωt at the landing."""
        phase = math.acos(self.least(self.restitution, self.n) / self.Gamma)
        return -phase if self.upper else phase

    @property
    def system(self) -> tr.RollingSystem:
        shaken = tr.Shake((0.0, 0.0, self.Gamma * G / self.rate**2), self.rate)
        support = tr.Support(tr.Plane(), motion=shaken, friction=0.0, restitution=self.restitution)
        return tr.RollingSystem(tr.Body.solid_sphere(self.radius, 0.01), support)

    @property
    def start(self) -> tr.State:
        """At the top of its flight."""
        height = self.Gamma * G / self.rate**2 * math.sin(self.phase) + G * self.period**2 / 8
        time = self.phase / self.rate + self.period / 2
        return tr.State((0.0, 0.0, self.radius + height), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), time=time)

    @property
    def multipliers(self) -> np.ndarray:
        e = self.restitution
        trace = 1 + e * e - (1 + e) ** 2 * self.Gamma * math.sin(self.phase)
        return np.sort_complex(np.roots([1.0, -trace, e * e]))
