"""The figure of a fit: data and fit, residuals over time, correlations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...views.plots.sheet import (
    BLUE,
    FAINT,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    Sheet,
    extent,
    look,
    square,
)
from . import report
from .observations import unit_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .result import Fit

_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY)
_MARKS = ("o", "s", "^", "D", "v", "P")


def draw(fit: Fit) -> Figure:
    """Draw data and fit on the support, residuals over time in units of the noise, and correlations."""
    with look():
        sheet = Sheet(10.0, 7.4)
        sheet.head(fit.title or "Fit", fit.verdict)
        predicted = report.predicted(fit)
        both = all({"x", "y"} <= set(model.seen.columns) for model in fit.problem.models)
        (_path if both else _over_time)(fit, predicted, sheet.add_box(0.75, 3.0, 4.6, 3.45))
        _correlations(fit, sheet.add_box(7.6, 3.75, 2.15, 2.8))
        _residuals(fit, predicted, sheet.add_box(0.75, 0.6, 9.0, 1.75))
    return sheet


def _path(fit: Fit, predicted: list[Any], panel: Any) -> None:
    """Draw measured places and the fitted path, both axes alike."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for i, (model, found) in enumerate(zip(fit.problem.models, predicted, strict=True)):
        x, y = (model.seen.columns.index(axis) for axis in "xy")
        values, colour = model.seen.values, _COLOURS[i % 6]
        label = f"measured, {model.seen.label}"
        panel.plot(values[:, x], values[:, y], _MARKS[i % 6], ms=2.2, color=colour, alpha=0.45, mew=0, label=label)
        panel.plot(found[:, x], found[:, y], color=INK, lw=1.0, label="fit" if i == 0 else None)
        for places in (values[:, [x, y]], found[:, [x, y]]):
            low, high = np.fmin(low, np.nanmin(places, axis=0)), np.fmax(high, np.nanmax(places, axis=0))
    if (side := extent(low, high)) > np.max(high - low):  # it stays where it is
        panel.update_datalim(square(low, high, side))
        panel.autoscale_view()
    panel.set_aspect("equal", adjustable="datalim")
    panel.set(xlabel="x, m", ylabel="y, m")
    _legend(panel, "left")


def _over_time(fit: Fit, predicted: list[Any], panel: Any) -> None:
    """Draw each column over time, where there is no path to draw."""
    for i, (model, found) in enumerate(zip(fit.problem.models, predicted, strict=True)):
        for c, name in enumerate(model.seen.columns):
            style = {"color": _COLOURS[(i + c) % 6], "marker": _MARKS[c % 6], "ms": 2.2, "lw": 0, "alpha": 0.45}
            panel.plot(model.seen.time, model.seen.values[:, c], label=f"{name}, {unit_of(name)}", mew=0, **style)
            panel.plot(model.seen.time, found[:, c], color=INK, lw=1.0)
    panel.set(xlabel="t, s", ylabel="measured, and fit (black)")
    _legend(panel, "left")


def _residuals(fit: Fit, predicted: list[Any], panel: Any) -> None:
    """Draw residuals over time in standard deviations, with a band of two."""
    panel.axhspan(-2, 2, color=FAINT, alpha=0.5, lw=0)
    panel.axhline(0, color=GREY, lw=0.8)
    for i, (model, noise, found) in enumerate(zip(fit.problem.models, fit.problem.noises, predicted, strict=True)):
        for c, name in enumerate(model.seen.columns):
            off = (model.seen.values[:, c] - found[:, c]) / noise.sigma[:, c]
            several = f" of {model.seen.label}" if len(predicted) > 1 else ""
            panel.plot(
                model.seen.time, off, _MARKS[c % 6], ms=2.0, color=_COLOURS[(i + c) % 6], mew=0, label=name + several
            )
    panel.set(xlabel="t, s", ylabel="residual, σ")
    _legend(panel, "right")


def _legend(panel: Any, side: str) -> None:
    """Say above a panel what it shows, where nothing is hidden."""
    at, columns = (float(side == "right"), 1.0), 6 if side == "right" else 3
    panel.legend(loc=f"lower {side}", bbox_to_anchor=at, ncols=columns, fontsize=8, borderaxespad=0.2, frameon=False)


def _correlations(fit: Fit, panel: Any) -> None:
    """Draw the correlations of the numbers that the data fix, with their names."""
    from .result import correlation

    fixed = [i for i, one in enumerate(fit.estimates) if one.sigma is not None][:12]
    names = [fit.estimates[i].name for i in fixed]
    if not fixed:
        panel.set_axis_off()
        return
    of = correlation(fit.covariance)[np.ix_(fixed, fixed)]
    panel.imshow(of, cmap="PuOr", vmin=-1, vmax=1)
    panel.grid(visible=False)
    panel.set_yticks(range(len(names)), [f"{i + 1} {name}" for i, name in enumerate(names)], fontsize=7)
    panel.set_xticks(range(len(names)), [str(i + 1) for i in range(len(names))], fontsize=7)
    panel.set_title("correlation", fontsize=9)
    for i in range(len(names)):
        for j in range(len(names)):
            shade = "white" if abs(of[i, j]) > 0.6 else INK
            panel.text(j, i, f"{of[i, j]:z.1f}", ha="center", va="center", fontsize=6, color=shade)
