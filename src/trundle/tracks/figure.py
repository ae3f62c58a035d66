"""The figure of a track: its path, and its columns over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from ..wording import Unit, unit_for
from .names import kind_of

if TYPE_CHECKING:
    from .track import Track

_MOST = 6  # columns that are drawn
_BLUE = "#0072b2"
_DRAWN = 50_000  # points, of more only every so many


def draw(track: Track) -> Figure:
    """Draw the path on the left and the columns over time on the right, gaps left open."""
    names = track.columns[:_MOST]
    path = {"x", "y"} <= set(track.columns)
    figure = Figure(figsize=(11.0 if path else 7.5, max(1.4 * len(names), 4.2)), layout="constrained")
    grid = figure.add_gridspec(len(names), 2 if path else 1)
    figure.suptitle("\n".join(filter(None, (track._headline().title, track.taken))), fontsize=9)
    some = slice(None, None, max(1, -(-len(track) // _DRAWN)))
    if path:
        _path(figure.add_subplot(grid[:, 0]), track, some)
    first = None
    for i, name in enumerate(names):
        axes = figure.add_subplot(grid[i, -1], sharex=first)
        first = first or axes
        unit = _unit(track, name)
        axes.plot(track.time[some], track[name][some] / unit.scale, ".-", color=_BLUE, lw=0.8, ms=2.5)
        axes.set_ylabel(f"{name} ({unit.symbol})" if unit.symbol else name)
        axes.tick_params(labelbottom=i == len(names) - 1)
        if i == len(names) - 1:
            axes.set_xlabel("t (s)")
    return figure


def _path(axes: Any, track: Track, some: slice) -> None:
    unit = max((_unit(track, name) for name in "xy"), key=lambda unit: unit.scale)
    axes.plot(track["x"][some] / unit.scale, track["y"][some] / unit.scale, ".-", color=_BLUE, lw=0.8, ms=2.5)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(f"x ({unit.symbol})")
    axes.set_ylabel(f"y ({unit.symbol})")


def _unit(track: Track, name: str) -> Unit:
    """Return the unit in which a column reads shortest."""
    kind, values = kind_of(name), track[name]
    finite = values[np.isfinite(values)]
    if kind in ("length", "angle") and finite.size and np.abs(finite).max() > 0:
        kinds = {"length": "length", "angle": "angle"}
        return unit_for(float(np.abs(finite).max()), kinds[kind])
    return Unit(1.0, str(track.data[name].attrs["units"]))
