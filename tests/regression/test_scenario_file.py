"""A scenario file says what it means, keeps its own words, and names what is wrong with it."""

from __future__ import annotations

import json
import math
import pickle
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trundle.errors import ScenarioError, TrundleError
from trundle.mechanics.bodies import Body
from trundle.mechanics.loads import Drag, Force, Torque
from trundle.mechanics.motions import Fixed, Spin, UnevenSpin, Wobble
from trundle.mechanics.surfaces import Cylinder, Plane
from trundle.mechanics.system import RollingSystem, Support
from trundle.scenario import ScenarioFile

WHOLE = """
title = "Everything at once"
notes = "Look."
gravity = "1.62 m/s^2"

[body]
kind = "sphere"
radius = "25 mm"
mass = "65 g"
inertia_ratio = 0.5

[support]
kind = "plane"
tilt = "3 deg"
rim = "0.5 m"
friction = 0.3
[support.motion]
kind = "spin"
rate = "33.3 rpm"

[start]
position = ["10 cm", 0]
velocity = ["0 m/s", "20 cm/s"]
spin = "1 rad/s"
orientation = [0, 1, 0, 0]

[[loads]]
kind = "force"
value = ["0.1 N", 0, 0]
[[loads]]
kind = "torque"
value = [0, "2 mN*m", 0]
[[loads]]
kind = "drag"
coefficient = "1 g/s"

[run]
duration = "60 s"
every = "10 ms"
method = "taylor"
"""


def test_every_key_reaches_the_mechanics() -> None:
    scenario = ScenarioFile.loads(WHOLE)
    table = Support(Plane(rim=0.5), motion=Spin(33.3 * math.pi / 30), tilt=math.radians(3), friction=0.3)
    loads = (Force((0.1, 0, 0)), Torque((0, 0.002, 0)), Drag(0.001))
    expected = RollingSystem(Body.sphere(0.025, 0.065, 0.5), table, loads, gravity=1.62)
    system, start = scenario.system(), scenario.start_state()
    assert system.body == expected.body
    assert system.loads == expected.loads
    assert system.gravity == 1.62
    assert system.support.surface == Plane(rim=0.5)
    assert system.support.friction == 0.3
    assert system.support.tilt == pytest.approx(math.radians(3), rel=1e-15)
    assert system.support.motion.rate == pytest.approx(33.3 * math.pi / 30, rel=1e-15)
    assert start.position == (0.1, 0.0, 0.025)
    assert start.velocity == (0.0, 0.2, 0.0)
    assert start.angular_velocity[2] == 1.0
    assert start.orientation == (0.0, 1.0, 0.0, 0.0)
    assert (scenario.timing.duration, scenario.timing.every, scenario.timing.method) == (60.0, 0.01, "taylor")
    assert (scenario.title, scenario.notes) == ("Everything at once", "Look.")


LEAST = """
[body]
kind = "hollow-sphere"
radius = 1
mass = 2
[support]
kind = "plane"
[start]
position = [0, 0]
[run]
duration = 1
every = 0.1
"""


def test_what_is_left_out_has_its_default() -> None:
    scenario = ScenarioFile.loads(LEAST, "folder/my-table.toml")
    system, start = scenario.system(), scenario.start_state()
    assert scenario.title == "my-table"
    assert (system.gravity, system.loads, system.support) == (9.80665, (), Support(Plane(), motion=Fixed()))
    assert (start.velocity, start.angular_velocity) == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert start.orientation == (1.0, 0.0, 0.0, 0.0)
    assert scenario.timing.method == "auto"


def test_the_text_keeps_the_users_own_words() -> None:
    written = tomllib.loads(WHOLE)
    assert tomllib.loads(ScenarioFile.loads(WHOLE).to_toml()) == written
    assert ScenarioFile.loads(ScenarioFile.loads(WHOLE).to_toml()) == ScenarioFile.loads(WHOLE)
    assert "gravity" not in ScenarioFile.loads(LEAST).to_toml()


@pytest.mark.parametrize("notes", ["one line", "two\nlines", 'quotes """ and \\ in\nit', "\ttab", "a\n", "\n", "é°"])
def test_notes_survive_writing(notes: str) -> None:
    scenario = ScenarioFile.read({**tomllib.loads(LEAST), "notes": notes})
    assert ScenarioFile.loads(scenario.to_toml()).notes == notes


