"""From a rolling system and a start back to the words of a scenario file, in bare SI numbers."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

from ..errors import InvalidValueError, ScenarioError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.attitude import attitude_of
from ..mechanics.contact import Contact, settle
from ..mechanics.placing import SLIP_TOLERANCE
from ..mechanics.system import RollingSystem, State, Support
from .words import LOADS, MOTIONS, SURFACES, Words, body_words, number_of, numbers_of, one_of

_DIGITS = (None, 15, 14, 13)  # as computed; and as someone may have written them


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
    for key in ("friction", "kinetic_friction"):
        if getattr(support, key) is not None:
            words[key] = number_of(getattr(support, key), f"support.{key}")
    if support.restitution != 0:
        words["restitution"] = number_of(support.restitution, "support.restitution")
    return {**words, "motion": one_of(MOTIONS, support.motion, "support.motion")}


def _start(system: RollingSystem, start: State) -> Words:
    """Return the shortest words that put the body where it is, to the last digit where there are such."""
    if start.time != 0:
        raise ScenarioError("start.time", "must be 0: a scenario starts its clock", start.time)
    if tuple(start.support) != tuple(system.support.motion.own_start()):
        remedy = "Start it from `system.place(...)`, or give the motion another rate."
        raise ScenarioError("start.support", "must be as the motion itself starts", start.support, remedy)
    words: Words = {}
    refused: InvalidValueError | None = None
    for words in _wordings(system, start):
        try:
            told = system.place(**words)
        except InvalidValueError as error:
            refused = error
            continue
        refused = None
        if told == start:
            return words
    if refused is not None:
        raise ScenarioError(f"start.{refused.key}", refused.rule, refused.received, refused.remedy)
    return words  # what is read off a round surface may come back a last digit off


def _wordings(system: RollingSystem, start: State) -> Iterator[Words]:
    """Return ways to say a start, from the shortest to the one that leaves nothing to follow from the rest."""
    q = Quaternion(*start.orientation)
    contact = settle(system, 0.0, Vector(*start.position), q, start.support)
    gap = float((Vector(*start.position) + contact.offset - contact.point).dot(contact.normal))
    first, second, normal, at = _seen_from(system, contact)
    V, Omega = Vector(*start.velocity), Vector(*start.angular_velocity)
    place = numbers_of(at, "start.position")
    along = numbers_of([V.dot(first), V.dot(second)], "start.velocity")
    turning = {"angular_velocity": numbers_of(start.angular_velocity, "start.angular_velocity")}
    spins = {"spin": number_of(normal.dot(Omega), "start.spin")}
    height = {"height": gap} if gap > SLIP_TOLERANCE * contact.offset.norm() else {}
    upward = [number_of(V.dot(normal), "start.velocity[2]")]
    for more, turned, about in itertools.product(([], upward), (spins, turning), _orientations(system, start, contact)):
        for digits in _DIGITS:
            yield {
                "position": _rounded(place, digits),
                "velocity": _rounded([*along, *more], digits),
                **{key: _rounded([value], digits)[0] for key, value in height.items()},
                **about,
                **turned,
            }
    yield {"position": place, "velocity": [*along, *upward], **height, **about, **turned}


def _seen_from(system: RollingSystem, contact: Contact) -> tuple[Vector, Vector, Vector, tuple[Any, Any]]:
    """Return the directions that a start's velocity is given along, and the coordinates of its place."""
    surface, turn = system.support.surface, contact.support.rotation
    there = turn.transpose @ (contact.point - contact.support.origin)
    first, second = (turn @ along for along in surface.directions(there))
    return first, second, contact.normal, surface.put_down_at(there, turn.transpose @ contact.offset)


def _orientations(system: RollingSystem, start: State, contact: Contact) -> list[Words]:
    """Return ways to say how the body is turned."""
    straight = system.body.shape.axis is not None
    if tuple(start.orientation) == (1.0, 0.0, 0.0, 0.0) and not straight:
        return [{}]
    whole = {"orientation": numbers_of(start.orientation, "start.orientation")}
    if straight or system.body.is_isotropic_sphere:
        return [whole]
    first, _, normal, _ = _seen_from(system, contact)
    angles = list(attitude_of(first, normal.cross(first), normal, Quaternion(*start.orientation)))
    return [*({"attitude": _rounded(angles, digits)} for digits in _DIGITS), whole]


def _rounded(numbers: list[float], digits: int | None) -> list[float]:
    """Return numbers rounded to so many digits of the largest: 0.3 for 0.30000000000000004."""
    largest = max(map(abs, numbers))
    if digits is None or largest == 0:
        return numbers
    return [round(number, digits - 1 - math.floor(math.log10(largest))) + 0.0 for number in numbers]
