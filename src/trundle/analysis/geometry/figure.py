"""The figure of rolled paths: a map with the ball at each stage, and below it the stages in a row."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trundle.wording import short, unit_for, with_unit

from ...views.plots.marks import arrowhead
from ...views.plots.sheet import BLUE, FAINT, GREY, INK, TABLE, Sheet, look
from .ball import ABOVE, ASIDE, View, place
from .evidence import direction
from .pieces import Straight
from .rolled import RolledPath
from .stages import Stages

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

_MOST_ON_MAP, _MOST_IN_ROW = 14, 6  # balls
_VERTICES = 600  # of a path's line
_SAME = 1e-6  # of the path's size: places nearer than this are one
# Inches: a map beside others and alone, its margins, the header, the row of stages and the words below it.
_COLUMN, _ALONE, _LEFT, _RIGHT, _FOOT, _TITLE, _HEADER = 4.55, 5.6, 0.75, 0.25, 0.55, 0.36, 0.62
_LOWEST, _TALLEST = 2.2, 4.6
_ROW, _WORDS, _RADIUS = 1.6, 0.52, 0.41


@dataclass(frozen=True)
class _Shown:
    """What is drawn of one path: its line, the ball at some places, and those that are stages by their names."""

    rolled: RolledPath
    line: Array
    at: Stages
    names: list[str]  # empty between stages


def draw(paths: tuple[RolledPath, ...]) -> Figure:
    """Draw paths side by side, to the same scale.

    Examples
    --------
    >>> import trundle as tr
    >>> figure = draw((tr.roll_along(tr.Straight(turn="90 deg"), radius="25 mm"),))
    >>> figure.axes[0].get_xlabel()
    'x (cm)'
    """
    shown = [_shown(path) for path in paths]
    size = _drawn_radius(shown)
    where = [_apart(one, size) for one in shown]
    everything = np.vstack([*(one.line for one in shown), *where])
    low, high = everything.min(axis=0), everything.max(axis=0)
    unit = unit_for(float(np.abs([low, high]).max()), "length")
    width, height, low, high = _fit(low - 2 * size, high + 2 * size, _ALONE if len(paths) == 1 else _COLUMN)
    inch = (high[0] - low[0]) / width  # m on the plane for each on the page
    with look():
        sheet = Sheet(len(paths) * (_LEFT + width + _RIGHT), _HEADER + _TITLE + height + _FOOT + _ROW + _WORDS)
        sheet.head(*_head(paths, size))
        for i, one in enumerate(shown):
            left = i * (_LEFT + width + _RIGHT) + _LEFT
            ax = sheet.add_box(left, _FOOT + _ROW + _WORDS, width, height)
            _map(ax, one, where[i], size, unit.scale, inch)
            ax.set(xlim=(low[0] / unit.scale, high[0] / unit.scale), ylim=(low[1] / unit.scale, high[1] / unit.scale))
            ax.set_xlabel(f"x ({unit.symbol})", labelpad=2)
            ax.set_ylabel(f"y ({unit.symbol})", labelpad=2)
            ax.set_title("Seen from above" if len(paths) == 1 else one.rolled.title or repr(one.rolled), loc="left")
            _row(sheet.add_box(left - 0.6, _WORDS, width + 0.7, _ROW), one, width + 0.7)
            _words(sheet, left - 0.55, one.rolled)
    return sheet


# --- what to show --------------------------------------------------------------------------------------------


def _shown(rolled: RolledPath) -> _Shown:
    """Choose the places to show: the stages, and some in between on bends."""
    ends = rolled.stages.distance
    turned = np.diff(ends) / rolled.radius
    bends = sum(not isinstance(piece, Straight) for piece in rolled.pieces)
    room = max(0, _MOST_ON_MAP - ends.size) // max(1, bends)
    between = [ends[:1]]
    for i, piece in enumerate(rolled.pieces):
        wanted = 1 if isinstance(piece, Straight) else 1 + max(3, math.ceil(turned[i] / (math.pi / 3)))
        parts = min(wanted, 1 + room)
        between.append(np.append(ends[i] + (ends[i + 1] - ends[i]) * np.arange(1, parts) / parts, ends[i + 1]))
    chosen = np.concatenate(between)
    if chosen.size > _MOST_ON_MAP:
        chosen = chosen[_spread(chosen.size, _MOST_ON_MAP)]
    number = {float(distance): str(i) for i, distance in enumerate(ends)}
    names = [number.get(float(distance), "") for distance in chosen]
    names[0] = "start"
    names[-1] = "end" if len(rolled.pieces) == 1 else f"{names[-1]}, end"
    line = rolled.sampled(rolled.length / _VERTICES).contact
    return _Shown(rolled, line, rolled.at(np.minimum(chosen, rolled.length)), names)


def _spread(count: int, most: int) -> NDArray[np.int_]:
    """Return the indices of so many of a list, evenly, the first and the last among them."""
    return np.unique(np.linspace(0, count - 1, min(most, count)).round().astype(int))


def _drawn_radius(shown: list[_Shown]) -> float:
    """Return the radius at which the balls are drawn, m: their own, if neighbours leave room and they can be seen."""
    extent = max(float(np.ptp(one.line, axis=0).max()) for one in shown)
    apart = extent
    for one in shown:
        gaps = np.linalg.norm(one.at.contact[:, None] - one.at.contact[None], axis=-1)
        gaps = gaps[gaps > _SAME * extent]
        apart = min(apart, float(gaps.min())) if gaps.size else apart
    room = min(max(0.36 * apart, 0.045 * extent), 0.22 * extent)
    own = shown[0].rolled.radius
    return own if 0.6 * room < own <= room else room


def _apart(one: _Shown, size: float) -> Array:
    """Return where the balls are drawn: a later one at the place of an earlier beside it, away from the path."""
    where = one.at.contact.copy()
    middle = one.line.mean(axis=0)
    same = _SAME * max(float(np.ptp(one.line, axis=0).max()), 1e-300)
    for i in range(1, len(where)):
        out = one.at.contact[i] - middle
        out = out / np.hypot(*out) if np.hypot(*out) > same else np.array([0.0, -1.0])
        for step in range(1, 6):
            if np.linalg.norm(where[:i] - where[i], axis=1).min() > same:
                break
            where[i] = one.at.contact[i] + 3.0 * step * size * out
    return where


def _fit(low: Array, high: Array, widest: float) -> tuple[float, float, Array, Array]:
    """Return width and height of a map, inches, and limits that fill it with equal scales."""
    span = high - low
    height = float(np.clip(widest * span[1] / span[0], _LOWEST, _TALLEST))
    scale = max(span[0] / widest, span[1] / height)
    width = max(0.85 * widest, float(span[0] / scale))
    middle, half = (low + high) / 2, 0.5 * scale * np.array([width, height])
    return width, height, middle - half, middle + half


def _head(paths: tuple[RolledPath, ...], size: float) -> tuple[str, str]:
    radii = {path.radius for path in paths}
    radius = max(radii)
    ball = f"ball of radius {with_unit(radius, 'length')}" if len(radii) == 1 else "balls of different sizes"
    if len(radii) == 1 and size != radius:
        ratio = short(size / radius, 2)
        ball += (
            f", drawn at {ratio} of its size on the map" if size < radius else f", {ratio} times its size on the map"
        )
    if len(paths) == 1:
        title, length = paths[0].title or "A ball rolled along a path", with_unit(paths[0].length, "length")
        return title, f"{ball}; path of {length}, without slipping or pivoting"
    ends = [path.stages.contact[-1] for path in paths]
    same = all(np.allclose(end, ends[0], rtol=0, atol=1e-9 * paths[0].length) for end in ends)
    title = f"{'Two' if len(paths) == 2 else len(paths)} ways to the same place" if same else "Paths of a rolled ball"
    return title, f"{ball}; rolled without slipping or pivoting"


# --- the map -------------------------------------------------------------------------------------------------


def _map(ax: Axes, one: _Shown, where: Array, size: float, scale: float, inch: float) -> None:
    """Draw a path and its balls: all lengths in m, `scale` m to one of the axes' numbers, `inch` m to an inch."""
    ax.plot(*one.line.T / scale, color=BLUE, lw=2.4, zorder=2)
    distance = one.at.distance
    on_the_way = one.rolled.at((distance[1:] + distance[:-1]) / 2)
    for spot, heading in zip(on_the_way.contact / scale, on_the_way.heading, strict=True):
        arrowhead(ax, spot, (math.cos(heading), math.sin(heading)), BLUE, 10)
    for i in _uncrowded(where, size):
        spot = where[i]
        if np.hypot(*(spot - one.at.contact[i])) > 0:
            ax.plot(*np.array([one.at.contact[i], spot]).T / scale, color=GREY, lw=1.0, ls=(0, (2, 2)), zorder=1.5)
        place(ax, spot / scale, size / scale, size / inch, one.at.orientation[i], ABOVE, zorder=10 + i)
        if one.names[i]:
            side = _free_side(one, where, i, size)
            x, y = (spot + 1.12 * size * side) / scale
            text = ax.text(float(x), float(y), one.names[i], zorder=40)
            text.set(
                ha="left" if side[0] > 0 else "right", va="bottom" if side[1] > 0 else "top", fontsize=9, color=INK
            )
    ax.set_aspect("equal")