def test_a_file_on_disk(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(WHOLE, encoding="utf-8-sig")  # as Windows editors write it
    assert ScenarioFile.load(file) == ScenarioFile.load(str(file)) == ScenarioFile.loads(WHOLE)


def test_pickle_and_copy_keep_the_text() -> None:
    scenario = ScenarioFile.loads(WHOLE)
    again = pickle.loads(pickle.dumps(scenario))  # noqa: S301
    assert again.to_toml() == scenario.model_copy(deep=True).to_toml() == scenario.to_toml()


# --- describing a system ------------------------------------------------------------------------------------

THIRD = 1 / 3
BODIES = [
    Body.solid_sphere(radius=THIRD, mass=0.1 + 0.2),
    Body.hollow_sphere(radius=0.02, mass=0.0027),
    Body.sphere(radius=0.1, mass=1e-9, inertia_ratio=THIRD),
]
SUPPORTS = [
    Support(Plane()),
    Support(Plane(rim=math.pi), motion=Spin(-THIRD), tilt=0.1 * THIRD, friction=0.1 + 0.2),
]
STARTS: list[dict[str, Any]] = [
    {"position": (0.1 + 0.2, -THIRD), "velocity": (THIRD, 1e-17)},
    {"position": (0.1, 0.2), "velocity": "co-rotating", "spin": THIRD},
    {"position": (0.1, 0.2), "orientation": (0.1, 0.2, 0.3, THIRD)},
]


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("support", SUPPORTS)
@pytest.mark.parametrize("start", STARTS)
def test_a_described_system_reads_back_to_the_last_digit(body: Body, support: Support, start: dict[str, Any]) -> None:
    loads = (Force((THIRD, 0.0, -0.1)), Torque((0.0, 2e-3 * THIRD, 0.0)), Drag(THIRD))
    system = RollingSystem(body, support, loads, gravity=9.81)
    state = system.place(**start)
    told = ScenarioFile.describe(system, state, duration=THIRD, every=0.001, method="exact", title="A third")
    again = ScenarioFile.loads(told.to_toml())
    assert again.system() == system
    assert again.start_state() == state
    assert (again.timing.duration, again.timing.every, again.timing.method) == (THIRD, 0.001, "exact")
    assert again.title == "A third"


def test_a_start_given_by_its_whole_angular_velocity_is_described_as_such() -> None:
    system = RollingSystem(BODIES[0], SUPPORTS[1])
    rolling = system.place(position=(0.1, 0.2), velocity=(0.3, 0.4), spin=2.0)
    turning = tuple(part * (1 + 1e-11) for part in rolling.angular_velocity)
    state = system.place(position=(0.1, 0.2), velocity=(0.3, 0.4), angular_velocity=turning)
    told = ScenarioFile.describe(system, state, duration=1.0, every=0.1)
    assert told.start.angular_velocity == turning
    assert ScenarioFile.loads(told.to_toml()).start_state() == state


def test_what_the_format_has_no_words_for_is_refused_by_name() -> None:
    import numpy as np

    many = RollingSystem(Body.solid_sphere(radius=np.array([0.1, 0.2]), mass=1.0), Support(Plane()))
    start = RollingSystem(BODIES[0], SUPPORTS[0]).place((0.0, 0.0))
    with pytest.raises(ScenarioError, match=r"body\.radius.*one number"):
        ScenarioFile.describe(many, start, duration=1.0, every=0.1)

    class Wind(Force):
        pass

    windy = RollingSystem(BODIES[0], SUPPORTS[0], (Wind((1, 0, 0)),))
    with pytest.raises(ScenarioError, match=r"loads\[0\].*words for; got 'Wind'"):
        ScenarioFile.describe(windy, start, duration=1.0, every=0.1)


PIPES = [
    Support(Cylinder(THIRD * 2), motion=Wobble(0.0, 0.0), tilt=0.2),
    Support(Cylinder(0.5, "outside"), motion=Spin(THIRD), tilt=-math.pi / 2, friction=1.0),
    Support(Plane(), motion=UnevenSpin(3.5, 0.1 * THIRD, THIRD)),
    Support(Plane(rim=2.0), motion=Wobble(-3.5, 1e-3 * THIRD), tilt=0.1),
]


@pytest.mark.parametrize("support", PIPES)
def test_pipes_and_imperfect_tables_read_back_to_a_rounding_of_the_place(support: Support) -> None:
    # An angle is read off a place on a circle, so that a coordinate may come back a last digit off.
    loads = (Force((THIRD, "0.1*sin(3*t)", -0.1)), Torque(("t**2", 0.0, 0.0)), Drag(THIRD, air=-THIRD))
    system = RollingSystem(BODIES[0], support, loads)
    state = system.place((0.3, THIRD), (0.1, -0.2), spin=0.5)
    told = ScenarioFile.describe(system, state, duration=1.0, every=0.1)
    again = ScenarioFile.loads(told.to_toml())
    assert again.system() == system
    for name in ("position", "velocity", "angular_velocity", "orientation"):
        assert getattr(again.start_state(), name) == pytest.approx(getattr(state, name), rel=1e-15, abs=1e-15)


@pytest.mark.parametrize("support", [Support(Plane(), tilt=THIRD), Support(Cylinder(2.0), tilt=math.pi / 2)])
def test_a_cylinder_reads_back_with_its_roll(support: Support) -> None:
    system = RollingSystem(Body.cylinder(THIRD, 0.2, 0.8), support)
    state = system.place((0.3, 0.0), (-0.5, 0.0), roll=2.0)
    again = ScenarioFile.loads(ScenarioFile.describe(system, state, duration=1.0, every=0.1).to_toml())
    assert again.system() == system
    assert again.start_state().orientation == pytest.approx(state.orientation, abs=1e-15)
    assert again.start_state().angular_velocity == pytest.approx(state.angular_velocity, abs=1e-14)


def test_a_weighted_cylinder_has_its_words() -> None:
    text = """
    body = {kind = "weighted-cylinder", radius = "5 cm", mass = "300 g", weight = "100 g", distance = "4 cm"}
    support = {kind = "plane", tilt = "5 deg"}
    start = {position = [0, 0], roll = "90 deg"}
    run = {duration = 1, every = 0.1}
    """
    scenario = ScenarioFile.loads(text)
    assert scenario.system().body == Body.weighted_cylinder(0.05, 0.3, 0.1, 0.04)
    assert scenario.start_state() == scenario.system().place((0.0, 0.0), roll=math.pi / 2)


def test_air_may_stand_turn_along_or_have_a_rate() -> None:
    text = WHOLE.replace('coefficient = "1 g/s"', 'coefficient = "1 g/s"\nair = {}')
    rate = ScenarioFile.loads(WHOLE).support.motion.rate
    for word, wanted in [('"still"', 0.0), ('"turning"', rate), ('"2 rad/s"', 2.0), ("-1.5", -1.5)]:
        assert ScenarioFile.loads(text.replace("{}", word)).system().loads[2].air == wanted


@given(st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: math.hypot(*q) > 1e-3))
def test_a_described_orientation_stays_to_the_last_digit(orientation: tuple[float, ...]) -> None:
    system = RollingSystem(BODIES[0], SUPPORTS[0])
    state = system.place((0.0, 0.0), orientation=orientation)
    told = ScenarioFile.describe(system, state, duration=1.0, every=0.1)
    assert ScenarioFile.loads(told.to_toml()).start_state() == state


