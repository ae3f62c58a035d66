"""The figure of a check: each residual over time beside its bound, and their path over ours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullFormatter

from trundle.wording import Unit, unit_for, with_unit

from ...views.plots.sheet import BLUE, GREY, INK, VERMILION, Sheet, extent, look, square

if TYPE_CHECKING:
    from .result import Check
    from .series import Series
    from .trajectories import Drawn

WIDTH, LEFT, STRIPS, BETWEEN, EDGE = 11.4, 0.72, 5.1, 0.95, 0.2
FOOT, HEADER, EACH, GAP, LEAST = 0.55, 1.02, 0.66, 0.3, 4.7
_KEY = "residuals as shares; dashed: the most allowed"
_LONGEST = 165  # letters of the line under the title
_DEEPEST = 1e-9  # of the bound: what lies lower is drawn there


def draw(check: Check, drawn: Drawn) -> Sheet:
    """Draw the sheet."""
    count = len(drawn.series)
    height = max(FOOT + HEADER + count * EACH + (count - 1) * GAP, LEAST + FOOT + HEADER)
    each = (height - FOOT - HEADER - (count - 1) * GAP) / count
    with look():
        sheet = Sheet(WIDTH, height)
        sheet.head(check.title, _says(check))
        clock = unit_for(max(abs(float(drawn.motion.time[0])), abs(float(drawn.motion.time[-1]))), "time")
        for i, series in enumerate(drawn.series):
            bottom = FOOT + (count - 1 - i) * (each + GAP)
            ax = sheet.add_box(LEFT, bottom, STRIPS, each)
            _strip(ax, series, clock, check.first_failure)
            ax.set_xlim(*(drawn.motion.time[[0, -1]] / clock.scale))
            ax.tick_params(labelbottom=i == count - 1)
            if i == count - 1:
                ax.set_xlabel(f"time ({clock.symbol})", labelpad=2)
        sheet.text(LEFT / WIDTH, 1 - 0.78 / height, _KEY, fontsize=8.8, color=GREY, va="baseline")
        left = LEFT + STRIPS + BETWEEN
        side = min(WIDTH - left - EDGE, height - FOOT - HEADER - 0.4)
        _paths(sheet.add_box(left, height - HEADER - side, side, side), check, drawn)
    return sheet


def _says(check: Check) -> str:
    if check.passed:
        return "it rolls without slipping and obeys the law, within the bounds"
    if check.answer == "cannot decide":
        return "these data cannot decide: they are too short, too few or too noisy to tell"
    told, lead = (check.likely, "likely: ") if check.likely else (check.nearest, "nearest: ")
    if not told:
        return check.remark.rpartition("\n")[2].partition(": look")[0].partition(": no change")[0]
    text = " Or: ".join(one.says for one in told)
    return lead + (text if len(text) < _LONGEST else text[: _LONGEST - 1] + "…")


def _strip(ax: Axes, series: Series, clock: Unit, first: float | None) -> None:
    """Draw one residual as a share, on a logarithmic axis, with its bound; red where it is beyond."""
    t, share, bound = series.time / clock.scale, series.length / series.size, series.bound / series.size
    low = _DEEPEST * float(bound.min())
    share = np.maximum(share, low)
    over = share > bound
    ax.set_yscale("log")
    ax.plot(t, share, color=BLUE, lw=1.2, zorder=3)
    if over.any():
        beyond = np.where(over, share, np.nan)
        ax.plot(t, beyond, color=VERMILION, lw=2.0, marker="." if over.sum() < 3 else None, zorder=4)
        ax.fill_between(t, bound, share, where=over.tolist(), color=VERMILION, alpha=0.16, lw=0, zorder=2)
    ax.plot(t, bound, color=INK, lw=1.1, ls=(0, (4, 2)), zorder=3.5)
    deepest = max(low, float(np.percentile(share, 5)) / 3)
    ax.set_ylim(min(deepest, float(bound.min()) / 30), max(float(share.max()), float(bound.max())) * 6)
    ax.yaxis.set_major_locator(LogLocator(numticks=4))
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.minorticks_off()
    ax.set_title(series.name, loc="left", fontsize=8.8, fontweight="normal", pad=2.5)
    within = "within its bound" if series.tells else "bound too wide to tell"
    verdict, colour = ("beyond its bound", VERMILION) if over.any() else (within, GREY)
    ax.set_title(verdict, loc="right", fontsize=8.8, fontweight="normal", color=colour, pad=2.5)
    if first is not None:
        ax.axvline(first / clock.scale, color=VERMILION, lw=1.0, ls=(0, (1, 1.5)), zorder=1.5)


def _paths(ax: Axes, check: Check, drawn: Drawn) -> None:
    """Draw both paths from above, to one scale, and the place where theirs first goes wrong."""
    theirs, ours = drawn.motion.position[:, :2], drawn.ours.position[:, :2]
    unit = unit_for(extent(theirs.min(axis=0), theirs.max(axis=0)), "length")
    if len(ours):
        ax.plot(*(ours / unit.scale).T, color=GREY, lw=4.0, alpha=0.45, solid_capstyle="round", label="ours")
    ax.plot(*(theirs / unit.scale).T, color=BLUE, lw=1.4, label="theirs")
    start: dict[str, Any] = {"marker": "o", "mfc": "white", "mec": INK, "mew": 1.5, "ms": 7, "ls": "none"}
    ax.plot(*(theirs[0] / unit.scale), **start, label="start", zorder=5)
    if check.first_failure is not None:
        index = int(np.argmin(np.abs(drawn.motion.time - check.first_failure)))
        at_once = check.first_failure == drawn.motion.time[0]
        text = "wrong from the start on" if at_once else f"goes wrong, t = {with_unit(check.first_failure, 'time')}"
        mark: dict[str, Any] = {"marker": "X", "color": VERMILION, "mec": INK, "mew": 0.8, "ms": 9.5, "ls": "none"}
        ax.plot(*(theirs[index] / unit.scale), **mark, label=text, zorder=6)
    _window(ax, theirs / unit.scale, ours / unit.scale)
    ax.set_aspect("equal")
    ax.set_xlabel(f"x ({unit.symbol})", labelpad=2)
    ax.set_ylabel(f"y ({unit.symbol})")
    ax.set_title("Path of the centre, support frame", loc="left")
    ax.locator_params(nbins=6)
    ax.legend(loc="upper left", bbox_to_anchor=(0.0, -0.11), ncols=2, borderaxespad=0.0, handlelength=2.0)


def _window(ax: Axes, theirs: Any, ours: Any) -> None:
    """Show both paths; of ours no more than lies within reach of theirs, if theirs is far smaller."""
    low, high = theirs.min(axis=0), theirs.max(axis=0)
    span = extent(low, high)
    if len(ours):
        near = np.all((ours > low - 2 * span) & (ours < high + 2 * span), axis=1)
        low, high = (f([edge, *ours[near]], axis=0) for f, edge in ((np.min, low), (np.max, high)))
    (left, bottom), (right, top) = square(low, high, span)
    ax.set(xlim=(left, right), ylim=(bottom, top))
