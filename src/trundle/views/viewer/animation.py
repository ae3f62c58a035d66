"""A scene as an animated picture, seen along the support's axis: the ball, its trail, and the support as it turns."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from PIL import Image

    from ..scene import Scene

Array = NDArray[np.float64]

_RATE = 20  # frames a second
_HOLD = 1000  # ms, on the last frame
_LONGEST = 8000  # ms, with that
_MOST_FRAMES = 1 + (_LONGEST - _HOLD) * _RATE // 1000
_INCHES, _DPI, _FINER = 4.8, 100, 2  # drawn twice as large, for smooth edges
_LEAST_RADIUS = 7.0  # of the ball, in pixels
_SPOTS = np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], dtype=float)


def gif_of(scene: Scene) -> bytes:
    """Return a scene as a GIF of at most eight seconds.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.views.scene import scene_of
    >>> gif_of(scene_of(tr.Scenario.load("tilted-turntable").run(duration=0.2, every=0.1)))[:6]
    b'GIF89a'
    """
    from PIL import Image

    time = scene.columns["time"]
    duration = float(time[-1] - time[0])
    count = int(np.clip(round(duration * _RATE) + 1, 2, _MOST_FRAMES))
    pace = duration / ((count - 1) / _RATE)
    stage = _Stage(scene, _pace(pace))
    places = np.searchsorted(time, np.linspace(time[0], time[-1], count)).clip(0, time.size - 1)
    colours = stage.frame(int(places[-1])).quantize(128)  # the last frame has every colour
    still = Image.Dither.NONE
    frames = [stage.frame(int(place)).quantize(palette=colours, dither=still) for place in places]
    made = io.BytesIO()
    lasting = [1000 // _RATE] * (count - 1) + [_HOLD]
    frames[0].save(made, "GIF", save_all=True, append_images=frames[1:], duration=lasting, loop=0, disposal=1)
    return made.getvalue()


def _pace(pace: float) -> str:
    if 0.8 < pace < 1.25:
        return ""
    return f", {pace:.2g} times as fast" if pace > 1 else f", {1 / pace:.2g} times as slow"


class _Stage:
    """What all frames share: the picture behind, and where a point of the support frame lies on it."""

    def __init__(self, scene: Scene, pace: str) -> None:
        from PIL import Image

        self.columns = scene.columns
        # What lies down the slope is drawn below, as in the figures: the first axis points down, the second right.
        down = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        self.view = down if scene.header["tilt"] else np.eye(3)
        self.track = (scene.columns["position"].astype(float) @ self.view.T)[:, :2]
        figure, self._axes, self.radius, self.reach = _background(scene, self.track, pace)
        figure.canvas.draw()
        picture = np.asarray(figure.canvas.buffer_rgba())
        self.height = picture.shape[0]
        self.behind = Image.fromarray(picture).convert("RGB")
        corner, unit = self._axes.transData.transform([(0.0, 0.0), (1.0, 0.0)])
        self.pixels_a_metre = float(unit[0] - corner[0])

    def at(self, points: Array) -> list[tuple[float, float]]:
        """Return points (n, 2) in pixels from the upper left corner."""
        there = self._axes.transData.transform(points)
        return [(float(x), float(self.height - y)) for x, y in there]

    def frame(self, place: int) -> Image.Image:
        """Draw the ball at one sample."""
        from PIL import ImageDraw

        from ..plots.sheet import BLUE

        picture = self.behind.copy()
        draw = ImageDraw.Draw(picture)
        self._turned(draw, place)
        if place > 0:
            step = max(1, place // 2000)
            draw.line(self.at(self.track[: place + 1 : step]), fill=BLUE, width=2 * _FINER, joint="curve")
        self._ball(draw, place)
        return picture.resize((picture.width // _FINER, picture.height // _FINER))

    def _turned(self, draw: Any, place: int) -> None:
        """Draw spokes that turn with the support, where it turns."""
        from ..plots.sheet import GREY

        if "support_orientation" not in self.columns:
            return
        turned = _rotation(self.columns["support_orientation"][place])
        origin = self.columns["support_position"][place].astype(float)
        for angle in np.linspace(0.0, 2 * math.pi, 6, endpoint=False):
            along = np.array([math.cos(angle), math.sin(angle), 0.0])
            ends = np.array([origin + turned @ (along * share * self.reach) for share in (0.88, 0.98)])
            draw.line(self.at((ends @ self.view.T)[:, :2]), fill=GREY, width=(4 if angle == 0 else 2) * _FINER)

    def _ball(self, draw: Any, place: int) -> None:
        from ..plots.sheet import INK, VERMILION

        [(x, y)] = self.at(self.track[place : place + 1])
        radius = max(self.radius * self.pixels_a_metre, _LEAST_RADIUS * _FINER)
        draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=VERMILION, outline=INK, width=_FINER)
        turned = _SPOTS @ _rotation(self.columns["orientation"][place]).T @ self.view.T
        for number, (right, up, towards) in enumerate(turned):
            if towards > -0.01:  # on the side that is seen, or on its edge, as with all marks of a cylinder
                size = radius * (0.2 if number > 1 else 0.3) * (0.5 + 0.5 * towards)
                cx, cy = x + 0.75 * radius * right, y - 0.75 * radius * up
                draw.ellipse((cx - size, cy - size, cx + size, cy + size), fill="white" if number > 1 else INK)


def _background(scene: Scene, track: Array, pace: str) -> tuple[Any, Any, float, float]:
    """Draw what does not move; return figure, axes, the ball's radius and how far the support is shown, m."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle

    from ..plots.sheet import FAINT, GREY, TABLE, look

    header = scene.header
    radius, rim = float(header["body"]["radius"]), header["support"]["rim"]
    moves = "support_orientation" in scene.columns
    low, high = track.min(axis=0) - 1.6 * radius, track.max(axis=0) + 1.6 * radius
    if moves:
        reach = float(rim or 1.05 * np.abs([low, high]).max())
        low, high = np.minimum(low, -1.02 * reach), np.maximum(high, 1.02 * reach)
    else:
        reach = 0.5 * float((high - low).max())
    middle, half = (low + high) / 2, max(0.5 * float((high - low).max()), 3 * radius)
    with look():
        figure = Figure(figsize=(_INCHES, _INCHES + 0.25), dpi=_DPI * _FINER, facecolor="white")
        FigureCanvasAgg(figure)
        axes = figure.add_axes((0.13, 0.09, 0.84, 0.84 * _INCHES / (_INCHES + 0.25)))
        axes.set(xlim=middle[0] + half * np.array([-1, 1]), ylim=middle[1] + half * np.array([-1, 1]), aspect="equal")
        axes.set(xlabel="y (m)", ylabel="up, −x (m)") if header["tilt"] else axes.set(xlabel="x (m)", ylabel="y (m)")
        if moves:
            axes.add_patch(Circle((0, 0), reach, facecolor=TABLE, edgecolor=GREY, zorder=0))
        axes.plot(*track.T, color=FAINT, linewidth=1.0)
        figure.text(0.03, 0.97, _short(str(header["title"])) + pace, fontsize=9.5, fontweight="bold", va="center")
    return figure, axes, radius, reach


def _short(title: str) -> str:
    plain = title.replace("$", r"\$")
    return plain if len(plain) <= 56 else plain[:55] + "…"


def _rotation(quaternion: Any) -> Array:
    """Return the matrix of a unit quaternion w, x, y, z."""
    w, x, y, z = (float(part) for part in quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
