"""The page about the scenario file shows files that load, and messages as they are."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from trundle.errors import ScenarioError
from trundle.scenario import ScenarioFile, files

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
