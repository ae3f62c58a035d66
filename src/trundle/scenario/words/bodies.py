"""From a body back to its table."""

from __future__ import annotations

from ...mechanics.bodies import HOLLOW_SPHERE, SOLID_SPHERE, Body, Isotropic
from .parts import Words, number_of, wordless


def body_words(body: Body) -> Words:
    """Return the table of a body.

    Parameters
    ----------
    body : Body
        One body, in numbers.

    Returns
    -------
    dict
        Its ``[body]``.

    Raises
    ------
    ScenarioError
        If the format has no words for it.

    Examples
    --------
    >>> body_words(Body.solid_sphere(radius=0.025, mass=0.065))
    {'kind': 'solid-sphere', 'radius': 0.025, 'mass': 0.065}
    """
    if not body.is_isotropic_sphere or (body.shape.axis is not None and isinstance(body.inertia, Isotropic)):
        raise wordless("body", body)
    ratio = number_of(body.inertia_ratio, "body.inertia_ratio")
    radius = getattr(body.shape, "radius", None)
    size = {"radius": number_of(radius, "body.radius"), "mass": number_of(body.mass, "body.mass")}
    if isinstance(body.inertia, Isotropic):  # its ratio would be rounded once more
        moment = number_of(body.inertia.moment, "body.inertia.moment")
        return {"kind": "sphere-with-moment", **size, "moment_of_inertia": moment}
    if body.shape.axis is not None:
        return {"kind": "cylinder", **size, "inertia_ratio": ratio}
    if ratio == SOLID_SPHERE:
        return {"kind": "solid-sphere", **size}
    if ratio == HOLLOW_SPHERE:
        return {"kind": "hollow-sphere", **size}
    return {"kind": "sphere", **size, "inertia_ratio": ratio}
