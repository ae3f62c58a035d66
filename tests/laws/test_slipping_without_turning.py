"""Bodies that slip against resistance to rolling: their turning over the support ends, and may begin again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from tests.tolerances import SOLVER

import trundle as tr
from trundle.mechanics.algebra import ZERO
from trundle.mechanics.loads import BodyMotion, Load
from trundle.mechanics.scalars import namespace
from trundle.solve.transitions import at_start

RADIUS, MASS, K, G, OFFSET = 0.05, 0.2, 0.4, 9.80665, 2e-3
J = K * MASS * RADIUS**2
BALL = tr.Body.sphere(radius=RADIUS, mass=MASS, inertia_ratio=K)
EGG = tr.Body.ellipsoid(("5 cm", "4 cm", "3 cm"), MASS)
METHODS = ["taylor", "runge-kutta"]


def followed(system: tr.RollingSystem, start: Any, method: str, duration: float = 1.0, every: float = 0.05) -> Any:
    """Return a run whose card passes."""
    if method == "taylor":
        pytest.importorskip("heyoka")
    run = tr.simulate(system, start, duration=duration, every=every, method=method)
    card = run.card()
    assert card.passed, str(card)
    return run


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("tilt", "turning"), [(0.0, 5.0), (0.0, -5.0), (0.3, 5.0), (0.3, -5.0)])
def test_without_friction_resistance_ends_the_turning_and_nothing_else(
    tilt: float, turning: float, method: str
) -> None:
    # J Ω̇ = −δ m g cos α against the turning; the centre feels nothing of it. The spin about the normal stays.
    ice = tr.Support(tr.Plane(), tilt=tilt, friction=0.0)
    system = tr.RollingSystem(BALL, ice, (tr.RollingResistance(OFFSET),))
    over = abs(turning) * J / (OFFSET * MASS * G * math.cos(tilt))
    start = system.place(velocity=(0.7, -0.2), angular_velocity=(0.6 * turning, 0.8 * turning, 3.0))
    run = followed(system, start, method, duration=2.0, every=over / 4)  # it ends at a sample
    assert [event.kind for event in run.events] == ["slip"]
    assert "stopped turning" in run.events[0].text
    assert abs(run.events[0].time - over) <= SOLVER(100, run.tolerance)
    t = run.data.time.values
    left = np.maximum(1 - t / over, 0.0)
    wanted = np.stack([0.6 * turning * left, 0.8 * turning * left, 0 * t + 3.0], axis=1)
    assert np.abs(run.data.angular_velocity.values - wanted).max() <= SOLVER(1000, run.tolerance)
    assert np.abs(run.data.velocity.values[:, 0] - (0.7 + G * math.sin(tilt) * t)).max() <= SOLVER(1000, run.tolerance)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("way", [1, -1])
def test_a_couple_turns_it_where_it_is_more_than_the_resistance_holds(method: str, way: int) -> None:
    # J Ω̇ = K₀ sin νt − δ m g, from where the right side is nothing to where its integral is.
    most, rate, held = 0.03, 3.0, 0.01 * MASS * G
    ice = tr.Support(tr.Plane(), friction=0.0)
    couple = tr.Torque((f"{way * most}*sin({rate}*t)", 0.0, 0.0))
    system = tr.RollingSystem(BALL, ice, (tr.RollingResistance(0.01), couple))
    run = followed(system, system.place(velocity=(1.0, 0.0), angular_velocity=(0, 0, 0)), method, duration=1.2)
    begins = math.asin(held / most) / rate

    def Omega(t: Any) -> Any:
        return (most / rate * (math.cos(rate * begins) - np.cos(rate * t)) - held * (t - begins)) / J

    ends = float(brentq(Omega, 2 * begins, 1.2))
    assert [event.text.split(" turn")[0] for event in run.events] == ["began to", "stopped"]
    assert np.abs(np.subtract([event.time for event in run.events], [begins, ends])).max() <= 1e-9
    t = run.data.time.values
    wanted = way * np.where((t > begins) & (t < ends), Omega(t), 0.0)
    assert np.abs(run.data.angular_velocity.values[:, 0] - wanted).max() <= 1e-9
    assert (run.data.velocity.values[:, 0] == 1.0).all()


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("kinetic", [None, 0.08])
def test_where_friction_gives_way_and_resistance_does_not_a_ball_slides_as_a_block_does(
    kinetic: float | None, method: str
) -> None:
    # Friction's lever on the ball is a μ N, and resistance holds δ N: more, where δ > a μ.
    slope = tr.Support(tr.Plane(), tilt=0.2, friction=0.1, kinetic_friction=kinetic)
    system = tr.RollingSystem(BALL, slope, (tr.RollingResistance(0.02),))
    run = followed(system, system.place(), method)
    assert not run.events
    pull = G * (math.sin(0.2) - (0.1 if kinetic is None else kinetic) * math.cos(0.2))
    assert np.abs(run.data.velocity.values[:, 0] - pull * run.data.time.values).max() <= 1e-9
    assert np.abs(run.data.angular_velocity.values).max() == 0.0


@dataclass(frozen=True)
class Smooth(Load):
    """Resistance to rolling that eases off below a rate, so that turning never ends."""

    offset_of_it: float
    below: float
    at_contact = True

    def torque_per_normal_force(self, motion: BodyMotion) -> Any:
        """Return −δ Ω_t/√(Ω_t² + w²)."""
        n = motion.normal
        if n is None:
            return ZERO
        relative = motion.angular_velocity - motion.support_angular_velocity
        over = relative - n * relative.dot(n)
        square = over.dot(over) + self.below * self.below
        return over * (-self.offset_of_it / namespace(square).sqrt(square))


@pytest.mark.parametrize("friction", [0.0, 0.05])
@pytest.mark.parametrize("surface", [tr.Plane(), tr.Bowl("1 m")])
def test_a_body_of_any_shape_moves_as_under_resistance_that_eases_off(surface: Any, friction: float) -> None:
    # By another law, of one phase: what it leaves of the turning, and of all else, goes with w.
    support = tr.Support(surface, motion=tr.Rock(0.05, 3.0), friction=friction)

    def last(load: Any) -> np.ndarray[Any, Any]:
        system = tr.RollingSystem(EGG, support, (load,))
        start = system.place(
            (0.2, 0.1), velocity=(-0.5, 0.2), angular_velocity=(-3.0, 4.0, -5.0), orientation=(0.9, 0.2, 0.3, 0.1)
        )
        run = tr.simulate(system, start, duration=0.3, every=0.3, method="auto")
        if not isinstance(load, Smooth):
            assert run.card().passed
            assert any("stopped turning" in event.text for event in run.events)
        return np.concatenate([run.data[name].values[-1] for name in ("position", "velocity", "angular_velocity")])

    sharp = last(tr.RollingResistance(0.02))
    off = [float(np.abs(last(Smooth(0.02, w)) - sharp).max()) for w in (0.02, 0.005)]
    assert off[0] <= 0.05
    assert off[1] <= 0.3 * off[0]


def test_on_an_axle_that_turns_freely_it_is_refused_in_words() -> None:
    table = tr.Support(tr.Plane(), motion=tr.FreeAxle(inertia=0.01, rate=1.0), friction=0.0)
    system = tr.RollingSystem(BALL, table, (tr.RollingResistance(OFFSET),))
    start = system.place((0.2, 0.0), velocity=(0.5, 0.0), angular_velocity=(0.0, 1.0, 1.0))
    with pytest.raises(tr.SolverError, match="no longer turns over its support"):
        tr.simulate(system, start, duration=2.0, every=0.1, method="runge-kutta")


def test_the_balance_counts_what_holds_a_body_at_rest_on_a_support_that_turns() -> None:
    rocker = tr.Support(tr.Plane(), motion=tr.Rock(0.02, 3.0), friction=0.5)
    system = tr.RollingSystem(BALL, rocker, (tr.RollingResistance(0.01),))
    run = followed(system, system.place((0.1, 0.0)), "runge-kutta")
    assert [event.kind for event in run.events] == ["stop"]


def test_a_body_that_slips_fast_in_a_narrow_bowl_stays_on_it() -> None:
    """What rounding makes of s along n grew there by e within a thirtieth of a second."""
    bowl = tr.Support(tr.Revolution("4.4*r**2"), friction=0.0)
    driven = tr.Torque((0.03, "0.0166*(1 - exp(-t))", 0.0))
    system = tr.RollingSystem(tr.Body.sphere("4 cm", "0.275 kg", 0.23), bowl, (driven,))
    start = system.place((0.0122, -0.1955), angular_velocity=(0.0, 0.0, 0.0))
    followed(system, start, "runge-kutta", duration=1.6, every=0.02)


@pytest.mark.parametrize(
    "motion",
    [
        tr.Fixed(),
        tr.Spin(3.0),
        tr.SpinBy("2*t + sin(5*t)"),
        tr.Rock(amplitude=0.3, rate=7.0, phase=0.4),
        tr.Wobble(3.5, 0.1),
        tr.FreeAxle(inertia=0.02),
    ],
    ids=lambda one: type(one).__name__,
)
@pytest.mark.parametrize(
    "surface", [tr.Plane(), tr.Bowl(0.7), tr.EllipsoidalBowl((0.7, 0.6, 0.5))], ids=lambda one: type(one).__name__
)
@pytest.mark.parametrize("slips", [False, True])
def test_how_fast_turning_over_a_moving_support_shrinks(surface: tr.Surface, motion: tr.Motion, slips: bool) -> None:
    """The support turns, too, and where it bends, or turns about, so does the normal."""
    support = tr.Support(surface, motion=motion, friction=0.3)
    system = tr.RollingSystem(EGG, support, (tr.RollingResistance(OFFSET),))
    given: Any = {"angular_velocity": (3.0, -2.0, 4.0), "velocity": (0.5, 0.2) if slips else "rolling"}
    now = at_start(system, system.place((0.05, 0.02), attitude=(0.3, 0.2, 0.1), **given))
    assert type(now.law).__name__ == ("SlippingLaw" if slips else "RollingWithResistance")
    y, step = list(map(float, now.state_vector)), 1e-4
    behind, ahead = (
        now.law.shrinking(system, now.time + h, now.law.rk4_step(system, now.time, y, h), "stop").array()
        for h in (-step, step)
    )
    n = now.law.unpack(system, now.time, y).contact.normal.array()
    slope = (ahead - behind) / (2 * step)
    along = slope - n * (n @ slope)
    found = now.law.shrinking_rate(system, now.time, y, "stop").array()
    assert np.abs(found - along).max() <= 1e-4 * np.abs(along).max()
