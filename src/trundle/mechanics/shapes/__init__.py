"""Shapes of bodies, one file a family: support map and inverse curvature.

A new shape is one class with `support_map` and `support_gradient`; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

from .base import Shape
from .ellipsoid import Ellipsoid
from .rims import Disc, Torus
from .sphere import HalfCylinder, Hemisphere, Roller, Sphere, concentric_sphere
from .support_function import SupportFunction

__all__ = [
    "Disc",
    "Ellipsoid",
    "HalfCylinder",
    "Hemisphere",
    "Roller",
    "Shape",
    "Sphere",
    "SupportFunction",
    "Torus",
    "concentric_sphere",
]
