"""What a notebook shows of every result: HTML of our own making only, the verdict in words, the numbers of the text."""

from __future__ import annotations

import importlib
import inspect
import math
import pkgutil
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from html import unescape
from typing import Any

import numpy as np
import pytest
import sympy as sp
from IPython.core.interactiveshell import InteractiveShell

import trundle as tr
from trundle import verify
from trundle.analysis.checking import Mistake
from trundle.analysis.fit import Alternative, Alternatives
from trundle.display import Displayed, Headline, markup
from trundle.tracks.film.calibration import Calibration, Turning
from trundle.tracks.film.pinhole import PinholeCamera
from trundle.verify import CardFigure

TITLE = "<script>alert('½ & \"two\"')</script>"
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:e[+-]?\d+)?")
# What only the classes below it are: nobody gets one.
INNER = {"Plottable", "Serializable", "Viewable", "Document", "ScenarioFile", "PathFile", "Printed"}


@cache
def scenario(name: str) -> tr.Scenario:
    """A shipped one under a title that must not be taken for markup."""
    return tr.Scenario.load(name).model_copy(update={"title": TITLE})


@cache
def run() -> tr.Trajectory:
    return scenario("tilted-turntable").run(duration=2.0)


@cache
def billiards() -> tr.Trajectory:
    return scenario("billiard-draw").run()


@cache
def checked() -> tr.Check:
    degrees = run().data.assign(angular_velocity=run().data.angular_velocity * (180 / math.pi))
    return tr.check(replace(run(), data=degrees), scenario("tilted-turntable"))


@cache
def steady() -> Any:
    return tr.steady_motions(scenario("coin-rolling-upright"))


@cache
def rolled() -> tr.RolledPath:
    return tr.PathScenario.load("roll-home-turned").model_copy(update={"title": TITLE}).run()


@cache
def analysis() -> tr.ConstraintAnalysis:
    return tr.PfaffianSystem.load("sphere").analyse()


@cache
def derivation() -> Any:
    return tr.derive(scenario("tilted-turntable"), with_numbers=True)


@cache
def sensitivity() -> tr.Sensitivity:
    return tr.sensitivity(scenario("level-turntable-nudged"), horizon="30 s")


@cache
def periodic() -> tr.PeriodicMotion:
    inside = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5)))
    return tr.periodic_motion(inside, inside.place(velocity=(3.0, 0.2)))


@cache
def swing() -> tr.PeriodicOrbit:
    trough = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    return tr.periodic_orbit(trough, trough.place(position=(0.1, 0.0)), period=1.5)


@cache
def branched() -> tr.BifurcationDiagram:
    section = "velocity.x falling through 0"
    table = scenario("tilted-turntable")
    return tr.bifurcation_diagram(table, "support.tilt", [0.005, 0.006], "position.x", section, duration=60.0)


@cache
def comparison() -> tr.VakonomicComparison:
    return tr.compare_vakonomic(scenario("level-turntable-nudged"))


@cache
def derivatives() -> tr.Sensitivities:
    return tr.sensitivities(scenario("level-turntable-nudged"), "start.velocity", duration=1.0)


@cache
def filmed() -> tr.FilmTrack:
    track = tr.read_track(run())
    camera = PinholeCamera(380.0, (160.0, 120.0), np.zeros(3), np.array([0.0, 0.0, 0.5]))
    turning = Turning(3.4907, 1e-4, 0.0, 0.11, 0.05)
    calibration = Calibration(camera, 0.1, turning, "the rim", track.time, np.zeros((len(track), 2)))
    return tr.FilmTrack(**vars(track), calibration=calibration)


@cache
def fitted() -> tr.Fit:
    measured = run().data.isel(time=slice(0, 60))
    columns = {"t": measured.time.values} | {
        axis: measured.position.sel(axis=axis).values + 1e-3 * np.sin(1e4 * np.arange(60) + i)
        for i, axis in enumerate("xy")
    }
    return tr.fit(columns, scenario("tilted-turntable"), ["support.tilt", "camera.scale"], noise="1 mm")


@cache
def equilibria() -> tr.Equilibria:
    return tr.equilibria(scenario("weighted-cylinder-on-incline"))


