"""Text without a unit is refused wherever you may write it: in a file, in Python, on the command line, in the lab."""

import re
from collections.abc import Iterator
from typing import Any

import pytest
from starlette.testclient import TestClient

import trundle as tr
from trundle.cli import run as command
from trundle.scenario import files

QUANTITY = re.compile(r"([+-]?[\d.]+(?:e[+-]?\d+)?)\s*[A-Za-z°µ][^\n]*")


def places(tables: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield where in nested tables a text with a unit stands."""
    inside = tables.items() if isinstance(tables, dict) else enumerate(tables) if isinstance(tables, list) else ()
    for key, part in inside:
        yield from places(part, (*path, key))
    if isinstance(tables, str) and QUANTITY.fullmatch(tables):
        yield path


def written(path: tuple[Any, ...]) -> str:
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in path)[1:]


def replaced(name: str, path: tuple[Any, ...], new: Any) -> dict[str, Any]:
    tables = files.parse(files.read(name), name)
    part: Any = tables
    for key in path[:-1]:
        part = part[key]
    part[path[-1]] = new(QUANTITY.fullmatch(part[path[-1]])[1])
    return tables


def kind_of(name: str) -> Any:
    return tr.PathScenario if files.is_shipped_path(name) else tr.Scenario


@pytest.mark.parametrize("name", files.names())
def test_each_quantity_of_each_shipped_scenario_without_its_unit(name: str) -> None:
    found = list(places({key: part for key, part in files.parse(files.read(name), name).items() if key != "notes"}))
    assert found
    for path in found:
        with pytest.raises(tr.ScenarioError) as caught:
            kind_of(name).read(replaced(name, path, str))
        assert caught.value.key == written(path)
        assert "with its unit" in str(caught.value)
        offered = r"Write ('.+ .+' or, in a file or in Python, the bare number|its unit behind it, as in '.+ .+')"
        assert re.search(offered, str(caught.value))


def test_a_bare_number_is_si_and_text_is_not_read_as_one() -> None:
    path = ("support", "motion", "rate")
    scenario = tr.Scenario.read(replaced("level-turntable-nudged", path, lambda _: 45))
    assert scenario.system().support.motion.rate == 45.0
    with pytest.raises(tr.ScenarioError, match="'45 rad/s', '45 rpm' or, in a file or in Python, the bare number 45"):
        tr.Scenario.read(replaced("level-turntable-nudged", path, lambda _: "45"))


@pytest.mark.parametrize(
    "call",
    [
        lambda: tr.Spin("45"),
        lambda: tr.Body.solid_sphere(radius="0.1", mass=1),
        lambda: tr.Body.solid_sphere(radius=0.1, mass="1"),
        lambda: tr.Support(tr.Plane(), tilt="0.1"),
        lambda: tr.Force(("1", 0, 0)),
        lambda: tr.Drag("0.01"),
        lambda: tr.RollingSystem(tr.Body.solid_sphere(0.1, 1), tr.Support(tr.Plane()), gravity="9.81"),
        lambda: tr.RollingSystem(tr.Body.solid_sphere(0.1, 1), tr.Support(tr.Plane())).place(("0.1", 0)),
        lambda: tr.RollingSystem(tr.Body.solid_sphere(0.1, 1), tr.Support(tr.Plane())).place(velocity=(0, "1")),
        lambda: tr.RollingSystem(tr.Body.solid_sphere(0.1, 1), tr.Support(tr.Plane())).place(spin="1"),
        lambda: tr.Scenario.load("tilted-turntable").run(duration="5"),
        lambda: tr.Scenario.load("tilted-turntable").run(every="1"),
        lambda: tr.sensitivity(tr.Scenario.load("real-demonstration"), tilt="0.1"),
        lambda: tr.twin(tr.Scenario.load("tilted-turntable"), mass="1"),
    ],
)  # fmt: skip
def test_in_python(call: Any) -> None:
    with pytest.raises(tr.InvalidValueError, match="with its unit"):
        call()


def test_what_has_no_dimension_may_be_text() -> None:
    assert tr.Support(tr.Plane(), friction="0.3", restitution="0.5").friction == 0.3


@pytest.mark.parametrize(
    "words",
    [
        ["run", "tilted-turntable", "--duration", "5"],
        ["run", "tilted-turntable", "--every", "1"],
        ["sensitivity", "real-demonstration", "--tilt", "0.1"],
        ["sensitivity", "real-demonstration", "--horizon", "100"],
        ["twin", "tilted-turntable", "--mass", "1"],
        ["vakonomic", "level-turntable-nudged", "--duration", "3"],
        ["steady", "coin-rolling-upright", "--hold", "speed=1"],
        ["steady", "coin-rolling-upright", "--along", "speed", "--from", "1"],
    ],
)  # fmt: skip
def test_on_the_command_line(
    words: list[str], capsys: pytest.CaptureFixture[str], tmp_path: Any, monkeypatch: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    assert command(words) == 2
    said = capsys.readouterr().err
    assert "with its unit" in said
    assert f"Write '{re.split('=', words[-1])[-1]} " in said
    assert not list(tmp_path.iterdir())


def test_in_the_lab(lab: TestClient) -> None:
    tables = replaced("level-turntable-nudged", ("support", "motion", "rate"), str)
    for route in ("simulate", "card", "derivation", "twin"):
        answer = lab.post(f"/api/{route}", json={"scenario": tables})
        assert answer.status_code == 422
        told = answer.json()["error"]
        assert told["key"] == "support.motion.rate"
        assert "'33.3 rad/s', '33.3 rpm'" in told["message"]
    answer = lab.post("/api/roll", json={"radius": "0.05", "curve": {"kind": "straight", "length": "1 m"}})
    assert "with its unit" in answer.json()["error"]["message"]
