"""Tables of loads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...mechanics.loads import Load
from ...mechanics.parts import kinds_of
from .of_parts import one_of, table_of
from .values import Table

LOADS: dict[str, type[Table]] = {kind: table_of(part) for kind, part in kinds_of(Load).items()}
if TYPE_CHECKING:
    Loads = Any
else:
    Loads = one_of(tuple(LOADS.values()))
