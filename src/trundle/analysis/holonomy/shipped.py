"""The lecture's systems and their relatives, each row taken from the package's own kinematics of contact.

Angles are counted from the support frame's axes. Euler angles are φ about the vertical, θ about the line of nodes, ψ
about the body's own axis (z, x, z).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from ...errors import UnknownNameError
from ...mechanics.algebra import Matrix, Vector
from ...mechanics.contact import Contact
from ...mechanics.motions import Fixed, Motion, Spin
from ...mechanics.shapes import Shape, Sphere
from .functions import on_circles
from .names import NAMES
from .system import PfaffianSystem
from .tower import tidy
from .words import TELLINGS

x, y, phi, theta, psi, t = sp.symbols("x y phi theta psi t", real=True)
a, b, omega = sp.symbols("a b omega", positive=True)
UP = Vector(sp.Integer(0), sp.Integer(0), sp.Integer(1))
ROWS_OF = tuple[tuple[sp.Symbol, ...], list[list[sp.Expr]]]


def load(name: str) -> PfaffianSystem:
    """Return a shipped system by its name.

    Examples
    --------
    >>> load("cylinder").rows
    Matrix([[1, -a]])
    """
    if name not in _MAKERS:
        raise UnknownNameError("system of constraints", name, list(NAMES))
    system = _MAKERS[name]()
    return replace(system, telling=replace(TELLINGS[name], title=NAMES[name]))


# --- what the rows are made of ---------------------------------------------------------------------------


def rotation_about(axis: int, angle: sp.Expr) -> Matrix:
    """Return the rotation by an angle about the first (0), second or third axis."""
    c, s, one, zero = sp.cos(angle), sp.sin(angle), sp.Integer(1), sp.Integer(0)
    rows = [[zero] * 3 for _ in range(3)]
    i, j = (axis + 1) % 3, (axis + 2) % 3
    rows[axis][axis] = one
    rows[i][i], rows[i][j], rows[j][i], rows[j][j] = c, -s, s, c
    return Matrix(*(Vector(*row) for row in rows))


def angular_velocity(Q: Matrix, rates: dict[sp.Symbol, sp.Symbol]) -> Vector:
    """Return Ω of Q̇ = Ω× Q for a rotation that depends on angles with given rates."""
    turned = _rate(Q, rates) @ Q.transpose
    return Vector(*(on_circles(part) for part in (turned.c.y, turned.a.z, turned.b.x)))


def _rate(Q: Matrix, rates: dict[sp.Symbol, sp.Symbol]) -> Matrix:
    return Matrix(*(Vector(*(_along(part, rates) for part in row)) for row in Q.rows))


def _along(e: Any, rates: dict[sp.Symbol, sp.Symbol]) -> sp.Expr:
    return sp.Add(*(sp.diff(e, angle) * rate for angle, rate in rates.items()))


def touching(shape: Shape, Q: Matrix, normal: Vector, motion: Motion, centre: Vector) -> Contact:
    """Return the contact of a body with a support of given normal, as the rolling law makes it."""
    rho, C = shape.contact(Q, normal)
    return Contact(motion.at(t), centre + rho, normal, rho, C, Matrix.zero())


def slip(contact: Contact, centre: Vector, Q: Matrix, rates: dict[sp.Symbol, sp.Symbol]) -> Vector:
    """Return the slip velocity V + Ω×ρ − u(p), linear in the rates."""
    V = Vector(*(_along(part, rates) for part in centre))
    return contact.slip_velocity(V, angular_velocity(Q, rates))


def pfaffian(coordinates: Sequence[sp.Symbol], constraints: Sequence[Any], rates: dict[Any, Any]) -> list[Any]:
    """Return the rows A(q) of constraints linear in the rates."""
    return [[on_circles(_whole(sp.diff(c, rates[q]))) for q in coordinates] for c in constraints]


def _whole(e: sp.Expr) -> sp.Expr:
    """Write the whole numbers that the mechanics has as floats, such as those of its unit vectors, as integers."""
    return e.replace(lambda part: part.is_Float and float(part).is_integer(), lambda part: sp.Integer(int(part)))


def _rates(*coordinates: sp.Symbol) -> dict[sp.Symbol, sp.Symbol]:
    return {q: sp.Symbol(f"{q}_rate") for q in coordinates}


def _on_the_plane(shape: Shape, Q: Matrix, rates: dict[Any, Any], motion: Motion | None = None) -> Vector:
    still = touching(shape, Q, UP, motion or Fixed(), Vector(x, y, sp.Integer(0)))
    centre = Vector(x, y, -still.offset.z)
    return slip(touching(shape, Q, UP, motion or Fixed(), centre), centre, Q, rates)


EULER = rotation_about(2, phi) @ rotation_about(0, theta) @ rotation_about(2, psi)


class _Rim(Shape):
    """A thin disc's sharp rim, X = a ν_t/|ν_t|, for a disc that leans with 0 < θ < π."""

    def support_map(self, nu: Vector) -> Vector:
        length = sp.sqrt(sp.trigsimp(nu.x**2 + nu.y**2)).subs(sp.Abs(sp.sin(theta)), sp.sin(theta))
        return Vector(sp.cancel(a * nu.x / length), sp.cancel(a * nu.y / length), sp.Integer(0))

    def support_gradient(self, nu: Vector) -> Matrix:  # noqa: ARG002  the first derivatives of motion do without it
        return Matrix.zero()


