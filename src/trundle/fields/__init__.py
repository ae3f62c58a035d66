"""The law for other programs: vector fields with names and units, printed for NumPy, numba, JAX, SymPy, C and more."""

from __future__ import annotations

from .backends import BACKENDS
from .field import FieldReset, VectorField
from .motion_formula import MotionFormula

__all__ = ["BACKENDS", "FieldReset", "MotionFormula", "VectorField"]
