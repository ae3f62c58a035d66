"""How a steady motion answers a nudge: the linear law with symmetry and family divided out."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .finding import Relative, co_moving_slopes
from .flow import Array
from .symmetry import moved_by

NOTHING = 1e-7  # of the scale's rate: a slower mode is none
_KERNEL = 2e-12  # singular values below this share of the rate belong to the family
_PURE = 1e-9  # share of the frequency below which growth is rounding


@dataclass(frozen=True)
class Mode:
    """One way in which a nudge moves on, as exp(λt).

    Parameters
    ----------
    rate : complex
        λ, 1/s, its imaginary part not negative.

    Examples
    --------
    >>> Mode(3j).frequency, Mode(3j).kind
    (3.0, 'stable')
    """

    rate: complex

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
        """One of "stable", "unstable" and "neutral"."""
        if self.rate == 0:
            return "neutral"
        return "unstable" if self.rate.real > 0 else "stable"


@dataclass(frozen=True)
class Reduced:
    """The linear law on what is left when symmetry is divided out.

    Parameters
    ----------
    basis : (10, r) array
        Moves that no symmetry makes, orthonormal in units of the scale.
    matrix : (r, r) array
        Their rates, 1/s.
    dimension : int
        Of the family of steady motions: directions in which the law leaves a nudge where it is.
    """

    basis: Array
    matrix: Array
    dimension: int


def reduce(relative: Relative) -> Reduced:
    """Return the linear law about a steady motion, symmetry divided out."""
    flow, y = relative.flow, relative.y
    tangent = flow.tangent(y)
    rows = [tangent.T @ (moved_by(row, y) / flow.scale) for row in relative.symmetries]
    across = np.eye(tangent.shape[1])
    if rows:
        U, singular, _ = np.linalg.svd(np.stack(rows, axis=1), full_matrices=True)
        across = U[:, int((singular > 1e-9 * max(float(singular.max()), 1e-300)).sum()) :]
    basis = tangent @ across
    slopes = co_moving_slopes(flow, y, relative.shares, flow.scale[:, None] * basis)
    matrix = basis.T @ (slopes / flow.scale[:, None])
    singular = np.linalg.svd(matrix, compute_uv=False)
    return Reduced(basis, matrix, int((singular <= _KERNEL * flow.rate).sum()))


def eigenvalues(reduced: Reduced) -> Array:
    """Return the eigenvalues besides those of the family, 1/s: its directions are divided out, too."""
    _, _, right = np.linalg.svd(reduced.matrix)
    rest = right[: len(right) - reduced.dimension].T
    return np.asarray(np.linalg.eigvals(rest.T @ reduced.matrix @ rest))


def modes_of(reduced: Reduced, rate: float) -> tuple[Mode, ...]:
    """Return the modes, the fastest growing first."""
    modes = []
    for value in eigenvalues(reduced):
        if value.imag < 0:
            continue
        real, imag = float(value.real), float(value.imag)
        clean = complex(
            0.0 if abs(real) < NOTHING * rate or abs(real) < _PURE * imag else real,
            0.0 if imag < NOTHING * rate else imag,
        )
        modes.append(Mode(clean))
    return tuple(sorted(modes, key=lambda mode: (-mode.growth, -mode.frequency)))


def verdict_of(modes: tuple[Mode, ...]) -> str:
    """Return the verdict of the linear law.

    Examples
    --------
    >>> verdict_of((Mode(2j),)), verdict_of((Mode(-1 + 2j),)), verdict_of((Mode(1 + 0j), Mode(-1 + 0j)))
    ('stable to first order', 'stable', 'unstable')
    """
    if any(mode.growth > 0 for mode in modes):
        return "unstable"
    if not modes or any(mode.rate == 0 for mode in modes):
        return "neutral"
    return "stable" if all(mode.growth < 0 for mode in modes) else "stable to first order"


def fastest(modes: tuple[Mode, ...]) -> float:
    """Return the largest |λ|, 1/s."""
    return max((math.hypot(mode.growth, mode.frequency) for mode in modes), default=0.0)
