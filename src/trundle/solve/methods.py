"""The methods by name, and which one `auto` takes."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

from ..errors import OutOfDomainError, UnknownNameError
from ..mechanics.system import RollingSystem, State
from .exact import closed_form

METHODS = {"exact": "closed_form", "taylor": "taylor", "runge-kutta": "runge_kutta"}
CHOICES = ("auto", *METHODS)


def choose(method: str, system: RollingSystem, start: State) -> str:
    """Return the method that will run: `auto` takes the closed form where there is one, else Taylor's method.

    Parameters
    ----------
    method : str
        One of `CHOICES`.
    system : RollingSystem
        What will be solved.
    start : State
        A start that rolls.

    Returns
    -------
    str
        One of `METHODS`.

    Raises
    ------
    UnknownNameError
        If there is no such method.
    OutOfDomainError
        If Taylor's method is asked for on a surface that is a table, which has no derivatives to take.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> choose("auto", system, system.place())
    'exact'
    """
    if method not in CHOICES:
        raise UnknownNameError("method", str(method), CHOICES)
    analytic = system.support.surface.analytic
    if method == "auto":
        method = "exact" if closed_form(system, start) is not None else "taylor" if analytic else "runge-kutta"
    if method == "taylor" and not analytic:
        raise OutOfDomainError(
            f"Taylor's method needs a surface that is a formula; a {type(system.support.surface).__name__} is a table. "
            'Use method="runge-kutta".'
        )
    return _instead_of_taylor() if method == "taylor" and not _has_taylor() else method


def _has_taylor() -> bool:
    from .taylor import available

    return available()


@cache  # told once
def _instead_of_taylor() -> str:
    warnings.warn(
        "heyoka has no wheel for this platform on PyPI, so SciPy's DOP853 at 1e-12 runs in place of Taylor's method "
        "at 1e-15. conda-forge has heyoka for every platform.",
        RuntimeWarning,
        stacklevel=2,
    )
    return "runge-kutta"


def solver(method: str) -> Callable[..., Any]:
    """Return the `solve` function of a method.

    Parameters
    ----------
    method : str
        One of `METHODS`.

    Returns
    -------
    callable
        (system, start, times, tolerance, progress) -> Samples.

    Examples
    --------
    >>> solver("exact").__module__
    'trundle.solve.closed_form'
    """
    return import_module(f".{METHODS[method]}", __package__).solve


def tolerance_of(method: str) -> float:
    """Return the tolerance at which a method runs; 0 for a closed form.

    Parameters
    ----------
    method : str
        One of `METHODS`.

    Returns
    -------
    float
        Relative, of each step.

    Examples
    --------
    >>> tolerance_of("exact")
    0.0
    """
    return getattr(import_module(f".{METHODS[method]}", __package__), "TOLERANCE", 0.0)
