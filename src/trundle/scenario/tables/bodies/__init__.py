"""Tables of bodies."""

from __future__ import annotations

from ..values import Table
from .round import AnySphere, CylinderBody, HollowSphere, Hoop, MomentSphere, SolidSphere, WeightedCylinder
from .shaped import (
    Disc,
    EccentricCylinder,
    EccentricSphere,
    Ellipsoid,
    Formula,
    HalfCylinder,
    Hemisphere,
    Ring,
    Torus,
)

Bodies = (
    SolidSphere
    | HollowSphere
    | AnySphere
    | MomentSphere
    | EccentricSphere
    | Hemisphere
    | CylinderBody
    | Hoop
    | WeightedCylinder
    | EccentricCylinder
    | HalfCylinder
    | Disc
    | Ring
    | Torus
    | Ellipsoid
    | Formula
)

BODIES: dict[str, type[Table]] = {
    "solid-sphere": SolidSphere,
    "hollow-sphere": HollowSphere,
    "sphere": AnySphere,
    "sphere-with-moment": MomentSphere,
    "eccentric-sphere": EccentricSphere,
    "hemisphere": Hemisphere,
    "cylinder": CylinderBody,
    "hoop": Hoop,
    "weighted-cylinder": WeightedCylinder,
    "eccentric-cylinder": EccentricCylinder,
    "half-cylinder": HalfCylinder,
    "disc": Disc,
    "ring": Ring,
    "torus": Torus,
    "ellipsoid": Ellipsoid,
    "formula": Formula,
}

__all__ = ["BODIES", "Bodies"]
