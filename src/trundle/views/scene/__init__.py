"""A run as a scene: everything that a viewer needs to draw it, as plain numbers, and as bytes."""

from __future__ import annotations

from .build import ground_under, places_of, scene_of
from .wire import Scene, pack, unpack

__all__ = ["Scene", "ground_under", "pack", "places_of", "scene_of", "unpack"]
