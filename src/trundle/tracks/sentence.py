"""How a track was read, in clauses: what a reader in another language has said to it, one after the other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from . import names
from .track import Array

_EVEN = 0.1  # of a step, that times may be off a grid of frames


def clauses(data: Any, units: Mapping[str, str], unit_of_time: str, noun: str) -> list[str]:
    """Say what was taken for what, how many rows there are, and how they follow each other."""
    heading = data["time"].attrs["heading"]
    said = [f"t from column `{heading}`" + ("" if unit_of_time == "s" else f" in {unit_of_time}")]
    by_unit: dict[str, list[str]] = {}
    for name, unit in units.items():
        by_unit.setdefault("" if unit == "1" else unit, []).append(_as_named(name, data[name].attrs["heading"]))
    for unit, some in by_unit.items():
        said += [*some[:-1], some[-1] + (f" in {unit}" if unit else "")]
    time = data["time"].values
    said.append(f"{time.size} rows" if time.size != 1 else "1 row")
    places = [data[name].values for name in "xy" if name in data] or [array.values for array in data.values()]
    return said + _rhythm(time, np.all([np.isfinite(array) for array in places], axis=0), noun)


def _as_named(name: str, heading: str) -> str:
    """Return a name, and the heading where that is another."""
    return name if names.apart(heading)[0] == name else f"{name} from `{heading}`"


def _rhythm(time: Array, measured: Any, noun: str) -> list[str]:
    """Say how many gaps there are, of how many frames, and how many frames a second."""
    times = time[measured]
    if times.size < 3:
        return []
    steps = np.diff(times)
    scales = [float(np.median(np.diff(time))), float(steps.min())]  # most frames are there, or two in a row at least
    even = [scale for scale in scales if np.all(np.abs(steps / scale - np.round(steps / scale)) < _EVEN)]
    steps = steps / [*even, *scales][0]
    edges = [int(np.argmax(measured)), int(np.argmax(measured[::-1]))]  # empty rows before the first, behind the last
    count = int((steps > 1.5).sum()) + sum(edge > 0 for edge in edges)
    if not even:
        return [_counted(count, "gap"), "uneven times"]
    lost = int(np.round(steps - 1).sum())
    rate = (times.size - 1 + lost) / (times[-1] - times[0])
    gaps = _counted(count, "gap") + (f" ({_counted(lost + sum(edges), noun)})" if count else "")
    return [gaps, f"{rate:.6g} {noun}s a second"]


def _counted(count: int, noun: str) -> str:
    return f"{count or 'no'} {noun}{'s' * (count != 1)}"
