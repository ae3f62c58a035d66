"""Maps in the lab: what a field shows is what the package finds there, and the run beside it is that of the field."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from playwright.sync_api import Page, expect

import trundle as tr
from trundle.analysis.sweep import shipped
from trundle.lab.links import encode
from trundle.scenario import files

from .axe import violations
from .bench import as_shown, decoded, eventually, number
from .launching import LAPTOP, PATIENCE, PHONE
from .visiting import Visitor

# A ball on an incline that rolls off at the end of it, or does not get there in time.
TABLES: dict[str, Any] = {
    "title": "Down an incline",
    "body": {"kind": "solid-sphere", "radius": "20 mm", "mass": "100 g"},
    "support": {"kind": "plane", "tilt": "2 deg", "rim": "20 cm"},
    "start": {"position": ["-10 cm", 0], "velocity": [0, 0]},
    "run": {"duration": "1.5 s", "every": "20 ms"},
}
SPANS = [
    {"key": "support.tilt", "from": "1 deg", "to": "5 deg", "count": 12, "scale": "linear"},
    {"key": "support.rim", "from": "15 cm", "to": "60 cm", "count": 10, "scale": "log"},
]


def linked(measure: str, **more: str) -> str:
    code = encode({"scenario": TABLES, "over": SPANS, "measure": measure})
    return "#/maps?" + "&".join([f"m={code}", *(f"{key}={value}" for key, value in more.items())])


def finished(page: Page) -> None:
    expect(page.get_by_test_id("map-progress")).to_have_text(re.compile(r"\d+ runs"), timeout=4 * PATIENCE)


def reading(page: Page) -> str:
    return page.get_by_test_id("map-readout").inner_text()


def falls(i: int, j: int) -> float:
    """When the ball of a field is over the rim, by hand: 5/7 g sin(tilt) t²/2 of its way there."""
    tilt = np.radians(np.linspace(1, 5, 12)[i])
    way = np.geomspace(0.15, 0.6, 10)[j] + 0.1
    return float(np.sqrt(2 * way / (5 / 7 * 9.80665 * np.sin(tilt))))


def test_a_class_is_what_happens_there_and_only_its_boundary_is_run(visitor: Visitor) -> None:
    page = visitor.open(linked("ending"), drawn=False)
    finished(page)
    expect(page.get_by_test_id("map-progress")).to_contain_text("lie within one class")
    expect(page.get_by_test_id("map-legend")).to_contain_text("none")
    expect(page.get_by_test_id("map-legend")).to_contain_text("rim")
    plot = page.get_by_test_id("map")
    box = plot.bounding_box()
    assert box is not None
    for i, j in ((0, 0), (11, 0), (11, 9), (4, 3), (8, 7)):
        where = {"x": (i + 0.5) / 12 * box["width"], "y": (1 - (j + 0.5) / 10) * box["height"]}
        plot.click(position=where)  # type: ignore[arg-type]
        word = "rim" if falls(i, j) < 1.5 else "none"
        eventually(page, lambda word=word: expect(page.get_by_test_id("map-readout")).to_contain_text(f"ending {word}"))


def test_a_number_is_the_packages_and_the_run_goes_to_the_bench(visitor: Visitor) -> None:
    """By keys alone: to the map, a step on it, and by the link again to the same point."""
    page = visitor.open(linked("max hypot(x, y)", at="3,4"))
    finished(page)
    plot = page.get_by_test_id("map")
    plot.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowDown")
    tables = {
        **TABLES,
        "support": {
            "kind": "plane",
            "tilt": float(np.radians(np.linspace(1, 5, 12)[4])),
            "rim": float(np.geomspace(0.15, 0.6, 10)[3]),
        },
    }
    run = tr.Scenario.read(tables).run()
    farthest = float(np.hypot(*run.data.position.values[:, :2].T).max())
    assert number(reading(page).split("= ")[-1]) == as_shown(farthest)
    assert "Support: Tilt = 2.455 deg" in reading(page)
    eventually(page, lambda: expect(page.locator('[data-bodies="1"]')).to_be_attached())
    eventually(page, lambda: expect(page).to_have_url(re.compile(r"at=4%2C3$")))
    page.reload()
    finished(page)
    assert "Support: Tilt = 2.455 deg" in reading(page)
    page.get_by_test_id("map-bench").click()
    expect(page).to_have_url(re.compile(r"#/bench\?s="))
    sent = tr.Scenario.read(decoded(page.url.split("s=")[1]))
    assert sent.support.tilt == tables["support"]["tilt"]


def test_another_map_is_asked_for_and_a_wrong_value_told_of(visitor: Visitor) -> None:
    visitor.watch.allow("status of 422")
    page = visitor.open(linked("ending"), drawn=False)
    finished(page)
    page.get_by_text("Change this map").click()
    first = page.get_by_role("group", name="Across").get_by_role("textbox", name="from")
    first.fill("1 kg")
    page.get_by_test_id("map-draw").click()
    expect(page.get_by_test_id("map-wrong")).to_contain_text("Support: Tilt")
    expect(first).to_have_attribute("aria-invalid", "true")
    assert not violations(page, ".map-form")
    first.fill("3 deg")
    page.get_by_test_id("map-measure").fill("end-time")
    page.get_by_test_id("map-draw").click()
    expect(page.get_by_test_id("map-legend")).to_contain_text("end-time (s)")
    expect(page.get_by_test_id("map-wrong")).to_be_hidden()
    finished(page)


def test_what_is_on_the_bench_has_a_map(visitor: Visitor) -> None:
    slow = {**files.tables_of("rattleback"), "run": {"duration": "4 s", "every": "10 ms"}}  # whose map takes long
    page = visitor.open(f"#/bench?s={encode(slow)}", drawn=False, cards=False)
    expect(page.locator('[data-bodies="1"]')).to_be_attached()
    page.get_by_role("link", name="Maps").click()
    page.get_by_test_id("map-choice").select_option(label="The scenario on the bench")
    expect(page.get_by_test_id("map-legend")).to_contain_text("max hypot(vx, vy) (m s⁻¹)")
    page.get_by_role("button", name="Stop").click()
    expect(page.get_by_role("button", name="Go on")).to_be_visible()


def test_the_work_stops_when_the_page_is_left(visitor: Visitor) -> None:
    """Of a map that takes long."""
    page = visitor.open("#/maps?name=rattleback", drawn=False, cards=False)
    with page.expect_request("**/api/map"):
        pass
    with page.expect_event("requestfailed", lambda request: request.url.endswith("/api/map")):
        page.get_by_role("link", name="Bench").click()
    asked = len(list(visitor.watch.asked_for("/api/map")))
    expect(page.locator('[data-bodies="1"]')).to_be_attached()
    assert len([one for one in visitor.watch.asked_for("/api/map") if one.endswith("/map")]) <= asked


def test_it_fits_a_laptop_and_a_phone(visitor: Visitor) -> None:
    page = visitor.open(linked("ending", at="3,4"), size=LAPTOP, drawn=False)
    finished(page)
    box = page.get_by_test_id("map-readout").bounding_box()
    assert box is not None
    assert box["y"] + box["height"] <= LAPTOP["height"], "the map and its reading are not seen at once"
    page.set_viewport_size(PHONE)  # type: ignore[arg-type]
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0


def test_the_shipped_sweeps_are_offered(visitor: Visitor) -> None:
    page = visitor.open(linked("ending"), drawn=False)
    offered = page.get_by_test_id("map-choice").get_by_role("option")
    expect(offered).to_have_text([*(title for _, title in shipped.titles()), "The scenario on the bench"])
