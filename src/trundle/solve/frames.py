"""The three frames that users are offered, and how a dataset goes from one to another.

"support" is inertial: third axis the support's, first axis down the slope. "world" is inertial: third axis
vertically up, second axis that of "support". "corotating" is fixed to the support's material, however that turns and
moves: its origin and axes are the support's own. For a steady turn it coincides with "support" at t = 0. Velocities,
angular velocities and orientation are those seen by somebody who rides on the support.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import OutOfDomainError
from ..mechanics.algebra import E_Z, Matrix, Quaternion, Vector
from ..mechanics.motions import Motion, SupportState
from ..mechanics.system import Support
from .samples import AT_ONCE

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]
Vectors = dict[Any, Vector]

FRAMES = ("support", "world", "corotating")
_STEP = 1.0  # rad: the support is followed in steps that turn it by less, so that half a turn is never missed
_PIECE = 200_000  # steps followed at once


def change(
    data: xarray.Dataset, support: Support, old: str, new: str, coordinates: Sequence[str] = ()
) -> xarray.Dataset:
    """Return a dataset with its vectors in another frame.

    Examples
    --------
    See `trundle.Trajectory.in_frame`.
    """
    for frame, forwards in ((old, False), (new, True)):
        if frame == "world":
            data = _tilted(data, float(support.tilt) * (1 if forwards else -1))
        elif frame == "corotating":
            rate = support.motion.steady_rate
            if rate is None:
                data = _carried(data, support.motion, coordinates, forwards)
            else:
                data = _turning(data, float(rate), forwards)
    return data.assign_attrs(frame=new)


def _tilted(data: xarray.Dataset, tilt: float) -> xarray.Dataset:
    """Turn every vector about the second axis: the support's e₁ = (cos α, 0, −sin α) in world axes."""
    c, s = np.cos(tilt), np.sin(tilt)
    turn = Matrix(Vector(c, 0.0, s), Vector(0.0, 1.0, 0.0), Vector(-s, 0.0, c))
    half = Quaternion(np.cos(tilt / 2), 0.0, np.sin(tilt / 2), 0.0)

    def seen(vectors: Vectors, _: slice) -> tuple[Vectors, Quaternion]:
        return {name: turn @ vector for name, vector in vectors.items()}, half

    return _changed(data, seen)


def _turning(data: xarray.Dataset, rate: float, forwards: bool) -> xarray.Dataset:
    """Go to the frame that turns steadily with the support, or back."""
    time, omega = data.time.values, Vector(0.0, 0.0, rate)

    def seen(vectors: Vectors, where: slice) -> tuple[Vectors, Quaternion]:
        angle = rate * time[where]
        c, s = np.cos(angle), np.sin(angle) * (-1 if forwards else 1)
        turn = Matrix(Vector(c, -s, 0.0), Vector(s, c, 0.0), E_Z)
        half = Quaternion(np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2) * (-1 if forwards else 1))
        if forwards:
            vectors["velocity"] = vectors["velocity"] - omega.cross(vectors["position"])
            vectors["angular_velocity"] = vectors["angular_velocity"] - omega
        turned = {name: turn @ vector for name, vector in vectors.items()}
        if not forwards:
            turned["velocity"] = turned["velocity"] + omega.cross(turned["position"])
            turned["angular_velocity"] = turned["angular_velocity"] + omega
        return turned, half

    return _changed(data, seen)


def _carried(data: xarray.Dataset, motion: Motion, names: Sequence[str], forwards: bool) -> xarray.Dataset:
    """Go to the frame that is fixed to a support that moves in any way, or back."""
    coordinates = _own(data, motion, names)
    time = np.asarray(data.time.values, dtype=float)
    followed = _followed(motion, time, coordinates)

    def seen(vectors: Vectors, where: slice) -> tuple[Vectors, Quaternion]:
        state, half = motion.at(time[where], *(part[where] for part in coordinates)), Quaternion.of(followed[where])
        turn = state.rotation
        if forwards:
            relative = {
                "velocity": vectors["velocity"] - state.material_velocity(vectors["position"]),
                "angular_velocity": vectors["angular_velocity"] - state.angular_velocity,
            }
            vectors |= relative | {name: vectors[name] - state.origin for name in _PLACES if name in vectors}
            back = turn.transpose
            return {name: back @ vector for name, vector in vectors.items()}, half.conjugate
        turned = {name: turn @ vector for name, vector in vectors.items()}
        turned |= {name: turned[name] + state.origin for name in _PLACES if name in turned}
        turned["velocity"] = turned["velocity"] + state.material_velocity(turned["position"])
        turned["angular_velocity"] = turned["angular_velocity"] + state.angular_velocity
        return turned, half

    return _changed(data, seen)