@cache
def swept() -> tr.Sweep:
    return tr.sweep(scenario("level-turntable-nudged"), {"gravity": [9.8, 9.9]}, "end x", duration=1.0)


@cache
def tolerated() -> tr.Tolerance:
    limits = {"support.motion.rate": "33.3 ± 0.3 rpm", "body.mass": "65 ± 1 g"}
    return tr.tolerance(scenario("level-turntable-nudged"), limits, "end x", members=4, duration=1.0)


# Every result that shows itself; the first test says if one is missing.
RESULTS: tuple[Callable[[], Displayed], ...] = (
    lambda: scenario("tilted-turntable"),
    lambda: scenario("rattleback"),
    lambda: tr.PathScenario.load("roll-home-turned").model_copy(update={"title": TITLE}),
    run,
    billiards,
    lambda: run().card(),
    lambda: tr.place_many(run().system, [[0.1, 0.0], [0.2, -0.1]], velocity=(0.0, 0.1)),
    lambda: run().card().figures[0],
    lambda: replace(run().card().figures[0], name=TITLE, passed=False),
    lambda: billiards().events[0],
    lambda: billiards().start,
    checked,
    lambda: checked().likely[0],
    lambda: Mistake(TITLE, TITLE, TITLE, 0.1, 1e-9, 1e-5, {TITLE: 0.4}),
    equilibria,
    lambda: equilibria()[0],
    lambda: tr.equilibria(scenario("weighted-cylinder-too-steep")),
    lambda: tr.equilibria(scenario("ball-in-a-trough")),
    steady,
    lambda: steady()[0],
    lambda: steady()[0].along("speed", count=3),
    periodic,
    swing,
    lambda: swing().along("gravity", 9.5, 10.0),
    lambda: tr.lyapunov_exponents(scenario("tilted-turntable"), duration=2.0, count=2),
    lambda: tr.poincare_section(scenario("tilted-turntable"), "velocity.x falling through 0", duration=10.0),
    branched,
    lambda: tr.lyapunov_map(swing().system, {"x": [0.1]}, lambda x: swing().system.place(position=(x, 0.0)), 1.0),
    lambda: tr.twin(scenario("tilted-turntable")),
    lambda: tr.twin(scenario("tilted-turntable"), electron=True).particle,
    lambda: tr.PfaffianSystem.load("sphere"),
    lambda: tr.PfaffianSystem(sp.symbols("<b> y"), [[1, 0]]),
    analysis,
    lambda: tr.PfaffianSystem(sp.symbols("<b> y"), [[1, 0]]).analyse(),
    sensitivity,
    lambda: sensitivity().rows[0],
    derivatives,
    fitted,
    lambda: fitted().sample(steps=20, walkers=20),
    lambda: Alternatives(TITLE, (Alternative("drag", 12.5, 3, 10, 25.0, (("loads[0].coefficient", 0.5, 0.25),)),)),
    lambda: tr.plan_fit(scenario("tilted-turntable"), "support.tilt", durations=[2.0], rates=[10]),
    derivation,
    lambda: derivation().steps[0],
    lambda: derivation().steps[0].equations[0],
    comparison,
    lambda: comparison().vakonomic,
    rolled,
    lambda: rolled().card(),
    lambda: rolled().rotation,
    lambda: rolled().stages,
    lambda: rolled().sampled(1e-3),
    lambda: scenario("free-turntable-ellipse").system().vector_field("c"),
    lambda: tr.MotionFormula(run().closed_form),
    swept,
    tolerated,
    lambda: tr.conformance.Score(
        (tr.conformance.Row(TITLE, "", "as shipped", "", "incline", 0.01, "failed", TITLE, *[math.nan] * 7),)
    ),
    lambda: tr.read_track(run()),
    filmed,
)


@cache
def made(make: Callable[[], Displayed]) -> Displayed:
    """One of them, made once for all tests."""
    return make()


@pytest.fixture(scope="module")
def shell() -> Iterator[InteractiveShell]:
    """IPython as a notebook's kernel has it."""
    yield InteractiveShell.instance()
    InteractiveShell.clear_instance()


