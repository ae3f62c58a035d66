"""The figure of a search: the energy along the support, and the body at each equilibrium with the forces on it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trundle.wording import short, unit_for, with_unit

from ...mechanics.algebra import ZERO, Quaternion, Vector
from ...mechanics.contact import Contact, roll
from ...views.plots.sheet import BLUE, FAINT, GREEN, GREY, INK, TABLE, VERMILION, Sheet, look
from . import rest
from .words import motion_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .line import Line
    from .result import Equilibria, Equilibrium

Array = NDArray[np.float64]

MOST_DRAWN = 3
CROWDED = 0.2  # share of the line that the equilibria take up, below which the curve is drawn of their surroundings
# Inches: the curve's box, each drawing, and the room around them.
_CURVE, _DRAWING, _LEFT, _FOOT, _HEADER, _GAP = 4.3, 2.9, 0.8, 0.62, 1.08, 0.15
_VIEW = 1.45  # half the width of a drawing, radii
_ARROW = 1.5  # length of the applied force's arrow, radii
STYLES: dict[str, dict[str, Any]] = {
    "stable": {"marker": "o", "color": BLUE, "ms": 9},
    "unstable": {"marker": "^", "color": VERMILION, "ms": 9},
    "indifferent": {"marker": "s", "color": GREEN, "ms": 8},
}
PULLED: dict[str, Any] = {"marker": "x", "color": GREY, "ms": 7, "mew": 1.6}


def draw(result: Equilibria) -> Figure:
    """Draw the findings."""
    shown = [one for one in result.marked if one.stands and one.angle is not None]
    shown = sorted(shown, key=lambda one: one.energy or 0.0)
    drawings: list[Equilibrium | None] = [*shown[:MOST_DRAWN]] or [None]
    with look():
        width = _LEFT + _CURVE + 0.3 + len(drawings) * (_DRAWING + _GAP) + 0.1
        height = _HEADER + _DRAWING + _FOOT
        sheet = Sheet(width, height)
        sheet.head(result.title or "Equilibria", _facts(result, len(shown)))
        if result.line is None:
            return sheet
        _curve(sheet.add_box(_LEFT, _FOOT, _CURVE, _DRAWING), result, shown)
        for i, one in enumerate(drawings):
            left = _LEFT + _CURVE + 0.3 + i * (_DRAWING + _GAP)
            ax = sheet.add_box(left, _FOOT, _DRAWING, _DRAWING)
            _drawing(ax, result.line, one)
    return sheet


def _facts(result: Equilibria, count: int) -> str:
    parts = []
    support, shape = result.system.support, result.system.body.shape
    if support.surface.coordinates == ("length", "length"):
        parts.append(f"tilt {short(math.degrees(support.tilt), 4)}°" if support.tilt else "level")
    centre = getattr(shape, "centre", None)
    if centre is not None:
        parts.append(f"centre of mass {with_unit(centre.norm(), 'length')} off the centre")
    if support.friction is not None:
        parts.append(f"friction {support.friction:g}")
    if not result.found:
        parts.append("no equilibrium: it rolls")
    elif count > MOST_DRAWN:
        parts.append(f"the {MOST_DRAWN} lowest of {count} equilibria drawn")
    return "  ·  ".join(parts)


# --- the energy along the line --------------------------------------------------------------------------------


def _curve(ax: Axes, result: Equilibria, shown: list[Equilibrium]) -> None:
    line = result.line
    if line is None:
        return
    angles = line.angles[:: max(1, line.angles.size // 1440)]
    energy, (along, axis) = line.energy(angles), _along(line, angles)
    presses = _presses(line, angles)
    zero = min((float(line.energy(one.angle)) for one in shown), default=float(energy[presses].min(initial=0.0)))
    scale, name = _joules(float(np.ptp(energy)) or line.scale)
    x, y = along(angles), (energy - zero) / scale
    handles: dict[str, Any] = {}
    ax.plot(np.where(presses, x, np.nan), y, color=INK, lw=1.8, zorder=3)
    if not presses.all():
        (dashes,) = ax.plot(x, y, color=GREY, lw=1.2, ls=(0, (2, 2)), zorder=2)
        handles["support would have to pull"] = dashes
    for one in result.marked:
        style = STYLES[one.stability] if one.stands else PULLED
        label = one.stability if one.stands else "support would have to pull"
        at = float(along(one.angle)), (float(line.energy(one.angle)) - zero) / scale
        edge = {"mec": "white", "mew": 1.0} if one.stands else {}
        (handle,) = ax.plot(*at, ls="none", zorder=5, **{**style, **edge})
        handles.setdefault(label, handle)
    if line.flat:
        ax.set(ylim=(-1, 1), yticks=[0])
        ax.plot(x, y, color=GREEN, lw=5, alpha=0.35, zorder=2)
    ax.margins(x=0.02, y=0.14)
    places = [float(along(one.angle)) for one in shown]
    if len(places) > 1 and np.ptp(places) < CROWDED * np.ptp(x):  # look closer
        low, high = min(places) - 1.5 * np.ptp(places), max(places) + 1.5 * np.ptp(places)
        seen = y[(x > low) & (x < high)]
        ax.set(xlim=(low, high), ylim=(seen.min() - 0.14 * np.ptp(seen), seen.max() + 0.14 * np.ptp(seen)))
    ax.set_xlabel(axis, labelpad=2)
    ax.set_ylabel(f"{'energy' if result.conservative else 'work against the loads'} ({name})")
    if handles:
        names = list(handles)
        ax.legend(
            [handles[name] for name in names],
            names,
            loc="lower left",
            bbox_to_anchor=(0, 1.0),
            ncols=4,
            borderaxespad=0.1,
            handletextpad=0.1,
            columnspacing=1.0,
        )


def _along(line: Line, angles: Array) -> tuple[Callable[[Any], Any], str]:
    """Return what is drawn along the axis, and its name: a body that tips over its rim rolls no way."""
    most = float(np.abs(line.distance(angles)).max())
    arm = float(rest.contact_at(line.system, line.time, *line.place(0.0)).offset.norm())
    if most <= 1e-6 * arm * float(np.ptp(angles)):
        return np.rad2deg, "angle tipped (°)"
    unit = unit_for(most, "length")
    return lambda angle: line.distance(angle) / unit.scale, f"distance rolled ({unit.symbol})"


def _presses(line: Line, angles: Array) -> NDArray[np.bool_]:
    """Return where the support pushes on the body, let go at rest."""
    p, q = line.place(angles)
    now = roll(line.system, line.time, p, q, ZERO)
    return np.broadcast_to(now.reaction.dot(now.contact.normal) >= 0, angles.shape)


def _joules(size: float) -> tuple[float, str]:
    units = ((1e3, "kJ"), (1.0, "J"), (1e-3, "mJ"), (1e-6, "µJ"), (1e-9, "nJ"))
    return next(((scale, name) for scale, name in units if size >= 0.999 * scale), units[-1])


# --- the body at one equilibrium ------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Page:
    """The plane across the turn's axis: the applied force points down, rolling on goes to the right."""

    origin: Vector
    right: Vector
    up: Vector
    size: float  # a radius, m

    def __call__(self, v: Vector) -> Array:
        """Return points, radii."""
        away = v - self.origin
        return np.stack(np.broadcast_arrays(away.dot(self.right), away.dot(self.up)), axis=-1) / self.size

    def direction(self, v: Vector) -> Array:
        """Return a direction, without a unit."""
        return np.array([float(v.dot(self.right)), float(v.dot(self.up))])


