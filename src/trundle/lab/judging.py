"""Whether an answer to a challenge is right: by conditions on the run, or by what the page does not know."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..solve.samples import FLIGHT, SLIPPING
from ..units import OFFERED
from .challenges import ByChoice, ByNumber, Challenge, Condition
from .errors import refused

if TYPE_CHECKING:
    from ..views.scene import Scene

Array = NDArray[np.float64]
_MANY = 2000  # samples of a run that is judged
_FACTORS = {unit: factor for units in OFFERED.values() for unit, factor in units.items()}
# What is left of the scene of a mystery: how it moves, and over what.
_MOTION = ("time", "position", "contact", "velocity", "angular_velocity", "orientation", "phase", "guiding_centre")
_GROUNDS = ("support_", "body_")  # columns that begin so: poses and meshes
_TOLD = ("gravity", "tilt", "to_world", "guiding_centre", "method")
_OF: dict[str, Callable[[Array], float]] = {
    "largest": lambda values: float(values.max()),
    "smallest": lambda values: float(values.min()),
    "mean": lambda values: float(values.mean()),
    "last": lambda values: float(values[-1]),
    "range": lambda values: float(np.ptp(values)),
}


def _way(scene: Scene) -> Array:
    """Return the distance from the place where it began, m."""
    place = scene.columns["position"].astype(float)
    return np.linalg.norm(place - place[0], axis=1)


def _turned(scene: Scene) -> Array:
    """Return the angle between the orientation at first and now, rad."""
    turns = scene.columns["orientation"].astype(float)
    return 2 * np.arccos(np.clip(np.abs(turns @ turns[0]), 0.0, 1.0))


def _heading(scene: Scene) -> Array:
    """Return by how much the direction of motion has turned in the plane, either way, rad."""
    x, y, _ = scene.columns["velocity"].astype(float).T
    angle = np.unwrap(np.arctan2(y, x))
    return np.abs(angle - angle[0])


QUANTITIES: dict[str, Callable[[Scene], Array]] = {
    "way": _way,
    "speed": lambda scene: np.linalg.norm(scene.columns["velocity"].astype(float), axis=1),
    "turned": _turned,
    "heading": _heading,
    "push": lambda scene: np.linalg.norm(scene.columns["contact_force"].astype(float), axis=1),
    "flying": lambda scene: (scene.columns["phase"] == FLIGHT).astype(float),
    "slipping": lambda scene: (scene.columns["phase"] == SLIPPING).astype(float),
}


def run(challenge: Challenge, values: Mapping[str, float], body: str = "", samples: int | None = None) -> Scene:
    """Return the run of what the learner chose as a scene; what is hidden is not in it.

    Examples
    --------
    >>> from trundle.lab.challenges import challenge
    >>> scene = run(challenge("mystery-ball"), {}, "Mystery ball", 50)
    >>> scene.header["body"]["label"], scene.header["scenario"], scene.header["findings"]
    ('Mystery ball', None, [])
    """
    from .answers import scene_from

    scene = scene_from(challenge.tables(values, body), samples)
    return _concealed(scene, challenge, body) if challenge.hidden else scene


def _concealed(scene: Scene, challenge: Challenge, name: str) -> Scene:
    """Return a scene that shows how a body moves, and nothing else: what is not named here is left out."""
    from ..views.scene.header import header_with

    given = scene.header
    body = {**given["body"], "kind": "sphere", "name": name, "label": name, "mass": None}
    told = {key: given[key] for key in _TOLD}
    header = header_with(challenge.title, given["duration"], body, given["support"], **told)
    columns = {key: column for key, column in scene.columns.items() if key in _MOTION or key.startswith(_GROUNDS)}
    columns["contact_force"] = np.zeros_like(scene.columns["contact_force"])
    return replace(scene, header=header, columns=columns)


def judge(challenge: Challenge, values: Mapping[str, float], answer: float | str | None) -> dict[str, Any]:
    """Return whether an answer is right, what was found, and, once it is right, why it is so.

    Examples
    --------
    >>> from trundle.lab.challenges import challenge
    >>> judge(challenge("which-is-hollow"), {}, "Ball B")["right"]
    False
    >>> judge(challenge("one-round-in-five-seconds"), {"rate": 42.0}, None)["right"]
    True
    """
    asked = challenge.answer
    found: list[dict[str, Any]] = []
    if isinstance(asked, ByChoice):
        if answer not in asked.choices:
            raise refused(422, f"Choose one of: {', '.join(asked.choices)}.", "answer")
        right = answer == asked.right
    elif isinstance(asked, ByNumber):
        if isinstance(answer, str) or answer is None or not math.isfinite(answer):
            raise refused(422, f"{asked.label} must be a number, such as 0.4.", "answer")
        right = abs(answer - asked.value) <= asked.within * abs(asked.value)
    else:
        scene = run(challenge, values, samples=_MANY)
        found = [_found(one, challenge, values, scene) for one in asked.conditions]
        right = all(one["held"] for one in found)
    return {"right": right, "found": found, "explanation": challenge.explanation if right else ""}


def _found(condition: Condition, challenge: Challenge, values: Mapping[str, float], scene: Scene) -> dict[str, Any]:
    """Return one condition with what the run shows of it, in the condition's unit."""
    if condition.quantity == "setting":
        (control,) = (one for one in challenge.controls if one.name == condition.control)
        value = float(values.get(control.name, control.first))
    else:
        value = _OF[condition.of](QUANTITIES[condition.quantity](scene)) / _FACTORS[condition.unit]
    low = -math.inf if condition.least is None else condition.least
    high = math.inf if condition.most is None else condition.most
    asked = {"least": condition.least, "most": condition.most}
    return {"said": condition.said, "value": value, "unit": condition.unit, **asked, "held": low <= value <= high}
