"""The derivation of the closed form T5: a sphere on a plane, in the order of the lecture (Milne, Landau)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp

from ...mechanics.system import RollingSystem
from .ratios import named_ratio
from .sphere_path import path_steps
from .sphere_setting import Setting, along, constants_of, proof_of
from .steps import Number, Proof, Step
from .symbols import (
    R_XYZ,
    V_XY,
    VDOT_XY,
    F,
    I,
    K,
    Omega,
    Omegadot,
    R,
    V,
    Vdot,
    Z,
    a,
    alpha,
    c,
    e_x,
    g,
    gamma,
    k,
    kappa,
    m,
    n,
    omega,
    r,
    v_d,
    varphi,
    varrho,
    x,
    y,
    zeta,
    zetaddot,
    zetadot,
)
from .vectors import Cross, Dot, times, total


def derive_system(setting: Setting) -> Iterator[Step]:
    """Yield the steps for a sphere on a plane.

    Examples
    --------
    >>> next(derive_system(Setting())).title
    "Newton's law"
    """
    proof = proof_of(setting)
    yield _newton(setting, proof)
    yield _euler(setting, proof)
    yield from _rolling(setting, proof)
    yield _without_reaction(setting, proof)
    yield _without_turning(setting, proof)
    yield _accelerations(setting, proof)
    yield _reaction(setting, proof)
    yield from _named_body(setting, proof)
    yield _one_equation(setting, proof)
    yield from path_steps(setting, proof)


def numbers_of(motion: Any, system: RollingSystem) -> Iterator[Number]:
    """Yield the constants of the closed form in numbers.

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), tr.Support(tr.Plane(), tr.Spin(3.5)))
    >>> [round(n.value, 6) for n in numbers_of(tr.solve.exact.SphereOnPlane.of(ball, ball.place()), ball)][:4]
    [0.065, 0.025, 0.4, 9.80665]
    """
    given = [(m, motion.mass, "kg"), (a, motion.radius, "m"), (k, motion.inertia_ratio, "")]
    given += [(g, system.gravity, "m/s²"), (alpha, system.support.tilt, "rad"), (omega, motion.rate, "rad/s")]
    given += [(c, motion.drag, "kg/s"), (kappa, motion.kappa, "rad/s"), (gamma, motion.gamma, "1/s")]
    given.append((varphi, complex(motion.phi.re, motion.phi.im), "m/s²"))
    if motion.has_guiding_centre:
        given += [(v_d, complex(*motion.drift_velocity), "m/s"), (varrho, motion.circle_radius, "m")]
    for symbol, value, unit in given:
        if value != 0:
            yield Number(symbol, value if isinstance(value, complex) else float(value), unit)


def _newton(s: Setting, proof: Proof) -> Step:
    equations = [proof.equation(times(m, Vdot), total(R, *s.applied))]
    sentence = f"Mass times the acceleration of the centre is the force of the plane on the {s.noun}, " + "{R}"
    parts = []
    if s.weight:
        parts.append("its weight")
    if any(s.force):
        parts.append("the applied force {F}")
    if s.drag:
        parts.append("the drag of still air")
    if len(parts) > 1:
        parts = [", ".join(parts[:-1]), parts[-1]]
    sentence += (", and " if len(parts) == 1 else ", ") + " and ".join(parts) + "." if parts else "."
    if s.tilted:
        sentence += " The vertical {up} leans from the normal {n}; the first axis points down the slope."
        equations.append(proof.equation(Z, sp.Matrix([-sp.sin(alpha), 0, sp.cos(alpha)])))
    return Step("Newton's law", sentence, tuple(equations), {"R": R, "F": F, "up": s.up, "n": n})


def _euler(s: Setting, proof: Proof) -> Step:
    turning = total(K if any(s.torque) else 0, times(-a, Cross(n, R)))
    sentence = "The reaction acts at the contact, {arm} from the centre" + (
        "; {K} is the applied torque." if any(s.torque) else "; nothing else has a moment about the centre."
    )
    moment = proof.equation(I, k * m * a**2)
    return Step(
        "Euler's law", sentence, (proof.equation(times(I, Omegadot), turning), moment), {"arm": times(-a, n), "K": K}
    )


def _rolling(s: Setting, proof: Proof) -> Iterator[Step]:
    moved = times(omega, Cross(n, r)) if s.turning else sp.ZeroMatrix(3, 1)
    sentence = f"The point of the {s.noun} at the contact moves " + (
        "as the plane under it does." if s.turning else "not at all."
    )
    yield Step("The rolling condition", sentence, (proof.equation(total(V, times(-a, Cross(Omega, n))), moved),))
    moved = times(omega, Cross(n, V)) if s.turning else sp.ZeroMatrix(3, 1)
    first = "It can be integrated, as the path will show; here it is differentiated"
    sentence = (
        (first if s.straight else "It cannot be integrated, but it can be differentiated")
        + ": {n} is constant"
        + (", and so is {omega}." if s.turning else ".")
    )
    equation = proof.equation(total(Vdot, times(-a, Cross(Omegadot, n))), moved)
    yield Step("The rolling condition, differentiated", sentence, (equation,), {"n": n, "omega": omega})


def _in_plane(s: Setting) -> tuple[Any, ...]:
    """Return the applied forces that have a moment about the contact's normal line: those not along it."""
    return tuple(term for term in s.applied if s.tilted or term != times(-m * g, n))


