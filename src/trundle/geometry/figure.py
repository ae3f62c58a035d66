"""The figure of rolled paths: a map with the ball at each stage, and below it the stages in a row."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..plots.marks import arrowhead
from ..plots.scales import Unit, short, unit_for, with_unit
from ..plots.sheet import BLUE, FAINT, GREY, INK, TABLE, Sheet, look
from .ball import ABOVE, ASIDE, View, place
from .evidence import direction
from .pieces import Straight
from .rolled import RolledPath

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

_MOST_ON_MAP, _MOST_IN_ROW = 14, 6
_LINE = 600  # vertices of a path
_SAME = 1e-6  # of the path's size: places nearer than this are one
# Inches: of a column, its margins, the rows and the header.
_COLUMN, _LEFT, _RIGHT, _FOOT, _TITLE, _HEADER = 4.55, 0.75, 0.25, 0.55, 0.42, 0.72
_ROW, _WORDS = 1.55, 0.34


@dataclass(frozen=True)
class _Shown:
    """What is drawn of one path: places (n, 2), m, orientations (n, 4), the stages' numbers or None in between."""

    rolled: RolledPath
    places: Array
    orientations: Array
    names: list[str]
    stage: list[bool]


def draw(paths: tuple[RolledPath, ...]) -> Figure:
    """Draw paths side by side, to the same scale.

    Parameters
    ----------
    paths : tuple of RolledPath
        At least one; three fit a page.

    Returns
    -------
    matplotlib.figure.Figure
        Needs neither a display nor pyplot.

    Examples
    --------
    >>> import trundle as tr
    >>> figure = draw((tr.roll_along(tr.Straight(turn="90 deg"), radius="25 mm"),))
    >>> figure.axes[0].get_xlabel()
    'x (cm)'
    """
    shown = [_shown(path) for path in paths]
    low, high = _extent(shown)
    unit = unit_for(float(np.abs([low, high]).max()), "length")
    size = _drawn_radius(shown, float((high - low).max()))
    pad = 2.0 * size
    low, high = low - pad, high + pad
    width, height, low, high = _fit(low, high)
    across = len(paths) * (_LEFT + width + _RIGHT)
    up = _HEADER + _TITLE + height + _FOOT + _ROW + _WORDS
    with look():
        sheet = Sheet(max(across, 5.6), up)
        sheet.head(*_head(paths, size))
        for i, one in enumerate(shown):
            left = i * (_LEFT + width + _RIGHT) + _LEFT
            ax = sheet.add_box(left, _FOOT + _ROW + _WORDS, width, height)
            _map(ax, one, size, unit, (low, high), alone=len(paths) == 1)
            _row(sheet.add_box(left - 0.55, _WORDS, width + 0.6, _ROW), one, width + 0.6)
            _words(sheet, left - 0.5, one.rolled)
    return sheet


# --- what to show --------------------------------------------------------------------------------------------


def _shown(rolled: RolledPath) -> _Shown:
    """Choose the places to show: the stages, and some in between on bends."""
    ends = rolled.stages.distance
    turned = np.diff(ends) / rolled.radius
    room = max(0, _MOST_ON_MAP - ends.size) // max(1, sum(not isinstance(p, Straight) for p in rolled.pieces))
    between = [ends[0]]
    for i, piece in enumerate(rolled.pieces):
        parts = 1 if isinstance(piece, Straight) else 1 + min(room, max(3, math.ceil(turned[i] / (math.pi / 3))))
        between += [ends[i] + (ends[i + 1] - ends[i]) * k / parts for k in range(1, parts)] + [ends[i + 1]]
    chosen = np.array(between)
    if chosen.size > _MOST_ON_MAP:
        chosen = chosen[np.unique(np.linspace(0, chosen.size - 1, _MOST_ON_MAP).round().astype(int))]
    at = rolled.at(np.minimum(chosen, rolled.length))
    number = {float(distance): i for i, distance in enumerate(ends)}
    stage = [float(distance) in number for distance in chosen]
    names = [str(number.get(float(distance), "")) for distance in chosen]
    names[0] = "start"
    names[-1] = "end" if len(rolled.pieces) == 1 else f"{names[-1]}, end"
    return _Shown(rolled, at.contact, at.orientation, names, stage)


