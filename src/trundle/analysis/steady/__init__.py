"""Steady motions and their stability, periodic motions and their Floquet multipliers, on the one rolling law."""

from __future__ import annotations

from .api import steady_motions
from .modes import Mode
from .periodic import PeriodicMotion, periodic_motion
from .result import SteadyMotion, SteadyMotions
from .sweep import Sweep

__all__ = ["Mode", "PeriodicMotion", "SteadyMotion", "SteadyMotions", "Sweep", "periodic_motion", "steady_motions"]
