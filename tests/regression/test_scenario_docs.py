"""The page about the scenario file shows files that load, and lists every key and kind that there is."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from trundle.errors import ScenarioError
from trundle.scenario import ScenarioFile, files
from trundle.scenario.tables import KINDS

PAGE = (Path(__file__).parents[2] / "docs" / "scenario-file.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.splitlines()[0])
def test_each_piece_stands_in_a_whole_scenario(block: str) -> None:
    """A piece of a file replaces that table of the page's first block, a whole one."""
    whole: dict[str, Any] = tomllib.loads(BLOCKS[0])
    piece = tomllib.loads(block)
    scenario = ScenarioFile.read({**whole, **piece})
    scenario.start_state()
    assert {**whole, **piece, "title": scenario.title} == tomllib.loads(scenario.to_toml())


def rows(heading: str) -> list[str]:
    section = PAGE.partition(f"### {heading}\n")[2].partition("\n#")[0]
    firsts = re.findall(r"^\| (`[^|]*) \|", section, re.MULTILINE)
    return [key for cell in firsts for key in re.findall(r"`([\w.-]+)`", cell)]


def keys_of(*tables: Any) -> set[str]:
    return {field.alias or key for table in tables for key, field in table.model_fields.items()}


def test_every_key_is_listed_and_no_other() -> None:
    top = keys_of(ScenarioFile) - {"body", "support", "start", "loads", "run"}
    assert set(rows("At the top")) == top
    assert set(rows("`[body]`")) == keys_of(*KINDS["body"].values())
    motion = {f"motion.{key}" for key in keys_of(*KINDS["support.motion"].values())}
    assert set(rows("`[support]` and `[support.motion]`")) == keys_of(*KINDS["support"].values()) - {"motion"} | motion
    assert set(rows("`[start]`")) == keys_of(ScenarioFile.model_fields["start"].annotation)
    assert set(rows("`[run]`")) == keys_of(ScenarioFile.model_fields["timing"].annotation)
    assert [row for row in rows("`[[loads]]`")[1:] if row != "air"] == list(KINDS["loads"])


def test_every_kind_is_named() -> None:
    for kinds in KINDS.values():
        for kind in kinds:
            assert f"`{kind}`" in PAGE


def test_the_messages_shown_are_the_messages() -> None:
    shown = re.search(r"prints\n\n```text\n(.*?)```", PAGE, re.DOTALL)
    assert shown is not None
    text = files.read("tilted-turntable")
    for wrong, message in zip(
        ('radios = "25 mm"', 'radius = "25 g"', "radius = nan"), shown[1].splitlines(), strict=True
    ):
        with pytest.raises(ScenarioError) as caught:
            ScenarioFile.loads(text.replace('radius = "25 mm"', wrong), "my-table.toml")
        assert str(caught.value) == message
