"""Films: the ball on the table followed from picture to picture, calibrated, timed, and brought to a track."""

from __future__ import annotations

from .api import track_film
from .result import FilmTrack

__all__ = ["FilmTrack", "track_film"]
