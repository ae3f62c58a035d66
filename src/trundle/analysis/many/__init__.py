"""Many members of one system at once: put down, and run."""

from .placing import Starts, place_many
from .running import simulate_many

__all__ = ["Starts", "place_many", "simulate_many"]
