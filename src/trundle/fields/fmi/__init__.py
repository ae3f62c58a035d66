"""A functional mock-up unit: the law as a component of FMI 3.0, for Modelica tools, Simulink and their like."""

from __future__ import annotations

from .archive import fmu

__all__ = ["fmu"]
