"""The rolling law on symbols: what `contact.roll` and `contact.touch` return, under the names of the theory page."""

from __future__ import annotations

from typing import Any

import sympy as sp

from ..mechanics.algebra import Matrix, Quaternion, Vector
from ..mechanics.contact import roll
from ..mechanics.loads import BodyMotion
from ..mechanics.system import RollingSystem
from .steps import Proof
from .symbols import OMEGA_XYZ, TIME
from .vectors import vector
from .zero import exact

QUATERNION = sp.symbols("q_w q_x q_y q_z", real=True)
UNIT_QUATERNION = {QUATERNION[0]: 1 - QUATERNION[1] ** 2 - QUATERNION[2] ** 2 - QUATERNION[3] ** 2}


def column(v: Vector) -> Any:
    """Return a vector of the mechanics as a column of exact SymPy expressions.

    Parameters
    ----------
    v : Vector
        Of symbols and numbers.

    Returns
    -------
    sympy.Matrix
        3×1.

    Examples
    --------
    >>> column(Vector(1.0, 0.0, sp.Symbol("a"))).T
    Matrix([[1, 0, a]])
    """
    return sp.Matrix([exact(part) for part in v])


def at_one_instant(system: RollingSystem, point: Vector) -> dict[Any, Any]:
    """Return the values of all vectors of a body that rolls, at any instant of any motion.

    V̇ is not taken from the law but worked out: the rate of V(t, p, q, Ω) as the law moves t, p, q and Ω.

    Parameters
    ----------
    system : RollingSystem
        Of symbols.
    point : Vector
        p, of symbols.

    Returns
    -------
    dict
        A column for each vector: n, ρ, ρ̇, p, r, u, u̇, V, V̇, Ω, Ω̇, R, and the applied F and K.

    Examples
    --------
    >>> import trundle as tr
    >>> a, m, k, x, y = sp.symbols("a m k x y")
    >>> level = tr.RollingSystem(tr.Body.sphere(a, m, k), tr.Support(tr.Plane()))
    >>> at_one_instant(level, Vector(x, y, sp.Integer(0)))[vector("V")].T
    Matrix([[Omega_y*a, -Omega_x*a, 0]])
    """
    q, Omega = Quaternion(*QUATERNION), Vector(*OMEGA_XYZ)
    now = roll(system, TIME, point, q, Omega)
    contact = now.contact
    V, p_rate = now.velocity, now.point_rate
    offset_rate = contact.rates(Vector(0.0, 0.0, 0.0), Omega, V)[1]
    F, K = system.loads_on(BodyMotion(TIME, system.body.mass, contact.centre, V, q, Omega))
    flow = {TIME: sp.Integer(1)}
    for names, rates in ((point, p_rate), (q, now.orientation_rate), (Omega, now.angular_acceleration)):
        flow |= {name: exact(rate) for name, rate in zip(names, rates, strict=True) if getattr(name, "is_Symbol", 0)}

    def rate_of(v: Vector) -> Any:
        return column(v).applyfunc(lambda part: sum(part.diff(name) * rate for name, rate in flow.items()))

    columns = {
        "nhat": contact.normal,
        "rho": contact.offset,
        "rhodot": offset_rate,
        "p": point,
        "r": contact.centre,
        "u": contact.support.material_velocity(point),
        "udot": contact.support.material_acceleration(point, p_rate),
        "V": V,
        "Omega": Omega,
        "Omegadot": now.angular_acceleration,
        "R": now.reaction,
        "F": F,
        "K": K,
    }
    values = {vector(name): column(v) for name, v in columns.items()}
    values[vector("Vdot")] = rate_of(V)
    return values


def proof_at_one_instant(system: RollingSystem, point: Vector) -> Proof:
    """Return a proof by the rolling law: what it makes of an equation holds at any instant of any motion.

    Parameters
    ----------
    system, point
        As for `at_one_instant`.

    Returns
    -------
    Proof
        With the values of the vectors.

    Examples
    --------
    >>> import trundle as tr
    >>> a, m, k, x, y = sp.symbols("a m k x y")
    >>> level = tr.RollingSystem(tr.Body.sphere(a, m, k), tr.Support(tr.Plane()))
    >>> proof = proof_at_one_instant(level, Vector(x, y, sp.Integer(0)))
    >>> proof.equation(m * vector("Vdot"), vector("F") + vector("R")).holds
    True
    """
    return Proof(at_one_instant(system, point), UNIT_QUATERNION)


def inertia(system: RollingSystem) -> Any:
    """Return J in space as a matrix of symbols.

    Parameters
    ----------
    system : RollingSystem
        Of symbols.

    Returns
    -------
    sympy.Matrix
        3×3.

    Examples
    --------
    >>> import trundle as tr
    >>> a, m, k = sp.symbols("a m k")
    >>> inertia(tr.RollingSystem(tr.Body.sphere(a, m, k), tr.Support(tr.Plane())))[0, 0]
    a**2*k*m
    """
    J: Matrix = system.body.inertia_in_space(Quaternion(*QUATERNION).matrix())
    return sp.Matrix([[exact(part) for part in row] for row in J.rows])
