"""The numbers that a scenario's closed form promises, read off it without a run."""

from __future__ import annotations

from ..scenario import ScenarioFile
from ..solve.exact import closed_form


def expectations(scenario: ScenarioFile) -> list[tuple[str, str]]:
    """Return what to expect of a scenario, each number with its name.

    Examples
    --------
    >>> for row in expectations(ScenarioFile.load("level-turntable-nudged"))[1:4]:
    ...     print(*row, sep=": ")
    one round: 6.30631 s, at 0.996334 rad/s
    its radius: 0.100368 m
    about the point: (0.099632, 0) m
    """
    motion = closed_form(scenario.system(), scenario.start_state())
    if motion is None:
        return [("closed form", "none covers this scenario; it is computed numerically")]
    return [("closed form", f"{motion.equation}, {motion.name}"), *motion.expected(float(scenario.timing.duration))]
