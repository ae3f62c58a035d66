"""The rolling law on symbols: what `contact.roll` and `contact.touch` return, under the names of the theory page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from ...mechanics.algebra import Matrix, Quaternion, Vector
from ...mechanics.contact import contact_at, roll
from ...mechanics.loads import BodyMotion
from ...mechanics.system import RollingSystem
from .symbols import OMEGA_XYZ, TIME
from .vectors import vector
from .zero import exact, normal_form, with_plain_roots

QUATERNION = sp.symbols("q_w q_x q_y q_z", real=True)
UNIT_QUATERNION = {QUATERNION[0]: 1 - QUATERNION[1] ** 2 - QUATERNION[2] ** 2 - QUATERNION[3] ** 2}


def column(v: Vector) -> Any:
    """Return a vector of the mechanics as a column of exact SymPy expressions.

    Examples
    --------
    >>> column(Vector(1.0, 0.0, sp.Symbol("a"))).T
    Matrix([[1, 0, a]])
    """
    return sp.Matrix([with_plain_roots(exact(part)) for part in v])


def at_one_instant(system: RollingSystem, point: Vector, here: Mapping[Any, Any] | None = None) -> dict[Any, Any]:
    """Return the values of all vectors of a body that rolls, at any instant of any motion.

    V̇ is not taken from the law but worked out: the rate of V(t, p, q, Ω) as the law moves t, p, q and Ω.

    Examples
    --------
    >>> import trundle as tr
    >>> a, m, k, x, y = sp.symbols("a m k x y")
    >>> level = tr.RollingSystem(tr.Body.sphere(a, m, k), tr.Support(tr.Plane()))
    >>> at_one_instant(level, Vector(x, y, sp.Integer(0)))[vector("V")].T
    Matrix([[Omega_y*a, -Omega_x*a, 0]])
    """
    chosen = dict(here or {})
    q, names = Quaternion(*QUATERNION), Vector(*OMEGA_XYZ)
    anywhere = column(contact_at(system, TIME, point, q).rolling_velocity(names))
    place, Omega = (Vector(*(sp.sympify(part).xreplace(chosen) for part in v)) for v in (point, names))
    now = roll(system, TIME, place, q, Omega)
    contact = now.contact
    offset_rate = contact.rates(Vector(0.0, 0.0, 0.0), Omega, now.velocity)[1]
    F, K = system.loads_on(BodyMotion(TIME, system.body.mass, contact.centre, now.velocity, q, Omega))
    columns = {
        "nhat": contact.normal,
        "rho": contact.offset,
        "rhodot": offset_rate,
        "p": place,
        "r": contact.centre,
        "u": contact.support.material_velocity(place),
        "udot": contact.support.material_acceleration(place, now.point_rate),
        "V": now.velocity,
        "Omega": Omega,
        "Omegadot": now.angular_acceleration,
        "R": now.reaction,
        "F": F,
        "K": K,
        "pdot": now.point_rate,
    }
    values = {vector(name): column(v).applyfunc(normal_form) for name, v in columns.items()}
    flow = {TIME: sp.Integer(1)} | dict(zip(q, (exact(rate) for rate in now.orientation_rate), strict=True))
    for symbols, rate in ((point, "pdot"), (names, "Omegadot")):
        flow |= {s: r for s, r in zip(symbols, values[vector(rate)], strict=True) if s.is_Symbol}
    values[vector("Vdot")] = anywhere.applyfunc(
        lambda part: normal_form(sum(part.diff(s).xreplace(chosen) * rate for s, rate in flow.items()))
    )
    return values


def inertia(system: RollingSystem) -> Any:
    """Return J in space as a matrix of symbols.

    Examples
    --------
    >>> import trundle as tr
    >>> a, m, k = sp.symbols("a m k")
    >>> inertia(tr.RollingSystem(tr.Body.sphere(a, m, k), tr.Support(tr.Plane())))[0, 0]
    a**2*k*m
    """
    J: Matrix = system.body.inertia_in_space(Quaternion(*QUATERNION).matrix())
    return sp.Matrix([[exact(part) for part in row] for row in J.rows])
