"""Bodies: a mass, an inertia tensor and a shape, and builders for the common ones."""

from __future__ import annotations

from .body import HOLLOW_SPHERE, HOOP, SOLID_CYLINDER, SOLID_SPHERE, Body
from .homogeneous import Homogeneous, homogeneous
from .inertia import Inertia, Isotropic, Principal, RatioInertia, Tensor, inertia_of

__all__ = [
    "HOLLOW_SPHERE",
    "HOOP",
    "SOLID_CYLINDER",
    "SOLID_SPHERE",
    "Body",
    "Homogeneous",
    "Inertia",
    "Isotropic",
    "Principal",
    "RatioInertia",
    "Tensor",
    "homogeneous",
    "inertia_of",
]
