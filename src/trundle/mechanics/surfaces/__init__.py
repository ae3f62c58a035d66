"""Surfaces of supports, one file each, in the support's own frame.

A new surface is one class with level function and coordinates, or with a height over the plane; normal and shape
operator follow by differentiation. `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

from .base import Surface
from .cone import Cone
from .cylinder import Cylinder
from .ellipsoidal import EllipsoidalBowl
from .height_field import HeightField
from .measured import HeightTable, RevolutionTable
from .over_plane import OverPlane
from .paraboloid import Paraboloid
from .plane import Plane
from .revolution import Revolution
from .spherical import Bowl, Dome
from .torus import TorusTrack

__all__ = [
    "Bowl",
    "Cone",
    "Cylinder",
    "Dome",
    "EllipsoidalBowl",
    "HeightField",
    "HeightTable",
    "OverPlane",
    "Paraboloid",
    "Plane",
    "Revolution",
    "RevolutionTable",
    "Surface",
    "TorusTrack",
]
