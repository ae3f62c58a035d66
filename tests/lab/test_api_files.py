"""Every file that the lab gives is opened again, and every file that it takes is read in full or refused in words."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from PIL import Image
from starlette.testclient import TestClient
from tests.lab.conftest import shipped

import trundle as tr
from trundle.views.viewer.exports import FORMATS

NAME = "level-turntable-nudged"
KINDS = sorted(ending.removeprefix(".") for ending in FORMATS)


def exported(lab: TestClient, kind: str, name: str = NAME) -> bytes:
    answer = lab.post("/api/export", json={"scenario": shipped(name), "format": kind})
    if kind == "html" and answer.status_code == 422 and answer.json()["error"]["kind"] == "NotBuiltError":
        pytest.skip("the viewer is not built into this copy: python web/build.py bundle")
    assert answer.status_code == 200, answer.text[:500]
    assert answer.headers["content-type"].startswith(FORMATS[f".{kind}"].media_type.partition(";")[0])
    assert answer.headers["content-disposition"].endswith(f'.{kind}"')
    return answer.content


def test_toml_is_the_scenario(lab: TestClient) -> None:
    assert tr.Scenario.loads(exported(lab, "toml").decode()) == tr.Scenario.load(NAME)


def test_a_table_holds_every_digit_and_names_its_units(lab: TestClient) -> None:
    rows = list(csv.reader(io.StringIO(exported(lab, "csv").decode(), newline="")))
    run = tr.Scenario.load(NAME).run()
    assert rows[0][:4] == ["time [s]", "position_x [m]", "position_y [m]", "position_z [m]"]
    assert "angular_velocity_z [rad/s]" in rows[0]
    assert "orientation_w" in rows[0]
    x = np.array([float(row[1]) for row in rows[1:]])
    assert np.array_equal(x, run.data.position.sel(axis="x"))


def test_trundle_check_reads_the_table(lab: TestClient, tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(exported(lab, "csv"))
    assert tr.check(path, tr.Scenario.load(NAME)).passed


def test_a_saved_run_is_the_run(lab: TestClient, tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    path.write_bytes(exported(lab, "nc"))
    again = tr.Trajectory.load(path)
    assert again.data.identical(tr.Scenario.load(NAME).run().data)
    opened = lab.post("/api/open", content=path.read_bytes(), headers={"content-type": "application/x-netcdf"})
    assert tr.Scenario.read(opened.json()["scenario"]) == tr.Scenario.load(NAME)


def test_figures_are_pictures(lab: TestClient) -> None:
    picture = Image.open(io.BytesIO(exported(lab, "png")))
    assert picture.size[0] > 800
    assert len(set(picture.convert("L").resize((64, 64)).get_flattened_data())) > 5
    root = ET.fromstring(exported(lab, "svg"))  # noqa: S314  of our own making
    assert root.tag.endswith("svg")


def test_an_animation_moves(lab: TestClient) -> None:
    picture = Image.open(io.BytesIO(exported(lab, "gif")))
    assert 2 <= picture.n_frames <= 200
    frames = []
    for number in (0, picture.n_frames // 2, picture.n_frames - 1):
        picture.seek(number)
        frames.append(np.asarray(picture.convert("RGB"), dtype=int))
    assert all((np.abs(frames[i] - frames[i - 1]).sum(axis=-1) > 60).sum() > 50 for i in (1, 2))


def test_what_may_be_asked_for_is_what_can_be_made(lab: TestClient) -> None:
    """The schema says it, and a form that is none is refused with those that are."""
    asked = lab.get("/api/openapi.json").json()["components"]["schemas"]["ToExport"]["properties"]["format"]
    assert sorted(asked["enum"]) == KINDS
    error = lab.post("/api/export", json={"scenario": shipped(NAME), "format": "mp4"}).json()["error"]
    assert error["key"] == "format"
    assert all(kind in error["message"] for kind in KINDS)


def test_a_model_is_one_that_other_programs_read(lab: TestClient) -> None:
    content = exported(lab, "glb")
    assert content[:4] == b"glTF"
    assert int.from_bytes(content[8:12], "little") == len(content)


def test_a_page_holds_the_whole_run_and_asks_nobody(lab: TestClient) -> None:
    page = exported(lab, "html").decode()
    assert page.startswith("<!doctype html>")
    assert 'src="http' not in page
    assert tr.Scenario.load(NAME).title in page


@pytest.mark.parametrize("kind", KINDS)
def test_a_path_is_exported_too(lab: TestClient, kind: str) -> None:
    assert len(exported(lab, kind, "roll-x-then-y")) > 100


def test_a_dropped_scenario_is_read_whatever_it_calls_itself(lab: TestClient) -> None:
    text = tr.Scenario.load(NAME).to_toml().encode()
    for kind in ("application/toml", "text/plain", "application/octet-stream"):
        opened = lab.post("/api/open", content=b"\xef\xbb\xbf" + text, headers={"content-type": kind}).json()
        assert tr.Scenario.loads(opened["toml"]) == tr.Scenario.load(NAME)
        assert opened["scenario"]["body"]["radius"] == "25 mm"


def test_a_dropped_path_is_read(lab: TestClient) -> None:
    text = tr.PathScenario.load("roll-x-then-y").to_toml()
    assert "path" in lab.post("/api/open", content=text).json()["scenario"]


def test_what_is_no_scenario_is_refused_in_words(lab: TestClient, tmp_path: Path) -> None:
    whole = tr.Scenario.load(NAME).run(duration=1.0).save(tmp_path / "run.nc").read_bytes()
    for content, said in (
        (b"", "must hold a scenario"),
        (b"radius = 25 mm", "is not valid TOML"),
        (b"\xff\xfe\x00", "neither a scenario"),
        (whole[: len(whole) // 2], "holds no scenario"),
        (b"\x89HDF\r\n\x1a\n" + bytes(200), "holds no scenario"),
        (b"[body]\nradius = 1\nmass = -1", "kind"),
    ):
        answer = lab.post("/api/open", content=content)
        assert answer.status_code == 422
        assert said in answer.json()["error"]["message"]
        assert "/" not in answer.json()["error"]["message"].replace("kg/m", "")  # no path of the server's


def test_a_bad_key_in_a_dropped_file_is_named(lab: TestClient) -> None:
    text = tr.Scenario.load(NAME).to_toml().replace("25 mm", "25 g")
    error = lab.post("/api/open", content=text).json()["error"]
    assert (error["key"], error["kind"]) == ("body.radius", "ScenarioError")
    assert "must be a length" in error["message"]
