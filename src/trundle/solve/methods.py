"""The methods by name, and which one `auto` takes."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InvalidValueError, OutOfDomainError, UnknownNameError
from ..mechanics.overlap import fits_anywhere
from ..mechanics.system import RollingSystem, State
from .exact import closed_form
from .samples import Array, Progress, Samples
from .walls import UpToWall, looks

if TYPE_CHECKING:
    from .dense import Dense

METHODS = {"exact": "closed_form", "taylor": "taylor", "runge-kutta": "runge_kutta"}
CHOICES = ("auto", *METHODS)
_FINEST, _COARSEST = 1e-15, 1e-6  # tolerances that can be asked for


@dataclass(frozen=True)
class Method:
    """A method and how finely it works.

    Examples
    --------
    >>> Method.of("taylor", 1e-9), Method.of("exact", 1e-9).tolerance
    (Method(name='taylor', tolerance=1e-09), 0.0)
    """

    name: str  # one of `METHODS`
    tolerance: float  # relative, of each step; 0 for a closed form

    @classmethod
    def of(cls, name: str, tolerance: float | None = None) -> Method:
        """Return a method at a tolerance, or the nearest that it can keep; absent: its own."""
        own = tolerance_of(name)
        return cls(name, own if tolerance is None or own == 0 else max(tolerance, _of(name, "FINEST", _FINEST)))

    def solve(self, system: RollingSystem, start: State, times: Array, progress: Progress | None = None) -> Samples:
        """Return the samples of a run at ascending times, s, none before the start."""
        if not times.size or fits_anywhere(system):
            return self._solve(system, start, times, progress)
        if self.name == "exact":
            return self._up_to_wall(system, start, float(times[-1]))(times)
        looked_at = looks(start.time, float(times[-1]))
        found = self._solve(system, start, np.union1d(times, looked_at), progress)
        last = found.time.size - 1
        seen = found.part(np.union1d(np.flatnonzero(np.isin(found.time, looked_at)), last))  # no more of a million
        up_to_wall = self._up_to_wall(system, start, float(times[-1]))
        if up_to_wall.is_short(found) or up_to_wall.runs_into(seen).any():
            kept = self._kept(system, start, float(times[-1]))
            if kept.up_to_wall.wall is not None:
                return kept(times)
        rows = np.searchsorted(found.time, times[times <= found.time[-1]])
        if any(event.final for event in found.events) and last not in rows[-1:]:  # there, too, it is sampled
            rows = np.append(rows, last)
        return found.part(rows)

    def _solve(self, system: RollingSystem, start: State, times: Array, progress: Progress | None = None) -> Samples:
        """Return the samples of a run, whatever the body runs into."""
        return solver(self.name)(system, start, times, self.tolerance, progress)

    def _up_to_wall(self, system: RollingSystem, start: State, end: float) -> UpToWall:
        """Return a run that ends where the body comes to a second wall."""
        return UpToWall(partial(self._solve, system, start), system, start.time, end, self.tolerance)

    def dense(self, system: RollingSystem, start: State, end: float) -> Callable[[Array], Samples]:
        """Return what gives samples of one and the same run at any ascending instants up to its end, s."""
        if self.name == "exact":
            return self._up_to_wall(system, start, end)
        return self._kept(system, start, end)

    def _kept(self, system: RollingSystem, start: State, end: float) -> Dense:
        """Return the same by a numerical method, gone through once."""
        from .dense import Dense

        module = import_module(f".{METHODS[self.name]}", __package__)
        keep, beside = module.keeping()
        return Dense(keep, beside, system, start, end, self.tolerance)


def choose(method: str, system: RollingSystem, start: State) -> str:
    """Return the method that a run begins with: `auto` takes the closed form where there is one, else Taylor's method.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> choose("auto", system, system.place())
    'exact'
    """
    if method not in CHOICES:
        raise UnknownNameError("method", str(method), CHOICES)
    if method == "auto":
        return "exact" if closed_form(system, start) is not None else _numerical(system)
    if method == "taylor" and not system.support.surface.analytic:
        raise OutOfDomainError(
            f"Taylor's method needs a surface that is a formula; a {system.support.surface.word} is a table. "
            'Use method="runge-kutta".'
        )
    return _numerical(system) if method == "taylor" else method


def run(
    method: str,
    system: RollingSystem,
    start: State,
    times: Array,
    progress: Progress | None = None,
    tolerance: float | None = None,
) -> tuple[Method, Samples]:
    """Run a method; `auto` leaves the closed forms where a phase has none, for what takes least work to the tolerance.

    Examples
    --------
    A ball slips on a turning table before it rolls, which only the rolling has a closed form for:

    >>> import numpy as np
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.0), friction=0.2)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), table)
    >>> start = system.place(velocity=(1.0, 0.0), angular_velocity=(0.0, 0.0, 0.0))
    >>> run("auto", system, start, np.array([0.0, 1.0]))[0]
    Method(name='taylor', tolerance=1e-15)
    """
    check_tolerance(tolerance)
    if method == "auto":
        with suppress(OutOfDomainError):
            exact = Method.of("exact")
            return exact, exact.solve(system, start, times, progress)
        chosen = _cheapest(system, start, float(times[-1]) if times.size else start.time, tolerance)
    else:
        chosen = Method.of(choose(method, system, start), tolerance)
    return chosen, chosen.solve(system, start, times, progress)


def check_tolerance(tolerance: Any, name: str = "tolerance") -> None:
    """Refuse what is no tolerance; None is one.

    Examples
    --------
    >>> check_tolerance(1e-9)
    """
    known = isinstance(tolerance, (int, float)) and not isinstance(tolerance, bool)
    if tolerance is not None and not (known and _FINEST <= tolerance <= _COARSEST):
        remedy = "Leave it out for the last digit; 1e-9 is twice as fast, and nothing that a picture shows."
        raise InvalidValueError(name, f"must be a number from {_FINEST:g} to {_COARSEST:g}", tolerance, remedy)


def _cheapest(system: RollingSystem, start: State, end: float, tolerance: float | None) -> Method:
    """Return the numerical method that takes the least work to the error that Taylor's has at a tolerance."""
    name = _numerical(system)
    if tolerance is None or not system.support.surface.analytic:
        return Method.of(name, tolerance)
    from .step_work import of_equal_error, takes_less

    if name == "taylor" and not takes_less(system, start, end, tolerance):
        return Method.of(name, tolerance)
    return Method.of("runge-kutta", of_equal_error(tolerance))


