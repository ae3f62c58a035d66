"""Work done in a second process while this one goes on: imports and drawing do not share a processor in Python."""

from __future__ import annotations

import os
import pickle
import signal
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Generic, TypeVar

T = TypeVar("T")


class ForkedCall(Generic[T]):
    """A call that runs in a copy of this process, where there is a processor free for it; else when asked for.

    The copy sees everything as it was, and only what the call returns comes back.

    Parameters
    ----------
    call : callable
        What to do; what it returns, or raises, must be picklable.

    Examples
    --------
    >>> ForkedCall(lambda: 6 * 7).result()
    42
    """

    def __init__(self, call: Callable[[], T]) -> None:
        self._call, self._process = call, 0
        self._answer: bytes | None = None
        if sys.platform != "linux" or len(os.sched_getaffinity(0)) < 2:  # elsewhere a copied process is not safe to use
            return
        sys.stdout.flush()
        sys.stderr.flush()
        read, write = os.pipe()
        with warnings.catch_warnings():  # Python warns of threads; those of OpenBLAS are made to be copied
            warnings.simplefilter("ignore", DeprecationWarning)
            self._process = os.fork()
        if self._process:
            os.close(write)
            self._read = read
        else:
            os.close(read)
            _work(call, write)

    def __enter__(self) -> ForkedCall[T]:
        return self

    def __exit__(self, *exception: object) -> None:
        if self._process:  # nobody waits for it any more
            with suppress(ProcessLookupError):
                os.kill(self._process, signal.SIGKILL)
            os.close(self._read)
            self._wait()

    def result(self) -> T:
        """Wait for the call to end and return what it returned, or raise what it raised."""
        if self._answer is None:
            self._answer = self._receive() if self._process else pickle.dumps((self._call(), None))
        value, error = pickle.loads(self._answer)  # noqa: S301  from our own copy
        if error is not None:
            raise error
        return value

    def _receive(self) -> bytes:
        with os.fdopen(self._read, "rb", closefd=False) as pipe:
            answer = pipe.read()
        os.close(self._read)
        self._wait()
        return answer or pickle.dumps((self._call(), None))  # it was killed, for lack of memory perhaps: do it here

    def _wait(self) -> None:
        with suppress(ChildProcessError):
            os.waitpid(self._process, 0)
        self._process = 0


def _work(call: Callable[[], Any], write: int) -> None:
    """Do the call in the copy, send what came of it, and end without the first process's farewells."""
    status = 1
    try:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        try:
            answer = pickle.dumps((call(), None))
        except Exception as error:  # noqa: BLE001  whatever it is, the first process shall hear of it
            answer = pickle.dumps((None, error))
        with os.fdopen(write, "wb") as pipe:
            pipe.write(answer)
        status = 0
    finally:
        os._exit(status)
