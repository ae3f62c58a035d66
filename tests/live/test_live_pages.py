"""Live pages: their motions are those of `simulate`, and what no page can compute is refused in words."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import trundle as tr
from trundle.analysis.sensitivities.keys import chosen, moved
from trundle.cli import run as command
from trundle.errors import InvalidValueError, OutOfDomainError
from trundle.live import law, live_page
from trundle.live.sliders import sliders_of
from trundle.live.start import Placed
from trundle.views.scene.curves import curves_of

from .accuracy import BOUND, Compared, compared

# Of every kind: closed forms and numerical runs, rolling, slipping, flight, the rim, a support that turns by itself.
SAMPLE = {
    "tilted-turntable": ["body.radius", "support.tilt"],
    "ball-in-a-turning-bowl": ["support.radius"],
    "billiard-swerve": ["support.friction"],
    "superball": ["start.height"],
    "off-the-rim": ["support.motion.rate"],
    "free-turntable-ellipse": ["support.motion.inertia"],
    "coin-in-a-circle": ["start.attitude[1]"],
    "tippe-top": [],
}


@pytest.mark.parametrize("name", SAMPLE)
def test_the_motion_in_the_page_is_the_run(name: str) -> None:
    """`python -m tests.live.accuracy` compares all scenarios at the ends of all sliders that are offered."""
    scenario = tr.Scenario.load(name)
    asked = SAMPLE[name] or ["start.angular_velocity[2]=150..160 rad/s"]
    for one in compared(scenario, asked):
        assert not one.refused
        assert one.apart <= BOUND, one.where
        assert one.alike, one.where
        assert_headline_is_the_servers(one)
        assert_curves_are_the_servers(one)


def assert_headline_is_the_servers(one: Compared) -> None:
    """The same sentence, and both its numbers: the page has samples of its own, at other instants."""
    told, wanted = one.told["headline"], one.headline
    if told["said"] != wanted["said"]:
        # The page keeps the sentence of the file where the server has that of another formula, or none.
        assert told["said"] == one.of_file, one.where
        return
    assert told["predicted"] <= wanted["predicted"]
    for key in ("text", "other"):
        assert _number(told[key]) == pytest.approx(_number(wanted[key]), rel=2e-3, abs=1e-9), (one.where, key)
        assert re.sub(r"[\d.−]+", "#", told[key]) == re.sub(r"[\d.−]+", "#", wanted[key])


def _number(text: str) -> float:
    found = re.search(r"−?\d+(?:\.\d+)?", text)
    assert found is not None
    return float(found[0].replace("−", "-"))


def assert_curves_are_the_servers(one: Compared) -> None:
    """All that the server draws of this motion, from the same instants."""
    assert one.run is not None
    times, rows = np.array(one.told["time"]), np.array(one.told["rows"], dtype=float)
    both = np.intersect1d(times, one.run.data.time.values)
    at = one.run.samples.part(np.flatnonzero(np.isin(one.run.samples.time, both)))
    told, columns = curves_of(one.run.system, at)
    shown = {each["column"]: each for each in law.curves_of(one.run.system)}
    # A speed of slip that never comes is not offered, neither here nor there.
    assert {each["column"] for each in told} - {"curve_slip"} == set(shown) - {"curve_slip"}
    mine = rows[np.isin(times, both)]
    for column, values in columns.items():
        known = np.isfinite(values)
        size = float(np.max(np.abs(values[known]), initial=0.0))
        apart = np.abs(mine[:, shown[column]["index"]] - values)[known]
        assert apart.max(initial=0.0) <= 2e-6 * max(size, 1e-3), (one.where, column)


def test_where_friction_gives_way_the_film_stops_and_says_so() -> None:
    _, low, _ = compared(tr.Scenario.load("ball-in-a-trough"), ["support.tilt=45 deg..90 deg"])
    assert low.run is not None
    slip = next(event for event in low.run.events if event.kind == "slip")
    assert low.told["ended"]["kind"] == "slip"
    assert low.told["ended"]["time"] == pytest.approx(slip.time, rel=1e-9)
    assert "slip" in low.told["ended"]["text"]
    assert low.apart <= BOUND


def test_a_page_follows_a_body_that_slips_and_is_kept_from_turning() -> None:
    tables = tr.Scenario.load("billiard-draw").model_dump(exclude_unset=True, exclude_none=True, by_alias=True)
    tables["loads"] = [{"kind": "rolling-resistance", "offset": "25 mm"}]
    tables["start"] = {**tables["start"], "angular_velocity": [0, "-1 turn/s", 0]}
    (one,) = compared(tr.Scenario.read(tables))[:1]
    assert one.run is not None
    told = [event["text"].partition(" at ")[0] for event in one.told["events"]]
    assert told == ["Stopped turning as it slipped", "Came to rest"]
    times = [event["time"] for event in one.told["events"]]
    assert times == pytest.approx([event.time for event in one.run.events], rel=1e-9)
    assert one.apart <= BOUND
    assert one.alike


@pytest.mark.parametrize("name", ["rattleback", "ball-in-a-funnel", "eulers-disc", "turntable-drop"])
def test_a_moved_slider_places_the_start_anew(name: str) -> None:
    """Placed on the tape at other numbers, the start is that of a scenario with these numbers."""
    scenario = tr.Scenario.load(name)
    sliders, placed = sliders_of(scenario, [])
    draw = np.random.default_rng(seed=7)
    for _ in range(5):
        values = {one.key.name: float(draw.uniform(one.low, one.high)) for one in sliders}
        system, start = moved(scenario, values)
        wanted = system.vector_field("numpy", placed.phase).pack(start)
        found = placed.at(list(values.values()))
        assert np.allclose(found[: placed.size], wanted, rtol=1e-12, atol=1e-12)
        assert np.allclose(found[placed.size :], system.vector_field("numpy").parameters, rtol=1e-14, atol=0)


BY_FORMULA = {"tilted-turntable": "T5", "golfers-dilemma": "T7", "cylinder-on-incline": "T5", "tippe-top": None}


@pytest.mark.parametrize("name", BY_FORMULA)
def test_where_a_closed_form_can_be_printed_the_page_has_it(name: str) -> None:
    """By it the place is right to rounding, also where a slider takes the motion to another of its cases."""
    scenario = tr.Scenario.load(name)
    sliders, placed = sliders_of(scenario, [])
    text = law.script_of(scenario, [one.key for one in sliders], placed)
    assert (placed.form and placed.form.equation) == BY_FORMULA[name]
    assert ("function rolling_by_formula_rates(" in text) == (placed.form is not None)
    assert placed.form is None or max(one.apart for one in compared(scenario)) < 1e-14


def test_where_a_slider_leads_out_of_a_closed_form_the_law_is_followed() -> None:
    """The golf ball's is that of an upright cylinder; another has that of one that leans."""
    scenario = tr.Scenario.load("golfers-dilemma")
    tables = scenario.model_dump(exclude_unset=True, exclude_none=True, by_alias=True)
    upright = tr.Scenario.read({**tables, "support": {**tables["support"], "tilt": 0.0}})
    _, placed = sliders_of(upright, ["support.tilt=0 deg..1 deg"])
    assert placed.form is None
    assert max(one.apart for one in compared(upright, ["support.tilt=0 deg..1 deg"])) < BOUND


