"""`trundle export`: each form reopened, each mistake named."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pandas as pd
import pygltflib
import pytest
from PIL import Image

import trundle as tr
from trundle.cli import run as command
from trundle.errors import TrundleError, UnknownNameError
from trundle.views.viewer.exports import FORMATS, export

NAME = "level-turntable-nudged"
Say = Callable[..., tuple[int, str, str]]


@pytest.fixture
def say(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Say:
    """The command in an empty folder; gives status, output and errors."""
    monkeypatch.chdir(tmp_path)

    def called(*words: str) -> tuple[int, str, str]:
        status = command(["export", *words])
        printed = capfd.readouterr()
        return status, printed.out, printed.err

    return called


def test_the_help_names_every_form(say: Say) -> None:
    status, out, _ = say("--help")
    assert status == 0
    assert [ending for ending in FORMATS if f"{ending}:" not in out.replace(",", ":")] == []


def test_a_scenario_is_run_and_written_as_a_page(say: Say) -> None:
    status, out, err = say(NAME, "scene.html")
    assert (status, err) == (0, "")
    assert out.startswith("Wrote scene.html (")
    assert Path("scene.html").read_bytes().startswith(b"<!doctype html>")
    assert [path.name for path in Path().iterdir()] == ["scene.html"]


def test_a_saved_run_gives_the_same_numbers_as_its_scenario(say: Say) -> None:
    assert say(NAME, "run.nc", "-q") == (0, "", "")
    assert say("run.nc", "path.csv")[0] == 0
    table, run = pd.read_csv("path.csv"), tr.Scenario.load(NAME).run()
    assert np.array_equal(table["position_y [m]"], run.data.position.sel(axis="y"))
    assert np.array_equal(table["time [s]"], run.data.time)
    assert say("run.nc", "again.toml")[0] == 0
    assert tr.Scenario.load("again.toml") == tr.Scenario.load(NAME)


def test_pictures_and_models_open_again(say: Say) -> None:
    for name in ("path.png", "path.svg", "scene.glb"):
        assert say(NAME, name)[0] == 0
    with Image.open("path.png") as picture:
        assert picture.format == "PNG"
    assert ET.parse("path.svg").getroot().tag.endswith("svg")  # noqa: S314  our own
    assert pygltflib.GLTF2().load("scene.glb").animations


def test_an_animation_moves_and_lasts_as_it_says() -> None:
    run = tr.Scenario.load(NAME).run(duration=1.0)
    film = Image.open(BytesIO(export(run, ".gif")))
    lasting, pictures = [], []
    for at in range(film.n_frames):  # type: ignore[attr-defined]
        film.seek(at)
        lasting.append(film.info["duration"])
        pictures.append(np.asarray(film.convert("RGB"), dtype=int))
    assert sum(lasting[:-1]) == pytest.approx(1000, abs=60), "in real time"
    assert all(np.abs(one - other).max() > 30 for one, other in pairwise(pictures))


@pytest.mark.parametrize(("duration", "wanted"), [("0.05 s", 1050), ("7 s", 8000), ("7.3 s", 8000), ("1 h", 8000)])
def test_an_animation_lasts_eight_seconds_at_most(duration: str, wanted: float) -> None:
    every = "1 s" if "h" in duration else "25 ms"
    run = tr.Scenario.load("level-turntable-nudged").run(duration=duration, every=every)
    film = Image.open(BytesIO(export(run, ".gif")))
    lasting = 0
    for at in range(film.n_frames):  # type: ignore[attr-defined]
        film.seek(at)
        lasting += film.info["duration"]
    assert lasting == wanted


def test_several_runs_make_one_page(say: Say) -> None:
    assert say("tilted-turntable", NAME, "both.html")[0] == 0
    assert Path("both.html").read_bytes().count(b"data-trundle-scene>") == 2


@pytest.mark.parametrize("ending", FORMATS)
def test_a_path_that_is_rolled_along_has_every_form(say: Say, ending: str) -> None:
    assert say("roll-x-then-y", f"path{ending}")[0] == 0
    assert Path(f"path{ending}").stat().st_size > 100


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ((NAME, "scene.mp4"), "`FILE` must end in one of .html, .glb"),
        ((NAME, "scene"), "`FILE` must end in one of"),
        ((NAME, "nowhere/scene.html"), "`FILE` must lie in a folder that exists"),
        ((NAME, "tippe-top", "scene.glb"), "Only .html can hold several."),
        (("tilted-turntabel", "scene.glb"), "Did you mean 'tilted-turntable'"),
        ((NAME,), "Missing argument"),
        ((*[NAME] * 6, "scene.html"), "must be 1 to 5"),
    ],
)
def test_what_cannot_be_is_named_and_nothing_written(say: Say, words: tuple[str, ...], told: str) -> None:
    status, out, err = say(*words)
    assert (status, out) == (2, "")
    assert told in err
    assert "Traceback" not in err
    assert list(Path().iterdir()) == []


def test_a_run_does_not_overwrite_itself(say: Say) -> None:
    assert say(NAME, "run.nc")[0] == 0
    before = Path("run.nc").read_bytes()
    status, _, err = say("run.nc", "./run.nc")
    assert status == 2
    assert "must not be the run itself" in err
    assert Path("run.nc").read_bytes() == before


def test_a_missing_or_foreign_file_is_named(say: Say) -> None:
    assert "must exist" in say("gone.nc", "scene.glb")[2]
    Path("text.nc").write_text("not a run")
    assert "must be NetCDF4" in say("text.nc", "scene.glb")[2]
    assert not Path("scene.glb").exists()


@pytest.mark.skipif(os.name == "nt" or (hasattr(os, "geteuid") and os.geteuid() == 0), reason="root may write anywhere")
def test_a_folder_that_may_not_be_written_to_is_named(say: Say) -> None:
    Path("closed").mkdir(mode=0o500)
    status, _, err = say(NAME, "closed/scene.glb")
    assert status == 1
    assert "cannot be written" in err


def test_asking_for_help_loads_nothing_heavy(tmp_path: Path) -> None:
    code = (
        "import sys; from trundle.cli import run; run(['export', '--help']);"
        "print(sorted({'numpy', 'matplotlib', 'pygltflib', 'anywidget', 'xarray'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path)  # noqa: S603
    assert ".html: a page that plays it" in " ".join(done.stdout.split())
    assert done.stdout.splitlines()[-1] == "[]"


def test_in_python_too_an_unknown_form_and_a_run_without_a_file_are_named() -> None:
    with pytest.raises(UnknownNameError, match=r"'\.mp4'"):
        export(tr.Scenario.load(NAME).run(), ".mp4")
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 1.0), tr.Support(tr.Plane()))
    run = tr.simulate(system, system.place(velocity=(1.0, 0.0)), duration=1.0, every=0.5)
    object.__setattr__(run, "scenario", "")
    with pytest.raises(TrundleError, match="no words for a part of its system"):
        export(run, ".toml")
