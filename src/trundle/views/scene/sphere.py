"""Scenes that are no run of a system: a sphere over a plane at rest, moved as its columns say."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.bodies import Body
from ...mechanics.surfaces import Plane
from .body_mesh import body_mesh
from .columns import UNITS, VECTORS, continuous
from .header import body_table, header_with, support_table
from .support_mesh import ground_of
from .wire import Scene

Array = NDArray[np.float64]


def sphere_scene(radius: float, columns: dict[str, Array], header: dict[str, Any]) -> Scene:
    """Return a scene of a sphere over a plane.

    Examples
    --------
    >>> still = {"time": np.array([0.0, 1.0]), "position": np.array([[0.0, 0.0, 0.1]] * 2)}
    >>> sphere_scene(0.1, still, {"title": "Still"}).columns["orientation"].tolist()[0]
    [1.0, 0.0, 0.0, 0.0]
    """
    n = columns["time"].size
    contact = columns["position"] * np.array([1.0, 1.0, 0.0])
    given = {name: np.zeros((n, 3)) for name in VECTORS} | {"contact": contact} | columns
    turned = columns.get("orientation", np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)))
    given["orientation"] = continuous(turned)
    moved: dict[str, NDArray[Any]] = {
        name: np.asarray(column, dtype=np.float64 if name == "time" else np.float32) for name, column in given.items()
    }
    moved["phase"] = np.zeros(n, dtype=np.uint8)
    body = body_mesh(Body.solid_sphere(radius, 1.0))
    ground = ground_of(Plane(), False, contact, radius)
    moved |= body.columns("body") | ground.mesh.columns("support")
    told = {
        "duration": float(columns["time"][-1] - columns["time"][0]),
        "body": body_table("sphere", "Sphere", radius),
        "support": support_table("plane", "Plane", ground),
        "guiding_centre": "guiding_centre" in columns,
    }
    units = {key: unit for key, unit in UNITS.items() if key in moved}
    return Scene(header_with(**{**told, **header}), moved, units, {"body": body, "support": ground.mesh})
