"""Every equation of every derivation is proved, a planted error is caught, and the lecture's formulas come out."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp
from tests.additions import Tumble
from tests.derivation.derived import derived

import trundle as tr
from trundle.analysis.derivation import DerivationError, derivable, forms, general, law, pendulum
from trundle.analysis.derivation.jacobi import cn, dn, sn
from trundle.analysis.derivation.steps import Derivation, Equation, Proof, Step
from trundle.analysis.derivation.symbols import (
    F_XYZ,
    K_XYZ,
    R_XYZ,
    V_XY,
    VDOT_XY,
    N,
    R_theta,
    a,
    alpha,
    ell,
    g,
    k,
    kappa,
    m,
    omega,
    theta,
    thetaddot,
    thetadot,
    v_d,
)
from trundle.analysis.derivation.topics import TOPICS
from trundle.analysis.derivation.vectors import Cross, vector
from trundle.analysis.derivation.zero import is_zero, numerator
from trundle.errors import InvalidValueError, ScenarioError, UnknownNameError
from trundle.mechanics.algebra import Vector
from trundle.mechanics.contact import Contact
from trundle.mechanics.loads import Drag, Gravity
from trundle.solve.exact import CLOSED_FORMS, sphere_on_plane

# Shipped scenarios that are no topic's setting; the others are `test_every_shipped_scenario_has_its_derivation`'s.
OF_THEIR_OWN = ["cylinder-in-turning-cylinder", "loop-the-loop", "hollow-ball-turntable", "real-demonstration"]


def formulas(derivation: Any, step: str) -> dict[Any, Any]:
    """Return the equations of a step by their left sides."""
    found = [one for one in derivation.steps if one.title == step]
    assert len(found) == 1, [one.title for one in derivation.steps]
    return {equation.formula.lhs: equation.formula.rhs for equation in found[0].equations}


def same(one: Any, other: Any) -> bool:
    return sp.simplify(one - other) == 0  # SymPy's own way to decide it, not ours


@pytest.mark.parametrize("name", [*TOPICS, *OF_THEIR_OWN])
def test_each_residual_is_zero(name: str) -> None:
    derivation = derived(name)
    residuals = [residual for step in derivation.steps for residual in step.residuals]
    assert len(residuals) >= 9
    for residual in residuals:
        parts = list(residual) if hasattr(residual, "shape") else [residual]
        assert all(part == 0 and isinstance(part, sp.Integer) for part in parts)


def test_the_steps_stand_in_the_order_of_the_lecture() -> None:
    titles = [step.title for step in derived("tilted-turntable").steps]
    order = [
        "Newton's law",
        "Euler's law",
        "The rolling condition",
        "The rolling condition, differentiated",
        "Elimination of the reaction",
        "Elimination of the angular velocity",
        "The equation of the path",
        "Its integral",
        "The path",
        "Circle and drift",
        "The closed form is a solution",
    ]
    assert [title for title in titles if title in order] == order


# --- the lecture's own formulas -------------------------------------------------------------------------


def test_landaus_ball_under_force_and_torque() -> None:
    (Fx, Fy, _), (Kx, Ky, _) = F_XYZ, K_XYZ
    found = formulas(derived("ball-on-plane"), "A homogeneous ball")
    fifth, second = sp.Rational(5, 7), sp.Rational(2, 7)
    assert same(found[R_XYZ[0]], fifth * Ky / a - second * Fx)
    assert same(found[R_XYZ[1]], -fifth * Kx / a - second * Fy)
    assert same(found[VDOT_XY[0]], fifth / m * (Fx + Ky / a))
    assert same(found[VDOT_XY[1]], fifth / m * (Fy - Kx / a))


def test_a_torque_about_the_normal_changes_no_reaction() -> None:
    found = formulas(derived("ball-on-plane"), "The reaction")
    assert all(not right.has(K_XYZ[2]) for right in found.values())


def test_milnes_circle_and_his_drift() -> None:
    turning = formulas(derived("turntable"), "A homogeneous ball")
    assert same(turning[VDOT_XY[0]], -sp.Rational(2, 7) * omega * V_XY[1])
    tilted = formulas(derived("tilted-turntable"), "Circle and drift")
    # (m a²/(I ω)) g sin α, across the slope; I = k m a².
    assert same(tilted[v_d], sp.I * g * sp.sin(alpha) / (k * omega))
    assert same(formulas(derived("turntable"), "The equation of the path")[kappa], omega / (1 + 1 / k))


def test_a_cylinder_on_an_incline_gains_two_thirds() -> None:
    found = formulas(derived("cylinder-on-incline"), "A homogeneous cylinder")
    assert same(found[VDOT_XY[0]], sp.Rational(2, 3) * g * sp.sin(alpha))


def test_a_cylinder_in_a_cylinder_is_a_pendulum() -> None:
    path = formulas(derived("cylinder-in-cylinder"), "Elimination: the equation of the path")
    assert same(path[(1 + k) * ell * thetaddot], -g * sp.sin(theta))
    reaction = formulas(derived("cylinder-in-cylinder"), "The reaction")
    assert same(reaction[N], m * ell * thetadot**2 + m * g * sp.cos(theta))
    # The whole force along the track from Newton's law alone: R_θ = m ℓ θ̈ + m g sin θ.
    assert same(reaction[R_theta], m * g * sp.sin(theta) - m * g * sp.sin(theta) / (1 + k))


# --- planted errors -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "method", "topic"),
    [
        (Drag, "force", "ball-with-drag"),
        (Gravity, "force", "ball-on-incline"),
        (tr.Torque, "torque", "ball-on-plane"),
        (Contact, "rolling_velocity", "turntable"),
    ],
)
def test_a_sign_flipped_in_the_mechanics_is_caught(
    monkeypatch: pytest.MonkeyPatch, kind: type, method: str, topic: str
) -> None:
    right: Any = getattr(kind, method)
    monkeypatch.setattr(kind, method, lambda self, *given: right(self, *given) * -1)
    with pytest.raises(DerivationError, match="does not hold"):
        tr.derive(topic)


@pytest.mark.parametrize("part", ["reaction", "angular_acceleration", "velocity"])
def test_a_wrong_contact_law_is_caught(monkeypatch: pytest.MonkeyPatch, part: str) -> None:
    right = law.roll

    def wrong(*given: Any) -> Any:
        now = right(*given)
        return replace(now, **{part: getattr(now, part) * sp.Rational(8, 7)})

    monkeypatch.setattr(law, "roll", wrong)
    for topic in ("turntable", "cylinder-in-cylinder"):
        with pytest.raises(DerivationError):
            tr.derive(topic)


def test_a_wrong_general_law_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    right = general.roll

    def wrong(*given: Any) -> Any:
        now = right(*given)
        return replace(now, angular_acceleration=now.angular_acceleration + Vector(0, 0, TINY))

    TINY = sp.Symbol("tiny")
    monkeypatch.setattr(general, "roll", wrong)
    general.law_steps.cache_clear()
    general.proof_of_any.cache_clear()
    try:
        with pytest.raises(DerivationError):
            tr.derive("rolling-law")
    finally:
        general.law_steps.cache_clear()
        general.proof_of_any.cache_clear()


def test_a_wrong_rate_of_the_circle_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sphere_on_plane, "quotient_times", lambda rate, ratio: (rate * ratio / (2 + ratio), 0.0))
    for topic in ("turntable", "tilted-turntable"):
        with pytest.raises(DerivationError):
            tr.derive(topic)


def test_a_wrong_elliptic_function_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    def wrong(u: Any, complement: Any) -> Any:
        s, c, _ = pendulum._elliptic(u, complement)
        return s, c, c

    with monkeypatch.context() as patch:
        patch.setitem(pendulum.SymbolicForm._jacobi.__globals__, "elliptic", wrong)
        with pytest.raises(DerivationError):
            tr.derive("cylinder-in-cylinder")


def test_a_wrong_equation_makes_no_derivation() -> None:
    x = sp.Symbol("x")
    wrong = Proof({}).equation(x, 2 * x)
    assert not wrong.holds
    with pytest.raises(DerivationError, match="leaves the residual -x"):
        Derivation("wrong", "Wrong", "", (Step("It", "", (wrong,)),))
    with pytest.raises(DerivationError):
        Derivation("wrong", "Wrong", "", (Step("It", "", (Equation(sp.Eq(x, 1), sp.Matrix([0, x, 0])),)),))


# --- every closed form ----------------------------------------------------------------------------------


DERIVED = [
    form for form in CLOSED_FORMS if form.equation in ("T5", "T6")
]  # of the others, the theory page has the steps


@pytest.mark.parametrize("form", DERIVED)
def test_a_closed_form_brings_its_derivation(form: Any) -> None:
    """A closed form of solve/exact/<name>.py has derivation/<name>.py, and a topic that shows it."""
    module = forms.module_of(form)
    assert callable(module.derive_system)
    assert callable(module.numbers_of)
    topics = [name for name, topic in TOPICS.items() if topic.form == module.__name__.rpartition(".")[2]]
    assert topics
    for name in topics:
        assert any("closed form is a solution" in step.title for step in derived(name).steps)


def test_every_shipped_scenario_has_its_derivation() -> None:
    names = [name for name, _ in derivable() if name not in TOPICS]
    assert set(OF_THEIR_OWN) <= set(names)
    for name in names:
        scenario = tr.Scenario.load(name)
        form, module = forms.form_of(scenario.system(), scenario.start_state())
        if form is not None:
            assert module.Setting.of(scenario.system()) is not None


def test_the_setting_is_read_off_the_system() -> None:
    from trundle.analysis.derivation.sphere_setting import Setting

    table = tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.1)
    loads = (tr.Force((0.1, 0, 0)), tr.Drag(0.01), tr.Force((-0.1, 0, 0.2)))
    setting = Setting.of(tr.RollingSystem(tr.Body.hollow_sphere(0.02, 0.003), table, loads))
    assert (setting.turning, setting.tilted, setting.drag, setting.straight) == (True, True, True, False)
    assert setting.force == (False, False, True)  # the first two cancel
    assert setting.torque == (False, False, False)


def test_a_log_under_its_weight_and_a_wind() -> None:
    log = tr.Support(tr.Cylinder(0.5, "outside"), tilt="90 deg")
    wind = tr.Force((0.0, 0.3, 0.0))
    derivation = tr.derive(tr.RollingSystem(tr.Body.hoop(0.1, 0.2), log, (wind,)))
    path = formulas(derivation, "Elimination: the equation of the path")
    assert same(path[(1 + k) * ell * thetaddot], -sp.Symbol("G", positive=True) * sp.sin(theta) / m)
    length = formulas(derivation, "The rolling condition")[ell]
    assert same(length, a + sp.Symbol("b", positive=True))


def test_without_a_closed_form_it_ends_with_the_equations_of_motion() -> None:
    body = tr.Body(0.7, tr.Principal(0.003, 0.004, 0.005), tr.Sphere(0.1))
    ball = tr.RollingSystem(
        body, tr.Support(tr.Cylinder(0.5), motion=Tumble(1.5, 0.2, -0.7, Vector(0.5, 0.1, 0.2), 2.0))
    )
    derivation = tr.derive(ball)
    assert derivation.steps[-1].title == "The reaction"
    assert derivation.steps[-2].title.startswith("Elimination")


def test_a_force_that_varies_stands_in_the_equations_of_motion() -> None:
    pushed = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()), (tr.Force(("0.1*t", 0.0, 0.0)),))
    found = formulas(tr.derive(pushed), "Its equations of motion")
    t, tenth = sp.Symbol("t", real=True), sp.Symbol("0.1", positive=True)
    assert same(
        found[sp.Symbol("Omegadot_y", real=True)].subs(k, sp.Rational(2, 5)), sp.Rational(5, 7) * tenth * t / m / a
    )


# --- Jacobi's functions ---------------------------------------------------------------------------------


@pytest.mark.parametrize("function", [sn, cn, dn])
def test_jacobis_functions_have_the_slopes_of_mpmath(function: Any) -> None:
    name, u, par = function.__name__, sp.Symbol("u"), sp.Symbol("par")

    for at, parameter in ((0.3, 0.2), (1.7, 0.9), (-2.2, 0.5)):
        with mpmath.workdps(30):
            slope = mpmath.diff(lambda v, q=parameter: mpmath.ellipfun(name, v, m=q), at)
            parts = {kind: mpmath.ellipfun(kind, at, m=parameter) for kind in ("sn", "cn", "dn")}
            expression = function(u, par).diff(u)
            numbers = {f: sp.Float(str(parts[f.func.__name__]), 30) for f in expression.atoms(sp.Function)}
            ours = expression.xreplace(numbers).subs(par, sp.Float(str(mpmath.mpf(parameter)), 30))
            assert abs(mpmath.mpf(str(ours)) - slope) < mpmath.mpf(10) ** -18


def test_the_identities_of_jacobis_functions_are_known_and_no_others() -> None:
    u, par = sp.symbols("u par")
    s, c, d = sn(u, par), cn(u, par), dn(u, par)
    assert is_zero(s**2 + c**2 - 1)
    assert is_zero(d**2 + par * s**2 - 1)
    assert is_zero(d**4 - (1 - par * s**2) ** 2)
    assert not is_zero(s**2 + d**2 - 1)
    assert not is_zero(sn(u, par) - sn(2 * u, par))


def test_the_plain_pendulum() -> None:
    """θ = 2 arcsin(√m sn(λt)) obeys θ̈ = −λ² sin θ; so do the others: by the machinery on its own, without a body."""
    t, lam, par = sp.symbols("t lambda mu", positive=True)
    u = lam * t
    for sine, cosine, pull in (
        (sp.sqrt(par) * sn(u, par), dn(u, par), lam**2),
        (sn(u, par), cn(u, par), par * lam**2),
        (sp.tanh(u), 1 / sp.cosh(u), lam**2),
    ):
        rate = 2 * sine.diff(t) / cosine  # d sin(θ/2)/dt = cos(θ/2) θ̇/2
        assert is_zero(sine**2 + cosine**2 - 1)
        assert is_zero(rate.diff(t) + 2 * pull * sine * cosine)
        assert not is_zero(rate.diff(t) + pull * sine * cosine)


def test_swinging_against_mpmaths_integrator() -> None:
    """The step's θ̇ for a swing from the lowest line, put in numbers, against the pendulum solved by Taylor series."""
    lam, par, t = (
        sp.Symbol(name, **kind) for name, kind in (("lambda", {}), ("mu", {"real": True}), ("t", {"real": True}))
    )
    formula = formulas(derived("cylinder-in-cylinder"), "It swings")[thetadot]
    parts = {f: f.func.__name__ for f in formula.atoms(sp.Function)}
    at, pace, parameter = 1.3, 2.0, 0.6
    numbers = {f: float(mpmath.ellipfun(kind, pace * at, m=parameter)) for f, kind in parts.items()}
    ours = float(formula.xreplace(numbers).subs({lam: pace, par: parameter, t: at}))
    start = [mpmath.mpf(0), 2 * pace * mpmath.sqrt(parameter)]
    theirs = mpmath.odefun(lambda _, s: [s[1], -(pace**2) * mpmath.sin(s[0])], 0, start)(at)[1]
    assert abs(ours - float(theirs)) < 1e-12


