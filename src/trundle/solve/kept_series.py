"""The polynomials of the steps of a stretch, as Taylor's method makes them."""

from __future__ import annotations

from array import array
from functools import cached_property
from typing import Any

import numpy as np

from .samples import Array


class KeptSeries:
    """The polynomials of the steps of a stretch, each about where it begins, counted from a reference of its own.

    Parameters
    ----------
    begin : float
        When the stretch begins, s.
    numbers : array
        The integrator's, there.
    """

    def __init__(self, begin: float, numbers: Array) -> None:
        self.state_vector, self.reference, self.reached = numbers, begin, 0.0
        self.references: list[float] = []
        self.begins: list[float] = []
        self.series = array("d")  # of all steps, in one piece: to make one of many would take twice the memory
        self.shape = 0, 0  # of each: variables, terms

    @property
    def steps(self) -> int:
        """How many."""
        return len(self.begins)

    @property
    def when(self) -> Array:
        """When they begin, s."""
        return np.add(self.references, self.begins)

    def take(self, integrator: Any) -> bool:
        """Keep the step just made; go on."""
        if integrator.last_h > 0:
            self.references.append(self.reference)
            self.begins.append(self.reached)
            series = integrator.tc
            self.series.frombytes(series.tobytes())
            self.shape = series.shape
        self.reached = float(integrator.time)
        return True

    def refer_to(self, time: float) -> None:
        """Count from another time on."""
        self.reference, self.reached = time, 0.0

    @cached_property
    def _all(self) -> tuple[Array, Array, Array]:
        """References, beginnings and series of all steps."""
        return np.array(self.references), np.array(self.begins), np.frombuffer(self.series).reshape(-1, *self.shape)

    def at(self, times: Array) -> Array:
        """Return the states at some times."""
        if not self.begins:
            return np.tile(self.state_vector, (times.size, 1))
        references, begins, series = self._all
        which = np.maximum(np.searchsorted(references + begins, times, side="right") - 1, 0)
        since = (times - references[which] - begins[which])[:, None]
        states = series[which, :, -1]
        for term in range(series.shape[2] - 2, -1, -1):
            states = states * since + series[which, :, term]
        return states
