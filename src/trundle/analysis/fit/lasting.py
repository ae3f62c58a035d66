"""Errors that last from row to row, and do not average out: those of a camera, and a memory that the noise shows.

The numbers stay those of least squares; their errors grow by P Γ Pᵀ, with P = (JᵀJ)⁻¹Jᵀ and Γ the covariance of what
lasts (a sandwich, as of Newey and West 1987).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...solve.samples import Array
from .problem import Problem

_PLACES = (("x", "y"), ("mark_x", "mark_y"), ("spot_x", "spot_y"))
_CHANCE = 2.0  # standard deviations below which a correlation is none
_LONGEST = 0.25  # of the rows


def of_places(columns: tuple[str, ...]) -> Any:
    """Return which columns are places in a picture."""
    return np.array([any(name in pair for pair in _PLACES) for name in columns])


def lasting(problem: Problem, values: Array, basis: Array, *, memory: bool) -> Array:
    """Return the covariance that lasting errors add, (r, r), along a basis whose parts are one standard deviation."""
    residual, jacobian = problem.both(values)
    along = jacobian @ basis
    total, at = np.zeros((basis.shape[1],) * 2), 0
    for model, noise in zip(problem.models, problem.noises, strict=True):
        known = model.seen.known
        part = slice(at, at + int(known.sum()))
        at = part.stop
        if model.accuracy:
            fields = _fields(model.seen.columns, model.seen.values) * model.accuracy
            moved = along[part].T @ noise.whiten(fields, known)
            total += moved @ moved.T
        if memory:
            z, rows = np.zeros(known.shape), np.zeros((*known.shape, basis.shape[1]))
            z[known], rows[known] = residual[part], along[part]
            total += _remembered(z, rows)
    return total


def _fields(columns: tuple[str, ...], values: Array) -> Array:
    """Return by what a camera may shift places that it sees, (n, c, fields): smooth fields, a unit at the edge in all.

    Each coordinate by a polynomial of degree 2 in both: a shift, another scale, a slant, a lean of the camera, a lens.
    """
    pairs = [(columns.index(x), columns.index(y)) for x, y in _PLACES if x in columns and y in columns]
    alone = [(i, i) for i, place in enumerate(of_places(columns)) if place and not any(i in pair for pair in pairs)]
    if not (pairs or alone):
        return np.zeros((*values.shape, 1))
    shown = np.concatenate([values[:, pair] for pair in (*pairs, *alone)])
    middle = np.nanmean(shown, axis=0)
    reach = max(float(np.nanmax(np.linalg.norm(np.nan_to_num(shown - middle), axis=1))), 1e-300)
    found = np.zeros((*values.shape, 12))
    for pair in (*pairs, *alone):
        u, v = np.nan_to_num((values[:, pair] - middle) / reach).T
        terms = np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=-1) / np.sqrt(6)
        for i, place in enumerate(dict.fromkeys(pair)):
            found[:, place, 6 * i : 6 * i + 6] = terms
    return found


def _remembered(z: Array, rows: Array) -> Array:
    """Return what correlations of residuals with later ones add; none is taken for real that chance may make."""
    count = len(z)
    sizes = np.maximum((z**2).sum(axis=0), 1e-300)
    longest = 0
    for column, size in zip(z.T, sizes, strict=True):
        lag = 1
        while lag < _LONGEST * count and (column[lag:] * column[:-lag]).sum() > _CHANCE * size / np.sqrt(count):
            lag += 1
        longest = max(longest, lag - 1)
    total = np.zeros((rows.shape[2],) * 2)
    for lag in range(1, longest + 1):
        share = (z[:-lag].T @ z[lag:]) / count * (1 - lag / (longest + 1))
        part = np.einsum("tci,cd,tdj->ij", rows[:-lag], share, rows[lag:])
        total += part + part.T
    sizes, turned = np.linalg.eigh(total)
    return np.asarray((turned * np.maximum(sizes, 0.0)) @ turned.T)
