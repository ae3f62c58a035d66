"""Closed forms, one file each, with domain, source and equation number.

A new closed form is one class with `of`, `outside`, `motion_at`, `period` and the facts `name`, `equation`,
`source`, `domain`; add it to `CLOSED_FORMS`, and inherit the contract test in `tests/contracts`.
"""

from __future__ import annotations

from ...mechanics.system import RollingSystem, State
from .sphere_on_plane import SphereOnPlane

CLOSED_FORMS = (SphereOnPlane,)


def closed_form(system: RollingSystem, start: State) -> SphereOnPlane | None:
    """Return the closed form that covers a system, if there is one.

    Parameters
    ----------
    system : RollingSystem
        Any system.
    start : State
        A start that rolls.

    Returns
    -------
    SphereOnPlane or None
        The motion, or None where no closed form applies.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()))
    >>> closed_form(system, system.place()).equation
    'T5'
    """
    for form in CLOSED_FORMS:
        if not form.outside(system):
            return form.of(system, start)
    return None


__all__ = ["CLOSED_FORMS", "SphereOnPlane", "closed_form"]
