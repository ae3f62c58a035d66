"""The sheet of time series: the parts that matter, under each other on one time axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from trundle.wording import Unit, unit_for

from .events import FLIGHT, RESTING, SLIPPING
from .facts import Facts, facts_of, turns_in
from .marks import STYLES
from .quantities import Series, quantities_of
from .scales import Array, thin_series
from .sheet import BLUE, GREEN, GREY, INK, SKY, VERMILION, Sheet, look

if TYPE_CHECKING:
    from trundle.simulation.trajectory import Trajectory

MANY_TURNS = 40  # beyond it the first turns are shown beside the whole
FIRST_TURNS = 5
LEFT, RIGHT, FOOT, HEADER, GAP, EACH, WIDTH = 0.95, 0.95, 0.52, 0.8, 0.14, 1.12, 8.4
FEWEST_A_TURN = 5  # samples; with fewer, a line between them would mislead
KEY_LINE = 0.2
# Shades of the phases: slipping is hatched besides, so that it is told apart without colour.
_SHADES: dict[int, tuple[str, dict[str, Any]]] = {
    SLIPPING: ("slipping", {"fc": "#FCEFD6", "ec": "#EFC578", "lw": 0.0, "hatch": "//"}),
    FLIGHT: ("in flight", {"fc": "#DCEFFA", "ec": SKY, "lw": 0.0}),
    RESTING: ("at rest", {"fc": "#EEEEEE", "ec": GREY, "lw": 0.0, "hatch": "...."}),
}
_STYLES: tuple[dict[str, Any], ...] = (
    {"color": BLUE, "lw": 1.7},
    {"color": VERMILION, "lw": 1.5, "ls": (0, (5, 1.6))},
    {"color": GREEN, "lw": 1.6, "ls": (0, (7, 1.5, 1.5, 1.5))},
)


@dataclass(frozen=True)
class Column:
    """One stretch of time, drawn for every panel."""

    left: float  # inches
    width: float
    samples: slice
    title: str
    many: bool  # turns: lines that sway are thin
    marked: dict[str, Any]  # how samples are marked where few make a turn


def draw(run: Trajectory) -> Sheet:
    """Draw the sheet."""
    facts = facts_of(run)
    time = np.asarray(run.data["time"].values, dtype=float)
    velocity = np.asarray(run.in_frame("support").data["velocity"].values, dtype=float)
    panels = quantities_of(run, facts)
    columns = _columns(time, turns_in(time, velocity[:, :2]) if not facts.flies else 0.0)
    key = _key(facts)
    rows = math.ceil(len(key) / 2)
    header = HEADER + 0.2 * (len(columns) - 1) + (KEY_LINE * rows + 0.1 if rows else 0.0)
    height = header + len(panels) * EACH + (len(panels) - 1) * GAP + FOOT
    with look():
        sheet = Sheet(WIDTH, height)
        sheet.head(facts.title, facts.numbers)
        if rows:
            place = (LEFT / WIDTH, 1.0 - (HEADER - 0.06) / height)
            style = {"ncols": 2, "borderpad": 0.0, "borderaxespad": 0.0, "columnspacing": 1.8}
            sheet.legend(handles=key, loc="upper left", bbox_to_anchor=place, **style)
        for column in columns:
            top: Axes | None = None
            for i, panel in enumerate(panels):
                bottom = FOOT + (len(panels) - 1 - i) * (EACH + GAP)
                ax = sheet.add_box(column.left, bottom, column.width, EACH, sharex=top)
                _phases(ax, facts, time[column.samples])
                _lines(ax, panel, time, column)
                if i == 0:
                    _events(ax, facts, time[column.samples])
                _value_axis(ax, panel, column)
                if column is columns[0]:
                    ax.set_ylabel(panel.label, fontsize=9)
                    ax.yaxis.set_label_coords(-0.5 / column.width, 0.5)
                if column is columns[-1]:
                    _names(ax, panel)
                if top is None:
                    top = ax
                    ax.set_title(column.title, loc="left", fontsize=9.5, fontweight="normal", pad=4)
                ax.xaxis.set_visible(i == len(panels) - 1)
            _time_axis(ax, time[column.samples], sheet.axes[-len(panels) : -1])
    return sheet


def _key(facts: Facts) -> list[Any]:
    """Return the entries of the legend: the shades of the phases, the marks of the events."""
    present = {stretch.phase for stretch in facts.stretches}
    shades = [Patch(label=_SHADES[phase][0], **_SHADES[phase][1]) for phase in _SHADES if phase in present]
    marks = [Line2D([], [], label=found.text, **STYLES[found.kind]) for found in facts.happenings]
    return [*shades, *marks] if len(present) > 1 or marks else []


def _phases(ax: Axes, facts: Facts, time: Array) -> None:
    """Shade what is not rolling, and rule a line at every event that has room."""
    clock, start, end = _clock(time).scale, float(time[0]), float(time[-1])
    for stretch in facts.stretches if len({stretch.phase for stretch in facts.stretches}) > 1 else ():
        if stretch.phase in _SHADES and stretch.end > start and stretch.start < end:
            low, high = max(stretch.start, start) / clock, min(stretch.end, end) / clock
            ax.axvspan(low, high, zorder=0.2, **_SHADES[stretch.phase][1])
    ruled: list[float] = []
    for when in sorted(float(t) for found in facts.happenings for t in found.times):
        if start <= when <= end and (not ruled or when - ruled[-1] >= 0.006 * (end - start)):
            ruled.append(when)
    ax.vlines(np.array(ruled) / clock, 0.0, 1.0, transform=ax.get_xaxis_transform(), color=GREY, lw=0.6, zorder=1.2)


def _events(ax: Axes, facts: Facts, time: Array) -> None:
    """Mark what happened over the highest panel."""
    clock = _clock(time).scale
    for found in facts.happenings:
        when = found.marked[(found.marked >= time[0]) & (found.marked <= time[-1])]
        style = STYLES[found.kind] | {"ms": 6.5}
        ax.plot(when / clock, np.ones(len(when)), transform=ax.get_xaxis_transform(), clip_on=False, **style)


def _columns(time: Array, turns: float) -> list[Column]:
    """All of the run, or, when its turns run together, the first of them and then all."""
    width = WIDTH - LEFT - RIGHT
    marked: dict[str, Any] = {"marker": ".", "ms": 4} if max(turns, 0.5) * 24 > len(time) else {}
    marked |= {"ls": "none"} if turns * FEWEST_A_TURN > len(time) else {}
    if turns <= MANY_TURNS:
        return [Column(LEFT, width, slice(None), "", many=False, marked=marked)]
    first = slice(0, max(2, math.ceil(FIRST_TURNS / turns * len(time)) + 1))
    title = f"all {turns:.0f} turns"
    return [
        Column(LEFT, 0.5 * width, first, f"first {FIRST_TURNS} turns", many=False, marked=marked),
        Column(LEFT + 0.58 * width, 0.42 * width, slice(None), title, many=True, marked={}),
    ]


def _lines(ax: Axes, panel: Series, time: Array, column: Column) -> None:
    clock = _clock(time[column.samples])
    for style, (name, values) in zip(_STYLES, panel.lines.items(), strict=False):
        t, v = thin_series(time[column.samples], values[column.samples])
        known = v[np.isfinite(v)]
        extent = float(np.ptp(known)) if len(known) else 0.0
        sways = extent > 0.02 * panel.largest and float(np.sum(np.abs(np.diff(known)))) > 20 * extent
        own = {"lw": 0.5, "ls": "-", "zorder": 1.9} if column.many and sways else column.marked
        ax.plot(t / clock.scale, v / panel.unit.scale, **(style | own | {"label": name or panel.name}))
    if panel.offered is not None and _is_near(panel):
        ax.axhline(panel.offered / panel.unit.scale, color=INK, lw=1.2, ls=(0, (1, 1.2)))


def _is_near(panel: Series) -> bool:
    """Whether the friction offered fits on the panel without flattening the friction needed."""
    return panel.offered is not None and panel.offered <= 4.0 * panel.largest


def _value_axis(ax: Axes, panel: Series, column: Column) -> None:
    unit = panel.unit
    shown = [line[column.samples] for line in panel.lines.values()]
    known = np.concatenate([line[np.isfinite(line)] for line in shown])
    low, high = (float(np.min(known)), float(np.max(known))) if len(known) else (0.0, panel.natural)
    if panel.is_nothing:
        low, high = -panel.natural, panel.natural
    if panel.offered is not None and _is_near(panel):
        high = max(high, panel.offered)
    least = 2e-3 * max(abs(low), abs(high))
    if panel.from_zero:
        low, high = 0.0, max(high, 0.0) * (1.3 if panel.offered is not None else 1.12)
    elif high - low < least:
        low, high = low - least, high + least
    pad = 0.0 if panel.from_zero else 0.1 * (high - low)
    foot = -0.03 * high if panel.from_zero else low - pad
    ax.set_ylim(foot / unit.scale, (high + pad) / unit.scale)
    ax.locator_params(axis="y", nbins=4)


def _names(ax: Axes, panel: Series) -> None:
    """Name the lines at their right ends, pushed apart where they meet."""
    bottom, top = ax.get_ylim()
    named = [
        (float(line[np.isfinite(line)][-1]) / panel.unit.scale, name, style["color"])
        for style, (name, line) in zip(_STYLES, panel.lines.items(), strict=False)
        if name and np.any(np.isfinite(line))
    ]
    if panel.offered is not None and _is_near(panel):
        named.append((panel.offered / panel.unit.scale, f"μ = {panel.offered:.3g}", INK))
    elif panel.offered is not None:
        text = f"the support offers μ = {panel.offered:.3g}"
        if not panel.is_nothing:
            text += f", {panel.offered / panel.largest:.2g} times as much"
        ax.text(0.995, 0.97, text, transform=ax.transAxes, ha="right", va="top", fontsize=8.5, color=GREY)
    heights = _apart(
        [(value - bottom) / (top - bottom) for value, _, _ in named],
        0.27 if any("\n" in name for _, name, _ in named) else 0.17,
    )
    for at, (_, name, colour) in zip(heights, named, strict=True):
        ax.annotate(
            name,
            (1.0, at),
            (5, 0),
            xycoords="axes fraction",
            textcoords="offset points",
            va="center",
            color=colour,
            fontsize=9,
        )


def _apart(places: list[float], least: float) -> list[float]:
    """Move places in [0, 1] apart by at least `least`, keeping their order."""
    order = sorted(range(len(places)), key=lambda i: places[i])
    moved = [min(max(place, 0.0), 1.0) for place in places]
    for _ in range(50):
        for lower, upper in pairwise(order):
            lack = least - (moved[upper] - moved[lower])
            if lack > 0.0:
                moved[lower] -= lack / 2
                moved[upper] += lack / 2
    return moved


def _clock(time: Array) -> Unit:
    return unit_for(max(float(np.max(np.abs(time))), 1e-300), "time")


def _time_axis(foot: Axes, time: Array, others: list[Axes]) -> None:
    """Label the lowest panel's time axis, and rule the others at its ticks: cheaper than their own."""
    clock = _clock(time)
    start, end = float(time[0]) / clock.scale, float(time[-1]) / clock.scale
    foot.set_xlabel(f"time ({clock.symbol})", labelpad=2)
    foot.set_xlim(start, end) if end > start else foot.set_xlim(start - 0.5, end + 0.5)
    foot.locator_params(axis="x", nbins=8)
    ticks = [tick for tick in foot.get_xticks() if start <= tick <= end]
    for ax in others:
        rules = {"color": rcParams["grid.color"], "lw": rcParams["grid.linewidth"], "zorder": 0.5}
        ax.vlines(ticks, 0.0, 1.0, transform=ax.get_xaxis_transform(), **rules)
