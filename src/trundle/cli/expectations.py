"""The numbers that a scenario's closed form promises, read off it without a run."""

from __future__ import annotations

import math
from typing import Any

from ..scenario import ScenarioFile
from ..solve.exact import CylinderOnCylinder, SphereOnPlane, closed_form

SLOWEST = 1e-12  # rad/s; a slower circle is a straight line to anyone


def expectations(scenario: ScenarioFile) -> list[tuple[str, str]]:
    """Return what to expect of a scenario, each number with its name.

    Parameters
    ----------
    scenario : ScenarioFile
        Any scenario.

    Returns
    -------
    list of (name, value)
        For the screen.

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
    rows = [("closed form", f"{motion.equation}, {motion.name}")]
    if isinstance(motion, CylinderOnCylinder):
        return rows + _pendulum(motion)
    circles = isinstance(motion, SphereOnPlane) and motion.has_guiding_centre and abs(motion.kappa) > SLOWEST
    return rows + (_circle(motion, scenario) if circles else _push(motion))


def _pendulum(motion: CylinderOnCylinder) -> list[tuple[str, str]]:
    kind = "goes round" if motion.goes_round else "swings"
    small = math.sqrt(motion.length * motion.mass * (1 + motion.inertia_ratio) / max(math.hypot(*motion.force), 1e-300))
    return [
        (f"it {kind}", "for ever" if math.isinf(motion.period) else f"once in {motion.period:.6g} s"),
        ("a small swing", f"{2 * math.pi * small:.6g} s"),
    ]


def _circle(motion: Any, scenario: ScenarioFile) -> list[tuple[str, str]]:
    drift = motion.drift_velocity
    rows = [
        ("one round", f"{2 * math.pi / abs(motion.kappa):.6g} s, at {motion.kappa:.6g} rad/s"),
        ("its radius", f"{motion.circle_radius:.6g} m"),
        ("about the point", _pair(motion.guiding_centre(0.0), "m")),
    ]
    if math.hypot(*drift) > 0:
        rows += [
            ("which drifts at", f"{math.hypot(*drift):.6g} m/s, {_pair(drift, 'm/s')}"),
            ("and ends at", _pair(motion.guiding_centre(float(scenario.timing.duration)), "m")),
        ]
    return rows


def _push(motion: Any) -> list[tuple[str, str]]:
    rows = [("acceleration at rest", _pair((motion.phi.re, motion.phi.im), "m/s²"))]
    if motion.gamma > 0:
        rows.append(("drag halves the speed in", f"{math.log(2) / motion.gamma:.6g} s"))
    return rows


def _pair(pair: tuple[Any, Any], unit: str) -> str:
    first, second = (float(f"{part:.6g}") + 0.0 for part in pair)
    size = max(abs(first), abs(second))
    first, second = (0.0 if abs(part) < 1e-12 * size else part for part in (first, second))
    return f"({first:.6g}, {second:.6g}) {unit}"
