"""Marks on a map of the path: rim, axis, arrows, dots in time, the ball to scale."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle
from matplotlib.patches import Circle, Ellipse
from matplotlib.path import Path

from trundle.wording import Unit

from .scales import Array
from .sheet import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, TABLE, VERMILION, Sheet

_LEGEND_SIZES = (9.0, 8.5, 8.0, 7.5, 7.0)  # pt
_ARROWHEAD = Path([(-0.8, -0.9), (0.0, 1.1), (0.8, -0.9), (0.0, -0.5), (-0.8, -0.9)], closed=True)


@dataclass(frozen=True)
class Page:
    """How the plane lies on the page: which axis runs across, which up, and whether it is mirrored twice.

    Seen from above, always: the third axis points at the reader.
    """

    across: int = 0
    across_sign: int = 1
    up_sign: int = 1

    @classmethod
    def downhill_down(cls, tilt: float) -> Page:
        """Turn the page so that the slope falls towards the reader."""
        if tilt == 0.0:
            return cls()
        sign = 1 if tilt > 0.0 else -1
        return cls(across=1, across_sign=sign, up_sign=-sign)

    @property
    def up(self) -> int:
        """The axis that runs up the page."""
        return 1 - self.across

    def order(self, points: Array) -> Array:
        """Return (n, 2) points as (across, up) values, in the axes' own sense."""
        return points[:, [self.across, self.up]]

    def direction(self, x: float, y: float) -> tuple[float, float]:
        """Return a direction of the plane as it looks on the page."""
        vector = (x, y)
        return self.across_sign * vector[self.across], self.up_sign * vector[self.up]


@dataclass(frozen=True)
class Ruler:
    """From metres to the numbers on a panel's axes."""

    unit: Unit
    zero: tuple[float, float]  # (across, up) of the place that the axes count from, m

    def __call__(self, places: Array) -> Array:
        """Return the axis numbers of places in m, (across, up) in the last dimension."""
        return (np.asarray(places, dtype=float) - np.asarray(self.zero)) / self.unit.scale


def arrowhead(ax: Axes, at: Array, direction: tuple[float, float], colour: str, size: float = 9.0) -> None:
    """Put an arrowhead at a place (axis numbers), pointing along a direction on the page."""
    turn = math.degrees(math.atan2(direction[1], direction[0])) - 90.0
    marker = MarkerStyle(_ARROWHEAD).rotated(deg=turn)
    ax.plot(*at, marker=marker, ms=size, mfc=colour, mec="white", mew=0.6, ls="none", zorder=6)


def rim(ax: Axes, page: Page, ruler: Ruler, radius: float, tilt: float) -> None:
    """Draw the table: its rim, foreshortened downhill by its tilt, and its top as a faint ground."""
    sizes = [2 * radius / ruler.unit.scale * math.cos(tilt), 2 * radius / ruler.unit.scale]
    centre = ruler(np.zeros(2))
    ax.add_patch(Ellipse(tuple(centre), sizes[page.across], sizes[page.up], fc=TABLE, ec=GREY, lw=1.1, zorder=0.5))


def ball(ax: Axes, ruler: Ruler, at: Array, radius: float) -> None:
    """Draw the ball to scale."""
    edge = {"ec": GREY, "lw": 1.1, "ls": (0, (1, 1.2))}
    ax.add_patch(Circle(tuple(ruler(at)), radius / ruler.unit.scale, fc="none", zorder=2.5, **edge))


def turning(ax: Axes, page: Page, ruler: Ruler, radius: float, middle: float, sense: float) -> None:
    """Draw which way the table turns, as an arc about the axis around an angle on the page, rad."""
    angle = middle + math.copysign(1.0, sense) * np.linspace(-0.3, 0.3, 40)
    signs = np.array([page.across_sign, page.up_sign])
    arc = ruler(radius * np.column_stack([np.cos(angle), np.sin(angle)]) * signs)
    ax.plot(*arc.T, color=GREY, lw=1.6, zorder=3, solid_capstyle="butt")
    onward = angle[-1] + math.copysign(math.pi / 2, sense)
    arrowhead(ax, arc[-1], (math.cos(onward), math.sin(onward)), GREY, 11)


