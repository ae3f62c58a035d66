"""A body that nothing presses to an upright wall falls along it and never leaves it: the card does not ask it to."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.tolerances import SOLVER

import trundle as tr
from trundle.mechanics.algebra import Vector
from trundle.solve.methods import tolerance_of
from trundle.solve.samples import ROLLING

G = 9.80665
WALLS = {
    "pipe": tr.Cylinder(0.3),
    "pillar": tr.Cylinder(0.3, side="outside"),
    "plane": tr.Plane(),
}


def dropped(wall: str, lean: float, method: str) -> tr.Trajectory:
    """Return a run of 0.4 s of a ball whose centre of mass lies off its middle, let go beside a wall.

    A plane is no wall: without gravity a force along it stands for that.
    """
    if method == "taylor":
        pytest.importorskip("heyoka")
    ball = tr.Body(0.4, tr.Principal(2e-4, 2e-4, 2.2e-4), tr.Sphere(0.03, centre=Vector(0.0, 0.0, 0.008)))
    alike: dict[str, Any] = {"gravity": 0.0, "loads": (tr.Force((0.4 * G, 0.0, 0.0)),)} if wall == "plane" else {}
    system = tr.RollingSystem(ball, tr.Support(WALLS[wall]), **alike)
    start = system.place((0.1, 0.2), (0.0, 0.0), attitude=(0.3, lean, 0.1))
    return tr.simulate(system, start, 0.4, 0.01, method)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize(
    ("wall", "lean"), [("pipe", 0.5), ("pipe", 1.5), ("pipe", 2.5), ("pillar", -0.5), ("plane", -0.5)]
)
def test_what_the_wall_would_have_to_pull_falls_along_it(wall: str, lean: float, method: str) -> None:
    ours = dropped(wall, lean, method)
    assert [(event.kind, event.time) for event in ours.events] == [("lift", 0.0)]
    t = ours.samples.time
    down = np.array([1.0, 0.0, 0.0] if wall == "plane" else [0.0, 0.0, -1.0])
    allowed = SOLVER(10, tolerance_of(method))
    np.testing.assert_allclose(fallen(ours), np.outer(G * t**2 / 2, down), rtol=0, atol=allowed)
    card = ours.card()
    assert card.passed, str(card)


@pytest.mark.parametrize(("wall", "lean"), [("pipe", -0.5), ("pillar", 0.5), ("pillar", 1.5), ("plane", 0.5)])
def test_what_its_own_turning_presses_to_the_wall_rolls(wall: str, lean: float) -> None:
    ours = dropped(wall, lean, "taylor")
    assert ours.events[0].time > 0.0
    assert (ours.samples.phase[0], ours.card().passed) == (ROLLING, True)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("rate", [-1.28684, 1.28684, -3.0, 0.5])
@pytest.mark.parametrize("place", [0.00671124, -0.5])
def test_a_ring_that_a_turning_pipe_only_spins_falls_along_it(rate: float, place: float, method: str) -> None:
    """Where it touches N is 0 and falls as t²: when it comes off the wall pulls by no more than rounding."""
    if method == "taylor":
        pytest.importorskip("heyoka")
    pipe = tr.Support(tr.Cylinder(1.21506), motion=tr.Spin(rate))
    system = tr.RollingSystem(tr.Body.ring(0.0227326, 0.0750005), pipe)
    # Where and whether it grazes the wall later on, and what the wall would have to do there, rounding decides.
    ours = tr.simulate(system, system.place((place, 1.03941)), 0.03, 0.001, method)
    assert (ours.events[0].kind, ours.events[0].time < 1e-3) == ("lift", True)
    falls = ours.samples.time < next((event.time for event in ours.events[1:]), np.inf)
    np.testing.assert_allclose(fallen(ours)[falls, 2], -G * ours.samples.time[falls] ** 2 / 2, rtol=0, atol=1e-6)
    figure = ours.card()["touches the support"]
    assert figure.passed, str(figure)


def fallen(run: tr.Trajectory) -> Any:
    """Return how far a body has come from where it began."""
    return run.samples.position - run.samples.position[0]
