"""Motions of the support, one file a family: where it is, how it turns, and its accelerations.

A new motion is one class with `at`; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

# In the order in which lists name them.
# isort: skip_file
from .base import Motion, SupportState
from .steady import Fixed, Spin
from .uneven import UnevenSpin, Wobble
from .given import SpinBy, Tilt, Move
from .free import FreeAxle
from .swinging import Rock, PrecessingTilt, Shake
from .sums import Combined

__all__ = [
    "Combined",
    "Fixed",
    "FreeAxle",
    "Motion",
    "Move",
    "PrecessingTilt",
    "Rock",
    "Shake",
    "Spin",
    "SpinBy",
    "SupportState",
    "Tilt",
    "UnevenSpin",
    "Wobble",
]
