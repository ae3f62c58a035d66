"""The spin of a ball whose path alone was given: on a bent surface it acts on the path, and the path tells it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from ...mechanics.system import RollingSystem, State
from .case import Case
from .comparisons import ACCELERATION
from .examining import View, examine, view_of
from .laws import independent_law
from .mistakes import Suspect
from .motion import motion_of
from .record import ExternalTrajectory

_WINDOWS = 16


def acts(system: RollingSystem, theirs: ExternalTrajectory) -> bool:
    """Tell whether nothing that was given tells a spin that acts on the path."""
    known = theirs.angular_velocity is not None or theirs.orientation is not None
    return not known and not system.support.surface.flat


def fitted_spin(
    system: RollingSystem, theirs: ExternalTrajectory, tolerance: float, start: State | None, view: View | None = None
) -> float | None:
    """Return the spin at the first sample that leaves least of the law."""
    view = (view_of(system, theirs, tolerance, start) if view is None else view).thinned(_WINDOWS)
    at = motion_of(system, theirs, start, view.instants)
    unit = max(float(np.linalg.norm(at.velocity, axis=1).max()) / at.arm, 1e-9)
    found = []
    for spin in (0.0, unit):
        series, _ = examine(system, replace(theirs, spin=spin), tolerance, start, view, independent_law)
        found.append(series[ACCELERATION].residual)
    slope = (found[1] - found[0]) / unit
    size = float((slope * slope).sum())
    return None if size == 0 else float(-(found[0] * slope).sum() / size)


def another_spin(case: Case) -> Iterator[Suspect]:
    """Yield another spin than that of the scenario, where the path alone was given."""
    if case.start is None or not acts(case.system, case.theirs):
        return
    spin = fitted_spin(case.system, case.theirs, case.tolerance, case.start, case.view)
    if spin is not None:
        says = f"It starts with another spin than the scenario says: Ω·n = {spin:.5g} rad/s fits."
        undo = partial(_spun, spin=spin)
        yield Suspect("another-spin", says, frozenset({"spin"}), theirs=undo, numbers={"spin": spin}, named=False)


def _spun(theirs: ExternalTrajectory, spin: float) -> ExternalTrajectory:
    return replace(theirs, spin=spin)
