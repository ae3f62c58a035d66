"""The boundary between classes on a fine grid, from runs near it only: coarse first, then halved where classes meet."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Places = NDArray[np.int64]
Mask = NDArray[np.bool_]

_COARSE = 16


def next_places(run: Mask, found: Any, *, everywhere: bool = False, coarse: int = _COARSE) -> tuple[Places, Any]:
    """Return which fields to run next, none where all is known, and the grid as far as it is known.

    What was run may be a part of what was to be run: so a map can be filled in as many goes as you like, and go on.
    In the end a field that was not run lies in a square of fields whose corners, and those of all squares about it, are
    of one class. What is smaller than a square of the first grid, and touches none of its corners, is not seen.

    Parameters
    ----------
    run : array of bool (fields, fields)
        Which fields have been run.
    found : array (fields, fields)
        What was found there. What stands where nothing was run is returned where nothing is known yet.
    everywhere : bool
        Whether the squares are halved everywhere, as for numbers, and not near the boundary alone.
    coarse : int
        Into how many squares the shorter side is divided at first, at least.

    Examples
    --------
    >>> run, found = np.zeros((64, 64), dtype=bool), np.zeros((64, 64))
    >>> places, _ = next_places(run, found)
    >>> run.ravel()[places] = True
    >>> places.size, next_places(run, found)[0].size, next_places(run, found, everywhere=True)[0].size
    (289, 0, 800)
    """
    shape = run.shape
    step = first_step(shape, coarse)
    wanted, whole = _grid(shape, step), found
    while True:
        lower = [_nodes(count, step)[_below(count, step)] for count in shape]
        whole = np.where(run, found, whole[np.ix_(*lower)])
        places = np.flatnonzero(wanted & ~run)
        if places.size or step == 1:
            return places, whole
        wanted = _grid(shape, step // 2)
        if not everywhere:
            wanted &= _near(whole, step)
        step //= 2


def first_step(shape: tuple[int, ...], coarse: int = _COARSE) -> int:
    """Return how many fields apart the first are: at least two, so that a small grid is refined, too.

    Examples
    --------
    >>> first_step((1000, 1000)), first_step((33, 25))
    (32, 2)
    """
    return max(2, 2 ** int(np.log2(max(min(shape) // coarse, 1))))


def _nodes(count: int, step: int) -> Places:
    """Return the places along a side that are corners of squares."""
    return np.unique(np.append(np.arange(0, count, step), count - 1))


def _below(count: int, step: int) -> Places:
    """Return for each place along a side the last corner that does not lie beyond it."""
    return np.searchsorted(_nodes(count, step), np.arange(count), side="right") - 1


def _grid(shape: tuple[int, ...], step: int) -> Mask:
    chosen = np.zeros(shape, dtype=bool)
    chosen[np.ix_(*(_nodes(count, step) for count in shape))] = True
    return chosen


def _near(found: Places, step: int) -> Mask:
    """Return which fields lie in a square whose corners are of several classes, or beside such a square."""
    corners = found[np.ix_(*(_nodes(count, step) for count in found.shape))]
    parts = [corners[i : len(corners) - 1 + i, j : corners.shape[1] - 1 + j] for i in (0, 1) for j in (0, 1)]
    mixed = np.max(parts, axis=0) != np.min(parts, axis=0)
    wide = np.pad(mixed, 1)
    wide = np.max([np.roll(wide, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)], axis=0)[1:-1, 1:-1]
    inside = [np.minimum(_below(count, step), len(_nodes(count, step)) - 2) for count in found.shape]
    near = wide[np.ix_(*inside)]
    edges = [np.isin(np.arange(count), _nodes(count, step)) for count in found.shape]
    before = [np.maximum(part - 1, 0) for part in inside]
    near |= edges[0][:, None] & wide[np.ix_(before[0], inside[1])]
    near |= edges[1][None, :] & wide[np.ix_(inside[0], before[1])]
    return near | (edges[0][:, None] & edges[1][None, :] & wide[np.ix_(before[0], before[1])])
