"""How a body at rest moves when it is nudged: the modes of the linearised rolling law."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import Vector

Array = NDArray[np.float64]

NOTHING = 1e-9  # of the natural size of H: below it a mode is indifferent
ROUNDING = 1e-15  # of the largest number of H
PARALLEL = 1e-6  # two ways of moving that differ less are one


@dataclass(frozen=True)
class Mode:
    """One way to move about an equilibrium, growing or oscillating as exp(λt).

    Examples
    --------
    >>> Mode(2j, (0.0, 1.0, 0.0), (0.1, 0.0, 0.0)).frequency
    2.0
    """

    # λ, 1/s: of the two that belong together the one with the larger real, else the positive imaginary part
    rate: complex
    turn: tuple[float, float, float]  # the axis about which the body turns, a unit vector of the support frame
    moves: tuple[float, float, float]  # how far the contact moves for one radian of that turn, m

    @property
    def frequency(self) -> float:
        """Of the oscillation, rad/s; 0 where it does not oscillate."""
        return abs(self.rate.imag)

    @property
    def growth(self) -> float:
        """The rate at which a nudge grows, 1/s; negative where it dies away."""
        return self.rate.real

    @property
    def kind(self) -> str:
        """One of "stable", "unstable" and "indifferent"."""
        if self.rate == 0:
            return "indifferent"
        return "unstable" if self.rate.real > 0 else "stable"


def modes_of(H: Array, G: Array, turns: Array, moves: Array, scale: float) -> tuple[Mode, ...]:
    """Return the modes of δφ̈ = H δφ + G δφ̇.

    Examples
    --------
    >>> one = np.array([[1.0]])
    >>> modes_of(-4 * one, 0 * one, np.eye(3)[:1], np.eye(3)[:1], 1.0)[0].rate
    2j
    """
    least = math.sqrt(NOTHING * scale)
    damped = np.abs(G).max() > NOTHING * least
    found = _damped(H, G) if damped else [(cmath.sqrt(mu), v) for mu, v in _eigen(H)]
    modes = []
    for rate, v in found:
        v = np.real(v * np.conj(v[np.argmax(np.abs(v))]))
        axis = v @ turns
        size = float(np.linalg.norm(axis))
        clean = complex(*(0.0 if abs(part) < least else float(part) for part in (rate.real, rate.imag)))
        if clean.imag and abs(clean.real) < NOTHING * abs(clean.imag):
            clean = complex(0.0, clean.imag)
        modes.append(Mode(clean, _triple(axis / size), _triple(v @ moves / size)))
    rank = {"unstable": 0, "stable": 1, "indifferent": 2}
    return tuple(sorted(modes, key=lambda mode: (rank[mode.kind], -abs(mode.rate))))


def _eigen(H: Array) -> list[tuple[complex, Array]]:
    # LAPACK balances a matrix first: by numbers of 1e-45, all that rounding has left, it would scale the others away.
    values, vectors = np.linalg.eig(np.where(np.abs(H) < ROUNDING * np.abs(H).max(), 0.0, H))
    return [(complex(value), vectors[:, i]) for i, value in enumerate(values)]


def _damped(H: Array, G: Array) -> list[tuple[complex, Array]]:
    """Return the eigenvalues of the law with its speeds: of two that belong to one way of moving, the slower to die."""
    count = len(H)
    whole = np.block([[np.zeros_like(H), np.eye(count)], [H, G]])
    found: list[tuple[complex, Array]] = []
    for rate, v in sorted(_eigen(whole), key=lambda pair: -pair[0].real):
        way = v[:count] / max(float(np.linalg.norm(v[:count])), 1e-300)
        twin = any(other.imag == 0 and abs(np.vdot(way, known)) > 1 - PARALLEL for other, known in found)
        if rate.imag > 0 or (rate.imag == 0 and not twin):
            found.append((rate, way))
    return found


def on_the_spot(mode: Mode, normal: Vector) -> bool:
    """Tell whether a body turns about the normal: one that tips over its rim stays where it is, too, and falls.

    Examples
    --------
    >>> on_the_spot(Mode(3.0, (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)), Vector(0.0, 0.0, 1.0))
    False
    """
    return Vector(*mode.turn).cross(normal).norm() < PARALLEL


def stability_of(modes: tuple[Mode, ...], normal: Vector) -> str:
    """Return "unstable" where any mode grows, "stable" where any other swings or dies away, else "indifferent".

    How it turns on the spot does not count.

    Examples
    --------
    >>> stability_of((Mode(0j, (0.0, 1.0, 0.0), (0.1, 0.0, 0.0)),), Vector(0.0, 0.0, 1.0))
    'indifferent'
    """
    kinds = {mode.kind for mode in modes if not on_the_spot(mode, normal)}
    return next((kind for kind in ("unstable", "stable") if kind in kinds), "indifferent")


def _triple(v: Array) -> tuple[float, float, float]:
    x, y, z = (float(part) + 0.0 for part in v)
    return x, y, z
