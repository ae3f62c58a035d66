"""Measured data: tracks of bodies in the files that cameras, sensors and other programs write."""

from __future__ import annotations

from .examples import Example, example, example_names, example_of
from .reading import read_track
from .table import Rejected
from .track import Track

__all__ = ["Example", "Rejected", "Track", "example", "example_names", "example_of", "read_track"]
