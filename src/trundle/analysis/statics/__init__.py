"""Statics as the limit: where a body stays if it is put down at rest, by the principle of virtual work."""

from __future__ import annotations

from .finding import equilibria
from .result import Equilibria, Equilibrium
from .stability import Mode

__all__ = ["Equilibria", "Equilibrium", "Mode", "equilibria"]
