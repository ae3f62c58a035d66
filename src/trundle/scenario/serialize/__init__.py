"""From the parts of a system back to the words of a scenario file, one file a family."""

from __future__ import annotations

from .bodies import body_words
from .parts import Words, number_of, numbers_of, words_of

__all__ = ["Words", "body_words", "number_of", "numbers_of", "words_of"]
