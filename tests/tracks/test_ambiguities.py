"""What a file does not tell is asked for by name, never guessed; what is wrong in it is named by its row."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import trundle as tr
from trundle.tracks.grid import grid_of

from .examples import AXES, DEEPLABCUT, MARKS, MULTI, trk, workbook


def read(folder: Path, text: str | bytes, name: str = "track.csv", **options: Any) -> tr.Track:
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return tr.read_track(path, **options)


def refused(folder: Path, text: str | bytes, name: str = "track.csv", **options: Any) -> str:
    with pytest.raises((tr.InvalidValueError, tr.UnknownNameError)) as caught:
        read(folder, text, name, **options)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def rows(separator: str, *lines: str) -> str:
    return "\n".join(separator.join(line.split()) for line in lines) + "\n"


# --- decimal comma or thousands -----------------------------------------------------------------------

THREE = rows(";", "t x y", "0,000 1,234 2,500", "0,100 1,345 2,600", "0,200 1,456 2,700")
ONLY = rows(
    "\t", "t x (mm) y (mm)".replace(" (", "_").replace(")", ""), "0 1,234 2,500", "1 1,345 2,600", "2 1,456 2,700"
)


def test_three_digits_behind_each_comma_are_asked_for(tmp_path: Path) -> None:
    says = refused(tmp_path, ONLY, "track.tsv", units={"time": "s"})
    assert "`decimal` must be known" in says
    assert "--decimal comma" in says
    for decimal, x in (("comma", 1.234e-3), ("point", 1.234)):
        track = read(tmp_path, ONLY, "track.tsv", units={"time": "s"}, decimal=decimal)
        assert track["x"][0] == pytest.approx(x, rel=1e-14)


def test_a_zero_before_the_comma_tells(tmp_path: Path) -> None:
    track = read(tmp_path, THREE, units="m")
    assert track["x"].tolist() == [1.234, 1.345, 1.456]
    assert "decimal comma" in track.taken


@pytest.mark.parametrize("sign", [",", "."])
def test_the_numbers_are_the_same_with_either_sign(tmp_path: Path, sign: str) -> None:
    text = rows("\t", "t x y", "0.5 1.25 1234567E-01", "0.6 .5 -1.5e3", "0.7 1. +2").replace(".", sign)
    track = read(tmp_path, text, "track.txt", units="m")
    assert track["x"].tolist() == [1.25, 0.5, 1.0]
    assert track["y"].tolist() == [123456.7, -1500.0, 2.0]


def test_thousands_are_taken_where_they_were_named(tmp_path: Path) -> None:
    english = rows("\t", "t x_mm y_mm", "0.1 1,234.5 2", "0.2 1,235.5 3", "0.3 1,236.5 4")
    german = english.translate(str.maketrans(",.", ".,"))
    for text, decimal in ((english, "point"), (german, "comma")):
        assert "`decimal` must be known" in refused(tmp_path, text, "track.txt")
        track = read(tmp_path, text, "track.txt", decimal=decimal)
        np.testing.assert_allclose(track["x"], [1.2345, 1.2355, 1.2365], rtol=1e-14)


def test_commas_between_cells_with_decimal_commas_are_told(tmp_path: Path) -> None:
    text = "t,x,y\n0,00,1,5,2,5\n0,10,1,6,2,6\n0,20,1,7,2,7\n0,30,1,8,2,9\n"
    assert "Are these decimal commas? Separate the cells by semicolons" in refused(tmp_path, text, units="m")


def test_quoted_decimal_commas(tmp_path: Path) -> None:
    text = 't,x,y\n"0,00","1,5","2,5"\n"0,10","1,6","2,6"\n"0,20","1,7","2,7"\n'
    assert read(tmp_path, text, units="m")["x"].tolist() == [1.5, 1.6, 1.7]


def test_a_slip_among_many_is_named(tmp_path: Path) -> None:
    lines = [f"{i / 100:.2f}\t{i / 7:.4f}\t1.5" for i in range(100)]
    lines[41] = "0.41\t5,8571\t1.5"
    track = read(tmp_path, "\n".join(["t\tx\ty", *lines]), "track.txt", units="m")
    (one,) = track.rejected
    assert (one.row, "'5,8571'" in one.reason, len(track)) == (43, True, 99)


@given(
    st.lists(st.floats(-1e6, 1e6).map(lambda x: round(x, 4)), min_size=3, max_size=20),
    st.sampled_from("\t; "),
    st.booleans(),
)
def test_a_column_that_was_written_is_read_or_asked_for(values: list[float], separator: str, comma: bool) -> None:
    lines = [f"{0.25 * i}{separator}{value!r}" for i, value in enumerate(values)]
    text = "\n".join([f"t{separator}x", *lines])
    try:
        grid = grid_of(text.replace(".", ",") if comma else text)
    except tr.InvalidValueError as error:
        assert error.key == "decimal"  # noqa: PT017
        return
    assert grid.cells(2)[0][1].tolist() == values


def test_a_spreadsheet_of_words_is_asked_as_a_text_is(tmp_path: Path) -> None:
    sheet = workbook(Sheet=[["t", "x (mm)"], ["1,000", "1,234"], ["1,100", "1,345"], ["1,200", "1,456"]])
    assert "`decimal` must be known" in refused(tmp_path, sheet, "track.xlsx")
    track = read(tmp_path, sheet, "track.xlsx", decimal="comma")
    assert track.time.tolist() == [1.0, 1.1, 1.2]


# --- which track, unit, pixel, sense ------------------------------------------------------------------


def test_which_track(tmp_path: Path) -> None:
    says = refused(tmp_path, MULTI.strip("\n"), units="m")
    assert "`track` must be named" in says
    assert "'mass A, mass B'" in says
    assert "--track 'mass A'" in says
    assert "Did you mean 'mass B'?" in refused(tmp_path, MULTI.strip("\n"), track="mass_B")


def test_the_unit_of_length(tmp_path: Path) -> None:
    text = rows(",", "t x y", "0.0 1 2", "0.1 3 4", "0.2 5 6")
    says = refused(tmp_path, text)
    assert says.startswith("`units` must be said")
    assert "--unit cm" in says
    assert read(tmp_path, text, units="cm")["x"].tolist() == [0.01, 0.03, 0.05]
    assert "unit" in refused(tmp_path, text, units="kg")
    assert "Did you mean 'length'" in refused(tmp_path, text, units={"lenght": "cm"})
    assert tr.read_track({"t": [0.0, 0.1], "x": [1.0, 2.0]})["x"].tolist() == [1.0, 2.0]  # in memory it is SI


def test_the_unit_of_an_angle_and_its_sense(tmp_path: Path) -> None:
    text = rows(",", "t x_cm y_cm angle omega_z", "0.0 1 2 0 1", "0.1 3 4 90 1", "0.2 5 6 180 1")
    track = read(tmp_path, text)
    assert track.columns == ("x", "y")
    assert track.left_out == {
        "angle": "its unit is not known: --angles",
        "omega_z": "its unit is not known: --angles",
    }
    assert "--sense" in read(tmp_path, text, units={"angle": "deg"}).left_out["angle"]
    for sense, sign in (("clockwise", -1), ("anticlockwise", 1)):
        track = read(tmp_path, text, units={"angle": "deg"}, sense=sense)
        np.testing.assert_allclose(track["angle"], sign * np.array([0.0, np.pi / 2, np.pi]), rtol=1e-14)
        np.testing.assert_allclose(track["wz"], np.pi / 180, rtol=1e-14)
    alone = rows(",", "t angle", "0.0 0", "0.1 90", "0.2 180")
    assert "--angles deg" in refused(tmp_path, alone)
    assert "--sense clockwise" in refused(tmp_path, alone, units={"angle": "deg"})


def test_pixels_and_which_way_is_up(tmp_path: Path) -> None:
    text = rows(",", "t x_(px) y_(px)".replace("_", ""), "0.0 100 200", "0.1 101 203", "0.2 102 206")
    assert "--pixel '0.8 mm'" in refused(tmp_path, text)
    assert "--y down" in refused(tmp_path, text, pixel="0.8 mm")
    assert "must be a length" in refused(tmp_path, text, pixel="8 s")
    down, up = (read(tmp_path, text, pixel="0.8 mm", y=way) for way in ("down", "up"))
    np.testing.assert_allclose(up["y"], [0.16, 0.1624, 0.1648], rtol=1e-14)
    np.testing.assert_array_equal(down["y"], -up["y"])
    assert "a pixel of 0.8 mm" in down.taken
    metres = rows(",", "t x_cm y_cm", "0.0 1 2", "0.1 3 4", "0.2 5 6")
    assert "`pixel` is for places in pixels" in refused(tmp_path, metres, pixel="0.8 mm")


def test_a_film_that_was_not_calibrated_is_in_pixels(tmp_path: Path) -> None:
    bare = trk(MARKS, {0: AXES | {"xscale": 1.0, "yscale": 1.0}}, ruler=False)
    assert "--pixel" in refused(tmp_path, bare, "film.trk")
    np.testing.assert_allclose(read(tmp_path, bare, "film.trk", pixel="1 mm")["x"], [0.1, 0.102, 0.105], rtol=1e-13)
    # With a ruler of one pixel a unit, the unit is that of the file.
    ruled = trk(MARKS, {0: AXES | {"xscale": 1.0, "yscale": 1.0}}, unit="mm")
    np.testing.assert_allclose(read(tmp_path, ruled, "film.trk")["x"], [0.1, 0.102, 0.105], rtol=1e-13)


def test_frames_need_their_rate(tmp_path: Path) -> None:
    assert "--rate 60" in refused(tmp_path, DEEPLABCUT.strip("\n"), track="ball", pixel="1 mm")
    assert "--rate 60" in refused(tmp_path, trk(MARKS, {0: AXES}, step=None), "film.trk")
    assert "must be frames a second" in refused(tmp_path, DEEPLABCUT.strip("\n"), track="ball", rate=-1)
    counted = rows(",", "frame x_cm y_cm", "0 1 2", "1 3 4", "2 5 6")
    assert "--rate 60" in refused(tmp_path, counted)
    assert read(tmp_path, counted, rate=50).time.tolist() == [0.0, 0.02, 0.04]


@pytest.mark.parametrize("times", ["0 1 2", "0 16.7 33.3", "100 200 300"])
def test_times_in_frames_milliseconds_or_seconds(tmp_path: Path, times: str) -> None:
    text = rows(",", "t x_cm y_cm", *(f"{t} 1 2" for t in times.split()))
    says = refused(tmp_path, text)
    assert "`time` must be known" in says
    assert "--time ms" in says
    numbers = np.array(times.split(), dtype=float)
    for options, factor in (({"units": {"time": "ms"}}, 1e-3), ({"units": {"time": "s"}}, 1.0), ({"rate": 50}, 0.02)):
        np.testing.assert_allclose(read(tmp_path, text, **options).time, factor * numbers, rtol=1e-14)
    named = text.replace("t,", "t (ms),")
    np.testing.assert_allclose(read(tmp_path, named).time, 1e-3 * numbers, rtol=1e-14)


def test_a_rate_beside_a_clock_is_refused(tmp_path: Path) -> None:
    text = rows(",", "t x_cm y_cm", "0.0 1 2", "0.1 3 4", "0.2 5 6")
    assert "`rate` is for files that count frames" in refused(tmp_path, text, rate=60)


# --- rows and headings --------------------------------------------------------------------------------


def test_bad_rows_are_named_and_the_rest_is_read(tmp_path: Path) -> None:
    lines = [f"{i / 100},{i},{2 * i}" for i in range(60)]
    lines[4], lines[9], lines[20], lines[30], lines[40] = "0.04,4", "0.09,oops,18", ",1,2", "0.3,inf,1", lines[39]
    track = read(tmp_path, "\n".join(["t,x,y", *lines]), units="cm")
    assert [one.row for one in track.rejected] == [6, 11, 22, 32, 42]
    reasons = ["2 cells for 3 headings", "'oops'", "no time", "finite", "its time is that of line 41"]
    assert all(word in one.reason for word, one in zip(reasons, track.rejected, strict=True))
    assert len(track) == 55
    assert "5 rows were left out: line 6 (2 cells for 3 headings), line 11 (" in str(track)


def test_too_many_bad_rows_are_refused(tmp_path: Path) -> None:
    lines = [f"{i / 100},{i},{'x' * (i % 5 == 4)}{2 * i}" for i in range(60)]
    assert "`y` must hold numbers; got \"'x8' in line 6" in refused(tmp_path, "\n".join(["t,x,y", *lines]), units="cm")


def test_times_that_go_back_are_refused(tmp_path: Path) -> None:
    text = rows(",", "t x_cm y_cm", "0.0 1 2", "0.2 3 4", "0.1 5 6")
    assert "`time` must ascend; got '0.2 s, then 0.1 s (lines 3 and 4)'" in refused(tmp_path, text)


def test_a_first_row_that_is_no_row_is_named(tmp_path: Path) -> None:
    track = read(tmp_path, rows(",", "t x_cm y_cm", "oops nothing 2", "0.1 3 4", "0.2 5 6", "0.3 5 6"))
    assert [one.row for one in track.rejected] == [2]


def test_headings_twice_matter_where_they_are_used(tmp_path: Path) -> None:
    good = rows(",", "t x_cm y_cm note note", "0.0 1 2 7 7", "0.1 3 4 7 7", "0.2 5 6 7 7")
    assert read(tmp_path, good).columns == ("x", "y")
    assert "`headings` must differ" in refused(tmp_path, good.replace("note,note", "x_cm,note"))
    assert "two could be `x`" in refused(tmp_path, good.replace("note,note", "pos_x,note"))
    chosen = read(tmp_path, good.replace("note,note", "pos_x,note"), columns={"x": "pos_x"}, units="mm")
    assert chosen["x"].tolist() == [0.007] * 3


def test_momentum_in_tracker_is_no_place(tmp_path: Path) -> None:
    # `px` is the momentum; in a table of another program it may be the place of a point p.
    text = "mass A\t\t\t\nt\tpx\tpy\n0.0\t1\t2\n0.1\t3\t4\n0.2\t5\t6\n"
    assert "no column but the time" in refused(tmp_path, text, "track.txt", units="m")


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("track.docx", b"", "must end in .csv"),
        ("missing/track.csv", None, "must exist"),
        ("track.csv", b"", "must hold rows of numbers"),
        ("track.csv", b"\x00\x01\x02" * 50, "must be text"),
        ("track.csv", b"hello\nworld\n", "must hold"),
        ("track.csv", b"t,x\n", "must hold rows of numbers below its headings"),
        ("track.xlsx", b"PK\x03\x04 no zip", "must be a readable .xlsx file"),
        ("track.trz", b"PK\x03\x04 no zip", "must be a readable .trz file"),
        ("track.trk", b"<a><b></a>", "must be a readable .trk file"),
        ("track.trk", b"<object class='java.util.Map'/>", "must be a project of Tracker's"),
        ("track.nc", b"\x89HDF\r\n\x1a\n damaged", "must be NetCDF4"),
        ("track.h5", b"\x89HDF\r\n\x1a\n damaged", "must be a readable .h5 file"),
    ],
)
def test_what_is_no_track_is_refused_in_a_line(tmp_path: Path, name: str, content: bytes | None, says: str) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(tr.InvalidValueError) as caught:
        tr.read_track(path)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)
