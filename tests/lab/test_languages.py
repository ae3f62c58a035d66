"""All that the server says can be said in another language: nothing of it is outside the catalogue."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator, Mapping
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from tests.tracks.examples import EXAMPLES, Example, written

import trundle as tr
from trundle.analysis.geometry import PathScenario
from trundle.analysis.geometry.scene import rolled_scene
from trundle.errors import TrundleError
from trundle.lab.challenges import on_site
from trundle.lab.deriving import derivation_of
from trundle.lab.errors import refusal_of
from trundle.lab.measuring import track_told
from trundle.lab.parts import all_parts
from trundle.mechanics.shapes.base import Shape
from trundle.mechanics.surfaces.base import Surface
from trundle.scenario import files
from trundle.solve import transitions
from trundle.solve.phases import ENDS
from trundle.tracks.film.result import _PARTS
from trundle.views.scene import scene_of

from .untold import untold, words_in


def test_a_text_in_no_catalogue_is_found() -> None:
    """Also where it is a part of what is known, or stands for what varies."""
    plain = ["Nobody has said this before", "Spin about the normal. Nobody has said this.", "drift of the whatever"]
    assert untold([*plain, "Spin about the normal", "drift of the energy"]) == plain


def test_titles_groups_and_notes_of_what_ships() -> None:
    told = []
    for name in files.names():
        tables = files.tables_of(name)
        told += [str(tables.get("title", "")), str(tables.get("group", ""))]
        told += [" ".join(part.split()).replace("`", "") for part in re.split(r"\n\s*\n", str(tables.get("notes", "")))]
    assert untold(told) == []


def test_challenges_with_their_hints_and_notes_for_teachers() -> None:
    assert untold(text for text in words_in(on_site()) if " " in text) == []


def test_labels_and_explanations_of_all_parts() -> None:
    assert untold(text for text in words_in(all_parts()) if re.search(r"[a-z] [a-z]", text)) == []


def _kinds(of: type) -> Iterator[type]:
    for kind in of.__subclasses__():
        yield kind
        yield from _kinds(kind)


def test_nouns_of_all_bodies_alone_and_in_what_is_said_of_the_tools() -> None:
    nouns = {noun for kind in (Shape, *_kinds(Shape)) for noun in _nouns(kind)}
    assert {"ball", "disc", "ring", "ellipsoid", "body"} <= nouns
    assert untold(f"{article}{noun}" for noun in sorted(nouns) for article in ("", "the ")) == []


def _nouns(shape: type) -> Iterator[str]:
    """Yield its noun, and those that its method returns instead."""
    yield str(shape.noun)  # type: ignore[attr-defined]
    if "noun_of" in vars(shape):
        function = ast.parse(textwrap.dedent(inspect.getsource(shape.noun_of)))  # type: ignore[attr-defined]
        returned = (node.value for node in ast.walk(function) if isinstance(node, ast.Return) and node.value)
        yield from (text for value in returned for text in _template(value, {}))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.id)
def test_what_is_said_of_a_track(example: Example, tmp_path: Path) -> None:
    track = tr.read_track(written(example, tmp_path), **example.options)
    if track.frame == "support":
        assert untold(clause for clauses in track_told(track)["said"] for clause in clauses) == []


DAMAGED = {
    "gaps": "t (s),x (cm)\n0,1\n1,\n2,3\n3,4\n7,5\n8,6\n",
    "one": "t (s),x (cm)\n0,1\n",
    "uneven": "t (ms),x (cm),y (cm)\n" + "".join(f"{i * i},1,2\n" for i in range(9)),
    "words": "time (s),x (m),time of day\n"
    + "".join(f"{i / 10},1,\n" for i in range(60))
    + "6.1,?!,\n6.1,2,\n,2,\n6.3,2\n6.2,3,\n6.2,4,\n",
}


@pytest.mark.parametrize("name", DAMAGED)
def test_what_is_said_of_a_track_with_gaps_and_other_faults(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"{name}.csv"
    path.write_text(DAMAGED[name])
    said = track_told(tr.read_track(path))["said"]
    assert untold(clause for clauses in said for clause in clauses) == []
    if name == "words":
        assert "time of day" in str(said), "what stands in the file is not said in another language"


def test_why_rows_are_left_out_and_how_a_camera_was_calibrated() -> None:
    """The rarest reasons too, which no file of these tests has."""
    told = [text for path in _files() if "tracks" in path.parts for text in _told_of_tracks(path.read_text("utf-8"))]
    assert len(told) > 20
    assert {"no ball", "no time", "its time is that of 3 3"} <= set(told)
    written_out = {"not known: 3": "not known: --unit", "that of 3 3": "that of line 3"}
    for short, whole in written_out.items():
        told = [text.replace(short, whole) for text in told]
    assert untold([*told, *_PARTS.values(), "calibrated by: the rim (83 points of its edge), to 0.3 px"]) == []


def _told_of_tracks(source: str) -> Iterator[str]:
    """Yield reasons why something is left out, and the lines about a camera."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            at = {"Rejected": 1, "leave_out": 1, "_leave": 2}.get(name)
            if at is not None and at < len(node.args):
                yield from _template(node.args[at], {})
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Subscript):
            if getattr(node.targets[0].value, "attr", "") in ("rejected", "left_out"):
                yield from _template(node.value, {})
        elif isinstance(node, ast.FunctionDef) and node.name == "_told":
            pairs = [one.elts for one in ast.walk(node) if isinstance(one, ast.Tuple) and len(one.elts) == 2]
            for name, said in pairs:
                if isinstance(name, ast.Constant):
                    yield from (f"{name.value}: {text}" for text in _template(said, {}))


