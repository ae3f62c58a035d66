"""Every download is fetched by its button, and read again by the package or by what it is made for."""

from __future__ import annotations

import json
import struct
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, expect

import trundle as tr
from trundle.scenario import files

from .bench import Bench, Stage, colours, eventually, linked
from .launching import SMALL
from .visiting import Visitor
from .watching import Watch

NAME = "level-turntable-nudged"


@pytest.fixture(scope="module")
def scenario() -> tr.Scenario:
    """A short run that does not ship."""
    tables = tomllib.loads(files.read(NAME))
    tables["support"]["motion"]["rate"] = "45 rpm"
    tables["run"] = {"duration": "3 s", "every": "20 ms"}
    return tr.Scenario.read(tables)


@pytest.fixture(scope="module")
def bench(staying: Visitor, scenario: tr.Scenario) -> Bench:
    """The scenario, opened by link, in one page for all."""
    return Bench(staying.open(linked(tomllib.loads(scenario.to_toml())), accept_downloads=True))


def fetch(bench: Bench, kind: str, folder: Path) -> Path:
    """Choose a kind from the menu, and keep the file under the name that it comes with."""
    bench.page.get_by_role("button", name="Download").click()
    with bench.page.expect_download(timeout=90_000) as download:
        bench.page.locator(f'[data-format="{kind}"]').click()
    path = folder / download.value.suggested_filename
    download.value.save_as(path)
    return path


def test_toml(bench: Bench, scenario: tr.Scenario, tmp_path: Path) -> None:
    path = fetch(bench, "toml", tmp_path)
    assert path.suffix == ".toml"
    assert tr.Scenario.loads(path.read_text(encoding="utf-8")) == scenario
    assert tr.Scenario.load(path).run().data.equals(scenario.run().data)


def test_csv(bench: Bench, scenario: tr.Scenario, tmp_path: Path) -> None:
    path = fetch(bench, "csv", tmp_path)
    assert path.suffix == ".csv"
    table = np.genfromtxt(path, delimiter=",", names=True, comments="#")
    data = scenario.run().data
    names = {name.lower(): name for name in table.dtype.names}
    time = next(names[name] for name in names if name.startswith("time"))
    assert table[time] == pytest.approx(data.time.values, abs=1e-12)
    for axis in "xyz":
        column = next(names[name] for name in names if name.startswith("position") and axis in name.split("_")[1:2])
        assert table[column] == pytest.approx(data.position.sel(axis=axis).values, abs=1e-12)


def test_netcdf(bench: Bench, scenario: tr.Scenario, tmp_path: Path) -> None:
    path = fetch(bench, "nc", tmp_path)
    assert path.suffix == ".nc"
    loaded, run = tr.Trajectory.load(path), scenario.run()
    for name in run.data.data_vars:
        np.testing.assert_array_equal(loaded.data[name].values, run.data[name].values)
    assert tr.Scenario.loads(loaded.scenario) == scenario
    assert loaded.card().passed


def test_png_figure(bench: Bench, tmp_path: Path) -> None:
    with Image.open(fetch(bench, "png", tmp_path)) as picture:
        assert picture.format == "PNG"
        assert min(picture.size) >= 500
        assert len(picture.convert("RGB").getcolors(maxcolors=10_000_000) or ()) > 50


def test_svg_figure(bench: Bench, tmp_path: Path) -> None:
    root = ET.parse(fetch(bench, "svg", tmp_path)).getroot()  # noqa: S314
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert len(list(root.iter("{http://www.w3.org/2000/svg}path"))) > 5


def test_picture_of_the_stage(bench: Bench, tmp_path: Path) -> None:
    with Image.open(fetch(bench, "stage", tmp_path)) as picture:
        assert picture.format == "PNG"
        assert len(picture.convert("RGB").getcolors(maxcolors=10_000_000) or ()) > 500


def test_self_contained_page(bench: Bench, browser: Browser, scenario: tr.Scenario, tmp_path: Path) -> None:
    """It opens from a file, asks for nothing, plays, and shows the body where the package says that it is."""
    path = fetch(bench, "html", tmp_path)
    assert path.suffix == ".html"
    watch = Watch(("file:",))
    context = browser.new_context(viewport=SMALL, reduced_motion="reduce", offline=True)
    watch.over(context)
    page = context.new_page()
    page.goto(path.as_uri())
    stage = Stage(page, page)
    expect(stage.canvas).to_be_visible()
    stage.canvas.focus()
    last = scenario.run().in_frame("world").data.position.values[-1]

    def ends() -> None:
        page.keyboard.press("End")
        assert stage.drawn().place == pytest.approx(tuple(last), abs=2e-5)

    eventually(page, ends)
    page.keyboard.press("Home")
    page.get_by_role("button", name="Play").click()
    eventually(page, lambda: goes(stage))
    assert colours(stage.middle()) > 100, "the stage is blank"
    context.close()
    assert watch.left() == []


def goes(stage: Stage) -> None:
    assert stage.drawn().time > 0.1


def test_glb(bench: Bench, tmp_path: Path) -> None:
    """The header, the chunks and the animation, read as the glTF 2.0 specification lays them out."""
    content = fetch(bench, "glb", tmp_path).read_bytes()
    magic, version, length = struct.unpack_from("<4sII", content)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack_from("<I4s", content, 12)
    assert kind == b"JSON"
    told = json.loads(content[20 : 20 + size])
    binary, kind = struct.unpack_from("<I4s", content, 20 + size)
    assert kind == b"BIN\x00"
    assert told["asset"]["version"] == "2.0"
    assert told["meshes"]
    assert all(view["byteOffset"] + view["byteLength"] <= binary for view in told["bufferViews"])
    animation = told["animations"][0]
    paths = {channel["target"]["path"] for channel in animation["channels"]}
    assert {"translation", "rotation"} <= paths
    last = max(told["accessors"][sampler["input"]]["max"][0] for sampler in animation["samplers"])
    assert last == pytest.approx(3.0, abs=1e-6)


def test_gif(bench: Bench, tmp_path: Path) -> None:
    with Image.open(fetch(bench, "gif", tmp_path)) as film:
        assert film.format == "GIF"
        assert film.n_frames > 10
        first = np.asarray(film.convert("RGB"), dtype=int)
        film.seek(film.n_frames // 2)
        middle = np.asarray(film.convert("RGB"), dtype=int)
        assert np.mean(np.abs(middle - first).max(axis=2) > 30) > 1e-3, "nothing moves"


def test_a_scenario_that_cannot_run_is_told_instead_of_a_file(visitor: Visitor) -> None:
    visitor.watch.allow("status of 422")
    bench = Bench(visitor.open(f"#/bench?name={NAME}", drawn=False))
    box = bench.box("body.radius")
    box.fill("-25 mm")
    box.press("Enter")
    bench.page.get_by_role("button", name="Download").click()
    bench.page.locator('[data-format="csv"]').click()
    expect(bench.page.locator(".toast-error")).to_contain_text("body.radius must be positive")
