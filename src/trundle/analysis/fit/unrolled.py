"""What a gyroscope shows, rolled back by itself: Ω along axes at rest, up to one turn, which is slow and soon fitted.

Along axes of a body that rolls Ω goes round as fast as the body, and a fit of it has false minima. But dQ/dt = Q [g]×
can be solved with the data alone, and Q g is Ω along axes that stay as they were at the first row. Its noise adds up
on the way, so that it only makes a first guess.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from itertools import accumulate

import numpy as np

from ...solve.samples import Array
from .observations import GYROSCOPE, UNROLLED, Observations
from .problem import Problem
from .unknowns import MOUNTING, of_run

_FEWEST = 3  # rows


def unrolled(problem: Problem) -> Problem | None:
    """Return the problem with what gyroscopes show along axes at rest; none where there is no whole gyroscope."""
    models, noises = list(problem.models), list(problem.noises)
    whole = [i for i, model in enumerate(models) if shows(model.seen)]
    for i in whole:
        models[i] = replace(models[i], seen=_at_rest(models[i].seen))
        noises[i] = replace(noises[i], factor=None)
    return replace(problem, models=models, noises=noises, last=None, recent=None) if whole else None


def shows(seen: Observations) -> bool:
    """Tell whether enough of Ω was measured along axes of a body."""
    whole = set(GYROSCOPE.values()) <= set(seen.columns)
    return whole and bool(np.isfinite(shown(seen)).all(axis=1).sum() >= _FEWEST)


def shown(seen: Observations) -> Array:
    """Return what a gyroscope showed, (n, 3), rad/s."""
    return seen.values[:, [seen.columns.index(name) for name in GYROSCOPE.values()]]


def _at_rest(seen: Observations) -> Observations:
    from scipy.spatial.transform import Rotation

    at = [seen.columns.index(name) for name in GYROSCOPE.values()]
    good = np.flatnonzero(np.isfinite(seen.values[:, at]).all(axis=1))
    g = seen.values[good][:, at]
    steps = Rotation.from_rotvec((g[1:] + g[:-1]) / 2 * np.diff(seen.time[good])[:, None]).as_matrix()
    turns = np.array([*accumulate([np.eye(3), *steps], np.matmul)])
    along = np.full((seen.time.size, 3), np.nan)
    along[good] = np.einsum("nij,nj->ni", turns, g)
    values = seen.values.copy()
    values[:, at] = along
    names = dict(zip(GYROSCOPE.values(), UNROLLED, strict=True))
    return replace(seen, columns=tuple(names.get(name, name) for name in seen.columns), values=values)


def aligned(problem: Problem, values: Array) -> Array:
    """Return the values with each gyroscope turned so that it suits the motion best (Wahba 1965)."""
    from scipy.spatial.transform import Rotation

    values = values.copy()
    for i, model in enumerate(problem.models):
        if UNROLLED[0] not in model.seen.columns:
            continue
        mine, at = of_run(problem.unknowns, i), [model.seen.columns.index(name) for name in UNROLLED]
        places = _places(problem, i)
        values[places] = 0.0
        own = model.predict([float(values[j]) for j in mine], model.seen.time.size, slopes=False)[0][:, at]
        seen = model.seen.values[:, at]
        good = np.isfinite(seen).all(axis=1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that Ω keeps to one axis, about which nothing shows
            values[places] = Rotation.align_vectors(own[good], seen[good])[0].as_rotvec()
    return values


def mounted(problem: Problem, values: Array) -> Array:
    """Return values that were found along axes at rest, with each gyroscope turned as it is in its body."""
    from scipy.spatial.transform import Rotation

    values = values.copy()
    for i, model in enumerate(problem.models):
        if shows(model.seen):
            places = _places(problem, i)
            first = int(np.flatnonzero(np.isfinite(shown(model.seen)).all(axis=1))[0])
            mine = [float(values[j]) for j in of_run(problem.unknowns, i)]
            body = Rotation.from_quat(model.orientation(mine, first), scalar_first=True)
            values[places] = (body.inv() * Rotation.from_rotvec(values[places])).as_rotvec()
    return values


def _places(problem: Problem, run: int) -> list[int]:
    """Return where the mounting of a run's gyroscope stands among the unknowns."""
    known = {problem.unknowns[j].key: j for j in of_run(problem.unknowns, run)}
    return [known[f"{MOUNTING}[{i}]"] for i in range(3)]