# Of every kind: closed forms, numerical runs, flight and landings, slip, a rim, a support that turns by itself, losses.
RUNS = [
    "tilted-turntable",
    "rattleback-with-losses",
    "turntable-drop",
    "billiard-draw",
    "real-demonstration",
    "free-turntable-ellipse",
    "loop-the-loop-too-slow",
    "golfers-dilemma",
    "cylinder-in-cylinder",
    "tippe-top",
    "chaplygin-ball",
    "rocking-hemisphere-over-its-edge",
]


def _said(header: dict[str, Any]) -> list[str]:
    card, headline = header["card"] or {}, header["headline"]
    figures = [text for one in card.get("figures", []) for text in (one["name"], one["note"])]
    # A source is cited as it is.
    method = re.sub(r"^(closed form [^(]*)\(.*\)", r"\1(1)", str(card.get("method", "")))
    findings = [text for one in header["findings"] for text in (one["name"], one["note"])]
    headlines = [headline["text"], headline["how"]] if headline else []
    formula = [header["formula"]["name"]] if header["formula"] else []
    others = [one["label"] for one in header["curves"]] + [one["text"] for one in header["events"]]
    return [*figures, method, *findings, *headlines, *formula, *others, header["body"]["label"]]


@pytest.mark.parametrize("name", RUNS)
def test_what_is_said_of_a_run(name: str) -> None:
    header = scene_of(tr.Scenario.load(name).run(), samples=50, with_card=True).header
    assert untold([*_said(header), header["support"]["name"]]) == []


def test_what_is_said_of_any_event() -> None:
    """Those that no run above comes to, too."""
    tree = ast.parse(inspect.getsource(transitions))
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    jolts = _named(functions["_jolted"])["said"]
    away = [f"the support jerked away from the body at 3 m/s{cut}" for cut in ("", *_cuts(functions["_left_behind"]))]
    jolts += ["the support struck the body at 3 m/s", *away]
    struck = [f"landed at 3 m/s{how}" for how in (" and bounced", *_named(functions["_struck"])["cut"])]
    thrown = [f"{jolt}{how}" for jolt in jolts for how in (" and threw it off", *_named(functions["_struck"])["cut"])]
    plain = [*transitions._NAMES.values(), transitions._STOPPED_TURNING, transitions._BEGAN_TO_ROLL]
    ends = [
        said.format(rim=0.4, end=surface.domain_end, left=shape.validity_end)  # type: ignore[attr-defined]
        for said, surface, shape in product(ENDS.values(), _kinds(Surface), (Shape, *_kinds(Shape)))
    ]
    others = [*(text for _, text in plain), *transitions._SLIPS_ON.values()]
    assert untold([*jolts, *struck, *thrown, *ends, *others]) == []


def _cuts(function: ast.FunctionDef) -> list[str]:
    """Return what is added to a text, where a flight is too low to be followed."""
    added = [node.value for node in ast.walk(function) if isinstance(node, ast.AugAssign)]
    return [text for value in added for text in _template(value, {})]


@pytest.mark.parametrize("name", ["roll-small-loop", "roll-x-then-y"])
def test_what_is_said_of_a_rolled_path(name: str) -> None:
    header = rolled_scene(PathScenario.read(files.tables_of(name), name).run(), with_card=True).header
    assert untold(_said({"curves": [], **header})) == []


@pytest.mark.parametrize("name", ["tilted-turntable", "cylinder-in-cylinder", "rattleback", "ball-under-torque"])
def test_what_is_said_in_a_derivation(name: str) -> None:
    told = derivation_of(tr.Scenario.load(name))
    steps = [text for step in told["steps"] for text in (step["title"], step["text"])]
    numbers = [number["name"] for number in told["numbers"]]
    assert untold([told["title"], told["introduction"], *steps, *numbers]) == []


