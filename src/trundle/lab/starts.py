"""A start made by hand, in the words of a scenario: a body was dragged, thrown, or goes on after a nudge."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError, OutOfDomainError, TrundleError
from ..mechanics.algebra import Vector
from ..mechanics.motions import SupportState
from ..mechanics.symmetry import same_at_all_times
from ..scenario.fields import written

if TYPE_CHECKING:
    from ..simulation.simulate import Scenario

_DIGITS = 9
_NEAR = 0.5  # of the body's size: what is picked on a mesh lies this near to the surface
_ROUNDING = 1e-12


@dataclass(frozen=True)
class _Place:
    """A body on its support, the support as it stands when the run is to begin; vectors in the support's own frame."""

    scenario: Scenario
    begin: SupportState
    contact: Vector
    offset: Vector  # from the centre of mass to the contact

    @property
    def coordinates(self) -> list[float]:
        """Where a scenario says that it is put down."""
        surface = self.scenario.system().support.surface
        there = surface.point(*surface.coordinates_of(self.contact))
        if not (there - self.contact).norm() <= _NEAR * self.offset.norm():
            raise OutOfDomainError(
                "No run can start here: the surface overhangs, and a start says its place by coordinates that stand "
                "for another place there. Go on from another instant."
            )
        return _numbers(surface.coordinates_from_contact(self.contact, self.offset))

    def along(self, velocity: Vector, *, normal: bool = False) -> list[float]:
        """Return a velocity of the inertial frame along the surface, and along its normal if wanted."""
        surface = self.scenario.system().support.surface
        axes = [*surface.directions(self.contact), *([surface.normal(self.contact)] if normal else [])]
        turned = self.begin.rotation.transpose @ velocity
        return _numbers(turned.dot(axis) for axis in axes)

    def spin(self, turning: Vector) -> float:
        """Return the part of an angular velocity of the inertial frame along the normal."""
        normal = self.scenario.system().support.surface.normal(self.contact)
        return _number((self.begin.rotation.transpose @ turning).dot(normal))


def start_by_hand(
    scenario: Scenario,
    at: Mapping[str, Any],
    velocity: Sequence[float] | None = None,
    nudge: Sequence[float] | None = None,
) -> dict[str, Any]:
    """Return what changes in the start of a scenario: as `nudged`, as `thrown`, or else as `dragged`.

    Examples
    --------
    >>> import trundle as tr
    >>> at = {"position": [0.0, 0.0, 0.014], "contact": [0.0, 0.0, 0.0]}
    >>> start_by_hand(tr.Scenario.load("ball-in-a-funnel"), at)
    Traceback (most recent call last):
    ...
    trundle.errors.OutOfDomainError: No run can start here: the surface is not smooth here. Choose another place.
    """
    try:
        if nudge is not None:
            return nudged(scenario, at, nudge)
        return dragged(scenario, at) if velocity is None else thrown(scenario, at, velocity)
    except TrundleError:
        raise
    except (ArithmeticError, ValueError):
        said = "No run can start here: the surface is not smooth here. Choose another place."
        raise OutOfDomainError(said) from None


def dragged(scenario: Scenario, at: Mapping[str, Any]) -> dict[str, Any]:
    """Return the start of a body that is put down elsewhere.

    Examples
    --------
    >>> import trundle as tr
    >>> at = {"position": [0.1, -0.2, 0.025], "contact": [0.1, -0.2, 0.0]}
    >>> dragged(tr.Scenario.load("tilted-turntable"), at)
    {'position': [0.1, -0.2]}
    """
    found: dict[str, Any] = {"position": _place(scenario, at, _begin(scenario)).coordinates}
    start, rough = scenario.start, scenario.support.friction is not None
    if start.angular_velocity is not None and not (rough or start.height or isinstance(start.velocity, str)):
        found["velocity"] = "rolling"  # it did, there
    return found


def thrown(scenario: Scenario, at: Mapping[str, Any], velocity: Sequence[float]) -> dict[str, Any]:
    """Return the start of a body that is given another velocity; None takes a key away.

    Examples
    --------
    >>> import trundle as tr
    >>> at = {"position": [0.1, -0.2, 0.025], "contact": [0.1, -0.2, 0.0]}
    >>> thrown(tr.Scenario.load("tilted-turntable"), at, (0.5, 0.0, 0.0))
    {'velocity': [0.5, 0.0]}
    """
    found: dict[str, Any] = {"velocity": _place(scenario, at, _begin(scenario)).along(Vector(*velocity))}
    if scenario.start.angular_velocity is not None and scenario.support.friction is None:
        found["angular_velocity"] = None  # nothing slips here: it went with the old velocity
    return found


def nudged(scenario: Scenario, at: Mapping[str, Any], by: Sequence[float]) -> dict[str, Any]:
    """Return the start that goes on from an instant of a run with its velocity changed.

    Where the support grips as much as it takes the body rolls on at once, with the spin it had; else the nudge goes
    through its centre and leaves its turning as it was. What moves by the clock goes on by it.

    Examples
    --------
    >>> import trundle as tr
    >>> at = {"position": [0.1, -0.2, 0.025], "contact": [0.1, -0.2, 0.0], "velocity": [0.3, 0.0, 0.0], "time": 2.0}
    >>> at |= {"angular_velocity": [1.0, 2.0, 3.0], "orientation": [1.0, 0.0, 0.0, 0.0]}
    >>> nudged(tr.Scenario.load("tilted-turntable"), at, (0.1, 0.0, 0.0))["velocity"]
    [0.4, 0.0]
    """
    system, own = scenario.system(), at.get("support") or ()
    motion, clock = system.support.motion, not same_at_all_times(system)
    if clock and len(own) != len(motion.coordinates):
        raise InvalidValueError("at.support", f"must hold {', '.join(motion.coordinates) or 'nothing'}", own)
    begin = motion.at(at["time"], *own) if clock else _begin(scenario)
    place, height, turning = _place(scenario, at, begin), at.get("height"), at["angular_velocity"]
    found: dict[str, Any] = {
        "position": place.coordinates,
        "velocity": place.along(Vector(*at["velocity"]) + Vector(*by), normal=height is not None),
        "orientation": _numbers(at["orientation"]),
    }
    if clock:
        found |= {"time": _number(at["time"])} | ({"support": _numbers(own)} if own else {})
    elif "time" in scenario.start.model_fields_set:
        found["time"] = written(scenario.start.time)
    if height is not None:
        found["height"] = _number(height)
    if height is not None or system.support.friction is not None:
        return found | {"angular_velocity": _numbers(turning)}
    return found | {"spin": place.spin(Vector(*turning))}


def _begin(scenario: Scenario) -> SupportState:
    """Return the support as it stands where the run begins."""
    motion, start = scenario.system().support.motion, scenario.start
    own = motion.initial_coordinates() if start.support is None else tuple(map(float, start.support))
    return motion.at(float(start.time), *own)


def _place(scenario: Scenario, at: Mapping[str, Any], begin: SupportState) -> _Place:
    contact, centre = Vector(*at["contact"]), Vector(*at["position"])
    return _Place(scenario, begin, begin.local(contact), begin.rotation.transpose @ (contact - centre))


def _number(value: Any) -> float:
    """Return a number without what single precision leaves of it, and of a zero that was turned to and fro."""
    if not math.isfinite(value):
        raise OverflowError
    return 0.0 if abs(value) < _ROUNDING else float(f"{float(value):.{_DIGITS}g}")


def _numbers(values: Any) -> list[float]:
    return [_number(value) for value in values]
