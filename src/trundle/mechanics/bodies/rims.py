"""Builders of what stands on its rim: coins, rings, tori."""

from __future__ import annotations

import math
from typing import Any, Self

from ...errors import InvalidValueError
from .. import checks
from ..scalars import is_number
from ..shapes import Disc, Torus
from .inertia import Principal
from .rigid import RigidBody, mass_of


class RimBuilders(RigidBody):
    """Builders of discs, rings and tori on their rim, for `Body`."""

    @classmethod
    def disc(cls, radius: Any, mass: Any = None, density: Any = None, thickness: Any = 0.0) -> Self:
        """Make a homogeneous disc, a coin, that rolls, leans and spins on its rim.

        Parameters
        ----------
        radius : float or quantity
            a, m.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        thickness : float or quantity
            d, m. It counts in mass and inertia; the rim that touches is the sharp circle half way between the faces.

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
        return cls(m, Principal(across, across, m * (a * a) / 2), shape)

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
    def torus(cls, radius: Any, rim_radius: Any, mass: Any = None, density: Any = None) -> Self:
        """Make a homogeneous solid ring of round cross-section that rolls, leans and spins on its rim.

        Parameters
        ----------
        radius : float or quantity
            a, of the circle through the middle of the ring, m; the whole is a + e in radius.
        rim_radius : float or quantity
            e, of the cross-section, m, at most a.
        mass, density : float or quantity
            kg or kg/m³; one of the two.

        Returns
        -------
        Body
            J = m(a²/2 + 5e²/8) across its axis, the third of the body frame, and m(a² + 3e²/4) about it.

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
        return cls(m, Principal(across, across, m * (a * a + 3 * (e * e) / 4)), shape)
