"""Closed forms, one file each, with domain, formula, source and equation number.

A new closed form is one class derived from `ClosedForm` that says all of this about itself; name its module here, and
inherit the contract test in `tests/contracts`.
"""

from __future__ import annotations

from collections.abc import Sequence

# The first that covers a motion is taken: the narrower stand before the wider.
# isort: skip_file
from ...errors import SolverError
from ...mechanics.system import RollingSystem, State
from .. import transitions
from .base import ClosedForm
from .sphere_on_plane import SphereOnPlane
from .cylinder_on_cylinder import CylinderOnCylinder
from .ball_in_upright_cylinder import BallInUprightCylinder
from .ball_in_leaning_cylinder import BallInLeaningCylinder
from .sphere_in_moving_air import SphereInMovingAir
from .sphere_coming_to_rest import SphereComingToRest
from .sphere_on_unsteady_plane import SphereOnUnsteadyPlane
from .sphere_on_free_plane import SphereOnFreePlane
from .sphere_on_sphere import SphereOnSphere
from .steady_chaplygin_ball import SteadyChaplyginBall
from .chaplygin_ball import ChaplyginBall
from .upright_chaplygin_ball import UprightChaplyginBall
from .sliding_sphere import SlidingSphere
from .sphere_in_flight import SphereInFlight
from .resting_body import RestingBody
from .off_a_dome import OffADome

CLOSED_FORMS: tuple[type[ClosedForm], ...] = tuple(
    form
    for form in vars().values()
    if isinstance(form, type) and issubclass(form, ClosedForm) and form is not ClosedForm
)


def closed_form(system: RollingSystem, start: State) -> ClosedForm | None:
    """Return the closed form that covers a system, if there is one.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> closed_form(system, system.place()).equation
    'T5'
    """
    try:
        now = transitions.slipping(system, transitions.at_start(system, start))
    except SolverError:  # it cannot go on at all
        return None
    return form_of_phase(now.law.code, system, now.start, now.state_vector)


def form_of_phase(phase: int, system: RollingSystem, start: State, numbers: Sequence[float]) -> ClosedForm | None:
    """Return the closed form that covers one phase of contact from a state on, if there is one."""
    for form in CLOSED_FORMS:
        if phase in form.phases and not form.violations(system, start):
            return form.from_state_vector(system, start, numbers)
    return None


def refusals(phase: int, system: RollingSystem, start: State) -> str:
    """Say why no closed form covers a phase."""
    found = " ".join(form.refusal(system, start) for form in CLOSED_FORMS if phase in form.phases)
    doing = ("rolls", "slips", "flies", "rests")[phase]
    return f'From t = {start.time:.6g} s the body {doing}. {found} Use method="taylor" or method="runge-kutta".'


__all__ = [
    "CLOSED_FORMS",
    "BallInLeaningCylinder",
    "BallInUprightCylinder",
    "ChaplyginBall",
    "ClosedForm",
    "CylinderOnCylinder",
    "OffADome",
    "RestingBody",
    "SlidingSphere",
    "SphereComingToRest",
    "SphereInFlight",
    "SphereInMovingAir",
    "SphereOnFreePlane",
    "SphereOnPlane",
    "SphereOnSphere",
    "SphereOnUnsteadyPlane",
    "SteadyChaplyginBall",
    "UprightChaplyginBall",
    "closed_form",
    "form_of_phase",
    "refusals",
]
