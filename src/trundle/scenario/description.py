"""From a rolling system and a start back to the words of a scenario file, in bare SI numbers."""

from __future__ import annotations

from dataclasses import replace

from ..errors import InvalidValueError, ScenarioError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import settle
from ..mechanics.system import RollingSystem, State, Support
from .words import LOADS, MOTIONS, SURFACES, Words, body_words, number_of, numbers_of, one_of


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
        "gravity": number_of(system.gravity, "gravity"),
        "body": body_words(system.body),
        "support": _support(system.support),
        "start": _start(system, start),
    }
    if system.loads:
        words["loads"] = [one_of(LOADS, load, f"loads[{i}]") for i, load in enumerate(system.loads)]
    return words


def _support(support: Support) -> Words:
    words = one_of(SURFACES, support.surface, "support")
    words["tilt"] = number_of(support.tilt, "support.tilt")
    if support.friction is not None:
        words["friction"] = number_of(support.friction, "support.friction")
    return {**words, "motion": one_of(MOTIONS, support.motion, "support.motion")}


def _start(system: RollingSystem, start: State) -> Words:
    if start.time != 0:
        raise ScenarioError("start.time", "must be 0: a scenario starts its clock", start.time)
    words = _place(system, start)
    if tuple(start.orientation) != (1.0, 0.0, 0.0, 0.0) or system.body.shape.axis is not None:
        words["orientation"] = numbers_of(start.orientation, "start.orientation")
    turning = numbers_of(start.angular_velocity, "start.angular_velocity")
    normal = settle(system, 0.0, Vector(*start.position), Quaternion(*start.orientation), start.support).normal
    spin = number_of(normal.dot(Vector(*start.angular_velocity)), "start.spin")
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
    surface, begin = system.support.surface, system.support.motion.at(0.0, *start.support)
    q = Quaternion(*start.orientation)
    contact = settle(system, 0.0, Vector(*start.position), q, start.support)
    own = begin.rotation.transpose @ (contact.point - begin.origin)
    V = begin.rotation.transpose @ Vector(*start.velocity)
    place = surface.put_down_at(own, begin.rotation.transpose @ contact.offset)
    return {
        "position": numbers_of(place, "start.position"),
        "velocity": numbers_of([V.dot(along) for along in surface.directions(own)], "start.velocity"),
    }
