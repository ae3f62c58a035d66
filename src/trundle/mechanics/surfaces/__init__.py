"""Surfaces of supports, one file each, in the support's own frame.

A new surface is one class with level function and coordinates, or with a height over the plane; normal and shape
operator follow by differentiation. `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

# In the order in which lists name them.
# isort: skip_file
from .base import Surface
from .over_plane import OverPlane
from .plane import Plane
from .cylinder import Cylinder
from .spherical import Bowl, Dome
from .cone import Cone
from .paraboloid import Paraboloid
from .ellipsoidal import EllipsoidalBowl
from .torus import TorusTrack
from .measured import HeightTable, RevolutionTable
from .revolution import Revolution
from .height_field import HeightField

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
