"""Every format that is read: the numbers that stand in a file by hand, and the table of the documents."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.tracks.formats import FORMATS

from .examples import EXAMPLES, PLACES, Example, parquet, written

PAGE = Path(__file__).parents[2] / "docs" / "tracks.md"


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.id)
def test_the_numbers_are_those_of_the_file(example: Example, tmp_path: Path) -> None:
    track = tr.read_track(written(example, tmp_path), **example.options)
    for name, values in example.truth.items():
        np.testing.assert_allclose(track[name], values, rtol=1e-13, atol=1e-15, err_msg=name)
    assert example.says in track.taken
    kind = next(one for one in FORMATS if one.name == track.format)
    assert type(kind).__name__ == example.format
    assert Path(example.file).suffix in kind.endings


def test_each_format_has_an_example() -> None:
    assert {example.format for example in EXAMPLES} | {"Parquet"} == {type(one).__name__ for one in FORMATS}


def test_parquet_or_a_word_about_it(tmp_path: Path) -> None:
    path = tmp_path / "track.parquet"
    if importlib.util.find_spec("pyarrow") is None:
        path.write_bytes(b"PAR1")
        with pytest.raises(tr.MissingExtraError, match=r"pip install 'trundle\[parquet\]'"):
            tr.read_track(path)
    else:
        path.write_bytes(parquet())
        track = tr.read_track(path)
        assert all(np.allclose(track[name], values, equal_nan=True) for name, values in PLACES.items())


def test_the_documents_list_the_formats_as_they_are() -> None:
    rows = re.findall(r"^\| ([^|]+?) \| ([^|]+?) \| ([^|]+?) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    listed = {name: (origin, endings) for name, origin, endings in rows}
    for one in FORMATS:
        assert listed[one.name] == (one.origin, ", ".join(f"`{ending}`" for ending in one.endings)), one.name


def test_a_run_of_our_own_is_a_track(tmp_path: Path) -> None:
    run = tr.Scenario.load("level-turntable-nudged").run()
    for source in (run, run.data, run.save(tmp_path / "run.nc")):
        track = tr.read_track(source)
        np.testing.assert_array_equal(track["x"], run.data.position.sel(axis="x"))
        np.testing.assert_array_equal(track["wz"], run.data.angular_velocity.sel(axis="z"))
    turned = tr.read_track(run.in_frame("corotating"))
    assert turned.frame == "corotating"


def test_a_track_is_read_once() -> None:
    track = tr.read_track(PLACES)
    assert tr.read_track(track) is track


def test_arrays_of_vectors_come_apart() -> None:
    position = np.arange(12.0).reshape(4, 3)
    quaternion = np.tile([0.0, 0.0, 0.0, 1.0], (4, 1))
    track = tr.read_track({"time": PLACES["t"], "position": position, "q": quaternion}, quaternion="xyzw")
    assert track.columns == ("x", "y", "z", "qx", "qy", "qz", "qw")
    assert track["qw"].tolist() == [1.0] * 4


def test_what_is_kept_with_a_track(tmp_path: Path) -> None:
    example = next(one for one in EXAMPLES if one.id == "multi")
    track = tr.read_track(written(example, tmp_path), **example.options)
    assert (track.name, track.source, track.frame, track.axes) == ("mass B", "track.csv", "support", "space")
    assert track.provenance["bytes"] == len(example.content)
    assert track.provenance["options"] == {"track": "mass B", "units": {"length": "m"}}
    assert track.data.row.values.tolist() == [4, 5, 6, 7]
    assert len(track.whole("x")["t"]) == 3
    assert len(track) == 4
    assert "mass B" in track._repr_html_()
    assert str(track).splitlines()[1] == track.taken
    with pytest.raises(tr.UnknownNameError, match="There are: t, x, y"):
        track["z"]


def test_the_gyroscope_is_along_the_axes_of_the_body(tmp_path: Path) -> None:
    example = next(one for one in EXAMPLES if one.id == "phyphox")
    assert tr.read_track(written(example, tmp_path)).axes == "body"


def test_the_figure_shows_path_and_columns(tmp_path: Path) -> None:
    for example in EXAMPLES[:2] + EXAMPLES[15:16]:
        track = tr.read_track(written(example, tmp_path), **example.options)
        figure = track.plot()
        assert len(figure.axes) == len(track.columns) + ({"x", "y"} <= set(track.columns))
        figure.savefig(tmp_path / "track.png")


# --- Tracker's axes -----------------------------------------------------------------------------------


def place(x: float, y: float, frame: dict[str, float]) -> tuple[float, float]:
    """Return a point along Tracker's axes: X = (cos θ dx − sin θ dy)/s, Y = −(sin θ dx + cos θ dy)/s."""
    turn = np.exp(1j * np.radians(frame["angle"]))
    point = np.conj((x - frame["xorigin"]) - 1j * (y - frame["yorigin"])) * turn
    return point.real / frame["xscale"], -point.imag / frame["yscale"]


def test_axes_that_move_turn_and_grow(tmp_path: Path) -> None:
    from .examples import MARKS, trk

    frames: dict[int, dict[str, Any]] = {
        0: {"xorigin": 320.0, "yorigin": 240.0, "angle": 30.0, "xscale": 500.0, "yscale": 400.0},
        3: {"xorigin": 300.0, "yorigin": 250.0, "angle": -90.0, "xscale": 800.0, "yscale": 800.0},
    }
    path = tmp_path / "film.trk"
    marks = MARKS | {4: MARKS[3]}
    path.write_bytes(trk(marks, frames, unit="cm"))
    track = tr.read_track(path)
    true = [place(*mark, frames[0 if i < 3 else 3]) for i, mark in marks.items()]
    np.testing.assert_allclose(np.column_stack([track["x"], track["y"]]), np.array(true) / 100, rtol=1e-13, atol=1e-15)
    # Up in the film along an x axis that was turned to −90°, which points down: by hand.
    assert track["x"][2] == pytest.approx(-(250 - 224) / 800 / 100)


def test_the_clock_of_a_clip(tmp_path: Path) -> None:
    from .examples import AXES, trk

    clip = "".join(
        f'<property name="{name}" type="double">{value}</property>'
        for name, value in {"startframe": 10, "stepsize": 2, "stepcount": 3, "starttime": -20.0}.items()
    )
    marks = {8: (0.0, 0.0), 10: (320.0, 240.0), 11: (1.0, 1.0), 12: (330.0, 240.0), 14: (340.0, 240.0), 16: (5.0, 5.0)}
    path = tmp_path / "film.trk"
    path.write_bytes(trk(marks, {0: AXES}, clip=clip, step=50.0))
    track = tr.read_track(path)
    np.testing.assert_allclose(track.time, [-0.02, 0.08, 0.18], rtol=0, atol=1e-15)
    np.testing.assert_allclose(track["x"], [0.0, 0.01, 0.02], rtol=0, atol=1e-15)
    assert [one.row for one in track.rejected] == [8, 11, 16]
    assert tr.read_track(path, rate=100).time.tolist() == pytest.approx([-0.02, 0.0, 0.02])  # a film in slow motion
