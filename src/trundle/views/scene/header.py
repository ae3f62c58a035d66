"""What a scene says of itself in words and numbers: body, support, events, frames, scenario."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from trundle.wording import as_ratio

from ...mechanics.symmetry import ball_of
from ...mechanics.system import RollingSystem
from ...scenario import files
from ..plots.words import title_of
from .support_mesh import Ground
from .wire import FORMAT

if TYPE_CHECKING:
    from ...simulation.trajectory import Trajectory


def header_of(run: Trajectory, ground: Ground, radius: float) -> dict[str, Any]:
    """Return the part of a header that the system and the scenario give."""
    system, scenario = run.system, tables(run.scenario)
    tilt, times = float(system.support.tilt), run.samples.time
    return header_with(
        run.title or title_of(system),
        float(times[-1] - times[0]),
        _body(system, (scenario or {}).get("body", {}), radius),
        _support(system, (scenario or {}).get("support", {}), ground),
        method=run.method,
        tolerance=run.tolerance,
        scenario=scenario,
        scenario_toml=run.scenario,
        gravity=[0.0, 0.0, -float(system.gravity)],
        tilt=tilt,
        to_world=[math.cos(0.5 * tilt), 0.0, math.sin(0.5 * tilt), 0.0],
        events=[{"time": event.time, "kind": event.kind, "text": event.text} for event in run.events],
    )


def header_with(
    title: str, duration: float, body: dict[str, Any], support: dict[str, Any], **told: Any
) -> dict[str, Any]:
    """Return a header with every key that scenes have.

    Examples
    --------
    >>> header_with("Still", 1.0, {}, {}, tilt=0.1)["tilt"], header_with("Still", 1.0, {}, {})["gravity"]
    (0.1, [0.0, 0.0, 0.0])
    """
    plain = {
        "format": FORMAT,
        "title": title,
        "method": "exact",
        "tolerance": 0.0,
        "duration": duration,
        "seconds": None,
        "scenario": None,
        "scenario_toml": "",
        "gravity": [0.0, 0.0, 0.0],
        "tilt": 0.0,
        "to_world": [1.0, 0.0, 0.0, 0.0],
        "body": body,
        "support": support,
        "events": [],
        "findings": [],
        "headline": None,
        "curves": [],
        "formula": None,
        "guiding_centre": False,
        "card": None,
    }
    return plain | told


def body_table(
    kind: str,
    name: str,
    radius: float,
    mass: float | None = None,
    more: str = "",
    *,
    noun: str = "ball",
    ball: bool = True,
) -> dict[str, Any]:
    """Return what a header says of a body; its label is the name and what more there is to it."""
    told = {"kind": kind, "radius": radius, "name": name, "mass": mass, "label": name + more}
    return {**told, "noun": noun, "ball": ball}


def support_table(
    kind: str,
    name: str,
    ground: Ground,
    *,
    flat: bool = True,
    deep: bool = False,
    moves: bool = False,
    rim: float | None = None,
    friction: float | None = None,
) -> dict[str, Any]:
    """Return what a header says of a support; of its ground, all but the mesh."""
    return {
        "kind": kind,
        "name": name,
        "flat": flat,
        "deep": deep,
        "moves": moves,
        "size": ground.size,
        "centre": list(ground.centre),
        "marks": ground.marks,
        "rim": rim,
        "friction": friction,
    }


@lru_cache(maxsize=64)
def _parsed(text: str) -> dict[str, Any]:
    return files.parse(text, "scenario")


def tables(text: str) -> dict[str, Any] | None:
    """Return the tables of a scenario, or None where there is no scenario."""
    return _copied(_parsed(text)) if text else None  # so that nobody changes what is kept


def _copied(part: Any) -> Any:
    """Copy tables and lists, which is all that can be changed in them."""
    if isinstance(part, dict):
        return {key: _copied(value) for key, value in part.items()}
    return [_copied(value) for value in part] if isinstance(part, list) else part


def _body(system: RollingSystem, words: dict[str, Any], radius: float) -> dict[str, Any]:
    body = system.body
    noun = body.shape.noun_of(body)
    kind = str(words.get("kind", noun))
    name = kind.replace("-", " ").capitalize()
    ratio = f", k = {as_ratio(float(body.inertia_ratio))}" if body.is_isotropic_sphere else ""
    ball = ball_of(body)
    any_way = ball is not None and ball.concentric
    return body_table(kind, name, radius, float(body.mass), ratio, noun=noun, ball=any_way)


def _support(system: RollingSystem, words: dict[str, Any], ground: Ground) -> dict[str, Any]:
    support = system.support
    surface, way = support.surface, support.motion.way
    kind = str(words.get("kind", surface.kind or surface.table_of or surface.noun))
    lies = kind == "cylinder" and abs(float(support.tilt)) > 1.5
    leaning = "level" if lies else "tilted" if float(support.tilt) else ""
    name = " ".join([*(part for part in (", ".join(p for p in (way, leaning) if p),) if part), kind.replace("-", " ")])
    return support_table(
        kind,
        name.capitalize(),
        ground,
        flat=surface.flat,
        deep=surface.where.startswith("in"),
        moves=support.motion.steady_rate != 0.0,
        rim=None if surface.rim is None else float(surface.rim),
        friction=None if support.friction is None else float(support.friction),
    )


def radius_about_centre(vertices: Any) -> float:
    """Return the largest distance of a mesh's vertices from its origin, m."""
    return float(np.sqrt(np.max(np.sum(np.asarray(vertices) ** 2, axis=1))))
