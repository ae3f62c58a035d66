"""Where the panels of a sheet go, in inches: set by hand, since a layout engine doubles the time to draw."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

# Room for tick labels and axis label at the left and at the foot, for a map's title, for the sheet's header.
LEFT, FOOT, TITLE, HEADER, GAP, EDGE = 0.86, 0.52, 0.3, 0.72, 0.14, 0.18
STRIP, STRIP_GAP, KEY_LINE = 1.15, 0.16, 0.21
WIDEST = 10.8


class Place(NamedTuple):
    """A box in inches from the sheet's lower left corner."""

    left: float
    bottom: float
    width: float
    height: float


class Key(NamedTuple):
    """A place for a share of the legend: its upper left corner, and how many rows fit."""

    left: float
    top: float
    rows: int


@dataclass(frozen=True)
class Plan:
    """The sheet's size and where its parts go."""

    width: float
    height: float
    maps: list[Place]
    strip: Place | None
    keys: list[Key]


def arrange(maps: list[tuple[str, tuple[float, float]]], under: str | None = None, lines: int = 2) -> Plan:
    """Place the maps: side by side, or, where the path runs across the page, under each other.

    Examples
    --------
    >>> plan = arrange([("support", (1.0, 1.0)), ("corotating", (1.0, 1.0))])
    >>> [place.width == place.height for place in plan.maps], plan.strip
    ([True, True], None)
    """
    shapes = [width / height for _, (width, height) in maps]
    names = [name for name, _ in maps]
    if len(maps) == 1:
        return _row([min(max(shapes[0], 0.7), 3.2)], names, 4.6, under, lines)
    if max(shapes[: len(names) - names.count("corotating")]) > 1.6 and "corotating" in names:
        return _stack(names, under, lines)
    return _row([min(max(shape, 0.6), 1.4) for shape in shapes], names, 4.4, under, lines)


def _row(shapes: list[float], names: list[str], tallest: float, under: str | None, lines: int) -> Plan:
    count = len(shapes)
    furniture = count * LEFT + (count - 1) * GAP + EDGE
    height = min((WIDEST - furniture) / sum(shapes), tallest)
    narrowest = 6.4 if count == 1 else 8.8 if "world" not in names else 7.2  # for title and legend
    shapes = [shape * max(1.0, (narrowest - furniture) / (height * sum(shapes))) for shape in shapes]
    width = furniture + height * sum(shapes)
    beside = under == "world"  # then the legend has room beside the strip
    low = FOOT if beside else FOOT + lines * KEY_LINE + 0.12
    foot = low + (STRIP + STRIP_GAP if under else 0.0) + (0.1 if beside or not under else 0.0)
    maps, left = [], LEFT
    for shape in shapes:
        maps.append(Place(left, foot, height * shape, height))
        left += height * shape + GAP + LEFT
    total = foot + height + TITLE + HEADER
    keys = [Key(LEFT - 0.1, 0.12 + lines * KEY_LINE, lines)]
    if under is None:
        return Plan(width, total, maps, None, keys)
    above = maps[names.index(under)]
    below = Place(above.left, low, above.width, STRIP)
    if beside:
        keys = [Key(place.left - 0.1, foot - FOOT - 0.1, 20) for place in maps if place is not above]
    return Plan(width, total, maps, below, keys)


def _stack(names: list[str], under: str | None, lines: int) -> Plan:
    strip = under is not None
    main = 6.2
    side = WIDEST - main - 2 * LEFT - GAP - EDGE
    rows = len(names) - 1
    each = 1.75 if strip else 2.9
    beside = "world" in names  # then the corotating map leaves room for the legend under it
    low = FOOT + (0.0 if beside else lines * KEY_LINE + 0.12)
    foot = low + (STRIP + STRIP_GAP if strip else 0.1)
    bottoms = [foot + (each + TITLE + (FOOT if strip else 0.0)) * (rows - 1 - i) for i in range(rows)]
    top = bottoms[0] + each
    maps = [Place(LEFT, bottom, main, each) for bottom in bottoms]
    right = LEFT + main + GAP + LEFT
    tall = min(side, top - (low if strip else foot))
    maps.append(Place(right, top - tall, side, tall))
    below = Place(LEFT, low, main, STRIP) if strip else None
    key = Key(right - 0.1, top - tall - FOOT - 0.2, 20) if beside else Key(LEFT - 0.1, 0.12 + lines * KEY_LINE, lines)
    return Plan(WIDEST, top + TITLE + HEADER, maps, below, [key])
