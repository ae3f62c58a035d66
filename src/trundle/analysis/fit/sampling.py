"""Draws from the posterior by emcee, along the directions that the data fix."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Displayed, Headline, Markup, paragraph, table
from ...errors import InvalidValueError, TrundleError
from ...extras import need
from ...solve.samples import Array
from .minimising import look

if TYPE_CHECKING:
    from .result import Fit

_QUANTILES = (0.16, 0.5, 0.84)
_FORGOTTEN = 0.3  # share of the steps that is left out
_LONG = 50.0  # autocorrelation times that a chain should last
_LOPSIDED = 0.1  # share by which the two sides of a median may differ in what is as good as normal
_SIDE = 2.3  # times 1/√n: deviation of the difference of the two sides of a normal median, over their mean
HEADINGS = ("number", "16 %", "median", "84 %", "unit")


@dataclass(frozen=True, repr=False)
class Samples(Displayed):
    """Draws from the posterior of a fit.

    Parameters
    ----------
    title : str
        Of the scenario.
    names, units : tuple of str
        Of the numbers.
    draws : array (n, p)
        SI; the same throughout for numbers that are held.
    acceptance : float
        Share of steps taken.
    autocorrelation : float
        Of the slowest direction, steps.
    steps : int
        Of each walker.

    Examples
    --------
    See `Fit.sample`.
    """

    title: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    draws: Array
    acceptance: float
    autocorrelation: float
    steps: int

    @property
    def converged(self) -> bool:
        """Whether the chains last fifty times as long as they remember."""
        return self.steps > _LONG * self.autocorrelation

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """Median and the limits of one standard deviation, of each number that varies."""
        each = np.quantile(self.draws, _QUANTILES, axis=0).T
        told = zip(self.names, each, self.units, strict=True)
        return [(name, *(f"{part:z.6g}" for part in parts), unit) for name, parts, unit in told if np.ptp(parts) > 0]

    @property
    def lopsided(self) -> tuple[str, ...]:
        """The numbers of which one side of the median is the longer one, by more than so few draws leave open."""
        low, middle, high = np.quantile(self.draws, _QUANTILES, axis=0)
        apart = np.abs(high + low - 2 * middle) / np.maximum((high - low) / 2, 1e-300)
        independent = self.draws.shape[0] / max(self.autocorrelation, 1.0)
        sure = (high > low) & (apart > max(_LOPSIDED, 4 * _SIDE / np.sqrt(independent)))
        return tuple(name for name, one in zip(self.names, sure, strict=True) if one)

    @property
    def verdict(self) -> str:
        """How far to trust them."""
        enough = "long enough" if self.converged else "too short: ask for more steps"
        return (
            f"{self.draws.shape[0]} draws, {100 * self.acceptance:.0f} % accepted; each chain lasts "
            f"{self.steps / max(self.autocorrelation, 1e-9):.0f} autocorrelation times, {enough}"
        )

    def __str__(self) -> str:
        rows = [HEADINGS, *self.rows]
        widths = [max(len(row[i]) for row in rows) for i in range(len(HEADINGS))]
        lines = ["  ".join(f"{c:<{w}}" for c, w in zip(row, widths, strict=True)).rstrip() for row in rows]
        return "\n".join([self.title, self.verdict, *lines, self.shape])

    @property
    def shape(self) -> str:
        """Whether one standard deviation tells it, as far as these draws show."""
        if not self.lopsided:
            return "The 16 and 84 % quantiles are one standard deviation to either side, were it normal."
        return f"Not normal: {', '.join(self.lopsided)}. Quote the median and both quantiles, not one ± for both sides."

    def _headline(self) -> Headline:
        return Headline(self.title, self.verdict, self.converged)

    def _parts(self) -> Iterator[Markup]:
        yield table(self.rows, HEADINGS, numbers=(1, 2, 3))
        yield paragraph(self.shape)


def sample(fit: Fit, steps: int, walkers: int, seed: int) -> Samples:
    """Return draws of the numbers of a fit."""
    need("fit", "Fit.sample")
    import emcee

    problem = fit.problem
    held = np.array([one.state in ("held", "limit") for one in fit.estimates])
    basis = look(problem, fit.values, held).basis
    size = basis.shape[1]
    if size == 0:
        raise InvalidValueError("fit", "must fix a number at least", "none", "Free fewer numbers.")
    if walkers < 2 * size + 2:
        raise InvalidValueError("walkers", f"must be {2 * size + 2} at least, for {size} numbers", walkers)
    variance = 1.0 if fit.judgement.noise_known else fit.judgement.reduced

    def log_probability(place: Any) -> float:
        values = fit.values + basis @ place
        try:
            residual = problem.residual(values)
        except (TrundleError, ArithmeticError, ValueError):
            return -np.inf
        inside = np.array_equal(problem.inside(values), values)
        found = -0.5 * float(residual @ residual) / variance
        return found if inside and np.isfinite(found) else -np.inf

    generator = np.random.RandomState(seed)
    first = generator.normal(scale=0.1 * np.sqrt(variance), size=(walkers, size))
    sampler = emcee.EnsembleSampler(walkers, size, log_probability)
    sampler.random_state = generator.get_state()
    sampler.run_mcmc(first, steps)
    memory = float(np.max(sampler.get_autocorr_time(quiet=True, tol=0)))
    chain = sampler.get_chain(discard=int(_FORGOTTEN * steps), flat=True)
    draws = fit.values + chain @ basis.T
    each = fit.estimates
    names, units = tuple(one.name for one in each), tuple(one.unit for one in each)
    accepted = float(np.mean(sampler.acceptance_fraction))
    return Samples(fit.title, names, units, draws, accepted, memory if np.isfinite(memory) else float(steps), steps)
