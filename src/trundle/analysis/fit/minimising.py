"""Least squares by lmfit, along the directions that the data fix, over longer and longer stretches of the data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import SolverError, TrundleError
from ...solve.samples import Array
from .directions import Directions, directions
from .problem import Problem

LOSSES = ("linear", "soft_l1", "huber", "cauchy")
_FEWEST = 3.0  # values for each unknown, in the first stretch
_PART = 0.3  # of a number, by which the scenario's may be off
_LONGER = 3.0  # times, from one stretch to the next
_AS_SAID = 0.3  # share of a change that derivatives may miss and still do
_FIRST = 1e-2  # of MINPACK's first step, a hundred over this: in standard deviations, as far as a guess may be off
_THERE = 1e-3  # standard deviations
_NEAR = 0.3  # standard deviations
_ROUNDS = 5  # in which the directions are found again
_STAGE, _LAST = 20, 60  # trials


@dataclass(frozen=True)
class Minimum:
    """Where the sum of squares is least."""

    values: Array  # (p,): of the unknowns
    directions: Directions  # there
    covariance: Array  # (p, p): of the unknowns along the directions fixed, by lmfit; not scaled
    result: Any  # of the last round; None where nothing is fixed
    evaluations: int  # of the model


def minimise(
    problem: Problem, values: Array, held: Any, loss: str = "linear", *, staged: bool = True, most: int = _LAST
) -> Minimum:
    """Return the minimum nearest to a first guess; unknowns that are held keep their values.

    Raises
    ------
    TrundleError
        If there is no motion from the first guess on.
    """
    evaluations = 0
    if staged:
        values, evaluations = _staged(problem, values, held)
    problem.until = 1.0
    found = look(problem, values, held)
    for _ in range(_ROUNDS if most == _LAST else 1):
        rank = found.basis.shape[1]
        if rank == 0:
            return Minimum(values, found, np.zeros((values.size, values.size)), None, evaluations)
        values, result = _lmfit(problem, values, found.basis, loss, most, 1e-4)
        evaluations += result.nfev
        again = look(problem, values, held)
        same, found_before, found = again.basis.shape[1] == rank, found, again
        there = values if loss != "linear" else _close_by(problem, values, found)
        if same and there is not None:
            values = there
            break
    covariance = _covariance(problem, result, found_before.basis, found, loss)
    return Minimum(values, found, covariance, result, evaluations)


def _covariance(problem: Problem, result: Any, basis: Array, found: Directions, loss: str) -> Array:
    """Return lmfit's covariance of the combinations as that of the unknowns.

    Where something is free, the directions turn on the way, and where derivatives were mended, lmfit's last are not
    exact: then it is taken from those at the minimum.
    """
    exact = found.free.shape[1] + found.weak.shape[1] == 0 and problem.by_formula
    whole = exact or loss != "linear"
    if getattr(result, "covar", None) is None or basis.shape[1] != found.basis.shape[1] or not whole:
        return found.covariance
    return np.asarray(basis @ result.covar @ basis.T)


def _close_by(problem: Problem, values: Array, found: Directions) -> Array | None:
    """Return the minimum if it is here, or a step away over which the derivatives here hold; else None.

    Lengths are in standard deviations. That the derivatives hold is seen there: nothing is left of their slope. What
    comes after then has these derivatives, too.
    """
    residual, jacobian = problem.both(values)
    step = found.basis.T @ (jacobian.T @ residual)  # of Gauss and Newton, backwards
    unit = np.sqrt(max(1.0, _reduced(residual)))
    if np.linalg.norm(step) < _THERE * unit:
        return values
    if problem.by_formula or np.linalg.norm(step) > _NEAR * unit:
        return None
    there = values - found.basis @ step
    left = problem.tried(there)
    if not np.linalg.norm(found.basis.T @ (jacobian.T @ left)) < _THERE * unit:
        return None
    problem.last = (there.tobytes(), problem.until, left, jacobian)
    return there


def _reduced(residual: Array) -> float:
    return float(residual @ residual) / residual.size


def look(problem: Problem, values: Array, held: Any) -> Directions:
    """Return the directions at some values; held unknowns take part in none."""
    _, jacobian = problem.both(values)
    found = directions(jacobian[:, ~held], problem.signal())

    def among_all(columns: Array) -> Array:
        whole = np.zeros((held.size, columns.shape[1]))
        whole[~held] = columns
        return whole

    return Directions(among_all(found.basis), among_all(found.free), among_all(found.weak), found.values)


def _staged(problem: Problem, values: Array, held: Any) -> tuple[Array, int]:
    """Return values found over longer and longer stretches: what turns many times has many false minima at once."""
    whole, evaluations = problem.size, 0
    share = min(1.0, max(_FEWEST * values.size, 16.0) / max(whole, 1))
    while share < 1:
        problem.until = share
        try:
            basis = _careful(problem, values, held)
            if basis.shape[1]:
                values, result = _lmfit(problem, values, basis, "linear", _STAGE, 1e-2)
                evaluations += result.nfev
        except TrundleError:
            break
        share *= _LONGER
    problem.until = 1.0
    return values, evaluations


def _careful(problem: Problem, values: Array, held: Any) -> Array:
    """Return the directions that a stretch fixes well enough to move along them already.

    A number that was asked for may be off by a part of itself; any other by what moves the body across all it went.
    """
    _, jacobian = problem.both(values)
    norms = np.linalg.norm(jacobian, axis=0)
    scale = problem.signal() / np.where(norms > 0, norms, np.inf)
    for j, one in enumerate(problem.unknowns):
        if one.asked and values[j] != 0:
            scale[j] = min(scale[j], _PART * abs(values[j]))
    scale[held] = 0.0
    _, s, Vt = np.linalg.svd(jacobian * scale, full_matrices=False)
    good = s > 1.0
    return np.asarray((scale[:, None] * Vt.T)[:, good] / s[good])


def _updated(known: list[Array], place: Array, residuals: Array) -> list[Array] | None:
    """Return derivatives that a step has mended (Broyden 1965); None where the step did not go as they said.

    Those at the minimum are exact again: only the way there is cheaper.
    """
    step, change = place - known[0], residuals - known[1]
    missed = change - known[2] @ step
    if not 0 < np.linalg.norm(missed) <= _AS_SAID * np.linalg.norm(change):
        return None
    return [place, residuals, known[2] + np.outer(missed, step) / (step @ step)]


def _lmfit(problem: Problem, values: Array, basis: Array, loss: str, most: int, tolerance: float) -> tuple[Array, Any]:
    """Let lmfit move along some directions, whose steps are of one standard deviation."""
    import lmfit

    parameters = lmfit.Parameters()
    names = [f"c{i}" for i in range(basis.shape[1])]
    for name in names:
        parameters.add(name, value=0.0)

    def at(now: Any) -> Array:
        return np.asarray(values + basis @ np.array([now[name].value for name in names]))

    def residual(now: Any) -> Array:
        return problem.tried(at(now))

    mended = loss == "linear" and not problem.by_formula
    known: list[Array] = []  # where the derivatives are known, the residuals there, and these

    def jacobian(now: Any) -> Array:
        place = np.array([now[name].value for name in names])
        try:
            found = _updated(known, place, problem.residual(at(now))) if known and mended else None
            if found is None:
                residuals, slopes = problem.both(at(now))
                found = [place, residuals, slopes @ basis]
            known[:] = found
            return known[2]
        except (TrundleError, ArithmeticError, ValueError):
            raise SolverError("The fit came to numbers with which there is no motion.") from None

    minimiser = lmfit.Minimizer(residual, parameters, scale_covar=False, nan_policy="raise", max_nfev=most)
    if loss == "linear":
        first = np.full(len(names), _FIRST)
        result = minimiser.leastsq(Dfun=jacobian, ftol=tolerance, xtol=tolerance, gtol=0.0, diag=first)
    else:
        result = minimiser.least_squares(jac=jacobian, loss=loss, ftol=tolerance, xtol=tolerance)
    return at(result.params), result
