"""From the parts of a system back to the words of a scenario file, one file a family."""

from __future__ import annotations

from .bodies import body_words
from .loads import LOADS
from .motions import MOTIONS
from .parts import Words, number_of, numbers_of, one_of
from .supports import SURFACES

__all__ = ["LOADS", "MOTIONS", "SURFACES", "Words", "body_words", "number_of", "numbers_of", "one_of"]
