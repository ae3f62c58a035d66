"""Builders of what stands on its rim: coins, rings, tori."""

from __future__ import annotations

import math
from typing import Any, Self

from ...errors import InvalidValueError
from .. import checks
from ..scalars import is_number
from ..shapes import Disc, Torus
from .inertia import Principal, inertia_of
from .rigid import RigidBody, mass_of


class RimBuilders(RigidBody):
    """Builders of discs, rings and tori on their rim, for `Body`."""

    @classmethod
    def disc(
        cls,
        radius: Any,
        mass: Any = None,
        density: Any = None,
        thickness: Any = 0.0,
        moments: Any = None,
        products: Any = None,
        centre: Any = None,
    ) -> Self:
        """Make a disc, a coin, that rolls, leans and spins on its rim; homogeneous unless moments are given.

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        thickness : float or quantity
            d, m. It counts in mass and inertia; the rim that touches is the sharp circle half way between the faces.
        moments, products : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz and J_xy, J_xz, J_yz about the centre of mass, kg m²; absent: as below.
        centre : sequence of 3 floats or quantities, optional
            The middle of the disc from the centre of mass, body frame, m; absent: the two coincide.

        Returns
        -------
        Body
            J = m(a²/4 + d²/12) across its axis, the third of the body frame, and m a²/2 about it.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.disc(2.0, mass=1.0).inertia
        Principal(x=1.0, y=1.0, z=2.0)
        """
        shape = Disc(radius)
        a, d = shape.radius, checks.non_negative(thickness, "length", "thickness")
        volume = None if isinstance(d, float) and d == 0 else math.pi * a * a * d
        m = mass_of(mass, density, volume, "`thickness`")
        across = m * (a * a / 4 + d * d / 12)
        own = (across, across, m * (a * a) / 2) if moments is None else moments
        return cls(m, inertia_of(own, products), Disc(a, centre))

    @classmethod
    def ring(cls, radius: Any, mass: Any) -> Self:
        """Make a thin ring that rolls, leans and spins on its rim; one that rolls straight is `Body.hoop`.

        Parameters
        ----------
        radius, mass : float or quantity
            a in m, m in kg.

        Returns
        -------
        Body
            J = m a²/2 across its axis, the third of the body frame, and m a² about it.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.ring(2.0, 1.0).inertia
        Principal(x=2.0, y=2.0, z=4.0)
        """
        shape = Disc(radius)
        m, a = checks.positive(mass, "mass", "mass"), shape.radius
        return cls(m, Principal(m * (a * a) / 2, m * (a * a) / 2, m * (a * a)), shape)

    @classmethod
    def torus(
        cls,
        radius: Any,
        rim_radius: Any,
        mass: Any = None,
        density: Any = None,
        moments: Any = None,
        products: Any = None,
        centre: Any = None,
    ) -> Self:
        """Make a solid ring of round cross-section that rolls, leans and spins on its rim.

        Parameters
        ----------
        radius : float or quantity
            a, of the circle through the middle of the ring, m; the whole is a + e in radius.
        rim_radius : float or quantity
            e, of the cross-section, m, at most a.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        moments, products : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz and J_xy, J_xz, J_yz about the centre of mass, kg m²; absent: as below.
        centre : sequence of 3 floats or quantities, optional
            The middle of the ring from the centre of mass, body frame, m; absent: the two coincide.

        Returns
        -------
        Body
            J = m(a²/2 + 5e²/8) across its axis, the third of the body frame, and m(a² + 3e²/4) about it. With moments
            of its own it may as well be a disc whose rim is rounded.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.torus(2.0, 1.0, mass=8.0).inertia
        Principal(x=21.0, y=21.0, z=38.0)
        """
        e = checks.positive(rim_radius, "length", "rim_radius")
        shape = Torus(radius, e)
        a = shape.radius
        if is_number(a) and is_number(e) and e > a:
            remedy = f"A ring of radius {a:g} m has no hole left at that."
            raise InvalidValueError("rim_radius", "must be at most `radius`", rim_radius, remedy)
        m = mass_of(mass, density, 2 * math.pi**2 * a * e * e)
        across = m * (a * a / 2 + 5 * (e * e) / 8)
        own = (across, across, m * (a * a + 3 * (e * e) / 4)) if moments is None else moments
        return cls(m, inertia_of(own, products), Torus(a, e, centre))
