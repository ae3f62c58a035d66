"""Ball and charge on one map: paths, drift, fields, and the line of equal height and equal potential."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from trundle.wording import short, unit_for, with_unit

from ...views.plots.marks import Page, Ruler, arrowhead, signpost
from ...views.plots.scales import thin_path
from ...views.plots.sheet import BLUE, FAINT, GREEN, GREY, INK, VERMILION, Sheet, look

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .correspondence import Twin

Array = NDArray[np.float64]
_SAMPLES, _FEWEST = 400, 1500  # of the lines: for each turn, and at least
# Inches: margins, header, the map's title, the strip below it and what stands between them.
_LEFT, _RIGHT, _HEADER, _TITLE, _FOOT, _STRIP, _GAP, _KEY, _SIGNS = 0.75, 0.25, 0.72, 0.1, 0.5, 0.8, 0.62, 0.62, 1.25
_WIDE, _LOW, _TALL = 7.6, 2.6, 5.2


def draw(pair: Twin, duration: float) -> Sheet:
    """Draw the sheet.

    Examples
    --------
    >>> import trundle as tr
    >>> sheet = draw(tr.twin(tr.Scenario.load("level-turntable-nudged")), 20.0)
    >>> [ax.get_xlabel() for ax in sheet.axes]
    ['x (cm)', 'time of the ball (s)', '']
    """
    turns = abs(float(pair.ball.kappa)) * duration / (2 * math.pi)
    times = np.linspace(0.0, duration, max(_FEWEST, min(math.ceil(turns * _SAMPLES), 200_000)))
    ball, charge = pair.paths(times)
    page = Page.downhill_down(pair.tilt)
    low, high = _view(pair, page.order(ball), duration)
    span = high - low
    height = float(np.clip(_WIDE * span[1] / span[0], _LOW, _TALL))
    width = float(np.clip(height * span[0] / span[1], _TALL, _WIDE))
    scale = float(np.max(span / (width, height)))  # m for each inch
    low, high = (
        (low + high - scale * np.array([width, height])) / 2,
        (low + high + scale * np.array([width, height])) / 2,
    )
    with look():
        sheet = Sheet(_LEFT + width + _SIGNS + _RIGHT, _HEADER + _TITLE + height + _GAP + _STRIP + _FOOT + _KEY)
        sheet.head(pair.title or "Ball on a turntable, charge in crossed fields", _numbers(pair))
        ax = sheet.add_box(_LEFT, _KEY + _FOOT + _STRIP + _GAP, width, height)
        ruler = _frame(ax, pair, page, low, high)
        once = times <= min(1.0, 1.0 / turns) * duration if pair.ball.period < duration else times <= duration
        texts = _map(ax, pair, page, ruler, (page.order(ball[once]), page.order(charge[once])), duration)
        _strip(sheet.add_box(_LEFT, _KEY + _FOOT, width, _STRIP), times, ball - charge)
        signs = sheet.add_box(_LEFT + width + 0.1, _KEY + _FOOT + _STRIP + _GAP, _SIGNS, height)
        _signs(signs, pair, page, height)
        sheet.legend(handles=texts, loc="lower left", ncols=3, bbox_to_anchor=(0.012, 0.005), columnspacing=1.4)
    return sheet


def _view(pair: Twin, path: Array, duration: float) -> tuple[Array, Array]:
    """Return the corners of what the map must show, with a margin, no side less than a third of the other."""
    shown = [path]
    if pair.ball.has_guiding_centre:
        shown.append(Page.downhill_down(pair.tilt).order(_centres(pair, np.array([0.0, duration]))))
    everything = np.vstack(shown)
    low, high = everything.min(axis=0), everything.max(axis=0)
    span = float(np.max(high - low)) or 4 * float(pair.ball.radius)
    middle, half = (low + high) / 2, np.maximum((high - low) / 2 + 0.07 * span, 0.17 * span)
    return middle - half, middle + half


def _centres(pair: Twin, times: Array) -> Array:
    return np.column_stack([np.broadcast_to(part, times.shape) for part in pair.ball.guiding_centre(times)])


def _frame(ax: Axes, pair: Twin, page: Page, low: Array, high: Array) -> Ruler:
    unit = unit_for(float(np.max(np.abs([low, high]))), "length")
    ruler = Ruler(unit, (0.0, 0.0))
    tilted = pair.tilt != 0.0
    labels = ("x, down the slope", "y, level") if tilted else ("x", "y")
    ax.set_aspect("equal")
    ax.set_xlim(*(ruler(low)[0], ruler(high)[0])[:: page.across_sign])
    ax.set_ylim(*(ruler(low)[1], ruler(high)[1])[:: page.up_sign])
    ax.set_xlabel(f"{labels[page.across]} ({unit.symbol})", labelpad=2)
    ax.set_ylabel(f"{labels[page.up]} ({unit.symbol})")
    return ruler


def _map(ax: Axes, pair: Twin, page: Page, ruler: Ruler, paths: tuple[Array, Array], duration: float) -> list[Line2D]:
    ball, charge = paths
    tolerance = 1e-4 * float(np.max(np.ptp(ball, axis=0)) or 1.0)
    styles: dict[str, dict[str, Any]] = {
        "path of the ball": {"color": BLUE, "lw": 4.0, "alpha": 0.45},
        "path of the charge": {"color": INK, "lw": 1.2, "ls": (0, (5, 2.2))},
    }
    told = [_line(name, style) for name, style in styles.items()]
    if float(np.max(np.ptp(ball, axis=0))) < 1e-9 * float(pair.ball.radius):
        ax.annotate("both at rest", tuple(ruler(ball[0])), (0, 11), textcoords="offset points", ha="center")
        told = []
    else:
        for line, style in zip((ball, charge), styles.values(), strict=True):
            ax.plot(*ruler(thin_path(line, tolerance)).T, zorder=4, **style)
    told += _potential(ax, pair, page, ruler, ball)
    told += _guide(ax, pair, page, ruler, duration)
    start: dict[str, Any] = {"color": INK, "marker": "o", "mfc": "white", "ms": 7.0, "mew": 1.4, "ls": "none"}
    ax.plot(*ruler(ball[0]), zorder=8, **start)
    return [*told, _line("start", start)]


def _line(label: str, style: dict[str, Any]) -> Line2D:
    return Line2D([], [], label=label, **style)


def _potential(ax: Axes, pair: Twin, page: Page, ruler: Ruler, ball: Array) -> list[Line2D]:
    """Draw lines across E: the one that the guiding centre keeps to, or that of the start, and faint ones beside it."""
    push = np.array([float(pair.ball.phi.re), float(pair.ball.phi.im)])
    if not np.any(push):
        return []
    along = page.order(np.array([[-push[1], push[0]]]))[0] / np.hypot(*push)
    down = page.order(push[None])[0] / np.hypot(*push)
    begin = page.order(_centres(pair, np.zeros(1)))[0] if pair.ball.has_guiding_centre else ball[0]
    reach = 3 * float(np.max(np.ptp(ball, axis=0)))
    spread = float(np.max(np.abs((ball - begin) @ down))) or reach
    left, right = ax.get_xlim()
    bottom, top = ax.get_ylim()
    style: dict[str, Any] = {"color": GREEN, "lw": 1.5, "ls": (0, (1, 1.6))}
    faint: dict[str, Any] = style | {"color": FAINT, "lw": 0.9}
    for step in range(-8, 9):
        ends = np.array([begin + down * spread * step / 2 + sign * reach * along for sign in (-1, 1)])
        ax.plot(*ruler(ends).T, zorder=2.2, **(style if step == 0 else faint))
    ax.set_xlim(left, right)
    ax.set_ylim(bottom, top)
    level = pair.tilt != 0.0 and abs(push[1]) <= 1e-12 * abs(push[0])
    return [_line("equal height = equal potential" if level else "equal potential", style)]


def _guide(ax: Axes, pair: Twin, page: Page, ruler: Ruler, duration: float) -> list[Line2D]:
    """Draw the way of the guiding centre, by the ball's and by the charge's formula, with its arrow."""
    if not pair.ball.has_guiding_centre:
        return []
    drift = pair.ball.drift_velocity
    speed = math.hypot(*drift)
    track = page.order(_centres(pair, np.array([0.0, duration])))
    places = pair.particle.guiding_centre(np.array([0.0, 0.5]) * duration / pair.slow_motion)
    of_charge = page.order(np.column_stack([np.broadcast_to(place, 2) for place in places]))
    style: dict[str, Any] = {"color": VERMILION, "lw": 1.6}
    mark: dict[str, Any] = {"color": VERMILION, "marker": "D", "mfc": "white", "ms": 5.5, "mew": 1.3, "ls": "none"}
    if speed * duration <= 1e-9 * max(float(pair.ball.circle_radius), float(pair.ball.radius)):
        ax.plot(*ruler(of_charge[:1]).T, zorder=6, **mark)
        return [_line("guiding centre of both, at rest", mark)]
    ax.plot(*ruler(track).T, zorder=5, **style)
    ax.plot(*ruler(of_charge).T, zorder=6, **mark)
    step = (track[1] - track[0]) * (page.across_sign, page.up_sign)
    for share in (0.27, 0.77):
        arrowhead(ax, ruler(track[0] + share * (track[1] - track[0])), (float(step[0]), float(step[1])), VERMILION, 12)
    return [
        _line(f"guiding centre of the ball, {with_unit(speed, 'speed')}", style),
        _line("guiding centre of the charge, E×B/B²", mark),
    ]


def _strip(ax: Axes, times: Array, apart: Array) -> None:
    """Draw the distance between the two paths: what rounding makes it."""
    distance = np.hypot(*apart.T)
    unit, clock = unit_for(float(distance.max()), "length"), unit_for(float(times[-1]), "time")
    ax.plot(times / clock.scale, distance / unit.scale, color=GREY, lw=0.8)
    ax.set_xlabel(f"time of the ball ({clock.symbol})", labelpad=2)
    ax.set_ylabel(f"apart\n({unit.symbol})" if distance.any() else "apart (m)")
    ax.set_xlim(0.0, times[-1] / clock.scale)
    ax.set_ylim(0.0, 1.15 * float(distance.max()) / unit.scale or 1.0)
    ax.locator_params(axis="y", nbins=3)


def _signs(ax: Axes, pair: Twin, page: Page, height: float) -> None:
    """Say beside the map which way the fields point: B at or from the reader, E and the force on the charge."""
    ax.set_axis_off()
    ax.set(xlim=(0, _SIGNS), ylim=(0, height))
    charge = pair.particle
    where = height - 0.1
    ex, ey = charge.electric_field
    b = charge.magnetic_field
    if b:
        way = "out of the page" if b > 0 else "into the page"
        ax.text(0.62, where, f"B, {way}", ha="center", va="top", fontsize=8.5)
        for dx in (-0.28, 0.0, 0.28):
            ax.plot(0.62 + dx, where - 0.36, "o", ms=11, mfc="white", mec=INK, mew=1.2)
            ax.plot(0.62 + dx, where - 0.36, "." if b > 0 else "x", ms=6 if b > 0 else 5.5, color=INK, mew=1.2)
        where -= 0.72
    if ex or ey:
        size = math.hypot(ex, ey)
        signpost(ax, (0.34, where), (_SIGNS, height), True, "E", page.direction(ex / size, ey / size))
        sign = math.copysign(1.0, charge.charge)
        signpost(
            ax, (0.9, where), (_SIGNS, height), True, "force QE", page.direction(sign * ex / size, sign * ey / size)
        )
        where -= 0.72
    if pair.tilt:
        signpost(ax, (0.62, where), (_SIGNS, height), True, "downhill", (0.0, -1.0))


def _numbers(pair: Twin) -> str:
    charge = pair.particle
    parts = [f"table {short(float(pair.ball.rate), 4)} rad/s" if pair.ball.rate else "plane at rest"]
    parts += [f"tilt {short(math.degrees(pair.tilt), 4)}°"] if pair.tilt else []
    parts += [f"Q = {short(charge.charge, 4)} C", f"M = {short(charge.mass, 4)} kg"]
    parts += [f"B = {short(charge.magnetic_field, 4)} T"]
    parts += [f"E = {short(math.hypot(*charge.electric_field), 4)} V/m"]
    parts += [f"C = {short(charge.resistance, 4)} kg/s"] if charge.resistance else []
    parts += [f"{short(pair.slow_motion, 3)} times slower"] if pair.slow_motion != 1.0 else []
    return "  ·  ".join(parts)