# --- bad input ----------------------------------------------------------------------------------------------

RADIUS = 'radius = "25 mm"'
VELOCITY = 'velocity = ["0 m/s", "20 cm/s"]'
BAD = [  # (what stands in the file, what comes instead, the key, the value, the remedy or rule)
    # unknown and missing keys
    (RADIUS, 'radios = "25 mm"', "body.radios", "'25 mm'", "Did you mean 'radius'? There are: kind, radius"),
    (RADIUS, "", "body.radius", "nothing", 'radius = "25 mm"'),
    ('kind = "sphere"', "", "body.kind", "nothing", "solid-sphere, hollow-sphere, sphere"),
    ('kind = "sphere"', 'kind = "spere"', "body.kind", "'spere'", "Did you mean 'sphere'?"),
    ('kind = "sphere"', "kind = 3", "body.kind", "3", "There are: solid-sphere"),
    ('kind = "sphere"', 'kind = "solid-sphere"', "body.inertia_ratio", "0.5", "is no key of [body]"),
    ("inertia_ratio = 0.5", "", "body.inertia_ratio", "nothing", "inertia_ratio = 0.4"),
    ('kind = "plane"', 'kind = "saddle"', "support.kind", "'saddle'", "There are: plane"),
    ('kind = "plane"', "", "support.kind", "nothing", 'kind = "plane"'),
    ('kind = "spin"', 'kind = "fixed"', "support.motion.rate", "'33.3 rpm'", "There are: kind"),
    ('kind = "drag"', 'kind = "dragg"', "loads[2].kind", "'dragg'", "Did you mean 'drag'?"),
    ("coefficient", "coeficient", "loads[2].coeficient", "'1 g/s'", "There are: kind, coefficient"),
    ("[body]", "[bodi]", "bodi", "{'kind'", "Did you mean 'body'?"),
    (WHOLE[WHOLE.index("[run]") :], "", "run", "nothing", "duration"),
    # dimensions, texts, non-numbers
    (RADIUS, 'radius = "25 g"', "body.radius", "'25 g'", "must be a length"),
    (RADIUS, 'radius = "wide"', "body.radius", "'wide'", "25 mm"),
    (RADIUS, "radius = true", "body.radius", "True", "must be a length"),
    (RADIUS, "radius = [1]", "body.radius", "[1]", "must be a length"),
    (RADIUS, "radius = {m = 1}", "body.radius", "{'m': 1}", "must be a length"),
    (RADIUS, "radius = 1979-05-27", "body.radius", "1979", "A date is no quantity"),
    (RADIUS, "radius = 07:32:00", "body.radius", "time", "A date is no quantity"),
    (RADIUS, "radius = nan", "body.radius", "nan", "finite"),
    (RADIUS, "radius = inf", "body.radius", "inf", "finite"),
    (RADIUS, 'radius = "-inf m"', "body.radius", "'-inf m'", "finite"),
    (RADIUS, "radius = 0x" + "f" * 5000, "body.radius", "an integer", "finite"),
    ('"2 mN*m"', '"2 mN"', "loads[1].value[1]", "'2 mN'", "must be a torque"),
    ('["0.1 N", 0, 0]', '["0.1 N", 0]', "loads[0].value", "['0.1 N', 0]", "a list of 3"),
    ('["0.1 N", 0, 0]', '"0.1 N"', "loads[0].value", "'0.1 N'", "a list of 3"),
    ('"33.3 rpm"', '"33.3 Hz"', "support.motion.rate", "'33.3 Hz'", "turn/s"),
    ('title = "Everything at once"', "title = 3", "title", "3", "must be text"),
    ('notes = "Look."', 'notes = "\\u001b[2J"', "notes", "x1b", "control characters"),
    ('title = "', 'title = "\\n', "title", "\\n", "one line"),
    # signs and bounds
    (RADIUS, "radius = 0", "body.radius", "0", "must be positive"),
    (RADIUS, 'radius = "-2 mm"', "body.radius", "'-2 mm'", "must be positive"),
    ('"65 g"', "0", "body.mass", "0", "must be positive"),
    ('"65 g"', '"-1 kg"', "body.mass", "'-1 kg'", "must be positive"),
    ('"60 s"', "0", "run.duration", "0", "must be positive"),
    ('"60 s"', "-1", "run.duration", "-1", "must be positive"),
    ('"10 ms"', "0.0", "run.every", "0.0", "must be positive"),
    ('"10 ms"', '"-10 ms"', "run.every", "'-10 ms'", "must be positive"),
    ('"10 ms"', '"2 min"', "run.every", "'2 min'", "must not be longer than the run"),
    (RADIUS, "radius = 1e-200", "body.radius", "1e-200", "Check the unit"),
    ('"65 g"', "1e200", "body.mass", "1e+200", "Check the unit"),
    ("inertia_ratio = 0.5", "inertia_ratio = 0.7", "body.inertia_ratio", "0.7", "(0, 2/3]"),
    ("inertia_ratio = 0.5", "inertia_ratio = 0", "body.inertia_ratio", "0", "(0, 2/3]"),
    ("friction = 0.3", "friction = -0.3", "support.friction", "-0.3", "must not be negative"),
    ('"1.62 m/s^2"', "-9.8", "gravity", "-9.8", "must not be negative"),
    ('"1 g/s"', "-1", "loads[2].coefficient", "-1", "must not be negative"),
    ('"0.5 m"', '"5 cm"', "start.position", "['10 cm', 0.0]", "inside the rim at 0.05 m"),
    ('"3 deg"', '"90 deg"', "support.tilt", "'90 deg'", "(-90 deg, 90 deg)"),
    ('"3 deg"', '"-172 deg"', "support.tilt", "'-172 deg'", "(-90 deg, 90 deg)"),
    ('"3 deg"', "3", "support.tilt", "3", 'Did you mean "3 deg"?'),
    ('"3 deg"', '"3 rad"', "support.tilt", "'3 rad'", 'Did you mean "3 deg"?'),
    # starts that contradict themselves
    (VELOCITY, "angular_velocity = [0, 0, 0]", "start.angular_velocity", "[0.0, 0.0, 0.0]", "beside `spin`"),
    (
        "friction = 0.3",
        "kinetic_friction = 0.3",
        "support.kinetic_friction",
        "0.3",
        "must stand beside `friction`",
    ),
    ("friction = 0.3", "friction = 0.3\nkinetic_friction = 0.4", "support.kinetic_friction", "0.4", "at most"),
    ("friction = 0.3", "restitution = 1.5", "support.restitution", "1.5", "[0, 1]"),
    ("friction = 0.3", "restitution = -0.5", "support.restitution", "-0.5", "must not be negative"),
    ("orientation = [0, 1, 0, 0]", "attitude = [0, 1]", "start.attitude", "[0, 1]", "a list of 3"),
    ("orientation = [0, 1, 0, 0]", 'attitude = [0, "1 m", 0]', "start.attitude[1]", "'1 m'", "must be an angle"),
    ("[0, 1, 0, 0]", "[0, 1, 0, 0]\nattitude = [0, 1, 0]", "start.attitude", "[0.0, 1.0, 0.0]", "`orientation`"),
    ("[0, 1, 0, 0]", '[0, 1, 0, 0]\nheight = "-1 cm"', "start.height", "'-1 cm'", "must not be negative"),
    (VELOCITY, 'velocity = ["1 m/s"]', "start.velocity", "['1 m/s']", "a list of 2 or 3"),
    (VELOCITY, 'velocity = [0, 0, "1 m"]', "start.velocity[2]", "'1 m'", "must be a velocity"),
    (VELOCITY, 'velocity = "roll"', "start.velocity", "'roll'", 'must be a list of 2 or 3, "co-rotating" or "rolling"'),
    (VELOCITY, 'velocity = "corotating"', "start.velocity", "'corotating'", "Did you mean 'co-rotating'?"),
    ("[0, 1, 0, 0]", "[0, 0, 0, 0]", "start.orientation", "[0.0, 0.0", "[1, 0, 0, 0]"),
    # what belongs to another surface, body or load
    ('["10 cm", 0]', '["10 deg", 0]', "start.position[0]", "'10 deg'", "must be a length"),
    (
        'kind = "plane"',
        'kind = "cylinder"\nradius = 1',
        "support.rim",
        "'0.5 m'",
        "There are: kind, radius, diameter, side",
    ),
    ('kind = "sphere"', 'kind = "hoop"', "body.inertia_ratio", "0.5", "is no key of [body]"),
    ('coefficient = "1 g/s"', 'coefficient = "1 g/s"\nair = "windy"', "loads[2].air", "'windy'", "angular velocity"),
    ('"2 mN*m"', '"sinh(t)"', "loads[1].value[1]", "'sinh(t)'", "must be a formula in t"),
    ('spin = "1 rad/s"', 'spin = "1 rad/s"\nroll = 1', "start.roll", "1", "belongs to a cylinder"),
    # samples and methods
    ('"60 s"', "1e10", "run.every", "", "1,000,000,000,001"),
    ('"taylor"', '"tailor"', "run.method", "'tailor'", "Did you mean 'taylor'?"),
    ('"taylor"', "4", "run.method", "4", "runge-kutta"),
    # no TOML
    (RADIUS, "radius = 25 mm", "line 8, column 13", "'radius = 25 mm'", 'radius = "25 mm"'),
    (RADIUS, 'radius = "25 mm', "line 8", "'radius = \"25 mm'", "quotes"),
    (RADIUS, RADIUS + "\n" + RADIUS, "line 9", "'radius = \"25 mm\"'", "valid TOML"),
    ("[body]", "[body", "line 6", "'[body'", "valid TOML"),
    (WHOLE, "a", "line 1", "'a'", "key = value"),
    (WHOLE, "  \n ", "scenario", "", "trundle show"),
    (RADIUS, "radius = " + "[" * 5000, "scenario", "", "nest"),
    (RADIUS, "radius = " + "9" * 5000, "scenario", "", "thousands of digits"),
]


