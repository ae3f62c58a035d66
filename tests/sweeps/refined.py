"""A map near its boundary, all at once: what the tests compare with one that is made in pieces."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from trundle.analysis.sweep.refining import Mask, Places, next_places


def refine(shape: tuple[int, int], classes_of: Callable[[Any], Any]) -> tuple[Mask, Places]:
    """Return which fields were run, and the class of every field."""
    run, found = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=np.int64)
    while (following := next_places(run, found))[0].size:
        places = following[0]
        found.ravel()[places] = classes_of(places)
        run.ravel()[places] = True
    return run, following[1]
