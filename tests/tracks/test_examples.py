"""The tracks that come with trundle: as their files say that they were made, and what a fit finds in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import trundle as tr
from trundle.units import to_si

from .making import made


@pytest.mark.parametrize("name", tr.tracks.example_names())
def test_it_is_made_as_its_file_says(name: str) -> None:
    stored = tr.tracks.example(name).path.read_text()
    drawn = made(name)
    assert stored.splitlines()[:2] == drawn.splitlines()[:2]
    numbers = [np.array([line.split(",") for line in text.splitlines()[2:]], dtype=float) for text in (stored, drawn)]
    np.testing.assert_allclose(*numbers, atol=0.0101)  # the last digit, mm


@pytest.mark.parametrize("name", ["ball-on-a-ramp", "ball-on-a-turntable"])
def test_the_truth_comes_out(name: str) -> None:
    one = tr.tracks.example(name)
    found = tr.fit(f"example:{name}", tr.Scenario.read(one.scenario), free=one.free, noise=one.noise)
    assert found.passed
    for key in one.free:
        sigma = found[key].sigma
        assert sigma is not None
        assert abs(found[key].value - float(to_si(one.truth[key], "angle", key))) < 3 * sigma


def test_the_command_needs_only_the_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from trundle.cli import run

    assert run(["fit", "example:ball-on-a-ramp", "--no-figure", "-o", str(tmp_path / "ramp")]) == 0
    assert "body.inertia_ratio" in capsys.readouterr().out
    assert run(["read", "example:ball-on-a-ramp"]) == 0
    assert run(["read", "example:ball-on-a-ram"]) == 2
    assert "Did you mean 'ball-on-a-ramp'?" in capsys.readouterr().err
