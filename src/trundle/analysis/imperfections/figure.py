"""The picture of a sensitivity table: each path on its table, and on one time axis when the ball leaves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes
from matplotlib.patches import Circle

from ...views.plots.scales import refined, thin_path
from ...views.plots.sheet import BLUE, GREY, INK, TABLE, VERMILION, Sheet, look
from .rows import Row

if TYPE_CHECKING:
    from .report import Sensitivity

WIDTH, ROW, FOOT, HEADER = 9.6, 1.06, 0.86, 0.98
NAMES, PICTURE, GAP, EDGE = 2.55, 0.98, 0.22, 0.3
TICKS = ((10, "10 s"), (30, "30 s"), (60, "1 min"), (180, "3 min"), (600, "10 min"), (1800, "30 min"), (3600, "1 h"))
LONGER = ((3 * 3600, "3 h"), (10 * 3600, "10 h"), (24 * 3600, "1 d"), (72 * 3600, "3 d"), (10 * 86400, "10 d"))
SHORTER = ((0.1, "0.1 s"), (0.3, "0.3 s"), (1, "1 s"), (3, "3 s"))
TINT = "#8FBBD9"  # of BLUE on the table
DRAWN = 60  # rounds of a path that stays: more would only blacken the picture


def draw(table: Sensitivity) -> Sheet:
    """Draw the sheet: a row for each shortcoming, the worst on top, and the scenario as it is at the foot."""
    rows = (*table.rows, table.given)
    height = HEADER + len(rows) * ROW + FOOT
    with look():
        sheet = Sheet(WIDTH, height)
        sheet.head(table.title, table.heading)
        left = NAMES + PICTURE + GAP
        chart = sheet.add_box(left, FOOT, WIDTH - left - EDGE, len(rows) * ROW)
        _chart(chart, table, rows)
        for i, row in enumerate(rows):
            bottom = FOOT + (len(rows) - 1 - i) * ROW
            _name(sheet, row, i + 1 if row in table.rows else None, bottom)
            _path(sheet.add_box(NAMES, bottom + (ROW - PICTURE) / 2, PICTURE, PICTURE), row, table)
        sheet.text(0.2 / WIDTH, 1 - 0.86 / height, "one shortcoming at a time", color=GREY, fontsize=9)
    return sheet


def _name(sheet: Sheet, row: Row, rank: int | None, bottom: float) -> None:
    across, up = sheet.get_size_inches()
    lines = [_broken(row.label, 26), *([f"{row.size_text}{', its own' * row.own}"] if row.size_text else [])]
    text = "\n".join(lines)
    first = f"{rank}" if rank else "–"
    middle = (bottom + ROW / 2) / up
    sheet.text(0.2 / across, middle, first, fontsize=15, fontweight="bold", color=GREY, va="center")
    sheet.text(0.52 / across, middle, text, fontsize=9.5, va="center", linespacing=1.35, parse_math=False)


def _broken(text: str, longest: int) -> str:
    """Break a label into two lines at a space, where it is too long for one."""
    if len(text) <= longest:
        return text
    at = max(i for i, letter in enumerate(text[:longest]) if letter == " ")
    return f"{text[:at]}\n{text[at + 1 :]}"


def _path(ax: Axes, row: Row, table: Sensitivity) -> None:
    """Draw the path on the table, seen from above, as the support frame has it."""
    ax.set_axis_off()
    ax.set_aspect("equal")
    rim = table.rim
    ax.add_patch(Circle((0.0, 0.0), rim, fc=TABLE, ec=GREY, lw=0.9, zorder=0.5))
    data = row.run.in_frame("support").data
    time, r, V = data.time.values, data.position.values[:, :2], data.velocity.values[:, :2]
    if row.leaves is None:
        seen = time - time[0] <= DRAWN * table.round_time
        time, r, V = time[seen], r[seen], V[seen]
    line = thin_path(refined(time, r, V, 3), 1e-3 * rim)
    dense = time[-1] - time[0] > DRAWN * table.round_time  # its lines merge into an area
    width = 0.9 if dense else 0.7 if len(r) < 1500 else 0.35
    ax.plot(*line.T, color=TINT if dense else BLUE, lw=width, zorder=2 if dense else 4)
    ax.plot(0.0, 0.0, marker="+", color=GREY, ms=5, mew=0.9, zorder=3)
    if row.leaves is not None:
        ax.plot(*r[-1], marker="X", color=VERMILION, mec=INK, mew=0.6, ms=7, zorder=8)
    ax.set_xlim(-1.09 * rim, 1.09 * rim)
    ax.set_ylim(-1.09 * rim, 1.09 * rim)


def _chart(ax: Axes, table: Sensitivity, rows: tuple[Row, ...]) -> None:
    """Draw the times on a logarithmic axis, which ends where the waiting ended."""
    times = [row.leaves for row in rows if row.leaves is not None] + [table.round_time]
    first, last = min(times) / 2.2, table.horizon
    ax.set_xscale("log")
    ax.set_xlim(first, last * (last / first) ** 0.16)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    ticks = [(at, name) for at, name in (*SHORTER, *TICKS, *LONGER) if first <= at <= last * 1.001]
    ax.set_xticks([at for at, _ in ticks], [name for _, name in ticks])
    ax.minorticks_off()
    ax.set_yticks([])
    ax.spines["left"].set_visible(False)
    ax.set_xlabel("time until the ball runs off the rim (logarithmic)", labelpad=4)
    for i in range(1, len(rows)):
        own = i == len(rows) - 1
        ax.axhline(i - 0.5, color=GREY if own else "#E8E8E8", lw=1.0 if own else 0.7, zorder=0.6)
    ax.axvline(last, color=GREY, lw=0.9, ls=(0, (4, 3)), zorder=1)
    ax.text(last, -0.47, " not watched\n any longer", fontsize=8, color=GREY, va="top", linespacing=1.25)
    for i, row in enumerate(rows):
        _dot(ax, i, row, first, last)
    handles = [
        ax.plot([], [], marker="X", color=VERMILION, mec=INK, mew=0.7, ms=9, ls="none", label="ran off the rim")[0],
        ax.plot([], [], marker=">", color=BLUE, mec=INK, mew=0.7, ms=8, ls="none", label="still on the table")[0],
        ax.plot([], [], marker="|", color=INK, mew=2.0, ms=13, ls="none", label="by theory not before")[0],
    ]
    ax.legend(
        handles=handles, loc="lower left", bbox_to_anchor=(-0.01, 1.0), ncols=3, borderaxespad=0.1, handletextpad=0.3
    )


def _dot(ax: Axes, i: int, row: Row, first: float, last: float) -> None:
    end = last if row.leaves is None else row.leaves
    ax.plot([first, end], [i, i], color=BLUE, lw=2.2, zorder=3, solid_capstyle="butt")
    if row.theory_leaves is not None and math.isfinite(row.theory_leaves):
        ax.plot(row.theory_leaves, i, marker="|", color=INK, mew=2.0, ms=19, zorder=4)
    marks: dict[str, Any] = (
        {"marker": ">", "color": BLUE, "ms": 9}
        if row.leaves is None
        else {"marker": "X", "color": VERMILION, "ms": 10.5}
    )
    ax.plot(end, i, mec=INK, mew=0.8, zorder=6, **marks)
    late = math.log(end / first) > 0.62 * math.log(last / first)
    says = row.outcome.replace("leaves", "off")
    place: dict[str, Any] = {"ha": "right", "xytext": (-10, 5)} if late else {"ha": "left", "xytext": (11, -1)}
    va = "bottom" if late else "center"
    ax.annotate(says, (end, i), textcoords="offset points", va=va, fontsize=10, fontweight="bold", **place)
    if row.moved != "–":
        ax.annotate(
            f"circle: {row.moved}", (first, i), (4, -12), textcoords="offset points", va="top", fontsize=8, color=GREY
        )
