"""Builders of bodies that roll straight on a line of contact, and of what rocks on half a round side."""

from __future__ import annotations

import math
from typing import Any, Self

from ...errors import InvalidValueError
from .. import checks
from ..algebra import Vector
from ..scalars import is_number
from ..shapes import HalfCylinder, Hemisphere, Roller
from .inertia import Isotropic, RatioInertia, inertia_of
from .rigid import HOOP, SOLID_CYLINDER, RigidBody, mass_of


class RollerBuilders(RigidBody):
    """Builders of cylinders, hoops and rocking halves, for `Body`."""

    @classmethod
    def cylinder(cls, radius: Any, mass: Any, inertia_ratio: Any = SOLID_CYLINDER) -> Self:
        """Make a cylinder that rolls straight on its round side.

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.
        inertia_ratio : float
            k = I/(m a²) about its axis: 1/2 where it is solid, at most a hoop's 1.

        Returns
        -------
        Body
            The cylinder; its axis is the third of the body frame.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.cylinder("3 cm", "200 g").inertia_ratio
        0.5
        """
        return cls(mass, RatioInertia(inertia_ratio), Roller(radius))

    @classmethod
    def hoop(cls, radius: Any, mass: Any) -> Self:
        """Make a hoop or a thin pipe that rolls straight, I = m a².

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.

        Returns
        -------
        Body
            The hoop. One that may lean and turn is `Body.ring`.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.hoop("30 cm", "1 kg").inertia_ratio
        1.0
        """
        return cls.cylinder(radius, mass, HOOP)

    @classmethod
    def weighted_cylinder(
        cls, radius: Any, mass: Any, weight: Any, distance: Any, inertia_ratio: Any = SOLID_CYLINDER
    ) -> Self:
        """Make a cylinder with a small weight fixed off its axis, on the first axis of the body frame.

        Parameters
        ----------
        radius, mass, inertia_ratio : see cylinder
            Of the cylinder without the weight.
        weight : float or quantity
            Mass of the weight, kg.
        distance : float or quantity
            Of the weight from the axis, m, at most the radius.

        Returns
        -------
        Body
            Its mass is that of both, its inertia that about their common centre of mass.

        Raises
        ------
        InvalidValueError
            If a value is not positive, or the weight would stick out.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.weighted_cylinder(0.05, 0.3, 0.1, 0.04).shape.centre.x
        -0.01
        """
        bare = cls.cylinder(radius, mass, inertia_ratio)
        m, d = checks.positive(weight, "mass", "weight"), checks.positive(distance, "length", "distance")
        if is_number(d) and is_number(bare.radius) and d > bare.radius:
            raise InvalidValueError(
                "distance", "must be at most the radius", distance, f"The cylinder ends at {bare.radius:g} m."
            )
        total = bare.mass + m
        centre = m * d / total
        moment = bare.inertia_ratio * bare.mass * bare.radius**2 + bare.mass * centre**2 + m * (d - centre) ** 2
        return cls(total, Isotropic(moment), Roller(bare.radius, Vector(-centre, 0.0, 0.0)))

    @classmethod
    def eccentric_cylinder(cls, radius: Any, mass: Any, moment_of_inertia: Any, centre: Any = None) -> Self:
        """Make a cylinder of any inertia, with its axis anywhere from its centre of mass, that rolls straight.

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.
        moment_of_inertia : float or quantity
            About the line through the centre of mass along the cylinder, kg m².
        centre : sequence of 3 floats or quantities, optional
            The axis from the centre of mass, in the body frame, m; its third component is 0.

        Returns
        -------
        Body
            The cylinder.

        Raises
        ------
        InvalidValueError
            If a value is not positive, or the centre of mass would lie outside the cylinder.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.eccentric_cylinder("5 cm", "1 kg", 1e-3, centre=("-1 cm", 0, 0)).shape.centre.x
        -0.01
        """
        shape = Roller(radius, centre)
        place = shape.centre
        if place is not None and all(is_number(part) for part in (*place, shape.radius)):
            away = math.hypot(place.x, place.y)
            if away >= shape.radius:
                remedy = f"It lies {away:g} m from a centre of mass that must be inside the cylinder."
                raise InvalidValueError("centre", "must lie less than the radius away", centre, remedy)
        moment = checks.positive(moment_of_inertia, "inertia", "moment_of_inertia")
        return cls(checks.positive(mass, "mass", "mass"), Isotropic(moment), shape)

    @classmethod
    def hemisphere(
        cls,
        radius: Any,
        mass: Any = None,
        density: Any = None,
        moments: Any = None,
        products: Any = None,
        centre: Any = None,
    ) -> Self:
        """Make a half sphere that rocks on its round side; the normal of its flat face is the third axis.

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        moments, products : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz and J_xy, J_xz, J_yz about the centre of mass, kg m²; absent: as below.
        centre : sequence of 3 floats or quantities, optional
            The middle of the flat face from the centre of mass, body frame, m; absent: (0, 0, (3/8) a).

        Returns
        -------
        Body
            A solid one: its centre of mass lies (3/8) a from the flat face; J = (83/320) m a² across the third axis,
            (2/5) m a² about it. It is told apart from a sphere by `shape.covers`, zero where it tips over its edge.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.hemisphere(0.08, mass=1.0).shape.centre.z
        0.03
        """
        shape = Hemisphere(radius)
        a = shape.radius
        m = mass_of(mass, density, 2 / 3 * math.pi * a * a * a)
        across = 83 / 320 * m * (a * a)
        own = (across, across, 2 / 5 * m * (a * a)) if moments is None else moments
        return cls(m, inertia_of(own, products), Hemisphere(a, (0.0, 0.0, 3 / 8 * a) if centre is None else centre))

    @classmethod
    def half_cylinder(
        cls,
        radius: Any,
        mass: Any = None,
        density: Any = None,
        length: Any = None,
        moment_of_inertia: Any = None,
        centre: Any = None,
    ) -> Self:
        """Make a half cylinder that rocks on its round side; the normal of its flat face is the first axis.

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        length : float or quantity, optional
            Along the axis, m; it is needed with a density only.
        moment_of_inertia : float or quantity, optional
            About the line through the centre of mass along the axis, kg m²; absent: as below.
        centre : sequence of 3 floats or quantities, optional
            The axis of the round side from the centre of mass, body frame, m; absent: (4a/(3π), 0, 0).

        Returns
        -------
        Body
            A solid one: its centre of mass lies 4a/(3π) from the flat face; I = (1/2 − 16/(9π²)) m a² about the line
            through it along the axis. It rolls straight, as every cylinder here.

        Examples
        --------
        >>> from trundle import Body
        >>> round(Body.half_cylinder(0.1, mass=1.0).shape.centre.x, 6)
        0.042441
        """
        a = HalfCylinder(radius).radius
        volume = None if length is None else 0.5 * math.pi * a * a * checks.positive(length, "length", "length")
        m = mass_of(mass, density, volume, "`length`")
        away = 4 / (3 * math.pi)
        own = (1 / 2 - away * away) * m * (a * a) if moment_of_inertia is None else moment_of_inertia
        moment = checks.positive(own, "inertia", "moment_of_inertia")
        return cls(m, Isotropic(moment), HalfCylinder(a, (away * a, 0.0, 0.0) if centre is None else centre))
