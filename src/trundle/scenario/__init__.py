"""Scenario files: the TOML description of a run, and the rolling system that it describes.

Nothing here is loaded before it is used: the names of the shipped scenarios need neither pydantic nor pint.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .document import ScenarioFile as ScenarioFile

__all__ = ["ScenarioFile"]


def __getattr__(name: str) -> Any:
    if name == "ScenarioFile":
        from .document import ScenarioFile

        return ScenarioFile
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
