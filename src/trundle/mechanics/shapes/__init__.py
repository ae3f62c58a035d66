"""Shapes of bodies, one file a family: support map and inverse curvature.

A new shape is one class with `support_map` and `support_gradient`; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

from .base import Shape
from .ellipsoid import Ellipsoid
from .rims import Disc, Torus
from .sphere import CylinderShape, HalfCylinder, Hemisphere, Sphere, concentric_sphere
from .support_function import SupportFunction

__all__ = [
    "CylinderShape",
    "Disc",
    "Ellipsoid",
    "HalfCylinder",
    "Hemisphere",
    "Shape",
    "Sphere",
    "SupportFunction",
    "Torus",
    "concentric_sphere",
]
