"""Builders of ellipsoids, and of bodies given by a formula."""

from __future__ import annotations

import math
from typing import Any, Self

from ...errors import InvalidValueError
from .. import checks
from ..algebra import ZERO
from ..shapes import Ellipsoid, SupportFunction
from .inertia import inertia_of
from .rigid import RigidBody, mass_of
from .whole import homogeneous


class GeneralBuilders(RigidBody):
    """Builders of ellipsoids and bodies of the user's own, for `Body`."""

    @classmethod
    def ellipsoid(
        cls,
        semi_axes: Any,
        mass: Any = None,
        density: Any = None,
        moments: Any = None,
        products: Any = None,
        turn: Any = 0.0,
        centre: Any = None,
    ) -> Self:
        """Make an ellipsoid, homogeneous or with an inertia of its own, as a rattleback has.

        Parameters
        ----------
        semi_axes : sequence of 3 floats or quantities
            a, b, c along the axes of the body frame, m.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        moments : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz about the centre of mass, kg m²; absent: m(b² + c²)/5 and so on.
        products : sequence of 3 floats or quantities, optional
            J_xy, J_xz, J_yz, elements of the tensor with their sign, kg m².
        turn : float or quantity
            The inertia is turned against the shape by this angle about the third axis, from the first towards the
            second, rad.
        centre : sequence of 3 floats or quantities, optional
            The ellipsoid's centre from the centre of mass, body frame, m; absent: the two coincide.

        Returns
        -------
        Body
            The ellipsoid.

        Raises
        ------
        InvalidValueError
            If a value is not positive, or the moments belong to no body.

        Examples
        --------
        >>> from trundle import Body
        >>> Body.ellipsoid((3.0, 2.0, 1.0), mass=5.0).inertia
        Principal(x=5.0, y=10.0, z=13.0)
        """
        a, b, c = checks.components(semi_axes, "length", "semi_axes")
        shape = Ellipsoid(a, b, c, centre)
        m = mass_of(mass, density, 4 / 3 * math.pi * a * b * c)
        if moments is None:
            moments = [m * (p * p + q * q) / 5 for p, q in ((b, c), (c, a), (a, b))]
        return cls(m, inertia_of(moments, products, turn), shape)

    @classmethod
    def shape_formula(
        cls,
        support_function: str,
        mass: Any = None,
        density: Any = None,
        moments: Any = None,
        products: Any = None,
        centre: Any = None,
    ) -> Self:
        """Make a smooth convex body of your own from its support function, homogeneous unless moments are given.

        Parameters
        ----------
        support_function : str
            h(ν) in nu_x, nu_y, nu_z, the components of the outward unit normal, m: how far the body reaches in the
            direction ν from a point of your choice.
        mass, density : float or quantity
            kg or kg/m³; one of the two.
        moments, products : sequence of 3 floats or quantities, optional
            J_xx, J_yy, J_zz and J_xy, J_xz, J_yz about the centre of mass, kg m²; absent: those of a homogeneous body.
        centre : sequence of 3 floats or quantities, optional
            The point that h is reckoned from, from the centre of mass, body frame, m. Absent: where it is in a
            homogeneous body; with `moments`, in the centre of mass.

        Returns
        -------
        Body
            Volume, centre of mass and inertia come from integrals over the surface; the axes stay those of h.

        Raises
        ------
        InvalidValueError
            If h is not that of a smooth convex body; the direction is named.

        Examples
        --------
        >>> from trundle import Body
        >>> egg = Body.shape_formula("0.025 + 0.003*nu_z + 0.004*nu_z**2", density="1.03 g/cm^3")
        >>> round(egg.mass, 4), egg.axisymmetric
        (0.0779, True)
        """
        bare = SupportFunction(support_function)
        if moments is not None:
            m = mass_of(mass, density, homogeneous(bare).volume if mass is None else None)
            return cls(m, inertia_of(moments, products), SupportFunction(bare.formula, centre))
        for name, value in (("products", products), ("centre", centre)):
            if value is not None:
                remedy = "Without them the body is homogeneous, and both follow from its shape."
                raise InvalidValueError(name, "must stand beside `moments`", value, remedy)
        whole = homogeneous(bare)
        m = mass_of(mass, density, whole.volume)
        moments, products = whole.inertia(m)
        away = None if whole.centre == ZERO else ZERO - whole.centre
        return cls(m, inertia_of(moments, products), SupportFunction(bare.formula, away))
