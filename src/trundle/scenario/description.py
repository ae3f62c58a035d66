"""From a rolling system and a start back to the words of a scenario file, in bare SI numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

from ..errors import InvalidValueError, ScenarioError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.bodies import HOLLOW_SPHERE, SOLID_SPHERE, Body, Isotropic
from ..mechanics.contact import settle
from ..mechanics.expressions import Expression
from ..mechanics.loads import Drag, Force, Torque
from ..mechanics.motions import Fixed, Spin, UnevenSpin, Wobble
from ..mechanics.surfaces import Cylinder, Plane
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
    if not body.is_isotropic_sphere or (body.shape.axis is not None and isinstance(body.inertia, Isotropic)):
        raise _wordless("body", body)
    ratio = _number(body.inertia_ratio, "body.inertia_ratio")
    radius = getattr(body.shape, "radius", None)
    size = {"radius": _number(radius, "body.radius"), "mass": _number(body.mass, "body.mass")}
    if isinstance(body.inertia, Isotropic):  # its ratio would be rounded once more
        moment = _number(body.inertia.moment, "body.inertia.moment")
        return {"kind": "sphere-with-moment", **size, "moment_of_inertia": moment}
    if body.shape.axis is not None:
        return {"kind": "cylinder", **size, "inertia_ratio": ratio}
    if ratio == SOLID_SPHERE:
        return {"kind": "solid-sphere", **size}
    if ratio == HOLLOW_SPHERE:
        return {"kind": "hollow-sphere", **size}
    return {"kind": "sphere", **size, "inertia_ratio": ratio}


def _support(support: Support) -> Words:
    words = _one_of(_SURFACES, support.surface, "support")
    words["tilt"] = _number(support.tilt, "support.tilt")
    if support.friction is not None:
        words["friction"] = _number(support.friction, "support.friction")
    return {**words, "motion": _one_of(_MOTIONS, support.motion, "support.motion")}


def _plane(plane: Plane, key: str) -> Words:
    rim = {} if plane.rim is None else {"rim": _number(plane.rim, f"{key}.rim")}
    return {"kind": "plane", **rim}


def _cylinder(cylinder: Cylinder, key: str) -> Words:
    return {"kind": "cylinder", "radius": _number(cylinder.radius, f"{key}.radius"), "side": cylinder.side}


def _moving(kind: str, motion: Any, key: str) -> Words:
    """Return the words of a motion that is its numbers."""
    numbers = {part.name: _number(getattr(motion, part.name), f"{key}.{part.name}") for part in fields(motion)}
    return {"kind": kind, **numbers}


def _drag(load: Drag, key: str) -> Words:
    air = {} if load.air_rate == 0 else {"air": _number(load.air_rate, f"{key}.air")}
    return {"kind": "drag", "coefficient": _number(load.coefficient, f"{key}.coefficient"), **air}


_SURFACES: dict[type, Callable[[Any, str], Words]] = {Plane: _plane, Cylinder: _cylinder}
_MOTIONS: dict[type, Callable[[Any, str], Words]] = {
    Fixed: lambda motion, key: {"kind": "fixed"},  # noqa: ARG005
    Spin: lambda motion, key: _moving("spin", motion, key),
    UnevenSpin: lambda motion, key: _moving("uneven-spin", motion, key),
    Wobble: lambda motion, key: _moving("wobble", motion, key),
}
_LOADS: dict[type, Callable[[Any, str], Words]] = {
    Force: lambda load, key: {"kind": "force", "value": _numbers(load.value, f"{key}.value")},
    Torque: lambda load, key: {"kind": "torque", "value": _numbers(load.value, f"{key}.value")},
    Drag: _drag,
}


def _start(system: RollingSystem, start: State) -> Words:
    if start.time != 0:
        raise ScenarioError("start.time", "must be 0: a scenario starts its clock", start.time)
    words = _place(system, start)
    if tuple(start.orientation) != (1.0, 0.0, 0.0, 0.0) or system.body.shape.axis is not None:
        words["orientation"] = _numbers(start.orientation, "start.orientation")
    turning = _numbers(start.angular_velocity, "start.angular_velocity")
    normal = settle(system, 0.0, Vector(*start.position), Quaternion(*start.orientation)).normal
    spin = _number(normal.dot(Vector(*start.angular_velocity)), "start.spin")
    # The spin says it all where the rest of the angular velocity follows from it to the last digit.
    try:
        follows = system.place(**words, spin=spin)
    except InvalidValueError as error:
        raise ScenarioError(f"start.{error.key}", error.rule, error.received, error.remedy) from None
    if replace(follows, orientation=start.orientation) == replace(start, time=0.0):
        return {**words, "spin": spin}
    return {**words, "angular_velocity": turning}


def _place(system: RollingSystem, start: State) -> Words:
    """Return where the body is and how fast, in the surface's own coordinates."""
    surface, begin = system.support.surface, system.support.motion.at(0.0)
    centre = begin.rotation.transpose @ (Vector(*start.position) - begin.origin)
    V = begin.rotation.transpose @ Vector(*start.velocity)
    along = [V.dot(direction) for direction in surface.directions(centre)]
    return {
        "position": _numbers(surface.coordinates_of(centre), "start.position"),
        "velocity": _numbers(along, "start.velocity"),
    }


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


def _numbers(values: Any, key: str) -> list[Any]:
    return [
        value.text if isinstance(value, Expression) else _number(value, f"{key}[{i}]") for i, value in enumerate(values)
    ]


def _wordless(key: str, thing: Any) -> ScenarioError:
    kind = type(thing).__name__
    return ScenarioError(key, "must be of a kind that the scenario format has words for", kind, "Keep it in Python.")
