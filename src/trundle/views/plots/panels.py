"""What each map of the sheet shows: the line to draw, the window on it, how the plane lies on the page."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from trundle.wording import with_unit

from .events import FLIGHT, SLIPPING, part_in, with_events
from .facts import NOTHING, Facts, guiding_centre, turns_in
from .marks import Page
from .scales import LONG_LINE, Array, refined

if TYPE_CHECKING:
    from trundle.simulation.trajectory import Trajectory

FEWEST_A_TURN = 5  # samples; with fewer, no honest line can be drawn through them
SMOOTH_A_TURN = 60  # vertices; coarser lines are rounded off
MANY_TURNS = 15  # beyond it lines thin out, and the first turn is drawn bold
ELONGATED = 10.0  # length to breadth beyond which the first map shows the first turns only
CROWDED = 0.6  # share of the path's box that its line fills, beyond which it is no line any more


@dataclass(frozen=True)
class Panel:
    """One map; all lengths in m, all points in the order x, y."""

    name: str
    title: str
    labels: tuple[str, str]  # of x and of y
    page: Page
    samples: Array  # (n, 3)
    velocity: Array  # (n, 3), m/s
    time: Array  # (m,), of the line's vertices
    line: Array  # (m, 3)
    guide: Array | None  # (n, 2)
    turns: float
    at_rest: bool
    sparse: bool  # too few samples a turn for a line
    sampled: Array  # (n,), s
    contact: Array | None = None  # (n, 2), of the samples; NaN in flight
    until: float | None = None  # the time up to which it is shown; None: all of it
    low: tuple[float, float] = (0.0, 0.0)  # the view, (across, up)
    high: tuple[float, float] = (0.0, 0.0)

    @property
    def span(self) -> tuple[float, float]:
        """Width and height of the view, m."""
        return self.high[0] - self.low[0], self.high[1] - self.low[1]

    @property
    def shown(self) -> slice:
        """The part of the line that is shown."""
        if self.until is None:
            return slice(None)
        return slice(0, max(2, int(np.searchsorted(self.time, self.until, side="right"))))

    @property
    def path(self) -> Array:
        """The shown part of the line as (across, up)."""
        return self.page.order(self.line[self.shown])

    @property
    def touched(self) -> Array | None:
        """The shown part of the track of the contact as (across, up), where it can be drawn as a line."""
        if self.contact is None or self.sparse or not np.any(np.isfinite(self.contact)):
            return None
        until = math.inf if self.until is None else self.until
        return self.page.order(self.contact[: max(2, int(np.searchsorted(self.sampled, until, side="right")))])

    @property
    def track(self) -> Array | None:
        """First and last place of the guiding centre as (across, up), if any of the way between is in the view."""
        if self.guide is None:
            return None
        ends = self.page.order(self.guide[[0, -1]])
        along = ends[0] + np.linspace(0.0, 1.0, 2001)[:, None] * (ends[1] - ends[0])
        return ends if np.any(np.all((along >= self.low) & (along <= self.high), axis=1)) else None

    @property
    def repeats(self) -> bool:
        """Whether the last turn lies upon the first."""
        if self.turns <= 1.2 or self.until is not None:
            return False
        count = self._turn
        first, last = self.line[:count, :2], self.line[-count:, :2]
        near = 0.03 * float(np.max(np.ptp(first, axis=0)))
        return bool(
            np.all(np.abs(np.min(first, axis=0) - np.min(last, axis=0)) < near)
            and np.all(np.abs(np.max(first, axis=0) - np.max(last, axis=0)) < near)
        )

    @property
    def first_turn(self) -> Array | None:
        """The first of many turns, where it is large enough to see and the others do not lie upon it."""
        if self.turns <= MANY_TURNS or self.until is not None or self.repeats:
            return None
        first = self.page.order(self.line[: self._turn])
        return first if np.max(np.ptp(first, axis=0)) > 0.08 * np.max(np.ptp(self.path, axis=0)) else None

    @property
    def _turn(self) -> int:
        return max(2, math.ceil(len(self.line) / self.turns) + 1)


def panels_of(run: Trajectory, facts: Facts) -> list[Panel]:
    """Return the maps that tell something about a run, with their views chosen."""
    plain = not facts.curved
    walled = plain and facts.wall is not None
    names = ["support"] + ["world"] * (facts.tilted and plain and not walled)
    names += ["corotating"] * (facts.moving and not walled)
    run = with_events(run)
    time = np.asarray(run.data["time"].values, dtype=float)
    panels = [_panel(run, facts, name, time) for name in names]
    if len(panels) == 2 and np.allclose(panels[0].samples[:, :2], panels[1].samples[:, :2], rtol=0, atol=1e-9):
        panels = panels[:1]  # shaken up and down: from above there is nothing to tell apart
    return [_viewed(_rounded(panel), facts) for panel in (_windowed(panels, facts) if plain else panels)]


def _panel(run: Trajectory, facts: Facts, name: str, time: Array) -> Panel:
    inertial = "Support frame" if facts.tilted else "Support and world frame"
    titles = {
        "support": "Along the cylinder's axis" if facts.wall is not None else inertial,
        "world": "World frame, from above",
        "corotating": "Corotating frame" if facts.turning and facts.stays else f"Seen from the {facts.ground}",
    }
    if facts.curved and facts.wall is None:
        titles["support"] += ", from above"
    labels = {
        "support": ("x, down" if facts.wall else "x, down the slope", "y, level") if facts.tilted else ("x", "y"),
        "world": ("X, level, downhill", "Y, level"),
        "corotating": (f"x′, on the {facts.ground}", f"y′, on the {facts.ground}"),
    }
    data = run.in_frame(name).data
    samples = np.asarray(data["position"].values, dtype=float)
    velocity = np.asarray(data["velocity"].values, dtype=float)
    at_rest = bool(np.all(np.ptp(samples[:, :2], axis=0) <= NOTHING * max(np.max(np.abs(samples)), 1e-300)))
    turns = 0.0 if at_rest else turns_in(time, velocity[:, :2])
    if name == "corotating" and not at_rest:
        turns = max(turns, abs(facts.rate) * float(time[-1] - time[0]) / (2 * math.pi) - 1.0)
    return Panel(
        name,
        titles[name],
        labels[name],
        _page(facts, samples),
        samples,
        velocity,
        time,
        samples,
        _guide(run, facts, name, time),
        turns,
        at_rest,
        sparse=turns * FEWEST_A_TURN > len(samples),
        sampled=time,
        contact=_contact(data, facts, time) if facts.off_centre else None,
    )


def _page(facts: Facts, samples: Array) -> Page:
    """Let the slope fall towards the reader, and a flight along the second axis go across the page."""
    if not facts.tilted and facts.flies and np.ptp(samples[:, 1]) > 1.5 * np.ptp(samples[:, 0]):
        return Page(across=1, across_sign=1, up_sign=-1)
    return Page.downhill_down(facts.tilt)


def _contact(data: Any, facts: Facts, time: Array) -> Array:
    """Return where the body touches, NaN where it does not."""
    points = np.array(data["contact"].values[:, :2], dtype=float)
    points[part_in(facts.stretches, FLIGHT, time)] = np.nan
    return points


def _guide(run: Trajectory, facts: Facts, name: str, time: Array) -> Array | None:
    guide = guiding_centre(run, time) if name != "corotating" else None
    if guide is None or name == "support":
        return guide
    c, s = math.cos(facts.tilt), math.sin(facts.tilt)
    return np.column_stack([guide[:, 0] * c + facts.radius * s, guide[:, 1]])


def _windowed(panels: list[Panel], facts: Facts) -> list[Panel]:
    """Show only the first turns of what would be a hairline or a blot; the world map always shows all."""
    first, *others = panels
    extent = np.sort(np.ptp(first.line[:, :2], axis=0))
    longest = ELONGATED if any(panel.name == "world" for panel in others) else 5 * ELONGATED
    if facts.rim is None and others and first.turns > 3 and extent[1] > longest * extent[0]:
        turns = min(max(2.1, 5 * extent[0] / extent[1] * first.turns), 8.0)
        first = replace(first, until=float(first.time[0] + turns / first.turns * (first.time[-1] - first.time[0])))
    return [first] + [_uncrowded(panel, first.until) for panel in others]


def _uncrowded(panel: Panel, until: float | None) -> Panel:
    if panel.name == "world" or panel.turns < 15 or panel.sparse:
        return panel
    line = _rounded(panel).line
    path = line[:: max(1, len(line) // 200_000), :2]
    cells = np.floor(90 * (path - np.min(path, axis=0)) / np.max(np.ptp(path, axis=0))).astype(int)
    if len(np.unique(cells @ [1000, 1])) < CROWDED * math.pi / 4 * 90 * 90:
        return panel
    duration = float(panel.time[-1] - panel.time[0])
    twelve = float(panel.time[0]) + 12 / panel.turns * duration
    return replace(panel, until=twelve if until is None else min(until, twelve))


def _rounded(panel: Panel) -> Panel:
    """Round off the line, in what is shown of it, where few samples make a turn."""
    parts = min(12, math.ceil(panel.turns * SMOOTH_A_TURN / len(panel.samples)))
    shown = panel.shown
    time = panel.time[shown]
    if panel.sparse or parts < 2 or len(time) * parts > 2 * LONG_LINE:
        return panel
    line = refined(time, panel.samples[shown], panel.velocity[shown], parts)
    fine = np.interp(np.arange(len(line)) / parts, np.arange(len(time)), time)
    return replace(panel, time=fine, line=line)


def _viewed(panel: Panel, facts: Facts) -> Panel:
    """Choose what a map must show: the path, and table, axis and guiding centre where they are near."""
    path = panel.path
    low, high = np.min(path, axis=0), np.max(path, axis=0)
    span = float(np.max(high - low))
    shown = [low, high]
    reach = float(np.max(np.hypot(path[:, 0], path[:, 1])))
    if panel.touched is not None and np.any(np.isfinite(panel.touched)):
        shown += [np.nanmin(panel.touched, axis=0), np.nanmax(panel.touched, axis=0)]
    if facts.wall is not None:
        shown += [np.full(2, -facts.wall), np.full(2, facts.wall)]
        shown += [low - 1.2 * facts.radius, high + 1.2 * facts.radius]
    elif facts.outline is not None and at_home(panel, facts) and _is_near(facts, panel, span, reach):
        shown += [np.full(2, -facts.outline), np.full(2, facts.outline)]
    elif panel.at_rest:
        shown += [low - 2.0 * facts.radius, high + 2.0 * facts.radius]
    if panel.at_rest or float(np.max(np.abs((low + high) / 2))) <= 2.0 * span:
        shown.append(np.zeros(2))
    if panel.guide is not None:
        guide = panel.page.order(panel.guide)
        margin = 0.0 if panel.until is not None else span / 2
        near = np.all((guide >= low - margin) & (guide <= high + margin), axis=1)
        shown += [np.min(guide[near], axis=0), np.max(guide[near], axis=0)] if np.any(near) else []
    low, high = np.min(shown, axis=0), np.max(shown, axis=0)
    pad = 0.07 * max(float(np.max(high - low)), 1e-300)
    return replace(panel, low=tuple(low - pad), high=tuple(high + pad))


def at_home(panel: Panel, facts: Facts) -> bool:
    """Tell whether the support is seen at rest in a map, or at least covers the same places all the time."""
    return facts.fixed or panel.name == "corotating"


def _is_near(facts: Facts, panel: Panel, span: float, reach: float) -> bool:
    """Tell whether the edge of the support belongs in the view: a rim does even where it is somewhat far."""
    edge = facts.outline or math.inf
    return reach > 0.8 * edge or (facts.rim is not None and (panel.at_rest or span > edge / 5))


def until_text(panel: Panel) -> str:
    """Return the title of a map, with the time up to which it is shown."""
    if panel.until is None:
        return panel.title
    return f"{panel.title}, first {with_unit(panel.until - float(panel.time[0]), 'time', 2)}"


def phases_of(panel: Panel, facts: Facts) -> tuple[Array, Array | None, Array | None]:
    """Return for touching, flight and slipping what to multiply the shown line with: 1 within, NaN without.

    Flight and slipping are None where there is none.
    """
    time = panel.time[panel.shown]
    found: list[Array | None] = []
    for phase in (FLIGHT, SLIPPING):
        inside = part_in(facts.stretches, phase, time)
        found.append(np.where(inside, 1.0, np.nan) if np.any(inside) else None)
    flying, slipping = found
    touching = np.ones(len(time))
    if flying is not None:
        others = {stretch.phase for stretch in facts.stretches} - {FLIGHT}
        parts = [part_in(facts.stretches, phase, time) for phase in others]
        touching = np.where(np.any(parts, axis=0), 1.0, np.nan) if parts else np.full(len(time), np.nan)
    return touching, flying, slipping
