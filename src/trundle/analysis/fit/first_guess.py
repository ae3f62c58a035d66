"""Where a fit begins: the start of each run from the first of its data, so that the user need not give one."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...errors import SolverError, TrundleError
from ...mechanics.algebra import Vector
from ...mechanics.duals import slopes_of, value_of
from ...solve.samples import Array
from ..sensitivities import keys
from .model import RunModel
from .observations import GYROSCOPE, Observations
from .problem import Problem
from .unknowns import OUTSIDE, START, camera_with, of_run

_DEGREE = 3
_FEWEST, _MOST = 8, 200  # rows for the polynomial at the start
_BENDS = 5.0  # times the noise: what a polynomial through the fewest rows is off by where they are too far apart for it
_NEARER = 0.1  # of the sum of squares
_ROUNDS = 12
_SETTLED = 1e-10


def first_guess(problem: Problem) -> Array:
    """Return the first values: what the scenario has, with starts as the first rows show them unless its own do better.

    Where neither is near, one of the two is by chance.
    """
    given, shown = problem.start, _as_shown(problem)
    if (given == shown).all():
        return given
    try:
        sums = [float(residual @ residual) for residual in map(problem.residual, (given, shown))]
    except (TrundleError, ArithmeticError, ValueError):  # from one of them there is no motion: as the rows show it
        return shown
    return given if sums[0] < _NEARER * sums[1] else shown


def _as_shown(problem: Problem) -> Array:
    values = problem.start
    for i, (model, noise) in enumerate(zip(problem.models, problem.noises, strict=True)):
        mine = of_run(problem.unknowns, i)
        wanted = [j for j in mine if problem.unknowns[j].key.partition("[")[0] in START]
        if wanted:
            begun = _at_start(model.seen, np.nanmedian(noise.sigma, axis=0))
            try:
                values[wanted] = _started(model, values[mine], [mine.index(j) for j in wanted], begun)
            except (TrundleError, ArithmeticError, ValueError, np.linalg.LinAlgError):
                continue  # the scenario's own start has to do
    return values


def _at_start(seen: Observations, sigma: Array) -> dict[str, tuple[float, float]]:
    """Return value and rate of each column at the first instant, from the longest polynomial that the noise allows.

    Examples
    --------
    >>> from .observations import observe
    >>> t = np.arange(0.0, 1.0, 0.01)
    >>> found = _at_start(observe({"t": t, "x": 1 + 2 * t}), np.array([1e-6]))
    >>> [round(part, 6) for part in found["x"]]
    [1.0, 2.0]
    """
    found = {}
    for name, column, noise in zip(seen.columns, seen.values.T, sigma, strict=True):
        good = np.flatnonzero(np.isfinite(column))[:_MOST]
        t, x = seen.time[good] - seen.time[0], column[good]
        best = (float(x[0]), float((x[-1] - x[0]) / (t[-1] - t[0])) if x.size > 1 else 0.0)
        count = min(_FEWEST, x.size)
        while count <= x.size and count > _DEGREE + 1:
            fit = np.polynomial.Polynomial.fit(t[:count], x[:count], _DEGREE)
            left = x[:count] - fit(t[:count])
            off = np.sqrt((left**2).sum() / (count - _DEGREE - 1))
            if off > (_BENDS if count <= _FEWEST else 2) * noise:
                if count <= _FEWEST:
                    through = np.polynomial.Polynomial.fit(t[: _DEGREE + 1], x[: _DEGREE + 1], _DEGREE)
                    best = float(x[0]), float(through.deriv()(0.0))
                break
            best = float(fit(0.0)), float(fit.deriv()(0.0))
            if count == x.size:
                break
            count = min(2 * count, x.size)
        found[name] = best
    return found


def _started(model: RunModel, values: Array, wanted: list[int], begun: dict[str, tuple[float, float]]) -> Array:
    """Return the start whose place and velocity are those that the data show, and nearest to the scenario's."""
    names = [one.key for one in model.unknowns]
    numbers = dict(zip(names, map(float, values), strict=True))
    camera = camera_with(model.camera, numbers)
    inside = {name: value for name, value in numbers.items() if not name.startswith(OUTSIDE)}
    rows, targets = _wanted(begun, camera, float(model.scenario.start_state().position[2]))
    guess = np.array([values[j] for j in wanted])
    if not rows:
        return _as_fast(model, inside, names, guess, wanted, begun)
    for _ in range(_ROUNDS):
        inside |= {names[j]: float(part) for j, part in zip(wanted, guess, strict=True)}
        listed = [keys.Key(names[j], inside[names[j]], "") for j in wanted]
        fixed = {name: value for name, value in inside.items() if name not in {key.name for key in listed}}
        state: Any = keys.varied(_fixed(model, fixed), listed)[1]
        parts = [*state.position, *state.velocity]
        jacobian = np.array([slopes_of(parts[row], len(wanted)) for row in rows], dtype=float)
        if not np.isfinite(jacobian).all():
            raise SolverError("The motion has no derivative there.")
        apart = np.array([value_of(parts[row]) for row in rows], dtype=float) - targets
        step = -np.linalg.lstsq(jacobian, apart, rcond=1e-9)[0]
        guess = guess + step
        if np.linalg.norm(step) <= _SETTLED * (1 + np.linalg.norm(guess)):
            break
    inside |= {names[j]: float(part) for j, part in zip(wanted, guess, strict=True)}
    keys.moved(model.scenario, inside)  # refuses what is no start
    return guess


