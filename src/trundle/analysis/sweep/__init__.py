"""Whole families of runs: what varies, what is measured, where it is stored."""

from .api import sweep
from .result import Sweep

__all__ = ["Sweep", "sweep"]
