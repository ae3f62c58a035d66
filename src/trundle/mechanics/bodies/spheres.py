"""Builders of spheres: about their centre of mass, or with it elsewhere."""

from __future__ import annotations

import math
from typing import Any, Self

from ...errors import InvalidValueError
from .. import checks
from ..scalars import is_number, namespace
from ..shapes import Sphere
from ..shapes.base import centre_of
from .inertia import RatioInertia, inertia_of
from .rigid import HOLLOW_SPHERE, SOLID_SPHERE, RigidBody, mass_of


class SphereBuilders(RigidBody):
    """Builders of spheres, for `Body`."""

    @classmethod
    def sphere(cls, radius: Any, mass: Any, inertia_ratio: Any) -> Self:
        """Make a sphere whose mass lies symmetrically about its centre.

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass : float or quantity
            m, kg.
        inertia_ratio : float
            k = I/(m a²): 2/5 for a solid sphere, 2/3 for a shell, never more.

        Returns
        -------
        Body
            The sphere.

        Raises
        ------
        InvalidValueError
            If a value is not positive, or k is more than a shell's.

        Examples
        --------
        >>> from trundle import Body
        >>> ball = Body.sphere(radius="40 mm", mass="2.7 g", inertia_ratio=0.5)
        >>> ball.shape.radius, round(ball.inertia_ratio, 12)
        (0.04, 0.5)
        """
        return cls(mass, RatioInertia(inertia_ratio), Sphere(radius))

    @classmethod
    def solid_sphere(cls, radius: Any, mass: Any = None, density: Any = None) -> Self:
        """Make a homogeneous ball, I = (2/5) m a².

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass, density : float or quantity
            One of the two, kg or kg/m³.

        Returns
        -------
        Body
            The ball.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.solid_sphere(radius=1.0, mass=5.0).inertia_ratio
        0.4
        >>> f"{Body.solid_sphere('25 mm', density='7.8 g/cm^3').mass:.3f} kg"
        '0.511 kg'
        """
        shape = Sphere(radius)
        a = shape.radius
        return cls.sphere(a, mass_of(mass, density, 4 / 3 * math.pi * a * a * a), SOLID_SPHERE)

    @classmethod
    def hollow_sphere(cls, radius: Any, mass: Any) -> Self:
        """Make a thin spherical shell, I = (2/3) m a².

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.

        Returns
        -------
        Body
            The shell.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.hollow_sphere(radius=1.0, mass=3.0).inertia_ratio
        0.6666666666666666
        """
        return cls.sphere(radius, mass, HOLLOW_SPHERE)

    @classmethod
    def eccentric_sphere(cls, radius: Any, mass: Any, moments: Any, centre: Any = None, products: Any = None) -> Self:
        """Make a sphere with any inertia and its centre of mass anywhere inside: a Chaplygin ball, a Routh sphere.

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.
        moments : sequence of 3 floats or quantities
            J_xx, J_yy, J_zz about the centre of mass, along the axes of the body frame, kg m².
        centre : sequence of 3 floats or quantities, optional
            The sphere's centre from the centre of mass, body frame, m; absent: the two coincide (Chaplygin's ball).
        products : sequence of 3 floats or quantities, optional
            J_xy, J_xz, J_yz, elements of the tensor with their sign, kg m².

        Returns
        -------
        Body
            The sphere.

        Raises
        ------
        InvalidValueError
            If the centre of mass lies outside the sphere, or the moments belong to no body.

        Examples
        --------
        A tippe top without its stem: heavy at the bottom, so its centre lies above its centre of mass.

        >>> from trundle import Body
        >>> Body.eccentric_sphere("15 mm", "6 g", (8e-7, 8e-7, 7e-7), centre=(0, 0, "2 mm")).axisymmetric
        True
        """
        place = centre_of(centre)
        if place is not None and all(is_number(part) and part == 0 for part in place):
            place = None
        shape = Sphere(radius, place)
        if place is not None and all(is_number(part) for part in (*place, shape.radius)):
            away = namespace().sqrt(place.dot(place))
            if away >= shape.radius:
                remedy = f"It lies {away:g} m from a centre of mass that must be inside the sphere."
                raise InvalidValueError("centre", "must lie less than the radius away", centre, remedy)
        return cls(checks.positive(mass, "mass", "mass"), inertia_of(moments, products), shape)
