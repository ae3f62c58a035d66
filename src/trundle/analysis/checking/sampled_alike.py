"""Our own run, sampled as theirs is: what the way of looking finds in it is no mistake of theirs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...errors import TrundleError
from ...mechanics.system import RollingSystem, State
from ...solve import methods
from ...solve.samples import RESTING, ROLLING
from .examining import View, examine
from .integrals import integrals
from .record import Array, ExternalTrajectory, checked
from .series import Series

_TIMES = 2.0  # what is found in ours: theirs is not the same motion
_BESIDE = 0.05  # share of the instants, to either side, at which ours may show it
_ARRAYS = ("velocity", "angular_velocity", "orientation")


def allowed_for(
    series: Mapping[str, Series],
    system: RollingSystem,
    theirs: ExternalTrajectory,
    tolerance: float,
    view: View,
    start: State,
) -> dict[str, Series]:
    """Widen each bound to twice what is found in our own run at about the same instant.

    Samples that hardly follow a motion look as if they had noise; what that leaves open, noise alone does not tell.
    """
    try:
        _, samples = methods.run("auto", system, start, theirs.time)
        if samples.time.size < theirs.time.size or not np.isin(samples.phase, (ROLLING, RESTING)).all():
            return dict(series)
        given = {name: getattr(samples, name) for name in _ARRAYS if getattr(theirs, name) is not None}
        ours = checked(
            ExternalTrajectory(theirs.time, samples.position, **given, height_given=theirs.height_given), system
        )
        found, _ = examine(system, ours, tolerance, start, view)
        found |= {one.name: one for one in integrals(system, ours, tolerance, start)}
    except TrundleError:
        return dict(series)
    return {name: _widened(one, found[name].length) if name in found else one for name, one in series.items()}


def _widened(one: Series, found: Array) -> Series:
    from scipy.ndimage import maximum_filter1d

    if found.size != one.time.size:
        return one
    about = maximum_filter1d(found, 2 * int(np.ceil(_BESIDE * found.size)) + 1)
    return replace(one, bound=np.maximum(one.bound, _TIMES * about))
