"""A disc on a level plane in Euler's angles with Lagrange's multipliers: nothing of it comes from the rolling law.

Heading ψ, lean λ out of upright, own turn φ, centre (x, y, a cos λ). With h along the heading, s to its left and
u = cos λ z + sin λ s from the contact to the centre, the disc's axis is h×u and Ω = −λ̇ h + ψ̇ z + φ̇ h×u.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import sympy as sp


@cache
def accelerations() -> Any:
    """Return a function (m, a, A, C, g, λ, λ̇, ψ̇, φ̇) -> (λ̈, ψ̈, φ̈) and its derivatives by the last four."""
    m, a, A, C, g, t = sp.symbols("m a A C g t", positive=True)
    psi, lean, phi, x, y = (sp.Function(name)(t) for name in ("psi", "lean", "phi", "x", "y"))
    spin = phi.diff() + psi.diff() * sp.sin(lean)
    turning = A * (lean.diff() ** 2 + (psi.diff() * sp.cos(lean)) ** 2) / 2 + C * spin**2 / 2
    moving = m * (x.diff() ** 2 + y.diff() ** 2 + (a * sp.sin(lean) * lean.diff()) ** 2) / 2
    L = turning + moving - m * g * a * sp.cos(lean)
    side = a * sp.cos(lean) * lean.diff()
    slips = [
        x.diff() + a * spin * sp.cos(psi) + side * sp.sin(psi),
        y.diff() + a * spin * sp.sin(psi) - side * sp.cos(psi),
    ]
    multipliers = [
        m * (x.diff() - slip).diff(t) if i == 0 else m * (y.diff() - slip).diff(t) for i, slip in enumerate(slips)
    ]
    equations = [
        L.diff(q.diff()).diff(t)
        - L.diff(q)
        - sum(mu * slip.diff(q.diff()) for mu, slip in zip(multipliers, slips, strict=True))
        for q in (lean, psi, phi)
    ]
    plain = sp.symbols("lean_ lean_rate psi_rate phi_rate", real=True)
    unknown = sp.symbols("lean2 psi2 phi2", real=True)
    second = dict(zip((lean.diff(t, 2), psi.diff(t, 2), phi.diff(t, 2)), unknown, strict=True))
    first = {lean.diff(): plain[1], psi.diff(): plain[2], phi.diff(): plain[3]}
    read = [e.doit().subs(second).subs(first).subs({psi: 0, lean: plain[0]}) for e in equations]
    matrix, right = sp.linear_eq_to_matrix(read, unknown)
    found = matrix.LUsolve(right)
    slopes = found.jacobian(plain)
    return sp.lambdify([(m, a, A, C, g), plain], [found, slopes], modules="numpy", cse=True)


def linear_law(numbers: tuple[float, ...], lean: float, turning: float, own: float) -> tuple[float, np.ndarray]:
    """Return λ̈ at a steady motion (0 if it is one), and the matrix of (λ, λ̇, ψ̇, φ̇) about it."""
    found, slopes = accelerations()(numbers, (lean, 0.0, turning, own))
    matrix = np.zeros((4, 4))
    matrix[0, 1] = 1.0
    matrix[1:] = np.array(slopes, dtype=float)
    return float(np.array(found)[0, 0]), matrix
