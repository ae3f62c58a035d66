"""The tables of a scenario file, one file a family: one class for each table, told apart by `kind`.

A new body, surface, motion or load is one class with `kind` and `build`, in the union and the list of its family.
"""

from __future__ import annotations

from .bodies import BODIES, Bodies
from .loads import LOADS, Loads
from .motions import MOTIONS, PARTS
from .start import Run, Start
from .supports import SUPPORTS, Supports
from .values import Place2, Radius, Table, Turn4

# Which class stands for which table, so that an error can list the keys that a table has.
KINDS: dict[str, dict[str, type[Table]]] = {
    "body": BODIES,
    "support": SUPPORTS,
    "support.motion": MOTIONS,
    "support.motion.parts": PARTS,
    "loads": LOADS,
}

__all__ = ["KINDS", "Bodies", "Loads", "Place2", "Radius", "Run", "Start", "Supports", "Table", "Turn4"]
