"""The drag of room air on a ball, as the linear coefficient that a scenario takes."""

from __future__ import annotations

import math
from typing import Any

from ...mechanics import checks

# Air at 20 °C and 101325 Pa: U.S. Standard Atmosphere (1976), by its gas law and Sutherland's formula.
DENSITY, VISCOSITY = 1.2041, 1.8134e-5  # kg/m³, Pa s
BLUNT = 0.44  # the drag coefficient of a sphere beyond Re = 1000, as far as some 200 000


def air_drag(radius: Any, speed: Any) -> float:
    """Return the linear drag coefficient c = F/V that room air has for a ball at one speed.

    The drag on a ball is not linear: F is ½ϱAC V² with C = (24/Re)(1 + 0.15 Re^0.687) up to Re = 1000 (Schiller and
    Naumann) and 0.44 beyond. On a circle the speed is constant, and a linear drag of this coefficient is the
    same force; where the speed changes, the coefficient changes with it, a little less than in proportion.

    Parameters
    ----------
    radius : float or quantity
        Of the ball, m.
    speed : float or quantity
        Through the air, m/s.

    Returns
    -------
    float
        c, kg/s.

    Raises
    ------
    InvalidValueError
        If the radius is not positive or the speed is negative.

    References
    ----------
    [schiller1933].

    Examples
    --------
    >>> print(f"{air_drag('25 mm', '0.1 m/s') * 1e3:.3f} g/s")
    0.078 g/s
    >>> air_drag(0.025, 0.0) == 6 * math.pi * VISCOSITY * 0.025  # Stokes
    True
    """
    a = checks.positive(radius, "length", "radius")
    v = checks.non_negative(speed, "velocity", "speed")
    reynolds = DENSITY * v * 2 * a / VISCOSITY
    # C Re/24: how many times Stokes's drag.
    return float(6 * math.pi * VISCOSITY * a * max(1 + 0.15 * reynolds**0.687, BLUNT * reynolds / 24))
