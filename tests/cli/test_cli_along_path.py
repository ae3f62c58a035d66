"""`trundle run` and `show` for a path to roll along: what they print, what they leave, how they end."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import xarray

import trundle as tr
from trundle.scenario import files
from trundle.scenario.path_file import PathFile

from .conftest import Command
from .test_cli_commands import on_a_terminal


def test_a_path_leaves_a_file_and_a_figure_and_tells_the_stages(trundle: Command, folder: Path) -> None:
    done = trundle("run", "roll-x-then-y")
    assert (done.status, done.err) == (0, "")
    assert done.files == {"roll-x-then-y", "roll-x-then-y/run.nc", "roll-x-then-y/stages.png"}
    *_, start, first, second, wrote = done.out.splitlines()
    side = 2.5 * math.pi / 2
    assert start == "start    (0, 0) cm, north pole up"
    assert first == f"stage 1  ({side:.4g}, 0) cm, north pole along +x"
    assert second == f"stage 2  ({side:.4g}, {side:.4g}) cm, north pole along +x"
    assert wrote == "Wrote roll-x-then-y/run.nc, roll-x-then-y/stages.png"
    assert (folder / "roll-x-then-y" / "stages.png").read_bytes().startswith(b"\x89PNG")


def test_the_file_holds_the_path_and_its_evidence(here: Command, folder: Path) -> None:
    done = here("run", "roll-home-turned", "--no-figure", "--every", "1 mm")
    assert done.files == {"roll-home-turned", "roll-home-turned/run.nc"}
    data = xarray.load_dataset(folder / "roll-home-turned" / "run.nc", engine="h5netcdf")
    assert set(data.data_vars) == {"position", "contact", "heading", "orientation", "north_pole", "stage_distance"}
    assert {data[name].attrs["units"] for name in ("position", "contact", "distance")} == {"m"}
    side = 0.025 * math.pi / 2
    np.testing.assert_allclose(data.stage_distance, side * np.arange(5), rtol=1e-14)
    np.testing.assert_allclose(data.north_pole[-1], [0, -1, 0], atol=1e-14)
    np.testing.assert_allclose(data.position[:, 2], 0.025)
    steps = np.diff(data.distance)
    assert steps.max() <= 0.001 * (1 + 1e-12)
    assert tr.PathScenario.loads(data.attrs["scenario"]).sampling.every == 0.001
    assert tr.Card.from_json(data.attrs["card"]).passed


def test_json_and_quiet(here: Command) -> None:
    done = here("run", "roll-small-loop", "--json", "--no-figure")
    assert (done.status, done.err) == (0, "")
    assert json.loads(done.out) == tr.PathScenario.load("roll-small-loop").run().card().as_dict()
    done = here("run", "roll-small-loop", "-q", "--no-figure", "-o", "elsewhere")
    assert (done.status, done.out, done.err) == (0, "", "")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--duration", "3 s"], "`--duration` is for motions under forces; got '3 s'."),
        (["--method", "exact"], "`--method` is for motions under forces; got 'exact'."),
        (["--tolerance", "1e-9"], "`--tolerance` is for motions under forces; got '1e-09'."),
        (["--every", "3 s"], "`--every` must be a length; got '3 s'."),
        (["--every", "0 m"], "`--every` must be positive; got '0 m'."),
    ],
)
def test_options_that_have_no_place(here: Command, words: list[str], said: str) -> None:
    done = here("run", "roll-x-then-y", *words)
    assert (done.status, done.out, done.files) == (2, "", set())
    assert said in done.err


def test_a_wrong_path_leaves_nothing(here: Command, folder: Path) -> None:
    text = files.read("roll-small-loop").replace('angle = "1 turn"', 'angel = "1 turn"')
    (folder / "mine.toml").write_text(text, encoding="utf-8")
    done = here("run", "mine.toml")
    assert (done.status, done.files) == (2, {"mine.toml"})
    assert "mine.toml: `path[0].angel` is no key of [path[0]]; got '1 turn'. Did you mean 'angle'?" in done.err
    assert here("show", "mine.toml").status == 2


def test_a_failed_check_is_told(here: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    from trundle.analysis.geometry import bends

    honest = bends.turn
    monkeypatch.setattr(bends, "turn", lambda *words: honest(*words) * [1, 1, -1, 1])
    done = here("run", "roll-x-then-y", "--no-figure")
    assert done.status == 3
    assert "the card fails: no slip" in done.err


def test_show_tells_what_to_expect_on_a_terminal_and_the_file_in_a_pipe(here: Command, folder: Path) -> None:
    assert here("show", "roll-y-then-x").out == files.read("roll-y-then-x")
    shown = on_a_terminal(["show", "roll-y-then-x"], folder)
    assert "north pole along +y" in shown
    assert "120 deg about (-0.57735, 0.57735, 0.57735)" in shown


def test_schema(here: Command) -> None:
    assert json.loads(here("schema", "--path").out) == PathFile.schema()
