"""What is special to one system: its own symbols, contact and loads, and its equations by components."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import sympy as sp

from ...mechanics.algebra import Vector
from ...mechanics.expressions import Expression
from ...mechanics.loads import Force, Torque
from ...mechanics.parameters import numbers, with_numbers
from ...mechanics.scalars import is_number
from ...mechanics.surfaces import Surface
from ...mechanics.system import RollingSystem
from .law import UNIT_QUATERNION, at_one_instant, inertia
from .steps import Proof, Step
from .symbols import OMEGA_XYZ, OMEGADOT_XYZ, R_XYZ, F, K, Omega, Omegadot, R, V, Vdot, m, n, rho, u, x, y
from .vectors import Cross, Times, times, total
from .zero import normal_form

_LONGEST = 60  # operations in one component that a reader may want to see
_NAMES = {
    "mass": "m", "ratio": "k", "moment": "I", "rate": "omega", "variation": "epsilon", "variation_rate": "nu",
    "angle": "epsilon", "tilt": "alpha", "gravity": "g", "coefficient": "c", "air": "omega_a", "friction": "mu",
}  # fmt: skip


def with_symbols(system: RollingSystem) -> RollingSystem:
    """Return a system with symbols for its numbers, named as on the theory page; what is zero stays zero.

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), tr.Spin(3.5)))
    >>> with_symbols(ball).support.motion.rate, with_symbols(ball).support.tilt
    (omega, 0.0)
    """
    names = list(_named(system, "", ""))
    values: list[Any] = []
    taken: dict[str, int] = {}
    for name, value in zip(names, numbers(system), strict=True):
        if value == 0:
            values.append(0.0)
        elif not name:
            values.append(_decimal(value))
        else:
            taken[name] = taken.get(name, 0) + 1
            more = f"{taken[name]}" if taken[name] > 1 else ""
            positive = name not in ("omega", "alpha", "omega_a", "epsilon") and "_" not in name
            values.append(sp.Symbol(name + more, real=True, positive=positive or None))
    return with_numbers(system, values)


def _decimal(value: float) -> Any:
    """Return a number of a formula: a symbol of its digits, since floats in the algebra would round a fraction."""
    exact = sp.Rational(value)
    return exact if exact.q <= 8 else sp.Symbol(f"{value:.15g}", positive=True)


def _named(thing: Any, name: str, inside: str) -> Iterator[str]:
    """Yield a name for each number, in the order of `numbers`; an empty one for numbers of a formula."""
    if isinstance(thing, Expression):
        yield from ("" for _ in numbers(thing))
    elif isinstance(thing, Vector):
        letter = inside or name
        for axis in "xyz":
            yield from _named(getattr(thing, axis), f"{letter}_{axis}", inside)
    elif is_dataclass(thing):
        letter = "F" if isinstance(thing, Force) else "K" if isinstance(thing, Torque) else ""
        for field in fields(thing):
            default = "b" if isinstance(thing, Surface) and field.name == "radius" else "a"
            own = default if field.name == "radius" else _NAMES.get(field.name, field.name)
            yield from _named(getattr(thing, field.name), own, letter)
    elif isinstance(thing, tuple):
        for part in thing:
            yield from _named(part, name, inside)
    elif is_number(thing) and not isinstance(thing, bool):
        yield name


def special_steps(system: RollingSystem) -> Iterator[Step]:
    """Yield the equations of this system by components, where a reader may want to see them.

    Examples
    --------
    >>> import trundle as tr
    >>> air = tr.Drag(0.01, 3.5)
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane(), tr.Spin(3.5)), (air,))
    >>> [step.title for step in special_steps(ball)]
    ['This system', 'Its laws again', 'Its equations of motion']
    """
    if not system.body.is_isotropic_sphere or not system.support.surface.flat or system.support.motion.coordinates:
        return
    own = with_symbols(system)
    tilted_axis = system.support.motion.at(0.0).rotation.c.z != 1
    height = sp.Symbol("z", real=True) if tilted_axis else sp.Integer(0)
    values = at_one_instant(own, Vector(x, y, height))
    moment = inertia(own)[0, 0]
    J = sp.MatrixSymbol("J", 3, 3)
    values[J] = moment * sp.eye(3)
    components = {
        name: value
        for names, v in ((OMEGADOT_XYZ, Omegadot), (R_XYZ, R))
        for name, value in zip(names, values[v], strict=True)
    }
    proof = Proof(values | components | dict(zip(OMEGA_XYZ, values[Omega], strict=True)), UNIT_QUATERNION)
    given = [proof.equation(v, sp.ImmutableMatrix(values[v])) for v in (n, rho, u, F, K) if _short(values[v])]
    sentence = "Its normal, contact, support and loads, with a body at the contact point (x, y):"
    yield Step("This system", sentence, tuple(given))
    laws = (
        proof.equation(times(m, Vdot), total(F, R)),
        proof.equation(Times(J, Omegadot), total(K, Cross(rho, R))),
        proof.equation(total(V, Cross(Omega, rho)), u),
    )
    yield Step("Its laws again", "With its own symbols, for which {J} is a number times 1:", laws, {"J": J})
    shown = [
        proof.equation(name, form)
        for name, value in components.items()
        if (form := normal_form(value)).count_ops() <= _LONGEST
    ]
    if shown:
        yield Step("Its equations of motion", "By components, solved:", tuple(shown))


def _short(v: Any) -> bool:
    return all(part.count_ops() <= _LONGEST for part in v)
