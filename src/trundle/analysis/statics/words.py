"""The findings in words."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ...display import verdict
from ...mechanics.system import RollingSystem
from .stability import Mode

if TYPE_CHECKING:
    from .result import Equilibria, Equilibrium


SPOT = "turning on the spot"


def direction_names(system: RollingSystem) -> tuple[str, str]:
    """Return how the two coordinates of the support are called as directions.

    Examples
    --------
    >>> import trundle as tr
    >>> direction_names(tr.RollingSystem(tr.Body.hoop(0.1, 1.0), tr.Support(tr.Cylinder(0.5))))
    ('around the cylinder', 'along its axis')
    """
    if system.support.surface.coordinates == ("angle", "length"):
        return "around the cylinder", "along its axis"
    return ("along x, the slope", "along y, level") if system.support.tilt else ("along x", "along y")


def report(result: Equilibria) -> str:
    """Write the findings out, as the command prints them."""
    lines = [result.title] if result.title else []
    lines.append(count_of(result))
    for i, one in enumerate(result.found, 1):
        lines += ["", f"{i}. {report_one(one, len(result.found))}"]
    return "\n".join([*lines, *[""] * bool(result.found), *remarks(result)])


def report_one(one: Equilibrium, count: int = 1) -> str:
    """Write out one equilibrium."""
    said = facts(one, count)
    energy = said["energy"] if one.energy == 0 else f"energy {said['energy']}"
    force = f"contact force {said['contact force']}; {said['friction']}"
    lines = [f"at {said['at']}", *[energy] * bool(said["energy"]), force, *said["a nudge"].splitlines()]
    return "\n   ".join([kind_of(one), *lines])


def record_of(one: Equilibrium, count: int = 1) -> dict[str, str]:
    """Return what `facts` does for a notebook, where a verdict is seen."""
    said = facts(one, count)
    return {**said, "friction": verdict(one.holds, said["friction"])}


def facts(one: Equilibrium, count: int) -> dict[str, str]:
    """Return what there is to say of one equilibrium among several, each fact under its name."""
    energy = ""
    if one.energy is not None and count > 1:
        energy = "lowest" if one.energy == 0 else f"{one.energy:.6g} J over the lowest"
    return {
        "at": where(one),
        "energy": energy,
        "contact force": f"N = {one.normal_force + 0.0:.6g} N, f = {one.friction_force + 0.0:.6g} N",
        "friction": _friction(one),
        "a nudge": "\n".join(_nudges(one)),
    }


def remarks(result: Equilibria) -> list[str]:
    """Return what there is to say beyond the equilibria, line by line."""
    lines = [] if result.found or not result.reason else [result.reason]
    if result.pulled:
        lines.append(_pulled(result))
    if result.repeats is not None and result.found:
        lines.append(_repeats(result.repeats, result.found))
    if not result.conservative:
        lines.append("no energy: some load has no potential; searched by virtual work")
    return [*lines, f"searched: {result.searched}"]


def count_of(result: Equilibria) -> str:
    """Say how many there are."""
    if not result.found:
        return "no equilibrium"
    families = sum(one.dimension > 0 for one in result.found)
    if not families:
        return f"{len(result.found)} {_plural('equilibrium', 'equilibria', len(result.found))}"
    if families == len(result.found):
        return f"{families} {_plural('family', 'families', families)} of equilibria"
    return f"{len(result.found)} equilibria, {families} of them families"


def _plural(one: str, more: str, count: int) -> str:
    return one if count == 1 else more


def kind_of(one: Equilibrium) -> str:
    """Say whether it is stable, and what may be changed without leaving it."""
    detail = f", {'' if one.free[0].startswith('in ') else 'anywhere '}{' and '.join(one.free)}" if one.free else ""
    return f"{one.stability}{detail}"


def _nudges(one: Equilibrium) -> list[str]:
    motions: dict[str, list[str]] = {}
    for mode, moves in zip(one.modes, one.moves, strict=True):
        if not (mode.kind == "indifferent" and moves == SPOT):
            motions.setdefault(_motion(mode, one), []).append(moves)
    return [f"{moves[0] if len(moves) == 1 else 'every way'}: {motion}" for motion, moves in motions.items()]


def where(one: Equilibrium) -> str:
    """Say at which coordinates it is."""
    kinds = one.kinds
    u, v = (_tidy(math.degrees(x) if kind == "angle" else x) for x, kind in zip(one.position, kinds, strict=True))
    u = 180.0 if kinds[0] == "angle" and u == -180 else u
    place = f"{u:.6g}° round, {v:.6g} m along" if kinds[0] == "angle" else f"x = {u:.6g} m, y = {v:.6g} m"
    if one.roll is None:
        return place
    return f"{place}, mark {_tidy(math.degrees(one.roll)):.6g}° from the normal"


def _tidy(value: float) -> float:
    return round(value, 9) + 0.0


def _friction(one: Equilibrium) -> str:
    needed = f"needs friction of at least {one.friction_needed:.6g}" if one.friction_force else "needs no friction"
    if one.holds is None:
        return needed
    return f"{needed}, the support has {one.friction:g}" + ("" if one.holds else ": it SLIPS")


def _motion(mode: Mode, one: Equilibrium) -> str:
    if mode.kind == "indifferent" and one.stability != "indifferent" and not one.dimension:
        return f"{one.stability}, but not by its linear law"
    words = motion_words(mode)
    if mode.kind == "unstable":
        return f"{words}, at {mode.growth:.6g} 1/s" + (
            f", swinging at {mode.frequency:.6g} rad/s" if mode.frequency else ""
        )
    dies = f", dying away at {-mode.growth:.6g} 1/s" if mode.growth else ""
    return f"{words}, at {mode.frequency:.6g} rad/s{dies}" if mode.frequency else f"{words}{dies}"


def motion_words(mode: Mode, digits: int = 6) -> str:
    """Say in a few words what a nudge leads to.

    Examples
    --------
    >>> motion_words(Mode(2j, (0.0, 1.0, 0.0), (0.1, 0.0, 0.0)))
    'swings once in 3.14159 s'
    """
    if mode.kind == "indifferent":
        return "indifferent"
    if mode.kind == "unstable":
        return f"a nudge grows by e in {1 / mode.growth:.{digits}g} s"
    return f"swings once in {2 * math.pi / mode.frequency:.{digits}g} s" if mode.frequency else "comes back"


def _pulled(result: Equilibria) -> str:
    one, count = result.pulled[0], len(result.pulled)
    if count == 1:
        return f"not one: {where(one)}, where the support would have to pull with {-one.normal_force:.4g} N"
    return f"not equilibria: {count} stationary points where the support would have to pull, as at {where(one)}"


def _repeats(repeats: tuple[float, float], found: tuple[Equilibrium, ...]) -> str:
    distance, energy = repeats
    if all(one.dimension for one in found):
        return "and the same on every turn"
    higher = "as high" if energy == 0 else f"{abs(energy):.6g} J {'higher' if energy > 0 else 'lower'}"
    return f"and again with every turn, {abs(distance):.6g} m further on and {higher}"
