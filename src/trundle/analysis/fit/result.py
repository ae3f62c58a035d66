"""What a fit found: values with errors, what the data do not show, the verdict, the fitted runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Plottable, Serializable, escaped, fold, paragraph, section, table
from ...errors import UnknownNameError
from ...scenario import ScenarioFile
from ...simulation.simulate import Scenario
from ...simulation.trajectory import Trajectory
from ...solve.samples import Array
from . import report, spikes
from .judging import Judgement
from .problem import Problem
from .undetermined import Undetermined, pm

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from ...verify import Card
    from .alternatives import Alternatives
    from .sampling import Samples

GOOD, BAD, UNDECIDED = "good", "bad", "cannot decide"
_SAYS = 5.0  # standard deviations beyond a limit, for which a straight line from there still tells what the data say


@dataclass(frozen=True)
class Estimate:
    """One number of a fit.

    Parameters
    ----------
    name : str
        Its key; with the number of the run where each run has its own.
    value : float
        SI.
    sigma : float or None
        Standard deviation; None where the data do not fix the number.
    unit : str
        SI; empty where it has none.
    state : str
        "fitted"; "held" at the scenario's value, as the data do not fix it; "together" with one that is held, for which
        alone the value stands; "limit": at the end of what is allowed.
    asked : bool
        Whether the user named it; a start is found besides.
    alone : float, optional
        Of one at its limit: what the data say without it.
    alone_sigma : float, optional
        And how well.

    Examples
    --------
    >>> print(Estimate("body.inertia_ratio", 0.4003, 0.0021, "", "fitted", True))
    body.inertia_ratio = 0.4003 ± 0.0021
    """

    name: str
    value: float
    sigma: float | None
    unit: str
    state: str
    asked: bool
    alone: float | None = None
    alone_sigma: float | None = None

    @property
    def cells(self) -> tuple[str, str, str]:
        """Its value with its error, its unit, and a remark."""
        if self.state == "limit" and self.alone is not None and self.alone_sigma is not None:
            beyond = self.alone - self.value
            if abs(beyond) > _SAYS * self.alone_sigma:  # so far off a straight line from the limit tells no value
                asked = "more" if beyond > 0 else "less"
                return f"{self.value:z.6g}", self.unit, f"at its limit; the data ask for {asked}"
            return f"{self.value:z.6g}", self.unit, f"at its limit; the data say {pm(self.alone, self.alone_sigma)}"
        if self.sigma is None:
            known = "held: the data do not fix it" if self.state == "held" else "only together, see below"
            return f"{self.value:z.6g}", self.unit, known
        return pm(self.value, self.sigma), self.unit, ""

    def __str__(self) -> str:
        value, unit, remark = self.cells
        return f"{self.name} = {value}{unit and ' ' + unit}{remark and f' ({remark})'}"


@dataclass(frozen=True, repr=False)
class Fit(Plottable, Serializable):
    """Numbers of a scenario fitted to measured motion.

    `fit["body.inertia_ratio"]` is one of the estimates.

    Parameters
    ----------
    title : str
        Of the scenario.
    problem : Problem
        What was solved: data, noise, model.
    values : array (p,)
        Of all that was free, SI.
    estimates : tuple of Estimate
        The same with errors, in the same order.
    covariance : array (p, p)
        SI; 0 for numbers that the data do not fix.
    undetermined : tuple of Undetermined
        What the data do not fix, each with what they fix instead and what else to measure.
    judgement : Judgement
        What the residuals say.
    scenarios : tuple of ScenarioFile
        The fitted scenario of each run.
    loss : str
        With which it was fitted.
    moves : bool
        Whether the data show motion at all.
    evaluations : int
        How often the model was worked out.
    lmfit : lmfit.minimizer.MinimizerResult or None
        lmfit's own result, for combinations of the numbers that the data fix.

    Examples
    --------
    See `trundle.fit`.
    """

    title: str
    problem: Problem
    values: Array
    estimates: tuple[Estimate, ...]
    covariance: Array
    undetermined: tuple[Undetermined, ...]
    judgement: Judgement
    scenarios: tuple[ScenarioFile, ...]
    loss: str
    moves: bool
    evaluations: int
    lmfit: Any = field(compare=False)

    def __getitem__(self, name: str) -> Estimate:
        """Return one estimate by its name."""
        found = next((one for one in self.estimates if one.name == name), None)
        if found is None:
            raise UnknownNameError("fitted number", str(name), [one.name for one in self.estimates])
        return found

    # The verdict

    @property
    def answer(self) -> str:
        """One of "good", "bad" and "cannot decide": nothing that was asked is fixed, or the data show no motion."""
        if self.judgement.freedom < 1:
            return UNDECIDED
        if not self.judgement.good:
            return BAD
        if not self.moves:
            return UNDECIDED
        asked = [one for one in self.estimates if one.asked]
        return UNDECIDED if asked and all(one.sigma is None and one.state != "limit" for one in asked) else GOOD

    @property
    def passed(self) -> bool | None:
        """Whether the fit is good; None where the data cannot decide."""
        return {GOOD: True, BAD: False, UNDECIDED: None}[self.answer]

    @property
    def verdict(self) -> str:
        """The answer with its reason."""
        said = self.judgement
        if said.freedom < 1:
            return "cannot decide: no values are left over to judge by"
        if said.good and not self.moves:
            return "cannot decide: the noise is larger than the motion"
        noise = "" if said.noise_known else ", against the noise that the data show by themselves"
        measure = f"χ²/dof = {said.reduced:.4g} ({said.freedom} degrees of freedom{noise})"
        if self.answer == BAD:
            return f"bad fit: {'; '.join(said.faults)}"
        if self.answer == UNDECIDED:
            return f"cannot decide what was asked, {measure}"
        return f"good fit, {measure}"

    @property
    def scenario(self) -> ScenarioFile:
        """The fitted scenario; of several runs, the first."""
        return self.scenarios[0]

    @cached_property
    def run(self) -> Trajectory:
        """The fitted run; of several, the first."""
        return Scenario.loads(self.scenario.to_toml()).run()

    @cached_property
    def card(self) -> Card:
        """The evidence of the fitted run."""
        return self.run.card()

    # What it says

    @property
    def rows(self) -> list[tuple[str, str, str, str]]:
        """A row for each number: name, value ± error, unit, remark."""
        return [(one.name, *one.cells) for one in self.estimates]

    @property
    def remarks(self) -> list[str]:
        """What else there is to say, a sentence each."""
        asked = {one.name for one in self.estimates if one.asked}
        silent = [one.names[0] for one in self.undetermined if len(one.names) == 1 and one.names[0] not in asked]
        said = [str(one) for one in self.undetermined if one.names[0] not in silent]
        if silent:
            said.append(f"Held, as these data do not show it: {', '.join(silent)}.")
        aside = [] if self.answer == "good" or self.judgement.outliers_named else spikes.told(self.problem)
        said += [f"{text[:1].upper()}{text[1:]}." for text in (*self.judgement.remarks, *aside)]
        for name, model in zip(report.labels(self), self.problem.models, strict=True):
            said.append(f"{name}: {model.seen.read}.")
        return said

    def __str__(self) -> str:
        return report.text(self)

    def _headline(self) -> Headline:
        return Headline(self.title, self.verdict, self.passed)

    def _parts(self) -> Iterator[Markup]:
        yield table(self.rows, report.HEADINGS, numbers=(1,))
        for remark in self.remarks:
            yield paragraph(remark)
        yield section("Correlations", table(*report.correlation_cells(self))) if len(self.values) < 12 else Markup()
        yield fold("Fitted scenario", Markup(f'<pre tabindex="0">{escaped(self.to_toml())}</pre>'))

    def table(self, form: str = "text") -> str:
        """Return the table of numbers.

        Parameters
        ----------
        form : str
            "text", "markdown", "latex" or "csv".

        Returns
        -------
        str
            With errors of two digits; CSV has all digits.

        Raises
        ------
        UnknownNameError
            If there is no such form.

        Examples
        --------
        See `docs/fitting.md`.
        """
        return report.in_form(self, form)

    def to_toml(self, run: int = 0) -> str:
        """Return a fitted scenario with its errors as comments, ready to run.

        Parameters
        ----------
        run : int
            Which, of several, from 0.

        Returns
        -------
        str
            TOML.

        Examples
        --------
        See `docs/fitting.md`.
        """
        return report.toml(self, run)

    @cached_property
    def data(self) -> xarray.Dataset:
        """Data, fit, residuals, values and covariance."""
        return report.dataset(self)

    def as_dict(self) -> dict[str, Any]:
        """Return all that is said, in SI."""
        return report.as_dict(self)

    def plot(self) -> Figure:
        """Draw data and fit, residuals over time, and how the numbers are correlated."""
        from .figure import draw

        return draw(self)

    def save(self, path: Any) -> Path:
        """Write data, fit and covariance to NetCDF.

        Parameters
        ----------
        path : path
            Of the file.

        Returns
        -------
        Path
            The same.

        Examples
        --------
        See `docs/fitting.md`.
        """
        from ...simulation.netcdf import write_dataset

        write_dataset(self.data, Path(path))
        return Path(path)

    def save_html(self, path: Any) -> Path:
        """Write a page of its own: verdict, numbers, figure, scenario.

        Parameters
        ----------
        path : path
            Of the file.

        Returns
        -------
        Path
            The same.

        Examples
        --------
        See `docs/fitting.md`.
        """
        Path(path).write_text(report.page(self), encoding="utf-8")
        return Path(path)

    # Further questions

    def compare(self) -> Alternatives:
        """Fit the same data with something added: drag, resistance, a tilt, a wobble, slipping; the best one first.

        Returns
        -------
        Alternatives
            Each with its χ² and Akaike's criterion, against this fit.

        Examples
        --------
        See `docs/fitting.md`.
        """
        from .alternatives import compare

        return compare(self)

    def sample(self, steps: int = 1000, walkers: int = 32, seed: int = 0) -> Samples:
        """Draw from the posterior by emcee, along what the data fix.

        Parameters
        ----------
        steps : int
            Of each walker.
        walkers : int
            At least twice as many as numbers.
        seed : int
            Of the draws.

        Returns
        -------
        Samples
            Draws of each number, after the walkers have forgotten where they began.

        Examples
        --------
        See `docs/fitting.md`.
        """
        from .sampling import sample

        return sample(self, steps, walkers, seed)

    def predicted(self) -> list[Array]:
        """Return what the fit says of each value measured.

        Returns
        -------
        list of array (n, c)
            One for each run, SI.

        Examples
        --------
        See `docs/fitting.md`.
        """
        return report.predicted(self)


def correlation(covariance: Array) -> Array:
    """Return correlations; 0 where there is no variance.

    Examples
    --------
    >>> correlation(np.array([[4.0, 2.0], [2.0, 4.0]])).tolist()
    [[1.0, 0.5], [0.5, 1.0]]
    """
    sigma = np.sqrt(np.diag(covariance))
    safe = np.where(sigma > 0, sigma, 1.0)
    return np.asarray(covariance / safe[:, None] / safe[None])
