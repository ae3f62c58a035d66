"""Dual numbers: every function against mpmath's derivatives, and where there is no slope."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.precise import precisely

import trundle as tr
from trundle.live.recorded import Recorded
from trundle.mechanics.algebra import Vector
from trundle.mechanics.duals import Dual, duals, has_duals, slopes_of, stacked, unstacked, value_of
from trundle.mechanics.jets import jets
from trundle.mechanics.scalars import namespace
from trundle.solve.tape import Tape

FUNCTIONS: dict[str, tuple[Callable[..., Any], float, float]] = {
    "+": (lambda x, y: x + y + 2.0 + x, 0.7, -0.4),
    "-": (lambda x, y: 1.0 - x - (y - 3.0) - (x - y), 0.7, -0.4),
    "*": (lambda x, y: 2.0 * x * y * x, 0.7, -0.4),
    "/": (lambda x, y: x / y / 3.0 + 2.0 / x, 0.7, -0.4),
    "**": (lambda x, y: x**3 + y**2 + x**-2 + y**1 + x**0, 0.7, -0.4),
    "sqrt": (lambda x, y: namespace(x).sqrt(x * y * y), 0.7, -0.4),
    "sin": (lambda x, y: namespace(x).sin(x * y), 0.7, -0.4),
    "cos": (lambda x, y: namespace(x).cos(x * y), 0.7, -0.4),
    "tan": (lambda x, y: namespace(x).tan(x * y), 0.7, -0.4),
    "exp": (lambda x, y: namespace(x).exp(x * y), 0.7, -0.4),
    "expm1": (lambda x, y: namespace(x).expm1(x * y), 0.7, -0.4),
    "log": (lambda x, y: namespace(x).log(x - y), 0.7, -0.4),
    "abs": (lambda x, y: abs(x) + namespace(x).abs(x * y), 0.7, -0.4),
    "hypot": (lambda x, y: namespace(x).hypot(x, y), 0.7, -0.4),
    "atan2": (lambda x, y: namespace(x).atan2(x, y), 0.7, -0.4),
    "where": (lambda x, y: namespace(x).where(y < x, x * y, x), 0.7, -0.4),
}


@pytest.mark.parametrize("name", FUNCTIONS)
@precisely
def test_a_function_has_its_derivatives(name: str) -> None:
    function, a, b = FUNCTIONS[name]
    exact = [mpmath.diff(function, (mpmath.mpf(a), mpmath.mpf(b)), order) for order in ((1, 0), (0, 1))]
    x, y = duals((a, b))
    found = function(x, y)
    assert value_of(found) == function(a, b)
    for slope, wanted in zip(found.slopes, exact, strict=True):
        assert abs(slope - float(wanted)) <= 8 * 2.0**-52 * max(1.0, abs(float(wanted)))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_arrays_of_duals_are_duals_of_arrays(name: str) -> None:
    function, a, b = FUNCTIONS[name]
    several = function(*duals((np.array([a, 2 * a]), np.array([b, 2 * b]))))
    for i, share in enumerate((1, 2)):
        one = function(*duals((share * a, share * b)))
        assert np.allclose(several.value[i], one.value, rtol=1e-15)
        for each, slope in zip(several.slopes, one.slopes, strict=True):
            assert np.allclose(np.broadcast_to(each, 2)[i], slope, rtol=4e-15)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_duals_on_a_tape_are_the_same_numbers(name: str) -> None:
    function, a, b = FUNCTIONS[name]
    tape = Tape()
    x, y = tape.inputs(2)
    found = function(*duals((x, y)))
    numbers = tape.function([found.value, *found.slopes])([a, b])
    plain = function(*duals((a, b)))
    assert np.allclose(numbers, [plain.value, *plain.slopes], rtol=1e-15)


def test_a_jet_of_duals_mixes_no_slopes() -> None:
    # d/da of d/dx of a x³ at x = 2: 3 x² = 12, and of its value x³ = 8.
    (a,), (x,) = duals((5.0,)), jets((Dual(2.0, (0.0,)),))
    found = a * x * x * x
    assert found.value.slopes == (8.0,)
    assert found.gradient[0].slopes == (12.0,)
    assert found.gradient[0].value == 60.0


def test_vectors_take_duals_on_either_side() -> None:
    (a,) = duals((3.0,))
    for product in (a * Vector(1.0, 2.0, 0.0), Vector(1.0, 2.0, 0.0) * a):
        assert [slopes_of(part, 1) for part in product] == [(1.0,), (2.0,), (0.0,)]


def test_where_there_is_no_slope_it_is_not_a_number() -> None:
    (zero,) = duals((0.0,))
    for found in (namespace(zero).sqrt(zero), namespace(zero).hypot(zero, 0.0)):
        assert found.value == 0.0
        assert math.isnan(found.slopes[0])


def test_decisions_look_at_the_value() -> None:
    x, y = duals((1.0, 2.0))
    assert x < y and y > x and x <= 1.0 and x >= 1.0 and x == 1.0 and x != y  # noqa: PT018
    assert f"{x:.2f}" == "1.00"


@pytest.mark.parametrize("number", [Dual(2.0, (1.0,)), Recorded(2.0, 2.0)])
def test_duals_of_every_kind_are_found_wherever_they_are(number: Dual) -> None:
    plain = tr.RollingSystem(tr.Body.solid_sphere(0.02, 1.0), tr.Support(tr.Bowl(0.5)))
    assert not has_duals(plain)
    assert has_duals(number)
    assert has_duals((1.0, (number,)))
    assert has_duals(replace(plain, support=tr.Support(tr.Bowl(number))))


def test_stacked_duals_come_back() -> None:
    several = [Dual(1.0, (2.0, 3.0)), Dual(4.0, (0.0, 5.0))]
    back = unstacked(stacked(several, 2), 2)
    assert [(one.value, one.slopes) for one in back] == [(one.value, one.slopes) for one in several]


@pytest.mark.parametrize(
    "lose", [float, math.sqrt, lambda x: math.hypot(x, 1.0), lambda x: np.array([1.0, x], dtype=float)]
)
def test_slopes_are_never_dropped_in_silence(lose: Any) -> None:
    with pytest.raises(TypeError, match="A float has no slopes"):
        lose(Dual(2.0, (0.0, 1.0)))
    assert float(Dual(2.0, (0.0, 0.0))) == value_of(Dual(2.0, (1.0,))) == 2.0