def test_a_start_that_would_be_decided_otherwise_is_refused() -> None:
    """What is decided by numbers on the way holds for those of the file; elsewhere the two are compared."""
    scenario = tr.Scenario.load("weighted-cylinder-on-incline")
    placed = Placed.of(scenario, chosen(scenario, ["start.roll"]))
    with pytest.raises(OutOfDomainError, match="placed otherwise"):
        placed.check(scenario, {"start.roll": 0.5 * float(scenario.start.roll)})


REFUSED = {
    "a path has no law": ["roll-figure-eight", "page.html", "--live"],
    "another form": ["tilted-turntable", "page.glb", "--live"],
    "several": ["tilted-turntable", "rattleback", "page.html", "--live"],
    "no page to move it in": ["tilted-turntable", "page.html", "--slider", "body.radius"],
    "no such number": ["tilted-turntable", "page.html", "--live", "--slider", "body.redius"],
    "the clock": ["turntable-starting-up", "page.html", "--live", "--slider", "start.time=0 s..1 s"],
    "a formula": ["turntable-starting-up", "page.html", "--live", "--slider", "support.motion.rate"],
    "downwards": ["tilted-turntable", "page.html", "--live", "--slider", "support.tilt=1deg..0deg"],
    "no unit": ["tilted-turntable", "page.html", "--live", "--slider", "support.tilt=0..2"],
    "no span": ["tilted-turntable", "page.html", "--live", "--slider", "support.tilt="],
    "half a span": ["tilted-turntable", "page.html", "--live", "--slider", "support.tilt=1deg"],
    "without its value": ["tilted-turntable", "page.html", "--live", "--slider", "support.tilt=1deg..2deg"],
    "beyond the rim": ["tilted-turntable", "page.html", "--live", "--slider", "start.position[0]=-1 m..0 m"],
    "no length": ["tilted-turntable", "page.html", "--live", "--slider", "body.radius=1 s..2 s"],
}


