"""How well each number will be known, before anything is measured: from the Fisher information."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...display import Headline, Markup, Serializable, paragraph, section, table
from ...errors import InvalidValueError, UnknownNameError
from ...scenario import ScenarioFile
from ...simulation.simulate import Scenario
from ...solve import methods
from ...solve.samples import Array
from ...units import to_si
from ..sensitivities import keys
from .api import alone, pose
from .camera import Camera
from .directions import directions, taken
from .model import RunModel
from .observations import COLUMNS, Observations
from .undetermined import Undetermined, undetermined
from .unknowns import OUTSIDE

_LENGTHS = (0.25, 0.5, 1.0)  # of the scenario's duration
_RATES = (30.0, 60.0, 120.0)  # pictures a second
_NOISES = (2e-4, 5e-4, 1e-3, 2e-3)  # m
_MOST_ROWS = 50_000


@dataclass(frozen=True, repr=False)
class FitPlan(Serializable):
    """Standard deviations that a measurement would reach.

    Parameters
    ----------
    title : str
        Of the scenario.
    names, units : tuple of str
        Of the numbers asked for.
    durations, rates, noises : tuple of float
        s, pictures a second, m (or the unit of the columns).
    sigma : array (names, durations, rates, noises)
        SI; not a number where the data would not fix the number.
    undetermined : tuple of Undetermined
        What the longest and finest measurement would not fix.

    Examples
    --------
    See `trundle.plan_fit`.
    """

    title: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    durations: tuple[float, ...]
    rates: tuple[float, ...]
    noises: tuple[float, ...]
    sigma: Array
    undetermined: tuple[Undetermined, ...]

    @property
    def headings(self) -> tuple[str, ...]:
        """Of the table of each number."""
        return "length, s", "pictures/s", *(f"noise {1e3 * one:g} mm" for one in self.noises)

    def rows(self, name: str) -> list[tuple[str, ...]]:
        """Return the table of one number.

        Parameters
        ----------
        name : str
            One of `names`.

        Returns
        -------
        list of tuple of str
            A row for each length and rate.

        Examples
        --------
        See `trundle.plan_fit`.
        """
        if name not in self.names:
            raise UnknownNameError("number of the plan", str(name), self.names)
        of = self.sigma[self.names.index(name)]
        return [
            (f"{length:g}", f"{rate:g}", *("not fixed" if np.isnan(s) else f"{s:.2g}" for s in of[i, j]))
            for i, length in enumerate(self.durations)
            for j, rate in enumerate(self.rates)
        ]

    def __str__(self) -> str:
        lines = [f"{self.title}: standard deviations to expect"]
        for name, unit in zip(self.names, self.units, strict=True):
            rows = [self.headings, *self.rows(name)]
            widths = [max(len(row[i]) for row in rows) for i in range(len(self.headings))]
            lines.append(f"σ of {name}{unit and ', ' + unit}")
            lines += ["  ".join(f"{c:<{w}}" for c, w in zip(row, widths, strict=True)).rstrip() for row in rows]
        return "\n".join([*lines, *map(str, self.undetermined)])

    def _headline(self) -> Headline:
        return Headline(self.title, "standard deviations to expect")

    def _parts(self) -> Iterator[Markup]:
        for name, unit in zip(self.names, self.units, strict=True):
            yield section(f"σ of {name}{unit and ', ' + unit}", table(self.rows(name), self.headings))
        for one in self.undetermined:
            yield paragraph(str(one))

    def as_dict(self) -> dict[str, Any]:
        """Return all of it as JSON takes it.

        Returns
        -------
        dict
            None where a number is not fixed.
        """
        sigma = self.sigma.astype(object)
        sigma[np.isnan(self.sigma)] = None
        return {
            "title": self.title,
            "numbers": list(self.names),
            "units": list(self.units),
            "durations": list(self.durations),
            "rates": list(self.rates),
            "noises": list(self.noises),
            "sigma": sigma.tolist(),
            "undetermined": [str(one) for one in self.undetermined],
        }


def plan_fit(
    scenario: Any,
    free: str | Sequence[str],
    *,
    durations: Sequence[Any] | None = None,
    rates: Sequence[float] = _RATES,
    noises: Sequence[Any] = _NOISES,
    observed: Sequence[str] = ("x", "y"),
    camera: Camera | Mapping[str, Any] | None = None,
    start: str = "free",
) -> FitPlan:
    """Say how well a fit would know each number, by how long, how often and how finely one measures.

    By the Fisher information at the scenario's own numbers: what least squares reach where the noise is normal and
    independent from one value to the next.

    Parameters
    ----------
    scenario : Scenario, str or path
        As it is expected to move, with its start.
    free : sequence of str
        As for `trundle.fit`.
    durations : sequence of float or quantity, optional
        s; absent: a quarter, a half and all of the scenario's.
    rates : sequence of float
        Pictures a second.
    noises : sequence of float or quantity
        Standard deviation of a value: of lengths, m.
    observed : sequence of str
        Columns, as for `trundle.fit`; all with the same noise in SI.
    camera : Camera or mapping, optional
        As for `trundle.fit`.
    start : str
        "free" or "given".

    Returns
    -------
    FitPlan
        A table for each number.

    Raises
    ------
    InvalidValueError, UnknownNameError
        If a value is refused.

    Examples
    --------
    Four times the pictures, half the error:

    >>> import trundle as tr
    >>> plan = tr.plan_fit("tilted-turntable", "support.tilt", durations=["5 s"], rates=[25, 100], noises=["1 mm"])
    >>> few, many = plan.sigma[0, 0, :, 0]
    >>> round(float(few / many), 1)
    2.0
    """
    loaded: ScenarioFile = scenario if isinstance(scenario, ScenarioFile) else Scenario.load(scenario)
    if start not in ("free", "given"):
        raise UnknownNameError("start", str(start), ("free", "given"))
    whole = float(loaded.timing.duration)
    lengths = [share * whole for share in _LENGTHS] if durations is None else [_positive(d, "time") for d in durations]
    often = [_positive(rate, "number", "rates") for rate in rates]
    fine = [_positive(noise, "length", "noises") for noise in noises]
    if not (lengths and often and fine):
        raise InvalidValueError("plan", "must have a length, a rate and a noise at least", "none")
    unknown = next((name for name in observed if name not in COLUMNS), None)
    if unknown is not None:
        raise UnknownNameError("column", str(unknown), COLUMNS)
    if max(lengths) * max(often) > _MOST_ROWS:
        told = f"{max(lengths) * max(often):.0f} pictures"
        raise InvalidValueError("rates", f"must make {_MOST_ROWS} pictures at most", told, "Plan for fewer.")
    return _planned(loaded, free, lengths, often, fine, tuple(observed), Camera.of(camera), start=start == "free")


def _positive(given: Any, kind: str, key: str = "durations") -> float:
    number = float(to_si(given, kind, key))
    if not number > 0:
        raise InvalidValueError(key, "must be positive", given)
    return number


def _planned(
    scenario: ScenarioFile,
    free: str | Sequence[str],
    lengths: list[float],
    rates: list[float],
    noises: list[float],
    observed: tuple[str, ...],
    camera: Camera,
    *,
    start: bool,
) -> FitPlan:
    asked: list[int] = []
    sigma = np.empty(0)
    told: tuple[Undetermined, ...] = ()
    names: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    for j, rate in enumerate(rates):
        since = float(scenario.start.time) - float(camera.time_offset)
        time = since + np.arange(int(max(lengths) * rate) + 1) / rate
        blank = np.zeros((time.size, len(observed)))
        seen = Observations(time, observed, blank, np.arange(time.size), "plan", "")
        problem = pose([seen], scenario, free, None, None, camera, start=start)
        values = problem.start
        _check_lasts(problem.models[0], values, time)
        predicted, jacobian = problem.models[0].predict(list(values), time.size, slopes=True)
        if not asked:
            asked = [i for i, one in enumerate(problem.unknowns) if one.asked]
            asked = asked or list(range(len(problem.unknowns)))
            names = tuple(problem.unknowns[i].name for i in asked)
            units = tuple(problem.unknowns[i].unit for i in asked)
            sigma = np.full((len(asked), len(lengths), len(rates), len(noises)), np.nan)
        for i, length in enumerate(lengths):
            rows = int(length * rate) + 1
            flat = np.asarray(jacobian)[:rows].reshape(-1, values.size)
            signal = float(np.linalg.norm(predicted[:rows] - predicted[:rows].mean(axis=0)))
            for n, noise in enumerate(noises):
                sigma[:, i, j, n] = _errors(flat / noise, signal / noise)[asked]
        if rate == max(rates):
            best = directions(np.asarray(jacobian).reshape(-1, values.size) / min(noises), signal / min(noises))
            problem.noises = [type(problem.noises[0])(True, np.full(blank.shape, min(noises)))]
            told = tuple(undetermined(problem, values, best, alone(np.asarray(jacobian).reshape(-1, values.size))))
    return FitPlan(scenario.title, names, units, tuple(lengths), tuple(rates), tuple(noises), sigma, tuple(told))


def _check_lasts(model: RunModel, values: Array, time: Array) -> None:
    """Refuse a length at which the run is over."""
    named = {one.key: float(v) for one, v in zip(model.unknowns, values, strict=True)}
    inside = {key: value for key, value in named.items() if not key.startswith(OUTSIDE)}
    end = methods.run("auto", *keys.moved(model.scenario, inside), time)[1]
    last = float(end.time[-1])
    if last < time[-1]:
        told = f"{time[-1] - time[0]:g} s"
        raise InvalidValueError(
            "durations", "must end before the run does", told, f"It ends after {last - time[0]:.4g} s."
        )


def _errors(jacobian: Array, signal: float) -> Array:
    """Return standard deviations; not a number for what takes part in a direction that is not fixed."""
    if jacobian.shape[0] < jacobian.shape[1]:
        return np.full(jacobian.shape[1], np.nan)
    found = directions(jacobian, signal)
    return np.where(taken(found, alone(jacobian), signal), np.nan, np.sqrt(np.diag(found.covariance)))
