"""What goes wrong in the lab, told on the terminal: in single lines, and the same thing once in a while."""

from __future__ import annotations

import logging
import sys
import time
import traceback
from pathlib import Path

SELDOM = 10.0  # s between two lines about the same thing
_LONGEST = 300  # letters
_FRAMES = 3  # of a traceback, the innermost first


class Terse(logging.Handler):
    """Writes one line for each kind of record, and later how often it came again.

    Parameters
    ----------
    seldom : float
        Time between two lines about the same thing, s.

    Examples
    --------
    >>> record = logging.LogRecord("lab", logging.ERROR, "lab.py", 1, "it failed", None, None)
    >>> terse = Terse()
    >>> terse.line(record), terse.line(record) is None
    ('trundle: it failed', True)
    """

    def __init__(self, seldom: float = SELDOM) -> None:
        super().__init__()
        self.seldom = seldom
        self._told: dict[tuple[object, ...], tuple[float, int]] = {}  # when, and how often it came again since

    def emit(self, record: logging.LogRecord) -> None:
        """Write a record, unless the same thing has been said a moment ago."""
        line = self.line(record)
        if line is not None:
            print(line, file=sys.stderr, flush=True)  # noqa: T201

    def line(self, record: logging.LogRecord) -> str | None:
        """Return a record as one line."""
        # The same is what the same place says, not what has the same words: there are only so many places.
        place = (record.pathname, record.lineno, *_origin(record))
        now = time.monotonic()
        then, since = self._told.get(place, (now - self.seldom, 0))
        again = now - then < self.seldom
        self._told[place] = (then, since + 1) if again else (now, 0)
        if again:
            return None
        words = f"{record.getMessage().partition(chr(10))[0]}{_error(record)}"
        return f"trundle: {words[:_LONGEST]}" + (f" (and {since} more since the last time)" if since else "")


def _error(record: logging.LogRecord) -> str:
    """Return what an exception says, and where it came through."""
    error = record.exc_info[1] if record.exc_info else None
    if error is None:
        return ""
    said = "".join(traceback.format_exception_only(error)).strip().partition("\n")[0]
    frames = traceback.extract_tb(error.__traceback__)[-_FRAMES:]
    places = " < ".join(f"{Path(frame.filename).name}:{frame.lineno}" for frame in reversed(frames))
    return f": {said} ({places})" if places else f": {said}"


def _origin(record: logging.LogRecord) -> tuple[object, ...]:
    """Return where an exception was raised."""
    error = record.exc_info[1] if record.exc_info else None
    if error is None or error.__traceback__ is None:
        return ()
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return type(error).__name__, frame.filename, frame.lineno


def install() -> None:
    """Let all that is logged in this process be told so.

    Examples
    --------
    In a process of the lab's own only: it takes the place of other handlers.
    """
    root = logging.getLogger()
    for handler in list(root.handlers):
        root.removeHandler(handler)
    root.addHandler(Terse())