def test_a_start_that_slips_needs_a_support_that_says_how_rough_it_is() -> None:
    smooth = WHOLE.replace("friction = 0.3\n", "")
    slipping = ('spin = "1 rad/s"', "angular_velocity = [0, 0, 0]")
    with pytest.raises(ScenarioError, match=r"start\.angular_velocity.*agree with rolling.*friction.*slip of"):
        ScenarioFile.loads(smooth.replace(*slipping))
    assert ScenarioFile.loads(WHOLE.replace(*slipping)).start_state().angular_velocity == (0.0, 0.0, 0.0)


def test_a_disc_is_not_put_down_flat() -> None:
    lying = LEAST.replace('"hollow-sphere"', '"disc"')
    with pytest.raises(ScenarioError, match=r"start\.orientation.*one point.*`attitude`"):
        ScenarioFile.loads(lying)
    standing = ScenarioFile.loads(lying.replace("position = [0, 0]", 'position = [0, 0]\nattitude = [0, "90 deg", 0]'))
    assert standing.start_state().position == (0.0, 0.0, 1.0)


@pytest.mark.parametrize(("there", "instead", "key", "value", "said"), BAD)
def test_one_message_names_key_value_and_remedy(there: str, instead: str, key: str, value: str, said: str) -> None:
    assert WHOLE.count(there) == 1
    with pytest.raises(ScenarioError) as caught:
        ScenarioFile.loads(WHOLE.replace(there, instead), "my.toml")
    message = str(caught.value)
    assert message.startswith(f"my.toml: `{key}")
    assert value in message.partition("; got ")[2]
    assert said in message
    assert "\n" not in message
    assert message.isprintable()
    assert "error" not in message.replace("ScenarioError", "")  # one thing is wrong, and one is told


