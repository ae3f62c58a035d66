"""From the equation of the path of a sphere on a plane to the path: its integration, the closed form, the drift."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import sympy as sp

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.loads import BodyMotion
from ...mechanics.system import State
from ...solve.exact import SphereOnPlane
from .law import column
from .steps import Proof, Step
from .symbols import (
    OMEGA_XYZ,
    TIME,
    F,
    I,
    K,
    Omega,
    Omega_z0,
    Omegadot,
    R,
    V,
    Vdot,
    Vx_0,
    Vy_0,
    a,
    alpha,
    c,
    g,
    gamma,
    k,
    kappa,
    lam,
    m,
    n,
    omega,
    phi,
    r,
    rdot,
    v_d,
    v_infinity,
    varphi,
    varrho,
    x,
    x_0,
    y,
    y_0,
    zeta,
    zeta_0,
    zeta_c,
    zetadot,
    zetadot_0,
)
from .vectors import Cross, times, total

if TYPE_CHECKING:
    from .sphere_setting import Setting


# A one-to-one change of symbols that keeps the closed form short: ω and c by κ and γ.
BY_RATES = {omega: kappa * (1 + k) / k, c: gamma * m * (1 + k)}


def closed_form_of(setting: Setting) -> SphereOnPlane:
    """Return the closed form itself, with symbols for its numbers; ω and c are given by κ and γ.

    Examples
    --------
    >>> from trundle.analysis.derivation.sphere_setting import Setting
    >>> closed_form_of(Setting(turning=True)).kappa
    kappa
    """
    zero = sp.Integer(0)
    start = State((x_0, y_0, a), (Vx_0, Vy_0, zero), (zero, zero, Omega_z0))
    return SphereOnPlane.of(setting.system_with(*BY_RATES.values()), start)


def proof_of_path(setting: Setting, proof: Proof) -> Proof:
    """Return a proof along the closed form: each vector is what `motion_at` says, each rate its derivative.

    Examples
    --------
    >>> from trundle.analysis.derivation.sphere_setting import Setting, proof_of
    >>> level = Setting()
    >>> proof_of_path(level, proof_of(level)).values[zeta_0]
    x_0 + I*y_0
    """
    form = closed_form_of(setting)
    position, velocity, turning, force = (column(v) for v in form.motion_at(TIME))
    still = Quaternion(*map(sp.Integer, (1, 0, 0, 0)))  # no load of this form feels how the sphere is turned
    now = BodyMotion(TIME, m, Vector(*position), Vector(*velocity), still, Vector(*turning))
    applied, torque = (column(v) for v in setting.system_with(*BY_RATES.values()).loads_on(now))
    place = column(form.position_at(TIME))
    values = proof.at(BY_RATES).values | {kappa: kappa if setting.turning else 0, gamma: gamma if setting.drag else 0}
    values |= {r: place - sp.Matrix([0, 0, a]), rdot: place.diff(TIME)}
    values |= {V: velocity, Vdot: velocity.diff(TIME), Omega: turning, Omegadot: turning.diff(TIME)}
    values |= {R: force, F: applied, K: torque}
    values |= dict(zip(OMEGA_XYZ, turning, strict=True))
    values |= {zeta: place[0] + sp.I * place[1], zeta_0: x_0 + sp.I * y_0, zetadot_0: Vx_0 + sp.I * Vy_0}
    values |= {zetadot: values[zeta].diff(TIME), lam: sp.I * values[kappa] - values[gamma]}
    if setting.turning and not setting.drag:
        (dx, dy), (cx, cy) = form.drift_velocity, form.guiding_centre(TIME)
        values |= {v_d: dx + sp.I * dy, zeta_c: cx + sp.I * cy, varrho: form.circle_radius}
    return Proof(values, proof.squares)


def path_steps(setting: Setting, proof: Proof) -> Iterator[Step]:
    """Yield the steps from the equation of the path to the path.

    Examples
    --------
    >>> from trundle.analysis.derivation.sphere_setting import Setting, proof_of
    >>> level = Setting()
    >>> [step.title for step in path_steps(level, proof_of(level))][0]
    'Its integral'
    """
    path = proof_of_path(setting, proof)
    if setting.drag:
        yield from _slowed(setting, path)
    elif setting.turning:
        yield from _circling(setting, path)
    else:
        yield from _straight(setting, path)
    if setting.straight and not (setting.drag or setting.turning or any(setting.torque)):
        yield _integrated(setting, path)
    yield _turning(setting, path)
    yield _closed_form(setting, path)


def _straight(s: Setting, path: Proof) -> Iterator[Step]:
    if s.pushed:
        once = path.equation(zetadot, total(zetadot_0, varphi * TIME))
        twice = path.equation(zeta, total(zeta_0, zetadot_0 * TIME, varphi * TIME**2 / 2))
        yield Step("Its integral", "The acceleration is constant:", (once,))
        yield Step("The path", "Once more: a parabola, or from rest a straight line.", (twice,))
    else:
        yield Step("Its integral", "Nothing pushes along the plane:", (path.equation(zetadot, zetadot_0),))
        yield Step("The path", "Once more: a straight line.", (path.equation(zeta, total(zeta_0, zetadot_0 * TIME)),))


def _circling(s: Setting, path: Proof) -> Iterator[Step]:
    drift = v_d if s.pushed else 0
    centre = total(zeta_0, sp.I / kappa * total(zetadot_0, -drift), drift * TIME)
    once = path.equation(zetadot, total(drift, sp.I * kappa * total(zeta, -zeta_c)))
    rows = [path.equation(v_d, sp.I * varphi / kappa)] if s.pushed else []
    sentence = "It integrates to steady circular motion about a point {zeta_c} that the start decides" + (
        ", and that moves at the one velocity, {v_d}, which the equation leaves alone." if s.pushed else "."
    )
    rows += [once, path.equation(zeta_c, centre)]
    yield Step("Its integral", sentence, tuple(rows), {"zeta_c": zeta_c, "v_d": v_d})
    arm = total(zetadot_0, -drift) / (sp.I * kappa) if s.pushed else total(zeta_0, -zeta_c)
    sentence = "Once more, and the path is there: a circle" + (" whose centre drifts." if s.pushed else ".")
    turned = sp.Mul(sp.exp(sp.I * kappa * TIME), arm, evaluate=False)
    yield Step("The path", sentence, (path.equation(zeta, total(zeta_c, turned)),))
    yield _circle(s, path)


def _circle(s: Setting, path: Proof) -> Step:
    cx, cy = sp.symbols("x_c y_c", real=True)
    (ux, uy) = (part if s.pushed else sp.Integer(0) for part in closed_form_of(s).drift_velocity)
    centre = closed_form_of(s).guiding_centre(TIME)
    place = path.values[r]
    here = path.at({x: place[0], y: place[1], cx: centre[0], cy: centre[1]})
    rows = [here.equation((x - cx) ** 2 + (y - cy) ** 2, varrho**2)]
    speed = total((Vx_0 - ux) ** 2, (Vy_0 - uy) ** 2) if not s.pushed else None
    if speed is not None:
        rows.append(here.equation(varrho, sp.sqrt(speed) / sp.Abs(kappa)))
    sentence = "The distance from the centre does not change."
    if s.tilted and not any((*s.force[:2], *s.torque[:2])):
        rows.append(path.equation(v_d, sp.I * g * sp.sin(alpha) / (omega * k)))
        sentence += " The drift is imaginary: it points across the slope, horizontally, and never down it."
    elif s.pushed:
        sentence += " The centre drifts at a right angle to the push."
    else:
        sentence += " It may be any circle: put down at rest, the ball stays where it is."
    return Step("Circle and drift" if s.pushed else "The circle", sentence, tuple(rows))


def _slowed(s: Setting, path: Proof) -> Iterator[Step]:
    rows = [path.equation(lam, total(sp.I * kappa if s.turning else 0, -gamma))]
    rows.append(path.equation(zetadot, total(zetadot_0, lam * total(zeta, -zeta_0), varphi * TIME if s.pushed else 0)))
    yield Step("Its integral", "With {lam} for both factors, it integrates once:", tuple(rows), {"lam": lam})
    growth = sp.exp(lam * TIME)
    free = total(growth, -1) / lam * zetadot_0
    pushed = total(growth, -1, -lam * TIME) / lam**2 * varphi if s.pushed else 0
    yield Step("The path", "Once more, and the path is there.", (path.equation(zeta, total(zeta_0, free, pushed)),))
    if s.pushed:
        end = path.at({v_infinity: -path.values[varphi] / path.values[lam]})
        rest = end.equation(zetadot - v_infinity, growth * total(zetadot_0, -v_infinity))
        rows = [end.equation(v_infinity, -varphi / lam), rest]
        sentence = "What was there at the start dies out at the rate {gamma}, and one velocity is left."
        if s.turning:
            sentence += " Its real part, down the slope, is there only because of the drag."
        yield Step("Where it ends", sentence, tuple(rows), {"gamma": gamma})


def _integrated(s: Setting, path: Proof) -> Step:
    angle = sp.integrate(path.values[OMEGA_XYZ[1]], (TIME, 0, TIME))
    here = path.at({phi: angle, x: path.values[r][0]})
    sentence = (
        "Held to its line, the cylinder turns about {axis} alone, and the rolling condition integrates: counted from "
        "the start, the angle {phi} is given by the position, and so is the orientation."
    )
    rows = (here.equation(total(x, -x_0), a * phi),)
    del s
    return Step("The rolling condition, integrated", sentence, rows, {"axis": OMEGA_XYZ[1], "phi": phi})


def _turning(s: Setting, path: Proof) -> Step:
    moved = omega * zeta if s.turning else 0
    rows = [path.equation(total(OMEGA_XYZ[0], sp.I * OMEGA_XYZ[1]), total(sp.I * zetadot, moved) / a)]
    driven = sp.Symbol("K_z", real=True) * TIME / I if s.torque[2] else 0
    rows.append(path.equation(OMEGA_XYZ[2], total(Omega_z0, driven)))
    sentence = "The rolling condition gives the angular velocity without another integration; about the normal "
    sentence += "the torque alone changes it." if s.torque[2] else "it is constant."
    return Step("The angular velocity", sentence, tuple(rows))


def _closed_form(s: Setting, path: Proof) -> Step:
    moved = omega * Cross(n, r) if s.turning else sp.ZeroMatrix(3, 1)
    rows = (
        path.equation(rdot, V),
        path.equation(m * Vdot, total(F, R)),
        path.equation(I * Omegadot, total(K, times(-a, Cross(n, R)))),
        path.equation(total(V, times(-a, Cross(Omega, n))), moved),
    )
    sentence = (
        "The closed form that trundle evaluates (T5) is put into the laws where they began: its position, velocity, "
        "angular velocity and contact force as functions of {t}, with {F} and {K} all that is applied, weight "
        "and drag included. Each difference of two sides is exactly 0."
    )
    return Step("The closed form is a solution", sentence, rows, {"t": TIME, "F": F, "K": K})
