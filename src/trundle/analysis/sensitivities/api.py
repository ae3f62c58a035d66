"""The one entry: which run, by which numbers, and the labels of what comes of it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValueError, UnknownNameError
from ...mechanics.system import RollingSystem
from ...scenario import ScenarioFile
from ...simulation import labels
from ...simulation.memory import check_room
from ...simulation.simulate import Scenario
from ...simulation.trajectory import Trajectory
from ...solve import transitions
from ...solve.samples import Array, Progress
from ...solve.sampling import longer_step, sample_times
from ...solve.variational import keeps_charts
from .by_formula import follow_formula
from .comparing import Agreement, compare
from .following import Followed, follow, method_for
from .keys import Key, chosen, varied
from .result import Sensitivities

if TYPE_CHECKING:
    import xarray


METHODS = ("auto", "variational")


def sensitivities(
    run_or_scenario: Any,
    wrt: str | Sequence[str],
    *,
    duration: Any = None,
    every: Any = None,
    method: str = "auto",
    compared: bool = True,
    progress: Progress | None = None,
) -> Sensitivities:
    """Return the first derivatives of all that is sampled in a run, by numbers of its scenario.

    They are exact: by the variational equations of each phase, across events with what these change, and through the
    search for the contact at the start. Each is taken at a fixed instant, so that before an event and after it they
    differ by how much the event moves.

    Parameters
    ----------
    run_or_scenario : Trajectory, Scenario, str or path
        A run, a scenario, the name of one that ships, or a file.
    wrt : sequence of str
        Numbers of the scenario by their keys, such as ``"support.tilt"`` or ``"loads[0].coefficient"``. The key of a
        list stands for each of its components: ``"start.velocity"`` for ``"start.velocity[0]"`` and
        ``"start.velocity[1]"``.
    duration, every : float or quantity, optional
        Instead of the scenario's, s. A run has its own.
    method : str
        "auto": by the formula where one closed form covers all of the run and can be differentiated, else by the
        variational equations. "variational": by these.
    compared : bool
        Whether to compare them with differences of four runs.
    progress : callable, optional
        Told the fraction done, 0 to 1.

    Returns
    -------
    Sensitivities
        The derivatives as a dataset over time, axis and parameter, in SI units, with their agreement.

    Raises
    ------
    InvalidValueError
        If a number cannot be changed alone, or is no number.
    UnknownNameError
        If the scenario has no such number; the message lists those that it has.
    SolverError
        If the motion has no derivative, because an event is only just reached, or cannot be followed.

    Examples
    --------
    How far a ball on a table is after a second, by how fast it started:

    >>> import trundle as tr
    >>> found = tr.sensitivities("level-turntable-nudged", wrt="start.velocity", duration="1 s", every="1 s")
    >>> rate = 2 / 7 * tr.Scenario.load("level-turntable-nudged").support.motion.rate
    >>> slope = found.position.sel(parameter="start.velocity[1]", axis="y").values[-1]
    >>> round(float(slope), 9) == round(float(np.sin(rate) / rate), 9)
    True
    """
    if method not in METHODS:
        raise UnknownNameError("method of derivatives", str(method), METHODS)
    scenario, times = _read(run_or_scenario, duration, every)
    wanted = chosen(scenario, [wrt] if isinstance(wrt, str) else list(wrt))
    if not wanted:
        raise InvalidValueError("wrt", "must name a number of the scenario at least", wrt, "Give ['support.tilt'].")
    system, start = scenario.system(), scenario.start_state()
    in_duals = varied(scenario, wanted)
    check_room(times.size, labels.size_of(system) * len(wanted), "every", every, partial(longer_step, times))
    tolerance = _tolerance(run_or_scenario)
    followed = None
    if method != "variational":
        followed = follow_formula(system, start, times, in_duals, [key.name for key in wanted])
    way = "variational" if followed is None else "exact"
    if followed is None:
        followed = _in_parts(scenario, wanted, times, tolerance, progress)
    agreement = Agreement(np.nan, np.nan, 0)
    if compared:
        agreement = compare(scenario, wanted, followed, times, method_for(system).solve)
    return Sensitivities(scenario.title, _dataset(system, wanted, followed, way), way, agreement)


def _read(given: Any, duration: Any, every: Any) -> tuple[ScenarioFile, Array]:
    """Return the scenario and the instants."""
    if not isinstance(given, Trajectory):
        scenario = given if isinstance(given, ScenarioFile) else Scenario.load(given)
        length = float(scenario.timing.duration) if duration is None else duration
        step = float(scenario.timing.every) if every is None else every
        return scenario, float(scenario.start.time) + sample_times(length, step)
    for name, value in (("duration", duration), ("every", every)):
        if value is not None:
            raise InvalidValueError(name, "belongs to a scenario; a run has its own samples", value, "Leave it out.")
    if not given.scenario:
        rule = "must be a run whose scenario can be written: its numbers have no keys otherwise"
        raise InvalidValueError("run", rule, given.title, "A part of it is of a kind of your own.")
    return Scenario.loads(given.scenario, given.title or "run"), given.data.time.values.astype(float)


def _in_parts(
    scenario: ScenarioFile, wanted: Sequence[Key], times: Array, tolerance: float | None, progress: Progress | None
) -> Followed:
    """Follow the run with its derivatives, those apart by numbers that break a symmetry by which the law is short."""
    system, start = scenario.system(), scenario.start_state()

    def by(keys: Sequence[Key]) -> Followed:
        return follow(system, start, times, varied(scenario, keys), [key.name for key in keys], tolerance, progress)

    law = transitions.at_start(system, start).law
    short = [key for key in wanted if keeps_charts(varied(scenario, [key])[0], law)]
    rest = [key for key in wanted if key not in short]
    if not (short and rest):
        return by(wanted)
    first, second = by(short), by(rest)
    if first.samples.time.size != second.samples.time.size or first.instants.shape[0] != second.instants.shape[0]:
        return by(wanted)
    order = [[*short, *rest].index(key) for key in wanted]

    def joined(one: Array, other: Array) -> Array:
        return np.concatenate([one, other], axis=-1)[..., order]

    slopes = {name: joined(columns, second.slopes[name]) for name, columns in first.slopes.items()}
    return Followed(first.samples, slopes, joined(first.instants, second.instants))


def _tolerance(given: Any) -> float | None:
    return given.tolerance if isinstance(given, Trajectory) and given.method == "taylor" else None


def _dataset(system: RollingSystem, wanted: Sequence[Key], followed: Followed, method: str) -> xarray.Dataset:
    """Label the derivatives."""
    import xarray

    samples, slopes = followed.samples, dict(followed.slopes)
    support = slopes.pop("support")
    slopes |= {name: support[:, i] for i, name in enumerate(labels.coordinate_names(system))}
    variables = {
        name: ((*dims, "parameter"), slopes[name], _of_slopes(about))
        for name, (dims, about) in labels.facts(system).items()
        if name in slopes
    }
    instant = {"long_name": "derivative of the time of the event", "units": "s per unit of the parameter"}
    coordinates = {
        **labels.coordinates(samples.time),
        "parameter": [key.name for key in wanted],
        "value": ("parameter", [key.value for key in wanted], {"long_name": "value of the parameter, SI"}),
        "unit": ("parameter", [key.unit for key in wanted], {"long_name": "SI unit of the parameter"}),
        "kind": (
            "event",
            np.array([event.kind for event in samples.events], dtype=object),
            {"long_name": "kind of the event"},
        ),
        "instant": (
            "event",
            np.array([event.time for event in samples.events], dtype=float),
            {"long_name": "time of the event", "units": "s"},
        ),
    }
    variables["event_time"] = (("event", "parameter"), followed.instants, instant)
    return xarray.Dataset(variables, coords=coordinates, attrs={"method": method, "frame": "support"})


def _of_slopes(about: dict[str, Any]) -> dict[str, str]:
    units = about["units"]
    return {
        "long_name": f"derivative of: {about['long_name']}",
        "units": f"{units} per unit of the parameter" if units != "1" else "1 per unit of the parameter",
    }