def _without_reaction(s: Setting, proof: Proof) -> Step:
    less = total(times(m, Vdot), *(times(-1, term) for term in _in_plane(s)))
    right = total(K if any(s.torque) else 0, times(a, Cross(less, n)) if _in_plane(s) else times(a * m, Cross(Vdot, n)))
    sentence = "Newton's law gives {R}; put it into Euler's" + (
        ". What points along the normal has no moment." if s.weight and not s.tilted else "."
    )
    return Step("Elimination of the reaction", sentence, (proof.equation(times(I, Omegadot), right),), {"R": R})


def _without_turning(s: Setting, proof: Proof) -> Step:
    equations = []
    tangential: list[tuple[Any, Any]] = [(m * g * sp.sin(alpha), e_x)] if s.tilted else []
    if any(s.force):
        tangential += [(1, F), (-Dot(n, F), n)] if s.force[2] else [(1, F)]
    if s.drag:
        tangential.append((-c, V))
    driven = [Cross(K, n)] if any(s.torque[:2]) else []
    across = total(*driven, *(times(a * size, v) for size, v in tangential), times(-a * m, Vdot))
    equations.append(proof.equation(times(I, Cross(Omegadot, n)), across))
    push = [times(a**2 / I * size, v) for size, v in tangential] + [times(a / I, v) for v in driven]
    moved = [times(omega, Cross(n, V))] if s.turning else []
    right = total(*moved, *push) if moved or push else sp.ZeroMatrix(3, 1)
    equations.append(proof.equation(times(1 + m * a**2 / I, Vdot), right))
    sentence = (
        "Take this times {n} from the right; the rolling condition turns {turned} into accelerations of the centre."
    )
    return Step(
        "Elimination of the angular velocity", sentence, tuple(equations), {"n": n, "turned": Cross(Omegadot, n)}
    )


def _accelerations(s: Setting, proof: Proof) -> Step:
    share = 1 / (m * (1 + k))
    rows = []
    for axis in (0, 1):
        push = total(*along(s, axis))
        rows.append(
            proof.equation(
                VDOT_XY[axis],
                total(
                    share * push if push != 0 else 0,
                    (-1, 1)[axis] * omega * k / (1 + k) * V_XY[1 - axis] if s.turning else 0,
                    -c * share * V_XY[axis] if s.drag else 0,
                ),
            )
        )
    return Step("The acceleration", "With {I}, by components in the plane:", tuple(rows), {"I": sp.Eq(I, k * m * a**2)})


def _reaction(s: Setting, proof: Proof) -> Step:
    (kx, ky, _), rows = s.torque_xyz, []
    slope = (m * g * sp.sin(alpha) if s.tilted else 0, 0)
    for axis in (0, 1):
        against = total(s.force_xyz[axis], slope[axis])
        rows.append(
            proof.equation(
                R_XYZ[axis],
                total(
                    (ky / a, -kx / a)[axis] / (1 + k),
                    -k / (1 + k) * against,
                    (-1, 1)[axis] * m * omega * k / (1 + k) * V_XY[1 - axis] if s.turning else 0,
                    c * k / (1 + k) * V_XY[axis] if s.drag else 0,
                ),
            )
        )
    lifted = (g * m * sp.cos(alpha) if s.tilted else g * m) if s.weight else sp.Integer(0)
    rows.append(proof.equation(R_XYZ[2], total(lifted, -s.force_xyz[2])))
    sentence = "Put back into Newton's law, the acceleration gives the force that the plane must supply."
    if any(s.torque):
        sentence += " A torque about the normal does not appear: it only spins the body about its contact."
    return Step("The reaction", sentence, tuple(rows))


def _named_body(s: Setting, proof: Proof) -> Iterator[Step]:
    named = named_ratio(s.inertia_ratio)
    if named is None:
        return
    ratio, name = named
    solid = proof.at({k: ratio})
    rows = []
    for left, equation in zip(
        (*VDOT_XY, *R_XYZ[:2]), (*_accelerations(s, proof).equations, *_reaction(s, proof).equations[:2]), strict=True
    ):
        terms = sp.Add.make_args(equation.formula.rhs)
        rows.append(solid.equation(left, total(*(term.subs(k, ratio) for term in terms))))
    yield Step(f"A {name}", f"For a {name}" + " {k}:", tuple(rows), {"k": sp.Eq(k, ratio, evaluate=False)})


def _one_equation(s: Setting, proof: Proof) -> Step:
    constants = constants_of(s)
    factor = total(sp.I * kappa if s.turning else 0, -gamma if s.drag else 0)
    rows = [proof.equation(zetaddot, total(factor * zetadot, varphi if s.pushed else 0))]
    rows += [proof.equation(name, value) for name, value in constants.items() if value != 0]
    sentence = "Write the centre as one complex number, {zeta}, so that a cross product with {n} becomes a factor {i}."
    return Step(
        "The equation of the path",
        sentence,
        tuple(rows),
        {"zeta": sp.Eq(zeta, total(x, sp.I * y), evaluate=False), "n": n, "i": sp.I},
    )
