"""The figure of a sweep: frequencies over growth against the quantity that decides, with the limits of stability."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ...views.plots.sheet import BLUE, GREY, INK, VERMILION, Sheet, look
from .quantities import MEANINGS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .flow import Array
    from .sweep import Sweep

WIDTH, HEIGHT = 8.0, 6.0  # inches
_LEFT, _RIGHT, _BOTTOM, _GAP, _TOP = 0.85, 0.35, 0.6, 0.42, 1.0
_UNSTABLE = "#FBEADF"


def draw(sweep: Sweep, title: str) -> Sheet:
    """Draw a sweep."""
    factor, unit = (180 / math.pi, "°") if sweep.name == "lean" else (1.0, sweep.unit)
    values = sweep.values * factor
    with look():
        sheet = Sheet(WIDTH, HEIGHT)
        sheet.head(
            title or "Steady motions", f"{sweep.name}: {MEANINGS[sweep.name]}   ·   {_said(sweep, factor, unit)}"
        )
        wide, tall = WIDTH - _LEFT - _RIGHT, (HEIGHT - _BOTTOM - _GAP - _TOP) / 2
        upper = sheet.add_box(_LEFT, _BOTTOM + tall + _GAP, wide, tall)
        lower = sheet.add_box(_LEFT, _BOTTOM, wide, tall, sharex=upper)
        _frequencies(upper, values, sweep.frequencies)
        _growth(lower, values, sweep.growth)
        limits = [limit * factor for limit in sweep.limits]
        for ax in (upper, lower):
            _regions(ax, sweep, values, limits)
            ax.set_xlim(values[0], values[-1])
            ax.set_ylim(bottom=0)
        _name_limits(upper, limits, unit)
        _here(upper, lower, sweep, values, factor)
        upper.set_ylabel("frequency (rad/s)")
        upper.tick_params(labelbottom=False)
        lower.set_ylabel("growth (1/s)")
        lower.set_xlabel(f"{sweep.name} ({unit})")
    return sheet


def _said(sweep: Sweep, factor: float, unit: str) -> str:
    if sweep.limits:
        where = " and ".join(f"{limit * factor:.6g} {unit}" for limit in sweep.limits)
        return f"stability changes at {where}"
    words = sorted({one.verdict for one in sweep.motions})
    return f"{', '.join(words)} throughout"


def _frequencies(ax: Axes, values: Array, frequencies: Array) -> None:
    if not frequencies.size:
        ax.text(0.5, 0.5, "nothing oscillates here", transform=ax.transAxes, ha="center", va="center", color=GREY)
        ax.set_ylim(0, 1)
        return
    for column in frequencies.T:
        ax.plot(values, column, color=BLUE, lw=2.0, zorder=4)
    ax.set_ylim(0, 1.12 * float(np.nanmax(frequencies)))


def _growth(ax: Axes, values: Array, growth: Array) -> None:
    ax.plot(values, growth, color=VERMILION, lw=2.0, zorder=4, clip_on=False)
    top = float(growth.max())
    ax.set_ylim(0, 1.12 * top if top else 1.0)
    if not top:
        ax.text(0.5, 0.5, "no nudge grows here", transform=ax.transAxes, ha="center", va="center", color=GREY)


def _regions(ax: Axes, sweep: Sweep, values: Array, limits: list[float]) -> None:
    """Shade where a nudge grows, between the limits."""
    edges = [float(values[0]), *limits, float(values[-1])]
    for a, b in pairwise(edges):
        inside = (values > a) & (values < b)
        if inside.any() and np.mean(sweep.growth[inside] > 0) > 0.5:
            ax.axvspan(a, b, color=_UNSTABLE, lw=0, zorder=0)
    for limit in limits:
        ax.axvline(limit, color=INK, lw=1.0, ls=(0, (5, 2)), zorder=3)


def _name_limits(ax: Axes, limits: list[float], unit: str) -> None:
    style: dict[str, Any] = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points", "fontsize": 8.5}
    for limit in limits:
        ax.annotate(f"{limit:.4g} {unit}", (limit, 1.0), xytext=(0, 3), ha="center", va="bottom", **style)


def _here(upper: Axes, lower: Axes, sweep: Sweep, values: Array, factor: float) -> None:
    """Mark the motion from which the family was followed, where it lies between the ends."""
    here = sweep.here * factor
    if not values[0] <= here <= values[-1]:
        return
    spot: dict[str, Any] = {"marker": "o", "mfc": "white", "mec": INK, "mew": 1.4, "ms": 6.5, "ls": "none", "zorder": 6}
    near = int(np.abs(values - here).argmin())
    for frequency in sweep.motions[near].frequencies:
        upper.plot(here, _between(values, sweep, here, frequency), **spot)
    lower.plot(here, float(np.interp(here, values, sweep.growth)), clip_on=False, label="the motion asked for", **spot)
    lower.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), borderaxespad=0.0, handletextpad=0.2)


def _between(values: Array, sweep: Sweep, here: float, near: float) -> float:
    """Return the frequency at a value, on the line that passes nearest."""
    lines = [float(np.interp(here, values, column)) for column in sweep.frequencies.T]
    good = [line for line in lines if np.isfinite(line)]
    return min(good, key=lambda line: abs(line - near)) if good else near
