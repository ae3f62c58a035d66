"""What a scene says of itself in words and numbers: body, support, events, frames, scenario."""

from __future__ import annotations

import math
import tomllib
from copy import deepcopy
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..mechanics.system import RollingSystem
from ..plots.scales import as_ratio
from ..plots.words import moves as way_of
from ..plots.words import noun_of, title_of
from .support_mesh import Ground
from .wire import FORMAT

if TYPE_CHECKING:
    from ..trajectory import Trajectory

_KINDS = {"EllipsoidalBowl": "ellipsoidal-bowl", "TorusTrack": "torus-track", "HeightField": "height-field"}


def header_of(run: Trajectory, ground: Ground, radius: float) -> dict[str, Any]:
    """Return the part of a header that the system and the scenario give.

    Parameters
    ----------
    run : Trajectory
        What is shown.
    ground : Ground
        The part of its support that is shown.
    radius : float
        Of the sphere about the centre of mass that holds the body, m.

    Returns
    -------
    dict
        Plain values.
    """
    system, scenario = run.system, _tables(run.scenario)
    tilt, times = float(system.support.tilt), run.data["time"].values
    gravity = [0.0, 0.0, -float(system.gravity)]
    return {
        "format": FORMAT,
        "title": run.title or title_of(system),
        "method": run.method,
        "duration": float(times[-1] - times[0]),
        "scenario": scenario,
        "scenario_toml": run.scenario,
        "gravity": gravity,
        "tilt": tilt,
        "to_world": [math.cos(0.5 * tilt), 0.0, math.sin(0.5 * tilt), 0.0],
        "body": _body(system, (scenario or {}).get("body", {}), radius),
        "support": _support(system, (scenario or {}).get("support", {}), ground),
        "events": [{"time": event.time, "kind": event.kind, "text": event.text} for event in run.events],
    }


@lru_cache(maxsize=64)
def _parsed(text: str) -> dict[str, Any]:
    return tomllib.loads(text)


def _tables(text: str) -> dict[str, Any] | None:
    return deepcopy(_parsed(text)) if text else None  # so that nobody changes what is kept


def _body(system: RollingSystem, words: dict[str, Any], radius: float) -> dict[str, Any]:
    body = system.body
    kind = str(words.get("kind", noun_of(body)))
    name = kind.replace("-", " ").capitalize()
    ratio = f", k = {as_ratio(float(body.inertia_ratio))}" if body.is_isotropic_sphere else ""
    return {"kind": kind, "radius": radius, "name": name, "mass": float(body.mass), "label": f"{name}{ratio}"}


def _support(system: RollingSystem, words: dict[str, Any], ground: Ground) -> dict[str, Any]:
    support = system.support
    surface = type(support.surface).__name__
    kind = str(words.get("kind", _KINDS.get(surface, surface.lower())))
    way = way_of(support.motion)
    lies = kind == "cylinder" and abs(float(support.tilt)) > 1.5
    leaning = "level" if lies else "tilted" if float(support.tilt) else ""
    name = " ".join([*(part for part in (", ".join(p for p in (way, leaning) if p),) if part), kind.replace("-", " ")])
    return {
        "kind": kind,
        "name": name.capitalize(),
        "moves": support.motion.steady_rate != 0.0,
        "size": ground.size,
        "centre": list(ground.centre),
        "marks": ground.marks,
        "rim": None if support.surface.rim is None else float(support.surface.rim),
        "friction": None if support.friction is None else float(support.friction),
    }


def radius_about_centre(vertices: Any) -> float:
    """Return the largest distance of a mesh's vertices from its origin, m."""
    return float(np.sqrt(np.max(np.sum(np.asarray(vertices) ** 2, axis=1))))
