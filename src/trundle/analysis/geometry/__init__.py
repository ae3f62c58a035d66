"""Rolling as geometry: a ball rolled along a path on a plane, without forces, slipping or pivoting."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .along import roll_along
from .pieces import Arc, Curve, Straight
from .rolled import RolledPath
from .rotation import Rotation
from .stages import Stages

if TYPE_CHECKING:
    from .scenario import PathScenario as PathScenario

__all__ = ["Arc", "Curve", "PathScenario", "RolledPath", "Rotation", "Stages", "Straight", "roll_along"]


def __getattr__(name: str) -> Any:
    if name == "PathScenario":  # pydantic takes its time
        from .scenario import PathScenario

        return PathScenario
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
