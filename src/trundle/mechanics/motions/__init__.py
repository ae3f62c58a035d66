"""Motions of the support, one file a family: where it is, how it turns, and its accelerations.

A new motion is one class with `at`; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

from .base import Motion, SupportState
from .steady import Fixed, Spin
from .uneven import UnevenSpin, Wobble

__all__ = ["Fixed", "Motion", "Spin", "SupportState", "UnevenSpin", "Wobble"]
