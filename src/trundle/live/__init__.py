"""Pages that compute a motion where they are opened: the law printed into them, a method, sliders and curves."""

from __future__ import annotations

from .page import live_page

__all__ = ["live_page"]
