"""Formulas in the time: their slopes, their kinks, and whether they are finite throughout a run."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from tests.precise import precisely, slope
from tests.tolerances import EXACT

import trundle as tr
from trundle.errors import InvalidValueError
from trundle.mechanics.expressions import Expression
from trundle.mechanics.finiteness import check_finite, first_singular
from trundle.mechanics.kinks import has_kinks, kinks

SMOOTH = [
    "3.5*(1 - exp(-t/2))",
    "1/(1.01 + sin(5*t))",
    "t**20/(1 + t**20)",
    "hypot(t - 1, 0.125)",
    "sqrt(1 + t**2)*cos(t)",
    "abs(t - 1)",
    "log(2 + sin(3*t))/(2 - cos(t))",
    "tan(sin(t))",
    "7",
    "+t - -t",
]
SINGULAR = {
    "1/(t - 3)": 3.0,
    "log(2 - t)": 2.0,
    "sqrt(t)": 0.0,  # its slope is not finite at the start
    "sqrt(4 - t)": 4.0,
    "tan(t)": math.pi / 2,
    "exp(t**4)": math.log(1e300) ** 0.25,  # beyond 1e300, near the end of the floats
    "sin(t)/t": 0.0,
    "1/(t - 7)**2": 7.0,
    "(t - 5)**-3": 5.0,
    "hypot(t - 6, 0)": 6.0,
    "1/sin(t - 2.5)": 2.5,
    "3/0": 0.0,
}


def formula(text: str) -> Expression:
    return Expression.parse(text, ("t",), "rate")


@pytest.mark.parametrize("text", SMOOTH)
def test_a_finite_formula_is_let_through(text: str) -> None:
    assert first_singular(formula(text), 0.0, 10.0) is None


@pytest.mark.parametrize("text", SINGULAR)
def test_the_first_instant_is_found(text: str) -> None:
    found = first_singular(formula(text), 0.0, 10.0)
    assert found is not None
    assert found == pytest.approx(SINGULAR[text], abs=1e-9)
    if SINGULAR[text] > 0:
        assert first_singular(formula(text), 0.0, 0.999 * SINGULAR[text]) is None


def test_a_needle_between_any_samples_is_found() -> None:
    # The pole's neighbourhood where |ω| > 1 is 2e-9 s wide in a run of an hour.
    found = first_singular(formula("1e-9/(t - 1234.56789)"), 0.0, 3600.0)
    assert found == pytest.approx(1234.56789, abs=1e-8)


def test_a_formula_that_cannot_be_told_is_not_refused() -> None:
    assert first_singular(formula("1/(1.2 + sin(t) + cos(t)/2)"), 0.0, 1e4) is None  # finite: sin + cos/2 ≥ −1.119


@pytest.mark.parametrize(
    ("support", "loads", "key"),
    [
        (tr.SpinBy("2/(5 - t)"), (), "support.motion.rate"),
        (tr.FreeAxle(1.0, motor_torque="2/(5 - t)"), (), "support.motion.motor_torque"),
        (tr.Combined((tr.Spin(1.0), tr.Move((0.0, "1/(5 - t)", 0.0)))), (), r"support.motion.parts\[1\].position\[1\]"),
        (tr.Fixed(), (tr.Drag(0.1), tr.Force((0.0, 0.0, "log(5 - t)"))), r"loads\[1\].value\[2\]"),
    ],
)
def test_what_is_not_finite_is_named_with_its_instant(support: tr.Fixed, loads: tuple[tr.Drag, ...], key: str) -> None:
    table = tr.Support(tr.Plane(), motion=support)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table, loads)
    check_finite(system, 0.0, 4.9)
    with pytest.raises(InvalidValueError, match=rf"`{key}`.*t = 5 s"):
        check_finite(system, 0.0, 6.0)


def test_a_potential_is_left_to_the_run() -> None:
    check_finite(tr.Potential("1/hypot(x, y)"), 0.0, 1.0)


KINKED = {
    "2*abs(t - 1.5) + abs(cos(t))": [1.5, math.pi / 2, 3 * math.pi / 2],
    "abs(abs(t - 3) - 0.5)*tan(t/10)": [2.5, 3.0, 3.5],
    "abs(t**3 - 4*t)": [0.0, 2.0],
    "abs(t*t - 2*t + 2)": [],
    "abs(sqrt(t + 1) - 2)/hypot(t, 1)": [3.0],
    "abs(log(t + 2) - 1)*exp(-t)": [math.e - 2],
    "abs((t + 2)**-1 - 0.25)": [2.0],
    "abs(7) + sin(abs(-2))*t": [],
}


@pytest.mark.parametrize("text", KINKED)
def test_each_kink_is_known_and_lies_between_its_instants(text: str) -> None:
    found, wanted = kinks(formula(text), -1.0, 5.0), sorted(KINKED[text])
    assert len(found) == len(wanted)
    for kink, instant in zip(found, wanted, strict=True):
        assert kink.before < instant < kink.behind
        assert kink.before < kink.time <= kink.behind
        assert kink.behind - kink.before <= EXACT(64, 5.0)


def test_kinks_at_one_instant_are_one() -> None:
    (found,) = kinks((formula("abs(t - 0.1)"), formula("abs(3*t - 0.3)"), formula("abs(sin(t - 0.1))")), 0.0, 1.0)
    assert found.before < 0.1 < found.behind
    assert found.time == pytest.approx(0.1, abs=EXACT(1, 1.0))


@pytest.mark.parametrize("text", ["abs(t - 1)", "abs(1 - t)", "abs(-(t - 1))", "abs((1 - t)*t)"])
def test_a_kink_at_a_float_has_the_slope_behind_it(text: str) -> None:
    (kink,) = kinks(formula(text), 0.5, 1.5)
    slopes = np.array([formula(text).slope("t", t=time) for time in (kink.before, kink.time, kink.behind)])
    assert kink.time == 1.0
    assert np.allclose(slopes, [-1.0, 1.0, 1.0], rtol=0, atol=1e-12)
    assert formula(text).slope("t", t=np.array([1.0, 2.0]))[0] == pytest.approx(1.0, abs=1e-12)


def test_a_kink_at_the_end_of_a_run_is_one_too() -> None:
    assert [kink.time for kink in kinks(formula("abs(t - 1)"), 0.0, 1.0)] == [1.0]
    assert kinks(formula("abs(t - 1)"), 0.0, 0.999) == []


def test_kinks_are_told_apart_where_there_are_many_of_them() -> None:
    found = kinks(formula("abs(sin(50*t) - 0.3)"), 0.0, 100.0)
    each = [(turn * math.pi + (-1) ** turn * math.asin(0.3)) / 50 for turn in range(1593)]
    assert len(found) == len([instant for instant in each if instant < 100.0])
    assert all(abs(one.time - other) <= EXACT(64, 100.0) for one, other in zip(found, each, strict=False))


def test_only_the_time_has_kinks_at_instants() -> None:
    assert [kink.time for kink in kinks(tr.Potential("abs(x)*abs(t - 1)"), 0.0, 3.0)] == [1.0]
    assert not has_kinks(tr.Potential("abs(x)*t"))
    assert kinks(formula("abs(t - t)"), 0.0, 3.0) == []  # between the bars nothing passes through zero


@precisely
def test_slopes_are_those_of_the_formula() -> None:
    text = "exp(-t/2)*sin(3*t)**2/(2 + cos(t)) + hypot(t, 1)*log(1 + t**2) - tan(t/4) + sqrt(3 + t)*abs(t + 1)"
    push = formula(text)
    for t in (mpmath.mpf("0.3"), mpmath.mpf("1.7")):
        value, rate, bend = push.course(t)
        assert value == push.at(t=t)
        assert abs(rate - slope(lambda t: push.at(t=t), t)) <= EXACT(16, 10)
        assert abs(bend - slope(lambda t: push.slope("t", t=t), t)) <= EXACT(16, 100)


def test_it_knows_its_variables() -> None:
    assert Expression.parse("x**2 + sin(t)*2", ("x", "y", "t"), "formula").variables == {"x", "t"}
    assert formula("2 + 3").variables == frozenset()
    assert formula("2 + 3").course(1.0) == (5.0, 0.0, 0.0)


def test_as_many_terms_as_fit_stand_beside_each_other() -> None:
    """Python's tree has each sum inside of the next: 250 terms are no deeper than two."""
    terms = formula("+".join(["t"] * 250))
    assert terms.course(2.0) == (500.0, 250.0, 0.0)
    assert formula("-".join(["t"] * 250)).at(t=1.0) == -248.0
    assert first_singular(terms, 0.0, 10.0) is None
    push = tr.Force(("0.0004*(" + "+".join(["t"] * 240) + ")", 0.0, 0.0))
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane()), (push,))
    run = tr.simulate(system, system.place((0.0, 0.0), (0.0, 0.0)), 2.0, 0.2).samples
    # 7/5 m a = F, and F = 0.096 t: x = 0.096 t³/6/(7/5 m)
    assert run.position[-1, 0] == pytest.approx(0.096 * 8 / 6 / (1.4 * 0.1), rel=1e-13)


def test_a_formula_that_is_nested_too_deep_is_refused() -> None:
    assert formula("(1+" * 60 + "t" + ")" * 60).at(t=1.0) == 61.0
    with pytest.raises(InvalidValueError, match="nested too deep"):
        formula("(1+" * 61 + "t" + ")" * 61)