# --- whether something is zero --------------------------------------------------------------------------


def test_zero_is_decided_and_never_guessed() -> None:
    x, y, t = sp.symbols("x y t", real=True)
    zeros = [
        1 / (x - y) - (x + y) / (x**2 - y**2),
        sp.sin(x) ** 4 - sp.cos(x) ** 4 + 1 - 2 * sp.sin(x) ** 2,
        sp.exp((1 + 2 * sp.I) * t) - sp.exp(t) * (sp.cos(2 * t) + sp.I * sp.sin(2 * t)),
        1 / sp.sqrt(x**2 + y**2) - sp.sqrt(x**2 + y**2) / (x**2 + y**2),
        sp.cosh(x) ** 2 - sp.sinh(x) ** 2 - 1,
        sp.Float(0.5) * x - x / 2,
    ]
    draw = np.random.default_rng(seed=8)
    for expression in zeros:
        value = expression.subs({x: draw.uniform(1, 2), y: draw.uniform(3, 4), t: draw.uniform(0, 1)})
        assert abs(complex(value)) < 1e-9  # it is one
        assert is_zero(expression) == (sp.simplify(expression) == 0)
    for other in (sp.sin(x) ** 2, sp.exp(t) - 1, sp.sqrt(x**2) - x + 1, x / y - y / x, sp.I * x):
        assert not is_zero(other)
    with pytest.raises(ZeroDivisionError):
        numerator(1 / (sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1))