def _uncrowded(where: Array, size: float) -> list[int]:
    """Return the balls that can be told apart on the map: the first, the last, and those that cover no other."""
    last = len(where) - 1
    kept = [0]
    for i in range(1, last):
        if np.linalg.norm(where[[*kept, last]] - where[i], axis=1).min() > 1.5 * size:
            kept.append(i)
    return [*kept, last]


def _free_side(one: _Shown, where: Array, i: int, size: float) -> Array:
    """Return the diagonal direction that is farthest from the path, the ball's axis and the balls near by."""
    heading, pole, here = one.at.heading[i], one.at.north_pole[i, :2], one.at.contact[i]
    near = where - where[i]
    ways = [*near[np.linalg.norm(near, axis=1) < 4 * size], *((one.at.contact[i - 1] - here)[None] if i else ())]
    busy = [np.array([math.cos(heading), math.sin(heading)]), pole, -pole]
    busy += [way / np.hypot(*way) for way in ways if np.hypot(*way) > 0]
    sides = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / math.sqrt(2)
    return sides[int(np.argmin(np.round((sides @ np.array(busy).T).max(axis=1), 6)))]


# --- the row of stages ---------------------------------------------------------------------------------------


def _row(ax: Axes, one: _Shown, width: float) -> None:
    """Draw the stages one after the other, as seen from the side; lengths in radii of the largest ball."""
    every = [i for i, name in enumerate(one.names) if name]
    if len(every) < 3:
        every = list(range(len(one.names)))
    every = [every[k] for k in _spread(len(every), _MOST_IN_ROW)]
    across, up = width / _RADIUS, _ROW / _RADIUS
    ax.axis("off")
    ax.set(xlim=(0.0, across), ylim=(-1.9, up - 1.9), aspect="equal")
    _tripod(ax, 1.0, -0.5, ASIDE)
    room, left = across - 2.5, 2.1  # beside the tripod, and at the right
    pitch = min(4.2, room / len(every))
    radius = min(1.0, 0.36 * pitch)
    first = left + 0.5 * (room - pitch * (len(every) - 1))
    unit = unit_for(one.rolled.length, "length")
    for k, i in enumerate(every):
        x = first + k * pitch
        _patch(ax, x, radius, ASIDE)
        place(ax, (x, 0.0), radius, radius * _RADIUS, one.at.orientation[i], ASIDE)
        name = one.names[i] or unit.after(short(one.at.distance[i] / unit.scale, 3))
        text = ax.text(x, -1.85, name)
        text.set(ha="center", va="bottom", fontsize=9, color=INK if one.names[i] else GREY)


