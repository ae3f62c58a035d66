"""Conditions of which the domains of closed forms are put together: what each asks for, and what to say where it fails.

Those that several forms ask for stand here; one that a form alone asks for stands in its file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from ...mechanics.algebra import Vector
from ...mechanics.loads import Drag, Load, QuadraticDrag, RollingCouple, RollingResistance, constant_part
from ...mechanics.motions import FreeAxle, Motion
from ...mechanics.records import remembered
from ...mechanics.scalars import is_number, is_zero
from ...mechanics.surfaces import Surface
from ...mechanics.system import RollingSystem

PARTS, FORCES, START = range(3)  # what a condition is about: each is asked only of what passes those before


@dataclass(frozen=True)
class Condition:
    """One thing that a closed form asks of a system, or of a start.

    Parameters
    ----------
    words : str
        What it asks for, as the sentence on the domain goes on; empty where that is clear without.
    failures : callable
        Names what of a (system, start) fails it.
    about : int
        `PARTS`, `FORCES` or `START`.
    """

    words: str
    failures: Callable[[RollingSystem, Any], Iterable[str]]
    about: int = PARTS


def that(holds: Callable[[RollingSystem], bool], words: str, failure: str, about: int = PARTS) -> Condition:
    """Return a condition that holds or fails.

    Examples
    --------
    >>> import trundle as tr
    >>> coin = tr.RollingSystem(tr.Body.hoop(1.0, 1.0), tr.Support(tr.Plane(), tilt=0.1))
    >>> level = that(lambda system: system.support.tilt == 0, ", level", "the support leans")
    >>> level.failures(coin, None)
    ('the support leans',)
    """
    return Condition(words, lambda system, start: () if holds(system) else (failure,), about)  # noqa: ARG005


def on(*surfaces: type[Surface]) -> Condition:
    """Return the condition that the surface is one of these.

    Examples
    --------
    >>> from trundle.mechanics.surfaces import Bowl, Dome
    >>> on(Bowl, Dome).words
    ', on a bowl or dome'
    """
    *others, last = (surface.kind for surface in surfaces)
    names = f"{', '.join(others)} or {last}" if others else last

    def failures(system: RollingSystem, start: Any) -> Iterable[str]:  # noqa: ARG001
        if not isinstance(system.support.surface, surfaces):
            yield f"the surface is a {system.support.surface.word}, not a {names}"

    return Condition(f", on a {names}", failures)


def moving(holds: Callable[[Any], bool], words: str, kind: str) -> Condition:
    """Return the condition that the support's motion is of a kind."""

    def failures(system: RollingSystem, start: Any) -> Iterable[str]:  # noqa: ARG001
        if not holds(system.support.motion):
            yield f"the support's motion, {system.support.motion.word}, is no {kind}"

    return Condition(words, failures)


def under(words: str, failure: str, *others: type[Load] | Callable[[Load], Any]) -> Condition:
    """Return the condition that each load is constant, or of one of some other kinds.

    Examples
    --------
    >>> import trundle as tr
    >>> still = under(", under gravity and still air", "not of still air", tr.QuadraticDrag, linear_drag)
    >>> ball, table = tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())
    >>> list(still.failures(tr.RollingSystem(ball, table, (tr.Drag(0.1), tr.Magnus(0.1))), None))
    ['the load magnus is not of still air']
    """

    def allowed(load: Load) -> bool:
        kinds = (isinstance(load, one) if isinstance(one, type) else one(load) for one in others)
        return load.constant or any(kinds)

    def failures(system: RollingSystem, start: Any) -> Iterable[str]:  # noqa: ARG001
        return (f"the load {load.word} is {failure}" for load in system.loads if not allowed(load))

    return Condition(words, failures)


def linear_drag(load: Load) -> bool:
    """Tell whether a load is linear drag in still air."""
    return load.linear_drag is not None


@remembered
def constant_forces(system: RollingSystem) -> tuple[Vector, Vector]:
    """Return the sum of the constant loads, force and torque about the centre of mass, N and N m.

    Examples
    --------
    >>> import trundle as tr
    >>> ball, table = tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())
    >>> constant_forces(tr.RollingSystem(ball, table, (tr.Drag(0.1),)))[0].z
    -9.80665
    """
    force, torque, _ = constant_part(tuple(load for load in system.all_loads if load.constant), system.body.mass)
    return force, torque


def turns_freely(motion: Motion) -> bool:
    """Tell whether a support turns on a free axle on which nothing else acts.

    Examples
    --------
    >>> turns_freely(FreeAxle(0.5, 2.0)), turns_freely(FreeAxle(0.5, 2.0, bearing_drag=0.1))
    (True, False)
    """
    if not isinstance(motion, FreeAxle):
        return False
    return all(is_zero(part) for part in (motion.motor_torque, motion.bearing_drag, motion.bearing_torque))


def _steady(motion: Motion) -> bool:
    return motion.steady_rate is not None


def _rests(system: RollingSystem) -> bool:
    rate = system.support.motion.steady_rate
    return rate is not None and is_zero(rate)


def _ball(system: RollingSystem) -> bool:
    return system.body.is_isotropic_sphere and system.body.shape.axis is None


def _along_normal(system: RollingSystem) -> bool:
    force, torque = constant_forces(system)
    return all(map(is_zero, (force.x, force.y, *torque)))


def _pressed(system: RollingSystem) -> bool:
    down = constant_forces(system)[0].z
    return not is_number(down) or down <= 0


RESISTANCES = (Drag, QuadraticDrag, RollingCouple, RollingResistance)  # nothing on a body at rest, in still air
_ISOTROPIC = "with isotropic inertia about its centre"
ROUND = that(
    lambda system: system.body.is_isotropic_sphere,
    f"a sphere or cylinder {_ISOTROPIC}",
    f"the body is no sphere or cylinder {_ISOTROPIC}",
)
SPHERE = that(_ball, f"a sphere {_ISOTROPIC}", f"the body is no sphere {_ISOTROPIC}")
ANY_BODY = that(lambda _: True, "any body", "")
AT_REST = that(_rests, " at rest", "the support moves")
TURNING_STEADILY = moving(_steady, " that is fixed or turns steadily about its axis", "steady turn")
TURNING_FREELY = moving(
    turns_freely,
    " that turns freely on an axle, without motor or bearing torque",
    "turn on an axle without motor or bearing torque",
)
TURNING_SO_OR_SO = moving(
    lambda motion: _steady(motion) or turns_freely(motion),
    " that is fixed or turns about its axis, steadily or freely",
    "steady or free turn",
)
CONSTANT_LOADS = under(", under gravity and constant loads", "not constant")
STILL_AIR = that(
    lambda system: all(is_zero(getattr(load, "air", 0.0)) for load in system.loads), ", in still air", "the air moves"
)
NO_TORQUE = that(
    lambda system: not any(constant_forces(system)[1]), ", without torque", "a torque acts on the body", FORCES
)
ALONG_NORMAL = that(
    _along_normal,
    " along its normal",
    "gravity or a force pushes along the plane, or a torque acts",
    FORCES,
)
PRESSED = that(_pressed, "", "the plane does not press on the body", FORCES)
