"""A law on a surface given by a table is recorded like any other: the spline is one step on the tape."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import polynomial
from tests.tolerances import EXACT

import trundle as tr
from trundle.mechanics.surfaces.splines import Spline
from trundle.solve.laws import FlightLaw, Law, RollingLaw, SlippingLaw
from trundle.solve.machine_code import machine_code
from trundle.solve.tape import Tape
from trundle.solve.tracing import python_law

X, Y = (-0.5, -0.1, 0.0, 0.2, 0.35, 0.6, 0.9), (0.0, 0.3, 0.5, 1.1)
TERMS = np.array([[0.3, -1.0, 0.2, 0.7], [0.1, 2.0, -0.5, 0.4], [-0.6, 0.3, 0.2, 1.0], [0.9, 0.0, -2.0, 0.3]])
ROUGH = tuple(np.linspace(0.0, 1.0, 12) ** 1.3)
GRID = Spline((X, Y), tuple(tuple(polynomial.polyval2d(x, y, TERMS) for y in Y) for x in X))
LINE = Spline((X,), tuple(polynomial.polyval(X, [1.0, -2.0, 0.5, 3.0, -0.2, 0.7])))


def on_floats(spline: Spline, at: tuple[Any, ...], orders: tuple[int, ...]) -> Any:
    return [spline(tuple(map(float, place)), orders) for place in zip(*at, strict=True)]


def on_arrays(spline: Spline, at: tuple[Any, ...], orders: tuple[int, ...]) -> Any:
    return spline(at, orders)


def on_a_tape(spline: Spline, at: tuple[Any, ...], orders: tuple[int, ...]) -> Any:
    tape = Tape()
    function = tape.function([spline(tuple(tape.inputs(len(at))), orders)])
    return [function(list(map(float, place)))[0] for place in zip(*at, strict=True)]


def in_machine_code(spline: Spline, at: tuple[Any, ...], orders: tuple[int, ...]) -> Any:
    pytest.importorskip("llvmlite")
    tape = Tape()
    function = machine_code(tape, [spline(tuple(tape.inputs(len(at))), orders)])
    return [function(list(map(float, place)))[0] for place in zip(*at, strict=True)]


EVALUATED = pytest.mark.parametrize("evaluated", [on_floats, on_arrays, on_a_tape, in_machine_code])


@EVALUATED
@pytest.mark.parametrize("order", [0, 1, 2, 5, 6])
def test_a_quintic_is_its_own_spline(evaluated: Callable[..., Any], order: int) -> None:
    places = np.linspace(-0.52, 0.92, 41)  # beyond its ends, too
    terms = polynomial.polyder([1.0, -2.0, 0.5, 3.0, -0.2, 0.7], order) if order < 6 else [0.0]
    wanted = polynomial.polyval(places, terms)
    # a derivative of the spline is a difference of rounded values, over the order's power of 0.1
    np.testing.assert_allclose(evaluated(LINE, (places,), (order,)), wanted, rtol=0, atol=EXACT(100, 10.0**order))


@EVALUATED
@pytest.mark.parametrize("orders", [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)])
def test_a_cubic_of_two_variables_is_its_own_spline(evaluated: Callable[..., Any], orders: tuple[int, int]) -> None:
    at = np.linspace(-0.52, 0.92, 23), np.linspace(1.12, -0.02, 23)
    terms = polynomial.polyder(polynomial.polyder(TERMS, orders[0], axis=0), orders[1], axis=1)
    found, wanted = evaluated(GRID, at, orders), polynomial.polyval2d(*at, terms)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=EXACT(100, 10.0 ** sum(orders)))


@EVALUATED
@pytest.mark.parametrize("orders", [(0, 0), (1, 0), (0, 2)])
def test_between_two_knots_it_is_scipys_spline(evaluated: Callable[..., Any], orders: tuple[int, int]) -> None:
    """What is a product of two functions has the product of their splines."""
    from scipy.interpolate import make_interp_spline

    rough = np.sin(40 * np.array(ROUGH)) + 2
    at = np.linspace(-0.01, 1.01, 57), np.linspace(1.01, -0.01, 57)
    line = make_interp_spline(ROUGH, rough, k=5)
    np.testing.assert_allclose(
        evaluated(Spline((ROUGH,), tuple(rough)), at[:1], orders[:1]), line(at[0], nu=orders[0]), rtol=1e-11, atol=1e-9
    )
    grid = Spline((ROUGH, ROUGH), tuple(tuple(a * b for b in rough) for a in rough))
    wanted = line(at[0], nu=orders[0]) * line(at[1], nu=orders[1])
    np.testing.assert_allclose(evaluated(grid, at, orders), wanted, rtol=1e-11, atol=1e-9)


@pytest.mark.parametrize("orders", [(1, 0), (0, 1)])
def test_a_step_aside_into_the_complex_plane_gives_the_slope(orders: tuple[int, int]) -> None:
    x, y = np.linspace(-0.5, 0.9, 29), np.linspace(0.0, 1.1, 29)
    aside = [1e-30j * order for order in orders]
    found = GRID((x + aside[0], y + aside[1])).imag / 1e-30
    np.testing.assert_allclose(found, GRID((x, y), orders), rtol=0, atol=EXACT(1000, 1.0))


def bowl(r: float) -> float:
    return 0.8 * r * r - 0.5 * r**4


RADII = [0.0, 0.1, 0.25, 0.3, 0.5, 0.6, 0.8]
SIDE = [-0.9, -0.5, -0.2, 0.0, 0.3, 0.5, 0.9]
# The same dish by a formula and by a table that a quintic goes through exactly.
FORMULA = tr.Revolution("0.8*r**2 - 0.5*r**4")
TABLES = {
    "revolution": tr.Revolution.through(RADII, [bowl(r) for r in RADII]),
    "height field": tr.HeightField.through(SIDE, SIDE, [[bowl(float(np.hypot(x, y))) for y in SIDE] for x in SIDE]),
}
MOVING = {"motion": tr.Wobble(angle=0.1, rate=2.0), "friction": 0.3}
BODY = tr.Body.ellipsoid((0.05, 0.04, 0.03), 0.2)


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("law", [RollingLaw(), SlippingLaw(), FlightLaw()], ids=["rolling", "slipping", "flying"])
def test_the_law_on_a_table_is_that_of_the_formula(table: str, law: Law) -> None:
    by_table, by_formula = (tr.RollingSystem(BODY, tr.Support(on, **MOVING)) for on in (TABLES[table], FORMULA))
    start = by_formula.place((0.2, 0.1), (0.3, -0.1), angular_velocity=(1.0, 2.0, 3.0))
    state = law.pack(by_formula, start)
    if law.code == SlippingLaw.code:
        state[10:13] = 0.1, 0.2, 0.0
    ending = (1e-20, 1.0, 0.0, 0.0) * len(law.ends)
    ours, theirs = (python_law(system, law, ending) for system in (by_table, by_formula))
    # a second derivative of the spline is a difference of rounded values over the square of 0.1
    np.testing.assert_allclose(ours.rates(0.3, state), theirs.rates(0.3, state), rtol=1e-11, atol=1e-11)
    known = dict(zip(theirs.names, theirs.event_functions(0.3, state), strict=True))
    found = dict(zip(ours.names, ours.event_functions(0.3, state), strict=True))
    assert set(found) - set(known) == {"end"}
    assert [found[name] for name in known] == pytest.approx(list(known.values()), rel=1e-11)


@pytest.mark.parametrize("table", TABLES)
def test_a_law_on_a_table_takes_little_longer_than_one_by_a_formula(table: str) -> None:
    """By vectors, and SciPy's splines, it took forty times as long: runs on tables hung."""
    took = {}
    for on in (TABLES[table], FORMULA):
        system = tr.RollingSystem(BODY, tr.Support(on, **MOVING))
        state = RollingLaw().pack(system, system.place((0.2, 0.1), (0.3, -0.1)))
        law = python_law(system, RollingLaw())
        assert law.compiled is not None
        begun = []
        for _ in range(5):
            begun.append(time.process_time())
            for _ in range(100):
                law.rates(0.3, state)
        took[on] = min(later - sooner for sooner, later in pairwise([*begun, time.process_time()]))
    assert took[TABLES[table]] < 10 * took[FORMULA]
