"""A scenario as a model that physics engines read: MJCF, SDF and URDF."""

from __future__ import annotations

from .formats import FORMATS, ModelFormat, engine_model

__all__ = ["FORMATS", "ModelFormat", "engine_model"]
