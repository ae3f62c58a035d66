"""Check somebody else's trajectory, or equations of motion, against the law of rolling."""

from __future__ import annotations

from .equations import check_equations
from .result import Check, Mistake
from .trajectories import check

__all__ = ["Check", "Mistake", "check", "check_equations"]