def shown(shell: InteractiveShell, result: Any) -> dict[str, str]:
    """What a cell that ends with a result keeps in the notebook."""
    import nbformat  # here: it takes three seconds, and each worker collects this file

    data, metadata = shell.display_formatter.format(result)
    output = nbformat.v4.new_output("execute_result", data, metadata=metadata, execution_count=1)
    cell = nbformat.v4.new_code_cell("result", outputs=[output], execution_count=1)
    nbformat.validate(nbformat.v4.new_notebook(cells=[cell]))
    return data


def parsed(html: str) -> ET.Element:
    """The elements of an output: strictly, so that none is left open."""
    return ET.fromstring(f"<body>{html.replace('<br>', '<br/>')}</body>")  # noqa: S314  our own


def read(html: str) -> str:
    """What a person reads of an output, with powers of ten as the text writes them."""
    html = re.sub(r"<style>.*?</style>", "", html, flags=re.DOTALL).replace("−", "-")
    html = re.sub(r"(?<!·)10<sup>", "1·10<sup>", html)
    html = re.sub(r"·10<sup>(-?\d+)</sup>", r"e\1", html)
    return unescape(re.sub(r"<[^>]+>", " ", html)).replace("−", "-")


def numbers(text: str) -> set[str]:
    """The numbers in a text, without their signs, to the six digits that are shown."""
    return {f"{float(found):.6g}" for found in NUMBER.findall(text)}


def each_class(kind: type) -> Iterator[type]:
    for below in kind.__subclasses__():
        yield below
        yield from each_class(below)


@cache
def displayed() -> set[type]:
    """Every class of the package whose objects show themselves."""
    for module in pkgutil.walk_packages(tr.__path__, "trundle."):
        if not module.name.startswith(("trundle.lab", "trundle.cli", "trundle.__main__")):
            importlib.import_module(module.name)
    return {kind for kind in each_class(Displayed) if kind.__module__.startswith("trundle.")}


def test_every_result_there_is_is_looked_at_here() -> None:
    assert {kind.__name__ for kind in displayed() - {type(made(make)) for make in RESULTS}} == INNER


def test_what_a_verb_returns_shows_itself() -> None:
    """So that the result of the next one is no wall of text."""
    verbs = [getattr(tr, name) for name in tr.__all__ if inspect.isfunction(getattr(tr, name))]
    others = ("xarray.Dataset", "float", "tuple[RollingSystem, State]")  # shows itself; a number; parts to build with
    returned = {verb.__annotations__["return"] for verb in verbs} - set(others)
    assert len(returned) > 8
    assert returned <= {kind.__name__ for kind in displayed()}


@pytest.mark.parametrize("make", RESULTS)
def test_it_is_whole_harmless_and_says_what_its_text_says(
    make: Callable[[], Displayed], shell: InteractiveShell
) -> None:
    result = made(make)
    data = shown(shell, result)
    html = data["text/html"]
    tags = {element.tag for element in parsed(html).iter()}
    assert not tags & {"script", "link", "img", "iframe", "object", "form", "h1", "h2"}
    for element in parsed(html).iter():
        assert not any(name.startswith("on") or name in ("src", "href", "style", "id") for name in element.attrib)
    style = html.partition("<style>")[2].partition("</style>")[0]
    assert "url(" not in style
    assert "@import" not in style
    words = read(html)
    assert "<script>alert" not in html
    missing = numbers(str(result)) - numbers(words)
    assert not missing, f"{missing} not in {words}"


@pytest.mark.parametrize("make", RESULTS)
def test_its_name_among_other_things_is_one_short_line(make: Callable[[], Displayed], shell: InteractiveShell) -> None:
    result = made(make)
    assert "\n" not in repr(result)
    assert len(repr(result)) < 420
    assert "array(" not in repr(result)
    assert shown(shell, result)["text/plain"] in (str(result), repr(result))
    assert repr(result).splitlines()[0] in shown(shell, [result])["text/plain"]


@pytest.mark.parametrize("make", RESULTS)
def test_a_title_is_text_whatever_it_holds(make: Callable[[], Displayed]) -> None:
    result = made(make)
    head = result._headline().title
    if TITLE in head:
        assert TITLE in "".join(parsed(result._repr_html_()).itertext())
    if hasattr(result, "title"):
        assert head == result.title


def verdict_of(result: Displayed) -> tuple[str, str]:
    """The class and the words of the verdict in the headline."""
    [line] = [part for part in parsed(result._repr_html_()).iter("p") if part.get("class") == "trundle-head"]
    said = list(line)[-1]
    return said.get("class") or "", "".join(said.itertext()).replace("\xa0", " ")


