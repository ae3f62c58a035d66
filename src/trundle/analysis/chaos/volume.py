"""How fast a law makes the volume grow that some differences span: the trace of its slopes on what they span.

It owes nothing to how the differences have grown: of these only the directions count, and the slopes are those of the
law itself at single instants. Its integral over the time is the sum of the exponents (Liouville).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import SolverError
from ...mechanics.duals import Dual, slopes_of
from ...mechanics.system import RollingSystem
from ...solve.laws import Law
from ...solve.samples import Array

_COUNT = 8
_LEGENDRE = np.polynomial.legendre
NODES, WEIGHTS = 0.5 * (_LEGENDRE.leggauss(_COUNT)[0] + 1), 0.5 * _LEGENDRE.leggauss(_COUNT)[1]
_COEFFICIENTS = (2 * np.arange(_COUNT)[:, None] + 1) * (WEIGHTS * _LEGENDRE.legvander(2 * NODES - 1, _COUNT - 1).T)
_AT_ONCE = 500  # stretches
_DEEPEST = 12  # halvings of one stretch
# The rule is exact to degree 15. Where Legendre's coefficients fall like a power, that of degree 16 is to the whole as
# the last that are known, of degree 6 and 7, to the power 16/7; it may be so much of the rate at which all changes.
_LEFT_OUT, _FALLS = 1e-9, 16 / 7


@dataclass(frozen=True)
class Stretch:
    """States of a law with their differences at the nodes of a quadrature over some time."""

    law: Law  # that holds there
    begin: float  # s
    end: float  # s
    states: Array  # (n, size · (1 + count)): at the nodes: the state and its differences, as `VariationalLaw` has them
    alive: Any  # (count,): which differences no event has taken away
    scale: Array  # (size,): what is large of each number of the state
    at: Callable[[Array], Array]  # takes instants, s; returns the states there

    @property
    def times(self) -> Array:
        """The nodes, s."""
        return nodes(self.begin, self.end)


def nodes(begin: float, end: float) -> Array:
    """Return the instants at which a stretch is looked at, s."""
    return begin + (end - begin) * NODES


def grown(system: RollingSystem, stretches: list[Stretch]) -> float:
    """Return the logarithm of the volume's growth over some stretches: the integral of the divergence."""
    total, left = 0.0, stretches
    for depth in range(_DEEPEST + 1):
        rough: list[Stretch] = []
        for _, alike in itertools.groupby(left, key=_kind):
            same = list(alike)
            for first in range(0, len(same), _AT_ONCE):
                some = same[first : first + _AT_ONCE]
                found, smooth = _integrals(system, some)
                total += float(found[smooth | (depth == _DEEPEST)].sum())
                rough += [one for one, fine in zip(some, smooth, strict=True) if not fine]
        if not rough or depth == _DEEPEST:
            break
        left = [
            half for _, same in itertools.groupby(rough, key=lambda one: id(one.at)) for half in _halves(list(same))
        ]
    return total


def _halves(stretches: list[Stretch]) -> Iterator[Stretch]:
    """Yield the halves of stretches that are parts of one, which is gone through once for all."""
    edges = [
        pair for one in stretches for pair in itertools.pairwise((one.begin, 0.5 * (one.begin + one.end), one.end))
    ]
    states = stretches[0].at(np.concatenate([nodes(*pair) for pair in edges]))
    if len(states) != _COUNT * len(edges):
        raise SolverError(f"The run cannot be gone through again at t = {edges[0][0]:.9g} s: an event moves about.")
    for (begin, end), part in zip(edges, np.split(states, len(edges)), strict=True):
        yield replace(stretches[0], begin=begin, end=end, states=part)


def slopes_at(system: RollingSystem, law: Law, times: Array, states: Array) -> Array:
    """Return ∂f/∂y of a law at some states (n, size), and last ∂f/∂t: (n, size, size + 1)."""
    size = states.shape[1]
    time, *seeds = (
        Dual(column, tuple(float(i == j) for i in range(size + 1)))
        for j, column in zip([size, *range(size)], [times, *states.T], strict=True)
    )
    found = np.zeros((len(states), size, size + 1))
    for i, rate in enumerate(law.rates(system, time, seeds)):
        for j, slope in enumerate(slopes_of(rate, size + 1)):
            found[:, i, j] = slope
    return found


def _kind(stretch: Stretch) -> tuple[Any, ...]:
    return type(stretch.law), tuple(vars(stretch.law).items()), tuple(stretch.alive.tolist())


def _integrals(system: RollingSystem, stretches: list[Stretch]) -> tuple[Array, Any]:
    """Return the integral over each stretch, and whether the divergence is smooth enough there for its nodes."""
    first = stretches[0]
    states = np.vstack([stretch.states for stretch in stretches])
    times = np.concatenate([stretch.times for stretch in stretches])
    lengths = np.array([stretch.end - stretch.begin for stretch in stretches])
    size, count = first.scale.size, first.alive.size
    if not first.alive.any():
        return 0 * lengths, lengths > 0
    columns = states[:, size:].reshape(-1, count, size).transpose(0, 2, 1)[:, :, first.alive] / first.scale[:, None]
    basis = np.linalg.qr(columns)[0]
    slopes = slopes_at(system, first.law, times, states[:, :size])[:, :, :size] * first.scale / first.scale[:, None]
    rates = np.einsum("nia,nij,nja->n", basis, slopes, basis).reshape(-1, _COUNT)
    last, most = np.abs(rates @ _COEFFICIENTS[-2:].T).max(axis=1), np.abs(rates).max(axis=1) + 1e-300
    return lengths * (rates @ WEIGHTS), most * (last / most) ** _FALLS <= _LEFT_OUT * first.scale[7]
