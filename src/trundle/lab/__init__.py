"""The lab: a rolling ball that one can pick up, served to a browser on this machine.

`create_app` makes the server's application; `trundle lab` runs it. Both need the extra `lab`, and load it only then.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..extras import need

if TYPE_CHECKING:
    from .app import create_app as create_app
    from .settings import Settings as Settings

__all__ = ["Settings", "create_app"]


def __getattr__(name: str) -> Any:
    if name == "create_app":
        need("lab", "trundle.lab.create_app")
        from .app import create_app

        return create_app
    if name == "Settings":
        from .settings import Settings

        return Settings
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
