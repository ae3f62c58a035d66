"""First derivatives of runs by the numbers of their scenarios: exact, through the start, the phases and all events."""

from .api import sensitivities
from .result import Sensitivities

__all__ = ["Sensitivities", "sensitivities"]
