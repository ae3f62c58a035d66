"""Whether a fit is good: χ², residuals over time and what they have in common, outliers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...solve.samples import Array
from .lasting import of_places
from .model import RunModel
from .observations import Noise
from .problem import Problem

ENOUGH = 5.0  # standard deviations by which a fit is bad
_OUTLIER = 1e-3  # chance of one outlier among all values, were the noise normal
_MOST_ROWS = 12
_REMEDY = "; leave these out, or take a loss that bears them, such as soft_l1"
_FEW = 0.05  # of all values: more are no outliers, but a law that is wrong
_NOTHING = 1e-3  # of the noise: what is less is where the search for the minimum ended
_OF_SCATTER = 3.0  # times the spread of χ²: noise that was estimated is itself not better known


@dataclass(frozen=True)
class Outlier:
    """A value far from the fit: the row of the data, its column, and how many standard deviations off."""

    run: int
    row: int
    column: str
    off: float


@dataclass(frozen=True)
class Judgement:
    """What the residuals say.

    Parameters
    ----------
    chi_square : float
        Sum of squares in units of the noise; the noise that was given, or that by which the data scatter.
    freedom : int
        Values less numbers fitted.
    excess : float
        By how many standard deviations χ² is above its mean.
    memory : float
        Correlation of one residual with the next, the column in which it is plainest.
    memory_excess : float
        In standard deviations.
    runs_excess : float
        By how many standard deviations there are too few changes of sign.
    outliers : tuple of Outlier
        The farthest first.
    noise_known : bool
        Whether the noise was given.
    allowed : float
        By which χ² may be larger, as the camera is only so accurate.
    """

    chi_square: float
    freedom: int
    excess: float
    memory: float
    memory_excess: float
    runs_excess: float
    outliers: tuple[Outlier, ...]
    noise_known: bool
    allowed: float = 0.0

    @property
    def reduced(self) -> float:
        """χ²/dof; not a number where nothing is left over."""
        return self.chi_square / self.freedom if self.freedom > 0 else float("nan")

    @property
    def faults(self) -> list[str]:
        """What is wrong, in words; empty for a good fit."""
        said = []
        if self.excess > ENOUGH:
            noise = "the noise given" if self.noise_known else "the data scatter by themselves"
            said.append(
                f"χ²/dof = {self.reduced:.4g} lies {self.excess:.3g}σ above 1: the law misses more than {noise}"
            )
        if self.memory_excess > ENOUGH:
            said.append(
                f"residuals follow one another (correlation {self.memory:.2f} from row to row, "
                f"{self.memory_excess:.3g}σ): the law is wrong, or the noise has a memory and the errors are too small"
            )
        elif self.runs_excess > ENOUGH:
            said.append(f"residuals change sign too seldom ({self.runs_excess:.3g}σ)")
        return said

    @property
    def good(self) -> bool:
        """Whether nothing is wrong."""
        return not self.faults

    @property
    def outliers_named(self) -> bool:
        """Whether values far from the fit are few enough to be named."""
        return 0 < len(self.outliers) <= _FEW * (self.freedom + 1)

    @property
    def remarks(self) -> list[str]:
        """What else there is to say."""
        said = []
        if self.allowed and self.chi_square > self.freedom + ENOUGH * float(np.sqrt(2.0 * max(self.freedom, 1))):
            said.append("residuals are larger than the noise, but no larger than the camera is accurate")
        if self.noise_known and self.excess < -ENOUGH:
            said.append(f"χ²/dof = {self.reduced:.3g}: the noise is less than was given, and the errors are too large")
        if self.outliers_named:
            some = ", ".join(f"row {one.row} ({one.column}, {one.off:+.1f}σ)" for one in self.outliers[:_MOST_ROWS])
            more = len(self.outliers) - _MOST_ROWS
            said.append(f"far from the fit: {some}" + (f" and {more} more" if more > 0 else "") + _REMEDY)
        return said


def judge(problem: Problem, values: Array, fitted: int, *, robust: bool = False) -> Judgement:
    """Return what the residuals say of a fit of some numbers."""
    residual = problem.residual(values)
    count = residual.size
    if robust:  # what such a loss bears is not held against the fit
        borne = np.abs(residual) > _limit(count)
        residual = np.where(borne & (borne.sum() <= _FEW * count), 0.0, residual)
        fitted += int((residual == 0).sum())
    chi, freedom = chi_square(problem, residual), count - fitted
    known = all(noise.known for noise in problem.noises)
    spread = np.sqrt(2.0 * max(freedom, 1)) * (1.0 if known else _OF_SCATTER)
    allowed = sum(_allowed(model, noise) for model, noise in zip(problem.models, problem.noises, strict=True))
    excess = (chi - freedom) / spread if freedom > 0 else 0.0
    if excess > 0:
        excess = max(excess - allowed / spread, 0.0)
    scale = 1.0 if known else np.sqrt(chi / freedom) if freedom > 0 and chi > 0 else 1.0
    memory, memory_excess, runs = 0.0, 0.0, 0.0
    outliers: list[Outlier] = []
    whole = problem.residual(values)
    limit = _limit(count)
    at = 0
    for i, (model, noise) in enumerate(zip(problem.models, problem.noises, strict=True)):
        seen = model.seen.known
        size = int(seen.sum())
        z = np.full(seen.shape, np.nan)
        z[seen] = whole[at : at + size]
        at += size
        typical = np.maximum(scale if known else 1.4826 * float(np.nanmedian(np.abs(z))), noise.least / noise.sigma)
        off_by = np.nanstd(z * noise.sigma, axis=0)
        small = (of_places(model.seen.columns) & (off_by <= model.accuracy)) | (off_by <= noise.least)
        small |= off_by <= _NOTHING * np.nanmedian(noise.sigma, axis=0)
        for c in np.flatnonzero(~small):
            column = z[:, c][np.isfinite(z[:, c])]
            r, off = _memory(column)
            if off > memory_excess:
                memory, memory_excess = r, off
            runs = max(runs, _runs(column))
        far = np.argwhere(np.abs(np.nan_to_num(z)) > limit * typical)
        outliers += [
            Outlier(i, int(model.seen.rows[row]), model.seen.columns[c], -float(z[row, c] / typical[row, c]))
            for row, c in far
        ]
    outliers.sort(key=lambda one: -abs(one.off))
    return Judgement(chi, freedom, float(excess), memory, memory_excess, runs, tuple(outliers), known, allowed)


def chi_square(problem: Problem, residual: Array) -> float:
    """Return χ²: of data without noise the residuals are errors of what is computed, no less than those believed."""
    each = [(noise.least / noise.sigma)[m.seen.known] for m, noise in zip(problem.models, problem.noises, strict=True)]
    least = np.concatenate(each)
    return float((residual**2).sum() + np.maximum(least**2 - residual[: least.size] ** 2, 0.0).sum())


def _allowed(model: RunModel, noise: Noise) -> float:
    """Return by how much χ² may be larger, as a camera is only so accurate."""
    share = np.where(of_places(model.seen.columns), model.accuracy / noise.sigma, 0.0)
    return float((share[model.seen.known] ** 2).sum())


def _limit(count: int) -> float:
    from scipy.special import ndtri

    return float(-ndtri(_OUTLIER / (2 * max(count, 1))))


def _memory(z: Array) -> tuple[float, float]:
    """Return the correlation of neighbours, and how many standard deviations of chance it is above 0.

    Examples
    --------
    >>> _memory(np.array([1.0, 1.0, 1.0, -1.0, -1.0, -1.0] * 20))[1] > 2
    True
    >>> _memory(np.array([0.0] * 9 + [1e-200]))
    (0.0, 0.0)
    """
    if z.size < 8 or not np.any(z):
        return 0.0, 0.0
    z = z / np.abs(z).max()
    clipped = np.clip(z, *(np.array([-4, 4]) * 1.4826 * (float(np.median(np.abs(z))) or 1.0)))
    r = float((clipped[1:] * clipped[:-1]).sum() / (clipped * clipped).sum())
    return r, r * float(np.sqrt(z.size))


def _runs(z: Array) -> float:
    """Return by how many standard deviations there are too few runs of one sign (Wald and Wolfowitz 1940).

    Examples
    --------
    >>> _runs(np.repeat([1.0, -1.0], 50)) > 5
    True
    """
    up, down = int((z > 0).sum()), int((z < 0).sum())
    total = up + down
    if min(up, down) < 1 or total < 8:
        return 0.0 if total < 8 else float(np.sqrt(total))
    runs = 1 + int((np.diff(np.sign(z[z != 0])) != 0).sum())
    mean = 1 + 2 * up * down / total
    variance = (mean - 1) * (mean - 2) / (total - 1)
    return float((mean - runs) / np.sqrt(variance)) if variance > 0 else 0.0