def test_all_errors_of_a_file_are_told_a_line_each() -> None:
    text = WHOLE.replace('"65 g"', "-1").replace('"60 s"', '"60 m"').replace("friction", "frictoin")
    with pytest.raises(ScenarioError) as caught:
        ScenarioFile.loads(text, "my.toml")
    assert caught.value.key == "support.frictoin"
    assert [other.key for other in caught.value.others] == ["body.mass", "run.duration"]
    lines = str(caught.value).split("\n")
    assert [re.findall(r"^my.toml: `(.*?)` .*; got .+", line) for line in lines] == [
        ["support.frictoin"],
        ["body.mass"],
        ["run.duration"],
    ]
    again = pickle.loads(pickle.dumps(caught.value))  # noqa: S301
    assert (str(again), again.others[1].key) == (str(caught.value), "run.duration")


START = 'position = ["10 cm", 0]'
SPIN = 'spin = "1 rad/s"\norientation = [0, 1, 0, 0]'


@pytest.mark.parametrize(
    ("changes", "keys"),
    [
        ({START: 'position = ["10 kg", "x"]'}, ["start.position[0]", "start.position[1]"]),
        ({START: 'position = ["10 deg", "20 deg"]'}, ["start.position[0]", "start.position[1]"]),
        (
            {SPIN: "spin = 1\nangular_velocity = [0, 0, 0]\norientation = [0, 0, 0, 0]"},
            ["start.angular_velocity", "start.orientation"],
        ),
        (
            {START: 'position = ["10 kg", 0]', '"65 g"': "0", '"10 ms"': "0"},
            ["body.mass", "start.position[0]", "run.every"],
        ),
        ({'kind = "sphere"': 'kind = "solid"', '"10 ms"': "0"}, ["body.kind", "run.every"]),
    ],
)
def test_mistakes_that_do_not_hide_each_other_are_all_told(changes: dict[str, str], keys: list[str]) -> None:
    text = WHOLE
    for there, instead in changes.items():
        assert text.count(there) == 1
        text = text.replace(there, instead)
    with pytest.raises(ScenarioError) as caught:
        ScenarioFile.loads(text)
    assert [caught.value.key, *(other.key for other in caught.value.others)] == keys
    assert str(caught.value).count("\n") == len(keys) - 1