def test_a_verdict_is_seen_by_sign_and_word() -> None:
    card = run().card()
    broken = replace(card, figures=(replace(card.figures[0], passed=False, value=0.3), *card.figures[1:]))
    assert verdict_of(card) == ("trundle-good", "✓ every check held")
    assert verdict_of(broken) == ("trundle-bad", "✗ 1 of the checks FAILED")
    assert read(broken._repr_html_()).count("✗\xa0FAILS") == 1
    assert verdict_of(checked())[1] == f"✗ {checked().outcome}"
    assert "likely: Ω is in deg/s" in read(checked()._repr_html_())
    assert verdict_of(tr.twin(scenario("tilted-turntable"))) == ("trundle-good", "✓ the two paths agree")
    assert verdict_of(analysis()) == ("", "NONHOLONOMIC")
    assert verdict_of(derivation())[1].startswith("✓ each of")
    assert verdict_of(steady()[0]) == ("", "circles, stable to first order")
    slips = replace(equilibria()[0], friction=0.01)
    assert "✗\xa0needs friction" in read(slips._repr_html_())
    assert "it SLIPS" in read(slips._repr_html_())


def test_a_run_is_not_verified_to_be_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    fresh = scenario("tilted-turntable").run(duration=2.0)
    with monkeypatch.context() as patch:
        patch.setattr(verify, "card", lambda *_: pytest.fail("nobody asked for the card"))
        assert verdict_of(fresh) == ("", "not checked yet: card() checks it")
    fresh.card()
    assert verdict_of(fresh) == ("trundle-good", "✓ every check held")
    card = fresh.card()
    failed = fresh.with_card(replace(card, figures=(replace(card.figures[0], passed=False), *card.figures[1:])))
    assert verdict_of(failed)[1] == "✗ 1 of the checks FAILED"


def test_a_long_run_is_shown_at_the_size_of_a_short_one() -> None:
    bounces = scenario("billiard-draw").run(every=2e-5)
    assert bounces.data.time.size == 100_001
    assert len(bounces._repr_html_()) < 1.1 * len(billiards()._repr_html_())
    many = replace(bounces, events=bounces.events * 500)
    assert "and 488 more" in read(many._repr_html_())


def test_it_takes_the_colours_of_the_page_it_is_on() -> None:
    style = parsed(run()._repr_html_()).find(".//style")
    assert style is not None
    for rule in re.findall(r"[^{};]*#[0-9a-f]{3,6}[^;}]*", str(style.text)):
        assert re.fullmatch(r"\s*color: color-mix\(in srgb, currentColor \d+%, #[0-9a-f]{6}\)\s*", rule), rule
    assert re.findall(r"background: (\w+)", str(style.text)) == ["none"]


def test_text_is_escaped_where_it_is_put_in_and_once() -> None:
    nasty = "<b> & \"'"
    for made in (
        markup.table([[nasty]], [nasty]),
        markup.pairs([(nasty, nasty)]),
        markup.records([{nasty: nasty}, {nasty: nasty}]),
        markup.paragraph(nasty),
        markup.section(nasty, nasty),
        markup.fold(nasty, nasty),
        markup.verdict(True, nasty),
        markup.number(nasty, unit=nasty),
        markup.numbers([nasty]),
        markup.joined([nasty, nasty], nasty),
    ):
        assert "<b>" not in made
        assert nasty in "".join(parsed(made).itertext())
        assert markup.escaped(made) is made


@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan, 0.0, -0.0, 1e-320, 1e308, np.float64(0.5), None])
def test_any_number_can_be_shown(value: Any) -> None:
    figure = CardFigure("anything", 0.0 if value is None else value, "m", value, None)
    assert parsed(figure._repr_html_()) is not None


def test_what_has_nothing_to_say_is_still_named() -> None:
    class Empty(Displayed):
        pass

    class Titled(Displayed):
        def _headline(self) -> Headline:
            return Headline("", TITLE, False)

    assert repr(Empty()) == "<Empty>"
    assert "Empty" in read(Empty()._repr_html_())
    assert verdict_of(Titled()) == ("trundle-bad", f"✗ {TITLE}")