def _extent(shown: list[_Shown]) -> tuple[Array, Array]:
    lines = np.vstack([_line(one.rolled) for one in shown])
    return lines.min(axis=0), lines.max(axis=0)


def _line(rolled: RolledPath) -> Array:
    return rolled.sampled(rolled.length / _LINE).contact


def _drawn_radius(shown: list[_Shown], extent: float) -> float:
    """Return the radius at which the balls are drawn, m: their own, if neighbours leave room and they can be seen."""
    apart = []
    for one in shown:
        gaps = np.linalg.norm(one.places[:, None] - one.places[None], axis=-1)
        gaps = gaps[gaps > _SAME * max(extent, 1e-300)]
        apart.append(float(gaps.min()) if gaps.size else extent)
    room = min(max(0.40 * min(apart), 0.05 * extent), 0.22 * extent)
    own = shown[0].rolled.radius
    return own if 0.6 * room < own <= room else room


def _fit(low: Array, high: Array) -> tuple[float, float, Array, Array]:
    """Return width and height of a map, inches, and limits that fill it with equal scales."""
    span = high - low
    width = _COLUMN
    height = float(np.clip(width * span[1] / span[0], 2.3, 4.6))
    scale = max(span[0] / width, span[1] / height)
    if span[0] / scale < 0.75 * width:
        width = max(3.4, float(span[0] / scale))
    middle, half = (low + high) / 2, 0.5 * scale * np.array([width, height])
    return width, height, middle - half, middle + half


def _head(paths: tuple[RolledPath, ...], size: float) -> tuple[str, str]:
    radius = paths[0].radius
    drawn = "" if size == radius else f" (balls on the map drawn at {short(size / radius, 2)} of their size)"
    facts = [f"ball of radius {with_unit(radius, 'length')}{drawn}"]
    if len(paths) == 1:
        rolled = paths[0]
        title = rolled.title or "A ball rolled along a path"
        return title, f"{facts[0]}, path of {with_unit(rolled.length, 'length')}, without slipping or pivoting"
    ends = [path.stages.contact[-1] for path in paths]
    same = all(np.allclose(end, ends[0], rtol=0, atol=1e-9 * paths[0].length) for end in ends)
    title = "Two ways to the same place" if same and len(paths) == 2 else f"One ball along {len(paths)} paths"
    return title, f"{facts[0]}, without slipping or pivoting"


# --- the map -------------------------------------------------------------------------------------------------


def _map(ax: Axes, one: _Shown, size: float, unit: Unit, limits: tuple[Array, Array], *, alone: bool) -> None:
    rolled, scale = one.rolled, unit.scale
    line = _line(rolled) / scale
    ax.plot(*line.T, color=BLUE, lw=2.4, zorder=2)
    at = rolled.stages
    middles = rolled.at((at.distance[1:] + at.distance[:-1]) / 2)
    for place_, heading in zip(middles.contact / scale, middles.heading, strict=True):
        arrowhead(ax, place_, (math.cos(heading), math.sin(heading)), BLUE, 10)
    where = _apart(one, size)
    for i, spot in enumerate(where):
        if np.hypot(*(spot - one.places[i])) > 0:
            ax.plot(*np.array([one.places[i], spot]).T / scale, color=GREY, lw=1.0, ls=(0, (2, 2)), zorder=1.5)
        place(ax, spot / scale, size / scale, one.orientations[i], ABOVE, zorder=5 + i)
        if one.stage[i]:
            below = spot / scale + np.array([0.0, -1.32 * size / scale])
            text: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 8.5, "color": INK}
            ax.text(
                *below, one.names[i], zorder=30, bbox={"fc": "white", "ec": "none", "alpha": 0.75, "pad": 0.8}, **text
            )
    (left, bottom), (right, top) = limits[0] / scale, limits[1] / scale
    ax.set_xlim(left, right)
    ax.set_ylim(bottom, top)
    ax.set_aspect("equal")
    ax.set_xlabel(f"x ({unit.symbol})", labelpad=2)
    ax.set_ylabel(f"y ({unit.symbol})", labelpad=2)
    ax.set_title("Seen from above" if alone else rolled.title or repr(rolled), loc="left")


