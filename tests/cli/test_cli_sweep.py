"""The commands `sweep`, `map` and `tolerance`."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from .conftest import Command

pytest.importorskip("heyoka")
pytest.importorskip("zarr")

SWEEP = """
title = "Rates"
scenario = "tilted-turntable"
[run]
duration = "1 s"
every = "0.5 s"
[over]
support.motion.rate = { from = "30 rpm", to = "45 rpm", count = 4 }
"start.position[0]" = ["5 cm", "10 cm", "90 cm"]
[measure]
far = "max hypot(x, y)"
how = "ending"
"""


@pytest.fixture
def sweep(folder: Path) -> Path:
    path = folder / "rates.toml"
    path.write_text(SWEEP)
    return path


def test_it_says_what_it_takes_runs_and_shows(sweep: Path, here: Command) -> None:
    done = here("sweep", sweep.name)
    assert done.status == 0, done.err
    lines = done.out.splitlines()
    assert lines[0].startswith("12 members in 2 chunks: about 1 s")
    assert lines[0].endswith("into rates.zarr")
    assert lines[1:3] == ["Rates", "12 members, 4 refused"]
    assert lines[-1] == "Wrote rates.zarr"
    assert here("sweep", "--status", "rates.zarr").out == "12 of 12 members are done, 4 refused\n"
    again = here("sweep", sweep.name)
    assert again.status == 2
    assert "`store` must not exist yet" in again.err
    drawn = here("map", "rates.zarr", "--measure", "how")
    assert drawn.out == "12 members, 4 refused\nWrote rates.png\n"


def test_dry_it_writes_nothing(sweep: Path, here: Command) -> None:
    done = here("sweep", sweep.name, "--dry-run")
    assert done.status == 0
    assert "12 members" in done.out
    assert done.files == {"rates.toml"}


def test_parts_are_joined(sweep: Path, here: Command) -> None:
    assert here("sweep", sweep.name, "-q").status == 0
    for k in "12":
        assert here("sweep", sweep.name, "-q", "--part", f"{k}/2", "-o", f"{k}.zarr").status == 0
    joined = here("sweep", "--merge", "1.zarr", "2.zarr", "-o", "all.zarr")
    assert joined.out == "2 chunks joined in all.zarr: 12 of 12 members are done, 4 refused\n"
    files = [
        {path.relative_to(store).as_posix(): path.read_bytes() for path in store.rglob("*") if path.is_file()}
        for store in (Path("all.zarr"), Path("rates.zarr"))
    ]
    assert files[0] == files[1]


def test_the_run_behind_a_point_is_run_again_with_its_card(sweep: Path, here: Command) -> None:
    assert here("sweep", sweep.name, "-q").status == 0
    done = here("map", "rates.zarr", "--open", "3.1,0.1", "-o", "one")
    assert done.status == 0, done.err
    assert {f"one/{name}" for name in ("run.nc", "path.png", "series.png", "run.html")} <= done.files
    from trundle import Trajectory

    run = Trajectory.load("one/run.nc")
    assert run.start.position[0] == 0.1
    assert run.system.support.motion.rate == pytest.approx(3.14159, abs=1e-4)
    assert here("map", "rates.zarr", "--open", "3.1").status == 2


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ((), "must be one sweep's file"),
        (("tipe-top",), "Did you mean 'tippe-top'"),
        (("--resume", "nothing.zarr"), "must be a store that a sweep wrote"),
        (("rates.toml", "--part", "3/2"), "K/N"),
        (("rates.toml", "--workers", "0"), "`workers`"),
        (("--merge",), "`--output`"),
        (("--merge", "-o", "x.zarr"), "must be the stores to join"),
        (("rates.toml", "-o", "no/where.zarr"), "in a folder that exists"),
        (("bad.toml",), "bad.toml: `over.support.tlit`"),
        (("rates.toml", "--scheduler", "tcp://127.0.0.1:1"), "a Dask scheduler that answers"),
    ],
    ids=str,
)
def test_bad_input_is_one_message_and_status_2(
    words: tuple[str, ...], says: str, folder: Path, here: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "rates.toml").write_text(SWEEP)
    monkeypatch.setattr("trundle.analysis.sweep.engine.PATIENCE", "1s")
    Path("bad.toml").write_text(SWEEP.replace("support.motion.rate", "support.tlit"))
    done = here("sweep", *words)
    assert done.status == 2
    assert says in done.err
    assert done.files == {"rates.toml", "bad.toml"}


def test_tolerances_in_one_command(folder: Path, here: Command) -> None:
    limits = ["support.motion.rate=33.3±0.3 rpm", "support.tilt=0±0.1 deg"]
    words = ["--measure", "end hypot(x, y)", "--duration", "5 s", "--every", "1 s", "--members", "8", "--json"]
    done = here("tolerance", "tilted-turntable", *limits, *words, "--figure", "t.png")
    assert done.status == 0, done.err
    told = json.loads(done.out)
    assert list(told["shares"]) == ["support.motion.rate", "support.tilt"]
    assert told["done"] == 32
    assert (folder / "t.png").exists()
    assert here("tolerance", "tilted-turntable", "support.tilt", "-m", "end x").status == 2


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("support.tilt=0.3±0.1", "must be an angle with its unit; got '0.3±0.1'"),
        ("support.tilt=0.3±0 deg", "must have something above 0 after ±; got '0.3±0 deg'"),
        ("support.tilt=0.3±-0.1 deg", "must have something above 0 after ±"),
        ("support.tilt=3±1 m", "must be an angle; got '3±1 m'"),
        ("body.inertia_ratio=0.4±0.01", "must be a number of the scenario"),
    ],
)
def test_limits_that_say_nothing_are_refused(given: str, said: str, here: Command) -> None:
    for more in ([], ["--normal"]):
        done = here("tolerance", "tilted-turntable", given, "-m", "end x", *more)
        assert done.status == 2
        assert said in done.err


def test_ctrl_c_leaves_what_is_done_and_says_how_to_go_on(sweep: Path, folder: Path) -> None:
    long = SWEEP.replace('"1 s"', '"60 s"').replace('"0.5 s"', '"1 ms"').replace("count = 4", "count = 99")
    sweep.write_text(long)
    command = [sys.executable, "-m", "trundle", "sweep", sweep.name, "--workers", "1"]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")  # noqa: S603
    begun = time.monotonic()
    while not list(folder.glob("rates.zarr/status/c/*")) and time.monotonic() - begun < 100:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "of 297 members are done" in said
    assert said.endswith("trundle: go on with: trundle sweep --resume rates.zarr\n")
