"""Many members of one system at once: put down, and run."""

from .placing import place_many
from .running import simulate_many

__all__ = ["place_many", "simulate_many"]
