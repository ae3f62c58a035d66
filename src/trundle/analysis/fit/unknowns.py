"""The numbers that a fit may change: of the scenario, of the start of each run, of the camera and of the marks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import InvalidValueError, ScenarioError, TrundleError, UnknownNameError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.duals import value_of
from ...mechanics.nearest import closest_contact
from ...mechanics.scalars import namespace
from ...scenario import ScenarioFile
from ..sensitivities import keys
from .camera import Camera
from .observations import Observations

START = ("start.position", "start.velocity")
OUTSIDE = ("camera.", "mark.", "spot.", "gyroscope.")  # numbers that are not of the scenario
MOUNTING, BIAS = "gyroscope.mounting", "gyroscope.bias"
_HALVINGS = 40
_SMALL = 1e-8  # rad²: of a smaller turn the series has all digits


@dataclass(frozen=True)
class Unknown:
    """A number that a fit may change."""

    key: str  # such as "body.radius", "camera.scale" or "mark.position[0]"
    run: int | None  # of which run, where each has its own; None where all share it
    value: float  # where the fit begins, SI
    unit: str  # SI
    asked: bool  # whether the user named it; a start is found besides

    @property
    def name(self) -> str:
        """The key, with the number of the run where each has its own: "start.velocity[0] of run 2"."""
        return self.key if self.run is None else f"{self.key} of run {self.run + 1}"


def of_marks(seen: Observations) -> dict[str, tuple[float, str]]:
    """Return the numbers of what is seen beside the body, each with a first value and a unit.

    Examples
    --------
    >>> from .observations import observe
    >>> of_marks(observe({"t": [0, 1, 2, 3], "angle": [1, 2, 3, 4]}))
    {'mark.angle': (1.0, 'rad')}
    """
    found: dict[str, tuple[float, str]] = {}
    for mark, axes, where in (("mark", "xy", "mark.position"), ("spot", "xyz", "spot.position")):
        if any(f"{mark}_{axis}" in seen.columns for axis in axes):
            for i, axis in enumerate(axes):
                name = f"{mark}_{axis}"
                column = seen.column(name) if name in seen.columns else np.zeros(1)
                first = float(column[np.isfinite(column)][0]) if mark == "mark" else 0.0
                found[f"{where}[{i}]"] = (first, "m")
    if "angle" in seen.columns:
        column = seen.column("angle")
        found["mark.angle"] = (float(column[np.isfinite(column)][0]), "rad")
    if any(name.startswith("gyro_") for name in seen.columns):
        found |= {f"{MOUNTING}[{i}]": (0.0, "rad") for i in range(3)}
    return found


def prepared(scenario: ScenarioFile, free: Sequence[str], time: float) -> ScenarioFile:
    """Return the scenario with a start that can be varied, at the time of the first row, on a support without a rim.

    Where the rim is, is not known before the start is.

    Examples
    --------
    >>> import trundle as tr
    >>> corotating = tr.Scenario.load("level-turntable-corotating")
    >>> corotating.start.velocity, [float(v) for v in prepared(corotating, [], 2.0).start.velocity]
    ('co-rotating', [0.0, 0.17435839227423355])
    """
    start: Any = scenario.start
    update: dict[str, Any] = {"time": float(time)}
    at = scenario.start_state() if isinstance(start.velocity, str) or start.angular_velocity is not None else None
    if isinstance(start.velocity, str) and at is not None:
        update["velocity"] = tuple(float(part) for part in at.velocity[:2])
    asked = {name.partition("[")[0] for name in free}
    if start.angular_velocity is not None and scenario.support.friction is None:
        update |= {"angular_velocity": None, "spin": _spin(scenario)}
    elif ("start.spin" in asked or at is not None) and start.spin is None and start.angular_velocity is None:
        update["spin"] = _spin(scenario)
    fields_set = start.model_fields_set | set(update)
    begun = start.model_copy(update=update)
    begun.__pydantic_fields_set__ = fields_set
    return scenario.model_copy(update={"start": begun, "support": without_rim(scenario.support, asked)})


def _spin(scenario: ScenarioFile) -> float:
    """Return the rate at which the body turns about the normal as it starts."""
    at = scenario.start_state()
    place, turned = Vector(*at.position), Quaternion(*at.orientation)
    normal = closest_contact(scenario.system(), at.time, place, turned, at.support).normal
    return float(normal.dot(Vector(*at.angular_velocity)))


def without_rim(support: Any, asked: set[str]) -> Any:
    """Return the table of a support without a rim, unless that is asked for."""
    if getattr(support, "rim", None) is None or "support.rim" in asked:
        return support
    endless = support.model_copy(update={"rim": None})
    endless.__pydantic_fields_set__ = support.model_fields_set - {"rim"}
    return endless


def unknowns(
    scenario: ScenarioFile, free: Sequence[str], camera: Camera, seen: Sequence[Observations], *, start: bool
) -> list[Unknown]:
    """Return what is free, in the order of the question: what was asked for, the starts, the marks.

    Examples
    --------
    >>> import trundle as tr
    >>> from .observations import observe
    >>> seen = observe({"t": [0, 1, 2, 3], "x": [0, 1, 2, 3]})
    >>> table = prepared(tr.Scenario.load("tilted-turntable"), [], 0.0)
    >>> [one.name for one in unknowns(table, ["support.tilt"], Camera(), [seen], start=True)][:3]
    ['support.tilt', 'start.position[0]', 'start.position[1]']
    """
    of_camera = camera.numbers()
    found: list[Unknown] = []
    several = len(seen) > 1
    for name in free:
        if not isinstance(name, str):
            raise InvalidValueError("free", "must hold names of numbers", name, 'Write ["body.inertia_ratio"].')
        if name.startswith("camera."):
            mine = [key for key in of_camera if key == name or key.startswith(f"{name}[")]
            if not mine:
                extra = "" if camera.height is not None or name != "camera.height" else " (give camera={'height': …})"
                raise UnknownNameError("number of the camera" + extra, name, of_camera)
            found += [Unknown(key, None, float(of_camera[key][0]), of_camera[key][1], True) for key in mine]
            continue
        if name.startswith("gyroscope."):
            found += _of_gyroscope(name, seen)
            continue
        try:
            wanted = keys.chosen(scenario, [name])
        except InvalidValueError as error:
            raise InvalidValueError("free", error.rule, error.received, error.remedy) from None
        except UnknownNameError as error:
            raise UnknownNameError("number of the scenario", name, [*error.known, *of_camera]) from None
        shared = not (several and name.startswith("start."))
        for key in wanted:
            found += [
                Unknown(key.name, run, float(key.value), key.unit, True)
                for run in ([None] if shared else range(len(seen)))
            ]
    asked = {one.key for one in found}
    for i, one in enumerate(seen):
        run = i if several else None
        own = keys.chosen(scenario, _of_start(scenario, one)) if start else []
        found += [Unknown(k.name, run, float(k.value), k.unit, False) for k in own if k.name not in asked]
        found += [Unknown(k, run, v, unit, False) for k, (v, unit) in of_marks(one).items()]
    distinct: dict[str, Unknown] = {}
    for each in found:
        distinct.setdefault(each.name, each)
    return list(distinct.values())


def _of_start(scenario: ScenarioFile, seen: Observations) -> tuple[str, ...]:
    """Return the numbers of a start that are found: its spin where the turning of the body was measured.

    A cylinder has no spin. It is laid across its way, and one that is laid already, or lies still, has but one.
    """
    start: Any = scenario.start
    if scenario.system().body.shape.axis is None:
        return (*START, "start.spin") if seen.turning and start.spin is not None else START
    velocity = [float(part) for part in start.velocity[:2]]
    laid = start.orientation is not None or start.attitude is not None
    if not laid and any(velocity):
        return START
    ways = [i for i in range(2) if velocity[i]] or ([] if laid else [0])
    return ("start.position", *(f"start.velocity[{i}]" for i in ways))


def _of_gyroscope(name: str, seen: Sequence[Observations]) -> list[Unknown]:
    """Return the numbers of a gyroscope that were asked for, of each run that has one."""
    known = {f"{what}[{i}]": unit for what, unit in ((MOUNTING, "rad"), (BIAS, "rad/s")) for i in range(3)}
    mine = [key for key in known if key == name or key.startswith(f"{name}[")]
    if not mine:
        raise UnknownNameError("number of the gyroscope", name, known)
    runs = [i for i, one in enumerate(seen) if any(column.startswith("gyro_") for column in one.columns)]
    if not runs:
        remedy = "Name its columns gyro_x, gyro_y, gyro_z, or leave the number out."
        raise InvalidValueError("free", "must name numbers of what was measured", f"{name} without a gyroscope", remedy)
    several = len(seen) > 1
    return [Unknown(key, run if several else None, 0.0, known[key], True) for key in mine for run in runs]


def of_run(names: Sequence[Unknown], run: int) -> list[int]:
    """Return the places of the unknowns that one run depends on."""
    return [i for i, one in enumerate(names) if one.run in (None, run)]


# The scenario with other numbers


def changed(scenario: ScenarioFile, values: Mapping[str, float]) -> ScenarioFile:
    """Return the scenario, checked again, with other numbers; it refuses those that a file must not hold.

    Examples
    --------
    >>> import trundle as tr
    >>> changed(tr.Scenario.load("tilted-turntable"), {"start.velocity[1]": -0.05}).start.velocity
    (0.0, -0.05)
    """
    data = scenario.model_dump(exclude_unset=True, by_alias=True)
    for name, value in values.items():
        _put(data, scenario, _path(name), float(value))
    return type(scenario).read(data, scenario.title or "scenario")


def _path(name: str) -> list[str | int]:
    return [int(part) if part.isdigit() else part for part in name.replace("[", ".").replace("]", "").split(".")]


def _put(data: Any, model: Any, path: list[str | int], value: float) -> None:
    """Put a number where its path says; lists that stand there as tuples, or not at all, are made."""
    first, *rest = path
    inner = model[first] if isinstance(first, int) else _field(model, first)
    if not rest:
        data[first] = value
        return
    there = data[first] if isinstance(first, int) or first in data else None
    if there is None or isinstance(there, tuple):
        there = list(inner if there is None else there) if isinstance(inner, tuple) else {}
    data[first] = there
    _put(there, inner, rest, value)


def _field(model: Any, alias: str) -> Any:
    name = next(name for name, field in type(model).model_fields.items() if alias in (name, field.alias))
    return getattr(model, name)


def limit(scenario: ScenarioFile, name: str, good: float, bad: float) -> float | None:
    """Return the last value towards a bad one that a file may hold; None where that is allowed.

    Examples
    --------
    >>> import trundle as tr
    >>> abs(limit(tr.Scenario.load("off-the-rim"), "body.mass", 0.5, -0.1)) < 1e-9
    True
    """
    if name.startswith(OUTSIDE):
        positive = name in ("camera.scale", "camera.height")
        return 0.0 if positive and bad <= 0 else None
    if _allowed(scenario, name, bad):
        return None
    if bad < 0 < good and _allowed(scenario, name, 0.0):
        return 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if _allowed(scenario, name, middle) else (good, middle)
    return float(f"{good:.12g}") if _allowed(scenario, name, float(f"{good:.12g}")) else good


def _allowed(scenario: ScenarioFile, name: str, value: float) -> bool:
    try:
        changed(scenario, {name: value})
    except ScenarioError:
        return False
    except TrundleError:
        return True
    return True


def camera_with(camera: Camera, values: Mapping[str, Any]) -> Camera:
    """Return the camera with other numbers, which may be duals.

    Examples
    --------
    >>> camera_with(Camera(), {"camera.origin[1]": 0.5}).origin
    (0.0, 0.5)
    """
    update = {name: values[f"camera.{name}"] for name in ("scale", "rotation", "height", "time_offset")
              if f"camera.{name}" in values}  # fmt: skip
    origin = tuple(values.get(f"camera.origin[{i}]", part) for i, part in enumerate(camera.origin))
    plain = replace(camera)
    for name, value in {**update, "origin": origin}.items():
        object.__setattr__(plain, name, value)  # unchecked: a trial of the fit
    return plain


def vector_of(values: Mapping[str, Any], name: str, count: int) -> Vector:
    """Return a vector of marks by its components, zeros where it has fewer."""
    return Vector(*(values[f"{name}[{i}]"] if i < count else 0.0 for i in range(3)))


def turn_by(v: Vector) -> Quaternion:
    """Return the turn by a rotation vector, rad: smooth, and with slopes, at none as well.

    Examples
    --------
    >>> turn_by(Vector(0.0, 0.0, 0.0)), round(turn_by(Vector(0.0, 0.0, 1.0)).z, 12)
    (Quaternion(w=1.0, x=0.0, y=0.0, z=0.0), 0.479425538604)
    """
    square = v.dot(v)
    if float(np.max(value_of(square))) < _SMALL:
        w, share = 1.0 - square / 8.0, 0.5 - square / 48.0
    else:
        xp = namespace(square)
        angle = xp.sqrt(square)
        w, share = xp.cos(0.5 * angle), xp.sin(0.5 * angle) / angle
    return Quaternion(w, share * v.x, share * v.y, share * v.z)


def rotated(q: Any, along: Vector) -> Vector:
    """Return a vector of the body in space."""
    return Quaternion(*q).matrix() @ along
