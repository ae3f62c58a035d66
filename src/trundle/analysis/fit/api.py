"""The entry: measured data, a scenario, what is free; and what comes of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import InvalidValueError, TrundleError, UnknownNameError
from ...extras import need
from ...scenario import ScenarioFile
from ...simulation.simulate import Scenario
from ...solve.samples import Array
from ...units import UNITS, to_si
from .camera import Camera
from .directions import Directions, echelon, taken
from .first_guess import first_guess
from .judging import chi_square, judge
from .lasting import lasting
from .minimising import LOSSES, Minimum, look, minimise
from .model import RunModel
from .observations import Observations, noise_for, observe
from .problem import Prior, Problem, Watch, names_of
from .result import Estimate, Fit
from .spikes import without_spikes
from .undetermined import preference, undetermined
from .unknowns import OUTSIDE, Unknown, changed, limit, of_run, prepared, unknowns
from .unrolled import aligned, mounted, unrolled

_MOST_LIMITS = 8
_PLAINLY = 3.0  # χ²/dof
_RATHER = 100.0  # times as gladly held: a number that else leaves what a file may hold
_CERTAIN = 25.0  # χ² by which motion must beat rest, for each number fitted, to be motion
_DIMENSIONS = {unit: kind for kind, (unit, _) in reversed(UNITS.items())}


def fit(
    data: Any,
    scenario: Any,
    free: str | Sequence[str] = (),
    *,
    priors: Mapping[str, Any] | None = None,
    noise: Any = None,
    camera: Camera | Mapping[str, Any] | None = None,
    loss: str = "linear",
    start: str = "free",
    columns: Mapping[str, str] | None = None,
    units: str | Mapping[str, str] | None = None,
) -> Fit:
    """Fit numbers of a scenario to measured motion, and say which of them the data fix, and how well.

    Least squares with exact derivatives, along the directions that the singular values of the weighted Jacobian leave.
    No start has to be given: it is found from the first rows, and fitted. A number that the data do not fix is held at
    the scenario's value and gets no error; the result names what they fix instead, and what else to measure.

    Parameters
    ----------
    data : Track, mapping, DataFrame, Dataset, path, or a list of these
        Columns over time: ``t`` and some of ``x``, ``y``, ``z`` (the centre), ``vx`` to ``vz``, ``wx`` to ``wz``
        (angular velocity), ``mark_x``, ``mark_y`` (a mark on the support), ``angle`` (by which the support has turned),
        ``spot_x`` to ``spot_z`` (a spot on the body), ``gyro_x`` to ``gyro_z`` (Ω along the axes of a gyroscope that is
        fixed in the body; how it is turned there is fitted). Several runs share what is free, and have each their own
        start.
    scenario : Scenario, str or path
        What moves: a scenario, the name of one that ships, or a file. Its start only helps where the data say nothing.
    free : sequence of str
        Numbers of the scenario by their keys, such as ``"body.inertia_ratio"``, of the camera, such as
        ``"camera.scale"``, and of a gyroscope, ``"gyroscope.bias"``; the key of a list stands for each of its
        components.
    priors : mapping, optional
        What is known beforehand: a value and its standard deviation by key, as ``{"support.tilt": ("0 deg",
        "0.1 deg")}``.
    noise : optional
        Standard deviation of a value: one for all, one for each row, a mapping by column, or a covariance, of the
        columns within a row or of all values. It is not rescaled. Absent: estimated, and rescaled by the fit.
    camera : Camera or mapping, optional
        How measured places differ from those of the scenario.
    loss : str
        "linear", or against outliers "soft_l1", "huber", "cauchy".
    start : str
        "free", or "given": as in the scenario.
    columns : mapping, optional
        Of headings that do not tell: ``{"t": "frame_time", "x": "u"}``.
    units : str or mapping, optional
        Of headings that have none, as of `trundle.read_track`, which reads the data: call it yourself where it asks
        for more.

    Returns
    -------
    Fit
        Values, errors, what is not known, the verdict; it draws and saves itself.

    Raises
    ------
    InvalidValueError
        If the data or a value is refused.
    UnknownNameError
        If there is no such number; the message lists those that there are.
    SolverError
        If the motion cannot be followed.

    Examples
    --------
    A ball on a table at 2 rad/s goes round at 2/7 of that:

    >>> import numpy as np
    >>> import trundle as tr
    >>> t = np.arange(0.0, 10.0, 0.05)
    >>> circle = {"t": t, "x": 0.2 * np.cos(4 / 7 * t), "y": 0.2 * np.sin(4 / 7 * t)}
    >>> table = tr.Scenario.read(
    ...     {
    ...         "body": {"kind": "sphere", "radius": "2 cm", "mass": "50 g", "inertia_ratio": 0.5},
    ...         "support": {"kind": "plane", "motion": {"kind": "spin", "rate": 2.0}},
    ...         "start": {"position": [0, 0]},
    ...         "run": {"duration": "10 s", "every": "50 ms"},
    ...     }
    ... )
    >>> found = tr.fit(circle, table, free=["body.inertia_ratio"], noise="1 mm")
    >>> round(found["body.inertia_ratio"].value, 6)
    0.4
    """
    need("fit", "trundle.fit")
    if loss not in LOSSES:
        raise UnknownNameError("loss", str(loss), LOSSES)
    if start not in ("free", "given"):
        raise UnknownNameError("start", str(start), ("free", "given"))
    several = list(data) if isinstance(data, (list, tuple)) else [data]
    seen = [observe(one, columns, units, f"data {i + 1}") for i, one in enumerate(several)]
    return fit_observed(seen, scenario, free, priors, noise, Camera.of(camera), loss, start=start == "free")


def fit_observed(
    seen: Sequence[Observations],
    scenario: Any,
    free: str | Sequence[str],
    priors: Mapping[str, Any] | None,
    noise: Any,
    camera: Camera,
    loss: str,
    *,
    start: bool,
    cures: bool = True,
    watch: Watch | None = None,
) -> Fit:
    """Fit what was read already; `watch` is told where the fit comes by."""
    loaded = scenario if isinstance(scenario, ScenarioFile) else Scenario.load(scenario)
    problem = pose(seen, loaded, free, priors, noise, camera, start=start)
    calm = without_spikes(problem)
    guess = first_guess(calm or problem)
    slow = unrolled(calm or problem, guess)
    if slow is not None:
        guess = mounted(calm or problem, _solved(slow, aligned(slow, guess), "linear").values)
    if calm is not None:
        calm.watch = watch
        guess = _solved(calm, guess, "linear").values
    problem.watch = watch
    solved = _solved(problem, guess, loss, staged=calm is None)
    problem.watch = None
    return _told(problem, solved, loaded, loss, cures=cures)


def pose(
    seen: Sequence[Observations],
    scenario: ScenarioFile,
    free: str | Sequence[str],
    priors: Mapping[str, Any] | None,
    noise: Any,
    camera: Camera,
    *,
    start: bool,
) -> Problem:
    """Return the problem that a fit solves."""
    names = [free] if isinstance(free, str) else list(free)
    asked = [*names, "start.spin"] if start and any(one.turning for one in seen) else names
    runs = [prepared(scenario, asked, float(one.time[0]) + float(camera.time_offset)) for one in seen]
    found = unknowns(runs[0], names, camera, seen, start=start)
    if not found:
        raise InvalidValueError(
            "free", "must name a number where the start is given", names, "Or leave the start free."
        )
    models = [
        RunModel(run, one, tuple(found[j] for j in of_run(found, i)), camera)
        for i, (run, one) in enumerate(zip(runs, seen, strict=True))
    ]
    noises = [noise_for(noise, one) for one in seen]
    values = sum(int(one.known.sum()) for one in seen)
    if values + len(priors or {}) < len(found):
        told = f"{values} values for {len(found)} numbers: {', '.join(names_of(found))}"
        raise InvalidValueError("data", "must have as many values as numbers are free", told, "Free fewer of them.")
    return Problem(found, models, noises, _priors(priors or {}, found))


def _priors(given: Mapping[str, Any], found: Sequence[Unknown]) -> dict[int, Prior]:
    """Return what is known beforehand, by place."""
    priors = {}
    for name, told in given.items():
        place = next((i for i, one in enumerate(found) if name in (one.name, one.key)), None)
        if place is None:
            raise UnknownNameError("free number, of which a prior may be given", str(name), names_of(found))
        if isinstance(told, (str, bytes)) or not hasattr(told, "__len__") or len(told) != 2:
            raise InvalidValueError(
                f"priors[{name}]", "must be a value and its standard deviation", told, "(0.4, 0.01)"
            )
        kind = _DIMENSIONS.get(found[place].unit, "number")
        value, sigma = (float(to_si(part, kind, f"priors[{name}]")) for part in told)
        if not sigma > 0:
            raise InvalidValueError(
                f"priors[{name}]", "must have a positive deviation", told, "Leave the key not free."
            )
        priors[place] = Prior(value, sigma)
    return priors


@dataclass(frozen=True)
class _Solved:
    """The best values, with what was held on the way."""

    values: Array
    free: Directions  # at the values, of all that is free
    covariance: Array
    pivots: list[int]
    limits: dict[int, tuple[float, float]]  # place: what the data alone say, and its error
    result: Any
    evaluations: int


def _solved(problem: Problem, guess: Array, loss: str, *, staged: bool = True) -> _Solved:
    """Return the minimum; along directions that are free, with the scenario's value of one number of each."""
    none = np.zeros(guess.size, dtype=bool)
    for place, prior in problem.priors.items():
        guess[place] = prior.value
    found = minimise(problem, guess, none, loss, staged=staged)
    evaluations = found.evaluations
    if staged and _far(
        problem, found.values
    ):  # perhaps a minimum that is not the least: once more, with all data at once
        again = minimise(problem, guess, none, loss, staged=False)
        evaluations += again.evaluations
        if _sum(problem, again.values) < _sum(problem, found.values):
            found = again
    found, pivots = _with_pivots(problem, found, guess, none, loss, staged=staged)
    limits: dict[int, tuple[float, float]] = {}
    for _ in range(_MOST_LIMITS):
        beyond = _beyond(problem, found.values, [*pivots, *limits])
        if not beyond:
            break
        sigma = np.sqrt(np.diag(_scaled(problem, found)))
        values = found.values.copy()
        for place, bound in beyond.items():
            limits[place] = float(values[place]), float(sigma[place])
            values[place] = bound
        held = none.copy()
        held[[*pivots, *limits]] = True
        found = minimise(problem, values, held, loss, staged=False)
    evaluations += found.evaluations
    held = none.copy()
    held[list(limits)] = True
    whole = look(problem, found.values, held)
    covariance = found.covariance if not (pivots and loss == "linear") else whole.covariance
    return _Solved(found.values, whole, covariance, pivots, limits, found.result, evaluations)