def _moving(system: ROWS_OF, chosen: dict[str, dict[sp.Symbol, Any]]) -> dict[str, list[sp.Expr]]:
    """Return the motions in which some coordinates have given rates and the rest follow from the constraints."""
    coordinates, rows = system
    motions = {}
    for name, given in chosen.items():
        rates = [given.get(q, sp.Dummy()) for q in coordinates]
        unknown = [rate for rate in rates if isinstance(rate, sp.Dummy)]
        solved = sp.solve([sum(c * r for c, r in zip(row, rates, strict=True)) for row in rows], unknown, dict=True)[0]
        motions[name] = [sp.trigsimp(sp.sympify(rate).subs(solved)) for rate in rates]
    return motions


# --- cylinders -------------------------------------------------------------------------------------------


def _cylinder() -> PfaffianSystem:
    q = (x, phi)
    rates = _rates(*q)
    Q, centre = rotation_about(1, phi), Vector(x, sp.Integer(0), a)
    slipping = slip(touching(Sphere(a), Q, UP, Fixed(), centre), centre, Q, rates)
    system = q, pfaffian(q, [slipping.x], rates)
    return PfaffianSystem(*system, _moving(system, {"roll": {phi: 1}}))


def _cylinder_in_cylinder() -> PfaffianSystem:
    q = (theta, phi)
    rates = _rates(*q)
    Q, zero = rotation_about(1, phi), sp.Integer(0)
    inwards, along = Vector(-sp.sin(theta), zero, sp.cos(theta)), Vector(sp.cos(theta), zero, sp.sin(theta))
    centre = -inwards * (b - a)
    slipping = slip(touching(Sphere(a), Q, inwards, Fixed(), centre), centre, Q, rates)
    system = q, pfaffian(q, [slipping.dot(along)], rates)
    return PfaffianSystem(*system, _moving(system, {"roll": {theta: 1}}))


# --- spheres and discs -----------------------------------------------------------------------------------


def _roll(row_of_spin: bool, motion: Motion | None = None) -> ROWS_OF:
    q = (x, y, phi, theta, psi)
    rates = _rates(*q)
    slipping = _on_the_plane(Sphere(a), EULER, rates, motion)
    constraints = [slipping.x, slipping.y] + [angular_velocity(EULER, rates).z] * row_of_spin
    return q, pfaffian(q, constraints, rates)


def _sphere_motions(pivoting: bool) -> dict[str, list[sp.Expr]]:
    """Return the motions with given Ω: V from rolling, and the Euler angles' rates from Ω."""
    rates = _rates(phi, theta, psi)
    Omega = angular_velocity(EULER, rates)
    made_by = Matrix(
        *(Vector(*(sp.diff(part, rate) for rate in rates.values())) for part in Omega)
    )  # Ω = made_by · rates
    contact = touching(Sphere(a), EULER, UP, Fixed(), Vector(x, y, a))
    chosen = {"roll along x": Vector(0, 1 / a, 0), "roll along y": Vector(-1 / a, 0, 0), "pivot": UP}
    motions = {}
    for name, wanted in list(chosen.items())[: 2 + pivoting]:
        V = contact.rolling_velocity(wanted)
        motions[name] = [sp.sympify(V.x), sp.sympify(V.y), *(tidy(rate) for rate in made_by.solve(wanted))]
    return motions


def _sphere() -> PfaffianSystem:
    q, rows = _roll(row_of_spin=False)
    return PfaffianSystem(q, rows, _sphere_motions(pivoting=True))


def _sphere_no_pivot() -> PfaffianSystem:
    q, rows = _roll(row_of_spin=True)
    return PfaffianSystem(q, rows, _sphere_motions(pivoting=False))


def _sphere_on_turntable() -> PfaffianSystem:
    q = (x, y, phi, theta, psi, t)
    rates = _rates(*q)
    slipping = _on_the_plane(Sphere(a), EULER, {c: rates[c] for c in q[:-1]}, Spin(omega))
    still = dict.fromkeys(rates.values(), 0)
    # What has no velocity in it, the table's own motion, belongs to dt.
    constraints = [s + (rates[t] - 1) * sp.sympify(s).subs(still) for s in (slipping.x, slipping.y)]
    motions = _sphere_motions(pivoting=True)
    rows = pfaffian(q, constraints, rates)
    carried = [-y * omega, x * omega, 0, 0, 0, 1]  # with the table's material, without turning in space
    fields: dict[str, Any] = {name: [*components, 0] for name, components in motions.items()}
    return PfaffianSystem(q, rows, fields | {"be carried": carried})


