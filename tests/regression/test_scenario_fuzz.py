"""No input gives a traceback: a scenario, or one `TrundleError` in one line."""

from __future__ import annotations

import copy
import datetime as dt
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from trundle.errors import MOST_TOLD, InvalidValueError, TrundleError
from trundle.mechanics.system import RollingSystem, State
from trundle.scenario import ScenarioFile, files
from trundle.units import UNITS

SHIPPED = {name: files.parse(files.read(name), name) for name in ScenarioFile.names()}
TEXTS = {name: files.read(name) for name in SHIPPED}

numbers = st.one_of(
    st.floats(),
    st.integers(),
    st.integers(-(10**400), 10**400),
    st.sampled_from([0, -0.0, 1e-308, 5e-324, 1e308, 1e30, 1e-30, 1e12, 2 / 3, 90, True]),
)
units = st.sampled_from([unit for unit, _ in UNITS.values()] + ["mm", "deg", "rpm", "Hz", "in", "x", "m^9", "%"])
words = st.sampled_from(
    [
        *("co-rotating", "spin", "fixed", "plane", "sphere", "sphere-with-moment", "solid-sphere", "drag", "torque"),
        *("exact", "cylinder", "hoop", "weighted-cylinder", "wobble", "uneven-spin", "turning", "inside", "outside"),
        *("0.1*sin(3*t)", "t", "t**2/0", "sqrt(-t)", "log(t)", "(t", "t.real", "10**9*t", "1e999*t", "90 deg"),
    ]
)
scalars = st.one_of(
    numbers,
    st.builds("{} {}".format, st.floats(-1e6, 1e6), units),
    st.builds("{}{}".format, numbers.filter(lambda n: abs(n) < 10**300 or n != n), units),
    words,
    st.text(max_size=8),
    st.dates(),
    st.times(),
    st.just(dt.datetime(1979, 5, 27, tzinfo=dt.UTC)),
)
KEYS = (
    "title,notes,gravity,body,support,start,loads,run,kind,radius,mass,inertia_ratio,moment_of_inertia,tilt,rim,friction,motion,rate,"
    "position,velocity,spin,angular_velocity,orientation,value,every,roll,side,air,weight,distance,variation,angle"
)
keys = st.one_of(st.sampled_from(KEYS.split(",")), st.text(max_size=5))
anything = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(keys, inner, max_size=4),
    max_leaves=8,
)


def places(node: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the path of every value in nested tables and lists."""
    inside = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    return [path] * bool(path) + [place for key, value in inside for place in places(value, (*path, key))]


@st.composite
def spoiled(draw: st.DrawFn) -> dict[str, Any]:
    """A shipped scenario with one to three values changed, removed, renamed or added."""
    data: dict[str, Any] = copy.deepcopy(SHIPPED[draw(st.sampled_from(sorted(SHIPPED)))])
    for _ in range(draw(st.integers(1, 3))):
        *way, last = draw(st.sampled_from(places(data)))
        node: Any = data
        for step in way:
            node = node[step]
        what = draw(st.sampled_from(["change", "change", "change", "remove", "rename", "add"]))
        if what == "change":
            node[last] = draw(anything)
        elif what == "remove":
            del node[last]
        elif isinstance(node, dict):
            value = node[last] if what == "add" else node.pop(last)
            node[draw(keys)] = value if what == "rename" else draw(anything)
        if not data:
            break
    return data


def judge_message(refusal: InvalidValueError) -> None:
    """One line for each mistake, of a length that is read, and no more of them than are read."""
    lines = str(refusal).split("\n")
    assert len(lines) == min(1 + len(getattr(refusal, "others", ())), MOST_TOLD + 1)
    assert all(0 < len(line) < 1000 for line in lines)


def judge(data_or_text: Any) -> None:
    """Load it: a refusal in one printable line, or a scenario that can be built, written and read again."""
    try:
        if isinstance(data_or_text, dict):
            scenario = ScenarioFile.read(data_or_text)
        elif isinstance(data_or_text, Path):
            scenario = ScenarioFile.load(data_or_text)
        else:
            scenario = ScenarioFile.loads(data_or_text)
    except InvalidValueError as refusal:
        judge_message(refusal)
        return
    try:
        assert isinstance(scenario.system(), RollingSystem)
        assert isinstance(scenario.start_state(), State)
    except TrundleError as refusal:
        judge_message(refusal)
    again = ScenarioFile.loads(scenario.to_toml())
    assert again == scenario
    assert again.to_toml() == scenario.to_toml()


@settings(deadline=None, max_examples=400, suppress_health_check=[HealthCheck.too_slow])
@given(spoiled())
def test_spoiled_scenarios(data: dict[str, Any]) -> None:
    judge(data)


@st.composite
def spoiled_text(draw: st.DrawFn) -> str:
    """The text of a shipped scenario with a piece cut out and another put in."""
    text = TEXTS[draw(st.sampled_from(sorted(TEXTS)))]
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(text)))
        end = draw(st.integers(start, min(len(text), start + 40)))
        piece = draw(
            st.text(max_size=6)
            | st.sampled_from(
                [
                    '"',
                    "'",
                    "\n",
                    "=",
                    "[",
                    "]",
                    "[[",
                    "{",
                    "nan",
                    "inf",
                    "1e999",
                    "0x",
                    '"""',
                    "\\",
                    "\r",
                    "\0",
                    "#",
                ]
            )
        )
        text = text[:start] + piece + text[end:]
    return text


@settings(deadline=None, max_examples=250)
@given(spoiled_text() | st.text(max_size=80))
def test_spoiled_texts(text: str) -> None:
    judge(text)


@settings(deadline=None, max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.binary(max_size=80)
    | st.builds(
        lambda text, junk: text.encode() + junk,
        st.sampled_from(sorted(TEXTS.values())),
        st.binary(max_size=8),
    )
)
def test_raw_bytes(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "any.toml"
    file.write_bytes(content)
    judge(file)


@pytest.mark.parametrize("name", sorted(SHIPPED))
def test_unspoiled_scenarios_are_what_the_fuzz_starts_from(name: str) -> None:
    assert len(places(SHIPPED[name])) > 15
    assert tomllib.loads(ScenarioFile.read(SHIPPED[name], name).to_toml()) == SHIPPED[name]
