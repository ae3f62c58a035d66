"""A figure of a very long run takes as many of its samples as its lines need: nobody sees ten million points."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from .scales import Array

if TYPE_CHECKING:
    from trundle.simulation.trajectory import Trajectory

MOST = 500_000
_WINDOWS, _WINDOW = 200, 4096  # places at which the samples are looked at, and how many of them
_LINES = ("position", "velocity", "angular_velocity", "contact_force")
_UNSEEN = 2e-3  # of a line's range, by which a straight piece may miss a sample that is left out
_SOME = 0.01  # share of the samples that may be missed by more: where something strikes, a line jumps
_TURN = 0.25  # rad by which the support may turn from one sample to the next


def fewer(run: Trajectory) -> Trajectory:
    """Return a run with every n-th sample: of no more than half a million, or of as many as the lines need.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("level-turntable-nudged").run(duration=5.0, every=0.01)
    >>> fewer(run) is run
    True
    """
    time = run.data["time"].values
    if time.size <= MOST:
        return run
    step = float(time[-1] - time[0]) / (time.size - 1)
    turning = float(run.system.support.motion.fastest_rate_within(float(time[0]), float(time[-1]))) * step
    stride, enough = 1, -(-time.size // MOST)
    while stride < enough and 2 * stride * turning <= _TURN and _unseen(run, 2 * stride):
        stride *= 2
    kept = np.append(np.arange(0, time.size - 1, min(stride, enough)), time.size - 1)
    return replace(run, data=run.data.isel(time=kept))


def _unseen(run: Trajectory, stride: int) -> bool:
    """Tell whether lines through every n-th sample pass the samples half-way between, as far as one looks."""
    first = np.linspace(0, run.data["time"].size - _WINDOW, _WINDOWS).astype(int)
    index = first[:, None] + np.arange(0, _WINDOW, stride // 2)[: _WINDOW // stride * 2 - 1]
    return all(_straight(np.asarray(run.data[name].values)[index]) for name in _LINES)


def _straight(values: Array) -> bool:
    """Tell whether every second value (windows, values, 3) lies between its neighbours, but for a few."""
    missed = np.abs(values[:, 1:-1:2] - 0.5 * (values[:, :-2:2] + values[:, 2::2]))
    span = np.ptp(values, axis=(0, 1)).max()
    seen = missed.max(axis=2) > _UNSEEN * max(float(span), _UNSEEN * float(np.abs(values).max()))
    return bool(np.mean(seen) <= _SOME)
