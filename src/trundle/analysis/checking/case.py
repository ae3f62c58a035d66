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
    """What was found."""

    system: RollingSystem  # what is said to move
    theirs: ExternalTrajectory  # their samples, checked
    tolerance: float  # as for `examine`
    start: State | None  # of the scenario
    view: View  # how their motion was looked at
    series: Mapping[str, Series]  # all that was found
    motion: Motion  # theirs

    @property
    def failing(self) -> list[Series]:
        """The series beyond their bounds, the worst first."""
        return sorted((s for s in self.series.values() if s.worst > 1), key=lambda s: -s.worst)
