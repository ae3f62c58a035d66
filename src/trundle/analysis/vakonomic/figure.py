"""Both paths on one map, and no doubt about which of them a ball takes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from trundle.wording import short, unit_for, with_unit

from ...views.plots.marks import Page, Ruler, rim, signpost, turning
from ...views.plots.sheet import BLUE, GREY, INK, VERMILION, Sheet, look

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .comparison import Array, VakonomicComparison

_MAP, _LEFT, _FOOT, _HEADER, _KEY = 6.0, 0.8, 0.55, 0.82, 0.95  # inches
TRUE: dict[str, Any] = {"color": BLUE, "lw": 3.2}
WRONG: dict[str, Any] = {"color": VERMILION, "lw": 2.0, "ls": (0, (5, 2))}
OTHERS: dict[str, Any] = {"color": VERMILION, "lw": 0.8, "alpha": 0.55, "ls": (0, (5, 2))}
_CLEAR: dict[str, Any] = {"fc": "white", "ec": "none", "pad": 0.8, "alpha": 0.7}
START: dict[str, Any] = {"color": INK, "marker": "o", "mfc": "white", "ms": 7.5, "mew": 1.5, "ls": "none"}


def draw(found: VakonomicComparison) -> Sheet:
    """Draw the sheet.

    Examples
    --------
    >>> import trundle as tr
    >>> sheet = draw(tr.compare_vakonomic(tr.Scenario.load("level-turntable-nudged")))
    >>> [text.get_text().partition(":")[0] for text in sheet.legends[0].get_texts()]
    ['TRUE', 'WRONG', 'WRONG', 'start of all of them']
    """
    page = Page.downhill_down(float(found.system.support.tilt))
    ball, wrong = page.order(found.position), page.order(found.vakonomic.position)
    others = [page.order(path.position) for path in found.family]
    with look():
        sheet = Sheet(_LEFT + _MAP + 0.3, _HEADER + _MAP + _FOOT + _KEY)
        sheet.head(found.title or "A ball, and the vakonomic path", _numbers(found))
        ax = sheet.add_box(_LEFT, _KEY + _FOOT, _MAP, _MAP)
        ruler = _frame(ax, found, page, ball, wrong)
        _table(ax, found, page, ruler)
        for path in others:
            ax.plot(*ruler(path).T, zorder=3, **OTHERS)
        ax.plot(*ruler(ball).T, zorder=4, **TRUE)
        ax.plot(*ruler(wrong).T, zorder=5, **WRONG)
        ax.plot(*ruler(ball[0]), zorder=8, **START)
        if found.stays:
            ax.plot(*ruler(ball[0]), marker="o", color=BLUE, ms=16, ls="none", zorder=7)
        if not found.agree:
            _cross(ax, ruler, wrong)
        sheet.legend(
            handles=_handles(found),
            loc="lower left",
            bbox_to_anchor=(0.02, 0.008),
            handlelength=3.0,
            fontsize=9.5,
            labelspacing=0.35,
        )
    return sheet


def _frame(ax: Axes, found: VakonomicComparison, page: Page, ball: Array, wrong: Array) -> Ruler:
    """Show the whole of the ball's path and of the wrong one, square; without a rim the origin need not be there."""
    edge = found.system.support.surface.rim
    shown = np.vstack([ball, wrong])
    low, high = shown.min(axis=0), shown.max(axis=0)
    if edge is not None:
        low, high = np.full(2, -1.13 * float(edge)), np.full(2, 1.13 * float(edge))
    half = 0.54 * float(np.max(high - low)) or float(found.system.body.radius)
    middle = (low + high) / 2
    unit = unit_for(float(np.abs([middle - half, middle + half]).max()), "length")
    ruler = Ruler(unit, (0.0, 0.0))
    names = ("x, down the slope", "y, level") if found.system.support.tilt else ("x", "y")
    first, last = ruler(middle - half), ruler(middle + half)
    ax.set_aspect("equal")
    ax.set_xlim(*(first[0], last[0])[:: page.across_sign])
    ax.set_ylim(*(first[1], last[1])[:: page.up_sign])
    ax.set_xlabel(f"{names[page.across]} ({unit.symbol})", labelpad=2)
    ax.set_ylabel(f"{names[page.up]} ({unit.symbol})")
    return ruler


def _table(ax: Axes, found: VakonomicComparison, page: Page, ruler: Ruler) -> None:
    """Draw rim and axis, and say which way the plane turns and leans."""
    support = found.system.support
    rate, edge = float(support.motion.steady_rate or 0.0), support.surface.rim
    left, right = sorted(ax.get_xlim())
    bottom, top = sorted(ax.get_ylim())
    inside = left < 0 < right and bottom < 0 < top
    if edge is not None:
        rim(ax, page, ruler, float(edge), 0.0)
        if rate:
            turning(ax, page, ruler, 1.05 * float(edge), math.radians(45.0), rate)
    if rate and inside:
        ax.plot(0.0, 0.0, color=GREY, marker="+", ms=11, mew=1.3, ls="none", zorder=3)
        ax.annotate("axis", (0, 0), (7, -11), textcoords="offset points", color=GREY, fontsize=8.5, bbox=_CLEAR)
    if support.tilt:
        signpost(ax, (_MAP - 0.45, _MAP - 0.08), (_MAP, _MAP), True, "downhill", (0.0, -1.0))


def _cross(ax: Axes, ruler: Ruler, wrong: Array) -> None:
    """Strike out the wrong path where it is seen last."""
    ax.plot(*ruler(wrong[-1]), marker="X", color=VERMILION, mec=INK, mew=0.8, ms=11, ls="none", zorder=9)


def _handles(found: VakonomicComparison) -> list[Line2D]:
    if found.agree:
        entry = ("From this start the same: stationary action (vakonomic), λ₀ = 0 kg m/s", WRONG)
    else:
        entry = _wrong(found)
    true = TRUE | ({"marker": "o", "ms": 10, "ls": "none"} if found.stays else {})
    texts = [(f"TRUE: how a ball rolls (d'Alembert); it {found.way}", true), entry]
    if found.family:
        size = float(np.hypot(*found.family[0].multipliers[0]))
        texts.append((f"WRONG: the same with |λ₀| = {short(size, 2)} kg m/s in other directions", OTHERS))
    return [Line2D([], [], label=label, **style) for label, style in (*texts, ("start of all of them", START))]


def _wrong(found: VakonomicComparison) -> tuple[str, dict[str, Any]]:
    """Return the entry of the wrong path, struck out as the path is."""
    wrong = WRONG | {"marker": "X", "mec": INK, "mew": 0.6, "ms": 8, "markevery": (1, 2)}
    return f"WRONG: stationary action under the constraint (vakonomic), λ₀ = {_pair(found)} kg m/s", wrong


def _pair(found: VakonomicComparison) -> str:
    x, y = found.vakonomic.multipliers[0]
    return "0" if x == y == 0 else f"({short(float(x), 3)}, {short(float(y), 3)})"


def _numbers(found: VakonomicComparison) -> str:
    support = found.system.support
    rate = float(support.motion.steady_rate or 0.0)
    parts = [f"table {short(rate, 4)} rad/s" if rate else "plane at rest"]
    parts += [f"tilt {short(math.degrees(float(support.tilt)), 4)}°"] if support.tilt else []
    parts.append(f"the ball for {with_unit(float(found.time[-1] - found.time[0]), 'time')}")
    if found.leaves is not None:
        parts.append(f"vakonomic for {with_unit(found.leaves - float(found.time[0]), 'time')}, then off")
    return "  ·  ".join(parts)
