"""What a run shows, in a sentence and as curves: as the package computes it, in step with the film, and to be saved."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page, Route, expect

import trundle as tr

from .bench import Bench, eventually
from .visiting import Visitor


@pytest.fixture(scope="module")
def page(staying: Visitor) -> Page:
    return staying.open("#/bench?name=billiard-follow", drawn=False, cards=False)


def read(page: Page, kind: str) -> str:
    """Take the lower curve with you, and read what came."""
    with page.expect_download() as coming:
        page.get_by_role("combobox", name="Take this curve with you").nth(1).select_option(kind)
    return Path(coming.value.path()).read_text(encoding="utf-8")


def test_the_stage_says_what_happens_beside_what_theory_says(page: Page) -> None:
    grip = tr.Scenario.load("billiard-follow").run().events[0].time
    Bench(page)
    expect(page.locator(".headline-text")).to_have_text(f"Slips for {grip:.4g} s, then rolls")
    expect(page.locator(".headline-other")).to_have_text(f"predicted {grip:.4g} s")


def test_any_quantity_against_any_other_as_the_package_has_it(page: Page) -> None:
    bench = Bench(page)
    bench.tab("Curves")
    page.get_by_role("combobox", name="Quantity of this curve").nth(1).select_option("slip")
    page.get_by_role("combobox", name="Against what it is drawn").nth(1).select_option("kinetic")
    rows = [line.split(",") for line in read(page, "csv").splitlines()]
    assert rows[0] == ["Time (s)", "Kinetic energy (J)", "Slip speed (m/s)"]
    run = tr.Scenario.load("billiard-follow").run()
    times = np.array([float(row[0]) for row in rows[1:]])
    slips = np.array([float(row[2]) for row in rows[1:]])
    seen = np.linalg.norm(run.at(times[:-1]).data.slip_velocity.values, axis=1)
    assert np.allclose(slips[:-1], seen, atol=1e-6)
    assert "Slip speed (m/s)" in read(page, "svg")


def test_a_curve_is_in_step_with_the_film_and_leads_to_its_instants(page: Page) -> None:
    bench = Bench(page)
    bench.tab("Curves")
    place = page.locator(".curve-place").first
    box = place.bounding_box()
    assert box
    before = page.locator(".playdot").first.get_attribute("transform")
    place.click(position={"x": 0.6 * box["width"], "y": 0.5 * box["height"]})

    def there() -> None:
        assert 0.8 < bench.stage.drawn().time < 1.4
        assert page.locator(".playdot").first.get_attribute("transform") != before

    eventually(page, there)


def test_curves_that_nobody_looks_at_come_when_the_numbers_rest(page: Page) -> None:
    bench, asked = Bench(page), list[bool]()
    page.route("**/api/simulate", lambda route: _note(route, asked))
    curve = page.locator(".curve-place").first

    def come() -> None:
        assert asked[-1:] == [True]

    def drag(share: float) -> list[bool]:
        """Drag a slider, and return of each scene whether it was asked for with curves, up to one that was."""
        asked.clear()
        bench.slide("start.velocity.0", share)
        eventually(page, come)
        return asked[:]

    shown = curve.get_attribute("aria-label") or ""
    bench.tab("Numbers")
    *moving, _ = drag(0.7)
    assert set(moving) == {False}
    bench.tab("Curves")
    expect(curve).not_to_have_attribute("aria-label", shown)
    assert all(drag(0.3))


def _note(route: Route, asked: list[bool]) -> None:
    asked.append(route.request.post_data_json.get("curves", True))
    route.continue_()
