"""The exact motion and an engine's beside each other, to be played in a page that needs nothing but itself."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..display import Markup, escaped
from .case import Case, Motion

if TYPE_CHECKING:
    from .results import Cell

_MOST = 201  # frames of one body; several share as many as make the same of numbers
_FEWEST = 31
_AROUND = np.linspace(0.0, 2 * math.pi, 25)
_Line = list[list[float]]


def path_of(motion: Motion) -> str:
    """Return positions and orientations at the frames of an animation: float32, little-endian, in base 64.

    Examples
    --------
    >>> import trundle as tr
    >>> len(path_of(tr.conformance.cases()[0].exact()))
    7504
    """
    samples, bodies = motion.position.shape[:2]
    chosen = np.linspace(0, samples - 1, _frames(samples, bodies)).round().astype(int)
    numbers = np.concatenate([motion.position[chosen], motion.orientation[chosen]], axis=-1)
    return base64.b64encode(numbers.astype("<f4").tobytes()).decode()


def _frames(samples: int, bodies: int) -> int:
    """Return how many frames are shown of a motion."""
    return min(samples, max(_FEWEST, _MOST // bodies))


def beside(case: Case, cells: Iterable[Cell]) -> Markup:
    """Return a figure that plays the exact motion, and beside it that of an engine, which the reader chooses.

    Parameters
    ----------
    case : Case
        What was run.
    cells : iterable of Cell
        Of this case; those that came to a motion can be chosen, at their finest step.
    """
    runs = [cell for cell in cells if cell.finest.path]
    if not runs:
        return Markup()
    exact = case.exact()
    situation = case.situation()
    bodies = [_drawn(body) for body in situation["bodies"]]
    frames = _frames(*exact.position.shape[:2])
    told = {
        "duration": case.duration,
        "frames": frames,
        "bodies": bodies,
        "ground": _ground(situation["support"], exact, max(body["reach"] for body in bodies)),
        "exact": path_of(exact),
        "runs": [{"path": cell.finest.path} for cell in runs],
    }
    choices = "".join(
        f"<option>{escaped(f'{cell.engine}, {cell.label}, {1e3 * cell.finest.step:g} ms')}</option>" for cell in runs
    )
    said = json.dumps(told).replace("<", "\\u003c")  # a file of rows may come from anywhere
    slower = max(case.duration, 4.0) / case.duration
    pace = "in real time" if slower == 1.0 else f"{slower:.2g} times slower than it is"
    return Markup(
        '<figure class="beside" hidden>'
        f"<div><button type=button>Play</button> <label>Engine <select>{choices}</select></label> "
        f'<label>Time <input type="range" min="0" max="{frames - 1}" value="0"></label> <output></output></div>'
        f'<canvas role="img" aria-label="{escaped(case.title)}: the exact motion, and an engine\'s beside it"></canvas>'
        f"<figcaption>Played {escaped(pace)}. Dashed on the right: the exact path. Small bodies are drawn larger than"
        f' they are.</figcaption><script type="application/json">{said}</script></figure>'
    )


def program() -> Markup:
    """Return what plays the figures of a page."""
    return Markup(f"<script>{Path(__file__).with_suffix('.js').read_text(encoding='utf-8')}</script>")


def _drawn(body: dict[str, Any]) -> dict[str, Any]:
    """Return the lines by which a body is drawn, in its axes about the centre of mass, and how far they reach."""
    shape = body["shape"]
    if "half_widths" in shape:
        corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])
        lines = [np.column_stack([corners, np.full(5, end)]) for end in (-1.0, 1.0)]
        lines += [np.array([[x, y, -1.0], [x, y, 1.0]]) for x, y in corners[:4]]
        size = np.array(shape["half_widths"])
    else:
        size = np.array(shape.get("semi_axes", [shape.get("radius", 0.0)] * 3))
        c, s, o = np.cos(_AROUND), np.sin(_AROUND), 0 * _AROUND
        lines = [np.column_stack([c, s, o])]
        round_about = [np.column_stack([c, o, s]), np.column_stack([o, c, s])]
        spokes = [np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]])]
        lines += spokes if shape["kind"] == "disc" else round_about
    offset = np.array(body["offset"])
    return {"lines": [_rounded(line * size + offset) for line in lines], "reach": float(size.max())}


def _ground(support: dict[str, Any], exact: Motion, margin: float) -> list[_Line]:
    """Return lines on the ground under a motion: a grid, or rings where it turns, or is a dome or a bowl."""
    points = exact.position.reshape(-1, 3)
    if support["kind"] == "plane" and support["motion"]["kind"] == "fixed":
        low, high = points[:, :2].min(0) - margin, points[:, :2].max(0) + margin
        pitch = max(high - low) / 8
        middle, reach = (low + high) / 2, np.maximum((high - low) / 2, 2 * pitch)
        counts = np.ceil(reach / pitch).astype(int)
        (x, y), (a, b) = middle, counts * pitch
        along = [[[x + i * pitch, y - b, 0.0], [x + i * pitch, y + b, 0.0]] for i in range(-counts[0], counts[0] + 1)]
        across = [[[x - a, y + j * pitch, 0.0], [x + a, y + j * pitch, 0.0]] for j in range(-counts[1], counts[1] + 1)]
        return [_rounded(line) for line in along + across]
    radius = support.get("radius", math.inf)
    widest = min(float(np.hypot(points[:, 0], points[:, 1]).max()) + margin, radius)
    rings = []
    for part in np.linspace(0.2, 1.0, 5) * widest:
        depth = radius - math.sqrt(max(radius**2 - part**2, 0.0)) if math.isfinite(radius) else 0.0
        height = depth if support["kind"] == "bowl" else -depth
        rings.append(np.column_stack([part * np.cos(_AROUND), part * np.sin(_AROUND), np.full(_AROUND.size, height)]))
    return [_rounded(ring) for ring in rings]


def _rounded(line: Sequence[Sequence[float]] | np.ndarray[Any, Any]) -> _Line:
    """Return a line with the digits that a screen can show."""
    rounded: _Line = np.round(np.asarray(line, dtype=float), 5).tolist()
    return rounded
