"""Crossed fields: the charged particle that moves as a ball on a turntable does, and back."""

from __future__ import annotations

from .correspondence import Twin, to_turntable, twin
from .particle import ELECTRON_MASS, ELEMENTARY_CHARGE, ChargedParticle

__all__ = ["ELECTRON_MASS", "ELEMENTARY_CHARGE", "ChargedParticle", "Twin", "to_turntable", "twin"]
