"""Tables of motions of the support."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...mechanics.motions import Motion
from ...mechanics.parts import PartsOf, fields_of, kinds_of
from .of_parts import one_of, table_of
from .values import Table

_ALL = kinds_of(Motion)
_OF_OTHERS = {kind for kind, part in _ALL.items() if any(isinstance(f, PartsOf) for f in fields_of(part).values())}

PARTS: dict[str, type[Table]] = {kind: table_of(part) for kind, part in _ALL.items() if kind not in _OF_OTHERS}
MOTIONS: dict[str, type[Table]] = PARTS | {kind: table_of(_ALL[kind], tuple(PARTS.values())) for kind in _OF_OTHERS}
if TYPE_CHECKING:
    Motions = Any
else:
    Motions = one_of(tuple(MOTIONS.values()))