def _patch(ax: Axes, x: float, radius: float, view: View) -> None:
    """Draw a patch of the plane below a ball, and the ball's shadow where it touches."""
    from matplotlib.patches import Polygon

    corners = radius * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=float)
    angle = np.linspace(0, 2 * math.pi, 60)
    ring = 0.55 * radius * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(60)])
    below, aside = np.array([0.0, 0.0, -radius]), np.array([x, 0.0])
    ax.add_patch(Polygon(view.flat(corners + below) + aside, fc=TABLE, ec=FAINT, lw=1.0, zorder=1))
    ax.add_patch(Polygon(view.flat(ring + below) + aside, fc="#C9C7BF", ec="none", zorder=1.1))


def _tripod(ax: Axes, x: float, y: float, view: View) -> None:
    """Draw the three axes of the support frame."""
    style = {"arrowstyle": "-|>,head_length=0.4,head_width=0.2", "color": GREY, "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
    for name, axis in zip("xyz", np.eye(3), strict=True):
        dx, dy = (float(part) for part in view.flat(axis))
        ax.annotate("", (x + dx, y + dy), (x, y), arrowprops=style, zorder=3)
        ax.text(x + 1.3 * dx, y + 1.3 * dy, name).set(ha="center", va="center", fontsize=8.5, color=GREY)


def _words(sheet: Sheet, left: float, rolled: RolledPath) -> None:
    """Say below the row how the ball is turned in the end."""
    home = "Home again, turned by" if rolled.is_closed else "In the end turned by"
    x, y, z = (short(round(part, 3) + 0.0, 3) for part in rolled.rotation.axis)
    angle = short(math.degrees(rolled.rotation.angle), 4)
    across, up = sheet.get_size_inches()
    for line, height in (
        (f"{home} {angle}° about ({x}, {y}, {z}).", 0.3),
        (f"The north pole points {direction(rolled.north_pole)}.", 0.12),
    ):
        sheet.text(left / across, height / up, line, fontsize=9.5, color=INK, ha="left", va="baseline")
