"""Work that takes long stands back for work that does not, where the processors are busy."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any

STEP, MOST = 5, 19  # of niceness: how far it stands back from where the lab itself stands, and the last there is


def computed(function: Callable[..., Any], arguments: tuple[Any, ...], within: float) -> Any:
    """Return what a function returns; what takes longer goes on with less of the processors.

    Examples
    --------
    >>> computed(divmod, (7, 2), 1.0)
    (3, 1)
    """
    if not sys.platform.startswith("linux"):  # where a thread cannot stand back by itself, or not come forward again
        return function(*arguments)
    done: list[Any] = []

    def compute() -> None:
        try:
            done.append((function(*arguments), None))
        except BaseException as error:  # noqa: BLE001  raised again below
            done.append((None, error))

    thread = threading.Thread(target=compute)
    thread.start()
    thread.join(within)
    if thread.is_alive() and thread.native_id is not None:
        with suppress(OSError):
            own = os.getpriority(os.PRIO_PROCESS, thread.native_id)
            os.setpriority(os.PRIO_PROCESS, thread.native_id, min(own + STEP, MOST))
    thread.join()
    result, error = done[0]
    if error is not None:
        raise error
    return result
