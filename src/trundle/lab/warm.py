"""What makes a worker ready before anyone asks."""

from __future__ import annotations

import gc
import signal
import threading
from functools import cache

from . import terminal

_STACK = 16 * 2**20  # bytes, of the thread that computes: some systems give it little
# New objects before garbage is looked for: thirty times as many as usual, since hardly any is in cycles.
_OBJECTS = 20_000
_SHOWN = ("tilted-turntable", "level-turntable-nudged", "ball-in-a-trough")


@cache
def begin() -> None:
    """Load what answers need, and answer something once; a copy of a process that has done so need not.

    Examples
    --------
    >>> begin()
    """
    import scipy.optimize
    import scipy.spatial.transform  # noqa: F401
    import xarray  # noqa: F401

    from ..solve import compiled_steps, taylor
    from . import answers

    if taylor.available():
        import heyoka  # noqa: F401
    if compiled_steps.available():
        import numba  # noqa: F401
    for name in _SHOWN:
        answers.warm(name)


def begin_worker() -> None:
    """Make a worker ready; what a copy has already costs nothing.

    Examples
    --------
    In a worker only: it changes what a signal does.
    """
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # ends at once, also within compiled code
    threading.stack_size(_STACK)
    terminal.install()
    begin()
    gc.set_threshold(_OBJECTS)
