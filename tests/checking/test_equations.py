"""Equations of motion that somebody wrote down: the right ones pass, and each wrong one is named."""

# ruff: noqa: ARG005  equations take the whole state, and use what they need of it

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import sympy

import trundle as tr

from .test_mistakes import BALL, LOPSIDED, system
from .theirs import Ball, G, replace, turned

W, K = BALL.omega, 2 / 7
PULL = 5 / 7 * G * np.sin(BALL.tilt)


def multipliers(ball: Ball) -> Callable[..., Any]:
    """The equations that the other tests integrate, with a multiplier."""
    return lambda t, r, V, q, Omega: ball.slope(t, np.concatenate([r, V, Omega, q]))[3:9]


def spun(ball: Ball) -> Callable[..., Any]:
    """Ω taken for one along the body's axes."""
    return lambda t, r, V, q, Omega: multipliers(ball)(t, r, V, q, turned(q) @ Omega)


def answered(ball: Ball) -> Callable[..., Any]:
    """Ω̇ given along the body's axes."""

    def equations(t: float, r: Any, V: Any, q: Any, Omega: Any) -> Any:
        rates = multipliers(ball)(t, r, V, q, Omega)
        return rates[:3], turned(q).T @ rates[3:]

    return equations


RIGHT = {
    "by hand": (lambda t, r, V, q, Omega: (PULL - K * W * V[1], K * W * V[0]), BALL),
    "multipliers": (multipliers(BALL), BALL),
    "lopsided": (multipliers(LOPSIDED), LOPSIDED),
}
WRONG = {
    "rate of a shell": (
        lambda t, r, V, q, Omega: (PULL * 0.84 - 0.4 * W * V[1], 0.4 * W * V[0]),
        "wrong-inertia-ratio",
    ),
    "sign": (lambda t, r, V, q, Omega: (PULL + K * W * V[1], -K * W * V[0]), "sign-of-table-rate"),
    "no tilt": (lambda t, r, V, q, Omega: (-K * W * V[1], K * W * V[0]), "tilt-left-out"),
    "no factor": (lambda t, r, V, q, Omega: (1.4 * PULL - K * W * V[1], K * W * V[0]), "rolling-factor"),
    "no u rate": (multipliers(replace(BALL, carried=False)), "missing-carrying-term"),
}
WRONG_LOPSIDED = {
    "no gyroscopic term": (multipliers(replace(LOPSIDED, gyroscopic=False)), "missing-gyroscopic-term"),
    "body axes in": (spun(LOPSIDED), "body-axes-for-space-axes"),
    "body axes out": (answered(LOPSIDED), "body-axes-for-space-axes"),
}


@pytest.mark.parametrize("case", RIGHT)
def test_right_equations_pass(case: str) -> None:
    equations, ball = RIGHT[case]
    checked = tr.check_equations(equations, system(ball))
    assert checked.passed, str(checked)
    assert (checked.likely, checked.worst_state) == ((), None)


@pytest.mark.parametrize("case", WRONG | WRONG_LOPSIDED)
def test_a_wrong_term_is_named_and_a_state_shows_it(case: str) -> None:
    equations, name = (WRONG | WRONG_LOPSIDED)[case]
    checked = tr.check_equations(equations, system(BALL if case in WRONG else LOPSIDED))
    assert not checked.passed
    assert name in {mistake.name for mistake in checked.likely}, str(checked)
    assert checked.worst_state is not None
    assert {"t", "r", "V", "q", "Ω", "their V̇", "our V̇"} <= set(checked.worst_state)


def test_the_ratio_that_fits() -> None:
    (mistake,) = tr.check_equations(WRONG["rate of a shell"][0], system(BALL)).likely
    assert mistake.numbers["inertia_ratio"] == pytest.approx(2 / 3, rel=1e-9)


def test_nothing_explains_nonsense() -> None:
    checked = tr.check_equations(lambda t, r, V, q, Omega: (V[1] ** 2, V[0]), system(BALL))
    assert (checked.passed, checked.likely) == (False, ())
    assert "No wrong law" in checked.remark
    with pytest.raises(tr.TrundleError, match="no path to draw"):
        checked.plot()


def test_expressions_with_values() -> None:
    vx, vy, omega, k, alpha = sympy.symbols("vx vy omega k alpha", real=True)
    kappa = omega * k / (1 + k)
    expressions = [G * sympy.sin(alpha) / (1 + k) - kappa * vy, kappa * vx]
    values = {"omega": W, k: 0.4, "alpha": BALL.tilt}
    assert tr.check_equations(expressions, system(BALL), values=values).passed
    assert not tr.check_equations(expressions, system(BALL), values=values | {k: 0.5}).passed
    with pytest.raises(tr.UnknownNameError, match=r"unknown symbol.*'omega'"):
        tr.check_equations(expressions, system(BALL), values={"k": 0.4, "alpha": 0.1})


@pytest.mark.parametrize(
    ("equations", "says"),
    [
        (lambda t, r, V, q, Omega: 1.0, "must return V̇"),
        (lambda t, r, V, q, Omega: (1.0, 2.0, 3.0, 4.0), "must return V̇"),
        (lambda t, r, V, q, Omega: (np.nan, 0.0), "must return finite numbers"),
        ("no equations", "must be"),
    ],
)
def test_what_is_no_equation_of_motion_is_refused(equations: Any, says: str) -> None:
    with pytest.raises(tr.InvalidValueError, match=says):
        tr.check_equations(equations, system(BALL))


def test_states_roll_on_any_surface() -> None:
    from tests.additions import Ball as Hollow
    from tests.additions import Tumble

    from trundle.analysis.checking.equations import states
    from trundle.mechanics.algebra import Quaternion, Vector
    from trundle.mechanics.contact import contact_at
    from trundle.mechanics.shapes import Ellipsoid

    body = tr.Body(0.75, tr.Principal(0.003, 0.004, 0.005), Ellipsoid(0.15, 0.125, 0.1))
    moving = Tumble(1.5, 0.25, -0.75, Vector(0.5, -0.25, 0.125), 2.0)
    for motion in (tr.Fixed(), moving):
        somewhere = tr.RollingSystem(body, tr.Support(Hollow(0.75, -1.0), motion=motion))
        at = states(somewhere, 20)
        for t, p, V, q, w in zip(at.time, at.point, at.velocity, at.orientation, at.angular_velocity, strict=True):
            contact = contact_at(somewhere, t, Vector(*p), Quaternion(*q))
            now = motion.at(t)
            own = now.rotation.transpose @ (Vector(*p) - now.origin)
            assert abs(somewhere.support.surface.level(own)) < 1e-12
            assert contact.slip_velocity(Vector(*V), Vector(*w)).norm() < 1e-12 * (1 + np.linalg.norm(V))
