"""Ctrl-C, and being told to end: leave through every `finally`, so that no half-written file stays behind."""

from __future__ import annotations

import _thread
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

INTERRUPTED = 130
_AGAIN = 0.25  # s until a signal that was lost is sent once more
_PATIENCE = 80  # times that it is held back while its exception seems to be on its way up


class Ending:
    """A signal handler that ends the command, and remembers that it was called, and whether files are there by then.

    Python loses an exception that a handler raises inside a callback, of the garbage collector, of a lock of imports or
    of compiled code, and prints "Exception ignored"; a compiled library may drop it, or put another in its place. So
    the signal comes again and again, but while its exception is on its way up, until the command is over or says that
    it has `heard`. `lost` keeps Python from printing, and `check` raises what is due.

    Examples
    --------
    >>> ending = Ending()
    >>> ending.check()
    >>> try:
    ...     ending(signal.SIGTERM, None)
    ... except SystemExit as end:
    ...     print(end.code)
    143
    >>> ending.stop()
    """

    def __init__(self) -> None:
        self.number = 0
        self.written = False
        self.before = sys.unraisablehook
        self._lock, self._over, self._sent, self._watched = _thread.allocate_lock(), False, False, False
        self._patience = _PATIENCE

    def __call__(self, number: int, frame: Any) -> None:  # noqa: ARG002
        """Take a signal."""
        if self._over:
            return
        sent, self._sent = self._sent, False
        if sent and self._patience and _on_its_way():
            self._patience -= 1
            return
        self.number = number
        if not self._watched:
            self._watched = True
            _thread.start_new_thread(self._send_again, ())  # no lock that the main thread may hold just now
        self.check()

    def _send_again(self) -> None:
        while True:
            time.sleep(_AGAIN)
            with self._lock:
                if self._over:
                    return
                self._sent = True
                _thread.interrupt_main(signal.Signals(self.number))

    def stop(self) -> None:
        """Hear no more."""
        with self._lock:
            self._over = True

    def lost(self, unraisable: Any) -> None:
        """Take an exception that Python cannot raise where it is, without a word if it is ours."""
        if not (self.number and issubclass(unraisable.exc_type, (KeyboardInterrupt, SystemExit))):
            self.before(unraisable)

    def check(self) -> None:
        """Raise what a signal calls for, if one came."""
        if self._over:
            return
        if self.number == signal.SIGINT:
            raise KeyboardInterrupt
        if self.number:
            raise SystemExit(128 + self.number)


def _on_its_way() -> bool:
    """Tell whether an exception that ends the command is being handled where the signal came."""
    error = sys.exc_info()[1]
    while error is not None and not isinstance(error, (KeyboardInterrupt, SystemExit)):
        error = error.__context__
    return error is not None


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
        handler.check()
    except Exception:  # whatever it is, a signal that came before it is the cause, or at least the end
        handler.check()
        raise
    finally:
        handler.stop()
        sys.unraisablehook = handler.before
        for number, old in before.items():
            signal.signal(number, old)


def deaf() -> None:
    """Hear no more Ctrl-C: what was to be done is done, and Python only takes itself apart."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def check() -> None:
    """Raise what a signal calls for, if one came and the exception was lost."""
    for handler in _handlers():
        handler.check()


def heard() -> None:
    """Tell that a signal was heard, and that what is done now is its answer."""
    for handler in _handlers():
        handler.stop()


def wrote() -> None:
    """Tell those that end the command that its files are there."""
    for handler in _handlers():
        handler.written = True


def _handlers() -> Iterator[Ending]:
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        handler = signal.getsignal(getattr(signal, name)) if hasattr(signal, name) else None
        if isinstance(handler, Ending):
            yield handler
