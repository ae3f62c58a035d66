"""The body that rolls, with its builders."""

from __future__ import annotations

from dataclasses import dataclass

from .general import GeneralBuilders
from .rims import RimBuilders
from .rollers import RollerBuilders
from .spheres import SphereBuilders


@dataclass(frozen=True)
class Body(SphereBuilders, RollerBuilders, RimBuilders, GeneralBuilders):
    """A rigid convex body.

    Parameters
    ----------
    mass : float
        m, kg.
    inertia : Isotropic, RatioInertia, Principal or Tensor
        J about the centre of mass.
    shape : Shape
        The surface that touches the support.

    Examples
    --------
    >>> Body.solid_sphere(radius=0.025, mass=0.065).inertia_ratio
    0.4
    """
