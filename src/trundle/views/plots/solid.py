"""The view of a surface in space: a light mesh, the track upon it, nothing else that is not needed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped]

from .ground import Window, patches
from .marks import STYLES
from .scales import Array
from .sheet import BLUE, GREY

ELEVATION, AZIMUTH = 28.0, -62.0  # degrees: of the eye over the level, and round the vertical


@dataclass(frozen=True)
class Track:
    """What is drawn in space, all in the support's own frame, m."""

    line: Array  # (n, 3): the contact; in flight the centre
    normal: Array  # (n, 3): from the support into the body
    flying: Any  # (n,) bool
    slipping: Any  # (n,) bool
    marks: dict[str, Array]  # kind of mark -> (k, 3)


def draw(ax: Any, surface: Any, window: Window, track: Track, tilt: float, names: tuple[str, str, str]) -> None:
    """Draw the view."""
    c, s = np.cos(tilt), np.sin(tilt)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    quads = patches(surface, window) @ turn.T
    line, normal = track.line @ turn.T, track.normal @ turn.T
    ax.view_init(ELEVATION, AZIMUTH)
    ax.set_axis_off()
    ax.set_proj_type("ortho")
    ax.computed_zorder = False
    eye = np.cross(*_page())
    if len(quads):
        ax.add_collection3d(_mesh(quads))
    front = normal @ eye > 0
    on = ~track.flying
    for chosen, style in (
        (on & front, STYLES["path"]),
        (on & ~front, {"color": BLUE, "lw": 1.0, "alpha": 0.55, "zorder": 3.9}),
        (track.flying, STYLES["flight"]),
        (track.slipping & on, STYLES["slipping"] | {"lw": 4.5}),
    ):
        ax.plot(*(line * np.where(_wide(chosen), 1.0, np.nan)[:, None]).T, **style)
    for kind, places in track.marks.items():
        if len(places):
            ax.plot(*(places @ turn.T).T, **STYLES[kind])
    points = np.vstack([quads.reshape(-1, 3), line[np.all(np.isfinite(line), axis=1)]])
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    span = np.maximum(high - low, 0.02 * float(np.max(high - low)))
    for set_limits, middle, extent in zip((ax.set_xlim, ax.set_ylim, ax.set_zlim), (low + high) / 2, span, strict=True):
        set_limits(middle - extent / 2, middle + extent / 2)
    ax.set_box_aspect(span, zoom=_zoom(points, span))
    _axes(ax, names)


def _page() -> tuple[Array, Array]:
    """Return the directions in space that run across the page and up it."""
    up, round_ = np.radians(ELEVATION), np.radians(AZIMUTH)
    right = np.array([-np.sin(round_), np.cos(round_), 0.0])
    return right, np.array([-np.sin(up) * np.cos(round_), -np.sin(up) * np.sin(round_), np.cos(up)])


def _wide(chosen: Any) -> Any:
    """Take one more sample at each end, so that pieces of a line meet."""
    wide = np.array(chosen)
    wide[1:] |= chosen[:-1]
    return wide


def _zoom(points: Array, span: Array) -> float:
    """Fill the panel with what is seen of the points: matplotlib leaves room for ticks."""
    right, above = _page()
    seen = max(float(np.ptp(points @ right)), float(np.ptp(points @ above)))
    return 0.92 * float(np.linalg.norm(span)) / seen


def _mesh(quads: Array) -> Poly3DCollection:
    """Return the mesh, shaded from above so that its shape is seen, and translucent."""
    across = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    facing = np.abs(across / np.where(length > 0.0, length, 1.0) @ np.array([-0.35, -0.25, 0.9]))
    shade = np.clip(0.72 + 0.24 * facing, 0.0, 1.0)
    colours = np.column_stack([shade, shade, 0.985 * shade, np.full(len(shade), 0.55)])
    return Poly3DCollection(quads, facecolors=colours, edgecolors=(0.45, 0.45, 0.45, 0.22), linewidths=0.3, zorder=1)


def _axes(ax: Any, names: tuple[str, str, str]) -> None:
    """Draw three short axes in a corner instead of walls with ticks."""
    right, above = _page()
    box = ax.get_position().bounds
    inches = np.array(ax.figure.get_size_inches()) * box[2:]
    corner = np.array([0.62, 0.42]) / inches
    style = {"arrowstyle": "-|>,head_length=0.3,head_width=0.15", "color": GREY, "lw": 1.0, "shrinkA": 0, "shrinkB": 0}
    for axis, name in zip(np.eye(3), names, strict=True):
        way = np.array([right @ axis, above @ axis])
        head, word = corner + 0.36 * way / inches, corner + 0.5 * way / inches
        ax.annotate("", tuple(head), tuple(corner), "axes fraction", "axes fraction", arrowprops=style)
        ax.text2D(*word, name, transform=ax.transAxes, color=GREY, fontsize=8.5, ha="center", va="center")
