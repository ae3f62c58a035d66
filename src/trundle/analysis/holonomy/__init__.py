"""Holonomic or not: what constraints on velocities leave free, decided exactly.

Nothing here is loaded before it is used: the names of the shipped systems need no SymPy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .analysis import ConstraintAnalysis as ConstraintAnalysis
    from .system import PfaffianSystem as PfaffianSystem

__all__ = ["ConstraintAnalysis", "PfaffianSystem"]


def __getattr__(name: str) -> Any:
    if name == "PfaffianSystem":
        from .system import PfaffianSystem

        return PfaffianSystem
    if name == "ConstraintAnalysis":
        from .analysis import ConstraintAnalysis

        return ConstraintAnalysis
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
