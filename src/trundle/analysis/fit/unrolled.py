"""What a gyroscope shows, rolled back by itself: Ω along axes at rest, up to one turn, which is slow and soon fitted.

Along axes of a body that rolls Ω goes round as fast as the body, and a fit of it has false minima. But dQ/dt = Q [g]×
can be solved with the data alone, and Q g is Ω along axes that stay as they were at the first row. Its noise adds up
on the way, so that it only makes a first guess.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...solve.samples import Array
from ..checking.record import orientation_from
from .observations import GYROSCOPE, UNROLLED, Observations
from .problem import Prior, Problem
from .unknowns import MOUNTING, of_run

_FEWEST = 3  # rows


def unrolled(problem: Problem, values: Array) -> Problem | None:
    """Return the problem with what gyroscopes show along axes at rest; none where there is no whole gyroscope.

    What is known beforehand of a mounting is turned with the body that the values describe.
    """
    from scipy.spatial.transform import Rotation

    models, noises = list(problem.models), list(problem.noises)
    known = [i for i, one in enumerate(problem.unknowns) if one.key.startswith(MOUNTING)]
    priors = {i: prior for i, prior in problem.priors.items() if i not in known}
    whole = [i for i, model in enumerate(models) if shows(model.seen)]
    for i in whole:
        places = _places(problem, i)
        if problem.priors.keys() >= set(places):
            body = _body(problem, i, values)
            turned = body * Rotation.from_rotvec([problem.priors[j].value for j in places])
            widest = max(problem.priors[j].sigma for j in places)
            priors |= {j: Prior(float(part), widest) for j, part in zip(places, turned.as_rotvec(), strict=True)}
        models[i] = replace(models[i], seen=_at_rest(models[i].seen))
        noises[i] = replace(noises[i], factor=None)
    return replace(problem, models=models, noises=noises, priors=priors, last=None, recent=None) if whole else None


def shows(seen: Observations) -> bool:
    """Tell whether enough of Ω was measured along axes of a body."""
    whole = set(GYROSCOPE.values()) <= set(seen.columns)
    return whole and bool(np.isfinite(shown(seen)).all(axis=1).sum() >= _FEWEST)


def shown(seen: Observations) -> Array:
    """Return what a gyroscope showed, (n, 3), rad/s."""
    return seen.values[:, [seen.columns.index(name) for name in GYROSCOPE.values()]]


def _at_rest(seen: Observations) -> Observations:
    at = [seen.columns.index(name) for name in GYROSCOPE.values()]
    good = np.flatnonzero(np.isfinite(seen.values[:, at]).all(axis=1))
    g = seen.values[good][:, at]
    q, _ = orientation_from(seen.time[good], g, (1.0, 0.0, 0.0, 0.0), body_axes=True)
    along = np.full((seen.time.size, 3), np.nan)
    along[good] = (Quaternion.of(q).matrix() @ Vector.of(g)).array()
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
            values[places] = (_body(problem, i, values).inv() * Rotation.from_rotvec(values[places])).as_rotvec()
    return values


def _body(problem: Problem, run: int, values: Array) -> Any:
    """Return how the body lies at the first row of its gyroscope."""
    from scipy.spatial.transform import Rotation

    model = problem.models[run]
    first = int(np.flatnonzero(np.isfinite(shown(model.seen)).all(axis=1))[0])
    mine = [float(values[j]) for j in of_run(problem.unknowns, run)]
    return Rotation.from_quat(model.orientation(mine, first), scalar_first=True)


def _places(problem: Problem, run: int) -> list[int]:
    """Return where the mounting of a run's gyroscope stands among the unknowns."""
    known = {problem.unknowns[j].key: j for j in of_run(problem.unknowns, run)}
    return [known[f"{MOUNTING}[{i}]"] for i in range(3)]