def _numerical(system: RollingSystem) -> str:
    """Return the best numerical method for a system."""
    if not system.support.surface.analytic:
        return "runge-kutta"
    return "taylor" if _has_taylor() else _instead_of_taylor()


def _has_taylor() -> bool:
    from .taylor import available

    return available()


@cache  # told once
def _instead_of_taylor() -> str:
    from .compiled_steps import available

    faster = "" if available() else " numba makes it thirty times as fast, or more: pip install 'trundle[numba]'."
    warnings.warn(
        "heyoka has no wheel for this platform on PyPI, so DOP853 at 1e-12 runs in place of Taylor's method at 1e-15."
        f"{faster} conda-forge has heyoka for every platform.",
        RuntimeWarning,
        stacklevel=2,
    )
    return "runge-kutta"


def solver(method: str) -> Callable[..., Any]:
    """Return the `solve` function of a method.

    Examples
    --------
    >>> solver("exact").__module__
    'trundle.solve.closed_form'
    """
    return import_module(f".{METHODS[method]}", __package__).solve


def tolerance_of(method: str) -> float:
    """Return the tolerance at which a method runs unless another is asked for; 0 for a closed form.

    Examples
    --------
    >>> tolerance_of("exact")
    0.0
    """
    return _of(method, "TOLERANCE", 0.0)


def _of(method: str, name: str, absent: float) -> float:
    return float(getattr(import_module(f".{METHODS[method]}", __package__), name, absent))
