"""The sheet of time series: the parts that matter, under each other on one time axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rcParams
from matplotlib.axes import Axes

from trundle.mechanics.algebra import Vector
from trundle.mechanics.contact import normal_at

from .facts import NOTHING, Facts, facts_of, guiding_centre, turns_in
from .scales import Array, Unit, thin_series, unit_for
from .sheet import BLUE, GREEN, GREY, INK, VERMILION, Sheet, look

if TYPE_CHECKING:
    from trundle.trajectory import Trajectory

MANY_TURNS = 40  # beyond it the first turns are shown beside the whole
FIRST_TURNS = 5
LEFT, RIGHT, FOOT, HEADER, GAP, EACH, WIDTH = 0.95, 0.95, 0.52, 0.8, 0.14, 1.12, 8.4
FEWEST_A_TURN = 5  # samples; with fewer, a line between them would mislead
_STYLES: tuple[dict[str, Any], ...] = (
    {"color": BLUE, "lw": 1.7},
    {"color": VERMILION, "lw": 1.5, "ls": (0, (5, 1.6))},
    {"color": GREEN, "lw": 1.6, "ls": (0, (7, 1.5, 1.5, 1.5))},
)


@dataclass(frozen=True)
class Series:
    """One panel: its quantity, its lines by name, and the size beside which rounding error is nothing."""

    name: str
    kind: str
    natural: float
    lines: dict[str, Array]
    from_zero: bool = False
    offered: float | None = None  # the friction coefficient that the support has

    @property
    def largest(self) -> float:
        """The largest magnitude of any line."""
        return max(float(np.nanmax(np.abs(line))) for line in self.lines.values())

    @property
    def is_nothing(self) -> bool:
        """Whether all lines are zero but for rounding."""
        return self.largest <= NOTHING * self.natural

    @property
    def unit(self) -> Unit:
        """The unit that its axis is labelled in."""
        return unit_for(self.natural if self.is_nothing else self.largest, self.kind)

    @property
    def label(self) -> str:
        """The name and the unit."""
        return f"{self.name} ({self.unit.symbol})" if self.unit.symbol else self.name


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
    support = run.in_frame("support").data
    panels = _panels(run, facts, time, support)
    columns = _columns(time, turns_in(time, _array(support, "velocity")[:, :2]))
    header = HEADER + 0.2 * (len(columns) - 1)
    height = header + len(panels) * EACH + (len(panels) - 1) * GAP + FOOT
    with look():
        sheet = Sheet(WIDTH, height)
        sheet.head(facts.title, facts.numbers)
        for column in columns:
            top: Axes | None = None
            for i, panel in enumerate(panels):
                bottom = FOOT + (len(panels) - 1 - i) * (EACH + GAP)
                ax = sheet.add_box(column.left, bottom, column.width, EACH, sharex=top)
                _lines(ax, panel, time, column)
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


def _array(data: Any, name: str) -> Array:
    return np.asarray(data[name].values, dtype=float)


def _panels(run: Trajectory, facts: Facts, time: Array, support: Any) -> list[Series]:
    r, V = _array(support, "position"), _array(support, "velocity")
    Omega, R = _array(support, "angular_velocity"), _array(support, "contact_force")
    duration = float(time[-1] - time[0])
    length = max(float(np.max(np.abs(r))), facts.radius, 1e-300)
    frequency = max(abs(facts.rate), 1.0 / duration if duration > 0.0 else 1.0)
    normal = np.broadcast_to(normal_at(run.system, time, Vector.of(_array(support, "contact"))).array(), R.shape)
    N = np.einsum("ni,ni->n", R, normal)
    f = np.linalg.norm(R - N[:, None] * normal, axis=1)
    force = float(np.max(np.abs(R)))
    panels = [
        _position(r, length),
        Series("speed", "speed", length * frequency, {"": np.sqrt(np.sum(V * V, axis=1))}, from_zero=True),
        Series(
            "angular\nvelocity",
            "angular velocity",
            max(frequency, float(np.max(np.abs(Omega)))),
            _turning(Omega, facts),
        ),
        Series("contact\nforce", "force", force or 1.0, {"N, normal": N, "|f|, friction": f}, from_zero=True),
    ]
    if float(np.max(N)) > NOTHING * force:
        pressed = np.where(NOTHING * force < N, N, np.nan)
        panels.append(
            Series(
                "friction\nneeded, |f|/N",
                "number",
                1.0,
                {"": f / pressed},
                from_zero=True,
                offered=facts.friction,
            )
        )
    if facts.tilted:
        height = _array(run.in_frame("world").data, "position")[:, 2]
        lines = {"": height - height[0]}
        guide = guiding_centre(run, time)
        if guide is not None:
            lines = {"ball": lines[""], "guiding\ncentre": (guide[:, 0] - r[0, 0]) * -math.sin(facts.tilt)}
        panels.append(Series("height\nabove start", "length", length, lines))
    return panels


def _turning(Omega: Array, facts: Facts) -> dict[str, Array]:
    if facts.wall is None:
        return {"Ωx": Omega[:, 0], "Ωy": Omega[:, 1], "Ωn, normal": Omega[:, 2]}
    size = NOTHING * max(float(np.max(np.abs(Omega))), 1e-300)
    across = {"Ωx": Omega[:, 0], "Ωy": Omega[:, 1]}
    seen = {name: values for name, values in across.items() if float(np.max(np.abs(values))) > size}
    return {"Ωz, along\nthe axis": Omega[:, 2], **seen}


def _position(r: Array, length: float) -> Series:
    """Count from the start where the path is tiny beside its distance from the axis."""
    x, y = r[:, 0], r[:, 1]
    extent = max(float(np.ptp(x)), float(np.ptp(y)))
    if NOTHING * length < extent < 0.01 * length:
        return Series("position\nfrom start", "length", length, {"x − x₀": x - x[0], "y − y₀": y - y[0]})
    return Series("position", "length", length, {"x": x, "y": y})


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
        extent = float(np.ptp(v))
        sways = extent > 0.02 * panel.largest and float(np.sum(np.abs(np.diff(v)))) > 20 * extent
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
    low, high = min(float(np.nanmin(line)) for line in shown), max(float(np.nanmax(line)) for line in shown)
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
        (float(line[-1]) / panel.unit.scale, name, style["color"])
        for style, (name, line) in zip(_STYLES, panel.lines.items(), strict=False)
        if name
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
