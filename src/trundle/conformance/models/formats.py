"""The formats of models, by the ending of the file's name, and what each of them cannot say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ...errors import ScenarioError, UnknownNameError
from ...simulation.simulate import Scenario
from ..case import Task
from ..rolling import Rolling
from . import mjcf, sdf, urdf
from .writing import lone_body, row

_RESTS = 1e-12  # m/s and rad/s


@dataclass(frozen=True)
class ModelFormat:
    """One format.

    Parameters
    ----------
    title : str
        Its name.
    write : callable
        Takes what is said on top, and a situation; returns the text.
    shapes : tuple of str
        That it has words for.
    bounces : bool
        Whether it has a coefficient of restitution.
    moving : bool
        Whether it says how the motion starts.
    alone : bool
        Whether it says the body, and nothing else.

    Examples
    --------
    >>> from trundle.conformance.models import FORMATS
    >>> FORMATS[".urdf"].alone
    True
    """

    title: str
    write: Callable[[str, Task], str]
    shapes: tuple[str, ...]
    bounces: bool = False
    moving: bool = False
    alone: bool = False


FORMATS = {
    ".xml": ModelFormat("MJCF", mjcf.write, ("sphere", "disc", "ellipsoid"), moving=True),
    ".sdf": ModelFormat("SDFormat", sdf.write, ("sphere", "disc", "ellipsoid"), bounces=True),
    ".urdf": ModelFormat("URDF", urdf.write, ("sphere", "disc"), bounces=True, alone=True),
}


def engine_model(scenario: Scenario, ending: str) -> tuple[str, str]:
    """Return a scenario as a model that physics engines read, and what the reader must be told besides.

    The world's axes are those of the support: where it is tilted, gravity leans. The body's frame lies at its centre
    of mass, along the body's axes.

    Parameters
    ----------
    scenario : Scenario
        Of a sphere, disc or ellipsoid on a plane or a dome that is at rest or turns on a free axle.
    ending : str
        ".xml" for MJCF, ".sdf" or ".urdf".

    Returns
    -------
    text : str
        The model.
    unsaid : str
        A sentence on what the format has no place for; empty where it says all.

    Raises
    ------
    UnknownNameError
        If there is no such format.
    ScenarioError
        If the format cannot say a part of the scenario.

    Examples
    --------
    >>> import trundle as tr
    >>> text, unsaid = engine_model(tr.Scenario.load("billiard-draw"), ".xml")
    >>> "<keyframe>" in text, unsaid
    (True, '')
    """
    if ending.lower() not in FORMATS:
        raise UnknownNameError("format of models", ending, FORMATS)
    form = FORMATS[ending.lower()]
    situation = Rolling.of(scenario.title, scenario).situation()
    _check(scenario, situation, form)
    unsaid = _unsaid(situation, form)
    return form.write(f"{scenario.title}. {unsaid}".strip(), situation), unsaid


def _check(scenario: Scenario, situation: Task, form: ModelFormat) -> None:
    """Refuse what the format cannot say."""
    support = scenario.system().support
    body = lone_body(situation)

    def refuse(key: str, rule: str, received: Any, remedy: str = "") -> ScenarioError:
        return ScenarioError(key, f"{rule} in {form.title}", received, remedy, scenario.title)

    if body["shape"]["kind"] not in form.shapes:
        raise refuse("body.kind", f"must be one of {', '.join(form.shapes)}", body["shape"]["kind"])
    if situation["support"]["motion"]["kind"] == "driven":
        remedy = 'Take kind = "free-axle" with a moment of inertia: an engine turns that by itself.'
        raise refuse("support.motion.kind", "must be at rest or on an axle", support.motion.kind, remedy)
    if support.kinetic_friction not in (None, support.friction):
        rule = "must be that of rest, since there is one coefficient"
        raise refuse("support.kinetic_friction", rule, support.kinetic_friction)
    if situation["restitution"] and not form.bounces:
        raise refuse("support.restitution", "must be 0, which is all that there is", situation["restitution"])


def _unsaid(situation: Task, form: ModelFormat) -> str:
    """Say what the format has no place for, with the numbers."""
    body, support = lone_body(situation), situation["support"]
    motion, told = support["motion"], []
    if form.alone:
        ground = f"a dome of radius {_listed([support['radius']])} m" if support["kind"] == "dome" else "a plane"
        if motion["kind"] == "hinge":
            inertia = _listed([motion["inertia"]])
            ground += f" on an axle along z, with a moment of inertia of {inertia} kg m^2"
        told += [f"the support, {ground}, its top at the origin", f"friction {_listed([situation['friction']])}"]
        told += [f"restitution {_listed([situation['restitution']])}", f"gravity {_listed(situation['gravity'])} m/s^2"]
        told += [f"position {_listed(body['position'])} m", f"orientation (w, x, y, z) {_listed(body['orientation'])}"]
    if not form.moving:
        rate = [motion["rate"]] if motion["kind"] == "hinge" else [0.0]
        for name, values, unit in (
            ("velocity", body["velocity"], "m/s"),
            ("angular velocity in the world's axes", body["angular_velocity"], "rad/s"),
            ("rate of the support", rate, "rad/s"),
        ):
            told += [f"{name} {_listed(values)} {unit}"] if max(map(abs, values)) > _RESTS else []
    return f"What {form.title} does not say, for you to tell the engine: {'; '.join(told)}." if told else ""


def _listed(values: list[float]) -> str:
    """Write one number, or several in brackets."""
    words = row(values).split()
    return words[0] if len(words) == 1 else f"({', '.join(words)})"
