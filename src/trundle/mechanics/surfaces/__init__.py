"""Surfaces of supports, one file each, in the support's own frame.

A new surface is one class with level function, normal, shape operator and coordinates; `tests/contracts` has the test
to inherit.
"""

from __future__ import annotations

from .base import Surface
from .cylinder import Cylinder
from .plane import Plane

__all__ = ["Cylinder", "Plane", "Surface"]