def _coin() -> PfaffianSystem:
    q = (x, y, phi, psi)
    rates = _rates(*q)
    Q = rotation_about(2, phi) @ rotation_about(0, sp.pi / 2) @ rotation_about(2, psi)
    slipping = _on_the_plane(Sphere(a), Q, rates)
    system = q, pfaffian(q, [slipping.x, slipping.y], rates)
    return PfaffianSystem(*system, _moving(system, {"roll": {psi: 1, phi: 0}, "turn": {psi: 0, phi: 1}}))


def _disc() -> PfaffianSystem:
    q = (x, y, phi, theta, psi)
    rates = _rates(*q)
    slipping = _on_the_plane(_Rim(), EULER, rates)
    system = q, pfaffian(q, [slipping.x, slipping.y], rates)
    chosen = {
        "roll": {phi: 0, theta: 0, psi: 1},
        "turn": {phi: 1, theta: 0, psi: 0},
        "lean": {phi: 0, theta: 1, psi: 0},
    }
    return PfaffianSystem(*system, _moving(system, chosen))


# --- blades and wheels -----------------------------------------------------------------------------------


def _ahead(angle: sp.Expr) -> Vector:
    return rotation_about(2, angle) @ Vector(sp.Integer(1), sp.Integer(0), sp.Integer(0))


def _aside(angle: sp.Expr) -> Vector:
    return rotation_about(2, angle) @ Vector(sp.Integer(0), sp.Integer(-1), sp.Integer(0))


def _velocity(place: Vector, rates: dict[Any, Any]) -> Vector:
    return Vector(*(_along(part, rates) for part in place))


def _skate() -> PfaffianSystem:
    q = (x, y, phi)
    rates = _rates(*q)
    sideways = _velocity(Vector(x, y, sp.Integer(0)), rates).dot(_aside(phi))
    system = q, pfaffian(q, [sideways], rates)
    motions = {"glide": [sp.cos(phi), sp.sin(phi), 0], "turn": [0, 0, 1]}
    return PfaffianSystem(*system, motions)


def _car() -> PfaffianSystem:
    delta, length = sp.Symbol("delta", real=True), sp.Symbol("l", positive=True)
    q = (x, y, theta, delta)
    rates = _rates(*q)
    rear = Vector(x, y, sp.Integer(0))
    front = rear + _ahead(theta) * length
    sideways = [_velocity(rear, rates).dot(_aside(theta)), _velocity(front, rates).dot(_aside(theta + delta))]
    system = q, [[tidy(e) for e in row] for row in pfaffian(q, sideways, rates)]
    heading = sp.cos(delta)
    motions = {
        "drive": [heading * sp.cos(theta), heading * sp.sin(theta), sp.sin(delta) / length, 0],
        "steer": [0, 0, 0, 1],
    }
    return PfaffianSystem(*system, motions)


def _trailers() -> PfaffianSystem:
    first, second = sp.symbols("delta_1 delta_2", real=True)
    q = (x, y, theta, first, second)
    rates = _rates(*q)
    headings = (theta, theta + second, theta + second + first)  # of the last trailer, the first one, the tractor
    place, sideways = Vector(x, y, sp.Integer(0)), []
    for heading in headings:
        sideways.append(_velocity(place, rates).dot(_aside(heading)))
        place = place + _ahead(heading)  # the hitch, one unit ahead, on the axle of the next
    along = sp.cos(first) * sp.cos(second)
    turning = sp.cos(first) * sp.sin(second)
    pull = [along * sp.cos(theta), along * sp.sin(theta), turning, -sp.sin(first), sp.sin(first) - turning]
    rows = [[sp.expand_trig(e) for e in row] for row in pfaffian(q, sideways, rates)]
    return PfaffianSystem(q, [[tidy(e) for e in row] for row in rows], {"pull": pull, "turn": [0, 0, 0, 1, 0]})


def _cart() -> PfaffianSystem:
    left, right = sp.symbols("phi_1 phi_2", real=True)
    q = (x, y, theta, left, right)
    rates = _rates(*q)
    middle = Vector(x, y, sp.Integer(0))
    constraints = [_velocity(middle, rates).dot(_aside(theta))]
    for angle, side in ((left, -1), (right, 1)):
        wheel = middle + _aside(theta) * (b * side)
        constraints.append(_velocity(wheel, rates).dot(_ahead(theta)) - a * rates[angle])
    system = q, pfaffian(q, constraints, rates)
    chosen = {"left wheel": {left: 1, right: 0}, "right wheel": {left: 0, right: 1}}
    return PfaffianSystem(*system, _moving(system, chosen))


def _disguised() -> PfaffianSystem:
    z = sp.Symbol("z", real=True)
    return PfaffianSystem((x, y, z), [[2 * x * z, 2 * y * z, -(x**2 + y**2)]])


_MAKERS: dict[str, Callable[[], PfaffianSystem]] = {
    "cylinder": _cylinder,
    "cylinder-in-cylinder": _cylinder_in_cylinder,
    "sphere": _sphere,
    "sphere-no-pivot": _sphere_no_pivot,
    "sphere-on-turntable": _sphere_on_turntable,
    "coin": _coin,
    "disc": _disc,
    "skate": _skate,
    "car": _car,
    "trailers": _trailers,
    "cart": _cart,
    "disguised": _disguised,
}
