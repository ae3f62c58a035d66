"""What may be drawn over time, or against each other: the numbers of a run that only its mechanics can tell."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import Vector
from ...mechanics.invariants import Record
from ...mechanics.invariants.powers import MOVING_ENERGY, energies
from ...mechanics.symmetry import ball_of
from ...mechanics.system import RollingSystem
from ...solve.samples import FLIGHT, SLIPPING, Samples

if TYPE_CHECKING:
    from ...mechanics.motions import SupportState

Array = NDArray[np.float64]
PREFIX = "curve_"  # of the columns


class Curve(NamedTuple):
    """One quantity over the samples; where there is none it is not a number."""

    key: str
    label: str
    unit: str
    values: Array


def curves_of(system: RollingSystem, at: Samples) -> tuple[list[dict[str, str]], dict[str, NDArray[Any]]]:
    """Return what each curve is called, and their columns.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("level-turntable-nudged").run()
    >>> told, columns = curves_of(run.system, run.samples)
    >>> told[0], columns["curve_spin_normal"].shape
    ({'column': 'curve_spin_normal', 'label': 'Spin about the normal', 'unit': 'rad/s'}, (2001,))
    """
    found = list(_curves(system, at))
    told = [{"column": PREFIX + one.key, "label": one.label, "unit": one.unit} for one in found]
    return told, {PREFIX + one.key: one.values.astype(np.float32) for one in found}


def upwards(system: RollingSystem) -> Array:
    """Return the unit vector that points vertically up, in the support frame."""
    tilt = float(system.support.tilt)
    return np.array([-np.sin(tilt), 0.0, np.cos(tilt)])


def third_axis(at: Samples) -> Array:
    """Return the body's third axis (n, 3) in the support frame."""
    w, x, y, z = at.orientation.T
    return np.column_stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])


def angle_between(one: Array, other: Array) -> Array:
    """Return the angle between unit vectors (n, 3), degrees, precise also where it is small."""
    across = np.linalg.norm(np.cross(one, other), axis=-1)
    return np.degrees(np.arctan2(across, np.sum(one * other, axis=-1)))


def is_ball(system: RollingSystem) -> bool:
    """Tell whether the body is a sphere about its centre of mass, which rolls any way."""
    ball = ball_of(system.body)
    return ball is not None and ball.concentric


def _curves(system: RollingSystem, at: Samples) -> Iterator[Curve]:
    up, normals, touches = upwards(system), at.normals(system), at.phase != FLIGHT
    state = at.support(system)
    yield from _angles(system, at, up, np.where(touches[:, None], normals, np.nan))
    yield from _energies(system, at)
    if (at.phase == SLIPPING).any():
        slip = np.linalg.norm(slip_of(system, at), axis=1)
        yield Curve("slip", "Slip speed", "m/s", np.where(touches, slip, np.nan))
    yield from _forces(at, normals, touches)
    yield from _table(system, at, state)


def slip_of(system: RollingSystem, at: Samples) -> Array:
    """Return the slip velocity s = V + Ω×ρ − u (n, 3), m/s."""
    if at.slip_velocity is not None:
        return np.asarray(at.slip_velocity, dtype=float)
    V, turning, material = at.speeds(system)
    return np.asarray((V + turning - material).array(), dtype=float)


def _angles(system: RollingSystem, at: Samples, up: Array, normals: Array) -> Iterator[Curve]:
    spin = np.sum(at.angular_velocity * normals, axis=1)
    yield Curve("spin_normal", "Spin about the normal", "rad/s", spin)
    level = system.support.surface.flat and not float(system.support.tilt)
    if not level:
        yield Curve("spin_vertical", "Spin about the vertical", "rad/s", at.angular_velocity @ up)
    axis = third_axis(at)
    if not is_ball(system):
        yield Curve("lean", "Lean of its axis from the normal", "°", angle_between(axis, normals))
    if is_ball(system) or not level:
        yield Curve("pole", "Angle of its pole from the vertical", "°", angle_between(axis, up))


def _energies(system: RollingSystem, at: Samples) -> Iterator[Curve]:
    motion = at.motion(system)
    orbit, turning, *potentials = (np.broadcast_to(part, at.time.shape) for part in energies(system, motion))
    kinetic, potential = orbit + turning, sum(potentials, np.zeros(at.time.size))
    yield Curve("kinetic", "Kinetic energy", "J", kinetic)
    yield Curve("potential", "Potential energy", "J", potential)
    yield Curve("energy", "Kinetic and potential energy", "J", kinetic + potential)
    if system.support.motion.steady_rate:
        record = Record(motion, Vector.of(at.contact), at.support_columns)
        moving = np.asarray(sum(MOVING_ENERGY.terms(system, record)), dtype=float)
        yield Curve("moving", "Moving energy, E − ω·L", "J", np.broadcast_to(moving, at.time.shape))


def _forces(at: Samples, normals: Array, touches: NDArray[np.bool_]) -> Iterator[Curve]:
    along = np.sum(at.contact_force * normals, axis=1)
    across = np.linalg.norm(at.contact_force - along[:, None] * normals, axis=1)
    yield Curve("normal", "Normal force N", "N", np.where(touches, along, np.nan))
    share = np.full(at.time.size, np.nan)
    np.divide(across, along, out=share, where=touches & (along > 0))
    yield Curve("friction", "Friction needed, |f|/N", "", share)


def _table(system: RollingSystem, at: Samples, state: SupportState) -> Iterator[Curve]:
    if system.support.motion.steady_rate is None:
        rate = np.asarray(state.angular_velocity.dot(state.axle), dtype=float)
        yield Curve("table", "Rate of the support", "rad/s", np.broadcast_to(rate, at.time.shape))
