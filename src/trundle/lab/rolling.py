"""A ball rolled along a path, without forces, as a scene: how it is turned on the way and when it comes home."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ScenarioError
from .bare import sphere_scene
from .limits import MOST_SAMPLES

if TYPE_CHECKING:
    from ..geometry import RolledPath
    from ..scene import Scene

_FINEST = math.radians(3.0)  # turned between two samples: what an eye takes for smooth
_FEWEST = 200
_PACE = 0.25  # turns of the ball in a second, unless that makes a scene too short or too long
_SHORTEST, _LONGEST = 2.0, 30.0  # s


def path_of(radius: Any, curve: Mapping[str, Any]) -> dict[str, Any]:
    """Return a ball and a curve as the tables of a scenario file.

    Parameters
    ----------
    radius : float or text with a unit
        Of the ball.
    curve : mapping
        One piece, as a [[path]] table says it; or several in a list, `path`, beside `start`, `title` and `notes`.

    Returns
    -------
    dict
        As `PathScenario.read` takes it.

    Raises
    ------
    ScenarioError
        If there is a key that a curve does not have.

    Examples
    --------
    >>> path_of("25 mm", {"kind": "straight", "turn": "90 deg"})["path"]
    [{'kind': 'straight', 'turn': '90 deg'}]
    """
    if "kind" in curve:
        return {"title": "A ball rolled along a curve", "body": {"radius": radius}, "path": [dict(curve)]}
    known = ("path", "start", "title", "notes")
    for key in curve:
        if key not in known:
            raise ScenarioError(
                f"curve.{key[:60]}", "is no key of a curve", curve[key], f"There are: {', '.join(known)}."
            )
    if "path" not in curve:
        remedy = 'Give pieces, for instance [{"kind": "straight", "turn": "90 deg"}].'
        raise ScenarioError("curve.path", "must be given", "nothing", remedy)
    return {"title": "A ball rolled along a path", **curve, "body": {"radius": radius}}


def rolled_scene(rolled: RolledPath, samples: int | None = None, with_card: bool = False) -> Scene:
    """Return a scene of a ball rolled along a path at an even pace.

    Parameters
    ----------
    rolled : RolledPath
        Ball and path.
    samples : int, optional
        How many to show; absent: as many as look smooth.
    with_card : bool
        Whether to verify it.

    Returns
    -------
    Scene
        Its header says by how much the ball is turned: `turned` (rad) about `turned_axis`, of it
        `turned_about_normal`; `enclosed_area` (m²) and `small_loop_angle` (rad) where the path is closed; and the
        `stages`, the ball at the end of each piece.

    Examples
    --------
    >>> from ..geometry import PathScenario
    >>> scene = rolled_scene(PathScenario.load("roll-x-then-y").run())
    >>> [round(float(part), 6) + 0.0 for part in scene.header["stages"][-1]["north_pole"]]
    [1.0, 0.0, 0.0]
    """
    smooth = 1 + math.ceil(min(rolled.length / rolled.radius / _FINEST, MOST_SAMPLES))
    count = samples or min(max(smooth, _FEWEST), MOST_SAMPLES - len(rolled.pieces))
    at = rolled.sampled(rolled.length / max(count - 1, 1))
    pace = rolled.length / min(max(rolled.length / rolled.radius / (2 * math.pi * _PACE), _SHORTEST), _LONGEST)
    velocity = pace * np.column_stack([np.cos(at.heading), np.sin(at.heading), np.zeros_like(at.heading)])
    columns = {
        "time": at.distance / pace,
        "position": at.position,
        "velocity": velocity,
        "angular_velocity": np.column_stack([-velocity[:, 1], velocity[:, 0], velocity[:, 2]]) / rolled.radius,
        "orientation": at.orientation,
    }
    header = {
        "title": rolled.title,
        "scenario": tomllib.loads(rolled.scenario) if rolled.scenario else None,
        "scenario_toml": rolled.scenario,
        "findings": _findings(rolled),
        "formula": _formula(rolled),
        "card": rolled.card().as_dict() if with_card else None,
        **_turned(rolled, pace),
    }
    return sphere_scene(rolled.radius, columns, header)


def _turned(rolled: RolledPath, pace: float) -> dict[str, Any]:
    turn, stages = rolled.rotation, rolled.stages
    told = [
        {
            "distance": stages.distance[i],
            "time": stages.distance[i] / pace,
            "position": stages.position[i],
            "orientation": stages.orientation[i],
            "north_pole": stages.north_pole[i],
        }
        for i in range(len(stages.distance))
    ]
    return {
        "length": rolled.length,
        "closed": rolled.is_closed,
        "gap": rolled.gap,
        "turned": turn.angle,
        "turned_axis": turn.axis,
        "turned_about_normal": turn.about_normal,
        "enclosed_area": rolled.enclosed_area,
        "small_loop_angle": rolled.small_loop_angle,
        "north_pole": rolled.north_pole,
        "stages": told,
        "error_bound": rolled.error_bound,
    }


def _findings(rolled: RolledPath) -> list[dict[str, Any]]:
    small, turn = rolled.small_loop_angle, rolled.rotation
    rows = [_finding("Angle by which the ball is turned", r"\theta", None, turn.angle, "rad", "about one axis")]
    if small is not None:
        note = "predicted for a loop that is small beside the ball"
        rows.append(_finding("Of it, about the normal", r"\psi", small, turn.about_normal, "rad", note))
        rows.append(_finding("Enclosed area", "A", None, rolled.enclosed_area, "m²", "anticlockwise is positive"))
    return rows


def _finding(
    name: str, symbol: str, predicted: float | None, measured: float | None, unit: str, note: str
) -> dict[str, Any]:
    difference = (measured - predicted) / abs(predicted) if predicted and measured is not None else None
    return {
        "name": name,
        "symbol": symbol,
        "predicted": predicted,
        "measured": measured,
        "unit": unit,
        "difference": difference,
        "note": note,
    }


def _formula(rolled: RolledPath) -> dict[str, str] | None:
    from ..scene.formulas import decimal

    area, small = rolled.enclosed_area, rolled.small_loop_angle
    if area is None or small is None:
        return None
    numbers = rf"\psi \approx -\frac{{{decimal(area)}\,\mathrm{{m^2}}}}{{({decimal(rolled.radius)}\,\mathrm{{m}})^2}}"
    return {
        "name": "Turn about the normal by a small loop",
        "source": "G4",
        "latex": r"\psi \approx -\frac{A}{a^2}",
        "numbers_latex": rf"{numbers} = {decimal(small)}\,\mathrm{{rad}}",
    }
