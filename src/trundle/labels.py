"""The dataset of a trajectory: which variables it has, in which units, and what it says of itself."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from .mechanics.system import RollingSystem
from .solve.methods import Method
from .solve.samples import FLIGHT, Samples

if TYPE_CHECKING:
    import xarray

PHASES = {0: "rolling", 1: "slipping", 2: "flight", 3: "resting"}


@dataclass(frozen=True)
class Variable:
    """What a variable of a dataset is.

    Parameters
    ----------
    long_name : str
        In words.
    units : str
        As CF writes them.
    dims : tuple of str
        Its dimensions.
    dtype : str
        NumPy's name of its type.

    Examples
    --------
    >>> Variable("velocity of the centre of mass", "m s-1").dims
    ('time', 'axis')
    """

    long_name: str
    units: str
    dims: tuple[str, ...] = ("time", "axis")
    dtype: str = "float64"

    @property
    def attributes(self) -> dict[str, Any]:
        """What the variable says of itself."""
        return {"long_name": self.long_name, "units": self.units}


TIME = Variable("time", "s", ("time",))
COMPONENTS = {"axis": ("x", "y", "z"), "quaternion": ("w", "x", "y", "z")}  # the labels of a second dimension

_VECTORS = {
    "position": Variable("centre of mass", "m"),
    "contact": Variable("contact point on the support", "m"),
    "velocity": Variable("velocity of the centre of mass", "m s-1"),
    "angular_velocity": Variable("angular velocity of the body", "rad s-1"),
    "contact_force": Variable("contact force on the body", "N"),
    "slip_velocity": Variable("velocity of the body's material at the contact relative to the support's", "m s-1"),
}
_TURN = Variable("orientation, unit quaternion from body frame to this frame", "1", ("time", "quaternion"))
_PHASE = Variable("phase of the contact", "1", ("time",), "int8")
# The coordinates of a support that is free to move, or moves as a formula says.
_OWN = {
    "angle": Variable("angle by which the support has turned", "rad", ("time",)),
    "rate": Variable("rate at which the support turns", "rad s-1", ("time",)),
}


def variables(system: RollingSystem) -> dict[str, Variable]:
    """Return which variables the dataset of a run has, beside the time.

    Parameters
    ----------
    system : RollingSystem
        What moves; a support that is free to move adds its own coordinates.

    Returns
    -------
    dict from str to Variable
        By name.

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> variables(ball)["contact_force"].units
    'N'
    """
    facts = [_OWN[name.rstrip("_0123456789")] for name in system.support.motion.own]  # of two that turn: angle_2
    own = dict(zip(own_names(system), facts, strict=True))
    return {**_VECTORS, "orientation": _TURN, "phase": _PHASE, **own}


def dataset(system: RollingSystem, samples: Samples, attributes: dict[str, Any]) -> xarray.Dataset:
    """Label the samples of a method.

    Parameters
    ----------
    system : RollingSystem
        Gives the slip, from velocity and Ω against the support's material.
    samples : Samples
        In the inertial support frame.
    attributes : dict
        Of the dataset; `frame` must be "support".

    Returns
    -------
    xarray.Dataset
        The design's variables over `time`.

    Examples
    --------
    See `Trajectory.data`.
    """
    import pandas as pd
    import xarray

    V, carried, u = samples.speeds(system)
    slip = np.broadcast_to((V + carried - u).array(), samples.position.shape).copy()
    slip[samples.phase == FLIGHT] = np.nan  # nothing touches
    arrays = {part.name: getattr(samples, part.name) for part in fields(samples)}
    arrays |= {"slip_velocity": slip, "phase": samples.phase.astype(np.int8)}
    arrays |= dict(zip(own_names(system), samples.own.T, strict=True))
    found = {name: (one.dims, arrays[name], one.attributes) for name, one in variables(system).items()}
    found["phase"][2].update(flag_values=np.array(list(PHASES), dtype=np.int8), flag_meanings=" ".join(PHASES.values()))
    return xarray.Dataset(
        found,
        coords={
            # As pandas indexes: to make them, xarray would first import every package of arrays that it knows of.
            "time": (TIME.dims, pd.Index(samples.time), {**TIME.attributes, "axis": "T"}),
            **{name: pd.Index(list(parts), dtype=object) for name, parts in COMPONENTS.items()},
        },
        attrs={"Conventions": "CF-1.11", **attributes},
    )


def own_names(system: RollingSystem) -> list[str]:
    """Return the names of the variables that hold the coordinates of the support's own motion.

    Parameters
    ----------
    system : RollingSystem
        Its support.

    Returns
    -------
    list of str
        In the order in which `Motion.at` takes them; mostly none.

    Examples
    --------
    >>> import trundle as tr
    >>> own_names(tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())))
    []
    """
    names = system.support.motion.own
    return [f"support_{name}" if names.count(name) == 1 else f"support_{name}_{i}" for i, name in enumerate(names)]


def attributes(title: str, method: Method) -> dict[str, Any]:
    """Return what a dataset says of itself: title, method, tolerance, frame and versions.

    Parameters
    ----------
    title : str
        Of the scenario.
    method : Method
        The method that ran.

    Returns
    -------
    dict
        Of text and numbers.

    Examples
    --------
    >>> attributes("A ball", Method("taylor", 1e-9))["tolerance"]
    1e-09
    """
    packages = ["trundle", "numpy", *{"taylor": ["heyoka"], "runge-kutta": ["scipy"]}.get(method.name, [])]
    return {
        "title": title,
        "method": method.name,
        "tolerance": method.tolerance,
        "frame": "support",
        "source": ", ".join(f"{package} {_version(package)}" for package in packages),
    }


@cache  # looked up in the files of the installation
def _version(package: str) -> str:
    from importlib.metadata import version

    return version(package)
