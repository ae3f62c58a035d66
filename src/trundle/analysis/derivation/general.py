"""The derivation of a system without a closed form: from Newton, Euler and rolling to the equations of motion T1-T3.

It is one derivation for every body, support, motion and load: each of them is put into `contact.roll` as nothing but
symbols, so what is proved here holds whatever stands in their places. What is special to the system stands at the end.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy as sp

from ...mechanics.algebra import E_Z, ZERO, Matrix, Quaternion, Vector
from ...mechanics.bodies import Body, Principal
from ...mechanics.contact import Contact, roll
from ...mechanics.loads import Load
from ...mechanics.motions import Motion, SupportState
from ...mechanics.shapes import Shape
from ...mechanics.surfaces import Surface
from ...mechanics.system import RollingSystem, Support
from .law import QUATERNION, column
from .special import special_steps
from .steps import Proof, Step
from .symbols import OMEGA_XYZ, TIME, F, K, Omega, Omegadot, R, V, Vdot, m, n, p, pdot, rho, rhodot, u, udot
from .vectors import Cross, Dot, Times, times, total, vector

J, C, S = (sp.MatrixSymbol(name, 3, 3) for name in "JCS")
turn, w = vector("omega"), vector("w")


def _free(name: str) -> Vector:
    return Vector(*sp.symbols([f"{name}_{axis}" for axis in "xyz"], real=True))


def _flat(name: str) -> Matrix:
    """Return a symmetric matrix on the tangent plane of a normal along the third axis."""
    xx, xy, yy = sp.symbols([f"{name}_{axes}" for axes in ("xx", "xy", "yy")], real=True)
    return Matrix(Vector(xx, xy, 0.0), Vector(xy, yy, 0.0), ZERO)


@dataclass(frozen=True)
class AnyShape(Shape):
    """Any shape: ρ and C are symbols, C with the axes chosen along the normal.

    Where the dynamics is asked for, C is three symbols that let the contact move with any velocity.
    """

    curved: bool = True

    def contact(self, Q: Matrix, n: Vector) -> tuple[Vector, Matrix]:  # noqa: ARG002
        """Return ρ and C."""
        x, y, z = _free("C")
        wander = Matrix(Vector(x, 0.0, 0.0), Vector(y, 0.0, 0.0), Vector(z, 0.0, 0.0))
        return _free("rho"), _flat("C") if self.curved else wander


@dataclass(frozen=True)
class AnyInertia(Principal):
    """Any inertia: J in space is three symbols, the axes chosen along the principal ones at this instant."""

    def in_space(self, Q: Matrix, body: Body) -> Matrix:  # noqa: ARG002
        """Return J."""
        return Matrix.diagonal(*_free("J"))


@dataclass(frozen=True)
class AnySurface(Surface):
    """Any surface: the axes are chosen with the third along its normal at the contact, and S is symbols, or 0.

    S decides how the contact moves, and nothing else: the dynamics holds for any velocity of it, and is asked with
    S = 0.
    """

    curved: bool = True
    rim = None
    axisymmetric = False

    def normal(self, p: Vector) -> Vector:  # noqa: ARG002
        """Return n."""
        return E_Z

    def shape_operator(self, p: Vector) -> Matrix:  # noqa: ARG002
        """Return S."""
        return _flat("S") if self.curved else Matrix.zero()


@dataclass(frozen=True)
class AnyMotion(Motion):
    """Any motion of the support: X, ω and their rates at the instant are symbols."""

    def at(self, time: Any) -> SupportState:  # noqa: ARG002
        """Return the support at this instant."""
        names = ("X", "Xdot", "Xddot", "omega", "omegadot")
        return SupportState(Matrix.identity(), *(_free(name) for name in names))


@dataclass(frozen=True)
class AnyLoad(Load):
    """Any load: F and K are symbols."""

    def force(self, motion: Any) -> Vector:  # noqa: ARG002
        """Return F."""
        return _free("F")

    def torque(self, motion: Any) -> Vector:  # noqa: ARG002
        """Return K."""
        return _free("K")


def introduction(system: RollingSystem) -> str:
    """Say what is derived for a system, and why it ends where it does.

    Examples
    --------
    >>> import trundle as tr
    >>> introduction(tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())))[:20]
    'No closed form that '
    """
    del system
    return (
        "No closed form that is derived here covers this system, so the derivation ends with the equations of motion. "
        "It is the same for every body, support and load."
    )


@cache
def proof_of_any(*, curved: bool = False) -> Proof:
    """Return the proof by the rolling law for a body, a support and loads of which nothing is known.

    Examples
    --------
    >>> proof_of_any().values[n].T
    Matrix([[0, 0, 1]])
    """
    one = sp.Integer(1)
    body = Body(m, AnyInertia(one, one, one), AnyShape(curved))
    system = RollingSystem(body, Support(AnySurface(curved), AnyMotion()), (AnyLoad(),), 0.0)
    q, turning, place = Quaternion(*QUATERNION), Vector(*OMEGA_XYZ), _free("p")
    now = roll(system, TIME, place, q, turning)
    contact = now.contact
    offset_rate = contact.rates(ZERO, turning, now.velocity)[1]
    material = contact.support.material_velocity(place)
    columns = {
        n: contact.normal,
        rho: contact.offset,
        rhodot: offset_rate,
        p: place,
        pdot: now.point_rate,
        u: material,
        udot: contact.support.material_acceleration(place, now.point_rate),
        w: now.point_rate - material,
        V: now.velocity,
        Omega: turning,
        turn: contact.support.angular_velocity,
        Omegadot: now.angular_acceleration,
        R: now.reaction,
        F: _free("F"),
        K: _free("K"),
    }
    values = {name: column(v) for name, v in columns.items()}
    matrices = {J: body.inertia_in_space(q.matrix()), C: contact.inverse_curvature, S: contact.shape_operator}
    values |= {name: sp.Matrix([list(column(row)) for row in matrix.rows]) for name, matrix in matrices.items()}
    values[Vdot] = values[udot] - values[Omegadot].cross(values[rho]) - values[Omega].cross(values[rhodot])
    return Proof(values)


def _proof_in_time() -> Proof:
    """Return the proof of what is differentiated: all vectors are functions of the time."""

    def moving(name: str) -> Vector:
        return Vector(*(sp.Function(f"{name}_{axis}", real=True)(TIME) for axis in "xyz"))

    def rate(v: Vector) -> Vector:
        return Vector(*(part.diff(TIME) for part in v))

    X, spin, place, arm, turning = map(moving, ("X", "omega", "p", "rho", "Omega"))
    state = SupportState(Matrix.identity(), X, rate(X), rate(rate(X)), spin, rate(spin))
    contact = Contact(state, place, E_Z, arm, Matrix.zero(), Matrix.zero())
    velocity = contact.rolling_velocity(turning)
    columns = {V: velocity, Vdot: rate(velocity), rho: arm, rhodot: rate(arm), Omega: turning, Omegadot: rate(turning)}
    columns |= {u: state.material_velocity(place), udot: state.material_acceleration(place, rate(place))}
    return Proof({name: column(v) for name, v in columns.items()})


def derive_system(system: RollingSystem) -> Iterator[Step]:
    """Yield the steps for any system, and what is special to this one.

    Examples
    --------
    >>> import trundle as tr
    >>> steps = derive_system(tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())))
    >>> next(steps).title
    "Newton's law"
    """
    yield from law_steps()
    yield from special_steps(system)


@cache
def law_steps() -> tuple[Step, ...]:
    """Return the steps that are the same for every system.

    Examples
    --------
    >>> law_steps()[-1].title
    'The reaction'
    """
    proof, wandering, moving = proof_of_any(), proof_of_any(curved=True), _proof_in_time()
    gyroscopic = Cross(Omega, Times(J, Omega))
    rolling = proof.equation(V, total(u, times(-1, Cross(Omega, rho))))
    rate = total(udot, times(-1, Cross(Omegadot, rho)), times(-1, Cross(Omega, rhodot)))
    across = Times(C, Cross(total(turn, times(-1, Omega)), n))
    known = total(udot, times(-1, Cross(Omega, rhodot)))
    inertia = total(Times(J, Omegadot), times(m * Dot(rho, rho), Omegadot), times(-m * Dot(rho, Omegadot), rho))
    moment = total(K, times(-1, gyroscopic), times(-1, Cross(rho, F)), times(m, Cross(rho, known)))
    return (
        Step(
            "Newton's law",
            "Of the centre of mass, under the applied force {F} and the contact force {R}.",
            (proof.equation(times(m, Vdot), total(F, R)),),
            {"F": F, "R": R},
        ),
        Step(
            "Euler's law",
            "About the centre of mass; {J} is the inertia tensor in space, and {R} acts at the contact, {rho} from it.",
            (proof.equation(total(Times(J, Omegadot), gyroscopic), total(K, Cross(rho, R))),),
            {"J": J, "R": R, "rho": rho},
        ),
        Step(
            "The rolling condition",
            "The body's point at the contact moves as the support's point there, with the velocity {u}.",
            (rolling,),
            {"u": u},
        ),
        Step(
            "Where the contact goes",
            "It runs over the support with the velocity {w}; {C} is the inverse curvature of the body there, {S} the "
            "shape operator of the support, {omega} the support's angular velocity.",
            (
                wandering.equation(total(w, Times(C, Times(S, w))), times(-1, across)),
                wandering.equation(pdot, total(u, w)),
                wandering.equation(rhodot, total(pdot, times(-1, V))),
            ),
            {"w": w, "C": C, "S": S, "omega": turn},
        ),
        Step(
            "The rolling condition, differentiated",
            "With {u} followed along the contact:",
            (moving.equation(Vdot, rate),),
            {"u": udot},
        ),
        Step(
            "Elimination of the reaction and of the acceleration",
            "Newton's law gives {R}; put it into Euler's, with the acceleration from the rolling condition, and "
            "collect what contains {Omegadot}. One linear equation is left:",
            (proof.equation(inertia, moment),),
            {"R": R, "Omegadot": Omegadot},
        ),
        Step(
            "The reaction",
            "And with its solution, the force that the support must supply:",
            (proof.equation(R, total(*(times(m, term) for term in rate.args), times(-1, F))),),
        ),
    )
