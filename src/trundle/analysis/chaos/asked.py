"""What the questions of this room have in common: which system, from which start, for how long, by which method."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...errors import InvalidValueError, UnknownNameError
from ...mechanics import checks
from ...mechanics.finiteness import check_finite
from ...mechanics.system import RollingSystem, State
from ...scenario import ScenarioFile
from ...simulation.simulate import Scenario, check_state
from ...solve import runge_kutta, taylor
from ...solve.contact_state import ContactState
from ...solve.laws import Law
from ...solve.phases import Integrate
from ...solve.samples import Array
from ..sensitivities.following import method_for

METHODS = ("auto", "taylor", "runge-kutta")


@dataclass(frozen=True)
class Asked:
    """A system and a start, from a scenario or by themselves."""

    title: str  # of the scenario; empty where there is none
    system: RollingSystem  # what moves
    start: State  # from where
    scenario: ScenarioFile | None = None  # where they come from

    @classmethod
    def of(cls, given: Any, start: State | None) -> Asked:
        """Return what is asked about: a system with a start, a scenario, its name or its file."""
        if isinstance(given, RollingSystem):
            start = given.place() if start is None else start
            checks.instance(start, State, "start", "Let system.place(...) make it.")
            check_state(given, start)
            return cls("", given, start)
        scenario = given if isinstance(given, ScenarioFile) else Scenario.load(given)
        system = scenario.system()
        start = scenario.start_state() if start is None else start
        checks.instance(start, State, "start", "Let system.place(...) make it.")
        check_state(system, start)
        return cls(scenario.title, system, start, scenario)

    def duration(self, given: Any) -> float:
        """Return how long, s: as asked for, or as the scenario says."""
        if given is None and self.scenario is None:
            raise InvalidValueError("duration", "must be given with a system", given, 'Give for instance "100 s".')
        length = float(self.scenario.timing.duration) if given is None and self.scenario else given
        found = float(checks.positive(length, "time", "duration"))
        check_finite(self.system, self.start.time, self.start.time + found)
        return found

    @property
    def moment(self) -> float:
        """A time in which the motion changes, s."""
        return ContactState.of(self.system, self.start).moment(self.system)


def integrator(
    system: RollingSystem, method: str, tolerance: float | None, begin: float, end: float
) -> tuple[Integrate, float]:
    """Return a method's way through one stretch of a run, and its tolerance."""
    if method not in METHODS:
        raise UnknownNameError("method of the variational equations", str(method), METHODS)
    module: Any = {"auto": method_for(system), "taylor": taylor, "runge-kutta": runge_kutta}[method]
    error = module.TOLERANCE if tolerance is None else tolerance
    if module is not taylor:
        return runge_kutta.integrate, error
    shared = taylor.Shared()
    shared.patience(begin, end)
    return partial(taylor.integrate, shared=shared), error


def scale_of(system: RollingSystem, law: Law, length: float, rate: float) -> Array:
    """Return what is large of each number of a law's state, in its unit.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.solve.laws import RollingLaw
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> scale_of(ball, RollingLaw(), 0.1, 10.0).tolist()
    [0.1, 0.1, 0.1, 1.0, 1.0, 1.0, 1.0, 10.0, 10.0, 10.0]
    """
    sizes = {"p": length, "r": length, "g": length, "q": 1.0, "Omega": rate, "support": 1.0}
    kinds = system.support.motion.coordinate_kinds
    own = [sizes.get(name.partition("_")[0], length * rate) for name in law.variables]
    return np.array([*own, *(1.0 if kind == "angle" else rate for kind in kinds)])


def checked_count(count: Any, most: int) -> int:
    """Return how many exponents are wanted, at most as many as there are."""
    if count is None:
        return most
    if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= most:
        raise InvalidValueError("count", f"must be a whole number from 1 to {most}, the dimension of the motion", count)
    return count


def finite_or_none(values: Sequence[float]) -> list[float | None]:
    """Return numbers as JSON takes them, None for those that are not finite."""
    return [float(value) if math.isfinite(value) else None for value in values]
