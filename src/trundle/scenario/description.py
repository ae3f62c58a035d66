"""From a rolling system and a start back to the words of a scenario file, in bare SI numbers."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from ..errors import InvalidValueError, ScenarioError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.attitude import attitude, attitude_of
from ..mechanics.contact import Contact
from ..mechanics.nearest import closest_contact
from ..mechanics.placing import no_gap
from ..mechanics.system import RollingSystem, State, Support
from .serialize import Words, body_words, number_of, numbers_of, words_of

_DIGITS = (None, 15, 14, 13)  # as computed; and as someone may have written them
_ROUNDINGS = [(None, None), (15, 15), (15, None), (None, 15), (14, 14), (14, None), (13, 13)]  # of place, of motion
_AS_GOOD = 1e-15  # of a state's parts: no more than a rounding or two
_ROUNDING = 1e-12  # of a state's parts: below it other digits may do where these words do not


def describe(system: RollingSystem, start: State) -> Words:
    """Return all tables of a scenario but ``run``.

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
        words["loads"] = [words_of(load, f"loads[{i}]") for i, load in enumerate(system.loads)]
    return words


def _support(support: Support) -> Words:
    words = words_of(support.surface, "support")
    words["tilt"] = number_of(support.tilt, "support.tilt")
    for key in ("friction", "kinetic_friction"):
        if getattr(support, key) is not None:
            words[key] = number_of(getattr(support, key), f"support.{key}")
    for key in ("restitution", "tangential_restitution"):
        if getattr(support, key) != 0:
            words[key] = number_of(getattr(support, key), f"support.{key}")
    return {**words, "motion": words_of(support.motion, "support.motion")}


def _start(system: RollingSystem, start: State) -> Words:
    """Return the shortest words that put the body where it is, to the last digit where there are such."""
    q = Quaternion(*start.orientation)
    contact = closest_contact(system, start.time, Vector(*start.position), q, start.support)
    best = _nearest(system, start, _Seen(system, start, contact))
    if best.refused is not None:
        error = best.refused
        raise ScenarioError(f"start.{error.key}", error.rule, error.received, error.remedy)
    return best.words  # what is read off a round surface may come back a last digit off


@dataclass(frozen=True)
class _Told:
    """A way to say a start, how far from it that leads, and why it leads nowhere."""

    words: Words
    apart: float
    refused: InvalidValueError | None = None


def _nearest(system: RollingSystem, start: State, seen: _Seen) -> _Told:
    """Return the first words that lead to the start to the last digit, else those that lead nearest."""
    told: list[_Told] = []
    for turned, wording in itertools.product(seen.turned, (seen.short, seen.riding, seen.turning, seen.whole)):
        if wording == seen.whole and any(one.apart <= _AS_GOOD for one in told):
            continue
        for place, motion in _ROUNDINGS:
            told.append(_tell(system, start, {**seen.place(place), **turned, **wording(motion)}))
            if told[-1].apart == 0:
                return told[-1]
            if told[-1].apart > _ROUNDING:
                break  # other words are needed, not other digits
    return min(told, key=lambda one: one.apart)


def _tell(system: RollingSystem, start: State, words: Words) -> _Told:
    try:
        return _Told(words, _apart(system.place(**words), start))
    except InvalidValueError as error:
        return _Told(words, math.inf, error)


def _apart(told: State, start: State) -> float:
    """Return how far two states are apart, as a share of the size of each part."""
    pairs = [(getattr(told, part), getattr(start, part)) for part in ("position", "velocity", "angular_velocity")]
    pairs.append((told.orientation, start.orientation))
    return max(math.dist(here, there) / (math.hypot(*there) or 1.0) for here, there in pairs)


