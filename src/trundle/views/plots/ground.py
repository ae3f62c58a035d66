"""The surface that is rolled on, as figures show it: its outline in a plane, its heights, patches of a light mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from trundle.mechanics.algebra import Vector
from trundle.mechanics.surfaces import Surface

from .scales import Array

_CELLS = 320  # of the grid on which outlines are looked for
_AROUND = 60  # parts of a full turn in the mesh
_ALONG = 22  # parts of an outline, or of a side of a field, in the mesh


@dataclass(frozen=True)
class Window:
    """The box, in the support's own frame, in which the surface is shown, m."""

    low: Array  # (3,)
    high: Array  # (3,)
    reach: float  # largest distance from the axis


def window_of(surface: Surface, places: Array, size: float) -> Window:
    """Choose how much of a surface to show: what the body saw of it, and a little more, all up to a near rim."""
    low, high = np.min(places, axis=0), np.max(places, axis=0)
    reach = float(np.max(np.hypot(places[:, 0], places[:, 1])))
    extent = max(float(np.max(high - low)), 2 * size)
    if surface.axisymmetric:
        reach = _whole(surface, 1.12 * reach + 0.3 * size)
        low[:2], high[:2] = -reach, reach
        pad = max(0.25 * extent, 2 * size, 0.35 * reach)
    else:
        middle, half = (low + high)[:2] / 2, max(0.62 * float(np.max((high - low)[:2])), 3 * size)
        low[:2], high[:2] = middle - half, middle + half
        grid = getattr(surface, "grid", None)
        if grid is not None:  # a table ends where its numbers do
            ends = np.array([[axis[0], axis[-1]] for axis in grid.axes])
            low[:2], high[:2] = np.maximum(low[:2], ends[:, 0]), np.minimum(high[:2], ends[:, 1])
        pad = max(0.5 * extent, 2 * size)
    low[2], high[2] = low[2] - pad, high[2] + pad
    if surface.axisymmetric and tuple(surface.coordinates) == ("length", "length"):
        with np.errstate(all="ignore"):
            z = np.asarray(surface.point(np.linspace(0.0, reach, 200), np.zeros(200)).z, dtype=float)
        z = z[np.abs(z - places[0, 2]) < 1.5 * reach]  # not all the way down a steep funnel
        low[2], high[2] = min(low[2], *z), max(high[2], *z)
    if len(surface.outline) > 1:  # a tube round a hole: all of its section
        tube = 0.5 * float(surface.outline[0] - surface.outline[1])
        low[2], high[2] = -1.03 * tube, 1.03 * tube
    return Window(low, high, reach)


def _whole(surface: Surface, reach: float) -> float:
    """Return how far to show a surface of revolution: to its edge, if that is not far away."""
    for edge in (*surface.outline[:1], getattr(surface, "radius", None)):
        if edge is not None and float(edge) > 0 and reach <= 1.15 * float(edge) <= 2.5 * reach:
            return 1.02 * float(edge)
        if edge is not None and float(edge) > 0 and float(edge) < reach:
            return 1.05 * reach
    return reach


def levels_at(surface: Surface, x: Any, y: Any, z: Any) -> Array:
    """Return the level function at points, NaN where the surface has ended."""
    x, y, z = np.broadcast_arrays(np.asarray(x, dtype=float), y, z)
    p = Vector(x, y, z)
    with np.errstate(all="ignore"):
        level = np.array(np.broadcast_to(surface.level(p), x.shape), dtype=float)
        inside = surface.domain_margin(p)
        if inside is not None:
            level[~(np.broadcast_to(inside, x.shape) >= 0)] = np.nan
        if surface.rim is not None:
            level[np.hypot(x, y) > float(surface.rim)] = np.nan
    return level


def meridians(surface: Surface, window: Window) -> list[Array]:
    """Return the lines in which the half plane of the first axis cuts a surface of revolution."""
    r = np.linspace(0.0, window.reach, _CELLS)
    z = np.linspace(window.low[2], window.high[2], _CELLS)
    R, Z = np.meshgrid(r, z)
    return _zero_lines(r, z, levels_at(surface, R, 0.0, Z))


def sections(surface: Surface, window: Window, count: int = 7) -> list[Array]:
    """Return the lines in which planes across the second axis cut a surface."""
    x = np.linspace(window.low[0], window.high[0], _CELLS // 2)
    z = np.linspace(window.low[2], window.high[2], _CELLS // 2)
    X, Z = np.meshgrid(x, z)
    cuts = np.linspace(window.low[1], window.high[1], count + 2)[1:-1]
    return [line for y in cuts for line in _zero_lines(x, z, levels_at(surface, X, y, Z))]


def _zero_lines(across: Array, up: Array, level: Array) -> list[Array]:
    from contourpy import contour_generator

    lines = contour_generator(across, up, np.ma.masked_invalid(level)).lines(0.0)
    found = [np.asarray(line, dtype=float) for line in lines]
    return [line for line in found if len(line) > 2]


def heights(surface: Surface, window: Window, cells: int = 160) -> tuple[Array, Array, Array] | None:
    """Return the heights of a surface over a grid, NaN where there is none; None of one that is no height field."""
    if tuple(surface.coordinates) != ("length", "length"):
        return None
    x = np.linspace(window.low[0], window.high[0], cells)
    y = np.linspace(window.low[1], window.high[1], cells)
    X, Y = np.meshgrid(x, y)
    with np.errstate(all="ignore"):
        z = np.array(np.broadcast_to(surface.point(X, Y).z, X.shape), dtype=float)
    z[~np.isfinite(levels_at(surface, X, Y, np.where(np.isfinite(z), z, 0.0)))] = np.nan
    return x, y, z


def patches(surface: Surface, window: Window) -> Array:
    """Return the quadrangles of a light mesh of a surface."""
    if surface.axisymmetric:
        turn = np.linspace(0.0, 2 * np.pi, _AROUND + 1)
        grids = []
        for line in meridians(surface, window):
            along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
            at = np.linspace(0.0, along[-1], _ALONG + 1)
            r, z = np.interp(at, along, line[:, 0]), np.interp(at, along, line[:, 1])
            shape = (len(r), len(turn))
            x, y = np.outer(r, np.cos(turn)), np.outer(r, np.sin(turn))
            grids.append(np.stack([x, y, np.broadcast_to(z[:, None], shape)], axis=-1))
    else:
        field = heights(surface, window, 2 * _ALONG + 1)
        if field is None:
            return np.zeros((0, 4, 3))
        x, y, z = field
        grids = [np.stack([*np.meshgrid(x, y), z], axis=-1)]
    quads = [
        np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 3)
        for grid in grids
    ]
    every = np.concatenate(quads) if quads else np.zeros((0, 4, 3))
    return every[np.all(np.isfinite(every), axis=(1, 2))]