# What a reader may do wrong at a control: where it stands, and what is put there.
WRONG: list[tuple[str, Any]] = [
    ("body.radius", "-1 cm"),
    ("body.radius", "much"),
    ("body.radius", "1 s"),
    ("body.radius", "5"),
    ("body.radius", "5 parsnips"),
    ("body.mass", 0),
    ("support.tilt", "172 deg"),
    ("support.friction", -1),
    ("support.restitution", 2),
    ("support.rim", "1 mm"),
    ("start.position", ["1 cm"]),
    ("start.velocity", [1, 2, 3, 4]),
    ("run.duration", 0),
    ("run.every", "1 h"),
    ("run.every", "1 ns"),
]


@pytest.mark.parametrize(("path", "value"), WRONG)
def test_what_is_said_of_a_wrong_value(path: str, value: Any) -> None:
    tables = tr.Scenario.load("tilted-turntable").model_dump(exclude_unset=True, exclude_none=True, by_alias=True)
    table, _, key = path.rpartition(".")
    tables[table] = {**tables.get(table, {}), key: value}
    with pytest.raises(TrundleError) as wrong:
        tr.Scenario.read(tables).run()
    refusal = refusal_of(wrong.value)
    assert refusal is not None
    assert refusal.parts, refusal.message
    assert untold(part[which] for part in refusal.parts for which in ("rule", "remedy")) == []


# What a visitor of the lab can come upon: these rooms compute for it. Of `analysis` the pages Measure, Crossed fields
# and Holonomy use a part.
ROOMS = [
    "mechanics",
    "scenario",
    "solve",
    "units.py",
    "lab",
    "tracks",
    "analysis/analogy",
    "analysis/fit",
    "analysis/geometry",
]
PYTHON_ONLY = {
    "analysis/fit/plan.py",
    "analysis/fit/sampling.py",
    "analysis/geometry/along.py",
    "analysis/geometry/pieces.py",
    "analysis/geometry/rolled.py",
    "lab/security.py",  # options of the command
    "lab/serving.py",
    "mechanics/duals.py",
    "mechanics/expressions.py",
    "solve/compiled_steps.py",
    "solve/exact/many_samples.py",
    "tracks/arrays.py",
    "tracks/film/check_film.py",
}
RAISED = re.compile(r"(InvalidValue|Scenario|OutOfDomain|Solver|TurnsTooFast|Trundle)Error$|^refused$")


Named = Mapping[str, list[str]]


def _template(node: ast.AST, named: Named) -> Iterator[str]:
    """Yield the words of a text, with a number for each value in it, in every way that it may read."""
    if isinstance(node, ast.IfExp):
        yield from [*_template(node.body, named), *_template(node.orelse, named)]
    elif isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.Name):
        yield from named.get(node.id, [])
    elif isinstance(node, ast.FormattedValue):
        yield from list(_template(node.value, named)) or ["3"]
    elif isinstance(node, ast.JoinedStr):
        yield from map("".join, product(*(list(_template(part, named)) for part in node.values)))


def _named(function: ast.AST) -> Named:
    """Return the texts that get a name first, such as `rule` and `remedy`."""
    found: dict[str, list[str]] = {}
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            found.setdefault(node.targets[0].id, []).extend(_template(node.value, {}))
    return found


def _raised(source: str) -> Iterator[str]:
    """Yield the rules, remedies and whole messages of the errors that a file raises."""
    for function in ast.walk(ast.parse(source)):
        if not isinstance(function, ast.FunctionDef):
            continue
        named = _named(function)
        for node in ast.walk(function):
            name = getattr(node.func, "id", "") if isinstance(node, ast.Call) else ""
            if not isinstance(node, ast.Call) or not RAISED.search(name):
                continue
            whole = name == "refused" or len(node.args) == 1
            for at, argument in enumerate(node.args):
                if at in ({0, 1} if whole else {1, 3}):
                    yield from _template(argument, named)


def _files() -> Iterator[Path]:
    top = Path(tr.__file__).parent
    for room in ROOMS:
        for path in [top / room] if room.endswith(".py") else sorted((top / room).rglob("*.py")):
            if path.relative_to(top).as_posix() not in PYTHON_ONLY:
                yield path


def test_rules_and_remedies_are_found_in_the_source() -> None:
    source = """def f(x):
        remedy = f"Take {x}."
        raise InvalidValueError("x", "must be small" if x else "must be", x, remedy)"""
    assert list(_raised(source)) == ["must be small", "must be", "Take 3."]


def test_every_rule_and_remedy_of_what_the_lab_computes() -> None:
    """The rarest too, which no run of these tests comes upon."""
    texts = (text for path in _files() for text in _raised(path.read_text(encoding="utf-8")) if " " in text)
    found = [re.sub(r"^3 (?=[A-Z])", "", text) for text in texts]  # a sentence of another error may stand before
    assert len(found) > 300
    assert untold(found) == []
