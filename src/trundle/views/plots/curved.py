"""The sheet of a curved support: from above, from the side, and in space."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle

from trundle.mechanics.algebra import Vector
from trundle.wording import unit_for, with_unit

from . import marks, solid
from .events import FLIGHT, SLIPPING, part_in, with_events
from .facts import Facts
from .ground import Window, heights, meridians, sections, window_of
from .layout import FOOT, GAP, HEADER, KEY_LINE, LEFT, TITLE, Key, Place, Plan
from .marks import STYLES, Ruler
from .panels import Panel, at_home
from .path import Drawing, crosses, fitted
from .scales import Array, round_step
from .sheet import GREY, Sheet

if TYPE_CHECKING:
    from trundle.simulation.trajectory import Trajectory

SIDE = 4.25  # inches: of each map from above, and of the view in space
LOW = 2.2  # inches: height of the view from the side
RIGHT = 0.25
LEVELS = 9  # contour lines, about


class CurvedDrawing(Drawing):
    """The sheet of a curved support while it is being drawn."""

    def __init__(self, run: Trajectory, facts: Facts, panels: list[Panel]) -> None:
        super().__init__(facts, panels)
        self.surface = run.system.support.surface
        self.fixed = facts.fixed
        run = with_events(run)
        self.own = run.in_frame("support" if self.fixed else "corotating").data
        self.time = np.asarray(self.own["time"].values, dtype=float)
        self.flying = part_in(facts.stretches, FLIGHT, self.time)
        self.centre, self.contact = (np.asarray(self.own[name].values, float) for name in ("position", "contact"))
        touched = self.contact[~self.flying] if not self.flying.all() else self.contact
        self.window = window_of(self.surface, touched, facts.radius)
        # A flight that does not come back is followed only as far as the surface can still be seen.
        touched_last = max((event.time for event in run.events if event.kind == "land"), default=-math.inf)
        leaves = part_in(facts.stretches[-1:], FLIGHT, self.time) & (self.time > touched_last)
        room = 0.6 * float(np.max(self.window.high - self.window.low))
        near = np.all((self.centre >= self.window.low - room) & (self.centre <= self.window.high + room), axis=1)
        self.shown = np.where((near | ~leaves)[:, None], self.centre, np.nan)

    def sheet(self) -> Sheet:
        """Draw it: two columns, two rows, the legend in the place that is left."""
        above = [panel for panel in self.panels if panel.name in ("support", "corotating")]
        lines = math.ceil((9 + self._said()) / 2)
        both = len(above) > 1
        # Beside two maps the view in space stands below, and the legend under the view from the side.
        key = lines * KEY_LINE + 0.3 if both else 0.0
        low = max(SIDE, LOW + FOOT + key) if both else max(LOW, (9 + self._said()) * KEY_LINE - FOOT)
        side, foot = low - FOOT - key if both else low, FOOT + 0.1
        width, top = 2 * (LEFT + SIDE) + GAP + RIGHT, foot + low + TITLE + FOOT
        sheet = Sheet(width, top + SIDE + TITLE + HEADER)
        sheet.head(self.facts.title, self.facts.numbers)
        right = LEFT + SIDE + GAP + LEFT
        for panel, left in zip(above, (LEFT, right), strict=False):
            place = Place(left, top, SIDE, SIDE)
            self._map(sheet.add_box(*place), fitted(panel, place, signs=False), place)
        self._side(sheet.add_box(LEFT, foot + low - side, SIDE, side), SIDE, side)
        self._space(
            sheet, Place(right - 0.55, foot - 0.3 if both else top - 0.3, SIDE + 0.55, (low if both else SIDE) + 0.3)
        )
        at = Key(LEFT - 0.1, foot + key - 0.2, lines) if both else Key(right - 0.1, foot + low, 9 + self._said())
        self._key(sheet, Plan(width, top + SIDE + TITLE + HEADER, [], None, [at]))
        return sheet

    def _table(self, ax: Axes, panel: Panel, ruler: Ruler) -> None:
        """Draw the edge and the heights of the surface, where the map sees it at rest."""
        if not at_home(panel, self.facts):
            return
        if self.facts.outline is not None and crosses(panel, self.facts.outline):
            marks.rim(ax, panel.page, ruler, self.facts.outline, 0.0)
            self.legend["rim"] = "wall" if self.facts.wall else "rim" if self.surface.rim is not None else "outline"
        for hole in map(float, self.surface.outline[1:]):
            ax.add_patch(
                Circle(tuple(ruler(np.zeros(2))), hole / ruler.unit.scale, fc="white", ec=GREY, lw=1.1, zorder=0.6)
            )
        self._contours(ax, panel, ruler)
        if self.facts.turning:
            ax.plot(*ruler(np.zeros(2)), **STYLES["axis"])
            self.legend["axis"] = f"axis of the {self.facts.ground}"
        if self.facts.round and 0.012 * max(panel.span) < self.facts.radius < 0.35 * min(panel.span):
            marks.ball(ax, ruler, panel.path[-1], self.facts.radius)
            self.legend["ball"] = f"{self.facts.noun} at the end, to scale"

    def _contours(self, ax: Axes, panel: Panel, ruler: Ruler) -> None:
        low, high = np.array(panel.low), np.array(panel.high)
        ends = [np.sort([low[i], high[i]]) for i in range(2)]
        x, y = (ends[panel.page.across], ends[panel.page.up]) if panel.page.across == 0 else (ends[1], ends[0])
        seen = Window(np.array([x[0], y[0], 0.0]), np.array([x[1], y[1], 0.0]), self.window.reach)
        field = heights(self.surface, seen)
        if field is None or not np.any(np.isfinite(field[2])):
            return
        grid_x, grid_y, z = field
        # Heights of places far beyond the path would leave no lines for where it is.
        limit = self.window.high[2] + (self.window.high[2] - self.window.low[2])
        known = z[np.isfinite(z) & (np.abs(z) <= max(abs(limit), abs(self.window.low[2]) * 2))]
        if not len(known) or float(np.ptp(known)) == 0.0:
            return
        unit = unit_for(float(np.ptp(known)), "length")
        step = round_step(float(np.ptp(known)) / unit.scale, LEVELS) * unit.scale
        levels = step * np.arange(np.floor(np.min(known) / step), np.ceil(np.max(known) / step) + 1)
        zero, scale = np.asarray(ruler.zero), ruler.unit.scale
        style: dict[str, Any] = {"levels": levels, "colors": "#B9B5A6", "linewidths": 0.7, "zorder": 0.8}
        if panel.page.across == 0:
            ax.contour((grid_x - zero[0]) / scale, (grid_y - zero[1]) / scale, z, negative_linestyles="solid", **style)
        else:
            ax.contour(
                (grid_y - zero[0]) / scale, (grid_x - zero[1]) / scale, z.T, negative_linestyles="solid", **style
            )
        along = "along the axis" if self.facts.tilted else "of height"
        self.legend["contour"] = f"surface, every {with_unit(step, 'length')} {along}"

    def _side(self, ax: Axes, width: float, height: float) -> None:
        """Draw the view from the side: of a surface of revolution the meridian, of a cylinder its wall unrolled."""
        if self.facts.wall is not None:
            self._unrolled(ax, width)
            return
        if self.surface.axisymmetric:
            across, ground = np.hypot(self.shown[:, 0], self.shown[:, 1]), meridians(self.surface, self.window)
            title, label = "Meridian plane", "distance from the axis"
        else:
            across, ground = self.shown[:, 0], sections(self.surface, self.window)
            title, label = "From the side", "x" if self.fixed else "x′"
        line = np.column_stack([across, self.shown[:, 2]])
        places = np.vstack([line[np.isfinite(across)], *ground])
        size = float(np.max(np.ptp(places, axis=0)))
        unit = unit_for(size, "length")
        for cut in ground:
            ax.plot(
                *(cut / unit.scale).T, **STYLES["ground" if self.surface.axisymmetric else "contour"] | {"zorder": 1}
            )
        if self.surface.axisymmetric:
            self.legend["ground"] = "surface, cut along its axis"
        ax.set_aspect("equal", adjustable="datalim")
        self._line(ax, line / unit.scale)
        if self.facts.round and 0.012 * size < self.facts.radius:
            spot = tuple(line[-1] / unit.scale)
            edge = {"ec": GREY, "lw": 1.1, "ls": (0, (1, 1.2))}
            ax.add_patch(Circle(spot, self.facts.radius / unit.scale, fc="none", zorder=2.5, **edge))
        ax.set_title(title, loc="left")
        ax.set_xlabel(f"{label} ({unit.symbol})", labelpad=2)
        ax.set_ylabel(f"{'z' if self.fixed else 'z′'}, along the axis ({unit.symbol})")
        ax.yaxis.set_label_coords(-0.5 / width, 0.5)
        ax.margins(0.06)
        ax.locator_params(axis="y", nbins=max(4, round(2 * height)))

    def _unrolled(self, ax: Axes, width: float) -> None:
        angle = np.degrees(np.unwrap(np.arctan2(self.centre[:, 1], self.centre[:, 0])))
        z = self.centre[:, 2]
        unit = unit_for(float(np.max(np.abs(z))), "length")
        turns = float(np.ptp(angle)) > 4 * 360.0
        self._line(ax, np.column_stack([angle / (360.0 if turns else 1.0), z / unit.scale]))
        ax.set_title("The wall, unrolled", loc="left")
        ax.set_xlabel("turns about the axis" if turns else "angle about the axis (°)", labelpad=2)
        ax.set_ylabel(f"z, along the axis ({unit.symbol})")
        ax.yaxis.set_label_coords(-0.5 / width, 0.5)

    def _line(self, ax: Axes, line: Array) -> None:
        """Draw the path of the centre with all that is marked on it."""
        slipping = part_in(self.facts.stretches, SLIPPING, self.time)
        for chosen, kind in ((~self.flying, "path"), (self.flying, "flight"), (slipping, "slipping")):
            if np.any(chosen):
                ax.plot(*(line * np.where(chosen, 1.0, np.nan)[:, None]).T, **STYLES[kind])
        for kind, places in self._marks(line).items():
            ax.plot(*places.T, **STYLES[kind])

    def _marks(self, line: Array) -> dict[str, Array]:
        """Return the places of start, end and events on a line through the samples."""
        found = {"start": line[:1]}
        if not any(happening.kind == "event" for happening in self.facts.happenings):
            found["end"] = line[-1:]
        for happening in self.facts.happenings:
            columns = [np.interp(happening.marked, self.time, line[:, i]) for i in range(line.shape[1])]
            found[happening.kind] = np.column_stack(columns)
        return found

    def _space(self, sheet: Sheet, place: Place) -> None:
        """Draw the view in space: the track on the surface, and the way of the centre in flight."""
        ax: Any = sheet.add_box(*place, projection="3d")
        line = np.where(self.flying[:, None], self.shown, self.contact)
        with np.errstate(all="ignore"):
            normal = self.surface.normal(Vector.of(self.contact)).array()
        track = solid.Track(
            line,
            np.broadcast_to(normal, line.shape),
            self.flying,
            part_in(self.facts.stretches, SLIPPING, self.time),
            self._marks(line),
        )
        upright = self.fixed and self.facts.tilted
        names = ("X", "Y", "Z, up") if upright else ("x", "y", "z") if self.fixed else ("x′", "y′", "z′")
        solid.draw(ax, self.surface, self.window, track, self.facts.tilt if upright else 0.0, names)
        across, up = sheet.get_size_inches()
        where = "Track on the surface" if self.fixed else f"Track on the surface, seen from the {self.facts.ground}"
        sheet.text(
            (place.left + 0.55) / across,
            (place.bottom + place.height + 7.0 / 72) / up,
            where,
            fontsize=10.5,
            fontweight="bold",
            ha="left",
            va="baseline",
        )
