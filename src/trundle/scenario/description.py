"""From a rolling system and a start back to the words of a scenario file, in bare SI numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from ..errors import InvalidValueError, ScenarioError
from ..mechanics.bodies import HOLLOW_SPHERE, SOLID_SPHERE, Body, Isotropic
from ..mechanics.loads import Drag, Force, Torque
from ..mechanics.motions import Fixed, Spin
from ..mechanics.surfaces import Plane
from ..mechanics.system import RollingSystem, State, Support

Words = dict[str, Any]


def describe(system: RollingSystem, start: State) -> Words:
    """Return all tables of a scenario but ``run``.

    Parameters
    ----------
    system : RollingSystem
        One system.
    start : State
        Its start, at time 0.

    Returns
    -------
    dict
        What `ScenarioFile.read` takes.

    Raises
    ------
    ScenarioError
        If the format has no words for a part of the system.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), tr.Support(tr.Plane()))
    >>> describe(system, system.place((0.1, 0.0)))["body"]
    {'kind': 'solid-sphere', 'radius': 0.025, 'mass': 0.065}
    """
    words: Words = {
        "gravity": _number(system.gravity, "gravity"),
        "body": _body(system.body),
        "support": _support(system.support),
        "start": _start(system, start),
    }
    if system.loads:
        words["loads"] = [_one_of(_LOADS, load, f"loads[{i}]") for i, load in enumerate(system.loads)]
    return words


def _body(body: Body) -> Words:
    if not body.is_isotropic_sphere:
        raise _wordless("body", body)
    ratio = _number(body.inertia_ratio, "body.inertia_ratio")
    radius = getattr(body.shape, "radius", None)
    size = {"radius": _number(radius, "body.radius"), "mass": _number(body.mass, "body.mass")}
    if isinstance(body.inertia, Isotropic):  # its ratio would be rounded once more
        moment = _number(body.inertia.moment, "body.inertia.moment")
        return {"kind": "sphere-with-moment", **size, "moment_of_inertia": moment}
    if ratio == SOLID_SPHERE:
        return {"kind": "solid-sphere", **size}
    if ratio == HOLLOW_SPHERE:
        return {"kind": "hollow-sphere", **size}
    return {"kind": "sphere", **size, "inertia_ratio": ratio}


def _support(support: Support) -> Words:
    if type(support.surface) is not Plane:
        raise _wordless("support", support.surface)
    words: Words = {"kind": "plane", "tilt": _number(support.tilt, "support.tilt")}
    if support.surface.rim is not None:
        words["rim"] = _number(support.surface.rim, "support.rim")
    if support.friction is not None:
        words["friction"] = _number(support.friction, "support.friction")
    return {**words, "motion": _one_of(_MOTIONS, support.motion, "support.motion")}


_MOTIONS: dict[type, Callable[[Any, str], Words]] = {
    Fixed: lambda motion, key: {"kind": "fixed"},  # noqa: ARG005
    Spin: lambda motion, key: {"kind": "spin", "rate": _number(motion.rate, f"{key}.rate")},
}
_LOADS: dict[type, Callable[[Any, str], Words]] = {
    Force: lambda load, key: {"kind": "force", "value": _numbers(load.value, f"{key}.value")},
    Torque: lambda load, key: {"kind": "torque", "value": _numbers(load.value, f"{key}.value")},
    Drag: lambda load, key: {"kind": "drag", "coefficient": _number(load.coefficient, f"{key}.coefficient")},
}


def _start(system: RollingSystem, start: State) -> Words:
    if start.time != 0:
        raise ScenarioError("start.time", "must be 0: a scenario starts its clock", start.time)
    words: Words = {
        "position": _numbers(start.position[:2], "start.position"),
        "velocity": _numbers(start.velocity[:2], "start.velocity"),
    }
    if tuple(start.orientation) != (1.0, 0.0, 0.0, 0.0):
        words["orientation"] = _numbers(start.orientation, "start.orientation")
    turning = _numbers(start.angular_velocity, "start.angular_velocity")
    # The spin says it all where the rest of the angular velocity follows from it to the last digit.
    try:
        follows = system.place(**words, spin=turning[2])
    except InvalidValueError as error:
        raise ScenarioError(f"start.{error.key}", error.rule, error.received, error.remedy) from None
    if replace(follows, orientation=start.orientation) == replace(start, time=0.0):
        return {**words, "spin": turning[2]}
    return {**words, "angular_velocity": turning}


def _one_of(words: dict[type, Callable[[Any, str], Words]], thing: Any, key: str) -> Words:
    if type(thing) not in words:
        raise _wordless(key, thing)
    return words[type(thing)](thing, key)


def _number(value: Any, key: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        remedy = "Describe one member at a time."
        raise ScenarioError(key, "must be one number to be written to a file", value, remedy) from None
    if not math.isfinite(number):
        raise ScenarioError(key, "must be a finite number", value)
    return number


def _numbers(values: Any, key: str) -> list[float]:
    return [_number(value, f"{key}[{i}]") for i, value in enumerate(values)]


def _wordless(key: str, thing: Any) -> ScenarioError:
    kind = type(thing).__name__
    return ScenarioError(key, "must be of a kind that the scenario format has words for", kind, "Keep it in Python.")