def test_of_very_many_errors_the_rest_is_counted() -> None:
    with pytest.raises(ScenarioError) as caught:
        ScenarioFile.loads(WHOLE + "".join(f"\n[wrong{i}]" for i in range(50)))
    lines = str(caught.value).split("\n")
    assert len(lines) == 21
    assert lines[-1].endswith("30 more errors like these.")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("nothing-like-it", "tilted-turntable"),
        ("tilted-turntabel", "Did you mean 'tilted-turntable'?"),
        ("folder/tilted-turntable.toml", "Did you mean 'tilted-turntable', the one that ships"),
        ("hollow", "Did you mean 'hollow-ball-turntable'?"),
        ("null\0character", "must be a file"),
        ("", "folder"),
        ("x" * 5000, "must be a file"),
    ],
)
def test_a_file_that_is_not_there(name: str, said: str) -> None:
    with pytest.raises(ScenarioError, match=r"`scenario` must be a file") as caught:
        ScenarioFile.load(name)
    assert said in str(caught.value)


def test_files_that_are_no_text(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="folder"):
        ScenarioFile.load(tmp_path)
    file = tmp_path / "file.toml"
    for content, said in [
        (b"title = 'a'\n\xff", "byte 0xff in line 2"),
        (WHOLE.encode("utf-16"), "UTF-16"),
        (b"", "must hold a scenario"),
        (b"#" * (2**20 + 1), "at most 1 MiB"),
    ]:
        file.write_bytes(content)
        with pytest.raises(ScenarioError, match=said):
            ScenarioFile.load(file)
    with pytest.raises(ScenarioError, match="must be a file"):
        ScenarioFile.load(file / "below")


