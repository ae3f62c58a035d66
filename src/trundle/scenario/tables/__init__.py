"""The tables of a scenario file, one file a family: one class for each table, told apart by `kind`.

Those of surfaces, motions and loads are made from what the parts say about themselves (`of_parts`).
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


def __getattr__(name: str) -> type[Table]:
    """Return a class that was made, by its name: pickles ask for it."""
    for tables in KINDS.values():
        for table in tables.values():
            if table.__name__ == name:
                return table
    raise AttributeError(name)
