"""Loads with a corner where something passes through zero: no step leads across it, by closed formulas."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mp

import trundle as tr
from trundle.solve import corner_events
from trundle.solve.dense import Dense
from trundle.solve.laws import FlightLaw, RollingLaw
from trundle.solve.methods import Method
from trundle.solve.tracing import python_law

METHODS = ("taylor", "runge-kutta")
A, M, G = 0.02, 0.05, 9.80665
BALL = tr.Body.solid_sphere(A, M)
CREASES = ("0.05*abs(x)", "0.05*sqrt(x**2)", "0.05*sqrt(x*x + y*y)", "hypot(x, y)/20")
INERT = 7 / 5  # 1 + k of a ball that rolls, in its mass


def passes(run: tr.Trajectory) -> None:
    failures = run.card().failures
    assert not failures, failures


def over(load: Any, **support: Any) -> tr.RollingSystem:
    return tr.RollingSystem(BALL, tr.Support(tr.Plane(), **support), loads=[load])


def newton(v0: float, down: float, up_hill: float, inert: float, at: float) -> float:
    """Return how far a body has gone up that begins at v0 against a pull and drag that goes with v²: tan, then tanh.

    The pull is m g `down`, the drag m `up_hill` v²; what moves has `inert` times the mass.
    """
    with mp.workdps(40):
        g, k = mp.mpf(down) * G / inert, mp.mpf(up_hill) / inert
        vt = mp.sqrt(g / k)
        rate, begun = mp.sqrt(g * k), mp.atan(v0 / vt)
        top = begun / rate
        if at < top:
            return float(mp.log(mp.cos(begun - rate * at) / mp.cos(begun)) / k)
        return float((-mp.log(mp.cos(begun)) - mp.log(mp.cosh(rate * (at - top)))) / k)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("c", [1e-4, 0.03, 2.0])
@pytest.mark.parametrize("v0", [0.3, 3.0])
def test_thrown_straight_up_against_newtons_drag(method: str, c: float, v0: float) -> None:
    system = over(tr.QuadraticDrag(c), friction=0.3, restitution=0.5)
    run = tr.simulate(system, system.place(velocity=(0.0, 0.0, v0), height=5.0), 0.8, 0.01, method)
    heights = [5.0 + A + newton(v0, 1.0, c / M, 1.0, t) for t in run.samples.time.tolist()]
    assert np.abs(run.samples.position[:, 2] - heights).max() < 2e-11  # 2e-6 without the corner
    passes(run)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("tilt", "way"), [(0.2, -1.0), (-0.2, 1.0), (0.05, -1.0)])
def test_rolled_up_a_slope_against_newtons_drag(method: str, tilt: float, way: float) -> None:
    system = over(tr.QuadraticDrag(0.3), tilt=tilt)
    run = tr.simulate(system, system.place(velocity=(2.0 * way, 0.0)), 2.5, 0.01, method)
    gone = [newton(2.0, abs(np.sin(tilt)), 0.3 / M, INERT, t) for t in run.samples.time.tolist()]
    assert np.abs(run.samples.position[:, 0] * way - gone).max() < 2e-11
    passes(run)


def crease(x0: float, v: float, a: float, t: Any) -> Any:
    """Return where a body is at times t that is pushed towards 0 with a constant acceleration: arcs of parabolas."""
    turns = np.sqrt(v * v + 2 * a * x0) / a  # from the lowest place of an arc to its top
    begun = turns - v / a if x0 > 0 else 0.0
    within = np.mod(np.asarray(t) + begun, 4 * turns)
    first = within < 2 * turns
    arc = np.where(first, within, within - 2 * turns) - turns
    return np.where(first, 1.0, -1.0) * 0.5 * a * (turns**2 - arc**2)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("formula", "x0", "v"),
    [
        *((formula, x0, v) for formula in CREASES for x0, v in ((0.1, 0.0), (0.07, -0.3), (0.07, 0.3))),
        *((formula, 0.0, 0.4) for formula in CREASES if "y" not in formula),  # a root of 0 has no slope to start with
    ],
)
def test_a_crease_in_a_potential_is_not_stepped_across(method: str, formula: str, x0: float, v: float) -> None:
    system = over(tr.Potential(formula))
    run = tr.simulate(system, system.place((x0, 0.0), velocity=(v, 0.0)), 5.0, 0.02, method)
    expected = crease(x0, v, 0.05 / (M * INERT), run.samples.time)
    assert np.abs(run.samples.position[:, 0] - expected).max() < 1e-10
    passes(run)


@pytest.mark.parametrize("method", METHODS)
def test_a_crease_that_moves(method: str) -> None:
    """In a frame that moves with it evenly, it is one at rest."""
    system = over(tr.Potential("0.05*abs(x - 0.2*t)"))
    run = tr.simulate(system, system.place((0.1, 0.0), velocity=(0.2, 0.05)), 5.0, 0.02, method)
    t = run.samples.time
    assert np.abs(run.samples.position[:, 0] - 0.2 * t - crease(0.1, 0.0, 0.05 / (M * INERT), t)).max() < 1e-10
    assert np.abs(run.samples.position[:, 1] - 0.05 * t).max() < 1e-12


@pytest.mark.parametrize("method", METHODS)
def test_drag_whose_velocity_passes_close_by_zero(method: str) -> None:
    """The nearer the thrown body comes to rest, the sharper its drag bends: by Taylor's series in 40 digits."""
    c, up = 0.5, 2.0
    for aside in (1e-3, 1e-5, 1e-7):
        system = over(tr.QuadraticDrag(c), friction=0.3)
        start = system.place(velocity=(aside, 0.0, up), height=3.0)
        run = tr.simulate(system, start, 0.5, 0.05, method)
        with mp.workdps(25):

            def rates(t: Any, y: Any) -> Any:  # noqa: ARG001
                size = mp.sqrt(y[2] ** 2 + y[3] ** 2 + mp.mpf("1e-12"))
                return [y[2], y[3], -c / M * size * y[2], -G - c / M * size * y[3]]

            top = float(mp.atan(up / mp.sqrt(G * M / c)) / mp.sqrt(G * c / M))
            before = mpmath.odefun(rates, 0, [0, 3 + A, aside, up], tol=1e-16)(top)
            expected = mpmath.odefun(rates, top, list(before), tol=1e-16)(mp.mpf("0.5"))
        assert np.abs(run.samples.position[-1, [0, 2]] - [float(v) for v in expected[:2]]).max() < 1e-10


