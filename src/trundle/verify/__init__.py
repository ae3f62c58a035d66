"""What is checked of every trajectory, and the card that shows it."""

from __future__ import annotations

from .card import Card, CardFigure
from .figures import card

__all__ = ["Card", "CardFigure", "card"]
