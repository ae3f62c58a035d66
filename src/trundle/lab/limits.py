"""How much a visitor may ask for: each bound with a message that says what to ask for instead."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..errors import ScenarioError
from ..scenario.files import Bounds

MOST_SAMPLES = 10_000  # of a scene; what a screen can show
MOST_SAVED = 200_000  # of a file
MOST_TRIED = 100  # scenarios at once of which it is asked whether they can start
LONGEST = 3600.0  # s
MOST_VALUES = 20_000  # numbers and texts in a scenario; a height field of 100 by 100 fits
MOST_LOADS = 20
MOST_SIDE = 64  # fields along a side of a map
MOST_FIELDS = MOST_SIDE**2
MOST_ROWS = 4000  # of a track that is fitted
MOST_PIECES = 500  # of a path
_NO_MORE = "The lab computes no more for one request; `trundle run` does."
_BOUNDS = Bounds(MOST_LOADS, MOST_PIECES, MOST_VALUES, deepest=12, remedy=_NO_MORE)


def check_size(data: Mapping[str, Any]) -> None:
    """Refuse a scenario of more parts than any page of text has.

    Examples
    --------
    >>> check_size({"loads": [{"kind": "force"}]})
    >>> check_size({"loads": [{}] * 21})
    Traceback (most recent call last):
    ...
    trundle.errors.ScenarioError: `loads` must have at most 20 parts; got 21. The lab computes no more ...
    """
    _BOUNDS.check(data)


def check_timing(duration: float, every: float, most: int) -> None:
    """Refuse a run that is too long, or is sampled too often.

    Examples
    --------
    >>> check_timing(60.0, 0.01, MOST_SAVED)
    >>> check_timing(1e6, 100.0, MOST_SAVED)
    Traceback (most recent call last):
    ...
    trundle.errors.ScenarioError: `run.duration` must be at most 3600 s; got 1000000.0. The lab computes no more ...
    """
    if duration > LONGEST:
        _refuse("run.duration", f"must be at most {LONGEST:g} s", duration)
    if duration / every > most:
        _refuse("run.every", f"must give at most {most} samples", every)


def _refuse(key: str, rule: str, received: Any) -> None:
    raise ScenarioError(key, rule, received, _NO_MORE)
