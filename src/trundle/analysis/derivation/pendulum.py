"""From the equation of the pendulum to Jacobi's functions: its integral, its three motions, the closed form T6."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import FunctionType
from typing import TYPE_CHECKING, Any

import sympy as sp

from ...solve.exact import cylinder_on_cylinder as numerical
from .jacobi import cn, dn, sn
from .law import column
from .steps import Proof, Step
from .symbols import (
    TIME,
    F,
    I,
    Omega,
    Omegadot,
    R,
    V,
    Vdot,
    a,
    b,
    e_x,
    e_z,
    ell,
    k,
    lam,
    lam_0,
    m,
    n,
    omega,
    p,
    par,
    r,
    rdot,
    theta,
    thetadot,
)
from .vectors import Cross, times, total

if TYPE_CHECKING:
    from .cylinder_on_cylinder import Setting

SINE, RATE = sp.symbols("s_0 w_0", real=True)  # sin(θ₀/2), and θ̇₀/(2λ) with the sign of the sense taken out
COSINE, SENSE = sp.symbols("c_0 sigma", real=True)


@dataclass(frozen=True)
class Case:
    """One of the three motions of a pendulum.

    Examples
    --------
    >>> CASES[0].name
    'It swings'
    """

    name: str  # what it does
    # `rotates`, `parameter`, `complement`, `pendulum`: as the closed form's own constants
    rotates: int
    parameter: Any
    complement: Any
    pendulum: Any
    squares: Mapping[Any, Any]  # what joins the symbols of the start
    period: float = 1.0


_SWINGING = SINE**2 + RATE**2  # m = sin²(θ₀/2) + (θ̇₀/2λ)², the square of the sine of half the greatest angle
CASES = (
    Case("It swings", 0, _SWINGING, 1 - _SWINGING, lam**2, {COSINE: 1 - SINE**2, SENSE: sp.Integer(1)}),
    Case(
        "It goes round",
        1,
        par,
        1 - par,
        par * lam**2,
        {COSINE: 1 - SINE**2, RATE: 1 - par * SINE**2, SENSE: sp.Integer(1)},
    ),
    Case(
        "It comes to rest at the top",
        0,
        sp.Integer(1),
        sp.Integer(0),
        lam**2,
        {COSINE: 1 - SINE**2, RATE: 1 - SINE**2, SENSE: sp.Integer(1)},
        math.inf,
    ),
)


def _elliptic(u: Any, complement: Any) -> tuple[Any, Any, Any]:
    """Return sn, cn and dn as functions of symbols, in the place of the numerical ones."""
    parameter = sp.expand(1 - complement)
    return sn(u, parameter), cn(u, parameter), dn(u, parameter)


class SymbolicForm(numerical.CylinderOnCylinder):
    """The closed form T6 on symbols: its own code, with Jacobi's functions of SymPy for those of numbers.

    Examples
    --------
    >>> SymbolicForm.__mro__[1].__name__
    'CylinderOnCylinder'
    """

    _jacobi = FunctionType(numerical.CylinderOnCylinder._jacobi.__code__, {**vars(numerical), "elliptic": _elliptic})

    @classmethod
    def of_case(cls, setting: Setting, case: Case, *, from_below: bool = False) -> SymbolicForm:
        """Return the motion of a case from a general start, or from the lowest line at t = 0."""
        pull = m * case.pendulum * (1 + k) * (b + setting.side * a)
        rate = omega if setting.turning else sp.Integer(0)
        unused = sp.Integer(0)
        form = cls(a, m, k, b, sp.Integer(setting.side), rate, unused, unused, unused, (pull, unused))
        start = (SENSE, SINE, COSINE, RATE)
        if from_below:
            start = tuple(map(sp.Integer, (1, 0, 1, 1)))
            start = (
                *start[:3],
                sp.Integer(1) if case.rotates else sp.sqrt(par) if case.period < math.inf else start[3],
            )
        sense, sine, cosine, sn_rate = start
        at_start = {SINE: sine, RATE: sn_rate} if from_below else {}
        vars(form)["_constants"] = numerical._Constants(
            rotates=case.rotates,
            sense=sense,
            complement=sp.expand(sp.sympify(case.complement).xreplace(at_start)),
            parameter=sp.expand(sp.sympify(case.parameter).xreplace(at_start)),
            scale=lam,
            argument=sp.Integer(1),
            phase_rate=lam,
            phase_rate_rest=0.0,
            period=case.period,
            sine=sine,
            cosine=cosine,
            sn_rate=sn_rate,
            pendulum=case.pendulum,
            pull_x=sp.Integer(1),
            pull_y=sp.Integer(0),
        )
        return form


def pendulum_steps(s: Setting, proof: Proof) -> Iterator[Step]:
    """Yield the steps from the equation of the pendulum to its motions.

    Examples
    --------
    >>> from trundle.analysis.derivation.cylinder_on_cylinder import Setting, proof_of
    >>> next(pendulum_steps(Setting(), proof_of(Setting()))).title
    'Its integral'
    """
    yield _integral(s, proof)
    for case in CASES:
        yield _from_below(s, case)
    for case in CASES:
        yield _closed_form(s, case)


def _integral(s: Setting, proof: Proof) -> Step:
    from .symbols import thetaddot

    half = sp.sin(theta / 2)
    energy = sp.Symbol("E_0", real=True)
    cosine = sp.cos(theta / 2)
    kept = proof.at({sp.sin(theta): 2 * half * cosine, sp.cos(theta): 1 - 2 * half**2}).constant(
        total((thetadot / 2) ** 2, lam_0**2 * half**2), energy, {theta: thetadot, thetadot: thetaddot}
    )
    pace = proof.equation(lam_0**2, s.pull / (m * (1 + k) * ell))
    sentence = (
        "Times {rate}, it integrates to the energy, here of a point on the half angle. Below {top} it swings, above "
        "it goes round, between the two lies the separatrix."
    )
    return Step("Its integral", sentence, (kept, pace), {"rate": thetadot, "top": sp.Eq(energy, lam_0**2)})


def _from_below(s: Setting, case: Case) -> Step:
    form = SymbolicForm.of_case(s, case, from_below=True)
    sine, cosine, rate = form._halves(TIME)
    values = {sp.sin(theta / 2): sine, sp.cos(theta / 2): cosine, thetadot: 2 * rate}
    values = {name: sp.sympify(value) for name, value in values.items()}
    proof = Proof(values)
    u = lam * TIME
    if case.period == math.inf:
        shown = (sp.tanh(u), 1 / sp.cosh(u), 2 * lam / sp.cosh(u))
        about = "{pace}; it climbs for ever."
        pace: Any = sp.Eq(lam, lam_0)
    elif case.rotates:
        shown = (sn(u, par), cn(u, par), 2 * lam * dn(u, par))
        about = "{pace}: the energy sets the pace, and {m} is how much of it the top takes."
        pace = sp.Eq(lam**2, lam_0**2 / par, evaluate=False)
    else:
        shown = (sp.sqrt(par) * sn(u, par), dn(u, par), 2 * lam * sp.sqrt(par) * cn(u, par))
        about = "{pace}, and the root of {m} is the sine of half the greatest angle."
        pace = sp.Eq(lam, lam_0)
    rows = [proof.equation(name, value) for name, value in zip(values, shown, strict=True)]
    # The equation of the pendulum itself: d/dt of θ̇ as shown, and sin θ = 2 sin(θ/2) cos(θ/2).
    acceleration = sp.Symbol("thetaddot", real=True)
    moving = Proof({**values, acceleration: shown[2].diff(TIME)})
    half = 2 * sp.Mul(sp.sin(theta / 2), sp.cos(theta / 2), evaluate=False)
    rows.append(moving.equation(acceleration, -case.pendulum.xreplace({par: par}) * half))
    sentence = "From the lowest line at {t}, with " + about
    return Step(case.name, sentence, tuple(rows), {"t": sp.Eq(TIME, 0), "pace": pace, "m": par})


def _closed_form(s: Setting, case: Case) -> Step:
    form = SymbolicForm.of_case(s, case)
    position, velocity, turning, force = (column(v) for v in form.motion_at(TIME))
    length = b + s.side * a
    normal = s.side * position / length
    values = {r: position, V: velocity, Omega: turning, R: force, n: normal, p: position - a * normal}
    values |= {rdot: position.diff(TIME), Vdot: velocity.diff(TIME), Omegadot: turning.diff(TIME)}
    values |= {F: sp.Matrix([form.force[0], 0, 0]), I: k * m * a**2, e_z: sp.Matrix([0, 0, 1])}
    values[e_x] = sp.Matrix([1, 0, 0])
    proof = Proof(values, case.squares)
    moved = times(omega, Cross(e_z, p)) if s.turning else sp.ZeroMatrix(3, 1)
    rows = (
        proof.equation(rdot, V),
        proof.equation(times(m, Vdot), total(F, R)),
        proof.equation(times(I, Omegadot), times(-a, Cross(n, R))),
        proof.equation(total(V, times(-a, Cross(Omega, n))), moved),
    )
    sentence = (
        "The closed form that trundle evaluates (T6), from any start and by the addition theorems, is put into the "
        "laws where they began. Each difference of two sides is exactly 0, by the identities "
        "of Jacobi's functions, {first} and {second}."
    )
    u = lam * TIME
    words = {
        "first": sp.Eq(total(sn(u, par) ** 2, cn(u, par) ** 2), 1, evaluate=False),
        "second": sp.Eq(total(dn(u, par) ** 2, par * sn(u, par) ** 2), 1, evaluate=False),
    }
    if case.period == math.inf:
        sentence = "The same on the separatrix, where the functions are hyperbolic."
    elif case.rotates:
        sentence = "The same where it goes round."
    return Step(f"The closed form is a solution: {case.name[0].lower()}{case.name[1:]}", sentence, rows, words)