def _sum(problem: Problem, values: Array) -> float:
    residual = problem.residual(values)
    return float(residual @ residual)


def _far(problem: Problem, values: Array) -> bool:
    """Tell whether what is left over is larger than any noise."""
    return _sum(problem, values) > _PLAINLY * problem.size


def _with_pivots(
    problem: Problem, found: Minimum, guess: Array, held: Array, loss: str, *, staged: bool
) -> tuple[Minimum, list[int]]:
    """Return the minimum again with one number of each direction that is free held where the fit began."""
    beyond: dict[int, float] = {}
    for _ in range(2):
        pivots: list[int] = []
        for null in (found.directions.free, found.directions.weak):
            if null.shape[1]:
                _, jacobian = problem.both(found.values)
                scale = alone(jacobian)
                liked = preference(problem.unknowns, null, scale)
                liked[[*beyond]] *= _RATHER
                pivots += echelon(null, scale, liked)[1]
        if not pivots:
            return found, pivots
        values, holding = found.values.copy(), held.copy()
        values[pivots] = guess[pivots]
        holding[pivots] = True
        there = minimise(problem, values, holding, loss, staged=staged)
        beyond = _beyond(problem, there.values, pivots)
        if not beyond:  # else another number of a free direction is held, for which there may be a motion
            break
    return there, pivots