def _drawing(ax: Axes, line: Line, one: Equilibrium | None) -> None:
    angle = float(line.angles[np.abs(line.works).argmin()]) if one is None else float(one.angle or 0.0)
    p, q = line.place(angle)
    now = roll(line.system, line.time, p, q, ZERO)
    force, torque = line.system.loads_on(rest.still(line.system, line.time, now.contact, q))
    page = _page(line, now.contact, q, force)
    _support(ax, page, line, angle)
    _body(ax, page, line, q, now.contact.centre)
    name = "m g" if all(load.linear_drag is not None for load in line.system.loads) else "F"
    _forces(ax, page, (now.contact.centre, p), (name, force), now.reaction, now.contact.normal)
    if torque.norm() > 1e-9 * line.scale:
        ax.text(0.03, 0.03, f"torque {with_unit(torque.norm(), 'torque')}", transform=ax.transAxes, fontsize=8.5)
    ax.set(xlim=(-_VIEW, _VIEW), ylim=(-0.75, 2 * _VIEW - 0.75))
    ax.set_aspect("equal")
    ax.axis("off")
    arm = float(np.abs(line.works).min() / force.norm()) if force.norm() > 0 and torque.norm() == 0 else 0.0
    _title(ax, line, one, name, arm)


def _title(ax: Axes, line: Line, one: Equilibrium | None, name: str, arm: float) -> None:
    top: dict[str, Any] = {"transform": ax.transAxes, "ha": "center", "va": "baseline"}
    if one is None:
        ax.text(0.5, 1.10, "no rest: nearest to it", fontsize=10.5, fontweight="bold", color=INK, **top)
        words = f"{name} passes {1e3 * arm:.3g} mm beside the contact" if arm > 0 else "the loads turn it on"
        ax.text(0.5, 1.035, words, fontsize=8.5, color=GREY, **top)
        return
    style = STYLES[one.stability]
    where = "" if line.system.body.shape.axis is None or line.flat else f", at {_place(line, one)}"
    ax.text(0.5, 1.145, f"{one.stability}{where}", fontsize=10.5, fontweight="bold", color=style["color"], **top)
    needs = f"friction {short(one.friction_needed, 3)} needed" if one.friction_force else "no friction needed"
    slips = ", it SLIPS" if one.holds is False else ""
    motion = "rests anywhere along the line" if line.flat else motion_words(one.modes[0], 4)
    ax.text(0.5, 1.085, motion, fontsize=8.5, color=GREY, **top)
    ax.text(0.5, 1.03, needs + slips, fontsize=8.5, color=GREY, **top)