def test_vectors_are_evaluated_as_they_are_written() -> None:
    u, v = vector("u"), vector("v")
    values = {u: sp.Matrix([1, 2, 3]), v: sp.Matrix([4, 5, 6])}
    assert Proof(values).equation(Cross(u, v), sp.ImmutableMatrix([-3, 6, -3])).holds
    assert not Proof(values).equation(Cross(u, v), Cross(v, u)).holds


# --- what is refused ------------------------------------------------------------------------------------


def test_names_that_are_none() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'turntable'"):
        tr.derive("turntabel")
    with pytest.raises(InvalidValueError, match="needs a scenario"):
        tr.derive("ball-on-plane", with_numbers=True)
    with pytest.raises(InvalidValueError, match="needs a closed form"):
        tr.derive("real-demonstration", with_numbers=True)
    with pytest.raises(ScenarioError, match="forces act on"):
        tr.derive("roll-home-turned")


def test_numbers_are_those_of_the_scenario() -> None:
    numbers = {str(n.symbol): n.value for n in tr.derive("tilted-turntable", with_numbers=True).numbers}
    scenario = tr.Scenario.load("tilted-turntable")
    rate, tilt = scenario.system().support.motion.rate, scenario.system().support.tilt
    assert numbers["kappa"] == pytest.approx(2 / 7 * rate, rel=1e-14)
    drift = 9.80665 * np.sin(tilt) / (0.4 * rate)
    assert numbers["v_d"] == pytest.approx(1j * drift, rel=1e-14)