def alone(jacobian: Array) -> Array:
    """Return the standard deviation that each number would have if nothing else were free; 1 where it does not show."""
    norms = np.linalg.norm(jacobian, axis=0)
    return np.asarray(1.0 / np.where(norms > 0, norms, 1.0))


def _beyond(problem: Problem, values: Array, held: Sequence[int]) -> dict[int, float]:
    """Return the limit of each number that left what a file may hold."""
    found = {}
    for i, one in enumerate(problem.unknowns):
        if i not in held:
            scenario = problem.models[one.run or 0].scenario
            bound = limit(scenario, one.key, one.value, float(values[i]))
            if bound is not None:
                found[i] = bound
    return found


def _scaled(problem: Problem, found: Minimum) -> Array:
    """Return the covariance, by the scatter of the residuals where no noise was given."""
    if all(noise.known for noise in problem.noises):
        return found.covariance
    residual = problem.residual(found.values)
    freedom = residual.size - found.directions.basis.shape[1]
    return np.asarray(found.covariance * (chi_square(problem, residual) / freedom if freedom > 0 else 1.0))


def _told(problem: Problem, solved: _Solved, scenario: ScenarioFile, loss: str, *, cures: bool) -> Fit:
    """Return the result."""
    values, found = solved.values, solved.free
    judgement = judge(problem, values, found.basis.shape[1], robust=loss != "linear")
    factor = 1.0
    if not judgement.noise_known and judgement.freedom > 0:
        factor = judgement.reduced
    _, jacobian = problem.both(values)
    scale = alone(jacobian)
    together = taken(found, scale, problem.signal())
    added = lasting(problem, values, found.basis, memory=not judgement.noise_known)
    grown = np.linalg.cholesky(factor * np.eye(len(added)) + added)
    scaled = replace(found, basis=found.basis @ grown)
    open_ = undetermined(problem, values, scaled, scale, cures=cures)
    covariance = solved.covariance * factor + found.basis @ added @ found.basis.T
    estimates = tuple(
        _estimate(
            one, float(values[i]), float(covariance[i, i]), bool(together[i]), i in solved.pivots, solved.limits.get(i)
        )
        for i, one in enumerate(problem.unknowns)
    )
    fitted = tuple(_fitted(problem, values, run, scenario) for run in range(len(problem.models)))
    covariance = np.where(together[:, None] | together[None], 0.0, covariance)
    moves = _moves(problem, judgement.chi_square, found.basis.shape[1])
    return Fit(scenario.title, problem, values, estimates, covariance, tuple(open_), judgement, fitted, loss, moves,
               solved.evaluations, solved.result)  # fmt: skip


