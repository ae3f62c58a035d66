"""The scenario file of a path to roll along: what it reads and refuses, and what the shipped ones promise."""

from __future__ import annotations

import copy
import math
import tomllib
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.regression.test_scenario_fuzz import anything, judge_message, places

import trundle as tr
from trundle.errors import InvalidValueError, ScenarioError
from trundle.scenario import ScenarioFile, files
from trundle.scenario.path_file import PathFile

SHIPPED = {name: files.parse(files.read(name), name) for name in PathFile.names()}
WHOLE = {"body": {"radius": 0.1}, "path": [{"kind": "straight", "length": "10 cm"}]}


def with_piece(**keys: Any) -> dict[str, Any]:
    return {**WHOLE, "path": [keys]}


def test_quantities_keep_the_users_words() -> None:
    for name in PathFile.names():
        scenario = PathFile.load(name)
        assert tomllib.loads(scenario.to_toml()) == SHIPPED[name]
        assert PathFile.loads(scenario.to_toml()) == scenario


def test_what_is_read_is_what_is_rolled() -> None:
    text = """
    [body]
    radius = "2 cm"
    [start]
    position = ["1 cm", "2 cm"]
    orientation = [0, 0, 0, 2]
    [[path]]
    kind = "straight"
    to = ["4 cm", "6 cm"]
    [[path]]
    kind = "arc"
    radius = "3 cm"
    angle = "-90 deg"
    [[path]]
    kind = "curve"
    points = [["8.2 cm", "6.6 cm"], ["9 cm", "5 cm"], ["9 cm", 0.0]]
    [run]
    every = "5 mm"
    """
    scenario = tr.PathScenario.loads(text)
    rolled = scenario.run()
    turned = math.atan2(4, 3)  # the way of the straight piece, with the legs 3 and 4 cm
    centre = np.array([0.04, 0.06]) + 0.03 * np.array([math.sin(turned), -math.cos(turned)])
    np.testing.assert_allclose(rolled.stages.contact[1], [0.04, 0.06], atol=1e-17)
    east = centre + 0.03 * np.array([math.cos(turned), math.sin(turned)])  # a quarter to the right of it
    np.testing.assert_allclose(rolled.stages.contact[2], east, atol=1e-15)
    np.testing.assert_allclose(rolled.stages.contact[2], [0.082, 0.066], atol=1e-15)
    assert rolled.stages.orientation[0].tolist() == [0, 0, 0, 1]
    assert rolled.radius == 0.02
    assert scenario.sampling.every == 0.005
    assert rolled.dataset(0.005).attrs["radius"] == 0.02


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ({**WHOLE, "body": {}}, "`body.radius` must be given; got nothing. Add for instance: radius ="),
        ({**WHOLE, "body": {"radius": "1 kg"}}, "`body.radius` must be a length; got '1 kg'"),
        (
            {**WHOLE, "body": {"radius": 0.1, "mass": 1}},
            "`body.mass` is no key of [body]; got 1. There are: radius, diameter.",
        ),
        ({**WHOLE, "path": []}, "`path` must have at least one piece; got []"),
        ({**WHOLE, "path": {"kind": "straight"}}, "`path` must be a list of tables"),
        ({**WHOLE, "support": {}}, "`support` is no key of the file"),
        ({**WHOLE, "\ud800": 1}, r"`'\ud800'` is no key of the file; got '\ud800'. There are: title"),
        ({**WHOLE, "body": {"radius": 0.1, "a.\udfff": 1}}, r"`body.'a.\udfff'` is no key of [body]; got 'a.\udfff'."),
        ({**WHOLE, "body": {"radius": 0.1, 1: 1}}, "`body[1]` is no key: keys are text; got 1. Put it in quotes."),
        (with_piece(length=1), '`path[0].kind` must be given; got nothing. Say which, for instance: kind = "straight"'),
        (
            with_piece(kind="strait"),
            "`path[0].kind` must be one of those that exist; got 'strait'",
        ),
        (with_piece(kind="straight"), "`path[0].length` must be given, or `turn`, or `to`; got nothing"),
        (
            with_piece(kind="straight", lenght=1),
            "`path[0].lenght` is no key of [path[0]]; got 1. Did you",
        ),
        (with_piece(kind="straight", length=1, turn=1), "`path[0].turn` must not stand beside `length`; got 1.0"),
        (with_piece(kind="straight", heading="1 deg", to=[1, 1]), "`path[0].heading` must not stand beside `to`"),
        (with_piece(kind="straight", length=-1), "`path[0].length` must be positive; got -1"),
        (with_piece(kind="straight", turn="1 m"), "`path[0].turn` must be an angle; got '1 m'"),
        (with_piece(kind="arc", angle=1), "`path[0].radius` must be given; got nothing"),
        (
            with_piece(kind="arc", radius=1, angle=0),
            "`path[0].angle` must not be zero; got 0. Positive",
        ),
        (with_piece(kind="curve", points=[[0, 0]]), "`path[0].points` must be a list of at least 2 points"),
        (with_piece(kind="curve", points=[[0, 0], [1]]), "`path[0].points[1]` must be a list of 2; got [1]"),
        (with_piece(kind="curve", points=[[0, 0], [1, "1 s"]]), "`path[0].points[1][1]` must be a length; got '1 s'"),
        (with_piece(kind="curve", points=[[0, 0], [1, 1]], closed=1), "`path[0].closed` must be true or false; got 1"),
        ({**WHOLE, "start": {"orientation": [0, 0, 0, 0]}}, "`start.orientation` must be a quaternion of unit length"),
        ({**WHOLE, "run": {"every": "1 s"}}, "`run.every` must be a length; got '1 s'"),
        ({"body": {"radius": 1}}, "`path` must be given; got nothing. Add for instance"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(data: dict[str, Any], said: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        PathFile.read(data, "mine.toml")
    assert str(caught.value).startswith(f"mine.toml: {said}")
    judge_message(caught.value)


def test_a_path_is_no_motion_and_a_motion_no_path() -> None:
    with pytest.raises(ScenarioError, match=r"roll-x-then-y: `scenario` must have a body .* `tr.PathScenario`"):
        tr.Scenario.load("roll-x-then-y")
    with pytest.raises(ScenarioError, match=r"tilted-turntable: "):
        tr.PathScenario.load("tilted-turntable")
    assert not set(PathFile.names()) & set(ScenarioFile.names())


def test_pieces_that_do_not_join_are_refused_when_rolled() -> None:
    curve = {"kind": "curve", "points": [[1, 1], [2, 1], [3, 0]]}
    with pytest.raises(ScenarioError, match=r"`path\[1\]` must begin where the path has come to; got '\(1, 1\) m'"):
        tr.PathScenario.read({**WHOLE, "path": [*WHOLE["path"], curve]}).run()
    with pytest.raises(ScenarioError, match=r"`path\[0\].to` must be another place"):
        tr.PathScenario.read(with_piece(kind="straight", to=[0, 0])).run()
    with pytest.raises(ScenarioError, match="must turn the ball by at most 1e9 rad"):
        tr.PathScenario.read(with_piece(kind="straight", length="1e12 m")).run()


@st.composite
def spoiled(draw: st.DrawFn) -> dict[str, Any]:
    """A shipped path with one or two values changed or removed."""
    data: dict[str, Any] = copy.deepcopy(SHIPPED[draw(st.sampled_from(sorted(SHIPPED)))])
    for _ in range(draw(st.integers(1, 2))):
        *way, last = draw(st.sampled_from(places(data)))
        node: Any = data
        for step in way:
            node = node[step]
        if draw(st.booleans()):
            node[last] = draw(anything)
        else:
            del node[last]
    return data


@settings(deadline=None, max_examples=200, suppress_health_check=[HealthCheck.too_slow])
@given(spoiled())
def test_spoiled_paths_are_refused_in_one_line_or_rolled(data: dict[str, Any]) -> None:
    try:
        scenario = tr.PathScenario.read(data)
        assert tr.PathScenario.loads(scenario.to_toml()) == scenario
        if len(scenario.path) < 30:
            assert np.isfinite(scenario.run().stages.orientation).all()
    except InvalidValueError as refusal:
        judge_message(refusal)


# --- the notes of the shipped paths tell what one sees -----------------------------------------------------------


def says(name: str, *words: str) -> None:
    notes = PathFile.load(name).notes.replace("\n", " ")
    for word in words:
        assert word in notes


def test_the_notes_of_the_two_orders() -> None:
    """By hand: (1 ∓ i + j ∓ k)/2 for the two, and their quotient (1 + i + j + k)/2."""
    for name in ("roll-x-then-y", "roll-y-then-x"):
        says(name, f"{25 * math.pi / 2:.1f} mm")
    says("roll-x-then-y", "120 deg about the diagonal (-1, 1, -1)", "still points along +x")
    says("roll-y-then-x", "120 deg about (-1, 1, 1)", "120 deg about (1, 1, 1)", "along +y")
    y_then_x = np.array([0.5, -0.5, 0.5, 0.5])
    rolled = tr.PathScenario.load("roll-y-then-x").run()
    np.testing.assert_allclose(rolled.stages.orientation[-1], y_then_x, rtol=0, atol=1e-15)


def test_the_notes_of_the_loops() -> None:
    home = tr.PathScenario.load("roll-home-turned").run()
    assert home.is_closed
    says("roll-home-turned", f"{25 * math.pi / 2:.1f} mm", "at -y", "120 deg about the diagonal (1, 1, -1)")
    np.testing.assert_allclose(
        home.stages.north_pole.round(12), [[0, 0, 1], [1, 0, 0], [1, 0, 0], [0, 0, 1], [0, -1, 0]]
    )
    ratio = 5 / 25
    says("roll-small-loop", f"{360 * (math.hypot(1, ratio) - 1):.2f} deg", f"= {180 * ratio**2:.1f} deg")
    eight = tr.PathScenario.load("roll-figure-eight").run()
    chords = eight.sampled(1e-5).contact
    assert f"{100 * np.hypot(*np.diff(chords, axis=0).T).sum():.1f} cm" == "36.5 cm"
    says("roll-figure-eight", "36.5 cm long", f"{math.degrees(_by_chords(eight)):.1f} deg")


def _by_chords(rolled: tr.RolledPath) -> float:
    """The angle by which short chords of the path turn the ball, each a rotation by its length/a."""
    q = np.array([1.0, 0, 0, 0])
    for dx, dy in np.diff(rolled.sampled(1e-4).contact, axis=0):
        length = math.hypot(dx, dy)
        half = length / rolled.radius / 2
        w, x, y = math.cos(half), -dy / length * math.sin(half), dx / length * math.sin(half)
        a, b, c, d = q
        q = np.array([w * a - x * b - y * c, w * b + x * a + y * d, w * c - x * d + y * a, w * d + x * c - y * b])
    return 2 * math.atan2(math.hypot(*q[1:]), abs(q[0]))


@pytest.mark.parametrize("name", PathFile.names())
def test_each_has_notes_and_its_card_holds(name: str) -> None:
    scenario = tr.PathScenario.load(name)
    assert len(scenario.notes) > 200
    assert all(line == line.strip() for line in scenario.notes.splitlines())
    assert scenario.run().card().passed
