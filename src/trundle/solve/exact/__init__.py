"""Closed forms, one file each, with domain, source and equation number.

A new closed form is one class derived from `ClosedForm`; add it to `CLOSED_FORMS`, and inherit the contract test in
`tests/contracts`.
"""

from __future__ import annotations

from ...errors import SolverError
from ...mechanics.system import RollingSystem, State
from .. import following
from ..samples import RESTING, ROLLING
from .ball_in_leaning_cylinder import BallInLeaningCylinder
from .ball_in_upright_cylinder import BallInUprightCylinder
from .base import ClosedForm
from .cylinder_on_cylinder import CylinderOnCylinder
from .sphere_coming_to_rest import SphereComingToRest
from .sphere_in_moving_air import SphereInMovingAir
from .sphere_on_plane import SphereOnPlane
from .sphere_on_unsteady_plane import SphereOnUnsteadyPlane

CLOSED_FORMS: tuple[type[ClosedForm], ...] = (
    SphereOnPlane,
    CylinderOnCylinder,
    BallInUprightCylinder,
    BallInLeaningCylinder,
    SphereInMovingAir,
    SphereComingToRest,
    SphereOnUnsteadyPlane,
)


def closed_form(system: RollingSystem, start: State) -> ClosedForm | None:
    """Return the closed form that covers a system, if there is one.

    Parameters
    ----------
    system : RollingSystem
        Any system.
    start : State
        A start that rolls.

    Returns
    -------
    ClosedForm or None
        The motion, or None where no closed form applies.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> closed_form(system, system.place()).equation
    'T5'
    """
    if system.support.friction is not None or not _rolls(system, start):  # a limit to friction may end the rolling
        return None
    for form in CLOSED_FORMS:
        if not form.outside(system, start):
            return form.of(system, start)
    return None


def _rolls(system: RollingSystem, start: State) -> bool:
    try:
        return following.at_start(system, start).law.code in (ROLLING, RESTING)
    except SolverError:  # it cannot go on at all
        return False


__all__ = [
    "CLOSED_FORMS",
    "BallInLeaningCylinder",
    "BallInUprightCylinder",
    "ClosedForm",
    "CylinderOnCylinder",
    "SphereComingToRest",
    "SphereInMovingAir",
    "SphereOnPlane",
    "SphereOnUnsteadyPlane",
    "closed_form",
]