def _apart(one: _Shown, size: float) -> Array:
    """Return where the balls are drawn: a later one at the place of an earlier beside it, away from the path."""
    where = one.places.copy()
    middle = _line(one.rolled).mean(axis=0)
    reach = max(float(np.ptp(one.places, axis=0).max()), 1e-300)
    for i in range(1, len(where)):
        for step in range(1, 6):
            gaps = np.linalg.norm(where[:i] - where[i], axis=1)
            if gaps.min() > _SAME * reach:
                break
            out = one.places[i] - middle
            out = out / np.hypot(*out) if np.hypot(*out) > _SAME * reach else np.array([-1.0, 0.0])
            where[i] = one.places[i] + 2.5 * step * size * out
    return where


# --- the row of stages ---------------------------------------------------------------------------------------


def _row(ax: Axes, one: _Shown, width: float) -> None:
    """Draw the stages one after the other, larger, as seen from the side."""
    ax.axis("off")
    every = [i for i, is_stage in enumerate(one.stage) if is_stage]
    if len(every) < 4:
        every = list(range(len(one.stage)))
    if len(every) > _MOST_IN_ROW:
        every = [every[k] for k in np.unique(np.linspace(0, len(every) - 1, _MOST_IN_ROW).round().astype(int))]
    view = ASIDE
    pitch = min(3.6, 2 * width / _ROW * 1.9 / (len(every) + 0.8))
    half = 1.95
    total = 2 * half * width / _ROW
    ax.set_xlim(-total / 2, total / 2)
    ax.set_ylim(-2.05, 2 * half - 2.05)
    ax.set_aspect("equal")
    pitch = min(3.9, total / (len(every) + 0.9))
    radius = min(1.0, 0.36 * pitch)
    lefts = (np.arange(len(every)) - (len(every) - 1) / 2 + 0.45) * pitch
    _tripod(ax, -total / 2 + 0.95, -0.55, view)
    for x, i in zip(lefts, every, strict=True):
        _patch(ax, x, radius, view)
        place(ax, (x, 0.0), radius, one.orientations[i], view)
        name = one.names[i] or "on the way"
        ax.text(x, -1.95, name, ha="center", va="baseline", fontsize=9, color=INK if one.names[i] else GREY)


def _patch(ax: Axes, x: float, radius: float, view: View) -> None:
    """Draw a patch of the plane below a ball, and the ball's shadow where it touches."""
    from matplotlib.patches import Polygon

    corners = 1.25 * radius * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=float)
    below = np.array([0.0, 0.0, -radius])
    ax.add_patch(Polygon(view.flat(corners + below) + [x, 0.0], fc=TABLE, ec=FAINT, lw=1.0, zorder=1))
    angle = np.linspace(0, 2 * math.pi, 60)
    ring = 0.55 * radius * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(60)])
    ax.add_patch(Polygon(view.flat(ring + below) + [x, 0.0], fc="#C9C7BF", ec="none", alpha=0.8, zorder=1.1))


def _tripod(ax: Axes, x: float, y: float, view: View) -> None:
    """Draw the three axes of the support frame."""
    style = {"arrowstyle": "-|>,head_length=0.4,head_width=0.2", "color": GREY, "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
    for name, axis in zip("xyz", np.eye(3), strict=True):
        tip = view.flat(axis)
        ax.annotate("", (x + tip[0], y + tip[1]), (x, y), arrowprops=style, zorder=3)
        ax.text(x + 1.3 * tip[0], y + 1.3 * tip[1], name, ha="center", va="center", fontsize=8.5, color=GREY)


def _words(sheet: Sheet, left: float, rolled: RolledPath) -> None:
    across, up = sheet.get_size_inches()
    home = "Home again, turned by" if rolled.is_closed else "In the end: turned by"
    x, y, z = (short(float(f"{round(part, 6) + 0.0:.3g}"), 3) for part in rolled.rotation.axis)
    angle = short(math.degrees(rolled.rotation.angle), 4)
    words = f"{home} {angle}° about ({x}, {y}, {z}); N points {direction(rolled.north_pole)}"
    sheet.text(left / across, 0.12 / up, words, fontsize=9, color=INK, ha="left", va="baseline")
