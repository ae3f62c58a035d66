"""From a load back to its table."""

from __future__ import annotations

from ...mechanics.loads import Drag, Force, Torque
from .parts import Describe, Words, number_of, numbers_of


def _drag(load: Drag, key: str) -> Words:
    air = {} if load.air_rate == 0 else {"air": number_of(load.air_rate, f"{key}.air")}
    return {"kind": "drag", "coefficient": number_of(load.coefficient, f"{key}.coefficient"), **air}


LOADS: Describe = {
    Force: lambda load, key: {"kind": "force", "value": numbers_of(load.value, f"{key}.value")},
    Torque: lambda load, key: {"kind": "torque", "value": numbers_of(load.value, f"{key}.value")},
    Drag: _drag,
}
