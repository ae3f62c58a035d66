"""Faults planted where the velocity or the acceleration of a support jumps."""

from __future__ import annotations

from .planting import Mutant

FOLLOWING = "solve.transitions"
PHASES = "solve.phases"
KINKS = "mechanics.kinks"

JOLTS = (
    Mutant(
        "jolt missed", KINKS, "* (kink.behind - kink.before):", "* (kink.behind - kink.before) + 1e9:", "egg_jerked"
    ),
    Mutant(
        "jolt: V of a body that moves as the support does after",
        FOLLOWING,
        "before = law.unpack(system, kink.before, numbers)",
        "before = law.unpack(system, kink.behind, numbers)",
        "egg_jerked",
    ),
    Mutant(
        "jolt: not struck",
        FOLLOWING,
        'return _struck(system, at, f"the support struck',
        'pass; (f"the support struck',
        "egg_jerked",
    ),
    Mutant(
        "jolt: not taken along",
        FOLLOWING,
        "if system.support.friction is None and at.sliding.norm() > limit:\n        return _struck(system, at, said)",
        "",
        "ball_jerked_sideways",
    ),
    Mutant(
        "jolt: not left behind",
        FOLLOWING,
        "if not _is_low(at, at.approach, pull):\n        return flies",
        "",
        "ball_left_behind",
    ),
    Mutant(
        "jolt a microsecond late",
        KINKS,
        "return Kink(before, last, behind)",
        "return Kink(before + 1e-6, last + 1e-6, behind + 1e-6)",
        "ball_left_behind",
    ),
    Mutant(
        "forces that jump break nothing",
        PHASES,
        "if name in _BREAKS and left < 0",
        "if name in _BREAKS and left < -1e9",
        "ball_on_table_that_speeds_up",
    ),
)
