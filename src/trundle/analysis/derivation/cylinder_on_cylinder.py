"""The derivation of the closed form T6: a cylinder or ball rolling inside or outside a cylinder, across its axis."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from ...mechanics.algebra import Vector
from ...mechanics.bodies import Body
from ...mechanics.loads import Force, constant_part
from ...mechanics.motions import Fixed, Spin
from ...mechanics.scalars import is_zero
from ...mechanics.surfaces import Cylinder
from ...mechanics.system import RollingSystem, Support
from .law import at_one_instant
from .pendulum import pendulum_steps
from .ratios import named_ratio
from .steps import Number, Proof, Step
from .symbols import (
    OMEGA_XYZ,
    OMEGADOT_XYZ,
    TIME,
    G,
    I,
    N,
    Omega,
    Omegadot,
    R,
    R_theta,
    V,
    Vdot,
    a,
    b,
    e_r,
    e_theta,
    e_x,
    e_z,
    ell,
    g,
    k,
    lam_0,
    m,
    n,
    omega,
    p,
    period,
    phi,
    theta,
    theta_0,
    thetaddot,
    thetadot,
    thetadot_0,
    x,
    y,
)
from .vectors import Cross, times, total

Omega_z, Omegadot_z = OMEGA_XYZ[2], OMEGADOT_XYZ[2]


@dataclass(frozen=True)
class Setting:
    """What of the things that T6 covers is there.

    Examples
    --------
    >>> Setting().side, Setting().pull
    (-1, g*m)
    """

    inside: bool = True
    turning: bool = False
    weight_alone: bool = True  # else the pull has other parts, or another direction, and is called G
    inertia_ratio: Any = 0.5

    @classmethod
    def of(cls, system: RollingSystem) -> Setting:
        """Read off a system what is there."""
        surface: Any = system.support.surface
        force, _, _ = constant_part(system.all_loads, system.body.mass)
        weight = system.body.mass * system.gravity
        return cls(
            inside=surface.sign < 0,
            turning=not is_zero(system.support.motion.steady_rate),
            weight_alone=all(map(is_zero, constant_part(system.loads, system.body.mass)[0]))
            and abs(force.x - weight) <= 1e-12 * weight,
            inertia_ratio=system.body.inertia_ratio,
        )

    @property
    def side(self) -> int:
        """+1 outside, −1 inside."""
        return -1 if self.inside else 1

    @property
    def length(self) -> Any:
        """ℓ, of the centre from the axis."""
        return total(b, self.side * a)

    @property
    def pull(self) -> Any:
        """The force along the first axis."""
        return m * g if self.weight_alone else G

    @cached_property
    def system(self) -> RollingSystem:
        """The system with symbols for its numbers."""
        support = Support(
            Cylinder(b, "inside" if self.inside else "outside"),
            Spin(omega) if self.turning else Fixed(),
            tilt=sp.pi / 2 if self.weight_alone else 0.0,
        )
        loads = () if self.weight_alone else (Force((G, sp.Integer(0), sp.Integer(0))),)
        return RollingSystem(Body.sphere(a, m, k), support, loads, g if self.weight_alone else 0.0)


def proof_of(s: Setting) -> Proof:
    """Return the proof by the rolling law, for a body that rolls across the axis at the angle θ with the rate θ̇.

    Examples
    --------
    >>> proof_of(Setting()).values[n].T
    Matrix([[-cos(theta), -sin(theta), 0]])
    """
    cosine, sine = sp.cos(theta), sp.sin(theta)
    length = b + s.side * a
    turning = s.side * (length * thetadot - (b * omega if s.turning else 0)) / a
    here = {x: b * cosine, y: b * sine, OMEGA_XYZ[0]: sp.Integer(0), OMEGA_XYZ[1]: sp.Integer(0), Omega_z: turning}
    values = at_one_instant(s.system, Vector(x, y, sp.Integer(0)), here)
    out, around = sp.Matrix([cosine, sine, 0]), sp.Matrix([-sine, cosine, 0])
    values |= {e_r: out, e_theta: around, e_x: sp.Matrix([1, 0, 0]), e_z: sp.Matrix([0, 0, 1])}
    values |= {I: k * m * a**2, ell: length, Omega_z: turning, Omegadot_z: values[Omegadot][2]}
    values |= {thetaddot: s.side * a * values[Omegadot][2] / length}
    values |= {N: values[R].dot(values[n]), R_theta: values[R].dot(around)}
    values[lam_0] = sp.sqrt(s.pull / (m * (1 + k) * length))
    return Proof(values)


def derive_system(s: Setting) -> Iterator[Step]:
    """Yield the steps for a body on a cylinder.

    Examples
    --------
    >>> next(derive_system(Setting())).title
    "Newton's law"
    """
    proof = proof_of(s)
    yield from _laws(s, proof)
    yield from _rolling(s, proof)
    yield from _elimination(s, proof)
    yield from pendulum_steps(s, proof)


def _laws(s: Setting, proof: Proof) -> Iterator[Step]:
    pull = times(s.pull, e_x)
    sentence = "Mass times the acceleration of the centre is the force of the track, {R}, and " + (
        "the weight, along the first axis: straight down." if s.weight_alone else "the pull {G} along the first axis."
    )
    yield Step("Newton's law", sentence, (proof.equation(times(m, Vdot), total(R, pull)),), {"R": R, "G": G})
    rows = (proof.equation(times(I, Omegadot), times(-a, Cross(n, R))), proof.equation(I, k * m * a**2))
    sentence = "The reaction acts at the contact, {arm} from the centre; nothing else has a moment about the centre."
    yield Step("Euler's law", sentence, rows, {"arm": times(-a, n)})


def _rolling(s: Setting, proof: Proof) -> Iterator[Step]:
    moved = times(omega, Cross(e_z, p)) if s.turning else sp.ZeroMatrix(3, 1)
    rows = [proof.equation(total(V, times(-a, Cross(Omega, n))), moved)]
    rows.append(proof.equation(V, times(ell * thetadot, e_theta)))
    rows.append(proof.equation(ell, s.length))
    track = total(b * omega if s.turning else 0, s.side * a * Omega_z)
    rows.append(proof.equation(ell * thetadot, track))
    sentence = "The point of the body at the contact moves " + (
        "as the wall there does. " if s.turning else "not at all. "
    )
    sentence += "The centre goes round the axis of the track at the distance {ell}, and {n} is {out}."
    yield Step("The rolling condition", sentence, tuple(rows), {"ell": ell, "n": n, "out": times(s.side, e_r)})
    left = ell * theta
    right = total(b * omega * TIME if s.turning else 0, s.side * a * phi)
    integral = proof.constant(left, right, {theta: thetadot, TIME: 1, phi: Omega_z})
    sentence = (
        "Unlike a ball's on a plane, this condition can be integrated: counted from where they are "
        "zero together, the angles give each other, and the orientation follows from the position alone."
    )
    yield Step("The rolling condition, integrated", sentence, (integral,))
    rates = proof.equation(ell * thetaddot, s.side * a * Omegadot_z)
    sentence = "Differentiated instead, it joins the accelerations; {omega} is constant and drops out."
    plain = "Differentiated instead, it joins the accelerations."
    yield Step("The rolling condition, differentiated", sentence if s.turning else plain, (rates,), {"omega": omega})


def _elimination(s: Setting, proof: Proof) -> Iterator[Step]:
    cosine, sine, pull = sp.cos(theta), sp.sin(theta), s.pull
    along = proof.equation(m * ell * thetaddot, total(R_theta, -pull * sine))
    across = proof.equation(-m * ell * thetadot**2, total(s.side * N, pull * cosine))
    turned = proof.equation(I * Omegadot_z, -s.side * a * R_theta)
    sentence = "Newton's law along the track and across it, and Euler's about the axis:"
    yield Step("By components", sentence, (along, across, turned))
    dragged = proof.equation(R_theta, -I * ell * thetaddot / a**2)
    path = proof.equation((1 + k) * ell * thetaddot, -pull * sine / m)
    sentence = "Euler's law and the rolling condition give {R}; put it into Newton's, with {I}. It is a pendulum."
    yield Step(
        "Elimination: the equation of the path", sentence, (dragged, path), {"R": R_theta, "I": sp.Eq(I, k * m * a**2)}
    )
    needed = proof.equation(R_theta, k / (1 + k) * pull * sine)
    pressed = proof.equation(N, total(-s.side * m * ell * thetadot**2, -s.side * pull * cosine))
    sentence = "Put back, they give what rolling takes along the track, and the force that presses; it must not "
    sentence += "become negative."
    yield Step("The reaction", sentence, (needed, pressed))
    named = named_ratio(s.inertia_ratio)
    if named is not None:
        ratio, name = named
        here = proof.at({k: ratio})
        rows = (
            here.equation(thetaddot, -pull * sine / (m * (1 + ratio) * ell)),
            here.equation(R_theta, ratio / (1 + ratio) * pull * sine),
        )
        yield Step(f"A {name}", f"For a {name}" + " {k}:", rows, {"k": sp.Eq(k, ratio, evaluate=False)})


def numbers_of(motion: Any, system: RollingSystem) -> Iterator[Number]:
    """Yield the constants of the closed form in numbers.

    Examples
    --------
    >>> import trundle as tr
    >>> trough = tr.Support(tr.Cylinder("50 cm"), tilt="90 deg")
    >>> system = tr.RollingSystem(tr.Body.cylinder("5 cm", "1 kg"), trough)
    >>> from trundle.solve.exact import CylinderOnCylinder
    >>> form = CylinderOnCylinder.of(system, system.place(("60 deg", 0.0)))
    >>> [str(number.symbol) for number in numbers_of(form, system)][-1]
    'T'
    """
    size = (motion.force[0] ** 2 + motion.force[1] ** 2) ** 0.5
    given = [(m, motion.mass, "kg"), (a, motion.radius, "m"), (k, motion.inertia_ratio, "")]
    given += [(b, motion.track_radius, "m"), (ell, motion.length, "m"), (g, system.gravity, "m/s²")]
    given += [(G, size, "N"), (omega, motion.rate, "rad/s"), (theta_0, motion.angle, "rad")]
    given.append((thetadot_0, motion.angular_rate, "rad/s"))
    given.append((lam_0, (size / (motion.mass * (1 + motion.inertia_ratio) * motion.length)) ** 0.5, "1/s"))
    given.append((period, motion.period, "s"))
    for symbol, value, unit in given:
        if value != 0 and math.isfinite(value):
            yield Number(symbol, float(value), unit)
