"""Shapes of bodies, one file a family: support map and inverse curvature.

A new shape is one class with `support_map` and `support_gradient`; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

from .base import Shape
from .sphere import Roller, Sphere, concentric_sphere

__all__ = ["Roller", "Shape", "Sphere", "concentric_sphere"]
