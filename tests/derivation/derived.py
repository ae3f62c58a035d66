"""Derivations that several tests look at are made once."""

from __future__ import annotations

from functools import cache
from typing import Any

import trundle as tr


@cache
def derived(name: str) -> Any:
    """Return a derivation by name."""
    return tr.derive(name)