_PLACES = ("position", "contact")  # what counts from the support's origin


def _own(data: xarray.Dataset, motion: Motion, names: Sequence[str]) -> tuple[Array, ...]:
    """Return the coordinates of the support's own motion."""
    if len(names) != len(motion.coordinates) or any(name not in data for name in names):
        raise OutOfDomainError(
            "A corotating frame is defined where the support's motion is known: this one turns by an angle that is "
            "part of the run, and the data do not hold it. Use the frame 'support' or 'world'."
        )
    return tuple(np.asarray(data[name].values, dtype=float) for name in names)


def _followed(motion: Motion, time: Array, coordinates: tuple[Array, ...]) -> Array:
    """Return how the support has turned, (n, 4), with the sign that is continuous from the start of its motion on.

    The turn is a continuous function of the time and the support's own coordinates. Any way through these that joins
    the samples therefore gives the sign: straight from one to the next, in steps too small to miss half a turn.
    """
    points = np.column_stack([time, *coordinates])
    points = np.vstack([[0.0, *(float(value) for value in motion.initial_coordinates())], points])
    leaps = np.abs(np.diff(points, axis=0))
    fastest = motion.fastest_rate_within(float(np.min(points[:, 0])), float(np.max(points[:, 0])))
    parts = np.ceil((leaps[:, 0] * fastest + np.sum(leaps[:, 1:], axis=1)) / _STEP).astype(int)
    parts = np.maximum(parts, 1)
    ends = np.cumsum(parts)
    found = np.empty((len(time), 4))
    last = _quaternions(_at(motion, points[:1]), 1)[0]
    first = 0
    while first < len(time):
        stop = max(int(np.searchsorted(ends, (ends[first - 1] if first else 0) + _PIECE)), first + 1)
        count = parts[first:stop]
        share = (np.arange(np.sum(count)) - np.repeat(np.cumsum(count) - count, count) + 1) / np.repeat(count, count)
        here = np.repeat(points[first:stop], count, axis=0)
        way = here + share[:, None] * (np.repeat(points[first + 1 : stop + 1], count, axis=0) - here)
        way[np.cumsum(count) - 1] = points[first + 1 : stop + 1]
        q = _quaternions(_at(motion, way), len(way))
        against = np.sum(q * np.vstack([last, q[:-1]]), axis=1) < 0
        q = q * np.where(np.cumsum(against) % 2, -1.0, 1.0)[:, None]
        found[first:stop], last = q[np.cumsum(count) - 1], q[-1]
        first = stop
    return found


def _at(motion: Motion, points: Array) -> SupportState:
    return motion.at(points[:, 0], *points[:, 1:].T)


def _quaternions(state: SupportState, count: int) -> Array:
    """Return the unit quaternions (n, 4) of rotations, by way of their largest components, w not negative."""
    (a, b, c), (d, e, f), (g, h, i) = (tuple(row) for row in state.rotation.rows)
    rows = (
        (1.0 + a + e + i, h - f, c - g, d - b),
        (h - f, 1.0 + a - e - i, b + d, c + g),
        (c - g, b + d, 1.0 - a + e - i, f + h),
        (d - b, c + g, f + h, 1.0 - a - e + i),
    )
    table = np.stack([np.stack([np.broadcast_to(part, (count,)) for part in row]) for row in rows])
    chosen = np.argmax(np.stack([table[j, j] for j in range(4)]), axis=0)
    q = table[chosen, :, np.arange(count)]
    return q * np.where(q[:, :1] < 0, -1.0, 1.0) / np.linalg.norm(q, axis=1, keepdims=True)


def _changed(data: xarray.Dataset, seen: Callable[[Vectors, slice], tuple[Vectors, Quaternion]]) -> xarray.Dataset:
    """Return a dataset with other vectors and orientations, worked out some at a time: those seen, and the turn."""
    names = [name for name in data.data_vars if data[name].dims[1:] == ("axis",)]
    old = {name: data[name].values for name in (*names, "orientation")}
    new = {name: np.empty(array.shape) for name, array in old.items()}
    for first in range(0, data.time.size, AT_ONCE):
        where = slice(first, first + AT_ONCE)
        vectors, turn = seen({name: Vector.of(old[name][where]) for name in names}, where)
        for name, vector in vectors.items():
            new[name][where] = vector.array()
        new["orientation"][where] = (turn * Quaternion.of(old["orientation"][where])).array()
    return data.assign({name: data[name].copy(data=array) for name, array in new.items()})
