"""Ctrl-C, and being told to end: leave through every `finally`, so that no half-written file stays behind."""

from __future__ import annotations

import _thread
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

INTERRUPTED = 130
_AGAIN = 0.02  # s: the callback in which an exception was lost is over by then


class Ending:
    """A signal handler that ends the command, and remembers that it was called.

    Python loses an exception that a handler raises inside a callback, of the garbage collector, of a lock of imports or
    of compiled code, and prints "Exception ignored": `lost` keeps it from that, and lets the signal come once more. A
    compiled library may also put another exception in its place; `check` raises it again.

    Examples
    --------
    >>> ending = Ending()
    >>> ending.check()
    >>> try:
    ...     ending(signal.SIGTERM, None)
    ... except SystemExit as end:
    ...     print(end.code)
    143
    """

    def __init__(self) -> None:
        self.number = 0
        self.before = sys.unraisablehook

    def __call__(self, number: int, frame: Any) -> None:  # noqa: ARG002
        """Take a signal."""
        self.number = number
        self.check()

    def lost(self, unraisable: Any) -> None:
        """Take an exception that Python cannot raise where it is: if it is ours, the signal comes again."""
        if self.number and issubclass(unraisable.exc_type, (KeyboardInterrupt, SystemExit)):
            timer = threading.Timer(_AGAIN, _thread.interrupt_main, (self.number,))
            timer.daemon = True
            timer.start()
        else:
            self.before(unraisable)

    def check(self) -> None:
        """Raise what a signal calls for, if one came."""
        if self.number == signal.SIGINT:
            raise KeyboardInterrupt
        if self.number:
            raise SystemExit(128 + self.number)


@contextmanager
def ending() -> Iterator[Ending]:
    """Handle the signals that end a program while the block runs, but those that are ignored, as under nohup.

    Examples
    --------
    >>> with ending() as handler:
    ...     handler.number
    0
    """
    handler, before = Ending(), {}
    try:
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            number = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
                before[number] = signal.signal(number, handler)
    except ValueError:  # not in the main thread: signals go where they went
        pass
    sys.unraisablehook = handler.lost
    try:
        yield handler
    except Exception:  # whatever it is, a signal that came before it is the cause, or at least the end
        handler.check()
        raise
    finally:
        sys.unraisablehook = handler.before
        for number, old in before.items():
            signal.signal(number, old)


def check() -> None:
    """Raise what a signal calls for, if one came and the exception was lost."""
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        handler = signal.getsignal(getattr(signal, name)) if hasattr(signal, name) else None
        if isinstance(handler, Ending):
            handler.check()
