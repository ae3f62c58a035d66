"""Links and files: what one visitor has on the bench, another gets."""

from __future__ import annotations

import base64
import tomllib
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

import trundle as tr
from trundle.scenario import files

from .bench import Bench, as_shown, circle_rate, decoded, eventually, linked
from .visiting import Visitor

NAME = "level-turntable-nudged"


def changed(name: str = NAME) -> dict:
    """A scenario that does not ship."""
    tables = tomllib.loads(files.read(name))
    tables["title"] = "Kugel auf dem Drehtisch, π·ω ≈ 10.9"
    tables["support"]["motion"]["rate"] = "45 rpm"
    tables["start"]["velocity"] = ["-3 cm/s", "0.12 m/s"]
    return tables


def shows(bench: Bench, run: tr.Trajectory) -> None:
    """What is drawn at the end, and the numbers, are those of a run."""
    bench.page.keyboard.press("End")
    place = tuple(float(value) for value in run.in_frame("world").data.position.values[-1])
    assert bench.stage.drawn().place == pytest.approx(place, abs=2e-5)
    assert bench.found(r"\kappa")[1] == as_shown(circle_rate(run))


def test_a_copied_link_opens_the_same_scenario_elsewhere(visitor: Visitor) -> None:
    bench = Bench(visitor.open(f"#/bench?name={NAME}", permissions=["clipboard-read", "clipboard-write"]))
    box = bench.box("support.motion.rate")
    box.fill("45 rpm")
    box.press("Enter")
    box.blur()
    bench.page.get_by_role("button", name="Copy link").click()
    expect(bench.page.get_by_text("Link copied")).to_be_visible()
    link = bench.page.evaluate("navigator.clipboard.readText()")
    expected = tomllib.loads(files.read(NAME))
    expected["support"]["motion"]["rate"] = "45 rpm"
    assert decoded(link.split("s=")[1]) == expected

    other = Bench(visitor.open(link.removeprefix(visitor.lab + "/"), drawn=False))
    expect(other.box("support.motion.rate")).to_have_value("45")
    expect(other.page.get_by_text(expected["title"]).first).to_be_visible()
    eventually(other.page, lambda: shows(other, tr.Scenario.read(expected).run()))
    assert other.scenario() == expected


def test_a_link_made_without_the_lab_opens(visitor: Visitor) -> None:
    tables = changed()
    bench = Bench(visitor.open(linked(tables), drawn=False))
    expect(bench.page.get_by_text(tables["title"]).first).to_be_visible()
    eventually(bench.page, lambda: shows(bench, tr.Scenario.read(tables).run()))


def test_the_link_follows_in_the_address_and_back_goes_back(visitor: Visitor) -> None:
    bench = Bench(visitor.open(f"#/bench?name={NAME}", drawn=False))
    page = bench.page
    page.get_by_role("link", name="Tour").click()
    expect(page.get_by_text("Step 1 of 7")).to_be_visible()
    page.go_back()
    bench.settle()
    expect(page.locator(".bar-title")).to_have_text(files.title_of(NAME))


@pytest.mark.parametrize("code", ["AAAA", "this-is-no-link", "%F0%9F%8E%B1"])
def test_a_damaged_link_is_told_and_the_lab_still_opens(code: str, visitor: Visitor) -> None:
    page = visitor.open(f"#/bench?s={code}", drawn=False)
    expect(page.get_by_text("The link")).to_be_visible()
    Bench(page)


def test_an_unknown_name_is_told_in_the_packages_words(visitor: Visitor) -> None:
    visitor.watch.allow("status of 404")
    page = visitor.open("#/bench?name=no-such-thing", drawn=False)
    expect(page.get_by_text("no-such-thing").first).to_be_visible()


def drop(page: Page, name: str, content: bytes) -> None:
    """Drop a file on the page, as from a file manager."""
    page.evaluate(
        """([name, content]) => {
            const bytes = Uint8Array.from(atob(content), (c) => c.charCodeAt(0))
            const dataTransfer = new DataTransfer()
            dataTransfer.items.add(new File([bytes], name))
            const target = document.querySelector('[data-testid=stage]')
            for (const type of ['dragenter', 'dragover', 'drop'])
                target.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }))
        }""",
        [name, base64.b64encode(content).decode()],
    )


def test_a_scenario_file_is_dropped_on_the_page(visitor: Visitor) -> None:
    scenario = tr.Scenario.read(changed())
    bench = Bench(visitor.open(drawn=False))
    drop(bench.page, "mine.toml", scenario.to_toml().encode())
    expect(bench.page.get_by_text("Opened mine.toml.")).to_be_visible()
    expect(bench.page.get_by_text("Kugel auf dem Drehtisch").first).to_be_visible()
    eventually(bench.page, lambda: shows(bench, scenario.run()))


def test_a_run_is_dropped_on_the_page(visitor: Visitor, tmp_path: Path) -> None:
    run = tr.Scenario.read(changed()).run()
    run.save(tmp_path / "run.nc")
    bench = Bench(visitor.open(drawn=False))
    drop(bench.page, "run.nc", (tmp_path / "run.nc").read_bytes())
    expect(bench.page.get_by_text("Opened run.nc.")).to_be_visible()
    eventually(bench.page, lambda: shows(bench, run))


def test_a_file_is_chosen_by_the_button(visitor: Visitor, tmp_path: Path) -> None:
    path = tmp_path / "chosen.toml"
    path.write_text(files.read(NAME), encoding="utf-8")
    bench = Bench(visitor.open(drawn=False))
    with bench.page.expect_file_chooser() as chooser:
        bench.page.get_by_role("button", name="Open a file").click()
    chooser.value.set_files(path)
    expect(bench.page.locator(".bar-title")).to_have_text(files.title_of(NAME))


@pytest.fixture(scope="module")
def kept(staying: Visitor) -> Bench:
    """A page that goes from one refused file to the next."""
    return Bench(staying.open(f"#/bench?name={NAME}", drawn=False))


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("words.toml", b"these are words"),
        ("picture.nc", b"\x89PNG\r\n\x1a\n"),
        ("sizes.toml", b'[body]\nkind = "cube"\n'),
    ],
)
def test_a_file_that_is_none_is_refused_and_the_bench_stays(
    name: str, content: bytes, kept: Bench, staying: Visitor
) -> None:
    staying.watch.allow(r"status of 4(22|00)")
    drop(kept.page, name, content)
    expect(kept.page.locator(".toast-error").filter(has_text=f"{name}: ")).to_be_visible()
    expect(kept.page.locator(".bar-title")).to_have_text(files.title_of(NAME))


def test_a_scenario_is_found_by_its_words(visitor: Visitor) -> None:
    bench = Bench(visitor.open(drawn=False))
    bench.page.keyboard.press("/")
    dialog = bench.page.get_by_role("dialog", name="Scenarios")
    names = files.names()
    expect(dialog.get_by_role("status")).to_have_text(f"{len(names)} of {len(names)}")
    dialog.get_by_role("searchbox").fill("nudged level")
    expect(dialog.locator("[data-scenario]").first).to_have_attribute("data-scenario", NAME)
    bench.page.keyboard.press("Enter")
    expect(dialog).to_be_hidden()
    expect(bench.page.locator(".bar-title")).to_have_text(files.title_of(NAME))
