"""Bodies: a mass, an inertia tensor and a shape, and builders for the common ones, a file a family."""

from __future__ import annotations

from .body import Body
from .inertia import Inertia, Isotropic, Principal, RatioInertia, Tensor, inertia_of
from .rigid import HOLLOW_SPHERE, HOOP, SOLID_CYLINDER, SOLID_SPHERE, RigidBody
from .whole import Whole, homogeneous

__all__ = [
    "HOLLOW_SPHERE",
    "HOOP",
    "SOLID_CYLINDER",
    "SOLID_SPHERE",
    "Body",
    "Inertia",
    "Isotropic",
    "Principal",
    "RatioInertia",
    "RigidBody",
    "Tensor",
    "Whole",
    "homogeneous",
    "inertia_of",
]
