"""Spots of one colour in a picture: how much of each pixel they cover, and where their middle is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError
from .container import Picture
from .pinhole import Array

_HUE = 15.0  # of 180, to either side of a named colour
_PALE, _DIM, _BRIGHT = 60.0, 50.0, 170.0  # saturation and value, of 255
_LEAST_COVER = 0.15  # below which a pixel is noise
SAME_COLOUR = 80.0  # distance of two colours, of 255, that may be one in another light
_BLURRED = 0.8  # px: against noise, before a shape is cut out
_SHAKEN = 4.5  # times the median of differences, which is more than one standard deviation: what is no noise
_LEAST_APART = 12.0  # of 255
_MARGIN = 3  # px around a spot in which its fringe is


@dataclass(frozen=True)
class Spot:
    """A connected region of one colour."""

    # `x`, `y`: its middle, px, to a tenth or better
    x: float
    y: float
    area: float  # how many pixels it covers, fractions counted
    whole: bool  # whether it lies in the picture with all its fringe
    colour: Array  # (3,): its colour, blue, green, red


def colour_of(name: str, key: str) -> Array:
    """Return a colour by its name or as #rrggbb: blue, green, red of 255.

    Examples
    --------
    >>> colour_of("red", "colour").tolist()
    [0.0, 0.0, 255.0]
    """
    from matplotlib.colors import to_rgb

    try:
        red, green, blue = to_rgb(name)
    except ValueError:
        remedy = "Write for instance red, orange, white, or #ff8800."
        raise InvalidValueError(key, "must be the name of a colour", name, remedy) from None
    return np.array([blue, green, red]) * 255.0


def alike(picture: Picture, colour: Array) -> NDArray[np.bool_]:
    """Return which pixels are of about a colour: of its hue, or if it has none as pale and as bright."""
    import cv2

    hsv = cv2.cvtColor(picture, cv2.COLOR_BGR2HSV).astype(np.int16)
    hue, pure, value = (
        float(part) for part in cv2.cvtColor(colour.round().astype(np.uint8)[None, None], cv2.COLOR_BGR2HSV)[0, 0]
    )
    if pure < _PALE:
        pale = hsv[:, :, 1] < 1.5 * _PALE
        if value > _BRIGHT:
            return np.asarray(pale & (hsv[:, :, 2] > _BRIGHT))
        dark = hsv[:, :, 2] < _DIM
        return np.asarray(dark if value < _DIM else pale & (np.abs(hsv[:, :, 2] - value) < 40))
    apart = np.abs((hsv[:, :, 0] - hue + 90) % 180 - 90)
    return np.asarray((apart < _HUE) & (hsv[:, :, 1] > _PALE) & (hsv[:, :, 2] > _DIM))


def differing(picture: Picture, ground: Picture) -> NDArray[np.bool_]:
    """Return which pixels differ from the ground in any colour by more than noise."""
    import cv2

    blue, green, red = cv2.split(cv2.GaussianBlur(cv2.absdiff(picture, ground), (0, 0), _BLURRED))
    apart = cv2.max(cv2.max(blue, green), red)
    return np.asarray(apart > max(float(np.median(apart[::3, ::3])) * _SHAKEN, _LEAST_APART))


def regions(mask: NDArray[np.bool_], least: float, most: float) -> list[tuple[int, int, int, int, int]]:
    """Return connected regions of so many pixels as boxes: x, y, width, height, area."""
    import cv2

    _, _, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    return [tuple(int(part) for part in row) for row in stats[1:] if least <= row[4] <= most]  # type: ignore[misc]


def core_colour(picture: Picture, mask: NDArray[np.bool_], box: tuple[int, ...]) -> Array:
    """Return the colour in the middle half of a region."""
    x, y, width, height = box[:4]
    part = (slice(y + height // 4, y + height - height // 4), slice(x + width // 4, x + width - width // 4))
    inside = picture[part][mask[part]]
    return np.asarray(np.median(inside if len(inside) else picture[part].reshape(-1, 3), axis=0), dtype=float)


def cover(picture: Any, ground: Any, colour: Array) -> Array:
    """Return how much of each pixel is covered by a colour over the ground: 0 to 1, and some noise.

    A pixel at the edge is a mixture, ground + α (colour − ground); of other colours the part along that line counts.
    """
    base = ground.astype(np.float32)
    towards = colour.astype(np.float32) - base
    size = np.einsum("...i,...i->...", towards, towards)
    along = np.einsum("...i,...i->...", picture.astype(np.float32) - base, towards)
    return np.asarray(along / np.maximum(size, 400.0), dtype=float)


def spots(picture: Picture, ground: Picture, colour: Array, least: float, most: float) -> list[Spot]:
    """Return the spots of a colour that cover so many pixels, each with its middle, the largest first."""
    import cv2

    height, width = picture.shape[:2]
    found = []
    for box in regions(differing(picture, ground), 0.4 * least, np.inf):
        left, top = max(box[0] - _MARGIN, 0), max(box[1] - _MARGIN, 0)
        part = (slice(top, box[1] + box[3] + _MARGIN), slice(left, box[0] + box[2] + _MARGIN))
        covered = cover(picture[part], ground[part], colour)
        mask = cv2.GaussianBlur(covered, (0, 0), _BLURRED) > 0.5
        for x, y, w, h, _ in regions(mask, 0.4 * least, 1.5 * most):
            one = _spot(picture[part], covered, mask, (x, y, w, h))
            if least <= one.area <= most and np.linalg.norm(one.colour - colour) < SAME_COLOUR:
                inside = (
                    left + x > _MARGIN
                    and top + y > _MARGIN
                    and left + x + w + _MARGIN < width
                    and top + y + h + _MARGIN < height
                )
                found.append(Spot(one.x + left, one.y + top, one.area, inside, one.colour))
    return sorted(found, key=lambda one: -one.area)


def _spot(picture: Picture, covered: Array, mask: NDArray[np.bool_], box: tuple[int, ...]) -> Spot:
    """Return the middle and the area of a region, with its fringe."""
    x, y, w, h = box
    left, top = max(x - _MARGIN, 0), max(y - _MARGIN, 0)
    share = covered[top : y + h + _MARGIN, left : x + w + _MARGIN]
    share = np.where(share > _LEAST_COVER, np.minimum(share, 1.0), 0.0)
    area = float(share.sum())
    middle_x = float((share.sum(axis=0) * np.arange(left, left + share.shape[1])).sum() / area)
    middle_y = float((share.sum(axis=1) * np.arange(top, top + share.shape[0])).sum() / area)
    return Spot(middle_x, middle_y, area, True, core_colour(picture, mask, box))