def _as_fast(
    model: RunModel, inside: dict[str, float], names: list[str], guess: Array, wanted: list[int], begun: dict[str, Any]
) -> Array:
    """Return the start of a body that turns as fast as its gyroscope shows, along the scenario's direction or along x.

    Ω = Ω₀ + A v of a velocity v, so that |Ω₀ + s A d|² is known: the larger s.
    """
    moving = [i for i, j in enumerate(wanted) if names[j].startswith("start.velocity")]
    if not moving or not set(GYROSCOPE.values()) <= begun.keys():
        return guess
    listed = [keys.Key(names[wanted[i]], float(guess[i]), "") for i in moving]
    fixed = {name: value for name, value in inside.items() if name not in {key.name for key in listed}}
    turning = [*keys.varied(_fixed(model, fixed), listed)[1].angular_velocity]
    A = np.array([slopes_of(part, len(moving)) for part in turning], dtype=float)
    v = guess[moving]
    d = v / np.linalg.norm(v) if v.any() else np.eye(len(moving))[0]
    still, along = np.array([value_of(part) for part in turning], dtype=float) - A @ v, A @ d
    shown = sum(begun[name][0] ** 2 for name in GYROSCOPE.values())
    roots = np.roots([along @ along, 2 * still @ along, still @ still - shown]) if along.any() else np.empty(0)
    real = roots.real[np.abs(roots.imag) <= _SETTLED * np.abs(roots)]
    if real.size:
        guess = guess.copy()
        guess[moving] = max(real) * d
    return guess


def _fixed(model: RunModel, values: dict[str, float]) -> Any:
    """Return the scenario with other numbers, unchecked."""
    return keys._replaced(model.scenario, "", lambda name, value: values.get(name, value))


def _wanted(begun: dict[str, tuple[float, float]], camera: Any, height: float) -> tuple[list[int], Array]:
    """Return which of x, y, z and their rates are known at the start, and what they are in the scenario's frame."""
    place = [begun.get(axis, (np.nan, np.nan)) for axis in "xyz"]
    speed = [begun[f"v{axis}"][0] if f"v{axis}" in begun else one[1] for axis, one in zip("xyz", place, strict=True)]
    known = [np.isfinite(one[0]) for one in place]
    if known[0] != known[1]:  # one of the two: as if the axes were not turned
        whole = [one[0] if ok else 0.0 for one, ok in zip(place, known, strict=True)]
    else:
        whole = [float(np.nan_to_num(one[0])) for one in place]
    at = camera.shows(Vector(*whole), height)
    further = camera.shows(Vector(*(a + np.nan_to_num(v) for a, v in zip(whole, speed, strict=True))), height)
    rate = further - at
    if known[2]:
        at, rate = Vector(at.x, at.y, whole[2] / camera.scale), Vector(rate.x, rate.y, speed[2] / camera.scale)
    rows = [i for i in range(3) if known[i]]
    rows += [3 + i for i in range(3) if np.isfinite(speed[i])]
    both = [*at, *rate]
    return rows, np.array([float(both[i]) for i in rows])