@pytest.mark.parametrize("arguments", REFUSED.values(), ids=REFUSED)
def test_what_no_page_can_compute_is_refused_in_words(
    arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert command(["export", *arguments]) == 2
    assert list(tmp_path.iterdir()) == []
    told = capsys.readouterr().err
    assert told.startswith("trundle: ")
    assert "Traceback" not in told


def test_a_kink_in_the_time_is_refused() -> None:
    scenario = tr.Scenario.load("turntable-starting-up")
    motion = {"kind": "spin-by", "rate": "abs(t - 1)"}
    tables = {**scenario.model_dump(exclude_unset=True, exclude_none=True, by_alias=True)}
    tables["support"] = {**tables["support"], "motion": motion}
    with pytest.raises(OutOfDomainError, match="kink"):
        law.check(tr.Scenario.read(tables))


def test_the_page_evaluates_nothing_and_asks_for_nothing() -> None:
    page = live_page(tr.Scenario.load("off-the-rim"), ["support.motion.rate=10 rpm..80 rpm"]).decode()
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', page)
    assert policy is not None
    assert "default-src 'none'" in policy[1]
    assert "worker-src blob:" in policy[1]
    assert "unsafe" not in policy[1]
    assert len(page.encode()) < 1_500_000
    held = page.partition("data-trundle-law>")[2].partition("</script>")[0]
    assert "const law =" in held
    assert not re.search(r"\beval\(|\bFunction\(|importScripts|fetch\(", held)
    assert not re.search(r"""(?:src|href)=["']?(?:https?:)?//""", page)


def test_the_labels_are_those_of_the_file() -> None:
    (one,), _ = sliders_of(tr.Scenario.load("tilted-turntable"), ["support.motion.rate=20 rpm..45 rpm"])
    assert (one.label, one.group, one.unit) == ("Rate", "support motion", "rpm")
    assert one.low / one.factor == pytest.approx(20.0, rel=1e-14)


@pytest.mark.parametrize("span", ["20..45 rpm", "20 rpm..45", "20 rpm .. 45 rpm"])
def test_a_unit_that_stands_once_stands_for_both_ends(span: str) -> None:
    (one,), _ = sliders_of(tr.Scenario.load("tilted-turntable"), [f"support.motion.rate={span}"])
    assert (one.low / one.factor, one.high / one.factor) == pytest.approx((20.0, 45.0), rel=1e-14)


def test_the_example_in_a_refusal_is_no_refusal_itself() -> None:
    scenario = tr.Scenario.load("tilted-turntable")
    with pytest.raises(InvalidValueError) as refused:
        sliders_of(scenario, ["support.tilt=0..2"])
    example = re.search(r'--slider "(.*)"', refused.value.remedy)
    assert example is not None
    sliders_of(scenario, [example[1]])


def test_too_many_sliders_are_refused() -> None:
    scenario = tr.Scenario.load("rattleback")
    with pytest.raises(InvalidValueError, match="at most 8"):
        sliders_of(scenario, ["body.semi_axes", "start.angular_velocity", "start.attitude"])


def test_the_page_has_no_sentence_that_the_server_has_not() -> None:
    """One that is worded anew in Python, and not there, would be told of no motion any more."""
    package = Path(tr.__file__).parent
    sources = [package / "views/scene/headline.py", *(package / "solve/exact").glob("*.py")]
    said = set(re.findall(r'"([^"\n]*\{\}[^"\n]*)"', "".join(path.read_text(encoding="utf-8") for path in sources)))
    source = (Path(__file__).parents[2] / "web/src/live/headline.ts").read_text(encoding="utf-8")
    here = {one or other for one, other in re.findall(r"'([^'\n]*\{\}[^'\n]*)'|\"([^\"\n]*\{\}[^\"\n]*)\"", source)}
    assert len(here) > 20
    assert here - said - {"{}"} == set()
