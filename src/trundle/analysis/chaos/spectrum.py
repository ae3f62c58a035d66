"""What is returned of Lyapunov exponents: with errors, what they sum up to, which must be zero, how they converged."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Plottable, Serializable, number, pairs, paragraph, table
from ...mechanics.system import RollingSystem, State
from ...solve.samples import Array
from .asked import finite_or_none
from .neutral import Neutral

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

SUMS_AGREE = 1e-8  # of the rate at which the motion changes
HEADINGS = ("exponent, 1/s", "error, 1/s", "")


@dataclass(frozen=True, repr=False)
class LyapunovExponents(Plottable, Serializable):
    """The Lyapunov exponents of a motion, the largest first, with errors and evidence.

    Parameters
    ----------
    title : str
        Of the scenario; empty where there is none.
    system : RollingSystem
        What moves.
    start : State
        From where.
    exponents : array (n,)
        1/s, descending. −∞ where an event takes a difference away altogether, as slip is when it grips.
    errors : array (n,)
        1/s. See `lyapunov_exponents`.
    duration : float
        How long the motion was followed, s.
    asked : float
        How long it was to be followed, s.
    transient : float
        How much of that at the beginning was left out of the means, s.
    sum_between_events, divergence : float
        1/s, over the whole time: the sum of the exponents without what events did, and the mean divergence of the law
        on what the differences span, by quadrature. They must agree.
    sum_across_events : float
        What the events added to the sum, 1/s.
    dimension : int
        How many independent differences a state of the phase has in which the motion starts.
    zeros : Neutral
        Which exponents must be zero.
    rate : float
        A rate at which the motion changes, 1/s.
    ended : str
        What ended the motion before the time that was asked for; empty where nothing did.
    events : int
        How many there were on the way.
    data : xarray.Dataset
        `running_mean` over `time` and `exponent`: what the exponents would have been at an earlier end, from the start.

    Examples
    --------
    A ball on top of a dome falls off at the rate of an inverted pendulum:

    >>> import trundle as tr
    >>> dome = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(tr.Dome(0.2)))
    >>> found = tr.lyapunov_exponents(dome, dome.place(), "8 s", transient="4 s")
    >>> round(found.largest / math.sqrt(9.80665 / (1.4 * 0.225)), 9)
    1.0
    >>> found.passed
    True
    """

    title: str
    system: RollingSystem
    start: State
    exponents: Array
    errors: Array
    duration: float
    asked: float
    transient: float
    sum_between_events: float
    divergence: float
    sum_across_events: float
    dimension: int
    zeros: Neutral
    rate: float
    ended: str
    events: int
    data: xarray.Dataset = field(compare=False)

    @property
    def largest(self) -> float:
        """The largest exponent, 1/s."""
        return float(self.exponents[0])

    @property
    def positive(self) -> int:
        """How many exponents are positive by more than their error."""
        return int((self.exponents > self.errors).sum())

    @property
    def zeros_found(self) -> int:
        """How many exponents are zero within their error."""
        return int((np.abs(self.exponents) <= self.errors).sum())

    @property
    def sums_apart(self) -> float:
        """How far the sum is from the mean divergence, 1/s."""
        return abs(self.sum_between_events - self.divergence)

    @property
    def passed(self) -> bool | None:
        """Whether the sum agrees with the divergence, and as many exponents are zero as must be.

        None where not all exponents were asked for: then some that are zero may be missing.
        """
        if self.sums_apart > SUMS_AGREE * self.rate:
            return False
        if len(self.exponents) < self.dimension:
            return None
        return self.zeros_found >= self.zeros.count

    @property
    def kaplan_yorke_dimension(self) -> float:
        """The dimension of an attractor by Kaplan and Yorke's conjecture; exponents that are zero count as such."""
        values = np.where(np.abs(self.exponents) <= self.errors, 0.0, self.exponents)
        sums = np.cumsum(values)
        whole = int((sums >= -1e-300).sum()) if values[0] >= 0 else 0
        if whole in (0, len(values)):
            return float(whole)
        return whole + float(sums[whole - 1] / -values[whole])

    @property
    def verdict(self) -> str:
        """What the largest exponent says."""
        if self.positive:
            return f"{self.positive} positive: nearby motions part exponentially"
        return "none positive within its error: nearby motions do not part exponentially"

    @property
    def cells(self) -> list[tuple[str, str, str]]:
        """A row for each exponent."""
        rows = []
        for value, error in zip(self.exponents.tolist(), self.errors.tolist(), strict=True):
            said = "taken away by an event" if value == -math.inf else "zero" if abs(value) <= error else ""
            rows.append((f"{value:.6g}", f"{error:.2g}", said))
        return rows

    @property
    def facts(self) -> list[tuple[str, str]]:
        """What else there is to say, each fact under its name."""
        short = f" of {self.asked:.6g} s: {self.ended}" if self.ended else ""
        across = f"; events add {self.sum_across_events:.6g} 1/s" if self.events else ""
        zeros = f"{self.zeros_found} within their errors; at least {self.zeros}"
        missing = "" if self.passed or self.zeros_found >= self.zeros.count else ". Follow the motion for longer"
        if len(self.exponents) < self.dimension:
            zeros, missing = f"of all {self.dimension}, at least {self.zeros}", ""
        return [
            ("followed", f"{self.duration:.6g} s{short}, the first {self.transient:.4g} s left out of the means"),
            ("sum", f"{self.sum_between_events:.10g} 1/s between events{across}"),
            ("mean divergence", f"{self.divergence:.10g} 1/s, {self.sums_apart:.1e} 1/s apart"),
            ("must be zero", zeros + missing),
        ]

    def __str__(self) -> str:
        lines = [self.title] if self.title else []
        lines.append(f"{len(self.exponents)} of {self.dimension} Lyapunov exponents; {self.verdict}")
        lines += [f"{value:>14} ± {error:<9}{said}".rstrip() for value, error, said in self.cells]
        return "\n".join([*lines, *(f"{name}: {fact}" for name, fact in self.facts)])

    def _headline(self) -> Headline:
        return Headline(self.title, self.verdict, None if self.passed else self.passed)

    def _parts(self) -> Iterator[Markup]:
        yield table(self.cells, HEADINGS, numbers=(0, 1))
        yield pairs([(name, fact) for name, fact in self.facts])
        yield paragraph("largest exponent ", number(self.largest, unit="1/s"))

    def as_dict(self) -> dict[str, Any]:
        """Return everything but the curves in SI units and plain types, for JSON.

        Returns
        -------
        dict
            An exponent of −∞ is None.

        Examples
        --------
        >>> import trundle as tr
        >>> dome = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(tr.Dome(0.2)))
        >>> tr.lyapunov_exponents(dome, dome.place(), "4 s").as_dict()["dimension"]
        8
        """
        return {
            "title": self.title,
            "exponents": finite_or_none(self.exponents.tolist()),
            "errors": finite_or_none(self.errors.tolist()),
            "duration": self.duration,
            "asked": self.asked,
            "transient": self.transient,
            "ended": self.ended,
            "sum_between_events": self.sum_between_events,
            "sum_across_events": self.sum_across_events,
            "divergence": self.divergence,
            "dimension": self.dimension,
            "zeros_expected": self.zeros.count,
            "zeros_found": self.zeros_found,
            "passed": self.passed,
        }

    def plot(self) -> Figure:
        """Draw how the exponents converged: their running means over time.

        Examples
        --------
        >>> import trundle as tr
        >>> dome = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(tr.Dome(0.2)))
        >>> tr.lyapunov_exponents(dome, dome.place(), "4 s").plot().axes[0].get_xlabel()
        't, s'
        """
        from matplotlib.figure import Figure

        from ...views.plots.sheet import BLUE, FAINT, GREEN, VERMILION

        figure = Figure(figsize=(7.0, 4.2), layout="constrained")
        panel = figure.subplots()
        time, means = self.data.time.values, self.data.running_mean.values
        for i, (value, error) in enumerate(zip(self.exponents, self.errors, strict=True)):
            colour = GREEN if abs(value) <= error else VERMILION if value > 0 else BLUE
            panel.plot(time, means[:, i], color=colour, linewidth=1.2)
        panel.axvline(self.start.time + self.transient, color=FAINT, linewidth=0.8, linestyle=":")
        panel.axhline(0.0, color=FAINT, linewidth=0.8, zorder=0)
        shown = means[time >= self.start.time + 0.5 * self.transient]
        finite = shown[np.isfinite(shown)]
        if finite.size and np.ptp(finite) > 0:
            panel.set_ylim(finite.min() - 0.1 * np.ptp(finite), finite.max() + 0.1 * np.ptp(finite))
        panel.set_xlabel("t, s")
        panel.set_ylabel("running mean, 1/s")
        for colour, name in ((VERMILION, "positive"), (GREEN, "zero within its error"), (BLUE, "negative")):
            panel.plot([], [], color=colour, label=name)
        panel.legend(fontsize=8, frameon=False)
        figure.suptitle(self.title or "Lyapunov exponents", fontsize=11)
        return figure