def _place(line: Line, one: Equilibrium) -> str:
    size = abs(float(line.distance(line.high) - line.distance(line.low)))
    distance = float(line.distance(one.angle))
    return "the start" if abs(distance) < 1e-9 * size else with_unit(distance, "length", 3)


def _page(line: Line, contact: Contact, q: Quaternion, force: Vector) -> _Page:
    n = contact.normal
    down = force - line.axis * force.dot(line.axis)
    up = -down if down.norm() > 1e-9 * force.norm() and force.norm() > 0 else n
    up = up / up.norm()
    right = line.axis.cross(up)
    outline = _outline(line, q, contact.centre, right, up)
    size = max(float(np.ptp(outline.dot(way))) / 2 for way in (right, up))  # a disc is a line from its edge
    return _Page(contact.point, right, up, size)


def _outline(line: Line, q: Quaternion, centre: Vector, right: Vector, up: Vector) -> Vector:
    """Return the points of the body whose outward normals lie in the page."""
    t, Q = np.linspace(0, 2 * math.pi, 361), q.matrix()
    outward = right * np.cos(t) + up * np.sin(t)
    return centre + Q @ line.system.body.shape.support_map(Q.transpose @ outward)


def _support(ax: Axes, page: _Page, line: Line, angle: float) -> None:
    """Draw the support as cut by the page: the contact's own path, and the ground behind it."""
    near = 1.0 + 2 * math.pi / 3
    here = line.distance(angle)
    angles = line.angles
    angles = angles[np.abs(line.distance(angles) - here) < 3.5 * near * page.size]
    p, _ = line.place(angles)
    path = page(p)
    now = [rest.contact_at(line.system, line.time, *line.place(end)) for end in (angles[0], angles[-1])]
    into = -page.direction(rest.contact_at(line.system, line.time, *line.place(angle)).normal)
    if all(row.norm() == 0 for contact in now for row in contact.shape_operator.rows):  # straight on
        along = np.array([-into[1], into[0]])
        path = np.vstack([path[0] - 6 * along, path, path[-1] + 6 * along])
    ax.fill(*np.vstack([path, (path + 4 * into)[::-1]]).T, color=TABLE, ec="none", zorder=0)
    ax.plot(*path.T, color=GREY, lw=1.6, zorder=1)


