"""All runs together as one least-squares problem: residuals in units of their noise, and their derivatives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...errors import SolverError, TrundleError
from ...solve.samples import Array
from .model import RunModel
from .observations import Noise
from .unknowns import Unknown, limit, of_run

Watch = Callable[[Array, Array, float], None]

_ASIDE = 1e-9
_NOWHERE = 1e8  # standard deviations, of a trial that has no motion


@dataclass(frozen=True)
class Prior:
    """What is known of a number beforehand: a value and its standard deviation."""

    value: float
    sigma: float


@dataclass
class Problem:
    """What is minimised."""

    unknowns: list[Unknown]  # in the order of the vector of values
    models: list[RunModel]  # one for each run
    noises: list[Noise]  # one for each run
    priors: dict[int, Prior] = field(default_factory=dict)  # by place of the unknown
    until: float = 1.0  # share of each run that counts, of its time
    watch: Watch | None = None  # told the values, their residuals and the share that counts, wherever the fit comes by
    limits: dict[int, tuple[float, float]] = field(default_factory=dict)  # those that a trial has come to
    last: tuple[bytes, float, Array, Array] | None = None  # residuals and derivatives
    recent: tuple[bytes, float, Array] | None = None  # residuals alone

    @property
    def start(self) -> Array:
        """The values at which the fit begins."""
        return np.array([one.value for one in self.unknowns])

    def rows(self, run: int) -> int:
        """Return how many rows of a run count."""
        time = self.models[run].seen.time
        if self.until >= 1:
            return time.size
        reached = int(np.searchsorted(time, time[0] + self.until * (time[-1] - time[0]), side="right"))
        return min(max(reached, 4), time.size)

    def residual(self, values: Array) -> Array:
        """Return (model − data)/σ of all that counts, and of the priors."""
        for known in (self.last, self.recent):
            if known is not None and known[:2] == (values.tobytes(), self.until):
                return known[2]
        self.recent = (values.tobytes(), self.until, self._stacked(values, slopes=False)[0])
        return self.recent[2]

    def both(self, values: Array) -> tuple[Array, Array]:
        """Return the residuals and their derivatives, (m, unknowns)."""
        if self.last is None or self.last[:2] != (values.tobytes(), self.until):
            try:
                found = self._stacked(values, slopes=True)
            except (SolverError, ArithmeticError):  # an event that hangs on a rounding does not a little aside
                found = self._stacked(values * (1 + _ASIDE), slopes=True)
            self.last = (values.tobytes(), self.until, *found)
            if self.watch is not None:
                self.watch(values, found[0], self.until)
        return self.last[2], self.last[3]

    @property
    def by_formula(self) -> bool:
        """Whether derivatives cost little more than the motion."""
        return all(model.by_formula for model in self.models)

    def tried(self, values: Array) -> Array:
        """Return the residuals; enormous ones where there is no motion, so that the step is not taken."""
        try:
            found = self.both(values)[0] if self.by_formula else self.residual(values)
        except (TrundleError, ArithmeticError, ValueError, IndexError):
            return np.full(self.size, _NOWHERE)
        return np.where(np.isfinite(found), found, _NOWHERE)

    @property
    def size(self) -> int:
        """How many residuals there are."""
        known = (int(model.seen.known[: self.rows(i)].sum()) for i, model in enumerate(self.models))
        return sum(known) + len(self.priors)

    def inside(self, values: Array) -> Array:
        """Return values no farther than the limits that trials have come to."""
        found = values.copy()
        for j, (low, high) in self.limits.items():
            found[j] = min(max(found[j], low), high)
        return found

    def _stacked(self, values: Array, *, slopes: bool) -> tuple[Array, Array]:
        """Return residuals and derivatives; beyond a limit they go on as straight lines, and make no minimum there."""
        there = self.inside(values)
        try:
            return self._extended(values, there, slopes=slopes)
        except TrundleError:
            if not self._meets_limits(there):
                raise
            return self._extended(values, self.inside(values), slopes=slopes)

    def _extended(self, values: Array, there: Array, *, slopes: bool) -> tuple[Array, Array]:
        beyond = values - there
        residual, jacobian = self._evaluated(there, slopes=slopes or bool(beyond.any()))
        return residual + jacobian @ beyond if beyond.any() else residual, jacobian

    def _meets_limits(self, values: Array) -> bool:
        """Find the limits that some values are beyond."""
        found = {}
        for j, one in enumerate(self.unknowns):
            bound = limit(self.models[one.run or 0].scenario, one.key, one.value, float(values[j]))
            if bound is not None:
                low, high = self.limits.get(j, (-np.inf, np.inf))
                found[j] = (bound, high) if values[j] < bound else (low, bound)
        self.limits |= found
        return bool(found)

    def _evaluated(self, values: Array, *, slopes: bool) -> tuple[Array, Array]:
        each, jacobians = [], []
        for i, (model, noise) in enumerate(zip(self.models, self.noises, strict=True)):
            rows, mine = self.rows(i), of_run(self.unknowns, i)
            predicted, jacobian = model.predict([float(values[j]) for j in mine], rows, slopes=slopes)
            known = np.zeros_like(model.seen.known)
            known[:rows] = model.seen.known[:rows]
            each.append(noise.whiten(_all_rows(predicted - model.seen.values[:rows], known), known))
            if jacobian is not None:
                whole = np.zeros((each[-1].size, len(self.unknowns)))
                whole[:, mine] = noise.whiten(_all_rows(jacobian, known), known)
                jacobians.append(whole)
        for j, prior in self.priors.items():
            each.append(np.array([(values[j] - prior.value) / prior.sigma]))
            jacobians.append((np.arange(len(self.unknowns)) == j)[None] / prior.sigma)
        return np.concatenate(each), np.concatenate(jacobians) if slopes else np.empty((0, 0))

    def signal(self) -> float:
        """Return how much larger than its noise the motion is: the norm of the data about its mean, in its units."""
        sums = [0.0]
        for i, (model, noise) in enumerate(zip(self.models, self.noises, strict=True)):
            values = model.seen.values[: self.rows(i)]
            values = np.where(np.isfinite(values), values, np.nan)
            apart = values - np.nansum(values, axis=0) / np.maximum(np.isfinite(values).sum(axis=0), 1)
            with np.errstate(invalid="ignore"):
                sums.append(float(np.nansum((apart / noise.sigma[: self.rows(i)]) ** 2)))
        return float(np.sqrt(sum(sums)))


def _all_rows(values: Array, known: Array) -> Array:
    """Return an array over all rows, of which only the first are given."""
    whole = np.zeros((known.shape[0], *values.shape[1:]))
    whole[: values.shape[0]] = values
    return whole


def names_of(unknowns: Sequence[Unknown]) -> list[str]:
    """Return the names, in order."""
    return [one.name for one in unknowns]
