"""The real demonstration: which shortcoming of a turntable ends it, and after how long."""

from __future__ import annotations

from .air import air_drag
from .measuring import CircleMotion
from .report import Sensitivity
from .rows import Row
from .varying import sensitivity

__all__ = ["CircleMotion", "Row", "Sensitivity", "air_drag", "sensitivity"]
