"""Derivations: how a motion follows from Newton's and Euler's laws, each equation proved from what the code computes.

SymPy is loaded when something is derived.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .naming import derivable, derive

if TYPE_CHECKING:
    from .steps import Derivation, DerivationError, Equation, Step

__all__ = ["Derivation", "DerivationError", "Equation", "Step", "derivable", "derive"]


def __getattr__(name: str) -> Any:
    if name in __all__:
        from . import steps

        return getattr(steps, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
