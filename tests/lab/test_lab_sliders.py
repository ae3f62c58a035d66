"""No dead sliders: each number of each shipped scenario can be moved, and what is refused says why by its key."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Iterator
from typing import Any

import pytest
from starlette.testclient import TestClient
from tests.lab.conftest import shipped

from trundle.lab.answers import possible
from trundle.scenario.files import is_shipped_path, names

SHIPPED = [name for name in names() if not is_shipped_path(name)]
STEP = 1e-4
_QUANTITY = re.compile(r"([+-]?[\d.]+(?:e[+-]?\d+)?)(?: (\S.*))?")
Place = tuple[str | int, ...]


def numbers_of(table: Any, place: Place = ()) -> Iterator[tuple[Place, float, str]]:
    """Yield every number of a scenario that a slider holds: where it is, the number and its unit."""
    if isinstance(table, dict | list):
        items = table.items() if isinstance(table, dict) else enumerate(table)
        for key, value in items:
            yield from numbers_of(value, (*place, key))
    elif isinstance(table, str) and (found := _QUANTITY.fullmatch(table)):
        yield place, float(found[1]), found[2] or ""
    elif isinstance(table, int | float) and not isinstance(table, bool):
        yield place, float(table), ""


def moved(scenario: dict[str, Any], place: Place, number: float, unit: str) -> dict[str, Any]:
    """Return a scenario with one number changed."""
    changed = copy.deepcopy(scenario)
    holder: Any = changed
    for key in place[:-1]:
        holder = holder[key]
    holder[place[-1]] = f"{number!r} {unit}" if unit else number
    return changed


@pytest.mark.parametrize("name", SHIPPED)
def test_every_slider_can_be_moved(name: str) -> None:
    scenario = shipped(name)
    sliders = [one for one in numbers_of(scenario) if one[0][0] not in ("title", "notes", "group")]
    ways = [
        [moved(scenario, place, number + way * STEP * (abs(number) or STEP), unit) for way in (-1, 1)]
        for place, number, unit in sliders
    ]
    told = answered([one for pair in ways for one in pair])
    for i, (place, _, _) in enumerate(sliders):
        refused = [one for one in told[2 * i : 2 * i + 2] if one is not None]
        # What touches along a line rolls straight or not at all, on no other slope and in no other direction.
        line = all("along a line" in one["message"] for one in refused)
        assert len(refused) < 2 or line, (place, refused[0])
        assert all(one["key"] for one in refused)


def answered(scenarios: list[dict[str, Any]]) -> list[dict[str, Any] | None]:
    return json.loads(possible(scenarios).body)


def test_the_route_says_of_each_why_it_cannot_start(lab: TestClient) -> None:
    ball = shipped("superball")
    bouncy = moved(ball, ("support", "restitution"), 1.1, "")
    answer = lab.post("/api/possible", json={"scenarios": [ball, bouncy, shipped("roll-x-then-y")]}).json()
    assert [one and one["key"] for one in answer] == [None, "support.restitution", None]
    assert "[0, 1]" in answer[1]["message"]


def test_friction_while_it_slips_ends_at_that_which_holds() -> None:
    table = shipped("billiard-draw")
    most = float(table["support"]["friction"])
    told = answered([moved(table, ("support", "kinetic_friction"), most * part, "") for part in (0.5, 1.0, 1.01)])
    assert [one and one["key"] for one in told] == [None, None, "support.kinetic_friction"]


def test_no_more_is_tried_at_once_than_one_page_has_sliders(lab: TestClient) -> None:
    answer = lab.post("/api/possible", json={"scenarios": [{}] * 101})
    assert answer.status_code == 422
    assert "100" in answer.json()["error"]["message"]
