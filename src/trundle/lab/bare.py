"""Scenes that are no run of a scenario: a small sphere over a plane at rest, moved as its columns say."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanics.bodies import Body
from ..mechanics.surfaces import Plane
from ..scene import Scene
from ..scene.body_mesh import body_mesh
from ..scene.columns import UNITS, continuous
from ..scene.support_mesh import ground_of

Array = NDArray[np.float64]
VECTORS = ("position", "contact", "velocity", "angular_velocity", "contact_force")


def sphere_scene(radius: float, columns: dict[str, Array], header: dict[str, Any]) -> Scene:
    """Return a scene of a sphere over a plane.

    Parameters
    ----------
    radius : float
        Of the sphere as it is drawn, m.
    columns : dict
        `time` and `position`; whatever else of a scene's columns there is. The others are 0, or not turned.
    header : dict
        `title`, and what is to be said besides or instead.

    Returns
    -------
    Scene
        As `trundle.scene.scene_of` makes them.

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
    meshes = body.columns("body", "body_pattern") | ground.mesh.columns("support", "support_marks")
    name = "Sphere"
    told = {
        "format": 1,
        "kind": "rolled",
        "method": "exact",
        "duration": float(columns["time"][-1] - columns["time"][0]),
        "seconds": None,
        "scenario": None,
        "scenario_toml": "",
        "gravity": [0.0, 0.0, 0.0],
        "tilt": 0.0,
        "to_world": [1.0, 0.0, 0.0, 0.0],
        "body": {"kind": "sphere", "radius": radius, "name": name, "mass": None, "label": name},
        "support": {
            "kind": "plane",
            "name": "Plane",
            "moves": False,
            "size": ground.size,
            "centre": list(ground.centre),
            "marks": ground.marks,
            "rim": None,
            "friction": None,
        },
        "events": [],
        "findings": [],
        "formula": None,
        "guiding_centre": "guiding_centre" in columns,
        "card": None,
    }
    units = {key: unit for key, unit in UNITS.items() if key in moved or key in meshes}
    return Scene({**told, **header}, moved | meshes, units)