def _estimate(
    one: Unknown, value: float, variance: float, together: bool, pivot: bool, at_limit: tuple[float, float] | None
) -> Estimate:
    if at_limit is not None:
        alone_, sigma = at_limit
        return Estimate(one.name, value, None, one.unit, "limit", one.asked, alone_, sigma)
    if together:
        return Estimate(one.name, value, None, one.unit, "held" if pivot else "together", one.asked)
    return Estimate(one.name, value, float(np.sqrt(max(variance, 0.0))), one.unit, "fitted", one.asked)


def _fitted(problem: Problem, values: Array, run: int, scenario: ScenarioFile) -> ScenarioFile:
    """Return the scenario of one run with the values found, over the time of its data."""
    model = problem.models[run]
    numbers = {
        problem.unknowns[j].key: float(values[j])
        for j in of_run(problem.unknowns, run)
        if not problem.unknowns[j].key.startswith(OUTSIDE)
    }
    there = changed(model.scenario, numbers)
    time = model.seen.time
    step = float(f"{np.median(np.diff(time)):.9g}")
    timing = there.timing.model_copy(update={"duration": float(time[-1] - time[0]), "every": step})
    timing.__pydantic_fields_set__ = {*there.timing.model_fields_set, "duration", "every"}
    title = f"{scenario.title}, fitted to {model.seen.label}"
    update = {"timing": timing, "title": title[:300], "notes": ""}
    if getattr(scenario.support, "rim", None) is not None and "support.rim" not in numbers:
        with suppress(TrundleError):  # where the body starts beyond the rim, it has none
            rimmed = there.support.model_copy(update={"rim": scenario.support.rim})
            rimmed.__pydantic_fields_set__ = there.support.model_fields_set | {"rim"}
            found = Scenario.loads(there.model_copy(update={**update, "support": rimmed}).to_toml(), title)
            found.start_state()
            return found
    return Scenario.loads(there.model_copy(update=update).to_toml(), title)


def _moves(problem: Problem, chi_square: float, fitted: int) -> bool:
    """Tell whether the data show motion at all: whether rest at one place does plainly worse."""
    rest = sum(
        float(np.nansum(((one.seen.values - np.nanmean(one.seen.values, axis=0)) / noise.sigma) ** 2))
        for one, noise in zip(problem.models, problem.noises, strict=True)
    )
    if not all(noise.known for noise in problem.noises):
        freedom = max(problem.size - fitted, 1)
        return rest - chi_square > _CERTAIN * fitted * max(chi_square / freedom, 1e-300)
    return rest - chi_square > _CERTAIN * fitted
