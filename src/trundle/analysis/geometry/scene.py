"""A ball rolled along a path, without forces, as a scene: how it is turned on the way and when it comes home."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...solve.exact.finding import Finding
from ...solve.exact.formula import quantity
from ...views.scene import Scene
from ...views.scene.header import tables
from ...views.scene.headline import Headline
from ...views.scene.instants import MOST
from ...views.scene.sphere import sphere_scene
from .rolled import RolledPath

_FINEST = math.radians(3.0)  # turned between two samples: what an eye takes for smooth
_FEWEST = 200
_PACE = 0.25  # turns of the ball in a second, unless that makes a scene too short or too long
_SHORTEST, _LONGEST = 2.0, 30.0  # s


def rolled_scene(rolled: RolledPath, samples: int | None = None, with_card: bool = False) -> Scene:
    """Return a scene of a ball rolled along a path at an even pace.

    Examples
    --------
    >>> import trundle as tr
    >>> scene = rolled_scene(tr.PathScenario.load("roll-x-then-y").run())
    >>> [round(float(part), 6) + 0.0 for part in scene.header["stages"][-1]["north_pole"]]
    [1.0, 0.0, 0.0]
    """
    smooth = 1 + math.ceil(min(rolled.length / rolled.radius / _FINEST, MOST))
    count = samples or min(max(smooth, _FEWEST), MOST - len(rolled.pieces))
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
        "kind": "rolled",
        "title": rolled.title,
        "scenario": tables(rolled.scenario),
        "scenario_toml": rolled.scenario,
        "findings": [one.as_dict() for one in _findings(rolled)],
        "headline": _headline(rolled).as_dict(),
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
        "small_loop": rolled.is_small_loop,
        "small_loop_angle": rolled.small_loop_angle,
        "north_pole": rolled.north_pole,
        "stages": told,
        "error_bound": rolled.error_bound,
    }


def _findings(rolled: RolledPath) -> list[Finding]:
    turn = rolled.rotation
    found = [Finding("Angle by which the ball is turned", r"\theta", None, turn.angle, "rad", note="about one axis")]
    if rolled.is_closed:
        small = rolled.small_loop_angle if rolled.is_small_loop else None
        note = "predicted for a loop that is small beside the ball"
        psi = turn.about_normal if abs(turn.about_normal) > rolled.error_bound else 0.0
        found.append(
            Finding("Of it, about the normal", r"\psi", small, psi, "rad", note=note, scale=None if small else 1.0)
        )
        found.append(Finding("Enclosed area", "A", None, rolled.enclosed_area, "m²", note="anticlockwise is positive"))
    return found


def _headline(rolled: RolledPath) -> Headline:
    angle = rolled.rotation.angle
    if not rolled.is_closed:
        return Headline("turns the ball by {}", "rad", angle, None, False, "about one axis")
    small = abs(rolled.small_loop_angle or 0.0) if rolled.is_small_loop else 0.0
    how = "by the area that a small loop encloses; and by all turns one after the other" if small else "about one axis"
    return Headline("comes home turned by {}", "rad", angle, small or None, bool(small), how)


def _formula(rolled: RolledPath) -> dict[str, str] | None:
    area, small = rolled.enclosed_area, rolled.small_loop_angle
    if not rolled.is_small_loop or area is None or small is None:
        return None
    numbers = rf"\psi \approx -\frac{{{quantity(area, 'm^2')}}}{{({quantity(rolled.radius, 'm')})^2}}"
    return {
        "name": "Turn about the normal by a small loop",
        "source": "G4",
        "latex": r"\psi \approx -\frac{A}{a^2}",
        "numbers_latex": rf"{numbers} = {quantity(small, 'rad')}",
    }
