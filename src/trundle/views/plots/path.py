"""The sheet of paths: a map for each frame that tells something, to one scale where that is possible."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from trundle.wording import Unit, unit_for, with_unit

from . import marks
from .events import FLIGHT, SLIPPING
from .facts import NOTHING, Facts, facts_of
from .layout import Place, Plan, arrange
from .marks import STYLES, Ruler
from .panels import MANY_TURNS, Panel, at_home, panels_of, phases_of, until_text
from .scales import Array, round_step, thin_path
from .sheet import BLUE, GREY, VERMILION, Sheet, look

if TYPE_CHECKING:
    from trundle.simulation.trajectory import Trajectory

COARSE_A_TURN = 12  # samples; with fewer the track of the contact is drawn as points
SIGN = 0.66  # inches across, for each of the arrows that say what pushes and turns


def draw(run: Trajectory) -> Sheet:
    """Draw the sheet."""
    facts = facts_of(run)
    with look():
        if facts.curved:
            from .curved import CurvedDrawing

            return CurvedDrawing(run, facts, panels_of(run, facts)).sheet()
        return Drawing(facts, panels_of(run, facts)).sheet()


class Drawing:
    """The sheet while it is being drawn."""

    def __init__(self, facts: Facts, panels: list[Panel]) -> None:
        self.facts, self.panels = facts, panels
        self.units = _units(panels)
        self.step, self.instants, self.of_what = _instants(panels)
        self.legend: dict[str, str] = {}

    def sheet(self) -> Sheet:
        """Draw it."""
        under = "world" if any(panel.name == "world" for panel in self.panels) else self._from_the_side()
        plan = arrange([(panel.name, panel.span) for panel in self.panels], under, lines=self._lines_of_key())
        sheet = Sheet(plan.width, plan.height)
        sheet.head(self.facts.title, self.facts.numbers)
        for panel, place in zip(self.panels, plan.maps, strict=True):
            shown = fitted(panel, place, signs=panel.name != "corotating" and self.facts.rim is None)
            ax = sheet.add_box(*place)
            self._map(ax, shown, place)
            if panel.name == under and plan.strip is not None:
                ax.set_xlabel("")
                ax.tick_params(labelbottom=False)
                self._strip(sheet.add_box(*plan.strip, sharex=ax), shown, place.width)
        self._key(sheet, plan)
        return sheet

    def _from_the_side(self) -> str | None:
        """Return the map under which heights are drawn, where they change."""
        panel = self.panels[0]
        rises = float(np.ptp(panel.line[:, 2])) > 2e-2 * self.facts.radius
        return "support" if rises and self.facts.wall is None else None

    def _lines_of_key(self) -> int:
        """Return how many lines the legend takes at the foot of a sheet, two unless there is much to say."""
        return 2 + math.ceil(self._said() / 2)

    def _said(self) -> int:
        """Return how many entries the legend has besides the usual ones."""
        phases = {stretch.phase for stretch in self.facts.stretches} & {SLIPPING, FLIGHT}
        return len(self.facts.happenings) + len(phases) + self.facts.off_centre

    def _key(self, sheet: Sheet, plan: Plan) -> None:
        """Write the legend, shared out over the places that the plan has for it."""
        kinds = [kind for kind in STYLES if kind in self.legend]
        each = math.ceil(len(kinds) / len(plan.keys))
        for i, key in enumerate(plan.keys):
            texts = {kind: self.legend[kind] for kind in kinds[i * each : (i + 1) * each]}
            if texts:
                corner = (key.left / plan.width, key.top / plan.height)
                marks.legend(sheet, texts, corner, math.ceil(len(texts) / key.rows))

    def _map(self, ax: Axes, panel: Panel, place: Place) -> None:
        ruler = self._frame(ax, panel, place.width)
        self._table(ax, panel, ruler)
        if panel.name != "corotating":
            self._signs(ax, panel, ruler, place)
        if not panel.at_rest:
            self._guide(ax, panel, ruler)
            self._path(ax, panel, ruler)
        self._contact(ax, panel, ruler)
        self._ends(ax, panel, ruler)
        self._events(ax, panel, ruler)

    def _frame(self, ax: Axes, panel: Panel, width: float) -> Ruler:
        """Set axes, labels and title; count from the start where the path is tiny beside its place."""
        page, unit = panel.page, self.units[panel.name]
        start = panel.path[0]
        zero, names = [0.0, 0.0], [panel.labels[page.across], panel.labels[page.up]]
        for i in range(2):
            if abs(panel.low[i] + panel.high[i]) / 2 > 20 * max(panel.span):
                zero[i] = float(start[i])
                sign = "+" if zero[i] < 0 else "−"
                names[i] = f"{names[i][0]} {sign} {with_unit(abs(zero[i]), 'length', 6)}"
        ruler = Ruler(unit, (zero[0], zero[1]))
        low, high = ruler(np.array(panel.low)), ruler(np.array(panel.high))
        ax.set_aspect("equal", adjustable="datalim")
        ax.set_xlim(*(low[0], high[0])[:: page.across_sign])
        ax.set_ylim(*(low[1], high[1])[:: page.up_sign])
        ax.set_xlabel(f"{names[0]} ({unit.symbol})", labelpad=2)
        ax.set_ylabel(f"{names[1]} ({unit.symbol})")
        ax.yaxis.set_label_coords(-0.5 / width, 0.5)
        ax.set_title(until_text(panel), loc="left")
        ax.locator_params(nbins=6)
        return ruler

    def _table(self, ax: Axes, panel: Panel, ruler: Ruler) -> None:
        """Draw what the ball rolls on, and the ball at the end, to scale."""
        facts = self.facts
        if facts.rim is not None and at_home(panel, facts) and crosses(panel, facts.rim):
            marks.rim(ax, panel.page, ruler, facts.rim, facts.tilt if panel.name == "world" else 0.0)
            self.legend["rim"] = "rim"
        if facts.wall is not None:
            marks.rim(ax, panel.page, ruler, facts.wall, 0.0)
            self.legend["rim"] = "wall"
        elif facts.turning and at_home(panel, facts) and crosses(panel, 0.0):
            ax.plot(*ruler(np.zeros(2)), **STYLES["axis"])
            self.legend["axis"] = f"axis of the {facts.ground}"
        smallest = 0.035 if facts.wall is None else 0.012
        large_enough = smallest * max(panel.span) < facts.radius < 0.35 * min(panel.span)
        if facts.round and large_enough and panel.until is None:
            marks.ball(ax, ruler, panel.path[-1], facts.radius)
            self.legend["ball"] = f"{facts.noun} at the end, to scale"

    def _signs(self, ax: Axes, panel: Panel, ruler: Ruler, place: Place) -> None:
        """Say which way is down and which way the table turns, where the map is emptiest."""
        facts = self.facts
        signs = [("down" if facts.wall else "downhill", (0.0, -1.0))] if facts.tilted else []
        signs += [(name, panel.page.direction(x, y)) for name, x, y in facts.pushes]
        arc = facts.turning
        whole = (
            facts.rim is not None
            and at_home(panel, facts)
            and max(panel.low) < -facts.rim
            and min(panel.high) > facts.rim
        )
        count = len(signs) + (arc and not whole)
        left, top = _emptiest(panel, place, SIGN * count, corners_only=whole)
        if whole and arc:
            # Beside the sign where there is one; else at the upper right.
            angle = math.radians(45.0 if not count or (left == 0.0) == top else 135.0)
            marks.turning(ax, panel.page, ruler, 1.055 * float(facts.rim or 0.0), angle, facts.rate)
        for i in range(count):
            at = (left + SIGN * (i + 0.5), place.height - 0.08 if top else 0.08)
            if i < len(signs):
                marks.signpost(ax, at, (place.width, place.height), top, *signs[i])
            else:
                marks.turn_sign(ax, at, (place.width, place.height), top, facts.rate, facts.ground)

    def _guide(self, ax: Axes, panel: Panel, ruler: Ruler) -> None:
        track = panel.track
        if track is None:
            return
        if np.all(np.ptp(track, axis=0) <= 1e-6 * max(panel.span)):
            ax.plot(*ruler(track[0]), **STYLES["centre"])
            self.legend["centre"] = "guiding centre, at rest"
            return
        above = {"zorder": 4.5} if panel.turns > MANY_TURNS and panel.until is None else {}
        ax.plot(*ruler(track).T, **STYLES["guide"] | above)
        speed = float(np.hypot(*(track[-1] - track[0]))) / float(panel.time[-1] - panel.time[0])
        self.legend["guide"] = f"guiding centre, {with_unit(speed, 'speed')}"
        # The arrowhead sits at the last place that is well within the view.
        along = track[0] + np.linspace(0.0, 1.0, 2001)[:, None] * (track[-1] - track[0])
        inset = 0.03 * max(panel.span)
        seen = along[np.all((along >= np.array(panel.low) + inset) & (along <= np.array(panel.high) - inset), axis=1)]
        if len(seen) > 1:
            step = (seen[-1] - seen[0]) * (panel.page.across_sign, panel.page.up_sign)
            marks.arrowhead(ax, ruler(seen[-1]), (float(step[0]), float(step[1])), VERMILION, 11)

    def _path(self, ax: Axes, panel: Panel, ruler: Ruler) -> None:
        path, first = panel.path, panel.first_turn
        self.legend["path"] = f"path of the {self.facts.noun}'s centre"
        if panel.sparse:
            ax.plot(*ruler(path).T, **STYLES["samples"], label="path")
            self.legend["samples"] = "samples, too far apart for a line"
            self.legend.pop("path")
            return
        tolerance = 1e-4 * max(panel.span)
        many = panel.turns > MANY_TURNS and panel.until is None and not panel.repeats
        thin = {"lw": 0.5 if panel.turns > 60 else 0.9} if many else {}
        touching, flying, slipping = phases_of(panel, self.facts)
        if flying is None:
            ax.plot(*ruler(thin_path(path, tolerance)).T, **STYLES["path"] | thin, label="path")
        else:
            ax.plot(*ruler(path * touching[:, None]).T, **STYLES["path"] | thin, label="path")
            ax.plot(*ruler(path * flying[:, None]).T, **STYLES["flight"])
            self.legend["flight"] = "in flight"
        if slipping is not None:
            ax.plot(*ruler(path * slipping[:, None]).T, **STYLES["slipping"])
            self.legend["slipping"] = "slipping"
        if first is not None:
            ax.plot(*ruler(thin_path(first, tolerance)).T, **STYLES["first turn"])
            self.legend["first turn"] = "its first turn"
        elif not many and (panel.until is not None or self.panels[0].until is None):
            self._dots(ax, panel, ruler)
        if first is not None or not (many and panel.turns > 60):
            self._arrows(ax, panel, ruler, path if first is None else first)

    def _dots(self, ax: Axes, panel: Panel, ruler: Ruler) -> None:
        path = panel.path
        times = self.instants[self.instants < panel.time[panel.shown][-1]]
        if len(times) and len(panel.samples) > 24:
            at = np.column_stack([np.interp(times, panel.time[panel.shown], path[:, i]) for i in range(2)])
            ax.plot(*ruler(at).T, **STYLES["dots"])
            self.legend["dots"] = f"every {with_unit(self.step, 'time')}{self.of_what}"

    def _arrows(self, ax: Axes, panel: Panel, ruler: Ruler, path: Array) -> None:
        """Show the sense of travel part of the way along: the ball is fast there, not at a cusp."""
        length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
        for fraction in (0.3, 0.78) if panel.first_turn is None else (0.3,):
            i = min(max(int(np.searchsorted(length, fraction * length[-1])), 1), len(path) - 1)
            step = path[i] - path[i - 1]
            at = path[i - 1] + (fraction * length[-1] - length[i - 1]) / (length[i] - length[i - 1]) * step
            onward = step * (panel.page.across_sign, panel.page.up_sign)
            marks.arrowhead(ax, ruler(at), (float(onward[0]), float(onward[1])), BLUE, 12)

    def _contact(self, ax: Axes, panel: Panel, ruler: Ruler) -> None:
        """Draw the track of the contact, where it is not that of the centre."""
        track = panel.touched
        if track is None or not np.any(np.isfinite(track)):
            return
        extent = np.nanmax(track, axis=0) - np.nanmin(track, axis=0)
        if float(np.max(extent)) > 1e-3 * max(panel.span):
            coarse = panel.turns * COARSE_A_TURN > len(panel.samples)
            ax.plot(*ruler(track).T, **STYLES["contact"] | ({"ls": "none", "marker": ".", "ms": 3} if coarse else {}))
            self.legend["contact"] = "track of the contact"

    def _ends(self, ax: Axes, panel: Panel, ruler: Ruler) -> None:
        path, time = panel.page.order(panel.line), panel.time
        last = "event" if any(found.kind == "event" for found in self.facts.happenings) else "end"
        if panel.until is None and not panel.at_rest and last == "end":
            ax.plot(*ruler(path[-1]), **STYLES["end"])
            self.legend["end"] = f"end, {with_unit(float(time[-1]), 'time')}"
        ax.plot(*ruler(path[0]), **STYLES["start"])
        self.legend["start"] = "start"
        if panel.at_rest and len(time) > 1:
            bobs = float(np.ptp(panel.line[:, 2])) > 1e-6 * self.facts.radius
            ax.annotate(
                "straight up and down" if bobs else "at rest",
                tuple(ruler(path[0])),
                (0, 9),
                textcoords="offset points",
                ha="center",
                va="bottom",
            )

    def _events(self, ax: Axes, panel: Panel, ruler: Ruler) -> None:
        """Mark what happened where it happened."""
        path, time = panel.page.order(panel.line), panel.time
        for found in self.facts.happenings:
            times = found.marked if panel.until is None else found.marked[found.marked <= panel.until]
            at = np.column_stack([np.interp(times, time, path[:, i]) for i in range(2)])
            ax.plot(*ruler(at).T, **STYLES[found.kind])
            if len(times):
                self.legend[found.kind] = found.text

    def _strip(self, ax: Axes, panel: Panel, width: float) -> None:
        """Draw the height of the centre above its start, against the level coordinate of the map above it."""
        page, ruler = panel.page, self.units[panel.name]
        height = panel.line[:, 2] - panel.line[0, 2]
        level = float(np.max(np.abs(height))) <= NOTHING * self.facts.radius
        unit = unit_for(self.facts.radius if level else float(np.max(np.abs(height))), "length")
        scale = np.array([ruler.scale, unit.scale])
        line = np.column_stack([panel.line[:, page.across], height]) / scale
        ax.axhline(0.0, color=GREY, lw=0.9, ls=(0, (1, 1.5)), zorder=2)
        many = panel.turns > MANY_TURNS
        if panel.guide is not None and panel.track is not None:
            # It lies in the plane of the ball's centre: its place downhill gives its height.
            ends = panel.guide[[0, -1]]
            fall = (ends[:, 0] - panel.line[0, 0]) * -math.tan(self.facts.tilt)
            track = np.column_stack([ends[:, page.across], fall]) / scale
            ax.plot(*track.T, **STYLES["guide"] | ({"zorder": 4.5} if many else {}))
        kind = "samples" if panel.sparse else "path"
        extent = np.where(
            np.ptp(line, axis=0) > 0.0, np.ptp(line, axis=0), 1.0
        )  # the two axes have scales of their own
        touching, flying, slipping = phases_of(panel, self.facts)
        if flying is None:
            drawn = thin_path(line / extent, 1e-4) * extent
            ax.plot(*drawn.T, **STYLES[kind] | ({"lw": 0.5} if many else {}))
        else:
            ax.plot(*(line * touching[:, None]).T, **STYLES[kind])
            ax.plot(*(line * flying[:, None]).T, **STYLES["flight"])
        if slipping is not None:
            ax.plot(*(line * slipping[:, None]).T, **STYLES["slipping"])
        for found in self.facts.happenings:
            at = np.column_stack([np.interp(found.marked, panel.time, line[:, i]) for i in range(2)])
            ax.plot(*at.T, **STYLES[found.kind])
        if "end" in self.legend:
            ax.plot(*line[-1], **STYLES["end"])
        ax.plot(*line[0], **STYLES["start"])
        ax.set_xlabel(f"{panel.labels[page.across]} ({ruler.symbol})", labelpad=2)
        ax.set_ylabel(f"height above\nstart ({unit.symbol})")
        ax.yaxis.set_label_coords(-0.48 / width, 0.5)
        if level:
            ax.set_ylim(-self.facts.radius / unit.scale, self.facts.radius / unit.scale)
        ax.margins(y=0.15)
        ax.locator_params(axis="y", nbins=4)


def _units(panels: list[Panel]) -> dict[str, Unit]:
    """One unit for the sheet, unless its maps differ so much in size that each needs its own."""
    sizes = {panel.name: _size(panel) for panel in panels}
    if max(sizes.values()) <= 50 * min(sizes.values()):
        return dict.fromkeys(sizes, unit_for(max(sizes.values()), "length"))
    return {name: unit_for(size, "length") for name, size in sizes.items()}


def _size(panel: Panel) -> float:
    largest = max(abs(edge) for edge in (*panel.low, *panel.high))
    return largest if largest < 20 * max(panel.span) else max(panel.span)


def _instants(panels: list[Panel]) -> tuple[float, Array, str]:
    """Choose round instants to mark: a dozen over what is shown, or over a turn that repeats."""
    panel = next((panel for panel in panels if not panel.at_rest), panels[0])
    start = float(panel.time[0])
    duration = (panel.until or float(panel.time[-1])) - start
    if duration <= 0.0:
        return 0.0, np.zeros(0), ""
    if panel.repeats:
        duration /= panel.turns
    unit = unit_for(duration, "time")
    step = round_step(duration / unit.scale, 20) * unit.scale
    count = math.floor(duration / step * (1 - 1e-9))
    instants = start + step * np.arange(1.0, 1.0 + count, dtype=np.float64)
    return step, instants, ", first turn" if panel.repeats else ""


def fitted(panel: Panel, place: Place, *, signs: bool) -> Panel:
    """Widen a view to the shape of its place; in a wide one, leave the room at the top, for the signs."""
    scale = max(panel.span[0] / place.width, panel.span[1] / place.height)
    middle = (np.array(panel.low) + np.array(panel.high)) / 2
    half = np.array([place.width, place.height]) * scale / 2
    if signs and place.width > 1.6 * place.height:
        middle[1] += panel.page.up_sign * 0.8 * (half[1] - panel.span[1] / 2)
    return replace(panel, low=tuple(middle - half), high=tuple(middle + half))


def crosses(panel: Panel, radius: float) -> bool:
    """Whether some of a circle about the axis lies in the view."""
    nearest = np.clip(0.0, panel.low, panel.high)
    farthest = np.maximum(np.abs(panel.low), np.abs(panel.high))
    return bool(np.hypot(*nearest) <= radius <= np.hypot(*farthest))


def _emptiest(panel: Panel, place: Place, width: float, corners_only: bool) -> tuple[float, bool]:
    """Find room for signs: the left edge, inches, of the emptiest stretch along the top (True) or foot."""
    signs = np.array([panel.page.across_sign, panel.page.up_sign])
    crowd = [panel.path[:: max(1, len(panel.path) // 4000)], np.zeros((1, 2))]
    if panel.guide is not None:
        ends = panel.page.order(panel.guide[[0, -1]])
        crowd.append(ends[0] + np.linspace(0.0, 1.0, 200)[:, None] * (ends[1] - ends[0]))
    share = (np.vstack(crowd) - panel.low) / panel.span
    inches = np.where(signs > 0, share, 1.0 - share) * (place.width, place.height)
    room = place.width - width
    lefts = [room, 0.0] if corners_only else [room, 0.0, *(room * (1.0 - np.arange(1, 20) / 20))]

    def taken(slot: tuple[float, bool]) -> int:
        left, top = slot
        beside = (inches[:, 0] > left - 0.1) & (inches[:, 0] < left + width + 0.1)
        y = place.height - inches[:, 1] if top else inches[:, 1]
        return int(np.sum(beside & (y > 0.0) & (y < 0.65)))

    return min([(left, top) for top in (True, False) for left in lefts], key=taken)
