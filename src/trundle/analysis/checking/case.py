"""What was found of somebody else's motion, for whoever looks for the mistake behind it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ...mechanics.system import RollingSystem, State
from .examining import View
from .motion import Motion
from .record import ExternalTrajectory
from .series import Series


@dataclass(frozen=True)
class Case:
    """What was found.

    Parameters
    ----------
    system : RollingSystem
        What is said to move.
    theirs : Theirs
        Their samples, checked.
    tolerance : float
        As for `examine`.
    start : State or None
        Of the scenario.
    view : View
        How their motion was looked at.
    series : mapping from str to Series
        All that was found.
    motion : Motion
        Theirs.
    """

    system: RollingSystem
    theirs: ExternalTrajectory
    tolerance: float
    start: State | None
    view: View
    series: Mapping[str, Series]
    motion: Motion

    @property
    def failing(self) -> list[Series]:
        """The series beyond their bounds, the worst first."""
        return sorted((s for s in self.series.values() if s.worst > 1), key=lambda s: -s.worst)
