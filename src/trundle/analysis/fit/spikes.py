"""Values far from their neighbours: they say nothing of where a fit is to begin, and draw its first steps away."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...solve.samples import Array
from .observations import Noise, Observations
from .problem import Problem

_WIDTH = 5  # rows, of which the median is taken
_MOST_ARE = 90  # percent of the rows
_FARTHER = 10.0  # times as far as most are
_NOISES = 20.0  # standard deviations, and as far at least
_FEW = 0.05  # of the rows: more are no spikes


def spikes(seen: Observations, sigma: Array) -> Any:
    """Return which values are far from all that their neighbours tell, (n, c): none where they are not few.

    Examples
    --------
    >>> from .observations import observe
    >>> x = np.sin(np.arange(100) / 20)
    >>> x[40] = 5.0
    >>> np.argwhere(spikes(observe({"t": np.arange(100.0), "x": x}), np.full((100, 1), 1e-3))).tolist()
    [[40, 0]]
    """
    found = np.zeros(seen.values.shape, dtype=bool)
    for c, column in enumerate(seen.values.T):
        good = np.flatnonzero(np.isfinite(column))
        if good.size < 2 * _WIDTH:
            continue
        off = _off(seen.time[good], column[good])
        far = off > np.maximum(_FARTHER * np.percentile(off, _MOST_ARE), _NOISES * sigma[good, c])
        found[good[far], c] = far.sum() <= _FEW * good.size
    return found


def _off(t: Array, x: Array) -> Array:
    """Return how far values are from the median of five, or from straight lines through the two before or after.

    The nearest counts: at a bounce a value is far from the median, and goes on from one side.
    """
    around = np.pad(x, _WIDTH // 2, mode="reflect")
    off = np.abs(x - np.median(np.lib.stride_tricks.sliding_window_view(around, _WIDTH), axis=1))
    before = x[1:-1] + (x[1:-1] - x[:-2]) * (t[2:] - t[1:-1]) / (t[1:-1] - t[:-2])
    after = x[1:-1] + (x[1:-1] - x[2:]) * (t[:-2] - t[1:-1]) / (t[1:-1] - t[2:])
    off[2:] = np.minimum(off[2:], np.abs(x[2:] - before))
    off[:-2] = np.minimum(off[:-2], np.abs(x[:-2] - after))
    return off


def without_spikes(problem: Problem) -> Problem | None:
    """Return the problem with no value far from its neighbours; none where there is no such value."""
    models, noises, some = list(problem.models), list(problem.noises), False
    for i, (model, noise) in enumerate(zip(models, noises, strict=True)):
        far = spikes(model.seen, noise.sigma)
        if far.any():
            models[i] = replace(model, seen=replace(model.seen, values=np.where(far, np.nan, model.seen.values)))
            noises[i] = Noise(noise.known, noise.sigma, least=noise.least)
            some = True
    return replace(problem, models=models, noises=noises, last=None, recent=None) if some else None


def told(problem: Problem) -> list[str]:
    """Return which values are far from their neighbours, a sentence for each run that has some."""
    said = []
    for model, noise in zip(problem.models, problem.noises, strict=True):
        places = np.argwhere(spikes(model.seen, noise.sigma))
        if places.size:
            named = ", ".join(f"row {model.seen.rows[row]} ({model.seen.columns[c]})" for row, c in places[:_WIDTH])
            more = f" and {len(places) - _WIDTH} more" if len(places) > _WIDTH else ""
            said.append(f"far from their neighbours: {named}{more}; leave these out, or take soft_l1, which bears them")
    return said
