"""A rolled path as labelled arrays, and as a NetCDF file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...simulation.netcdf import write_dataset

if TYPE_CHECKING:
    import xarray

    from .rolled import RolledPath


def dataset(rolled: RolledPath, every: float | None = None) -> xarray.Dataset:
    """Label the samples of a rolled path.

    Examples
    --------
    >>> import trundle as tr
    >>> dataset(tr.roll_along(tr.Straight(length=1.0), radius=0.1)).stage_distance.values
    array([0., 1.])
    """
    from importlib.metadata import version

    import pandas as pd
    import xarray

    at = rolled.sampled(every)
    turning = {"long_name": "orientation, unit quaternion from body frame to support frame", "units": "1"}
    position = {"long_name": "centre of the ball", "units": "m"}
    contact = {"long_name": "contact point on the plane", "units": "m"}
    pole = {"long_name": "direction to the north pole, the body's third axis", "units": "1"}
    heading = {"long_name": "direction of travel, from the first axis towards the second", "units": "rad"}
    return xarray.Dataset(
        {
            "position": (("distance", "axis"), at.position, position),
            "contact": (("distance", "axis"), np.column_stack([at.contact, np.zeros(len(at.contact))]), contact),
            "heading": (("distance",), at.heading, heading),
            "orientation": (("distance", "quaternion"), at.orientation, turning),
            "north_pole": (("distance", "axis"), at.north_pole, pole),
            "stage_distance": (
                ("stage",),
                rolled.stages.distance,
                {"long_name": "distance of the stages along the path", "units": "m"},
            ),
        },
        coords={
            "distance": (("distance",), pd.Index(at.distance), {"long_name": "distance along the path", "units": "m"}),
            "axis": pd.Index(["x", "y", "z"], dtype=object),
            "quaternion": pd.Index(["w", "x", "y", "z"], dtype=object),
        },
        attrs={
            "Conventions": "CF-1.11",
            "title": rolled.title,
            "frame": "support",
            "radius": rolled.radius,
            "error_bound": rolled.error_bound,
            "source": f"trundle {version('trundle')}, numpy {version('numpy')}",
        },
    )


def save(rolled: RolledPath, target: Path, every: float | None = None) -> Path:
    """Write a rolled path to a NetCDF4 file, whole or not at all, with its card and, where it has one, its scenario.

    Examples
    --------
    See `RolledPath.save`.
    """
    extra = {"scenario": rolled.scenario, "card": rolled.card().as_json()}
    write_dataset(dataset(rolled, every).assign_attrs(extra), target)
    return target
