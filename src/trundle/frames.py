"""The three frames that users are offered, and how a dataset goes from one to another.

"support" is inertial: third axis the support's, first axis down the slope. "world" is inertial: third axis
vertically up, second axis that of "support". "corotating" turns with the support and coincides with "support" at
t = 0; velocities, angular velocities and orientation are those seen by somebody who turns with it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import OutOfDomainError
from .mechanics.algebra import E_Z, Matrix, Quaternion, Vector
from .mechanics.system import Support

if TYPE_CHECKING:
    import xarray

FRAMES = ("support", "world", "corotating")


def change(data: xarray.Dataset, support: Support, old: str, new: str) -> xarray.Dataset:
    """Return a dataset with its vectors in another frame.

    Parameters
    ----------
    data : xarray.Dataset
        A trajectory's data.
    support : Support
        Gives tilt and motion.
    old, new : str
        Two of `FRAMES`.

    Returns
    -------
    xarray.Dataset
        A new one.

    Raises
    ------
    OutOfDomainError
        If the support's motion is no steady turn, so that no corotating frame is defined.

    Examples
    --------
    See `trundle.Trajectory.in_frame`.
    """
    for frame, forwards in ((old, False), (new, True)):
        if frame == "world":
            data = _tilted(data, float(support.tilt) * (1 if forwards else -1))
        elif frame == "corotating":
            data = _turning(data, _rate(support), forwards)
    return data.assign_attrs(frame=new)


def _rate(support: Support) -> float:
    rate = support.motion.steady_rate
    if rate is None:
        raise OutOfDomainError("A corotating frame is defined for a support that turns steadily about its axis.")
    return float(rate)


def _tilted(data: xarray.Dataset, tilt: float) -> xarray.Dataset:
    """Turn every vector about the second axis: the support's e₁ = (cos α, 0, −sin α) in world axes."""
    c, s = np.cos(tilt), np.sin(tilt)
    turn = Matrix(Vector(c, 0.0, s), Vector(0.0, 1.0, 0.0), Vector(-s, 0.0, c))
    half = Quaternion(np.cos(tilt / 2), 0.0, np.sin(tilt / 2), 0.0)
    return _with(data, {name: turn @ vector for name, vector in _vectors(data).items()}, half)


def _turning(data: xarray.Dataset, rate: float, forwards: bool) -> xarray.Dataset:
    """Go to the frame that turns with the support, or back."""
    angle = rate * data.time.values
    c, s = np.cos(angle), np.sin(angle) * (-1 if forwards else 1)
    turn = Matrix(Vector(c, -s, 0.0), Vector(s, c, 0.0), E_Z)
    half = Quaternion(np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2) * (-1 if forwards else 1))
    omega, vectors = Vector(0.0, 0.0, rate), _vectors(data)
    carried = omega.cross(vectors["position"])
    if forwards:
        vectors["velocity"] = vectors["velocity"] - carried
        vectors["angular_velocity"] = vectors["angular_velocity"] - omega
    turned = {name: turn @ vector for name, vector in vectors.items()}
    if not forwards:
        turned["velocity"] = turned["velocity"] + omega.cross(turned["position"])
        turned["angular_velocity"] = turned["angular_velocity"] + omega
    return _with(data, turned, half)


def _vectors(data: xarray.Dataset) -> dict[Any, Vector]:
    return {name: Vector.of(data[name].values) for name in data.data_vars if data[name].dims[1:] == ("axis",)}


def _with(data: xarray.Dataset, vectors: dict[Any, Vector], turn: Quaternion) -> xarray.Dataset:
    changed = {name: data[name].copy(data=vector.array()) for name, vector in vectors.items()}
    q = turn * Quaternion.of(data.orientation.values)
    return data.assign({**changed, "orientation": data.orientation.copy(data=q.array())})
