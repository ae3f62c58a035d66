"""What a loop is said to do to a ball that is rolled along it: against the whole rotation, of which it is a part."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import pytest

import trundle as tr
from trundle.analysis.geometry.scene import rolled_scene

DOWN = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


def eight(size: float, radius: float) -> tr.RolledPath:
    """A figure of eight of two circles, rolled along by a ball."""
    lobes = [tr.Arc(radius=size, angle=angle, heading=0.0) for angle in (2 * math.pi, -2 * math.pi)]
    return tr.roll_along(lobes, radius=radius)


def square(size: float, radius: float) -> tr.RolledPath:
    ways = [tr.Straight(heading=k * math.pi / 2, length=size) for k in range(4)]
    return tr.roll_along(ways, radius=radius)


@pytest.mark.parametrize("size", [0.01, 0.1, 0.3, 1.0, math.pi / 2, 3.0])
@pytest.mark.parametrize("loop", [square, eight])
def test_a_loop_is_said_to_turn_the_ball_by_the_whole_angle(loop: Callable[..., tr.RolledPath], size: float) -> None:
    rolled = loop(0.03 * size, 0.03)
    header = rolled_scene(rolled).header
    said = header["headline"]
    assert said["text"].startswith("comes home turned by ")
    assert told(said["text"]) == pytest.approx(rolled.rotation.angle, rel=1e-3)
    if said["other"] is not None:  # a rule that stands beside it is one that holds
        assert told(said["other"]) == pytest.approx(rolled.rotation.angle, rel=0.1)
    psi = next(row for row in header["findings"] if row["symbol"] == r"\psi")
    assert psi["difference"] is None or psi["difference"] < 0.1
    assert (header["formula"] is None) == (psi["predicted"] is None)


def told(text: str) -> float:
    """The angle in a text, rad."""
    found = re.search(r"([\d.]+)(?:°|·10(\S+) rad)", text)
    assert found, text
    return float(found[1]) * (10.0 ** int(found[2].translate(DOWN)) if found[2] else math.radians(1.0))


@pytest.mark.parametrize("size", [0.01, 0.3, 3.0])
def test_a_figure_of_eight_encloses_nothing_and_turns_nothing_about_the_normal(size: float) -> None:
    rolled = eight(0.03 * size, 0.03)
    assert rolled.enclosed_area == 0
    rows = {row["symbol"]: row["measured"] for row in rolled_scene(rolled).header["findings"]}
    assert rows["A"] == 0
    assert rows[r"\psi"] == 0
    assert "of that" not in str(rolled.card())


@pytest.mark.parametrize("name", ["roll-figure-eight", "roll-home-turned", "roll-small-loop"])
def test_notes_and_headline_of_a_loop_say_the_same(name: str) -> None:
    scenario = tr.PathScenario.load(name)
    angle = re.search(r"([\d.]+) deg", scenario.notes.split("turned", 1)[1].replace("\n", " "))
    assert angle
    said = rolled_scene(scenario.run()).header["headline"]["text"]
    assert told(said) == pytest.approx(math.radians(float(angle[1])), rel=1e-3)
