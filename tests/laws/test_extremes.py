"""Numbers as small and as large as floats are, in every field: an answer with its card, or a refusal in words, soon."""

import copy
import math
import time
import warnings
from collections.abc import Callable

import pytest

import trundle as tr
from trundle.mechanics.surfaces.base import Surface

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
