"""Motions of the support, one file a family: where it is, how it turns, and its accelerations.

A new motion is one class with `at`; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

from .base import Motion, SupportState
from .free import FreeAxle
from .given import Move, SpinBy, Tilt
from .steady import Fixed, Spin
from .sums import Combined
from .swinging import PrecessingTilt, Rock, Shake
from .uneven import UnevenSpin, Wobble

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