@pytest.mark.parametrize("method", METHODS)
def test_at_rest_in_still_air_nothing_is_passed(method: str) -> None:
    system = over(tr.QuadraticDrag(0.3))
    run = tr.simulate(system, system.place(), 5.0, 0.1, method)
    assert not run.samples.velocity.any()
    passes(run)


@pytest.mark.parametrize("method", METHODS)
def test_pushed_into_a_crease_from_both_sides_is_refused_in_words(method: str) -> None:
    system = over(tr.Potential("0.05*abs(x)"))
    with pytest.raises(tr.SolverError, match="pushed back from both sides"):
        tr.simulate(system, system.place(velocity=(0.0, 0.3)), 1.0, 0.1, method)


def test_members_with_corners_are_as_when_alone() -> None:
    system = over(tr.QuadraticDrag(0.3), tilt=0.2)
    starts = [system.place(velocity=(-v, 0.0)) for v in (1.0, 2.0, 3.0)]
    many = tr.simulate_many(system, starts, 2.5, 0.1)
    for i, start in enumerate(starts):
        alone = tr.simulate(system, start, 2.5, 0.1)
        apart = np.abs(many.position.values[i] - alone.samples.position)
        assert apart.max() <= 1e-14  # several at once: their steps are rounded otherwise


@pytest.mark.parametrize("method", METHODS)
def test_passing_a_corner_asks_the_law_itself_for_no_rates(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # By vectors they take as long as twenty times by the flat function that is made of them once.
    asked, rates = [], RollingLaw.rates

    def counted(law: RollingLaw, system: Any, time: Any, state: Any) -> Any:
        asked.extend([time] * isinstance(time, float))
        return rates(law, system, time, state)

    monkeypatch.setattr(RollingLaw, "rates", counted)
    system = over(tr.Potential("0.05*abs(x)"))
    run = tr.simulate(system, system.place(position=(0.02, 0.0)), 2.0, 0.1, method)
    x = run.samples.position[:, 0]
    assert x.min() < -0.01
    assert not asked


@pytest.mark.parametrize("place", [(0.07, 0.02), (-0.03, 0.0)])
def test_what_passes_through_zero_at_a_corner_is_the_same_as_flat_python(place: tuple[float, float]) -> None:
    system = tr.RollingSystem(
        BALL, tr.Support(tr.Plane(), motion=tr.Spin(2.0)), loads=[tr.QuadraticDrag(0.3), tr.Potential("0.05*abs(x)")]
    )
    for law, start in (
        (RollingLaw(), system.place(place, (0.2, -0.1))),
        (FlightLaw(), system.place(place, (0.2, -0.1, 0.3), height=0.2)),
    ):
        numbers = law.pack(system, start)
        wanted = [float(part) for w in corner_events.vectors(system, law, 0.3, numbers) for part in w]
        assert len(wanted) == 3 * len(system.corners) == 6
        assert python_law(system, law).corners(0.3, numbers) == pytest.approx(wanted, rel=1e-14)


@pytest.mark.parametrize("gap", [1e-5, 1e-6, 1e-7])
def test_a_velocity_that_only_whirls_about_passes_no_corner(gap: float) -> None:
    """In a bowl all but as round as the ball V whirls at √(5g/(7(R − a))), and nothing else is as fast.

    Each quarter turn was taken for a corner, and the law begun anew behind it: some runs took a minute.
    """
    bowl = tr.Support(tr.Bowl(A + gap))
    system = tr.RollingSystem(BALL, bowl, loads=[tr.QuadraticDrag(1e-6)])
    rate = np.sqrt(5 * G / (7 * gap))
    start = system.place((0.3 * A, 0.0), (0.0, 0.3 * gap * rate))
    run = Method.of("taylor").dense(system, start, 20 / rate)
    assert isinstance(run, Dense)
    lengths = np.linalg.norm(run(np.linspace(0.0, 20 / rate, 100)).velocity, axis=1)
    assert lengths.min() > 0.8 * lengths.max()
    assert len(run.legs) == 1
