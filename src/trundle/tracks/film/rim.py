"""The rim of the table in a picture: its ellipse, found to a small part of a pixel."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError
from .container import Picture
from .pinhole import Array

_RAYS = 360
_LEAST_AREA = 0.03  # of the picture
_REACH = 0.05  # of the ellipse: how far from it an edge is looked for
_ON_IT = 1.5  # px from the ellipse, within which an edge belongs to it
_LEAST_EDGES = 0.6  # of all rays
_SIDE = 3.0  # px to either side of an edge, where its blur is over
_LEAST_STEP = 3.0  # grey levels a pixel


def find_rim(picture: Picture) -> Array:
    """Return points (n, 2) of the outermost large ellipse in a picture, px.

    Raises
    ------
    InvalidValueError
        If there is none.

    Examples
    --------
    >>> y, x = np.mgrid[:120, :160]
    >>> disc = np.where((x - 80.3) ** 2 + (y - 60.0) ** 2 < 50**2, 200, 40).astype(np.uint8)
    >>> edges = find_rim(np.repeat(disc[:, :, None], 3, axis=2))
    >>> bool(np.abs(np.hypot(*(edges - (80.3, 60.0)).T) - 50).mean() < 0.4)
    True
    """
    best: tuple[float, Array] | None = None
    for ellipse in _ellipses(picture):
        found = _refined(picture, ellipse)
        if found is not None and (best is None or found[0] > best[0]):
            best = found
    if best is None:
        remedy = "Film the whole rim against a ground of another colour, or give four marks instead."
        raise InvalidValueError(
            "rim_radius", "must be of a rim that can be seen whole", "a film in which none is found", remedy
        )
    return best[1]


def _ellipses(picture: Picture) -> list[Any]:
    """Return the ellipses of large connected regions, light or dark in some colour."""
    import cv2

    soft = cv2.GaussianBlur(picture, (0, 0), 1.5)
    planes = [cv2.cvtColor(soft, cv2.COLOR_BGR2GRAY), cv2.cvtColor(soft, cv2.COLOR_BGR2HSV)[:, :, 1], *cv2.split(soft)]
    height, width = picture.shape[:2]
    found = []
    for plane in planes:
        _, mask = cv2.threshold(plane, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
        for side in (mask, 255 - mask):
            for contour in cv2.findContours(side, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]:
                hull = cv2.convexHull(contour)
                if len(hull) < 8 or cv2.contourArea(hull) < _LEAST_AREA * width * height:
                    continue
                if np.any(np.array(cv2.boundingRect(hull)[2:]) < (width, height)):
                    found.append(cv2.fitEllipse(hull))
    return found


def _refined(picture: Picture, ellipse: Any) -> tuple[float, Array] | None:
    """Return the size of an ellipse and the edges along it; None where they are too few."""
    import cv2

    for reach in (_REACH, _REACH / 2):
        (x, y), (long, short), degrees = ellipse
        if not np.isfinite([x, y, long, short]).all() or min(long, short) < 10:
            return None
        turn = np.deg2rad(degrees)
        ray = 2 * np.pi * np.arange(_RAYS) / _RAYS
        axes: Array = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
        on = np.column_stack([long / 2 * np.cos(ray), short / 2 * np.sin(ray)]) @ axes + (x, y)
        across = np.column_stack([np.cos(ray) / long, np.sin(ray) / short]) @ axes
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        edges, strong = _edges(picture, on, across, max(reach * short, 4.0))
        if strong.sum() < _LEAST_EDGES * _RAYS:
            return None
        kept = edges[strong]
        for _ in range(2):
            ellipse = cv2.fitEllipseDirect(kept.astype(np.float32)[:, None])
            near = _off(ellipse, edges) < _ON_IT
            kept = edges[strong & near]
            if len(kept) < _LEAST_EDGES * _RAYS:
                return None
    return float(ellipse[1][0] * ellipse[1][1]), kept


def _off(ellipse: Any, points: Array) -> Array:
    """Return how far points are from an ellipse, px, to first order."""
    (x, y), (long, short), degrees = ellipse
    turn = np.deg2rad(degrees)
    along = (points - (x, y)) @ np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    scaled = along / (0.5 * np.array([long, short]))
    size = np.linalg.norm(scaled, axis=1)
    slope = np.linalg.norm(scaled / (0.5 * np.array([long, short])), axis=1) / np.maximum(size, 1e-9)
    return np.asarray(np.abs(size - 1) / np.maximum(slope, 1e-9))


def _edges(picture: Picture, on: Array, across: Array, reach: float) -> tuple[Array, NDArray[np.bool_]]:
    """Return the steepest step of grey across a curve at each of its points, px, and whether it is one."""
    import cv2

    step = 0.25
    offsets = np.arange(-reach, reach + step, step)
    places = on[:, None] + offsets[None, :, None] * across[:, None]
    soft = cv2.GaussianBlur(picture, (0, 0), 0.8)
    seen = cv2.remap(
        soft, *np.moveaxis(places.astype(np.float32), 2, 0), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    span = 4  # samples: one pixel
    change = np.linalg.norm(seen[:, 2 * span :].astype(float) - seen[:, : -2 * span], axis=2) / (2 * span * step)
    peak = change.argmax(axis=1)
    rows = np.arange(len(on))[:, None]
    at = change[rows[:, 0], peak]
    # Where a sharp edge would have to be for the same sum of colours from one side of the blurred one to the other.
    half = round(_SIDE / step)
    middle = np.clip(peak + span, half, len(offsets) - 1 - half)
    near = seen[rows, middle[:, None] + np.arange(-half, half + 1)].astype(float)
    inner, outer = (near[:, part].mean(axis=1) for part in (slice(None, span), slice(-span, None)))
    towards = inner - outer
    share = np.einsum("ijk,ik->ij", near - outer[:, None], towards) / np.maximum((towards**2).sum(axis=1), 1.0)[:, None]
    offset = offsets[middle - half] - step / 2 + step * share.sum(axis=1)
    whole = (np.abs(offset - offsets[middle]) < 1.5) & (peak + span == middle)
    height, width = picture.shape[:2]
    edges = on + offset[:, None] * across
    inside = ((edges > 1) & (edges < np.array([width, height]) - 2)).all(axis=1)
    return edges, inside & whole & (at > _LEAST_STEP)
