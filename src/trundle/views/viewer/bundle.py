"""The viewer as it was built from web/: one module, and its style."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from ...errors import TrundleError

STATIC = Path(__file__).resolve().parent / "static"


class NotBuiltError(TrundleError):
    """The viewer is not in this copy of trundle."""


def built(name: str) -> str:
    """Return a file of the built viewer.

    Examples
    --------
    >>> "createViewer" in built("viewer.js")
    True
    """
    path = STATIC / name
    try:
        return _read(path, path.stat().st_mtime_ns)
    except OSError:
        raise NotBuiltError(
            f"The viewer has not been built into this copy of trundle: {name} is missing. "
            "`pip install .`, in a checkout, builds it."
        ) from None


def languages() -> dict[str, str]:
    """Return the catalogues by the tag of their language, each as JSON.

    Examples
    --------
    >>> list(languages())
    ['de']
    """
    return {path.stem: built(f"languages/{path.name}") for path in sorted((STATIC / "languages").glob("*.json"))}


@lru_cache(maxsize=8)
def _read(path: Path, changed: int) -> str:  # noqa: ARG001  a file that is built anew is read anew
    return path.read_text(encoding="utf-8")
