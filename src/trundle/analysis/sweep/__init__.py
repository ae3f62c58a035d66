"""Whole families of runs: what varies, what is measured, where it is stored."""

from .api import sweep
from .result import Sweep
from .tolerancing import Tolerance, tolerance

__all__ = ["Sweep", "Tolerance", "sweep", "tolerance"]
