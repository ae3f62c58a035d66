"""The samples of a run as columns: what moves, in the inertial support frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.motions import SupportState
from ...mechanics.system import RollingSystem
from ...solve.exact import ClosedForm
from ...solve.samples import ROLLING, Samples

if TYPE_CHECKING:
    from ...simulation.trajectory import Trajectory

Array = NDArray[np.float64]

UNITS = {
    "time": "s",
    "position": "m",
    "contact": "m",
    "velocity": "m/s",
    "angular_velocity": "rad/s",
    "contact_force": "N",
    "support_position": "m",
    "guiding_centre": "m",
    "body_vertices": "m",
    "support_vertices": "m",
}
VECTORS = ("position", "contact", "velocity", "angular_velocity", "contact_force")


def columns_of(at: Samples) -> dict[str, NDArray[Any]]:
    """Return the body's columns."""
    vectors = {name: getattr(at, name).astype(np.float32) for name in VECTORS}
    return {
        "time": np.asarray(at.time, dtype=np.float64),
        **vectors,
        "orientation": continuous(at.orientation).astype(np.float32),
        "phase": at.phase.astype(np.uint8),
    }


def moves(system: RollingSystem) -> bool:
    """Tell whether a system's support moves at all."""
    return system.support.motion.steady_rate != 0.0


def pose_of(system: RollingSystem, at: Samples, state: SupportState) -> dict[str, NDArray[Any]]:
    """Return the columns of a moving support's pose."""
    n, rate = at.time.size, system.support.motion.steady_rate
    coordinates = (
        {"support_coordinates": np.asarray(at.support_coordinates, dtype=np.float64)}
        if at.support_coordinates.shape[1]
        else {}
    )
    turned = _quaternions(rotations(state, n)) if rate is None else _about_third_axis(float(rate) * at.time)
    origin = np.broadcast_to(state.origin.array(), (n, 3))
    return {
        "support_position": origin.astype(np.float32),
        "support_orientation": continuous(turned).astype(np.float32),
        **coordinates,
    }


def guiding_centre(run: Trajectory, form: ClosedForm | None, at: Samples) -> dict[str, NDArray[Any]]:
    """Return the column of the point about which a ball circles, where a closed form has one throughout."""
    circle = None if form is None else form.circle
    if circle is None or (at.phase != ROLLING).any():
        return {}
    centre = circle.centre_at(at.time - run.start.time)
    return {"guiding_centre": np.column_stack([centre.real, centre.imag, 0.0 * at.time]).astype(np.float32)}


def rotations(state: SupportState, count: int) -> Array:
    """Return the rotation matrices (n, 3, 3) of a support, its own frame to the support frame."""
    rows = [np.broadcast_to(row.array(), (count, 3)) for row in state.rotation.rows]
    return np.stack(rows, axis=1)


def material(at: Samples, state: SupportState, points: Array) -> Array:
    """Return where points are in the support's own frame, (n, 3), m."""
    turn = rotations(state, at.time.size)
    return np.einsum("nji,nj->ni", turn, points - state.origin.array())


def _about_third_axis(angle: Array) -> Array:
    half = 0.5 * angle
    return np.column_stack([np.cos(half), 0.0 * half, 0.0 * half, np.sin(half)])


def _quaternions(matrices: Array) -> Array:
    from scipy.spatial.transform import Rotation

    try:
        found = Rotation.from_matrix(matrices, assume_valid=True)
    except TypeError:  # before SciPy 1.17, which takes twenty times as long to make sure
        found = Rotation.from_matrix(matrices)
    return np.roll(found.as_quat(), 1, axis=1)


def continuous(quaternions: Array) -> Array:
    """Return unit quaternions (n, 4), each with the sign that is nearer to the one before."""
    against = np.sum(quaternions[1:] * quaternions[:-1], axis=1) < 0
    flips = np.concatenate([[0], np.cumsum(against)]) % 2
    return quaternions * np.where(flips, -1.0, 1.0)[:, None]