def _body(ax: Axes, page: _Page, line: Line, q: Quaternion, centre: Vector) -> None:
    """Draw the outline, the centre of mass at its place, and the side on which it is heavy."""
    from matplotlib.patches import Circle, Polygon, Wedge

    shape, Q = line.system.body.shape, q.matrix()
    outline = page(_outline(line, q, centre, page.right, page.up))
    ax.add_patch(Polygon(outline, fc="white", ec=INK, lw=1.5, alpha=0.92, zorder=2))
    c = getattr(shape, "centre", None)
    at = page(centre)
    if c is not None and c.norm() > 0:
        middle = centre + Q @ c
        heavy = -(Q @ c) / c.norm()
        far = page(middle + heavy * (0.8 * page.size))
        ax.plot(*np.array([page(middle), far]).T, color=FAINT, lw=2.0, zorder=2.2)
        ax.add_patch(Circle(tuple(far), 0.115, fc=GREY, ec=INK, lw=0.8, zorder=2.3))
        ax.plot(*page(middle), marker="+", color=GREY, ms=9, mew=1.2, zorder=2.4)
    size = 0.075
    ax.add_patch(Circle(tuple(at), size, fc="white", ec=INK, lw=0.9, zorder=6))
    for begin in (0, 180):
        ax.add_patch(Wedge(tuple(at), size, begin, begin + 90, fc=INK, ec="none", zorder=6.1))


def _forces(
    ax: Axes, page: _Page, points: tuple[Vector, Vector], applied: tuple[str, Vector], reaction: Vector, n: Vector
) -> None:
    (centre, p), (name, force) = points, applied
    size = force.norm()
    if not size > 0:
        return
    N, whole = n * reaction.dot(n), page.direction(force) / size * _ARROW
    f = reaction - N
    _arrow(ax, page(p), page.direction(N) / size * _ARROW, BLUE, "N", 3.2, 4)
    _arrow(ax, page(centre), whole, INK, name, 1.6, 5)
    if f.norm() > 1e-9 * size:
        _arrow(ax, page(p), page.direction(f) / size * _ARROW, VERMILION, "f", 3.2, 4.5)
    ax.plot(*page(p), marker="o", ms=4, color=INK, zorder=7)


def _arrow(ax: Axes, tail: Array, along: Array, colour: str, name: str, width: float, zorder: float) -> None:
    head = tail + along
    style = {
        "arrowstyle": f"-|>,head_length={0.28 + 0.05 * width},head_width={0.13 + 0.04 * width}",
        "lw": width,
        "color": colour,
        "shrinkA": 0,
        "shrinkB": 0,
        "joinstyle": "miter",
    }
    ax.annotate("", tuple(head), tuple(tail), arrowprops=style, zorder=zorder)
    length = max(float(np.hypot(*along)), 1e-12)
    side = np.array([along[1], -along[0]]) / length
    place = head + (0.12 + 0.06 * len(name)) * side if length > 0.5 else head + 0.12 * along / length + [0.0, 0.13]
    ax.text(
        float(place[0]),
        float(place[1]),
        name,
        color=colour,
        fontsize=10,
        ha="center",
        va="center",
        zorder=8,
        fontweight="bold",
    )
