"""What makes a worker ready before anyone asks."""

from __future__ import annotations

import os
import signal
from functools import cache

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

    from ..solve import taylor
    from . import answers

    if taylor.available():
        import heyoka  # noqa: F401
    for name in _SHOWN:
        answers.warm(name)


def begin_worker(niceness: int = 0) -> None:
    """Make a worker ready; what a copy has already costs nothing.

    Parameters
    ----------
    niceness : int
        By how much it stands back for others where the processors are busy.

    Examples
    --------
    In a worker only: it changes what a signal does.
    """
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # ends at once, also within compiled code
    if niceness and hasattr(os, "nice"):
        os.nice(niceness)
    begin()
