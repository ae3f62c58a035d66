"""Files and tables that are no scenario are refused in a second and in words, however they are made."""

import inspect
import resource
import time
from typing import Any

import pytest

import trundle as tr
from trundle.scenario import files

TEXT = files.read("level-turntable-nudged")
MIB = files.LARGEST
PATH = '[body]\nradius = "1 cm"\n' + '[[path]]\nkind = "straight"\nlength = "1 cm"\n' * 10_001


def filled(part: str, before: str = "", after: str = "", size: int = MIB - 10) -> str:
    """Return a text all but as long as a file may be."""
    return before + part * ((size - len(before) - len(after)) // len(part)) + after


def with_load(formula: str) -> str:
    return f"{TEXT}\n[[loads]]\nkind = 'force'\nvalue = ['{formula}', 0, 0]"


def with_radius(value: str) -> str:
    return TEXT.replace('"25 mm"', value)


HOSTILE = {
    "a dotted key": filled("a.", after="b=1"),
    "a dotted key with spaces": filled("a . ", after="b=1"),
    "a dotted key in quotes": filled('"a".', after="b=1"),
    "a dotted key in single quotes": filled("'a.b' .\t", after="b=1"),
    "a dotted key deep in the file": filled("a.", before=TEXT, after="b=1"),
    "a dotted key within a table": filled("a.", before="x = {", after="b=1}"),
    "a dotted head": filled("a.", before="[", after="b]"),
    "a dotted head of a list": filled("a.", before="[[", after="b]]"),
    "many dotted keys": filled("a." * 40 + "b=1\n"),
    "a dotted key of other letters": filled("é.", after="b=1", size=MIB // 2),
    "lists within lists": "a=" + "[" * 300 + "]" * 300,
    "lists too deep for Python": filled("[", before="a="),
    "tables within tables": "a=" + "{a=" * 300 + "1" + "}" * 300,
    "tables too deep for Python": filled("{a=", before="a="),
    "heads that go deeper": "\n".join(f"[{'.'.join('a' * n)}]" for n in range(1, 20)) + "\n[" + "a." * 19 + "a]",
    "as many keys as fit": "".join(f"k{i}=1\n" for i in range(90_000)),
    "as many heads as fit": "".join(f"[k{i}]\n" for i in range(90_000)),
    "keys of the run": TEXT + "".join(f"k{i}=1\n" for i in range(90_000)),
    "as many empty tables as fit": filled("{},", before="a=[", after="]"),
    "as many numbers as fit": filled("1,", before="a=[", after="]"),
    "numbers for one": with_radius(filled("1,", before="[", after="]", size=MIB - 2000)),
    "thousands of loads": filled('[[loads]]\nkind="force"\nvalue=["1 N", 0, 0]\n', before=TEXT),
    "thousands of loads in one list": filled("{},", before="loads=[", after="]"),
    "thousands of pieces": PATH,
    "an integer of a million digits": with_radius(filled("9", size=MIB - 2000)),
    "as a title": filled("9", before="title="),
    "a long hexadecimal": with_radius(filled("f", before="0x", size=MIB - 2000)),
    "a long hexadecimal as a kind": TEXT.replace('"plane"', filled("f", before="0x", size=MIB - 2000)),
    "a long binary": filled("1", before="title=0b"),
    "1e999999": with_radius("1e999999"),
    "1e999999 m": with_radius('"1e999999 m"'),
    "a small one": with_radius("1e-999999"),
    "digits as text": with_radius(filled("9", before='"', after=' m"', size=MIB - 2000)),
    "a unit as long as fits": with_radius(filled("m", before='"1 ', after='"', size=MIB - 2000)),
    "powers of powers": with_radius('"1 m^9^9^9^9"'),
    "a long formula": with_load(filled("t+", after="t", size=MIB - 2000)),
    "a deep formula": with_load("sin(" * 70 + "t" + ")" * 70),
    "a formula of minus signs": with_load("-" * 400 + "t"),
    "a tower of powers": with_load("(t**20)" + "**20" * 60),
    "a formula with a long number": with_load("t*" + "9" * 450),
    "a title as long as fits": filled("x", before='title="', after='"\n' + TEXT.partition("\n")[2]),
    "more than fits": filled("#", before=TEXT, size=MIB + 1),
    "quotes": filled('"'),
    "single quotes": filled("'"),
    "letters": filled("x"),
    "dots": filled("."),
    "equals": filled("="),
    "blanks": filled(" ", after="a"),
    "a long bare value": filled("x", before="a="),
    "underscores": filled("1_", before="a=", after="1"),
    "escapes": filled("\\u0041", before='a="', after='"'),
    "noughts": with_radius(filled("\\u0000", before='"', after='"', size=MIB - 2000)),
}


@pytest.mark.parametrize("text", ["t+" * 250 + "t", "sin(1)" + " " * 500])
def test_a_formula_that_is_too_long_is_told_so(text: str) -> None:
    with pytest.raises(tr.ScenarioError, match=r"`loads\[0\].value\[0\]` must be a formula in t; .*500 characters"):
        tr.Scenario.loads(with_load(text), "mine.toml")


def spent() -> float:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


@pytest.mark.parametrize("name", HOSTILE)
def test_what_is_no_scenario_is_refused_in_words_and_at_once(name: str, capfd: pytest.CaptureFixture[str]) -> None:
    kind = tr.PathScenario if name == "thousands of pieces" else tr.Scenario
    tr.Scenario.loads(TEXT)  # with all that it imports
    begun, wall = spent(), time.perf_counter()
    with pytest.raises(tr.ScenarioError) as caught:
        kind.loads(HOSTILE[name], "mine.toml")
    assert min(spent() - begun, time.perf_counter() - wall) < 30.0  # an hour, before; a machine may be slow
    assert str(caught.value).startswith("mine.toml: `")
    assert max(map(len, str(caught.value).splitlines())) < 600
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("data", [{"a": {str(i): 1 for i in range(101)}}, {"loads": [{}] * 101}, {"x": [0] * 10**6}])
def test_tables_from_python_have_the_same_bounds(data: dict[str, object]) -> None:
    with pytest.raises(tr.ScenarioError, match="must have at most"):
        tr.Scenario.read(data)


def test_a_list_that_holds_itself_is_refused() -> None:
    endless: list[object] = []
    endless.append(endless)
    with pytest.raises(tr.ScenarioError, match="must nest at most"):
        tr.Scenario.read({"x": endless})
    with pytest.raises(tr.ScenarioError, match=r"`y\[0\]` must be a finite number"):
        tr.Scenario.read({"x": endless, "y": [10**400]})


def test_what_looks_like_it_but_is_a_scenario_is_read() -> None:
    notes = f"Section 1.2.3.4.5.6 of www.a.b.c.d.e.f.g ... {'.' * 200} {'[' * 500} {'1.5, ' * 500}"
    heights = [[0.0] * 100] * 100
    table = {"kind": "height-field", "x": [float(i) for i in range(100)], "y": [float(i) for i in range(100)]}
    described = tr.Scenario.loads(TEXT).model_dump(by_alias=True, exclude_unset=True)
    whole = {**described, "notes": notes, "support": {**table, "z": heights}, "start": {"position": [50, 50]}}
    assert tr.Scenario.loads(tr.Scenario.read(whole).to_toml()).notes == notes


def kind(value: Any) -> str:
    """Return the name of a kind of value."""
    return type(value).__name__


ASKED = [name for name in tr.__all__ if inspect.isfunction(getattr(tr, name))]


@pytest.mark.parametrize("nonsense", [7, None, {"a": 1}, [1], object()], ids=kind)
@pytest.mark.parametrize("name", ASKED)
def test_what_is_nothing_of_the_kind_is_refused_in_words(name: str, nonsense: Any) -> None:
    function = getattr(tr, name)
    needed = [one for one in inspect.signature(function).parameters.values() if one.default is one.empty]
    given = [nonsense for one in needed if one.kind is one.POSITIONAL_OR_KEYWORD]
    named = {one.name: nonsense for one in needed if one.kind is one.KEYWORD_ONLY}
    if (name, nonsense) == ("air_drag", 7):  # that is a ball
        return
    with pytest.raises(tr.TrundleError):
        function(*given, **named)


@pytest.mark.parametrize("nonsense", [None, {"a": 1}, [1.0], (1.0,), {1.0}, object(), b"1 m", True], ids=kind)
@pytest.mark.parametrize("part", [tr.Sphere, tr.Spin, tr.Drag, tr.Bowl, lambda x: tr.Body.hoop(x, 1.0)])
def test_what_is_no_number_is_refused(part: Any, nonsense: Any) -> None:
    with pytest.raises(tr.InvalidValueError, match="must be a"):
        part(nonsense)