def signpost(
    ax: Axes,
    at: tuple[float, float],
    size: tuple[float, float],
    top: bool,
    name: str,
    direction: tuple[float, float],
) -> None:
    """Draw a named arrow in a corner, its name at the edge; `at` and `size` (the panel's) in inches."""
    x, y = _beside_name(ax, at, size, top, name, 0.32)
    half = 0.15
    tail = ((x - half * direction[0]) / size[0], (y - half * direction[1]) / size[1])
    head = ((x + half * direction[0]) / size[0], (y + half * direction[1]) / size[1])
    style = {
        "arrowstyle": "-|>,head_length=0.5,head_width=0.28",
        "color": INK,
        "lw": 1.4,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    ax.annotate("", head, tail, "axes fraction", "axes fraction", arrowprops=style, zorder=7)


def turn_sign(ax: Axes, at: tuple[float, float], size: tuple[float, float], top: bool, sense: float, name: str) -> None:
    """Draw a small arc arrow with the name of what turns, where the axis itself is not the place for it."""
    x0, y0 = _beside_name(ax, at, size, top, name, 0.32)
    angle = math.copysign(1.0, sense) * np.linspace(-2.2, 2.2, 40) + math.pi / 2
    x, y = (x0 + 0.13 * np.cos(angle)) / size[0], (y0 + 0.13 * np.sin(angle)) / size[1]
    ax.plot(x, y, transform=ax.transAxes, color=GREY, lw=1.6, zorder=7, solid_capstyle="butt")
    turn = math.degrees(angle[-1]) + math.copysign(90.0, sense) - 90.0
    marker = MarkerStyle(_ARROWHEAD).rotated(deg=turn)
    ax.plot(x[-1], y[-1], transform=ax.transAxes, marker=marker, ms=9, color=GREY, mec="white", mew=0.5, zorder=7)


def _beside_name(
    ax: Axes, at: tuple[float, float], size: tuple[float, float], top: bool, name: str, away: float
) -> tuple[float, float]:
    """Write a sign's name at the panel's edge, and return the middle of the sign itself, inches."""
    edge: dict[str, Any] = {"ha": "center", "va": "top" if top else "bottom", "fontsize": 8.5, "zorder": 7}
    ax.text(at[0] / size[0], at[1] / size[1], name, transform=ax.transAxes, **edge)
    return at[0], at[1] - away if top else at[1] + away


_EVENT: dict[str, Any] = {"mec": INK, "mew": 0.8, "ms": 8.0, "ls": "none", "zorder": 8.4}
STYLES: dict[str, dict[str, Any]] = {
    "path": {"color": BLUE, "lw": 1.8, "zorder": 4},
    "first turn": {"color": BLUE, "lw": 2.4, "zorder": 4.1},
    "guide": {"color": VERMILION, "lw": 1.5, "ls": (0, (5, 2)), "zorder": 3.5},
    "centre": {"color": VERMILION, "marker": "D", "ms": 6, "ls": "none", "zorder": 3.5},
    "dots": {"color": BLUE, "marker": "o", "mfc": "white", "ms": 3.8, "mew": 1.0, "ls": "none", "zorder": 5},
    "samples": {"color": BLUE, "marker": ".", "ms": 5, "ls": "none", "zorder": 5},
    "start": {"color": INK, "marker": "o", "mfc": "white", "ms": 7.5, "mew": 1.5, "ls": "none", "zorder": 8},
    "end": {"color": INK, "marker": "s", "ms": 5.5, "mec": "white", "mew": 0.6, "ls": "none", "zorder": 8},
    "event": {
        "color": VERMILION,
        "marker": "X",
        "mec": INK,
        "mew": 0.8,
        "ms": 9.5,
        "ls": "none",
        "zorder": 8.5,
    },
    "slipping": {"color": ORANGE, "lw": 6.0, "alpha": 0.45, "zorder": 3.8, "solid_capstyle": "butt"},
    "flight": {"color": BLUE, "lw": 1.4, "ls": (0, (1, 1.6)), "zorder": 4},
    "contact": {"color": GREEN, "lw": 0.8, "zorder": 3.6},
    "slip": {"color": ORANGE, "marker": "d"} | _EVENT,
    "grip": {"color": GREEN, "marker": "p"} | _EVENT,
    "lift": {"color": SKY, "marker": "^"} | _EVENT,
    "land": {"color": SKY, "marker": "v"} | _EVENT,
    "bounce": {"color": "white", "marker": "v"} | _EVENT,
    "settle": {"color": SKY, "marker": "P"} | _EVENT,
    "jolt": {"color": VERMILION, "marker": "*"} | _EVENT,
    "stop": {"color": PURPLE, "marker": "h"} | _EVENT,
    "off": {"color": PURPLE, "marker": ">"} | _EVENT,
    "axis": {"color": GREY, "marker": "+", "ms": 11, "mew": 1.3, "ls": "none", "zorder": 3},
    "rim": {"color": GREY, "lw": 1.1},
    "ground": {"color": GREY, "lw": 1.3},
    "contour": {"color": "#B9B5A6", "lw": 0.9},
    "ball": {"color": GREY, "lw": 1.1, "ls": (0, (1, 1.2))},
}


def handles(texts: dict[str, str]) -> list[Line2D]:
    """Return the legend's entries: kind of mark -> its text, in the order given."""
    return [Line2D([], [], label=text, **STYLES[kind]) for kind, text in texts.items()]


def legend(sheet: Sheet, texts: dict[str, str], corner: tuple[float, float], columns: int) -> None:
    """Write a legend with its upper left corner at a place of the sheet, as large as fits beside it."""
    for size in _LEGEND_SIZES:
        entry = sheet.legend(
            handles=handles(texts),
            loc="upper left",
            bbox_to_anchor=corner,
            ncols=columns,
            borderpad=0.0,
            borderaxespad=0.0,
            handlelength=2.2,
            columnspacing=1.6 if size == _LEGEND_SIZES[0] else 1.0,
            fontsize=size,
        )
        if entry.get_window_extent().x1 <= sheet.bbox.x1 or size == _LEGEND_SIZES[-1]:
            return
        entry.remove()
