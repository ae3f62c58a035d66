"""The wrong mechanics of rolling, for comparison only: what minimising the action under the constraint would give."""

from __future__ import annotations

from .comparison import VakonomicComparison, compare_vakonomic
from .equations import VakonomicPath, vakonomic_path

__all__ = ["VakonomicComparison", "VakonomicPath", "compare_vakonomic", "vakonomic_path"]
