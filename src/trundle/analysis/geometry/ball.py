"""A painted ball, seen from far away: the picture of a sphere whose orientation can be read off."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import E_Z, Quaternion

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

# The northern half is orange, the southern blue (Okabe and Ito's), in sectors of 60 degrees, lighter and darker.
_NORTH, _SOUTH = ((0.96, 0.76, 0.50), (0.90, 0.56, 0.22)), ((0.66, 0.82, 0.93), (0.36, 0.60, 0.80))
_LINE = (0.16, 0.16, 0.18)
_PIXELS, _FINER = 150, 2
_DOTS = 200  # pixels to the inch
_SHORT = 0.45  # of the radius: an axis that appears shorter is shown as a dot
_ROD, _STUB = 1.55, 1.3  # of the radius: how far the axis sticks out at the north pole, and at the south
_LIGHT = np.array([-0.45, 0.55, 0.75]) / np.linalg.norm([-0.45, 0.55, 0.75])  # right, up, towards the viewer


@dataclass(frozen=True)
class View:
    """A way to look: three unit vectors of the support frame that appear to the right, up, and towards the viewer."""

    right: Array  # (3,): right-handed
    up: Array  # (3,): right-handed
    towards: Array  # (3,): right-handed

    @staticmethod
    def of(azimuth: float, elevation: float) -> View:
        """Return the view from a direction.

        Examples
        --------
        >>> View.of(-math.pi / 2, math.pi / 2).right.round(12) + 0.0
        array([1., 0., 0.])
        """
        ca, sa, ce, se = math.cos(azimuth), math.sin(azimuth), math.cos(elevation), math.sin(elevation)
        return View(np.array([-sa, ca, 0.0]), np.array([-se * ca, -se * sa, ce]), np.array([ce * ca, ce * sa, se]))

    def flat(self, points: Any) -> Array:
        """Return where points (..., 3) appear, (..., 2)."""
        return np.stack([points @ self.right, points @ self.up], axis=-1)


ABOVE = View.of(-math.pi / 2, math.pi / 2)  # as on a map: x to the right, y up the page
ASIDE = View.of(math.radians(38), math.radians(27))  # as in a textbook: x towards the reader, y to the right


def picture(orientation: Any, view: View, pixels: int = _PIXELS) -> Array:
    """Paint a ball.

    Examples
    --------
    Seen from above, a ball that is not turned shows its northern half, which is more red than blue:

    >>> middle = picture((1, 0, 0, 0), ABOVE, 40)[25, 25]
    >>> bool(middle[0] > middle[2])
    True
    """
    count = pixels * _FINER
    axis = (np.arange(count) + 0.5) / count * 2 - 1
    across, up = np.meshgrid(axis, -axis)
    radius2 = across * across + up * up
    towards = np.sqrt(np.clip(1 - radius2, 0.0, None))
    normal = across[..., None] * view.right + up[..., None] * view.up + towards[..., None] * view.towards
    turned = np.array([tuple(row) for row in Quaternion(*map(float, orientation)).matrix().rows])
    colour = _paint(normal @ turned)  # Qᵀ n: the spot of the ball that is seen there
    light = np.clip(across * _LIGHT[0] + up * _LIGHT[1] + towards * _LIGHT[2], 0.0, 1.0)
    colour = np.clip(colour * (0.62 + 0.42 * light)[..., None] + 0.10 * (light**24)[..., None], 0.0, 1.0)
    rim = np.clip((np.sqrt(radius2) - 0.965) / 0.02, 0.0, 1.0)[..., None]
    colour = colour * (1 - rim) + rim * np.array(_LINE)
    image = np.concatenate([colour, (radius2 <= 1)[..., None]], axis=-1)
    image[..., :3] *= image[..., 3:]
    image = image.reshape(pixels, _FINER, pixels, _FINER, 4).mean(axis=(1, 3))
    image[..., :3] /= np.maximum(image[..., 3:], 1e-9)
    return image


def _paint(spot: Array) -> Array:
    """Return the colour at spots (..., 3) of the ball, body frame: a globe with its grid of 30 degrees."""
    x, y, z = spot[..., 0], spot[..., 1], spot[..., 2]
    longitude, flat = np.arctan2(y, x), np.hypot(x, y)
    sector = np.floor(longitude / (math.pi / 3)).astype(int) % 2
    colour = np.where((z >= 0)[..., None], np.array(_NORTH)[sector], np.array(_SOUTH)[sector])
    latitude = np.arctan2(z, flat)
    step = math.pi / 6
    to_parallel = np.abs(latitude - step * np.round(latitude / step))
    to_meridian = np.abs(np.sin(longitude - step * np.round(longitude / step))) * flat
    equator, first = np.abs(latitude), np.where(x > 0, np.abs(y), 1.0)
    thin = np.minimum(to_parallel, to_meridian)
    ink = np.maximum(0.42 * _band(thin, 0.011), 0.95 * np.maximum(_band(equator, 0.024), _band(first, 0.03)))
    cap = _band(flat, 0.10) * (z > 0)
    colour = colour * (1 - ink[..., None]) + ink[..., None] * np.array(_LINE)
    return colour * (1 - cap[..., None]) + cap[..., None]


def _band(distance: Array, half: float) -> Array:
    return np.clip((half - distance) / (0.4 * half) + 0.5, 0.0, 1.0)


def place(ax: Axes, at: Any, radius: float, inches: float, orientation: Any, view: View, zorder: float = 5.0) -> None:
    """Put a ball with its axis into a picture.

    Examples
    --------
    See `trundle.analysis.geometry.figure.draw`.
    """
    x, y = float(at[0]), float(at[1])
    pixels = int(np.clip(2 * inches * _DOTS, 40, 300))
    ax.imshow(
        picture(orientation, view, pixels),
        extent=(x - radius, x + radius, y - radius, y + radius),
        interpolation="antialiased",
        zorder=zorder,
    )
    pole = np.array(tuple(Quaternion(*map(float, orientation)).matrix() @ E_Z))
    _axis(ax, np.array([x, y]), radius, inches, view.flat(pole), float(pole @ view.towards), zorder)


def _axis(ax: Axes, centre: Array, radius: float, inches: float, flat: Array, depth: float, zorder: float) -> None:
    """Draw the axis where it comes out of the ball: an arrow and N at the north pole, a stub at the south.

    An axis seen from one end is a dot, with the letter of the pole that is on this side.
    """
    from ...views.plots.sheet import GREY, INK

    long, size = math.hypot(*flat), float(np.clip(inches / 0.35, 0.75, 1.0))
    if long < _SHORT:
        side = 1.0 if depth > 0 else -1.0
        dot = centre + side * radius * flat
        colour = INK if depth > 0 else GREY
        ax.plot(*dot, marker="o", ms=5.5 * size, mfc=colour, mec="white", mew=1.0, zorder=zorder + 0.3, ls="none")
        beside = side * flat / long if long > 0.1 else np.array([0.7, 0.7])
        _letter(ax, dot + 0.32 * radius * beside, "N" if depth > 0 else "S", colour, size, zorder + 0.4)
        return
    near, far = zorder + 0.3, zorder - 0.3
    stub = np.array([centre - radius * flat, centre - _STUB * radius * flat])
    ax.plot(*stub.T, color=GREY, lw=2.2 * size, zorder=far if depth > 0.02 else near, solid_capstyle="butt")
    tip, root = centre + _ROD * radius * flat, centre + (radius * flat if depth > -0.02 else 0.0)
    head = f"-|>,head_length={0.55 * size},head_width={0.28 * size}"
    arrow = {"arrowstyle": head, "color": INK, "lw": 1.9 * size, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", tuple(tip), tuple(root), arrowprops=arrow, zorder=near if depth > -0.02 else far)
    _letter(ax, tip + 0.25 * radius * flat / long, "N", INK, size, zorder + 0.4)


def _letter(ax: Axes, at: Array, letter: str, colour: str, size: float, zorder: float) -> None:
    from matplotlib.patheffects import Normal, Stroke

    white = [Stroke(linewidth=3.0 * size, foreground="white"), Normal()]
    text = ax.text(float(at[0]), float(at[1]), letter, color=colour, zorder=zorder, path_effects=white)
    text.set(ha="center", va="center", fontsize=9 * size, fontweight="bold")
