"""Imported by the process that the workers are copies of, so that each of them begins with everything loaded."""

from __future__ import annotations

import gc
from contextlib import suppress

from .warm import begin

with suppress(BaseException):  # a worker will say what is wrong; Ctrl-C is the server's to hear
    begin()
    gc.collect()
    gc.freeze()  # a full pass over all that is loaded takes a copy a fifth of a second, at any moment
