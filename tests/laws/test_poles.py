"""Formulas that are not finite within a run, at its end or hardly behind it: refused in words and at once."""

import math
import re
import time
from collections.abc import Callable

import pytest

import trundle as tr

SECONDS = 60.0  # of the processor: far more than it takes on any machine, and far less than for ever
BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)
POLES = [
    "tan(t*1.5707963)",
    "1/(1 - t)",
    "1/(1 - t)**3",
    "log(1 - t)",
    "sqrt(1 - t)",
    "exp(1/(1 - t))",
    "sin(1/(1 - t))",
]
REACHED = [1.0, 1.5, 0.9999999, 1 - 1e-12]  # s: at the pole, beyond, and hardly before


def spun(formula: str) -> tr.RollingSystem:
    return tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.SpinBy(formula)))


def pushed(formula: str) -> tr.RollingSystem:
    return tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=(tr.Force((formula, 0.0, 0.0)),))


def wound(formula: str) -> tr.RollingSystem:
    return tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=(tr.Torque((0.0, 0.0, formula)),))


def tilted(formula: str) -> tr.RollingSystem:
    return tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Tilt(f"0.01*({formula})")))


def moved(formula: str) -> tr.RollingSystem:
    return tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Move((f"0.01*({formula})", 0.0, 0.0))))


def told_of(system: tr.RollingSystem, velocity: tuple[float, float], duration: float, method: str) -> str:
    """Return the card, or the words in which the run is refused."""
    try:
        return str(tr.simulate(system, system.place((0.2, 0.0), velocity), duration, duration / 10, method).card())
    except tr.TrundleError as refused:
        return str(refused)


SITES = [spun, pushed, wound, tilted, moved]


@pytest.mark.parametrize("duration", REACHED)
@pytest.mark.parametrize("formula", POLES)
@pytest.mark.parametrize("site", SITES, ids=lambda site: site.__name__)
def test_a_formula_that_ends_within_the_run_or_at_its_end_is_refused_at_once(
    site: Callable[[str], tr.RollingSystem], formula: str, duration: float
) -> None:
    for method in ("auto", "taylor", "runge-kutta"):
        begun = time.process_time()
        said = told_of(site(formula), (0.0, 0.0), duration, method)
        assert time.process_time() - begun < SECONDS
        assert "must be finite, with its slopes, throughout the run" in said
        found = re.search(r"It is not at t = ([\d.]+) s\.", said)
        assert found is not None
        assert float(found[1]) == pytest.approx(1 - 1 / math.log(1e300) if "exp" in formula else 1.0, rel=1e-7)
        assert ("End the run sooner" in said) == (float(found[1]) > duration)


@pytest.mark.parametrize("method", ["auto", "taylor", "runge-kutta"])
@pytest.mark.parametrize("before", [1e-2, 3e-5])  # s; what is between is no nearer than the last
@pytest.mark.parametrize("formula", ["tan(t*1.5707963)", "1/(1 - t)", "log(1 - t)", "sqrt(1 - t)"])
def test_a_run_that_ends_some_way_before_a_pole_is_answered_soon(formula: str, before: float, method: str) -> None:
    for site in (spun, pushed):
        system = site(formula)
        begun = time.process_time()
        run = tr.simulate(system, system.place((0.2, 0.0)), 1 - before, 0.1, method)
        assert run.card().passed
        assert time.process_time() - begun < SECONDS


@pytest.mark.parametrize("method", ["auto", "taylor", "runge-kutta"])
def test_a_force_that_ends_at_a_place_is_named_where_it_does(method: str) -> None:
    """No look at the time alone finds these: the method gives them up on its way."""
    for formula in ("0.001/(0.5 - x)", "-0.001/(0.5 - x)", "-0.01/(0.5 - x)**3", "0.01*log(0.5 - x)", "sqrt(0.5 - x)"):
        system = tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=(tr.Potential(formula),))
        begun = time.process_time()
        assert len(told_of(system, (0.5, 0.0), 3.0, method)) > 40
        assert time.process_time() - begun < SECONDS
