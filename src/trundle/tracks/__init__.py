"""Measured data: tracks of bodies in the files that cameras, sensors and other programs write."""

from __future__ import annotations

from .reading import read_track
from .table import Rejected
from .track import Track

__all__ = ["Rejected", "Track", "read_track"]
