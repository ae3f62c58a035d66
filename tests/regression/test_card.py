"""The card passes what is right, lists each integral that holds and no other, and reads back as it was written."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.additions import Tumble
from tests.draws import runs

import trundle as tr
from trundle import verify
from trundle.mechanics.algebra import Vector
from trundle.mechanics.shapes import Ellipsoid, Sphere
from trundle.mechanics.system import RollingSystem, State
from trundle.solve import methods
from trundle.solve.methods import Method
from trundle.solve.samples import Samples
from trundle.verify import Card, CardFigure

BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)
TABLE = tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05)
SYSTEM = tr.RollingSystem(BALL, TABLE)
START = SYSTEM.place((0.1, 0.03), (0.05, 0.2), spin=2.0)
TIMES = np.linspace(0.0, 2.0, 101)


def solved(system: RollingSystem = SYSTEM, start: State = START, method: str = "exact") -> Samples:
    return Method.of(method).solve(system, start, TIMES)


def failures(card: Card) -> set[str]:
    assert card.passed == (not card.failures)
    return {figure.name for figure in card.failures}


# --- what is right passes -------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["exact", "taylor", "runge-kutta"])
def test_a_right_run_passes(method: str) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    card = verify.card(SYSTEM, START, solved(method=method), Method.of(method), "a run")
    assert card.passed, str(card)
    assert card.title == "a run"


@settings(max_examples=25)
@given(runs(), st.sampled_from([1e-3, 0.1, 1.0, 60.0]), st.integers(1, 50))
def test_every_honest_run_passes(run: tuple[RollingSystem, State], duration: float, steps: int) -> None:
    card = tr.simulate(*run, duration=duration, every=duration / steps).card()
    assert failures(card) <= {"normal force"}, str(card)  # a drawn push may lift a light ball


@settings(max_examples=6)
@given(runs(), st.sampled_from(["taylor", "runge-kutta"]))
def test_every_honest_numerical_run_passes(run: tuple[RollingSystem, State], method: str) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    card = tr.simulate(*run, duration=1.0, every=0.1, method=method).card()
    assert failures(card) <= {"normal force"}, str(card)


def test_samples_too_far_apart_to_show_the_motion_pass() -> None:
    # A rattleback rocks twelve times a second, and is sampled ten times.
    pytest.importorskip("heyoka")
    card = tr.Scenario.load("rattleback").run(duration=5.0, every=0.1).card()
    assert card.passed, str(card)


# --- friction and the normal force ----------------------------------------------------------------------


def needed_on_a_tilted_table() -> float:
    # A full turn asks for tan α + κ²ϱ/(g cos α).
    kappa, drift = 1.0, 9.80665 * math.sin(0.05) / (3.5 * 0.4)
    radius = abs(complex(0.05, 0.2) - 1j * drift) / kappa
    return math.tan(0.05) + kappa**2 * radius / (9.80665 * math.cos(0.05))


@pytest.mark.parametrize("friction", [None, 0.2])
def test_friction_that_is_enough(friction: float | None) -> None:
    system = replace(SYSTEM, support=replace(TABLE, friction=friction))
    run = tr.simulate(system, START, duration=10.0, every=0.01)
    figure = run.card()["friction coefficient needed"]
    assert not run.events
    assert figure.bound == friction
    assert figure.passed is (None if friction is None else True)
    assert run.card().passed, str(run.card())
    assert figure.value == pytest.approx(needed_on_a_tilted_table(), rel=1e-4)  # of samples 0.01 s apart


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("friction", [0.05, 0.0])
def test_friction_that_is_not_enough(friction: float, method: str) -> None:
    system = replace(SYSTEM, support=replace(TABLE, friction=friction))
    assert friction < needed_on_a_tilted_table()
    run = tr.simulate(system, START, duration=2.0, every=0.01, method=method)
    assert (run.data.phase.values == 1).any()
    assert run.card()["friction while slipping"].passed
    assert run.card().passed, str(run.card())


def test_rolling_beyond_the_friction_given_fails() -> None:
    system = replace(SYSTEM, support=replace(TABLE, friction=0.05))
    held = solved(method="runge-kutta")
    figure = verify.card(system, START, held, Method.of("runge-kutta"))["friction coefficient needed"]
    assert figure.passed is False
    assert "slip" in figure.note


def test_the_support_does_not_pull() -> None:
    lifted = replace(SYSTEM, loads=(tr.Force((0.0, 0.0, 1.0)),))
    run = tr.simulate(lifted, lifted.place((0.1, 0.0)), duration=1.0, every=0.1, method="runge-kutta")
    assert [event.kind for event in run.events] == ["lift"]
    assert run.card().passed, str(run.card())
    up = (1.0 / 0.065 - 9.80665 * math.cos(0.05)) / 2  # m after 1 s
    assert run.data.position.values[-1, 2] == pytest.approx(0.025 + up, rel=1e-12)


def test_a_support_that_pulls_fails() -> None:
    right = solved()
    pulled = replace(right, contact_force=-right.contact_force)
    assert "normal force" in failures(verify.card(SYSTEM, START, pulled, Method.of("exact")))


# --- integrals ------------------------------------------------------------------------------------------

LEVEL, SLOPE = tr.Support(tr.Plane()), tr.Support(tr.Plane(), tilt=0.1)
TURNING = tr.Support(tr.Plane(), motion=tr.Spin(2.0))
CHAPLYGIN = tr.Body(0.065, tr.Principal(1.6e-5, 1.7e-5, 1.8e-5), Sphere(0.025))
WEIGHTED = tr.Body(0.065, tr.Isotropic(1.7e-5), Sphere(0.025, Vector(0.001, 0.0, 0.0)))
EGG = tr.Body(0.065, tr.Principal(1.6e-5, 1.7e-5, 1.8e-5), Ellipsoid(0.02, 0.025, 0.03))
TUMBLING = tr.Support(tr.Plane(), motion=Tumble(1.0, 0.5, 0.25, Vector(0.1, 0.0, 0.0), 2.0))
ENERGY, MOVING, SPIN, ABOUT = (
    "energy",
    "moving energy",
    "spin about the normal",
    "angular momentum about the contact",
)
NORMAL, JELLETT, ROUTH = "angular momentum about the normal", "integral of Jellett", "integral of Routh"
HOLD: dict[str, tuple[tr.Body, tr.Support, tuple[Any, ...], set[str]]] = {
    "ball, level": (BALL, LEVEL, (), {ENERGY, SPIN, ABOUT}),
    "ball, slope": (BALL, SLOPE, (), {ENERGY, SPIN}),
    "ball, turning": (BALL, TURNING, (), {MOVING, SPIN, ABOUT}),
    "ball, tilted and turning": (BALL, TABLE, (), {SPIN}),
    "ball, pushed": (BALL, LEVEL, (tr.Force((0.1, 0.0, 0.0)),), {ENERGY, SPIN}),
    "ball, pressed": (BALL, LEVEL, (tr.Force((0.0, 0.0, -0.1)),), {ENERGY, SPIN, ABOUT}),
    "ball, twisted": (BALL, LEVEL, (tr.Torque((1e-4, 0.0, 0.0)),), {SPIN}),
    "ball, spun up": (BALL, LEVEL, (tr.Torque((0.0, 0.0, 1e-5)),), set()),
    "ball, in air": (BALL, LEVEL, (tr.Drag(0.01),), {SPIN}),
    "ball, in air, turning": (BALL, TURNING, (tr.Drag(0.01),), {SPIN}),
    "Chaplygin's ball, level": (CHAPLYGIN, LEVEL, (), {ENERGY, NORMAL, ABOUT}),
    "Chaplygin's ball, slope": (CHAPLYGIN, SLOPE, (), {ENERGY, NORMAL}),
    "Chaplygin's ball, turning": (CHAPLYGIN, TURNING, (), {MOVING, NORMAL, ABOUT}),
    "Chaplygin's ball, tilted and turning": (CHAPLYGIN, TABLE, (), {NORMAL}),
    "weighted ball, level": (WEIGHTED, LEVEL, (), {ENERGY, JELLETT, ROUTH}),
    "ellipsoid, level": (EGG, LEVEL, (), {ENERGY}),
    "ellipsoid, turning": (EGG, TURNING, (), {MOVING}),
    "ball, tumbling": (BALL, TUMBLING, (), set()),
}


def drifts(card: Card) -> set[str]:
    found = {figure.name.removeprefix("drift of the ") for figure in card.figures if "drift of the" in figure.name}
    return {name for name in found if not name.startswith("circle")}


@pytest.mark.parametrize("name", HOLD)
def test_each_integral_that_holds_is_there_and_no_other(name: str) -> None:
    body, support, loads, wanted = HOLD[name]
    system = tr.RollingSystem(body, support, loads)
    start = system.place((0.1, 0.03), (0.05, 0.2), spin=2.0)
    method = methods.choose("auto", system, start)
    method = "runge-kutta" if method != "exact" and body is not EGG and support is not TUMBLING else method
    times = np.linspace(0.0, 0.5, 51)
    chosen = Method.of(method)
    card = verify.card(system, start, chosen.solve(system, start, times), chosen)
    assert drifts(card) == wanted
    assert card.passed, str(card)


@pytest.mark.parametrize(("support", "circles"), [(TABLE, True), (TURNING, True), (LEVEL, False), (SLOPE, False)])
def test_a_circle_is_measured_where_there_is_one(support: tr.Support, circles: bool) -> None:
    system = tr.RollingSystem(BALL, support)
    card = tr.simulate(system, system.place((0.1, 0.03), (0.05, 0.2)), duration=10.0, every=0.01).card()
    names = {figure.name for figure in card.figures}
    assert any(name.startswith("circle rate measured") for name in names) is circles
    assert any(name.startswith("drift of the circle's") for name in names) is circles


# --- the card as a thing --------------------------------------------------------------------------------


def test_json_brings_back_every_number() -> None:
    figures = (
        CardFigure("a", 1 / 3, "N", 0.1, True, "as µ ≤ 0.1"),
        CardFigure("b", math.inf, "", 0.3, False, "it would slip"),
        CardFigure("c", -math.inf),
        CardFigure("d", 5e-324, "m", math.inf, None),
    )
    card = Card('a "title"', "Taylor's", figures)
    text = card.as_json()
    assert Card.from_json(text) == card
    assert json.loads(text, parse_constant=pytest.fail)["figures"][1]["value"] == "inf"
    assert json.loads(text)["passed"] is False
    assert Card.from_json(text).failures == (figures[1],)


def test_a_mistyped_figure_lists_the_names() -> None:
    card = verify.card(SYSTEM, START, solved(), Method.of("exact"))
    with pytest.raises(tr.UnknownNameError, match=r"Did you mean 'no slip'.*law of motion"):
        card["no slp"]


def test_the_text_says_what_failed() -> None:
    card = Card("a run", "Taylor", (CardFigure("x", 1.0, "m", 0.5, False), CardFigure("y", 1.0, "m", 2.0, True)))
    assert "FAIL" in str(card)
    assert "1 of the checks FAILED" in str(card)
    assert "every check held" in str(Card("a run", "Taylor", card.figures[1:]))


@pytest.mark.parametrize("heading", [0.0, 37.0, -90.0])
def test_an_integral_that_is_nothing_for_every_heading_drifts_by_nothing(heading: float) -> None:
    # A hemisphere that rocks has JΩ·ρ = 0, by terms that cancel at one heading and are all rounding at another.
    half = tr.Body.hemisphere(radius=0.05, mass=0.25)
    system = tr.RollingSystem(half, tr.Support(tr.Plane()))
    turned = system.place(attitude=(math.radians(heading), math.radians(60.0), 0.0))
    assert tr.simulate(system, turned, duration=2.0, every=0.01).card().passed