@dataclass(frozen=True)
class _Seen:
    """A start seen from its contact, and the ways to say it."""

    system: RollingSystem
    start: State
    contact: Contact

    @property
    def _along(self) -> tuple[Vector, Vector, Vector]:
        """Return the directions that a velocity is given along, and the normal."""
        turn = self.contact.support.rotation
        there = turn.transpose @ (self.contact.point - self.contact.support.origin)
        first, second = self.system.support.surface.directions(there)
        return turn @ first, turn @ second, self.contact.normal

    def place(self, digits: int | None) -> Words:
        """Return where the body is, and when."""
        contact, turn = self.contact, self.contact.support.rotation
        there = turn.transpose @ (contact.point - contact.support.origin)
        at = self.system.support.surface.coordinates_from_contact(there, turn.transpose @ contact.offset)
        words: Words = {"position": _rounded(numbers_of(at, "start.position"), digits)}
        gap = float((Vector(*self.start.position) + contact.offset - contact.point).dot(contact.normal))
        if gap > no_gap(contact, self.start.position):
            words["height"] = _rounded([gap], digits)[0]
        return {**words, **self._when}

    @property
    def _when(self) -> Words:
        """Return the instant, and where the support stands then, where that does not follow from it."""
        words: Words = {}
        if self.start.time != 0:
            words["time"] = number_of(self.start.time, "start.time")
        if tuple(self.start.support) != tuple(self.system.support.motion.initial_coordinates()):
            words["support"] = numbers_of(self.start.support, "start.support")
        return words

    @property
    def turned(self) -> list[Words]:
        """Return how the body is turned: by its attitude where that says it in a few digits, and by its quaternion."""
        q, shape = tuple(self.start.orientation), self.system.body.shape
        if q == (1.0, 0.0, 0.0, 0.0) and shape.axis is None:
            return [{}]
        whole: Words = {"orientation": numbers_of(q, "start.orientation")}
        if shape.axis is None and not self.system.body.is_isotropic_sphere:
            first, _, normal = self._along
            axes = (first, normal.cross(first), normal)
            angles = [float(angle) for angle in attitude_of(*axes, Quaternion(*q))]
            for digits in _DIGITS:
                words = _rounded(angles, digits)
                if tuple(attitude(*axes, *words)) == q:
                    return [{"attitude": words}, whole]
        return [whole]

    def _velocity(self, digits: int | None, size: int) -> list[float]:
        V = Vector(*self.start.velocity)
        speed = V.norm() + self.contact.support.material_velocity(self.contact.point).norm()
        return _rounded(numbers_of([V.dot(e) for e in self._along[:size]], "start.velocity"), digits, speed)

    def short(self, digits: int | None) -> Words:
        """Return the velocity along the surface and the spin: the rest follows from no slip."""
        Omega = Vector(*self.start.angular_velocity)
        spin = number_of(self.contact.normal.dot(Omega), "start.spin")
        return {"velocity": self._velocity(digits, 2), "spin": _rounded([spin], digits, Omega.norm())[0]}

    def riding(self, digits: int | None) -> Words:  # noqa: ARG002
        """Return the word for a body that is let go from rest on the support."""
        return {"velocity": "co-rotating"}

    def turning(self, digits: int | None) -> Words:
        """Return the velocity along the surface and all of the angular velocity."""
        turning = numbers_of(self.start.angular_velocity, "start.angular_velocity")
        return {"velocity": self._velocity(digits, 2), "angular_velocity": turning}

    def whole(self, digits: int | None) -> Words:
        """Return all of the velocity and of the angular velocity."""
        return {**self.turning(digits), "velocity": self._velocity(digits, 3)}


def _rounded(numbers: list[float], digits: int | None, size: float | None = None) -> list[float]:
    """Return numbers rounded to so many digits of the largest, or of a size: 0.3 for 0.30000000000000004."""
    largest = max(map(abs, numbers)) if size is None else float(size)
    if digits is None or largest == 0:
        return numbers
    return [round(number, digits - 1 - math.floor(math.log10(largest))) + 0.0 for number in numbers]
