"""What a controller drives: a force and a torque on the body, and the motion of a platform that carries the support.

Each is a part like any other, so that the law knows nothing of it: a load, and a motion that carries the support's own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from ..errors import UnknownNameError
from ..mechanics.algebra import ZERO, Matrix, Quaternion, Vector
from ..mechanics.loads import BodyMotion, Load
from ..mechanics.motions import Combined, Motion, SupportState
from ..mechanics.scalars import Scalar
from ..mechanics.system import RollingSystem

GROUPS = ("force", "torque", "support")
_AXES = ("x", "y", "z")


class Input(NamedTuple):
    """One input: its name, its unit, and the value that changes nothing."""

    name: str
    unit: str
    value: float = 0.0


def inputs_of(system: RollingSystem, groups: Sequence[str]) -> list[Input]:
    """Return the inputs of some groups.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> [name for name, *_ in inputs_of(level, ("torque",))]
    ['torque_x', 'torque_y', 'torque_z']
    """
    unknown = next((group for group in groups if group not in GROUPS), None)
    if unknown is not None:
        raise UnknownNameError("group of inputs", unknown, GROUPS)
    found: list[Input] = []
    for group in GROUPS:
        if group in groups:
            found += _of_support(system) if group == "support" else _vector(group, "N" if group == "force" else "N*m")
    return found


def _vector(name: str, unit: str) -> list[Input]:
    return [Input(f"{name}_{axis}", unit) for axis in _AXES]


def _of_support(system: RollingSystem) -> Iterator[Input]:
    yield from _vector("support", "m")
    yield from _vector("support_velocity", "m/s")
    yield from _vector("support_acceleration", "m/s^2")
    if not system.support.motion.free:  # an axle that turns freely may be shifted, not turned
        yield from (Input(f"support_q_{part}", "", float(part == "w")) for part in "wxyz")
        yield from _vector("support_angular_velocity", "rad/s")
        yield from _vector("support_angular_acceleration", "rad/s^2")


@dataclass(frozen=True)
class _Applied(Load):
    """A force and a torque given from outside."""

    given_force: Vector
    given_torque: Vector

    def force(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        """Return F."""
        return self.given_force

    def torque(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        """Return K."""
        return self.given_torque


@dataclass(frozen=True)
class _Platform(Motion):
    """What carries the support, its motion given from outside."""

    state: SupportState
    turns: bool = True

    def at(self, time: Scalar, *coordinates: Scalar) -> SupportState:  # noqa: ARG002
        """Return what is given."""
        return self.state


def with_inputs(system: RollingSystem, groups: Sequence[str], values: Sequence[Scalar]) -> RollingSystem:
    """Return a system that the inputs drive.

    Examples
    --------
    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> with_inputs(level, ("force",), [3.0, 0.0, 0.0]).loads[0].given_force.x
    3.0
    """
    rest = iter(values)

    def vector() -> Vector:
        return Vector(next(rest), next(rest), next(rest))

    if "force" in groups or "torque" in groups:
        force = vector() if "force" in groups else ZERO
        torque = vector() if "torque" in groups else ZERO
        system = replace(system, loads=(*system.loads, _Applied(force, torque)))
    if "support" not in groups:
        return system
    own = system.support.motion
    origin, velocity, acceleration = vector(), vector(), vector()
    if own.free:
        state = SupportState(Matrix.identity(), origin, velocity, acceleration, ZERO, ZERO)
    else:
        turn = Quaternion(next(rest), next(rest), next(rest), next(rest)).matrix()
        state = SupportState(turn, origin, velocity, acceleration, vector(), vector())
    carried = Combined((_Platform(state, turns=not own.free), own))
    return replace(system, support=replace(system.support, motion=carried))
