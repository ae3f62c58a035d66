"""The findings in words."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ...display import verdict
from .modes import Mode
from .quantities import UNITS

if TYPE_CHECKING:
    from .periodic import PeriodicMotion
    from .result import SteadyMotion, SteadyMotions


def report(result: SteadyMotions) -> str:
    """Write the findings out, as the command prints them."""
    lines, count = [result.title] if result.title else [], len(result.found)
    lines.append(count_of(result))
    for i, one in enumerate(result.found, 1):
        lines += ["", f"{i}. {report_one(one)}"]
    return "\n".join([*lines, *[""] * bool(count), *remarks(result)])


def remarks(result: SteadyMotions) -> list[str]:
    """Return what there is to say beyond the motions, line by line."""
    lines = [f"from the start: {_moved(result.moved)}" if result.found else result.reason]
    if result.pulled:
        lines.append(f"not counted: {result.pulled} more, in which the support would have to pull")
    return [*lines, f"searched: {result.searched}"]


def count_of(result: SteadyMotions) -> str:
    """Say how many there are."""
    count = len(result.found)
    return "no steady motion" if not count else f"{count} steady motion{'s' * (count > 1)}"


def _moved(distance: float) -> str:
    return "it is one already" if distance < 1e-9 else f"{distance:.3g} away, in units of the body's size and rates"


def report_one(one: SteadyMotion) -> str:
    """Write out one steady motion."""
    told = facts(one)
    force = f"contact force {told['contact force']}; {told['friction']}"
    nudges = [f"a nudge {line}" for line in told["a nudge"].splitlines()]
    lines = [told["quantities"], force, *nudges, told["family"], f"evidence: {told['evidence']}"]
    return "\n   ".join([f"{one.kind}, {one.verdict}", *lines])


def record_of(one: SteadyMotion) -> dict[str, str]:
    """Return what `facts` does for a notebook, where a verdict is seen."""
    told = facts(one)
    return {**told, "friction": verdict(one.holds, told["friction"])}


def facts(one: SteadyMotion) -> dict[str, str]:
    """Return what there is to say of one steady motion, each fact under its name."""
    return {
        "quantities": ", ".join(f"{name} {said(name, value)}" for name, value in one.quantities.items()),
        "contact force": f"N = {one.normal_force:.6g} N, f = {one.friction_force:.6g} N",
        "friction": _friction(one),
        "a nudge": "\n".join(_nudges(one)),
        "family": _family(one),
        "evidence": _evidence(one),
    }


def said(name: str, value: float) -> str:
    """Return a quantity with its unit, angles in degrees."""
    if name == "lean":
        return f"{math.degrees(value) + 0.0:.6g}°"
    return f"{value + 0.0:.6g} {UNITS[name]}"


def _friction(one: SteadyMotion) -> str:
    needed = f"needs friction of at least {one.friction_needed:.6g}" if one.friction_force else "needs no friction"
    if one.holds is None:
        return needed
    return f"{needed}, the support has {one.system.support.friction:g}" + ("" if one.holds else ": it SLIPS")


def _nudges(one: SteadyMotion) -> list[str]:
    if not one.modes:
        return ["only changes it into another steady motion"]
    said_once = list(dict.fromkeys(mode_words(mode) for mode in one.modes if not _twin(mode, one.modes)))
    frame = "" if one.frame == "inertial" else ", seen turning with the support"
    return [f"{words}{frame}" for words in said_once]


def _twin(mode: Mode, modes: tuple[Mode, ...]) -> bool:
    """Whether a mode dies away at the rate at which another grows: it comes with it and decides nothing."""
    return mode.growth < 0 and any(
        other.growth > 0 and abs(other.growth + mode.growth) <= 1e-6 * other.growth for other in modes
    )


def mode_words(mode: Mode) -> str:
    """Say in a few words what a nudge leads to.

    Examples
    --------
    >>> mode_words(Mode(2j)), mode_words(Mode(0.5 + 0j))
    ('oscillates at 2 rad/s, once in 3.14159 s', 'grows at 0.5 1/s, by e in 2 s')
    """
    if mode.kind == "neutral":
        return "stands at a limit of stability: the linear law neither carries it back nor away"
    swings = ""
    if mode.frequency:
        swings = f"oscillates at {mode.frequency:.6g} rad/s, once in {2 * math.pi / mode.frequency:.6g} s"
    if mode.growth == 0:
        return swings
    if mode.growth > 0:
        grows = f"grows at {mode.growth:.6g} 1/s, by e in {1 / mode.growth:.6g} s"
    else:
        grows = f"dies away at {-mode.growth:.6g} 1/s"
    return f"{grows}, and {swings}" if swings else grows


def _family(one: SteadyMotion) -> str:
    if not one.dimension:
        return "stands alone but for place, direction and phase"
    numbers = {1: "one number", 2: "two numbers", 3: "three numbers"}.get(one.dimension, f"{one.dimension} numbers")
    return f"one of a family with {numbers} to choose"


def _evidence(one: SteadyMotion) -> str:
    return f"steady to {one.residual:.1g}; nudged runs follow the linear law to {one.checked:.1g}"


def periodic_report(motion: PeriodicMotion) -> str:
    """Write out what was found of a periodic motion."""
    told = periodic_facts(motion)
    lines = [f"repeats {told['repeats']}", f"multipliers: {told['multipliers']}", f"evidence: {told['evidence']}"]
    return "\n".join([f"periodic, {motion.verdict}", *(f"   {row}" for line in lines for row in line.splitlines())])


def periodic_facts(motion: PeriodicMotion) -> dict[str, str]:
    """Return what there is to say of a periodic motion, each fact under its name."""
    rest = motion.multipliers[motion.free :]
    turned = f"turned on by {math.degrees(motion.turned) + 0.0:.6g}° about the axis"
    several = ", ".join(map(_multiplier, rest)) or "none besides 1"
    return {
        "repeats": f"after {motion.period:.9g} s, {turned}",
        "multipliers": f"{several}\nand {motion.free} equal to 1, along the motion and its family",
        "evidence": f"closes to {motion.residual:.1g} of its scale",
    }


def _multiplier(value: complex) -> str:
    if abs(value.imag) < 1e-9:
        return f"{value.real:.6g}"
    return f"{abs(value):.6g} at {math.degrees(math.atan2(value.imag, value.real)):.6g}°"
