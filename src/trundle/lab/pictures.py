"""A small picture of a scenario, drawn as lines from its scene: support, path, and the body at both ends of it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ..views.scene import Scene

Array = NDArray[np.float64]
WIDTH, HEIGHT = 240.0, 150.0
SAMPLES = 240
_MARGIN = 10.0
_WIDER = 1.6  # how much more than path and body a picture shows, where the support is that large
_AT_LEAST = 0.3  # of the support, where the body hardly moves
_ACROSS, _ABOVE = math.radians(-62.0), math.radians(38.0)  # from where it is seen
# Of a strength that both a light and a dark page bear.
_STYLE = (
    ".s{fill:#8b8f94;fill-opacity:.22;stroke:#8b8f94;stroke-width:1.2}"
    ".p{fill:none;stroke:#2a86c0;stroke-width:2.2;stroke-linejoin:round;stroke-linecap:round}"
    ".b{fill:#e69f00;stroke:#8a5a00;stroke-width:1}"
    ".f{fill:none;stroke:#b37c00;stroke-width:1.2;stroke-dasharray:3 2}"
)


def picture(scene: Scene) -> str:
    """Return a scene as SVG.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.views.scene import scene_of
    >>> picture(scene_of(tr.Scenario.load("level-turntable-nudged").run(), SAMPLES))[:4]
    '<svg'
    """
    turn = _rotation(scene.header["to_world"])
    columns = {name: scene.columns[name].astype(float) for name in ("position", "orientation", "body_vertices")}
    path = _seen(columns["position"] @ turn.T)
    bodies = [_outline(_seen(_posed(columns, at) @ turn.T)) for at in (0, -1)]
    ground = _outline(_seen(scene.columns["support_vertices"].astype(float) @ turn.T))
    low, high = _window([path, *bodies], ground)
    scale = min((WIDTH - 2 * _MARGIN) / (high[0] - low[0]), (HEIGHT - 2 * _MARGIN) / (high[1] - low[1]))
    middle = 0.5 * (low + high)

    def drawn(points: Array, kind: str, closed: bool = True) -> str:
        at = (points - middle) * (scale, -scale) + (0.5 * WIDTH, 0.5 * HEIGHT)
        text = " ".join(f"{x:.1f},{y:.1f}" for x, y in np.clip(at, -2000.0, 2000.0))
        return f'<poly{"gon" if closed else "line"} class="{kind}" points="{text}"/>'

    start, end = bodies
    parts = [drawn(ground, "s"), drawn(path, "p", closed=False), drawn(start, "f"), drawn(end, "b")]
    box = f'viewBox="0 0 {WIDTH:g} {HEIGHT:g}" width="{WIDTH:g}" height="{HEIGHT:g}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {box}><style>{_STYLE}</style>{"".join(parts)}</svg>'


def _rotation(quaternion: Iterable[float]) -> Array:
    """Return the matrix of a unit quaternion."""
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _posed(columns: dict[str, Array], at: int) -> Array:
    """Return where the vertices of the body are at a sample."""
    return columns["position"][at] + columns["body_vertices"] @ _rotation(columns["orientation"][at]).T


def _seen(points: Array) -> Array:
    """Return points of the room as they are seen from far away."""
    x, y, z = points.T
    away = math.cos(_ACROSS) * x + math.sin(_ACROSS) * y
    return np.column_stack(
        [-math.sin(_ACROSS) * x + math.cos(_ACROSS) * y, math.cos(_ABOVE) * z - math.sin(_ABOVE) * away]
    )


def _outline(points: Array) -> Array:
    """Return the convex outline of points; of those on one line, the line."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return points[ConvexHull(points).vertices]
    except QhullError:
        return points[[points[:, 0].argmin(), points[:, 0].argmax()]]


def _window(shown: list[Array], ground: Array) -> tuple[Array, Array]:
    """Return the corners of what is shown: all of path and body, and of the support as much as there is room for."""
    points = np.concatenate(shown)
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * (high - low).max()
    reach = max(_WIDER * half, _AT_LEAST * np.ptp(ground, axis=0).max())
    low = np.minimum(low, np.maximum(ground.min(axis=0), middle - reach))
    high = np.maximum(high, np.minimum(ground.max(axis=0), middle + reach))
    return low, np.maximum(high, low + 1e-9)
