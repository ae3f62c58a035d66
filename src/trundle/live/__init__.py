"""Pages that compute a motion where they are opened, by the law printed into them, and sites of such pages."""

from __future__ import annotations

from .page import live_page
from .site import site_of

__all__ = ["live_page", "site_of"]
