"""The dataset of a trajectory: which variables it has, in which units, and what it says of itself."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..mechanics.system import RollingSystem
from ..solve.compiled_steps import available
from ..solve.methods import Method
from ..solve.samples import FLIGHT, Samples

if TYPE_CHECKING:
    import xarray

PHASES = {0: "rolling", 1: "slipping", 2: "flight", 3: "resting"}

# The coordinates of a support that is free to move, or moves as a formula says -> (long name, unit)
_OWN = {
    "angle": ("angle by which the support has turned", "rad"),
    "rate": ("rate at which the support turns", "rad s-1"),
}

# Dataset variable -> (long name, unit)
_VECTORS = {
    "position": ("centre of mass", "m"),
    "contact": ("contact point on the support", "m"),
    "velocity": ("velocity of the centre of mass", "m s-1"),
    "angular_velocity": ("angular velocity of the body", "rad s-1"),
    "contact_force": ("contact force on the body", "N"),
    "slip_velocity": ("velocity of the body's material at the contact relative to the support's", "m s-1"),
}


def facts(system: RollingSystem) -> dict[str, tuple[tuple[str, ...], dict[str, Any]]]:
    """Return dimensions and attributes of every variable that a trajectory of a system has.

    Examples
    --------
    >>> import trundle as tr
    >>> facts(tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())))["velocity"]
    (('time', 'axis'), {'long_name': 'velocity of the centre of mass', 'units': 'm s-1'})
    """
    turning = {"long_name": "orientation, unit quaternion from body frame to this frame", "units": "1"}
    phase = {
        "long_name": "phase of the contact",
        "units": "1",
        "flag_values": np.array(list(PHASES), dtype=np.int8),
        "flag_meanings": " ".join(PHASES.values()),
    }
    coordinates = [
        _OWN[name.rstrip("_0123456789")] for name in system.support.motion.coordinates
    ]  # of two that turn: angle_2
    return {
        **{name: (("time", "axis"), _named(*said)) for name, said in _VECTORS.items()},
        "orientation": (("time", "quaternion"), turning),
        "phase": (("time",), phase),
        **{name: (("time",), _named(*said)) for name, said in zip(coordinate_names(system), coordinates, strict=True)},
    }


def size_of(system: RollingSystem) -> int:
    """Return how many bytes a sample takes in a dataset.

    Examples
    --------
    >>> import trundle as tr
    >>> size_of(tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())))
    185
    """
    widths = {"time": 1, "axis": 3, "quaternion": 4}
    numbers = [math.prod(widths[dim] for dim in dims) for dims, _ in facts(system).values()]
    return 8 * (1 + sum(numbers)) - 7  # the phase takes one byte


def _named(long_name: str, unit: str) -> dict[str, Any]:
    return {"long_name": long_name, "units": unit}


def columns(system: RollingSystem, samples: Samples) -> dict[str, Any]:
    """Return the values of every variable of a dataset.

    Examples
    --------
    See `Trajectory.data`.
    """
    return {
        **{name: getattr(samples, name) for name in _VECTORS if name != "slip_velocity"},
        "slip_velocity": _slip(system, samples),
        "orientation": samples.orientation,
        "phase": samples.phase.astype(np.int8, copy=False),
        **dict(zip(coordinate_names(system), samples.support_coordinates.T, strict=True)),
    }


def dataset(system: RollingSystem, samples: Samples, attributes: dict[str, Any]) -> xarray.Dataset:
    """Label the samples of a method.

    Examples
    --------
    See `Trajectory.data`.
    """
    import xarray

    arrays = columns(system, samples)
    variables = {
        # xarray would look whether they are of any package of arrays that it knows of, and import it first.
        name: xarray.Variable(dims, arrays[name], about, fastpath=True)
        for name, (dims, about) in facts(system).items()
    }
    return xarray.Dataset(variables, coords=coordinates(samples.time), attrs=attributes)


def coordinates(times: Any) -> dict[str, Any]:
    """Return the coordinates of a dataset: the instants, and the labels of vectors and quaternions.

    Examples
    --------
    >>> list(coordinates(np.array([0.0, 1.0])))
    ['time', 'axis', 'quaternion']
    """
    import pandas as pd

    return {
        # As pandas indexes: to make them, xarray would first import every package of arrays that it knows of.
        "time": (("time",), pd.Index(times), {"long_name": "time", "units": "s", "axis": "T"}),
        "axis": pd.Index(["x", "y", "z"], dtype=object),
        "quaternion": pd.Index(["w", "x", "y", "z"], dtype=object),
    }


def _slip(system: RollingSystem, samples: Samples) -> Any:
    """Return V + Ω×ρ − u, (n, 3), m/s; not a number where nothing touches."""
    found = np.empty_like(samples.position)
    for where, some in samples.blocks():
        V, carried, u = some.speeds(system)
        found[where] = (V + carried - u).array()
        found[where][some.phase == FLIGHT] = np.nan
    return found


def coordinate_names(system: RollingSystem) -> list[str]:
    """Return the names of the variables that hold the coordinates of the support's own motion.

    Examples
    --------
    >>> import trundle as tr
    >>> coordinate_names(tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())))
    []
    """
    names = system.support.motion.coordinates
    return [f"support_{name}" if names.count(name) == 1 else f"support_{name}_{i}" for i, name in enumerate(names)]


def attributes(title: str, method: Method) -> dict[str, Any]:
    """Return what a dataset says of itself: conventions, title, method, tolerance, frame and versions.

    Examples
    --------
    >>> attributes("A ball", Method("taylor", 1e-9))["tolerance"]
    1e-09
    """
    packages = {"taylor": ["heyoka"], "runge-kutta": ["scipy"]}.get(method.name, [])
    if method.name == "runge-kutta" and available():
        packages.append("numba")
    return {
        "Conventions": "CF-1.11",
        "title": title,
        "method": method.name,
        "tolerance": method.tolerance,
        "frame": "support",
        "source": ", ".join(f"{package} {_version(package)}" for package in ("trundle", "numpy", *packages)),
    }


@cache  # looked up in the files of the installation
def _version(package: str) -> str:
    from importlib.metadata import version

    return version(package)