# --- for editors, and in no time ----------------------------------------------------------------------------


def fits(value: Any, schema: dict[str, Any], whole: dict[str, Any]) -> bool:
    """Judge by the few words of JSON schema that the scenario schema uses."""
    if "$ref" in schema:
        return fits(value, whole["$defs"][schema["$ref"].rpartition("/")[2]], whole)
    for part in schema.get("allOf", ()):  # one of radius and diameter
        if sum(each["required"][0] in value for each in part["oneOf"]) != 1:
            return False
    if "anyOf" in schema or "oneOf" in schema:
        return any(fits(value, each, whole) for each in schema.get("anyOf") or schema["oneOf"])
    if "const" in schema or "enum" in schema:
        return value in schema.get("enum", [schema.get("const")])
    if schema["type"] == "object":
        known = schema["properties"]
        return (
            isinstance(value, dict)
            and value.keys() <= known.keys()
            and value.keys() >= set(schema.get("required", ()))
            and all(fits(value[key], known[key], whole) for key in value)
        )
    if schema["type"] == "array":
        right_size = isinstance(value, list) and schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", 99)
        return right_size and all(fits(each, schema["items"], whole) for each in value)
    if schema["type"] == "number":
        return isinstance(value, (int, float)) and value > schema.get("exclusiveMinimum", -math.inf)
    return isinstance(value, {"string": str, "null": type(None)}[schema["type"]])


def test_the_schema_fits_what_loads_and_not_what_does_not() -> None:
    schema = json.loads(json.dumps(ScenarioFile.schema()))
    assert schema["$schema"].startswith("https://json-schema.org/")
    for text in (WHOLE, LEAST, WHOLE.replace(RADIUS, 'diameter = "50 mm"')):
        assert fits(tomllib.loads(text), schema, schema)
    for there, instead in [
        (RADIUS, ""),
        (RADIUS, "radius = 0"),
        (RADIUS, f"{RADIUS}\ndiameter = 1"),
        ("[body]", "[bodi]"),
        ('"taylor"', '"x"'),
    ]:
        assert not fits(tomllib.loads(WHOLE.replace(there, instead)), schema, schema)


def test_loading_needs_neither_pint_nor_a_solver() -> None:
    code = (
        "import sys; from trundle.scenario import ScenarioFile; ScenarioFile.load('tilted-turntable')\n"
        "heavy = ('pint', 'heyoka', 'xarray', 'matplotlib', 'sympy', 'scipy')\n"
        "print([name for name in heavy if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)  # noqa: S603
    assert done.stdout == "[]\n"


def test_a_refusal_is_a_trundle_error_and_a_value_error() -> None:
    assert issubclass(ScenarioError, TrundleError)
    assert issubclass(ScenarioError, ValueError)
