"""Numbers as small and as large as floats are, in every field: an answer with its card, or a refusal in words, soon."""

import copy
import math
import time
import warnings
from collections.abc import Callable

import pytest

import trundle as tr
from trundle.mechanics.surfaces.base import Surface
from trundle.solve.samples import ROLLING

SECONDS = 60.0  # of the processor: far more than it takes on any machine, and far less than for ever
TABLE = {
    "body": {"kind": "solid-sphere", "radius": 0.025, "mass": 0.065},
    "support": {
        "kind": "plane",
        "tilt": 0.01,
        "friction": 0.2,
        "restitution": 0.3,
        "motion": {"kind": "spin", "rate": 3.0},
    },
    "start": {"position": [0.2, 0.0], "velocity": [0.1, 0.0]},
    "run": {"duration": 1.0, "every": 0.1},
}
FIELDS = [
    ("body", "radius"),
    ("body", "mass"),
    ("support", "tilt"),
    ("support", "friction"),
    ("support", "restitution"),
    ("support", "motion", "rate"),
    ("start", "position", 0),
    ("start", "velocity", 0),
    ("start", "spin"),
    ("start", "time"),
    ("start", "height"),
    ("run", "duration"),
    ("run", "every"),
    ("gravity",),
]
SMALL = [1e-320, 1e-308, 1e-200, 1e-162, 1e-155, 1e-100, 1e-30, 1e-16]
LARGE = [1e16, 1e30, 1e100, 1e155, 1e200, 1e308]


def with_value(path: tuple[object, ...], value: float, tilt: float) -> tr.Scenario:
    tables = copy.deepcopy(TABLE)
    tables["support"]["tilt"] = tilt
    place = tables
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return tr.Scenario.read(tables)


def told_of(scenario: Callable[..., tr.Scenario], *given: object) -> str:
    """Return the card, or the words in which the run is refused."""
    try:
        return str(scenario(*given).run().card())
    except tr.TrundleError as refused:
        return str(refused)


@pytest.mark.parametrize("tilt", [0.0, 0.01])
@pytest.mark.parametrize("path", FIELDS, ids=lambda path: ".".join(map(str, path)))
def test_a_number_of_any_size_is_answered_or_refused_in_words(path: tuple[object, ...], tilt: float) -> None:
    for size in SMALL + LARGE:
        for value in (size, -size):
            begun = time.process_time()
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                told = told_of(with_value, path, value, tilt)
            assert len(told) > 40
            assert "nan" not in told
            assert " inf" not in told
            assert time.process_time() - begun < SECONDS


@pytest.mark.parametrize("method", ["exact", "taylor", "runge-kutta"])
@pytest.mark.parametrize("rate", [1e-320, -1e-308, 1e-200, 1e-155, -1e-100, 1e-20])
def test_a_table_that_hardly_turns_is_one_that_does_not(rate: float, method: str) -> None:
    for tilt in (0.0, 0.02):
        ball = tr.Body.solid_sphere(radius=0.025, mass=0.065)
        support = tr.Support(tr.Plane(), tilt=tilt, motion=tr.Spin(rate))
        system = tr.RollingSystem(ball, support)
        run = tr.simulate(system, system.place((0.2, 0.0), (0.1, 0.05)), 2.0, 0.1, method)
        t = run.data.time.values
        downhill = 5 / 7 * 9.80665 * math.sin(tilt)
        assert run.data.position.values[:, 0] == pytest.approx(0.2 + 0.1 * t + downhill * t**2 / 2, rel=1e-11)
        assert run.data.position.values[:, 1] == pytest.approx(0.05 * t, rel=1e-9, abs=1e-12)
        assert run.card().passed


@pytest.mark.parametrize("surface", [tr.Dome(0.3), tr.Bowl(0.3), tr.Paraboloid(0.3), tr.Revolution("r**2")])
@pytest.mark.parametrize("place", [(1e-308, 0.0), (-1e-320, 1e-200), (1e-155, -1e-155), (1e-100, 0.0), (0.0, 1e-30)])
def test_a_ball_that_hardly_is_off_the_axis_is_followed(surface: Surface, place: tuple[float, float]) -> None:
    ball = tr.Body.solid_sphere(radius=0.1, mass=0.0327)
    for rate in (0.0, 37.7):
        system = tr.RollingSystem(ball, tr.Support(surface, motion=tr.Spin(rate)))
        begun = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            run = tr.simulate(system, system.place(place, "co-rotating"), 0.5, 0.1)
            assert run.card().passed
        assert time.process_time() - begun < SECONDS


@pytest.mark.parametrize("method", ["auto", "taylor", "runge-kutta"])
@pytest.mark.parametrize("size", [1e-2, 1e-9, 2.5e-11])
def test_a_body_put_down_touches_however_small_it_is_beside_its_place(size: float, method: str) -> None:
    """The place of a ball of 2.5e-11 m on a wall of 12.5 cm is rounded by more than a share of the ball."""
    wall = tr.RollingSystem(tr.Body.solid_sphere(size, 0.51), tr.Support(tr.Cylinder(0.125), tilt="90 deg"))
    for degrees in (1e-4, 0.3, 12.0, -47.0):
        run = tr.simulate(wall, wall.place((math.radians(degrees), 0.0)), 1e-6, 1e-7, method)
        assert run.events == ()
        assert (run.samples.phase == ROLLING).all()


def test_on_a_wall_of_a_million_kilometres_the_law_is_checked_as_sharply_as_places_are() -> None:
    drum = tr.RollingSystem(tr.Body.cylinder(0.025, 0.2), tr.Support(tr.Cylinder(5e8), tilt="90 deg", friction=0.6))
    card = tr.simulate(drum, drum.place(("60 deg", 0.0)), 10.0, 0.1).card()
    assert card.passed
    assert all(figure.value <= 1e-12 for figure in card.figures if figure.name == "law of motion")


def test_of_what_turns_too_fast_for_the_clock_nothing_is_claimed() -> None:
    pushed = tr.RollingSystem(
        tr.Body.solid_sphere(0.025, 5.1e-18), tr.Support(tr.Plane()), loads=(tr.Force((0.1, 0.0, 0.0)),)
    )
    card = tr.simulate(pushed, pushed.place(), 3.0, 0.1).card()
    assert card.passed
    blind = {figure.name for figure in card.figures if "no verdict" in figure.note}
    assert blind == {"no slip", "Ω is the slope of the orientation"}
