"""A ball in a bowl that engines are told of as triangles: exact is the smooth bowl."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from ..errors import ScenarioError
from ..simulation.simulate import Scenario
from .case import Array, Input, Motion, Task
from .rolling import Rolling
from .triangles import Triangles, rolled


@dataclass(frozen=True)
class BowlOfTriangles(Rolling):
    """A case of a ball in a spherical bowl, which the task tells as a mesh.

    Parameters
    ----------
    name, title, about, scenario
        As those of `Rolling`.
    points : int
        Of the mesh, on the whole sphere.

    Examples
    --------
    >>> import trundle as tr
    >>> case = next(case for case in tr.conformance.cases() if case.name == "bowl-mesh-coarse")
    >>> len(case.situation()["support"]["mesh"]["triangles"])
    406
    """

    points: int = 0
    table: ClassVar[str] = "mesh"
    surfaces: ClassVar[tuple[str, ...]] = ("bowl",)

    @classmethod
    def read(cls, name: str, tables: Mapping[str, Any], source: str) -> BowlOfTriangles:
        """Make a case of the tables of a scenario file with one more, of the mesh."""
        told = tables[cls.table]
        points = told.get("points") if isinstance(told, Mapping) else told
        if not isinstance(points, int) or points < 12:
            raise ScenarioError(f"{cls.table}.points", "must be a whole number, 12 or more", points, "", source)
        scenario = Scenario.read({key: value for key, value in tables.items() if key != cls.table}, source)
        case = cls(name, scenario.title, scenario.notes.strip(), scenario, points)
        case.situation()
        return case

    def situation(self) -> Task:
        """Return bodies, support, friction and gravity; the support with its triangles."""
        told = super().situation()
        mesh = self._mesh(told)
        middle = np.array([0.0, 0.0, told["support"]["radius"]])
        told["support"]["mesh"] = {
            "vertices": (mesh.vertices + middle).tolist(),
            "triangles": mesh.corners.tolist(),
            "middle": middle.tolist(),
        }
        return told

    def on_mesh(self) -> Motion:
        """Return how an exact ball rolls on the triangles."""
        return _on_mesh(self)

    def inputs(self) -> tuple[Input, ...]:
        """Return nothing: an engine's derivatives are those of a ball on triangles."""
        return ()

    def slip(self, motion: Motion) -> Array:
        """Return V + Ω×ρ where the ball touches what it is nearer to: the smooth bowl or its triangles."""
        told = super().situation()
        radius = told["bodies"][0]["shape"]["radius"]
        arms = motion.position - [0.0, 0.0, told["support"]["radius"]]
        reach = np.linalg.norm(arms, axis=-1, keepdims=True)
        flat, gap = self._mesh(told).nearest(arms)
        smooth = np.abs(reach[..., 0] + radius - told["support"]["radius"]) < np.abs(gap - radius)
        normal = np.where(smooth[..., None], -arms / reach, flat)
        slip: Array = motion.velocity - radius * np.cross(motion.angular_velocity, normal)
        return slip

    def _mesh(self, told: Task) -> Triangles:
        """Return the triangles about the middle of the sphere; the ball begins on one of them."""
        radius = told["support"]["radius"]
        arm = np.array(told["bodies"][0]["position"]) - [0.0, 0.0, radius]
        return _mesh(self.points, radius, tuple(arm / np.linalg.norm(arm)))


@lru_cache
def _mesh(points: int, radius: float, towards: tuple[float, ...]) -> Triangles:
    return Triangles.bowl(points, radius, np.array(towards))


@lru_cache
def _on_mesh(case: BowlOfTriangles) -> Motion:
    told = Rolling.situation(case)
    return rolled(case._mesh(told), told, case.times())
