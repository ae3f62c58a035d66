"""From a load back to its table."""

from __future__ import annotations

from ...mechanics.loads import (
    Drag,
    Force,
    Magnus,
    Motor,
    PivotFriction,
    Potential,
    QuadraticDrag,
    RollingCouple,
    RollingResistance,
    Torque,
)
from .motions import by_kind, words_of
from .parts import Describe, Words


def _through_air(kind: str, load: Drag | QuadraticDrag, key: str) -> Words:
    words = words_of(kind, load, key)
    rate = words.pop("air")
    return words if rate == 0 else {**words, "air": rate}


LOADS: Describe = {
    Drag: lambda load, key: _through_air("drag", load, key),
    QuadraticDrag: lambda load, key: _through_air("quadratic-drag", load, key),
    **by_kind(
        {
            Force: "force",
            Torque: "torque",
            Potential: "potential",
            RollingResistance: "rolling-resistance",
            PivotFriction: "pivot-friction",
            RollingCouple: "rolling-couple",
            Magnus: "magnus",
            Motor: "motor",
        }
    ),
}
