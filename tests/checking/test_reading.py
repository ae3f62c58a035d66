"""Files, tables and arrays of every kind that is promised, and what is said of the others."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray
from scipy.spatial.transform import Rotation

import trundle as tr
from trundle.analysis.checking.reading import Conventions, read
from trundle.tracks.names import recognise

from .test_mistakes import BALL, run, system
from .theirs import only, vectors

SYSTEM = system(BALL)


def test_names_are_found_as_people_write_them() -> None:
    for headings in (
        ["t", "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "qw", "qx", "qy", "qz"],
        ["Time", "pos_x", "pos_y", "pos_z", "vel_x", "vel_y", "vel_z", "omega_x", "omega_y", "omega_z"],
        ["time_s", "x_m", "y_m", "xdot", "ydot", "Ωx", "Ωy", "Ωz", "quat_w", "quat_x", "quat_y", "quat_z"],
        ["sim_time", "position x", "position y", "velocity.x", "velocity.y", "angular_velocity_x"],
    ):
        assert len(recognise(headings)) == len(headings)


def table(**changed: Any) -> pd.DataFrame:
    return pd.DataFrame(run() | changed)


@pytest.mark.parametrize("separator", [",", ";", "\t", " "])
def test_text_files_of_every_kind(tmp_path: Path, separator: str) -> None:
    path = tmp_path / "theirs.csv"
    table().to_csv(path, index=False, sep=separator)
    assert tr.check(path, SYSTEM).passed


def test_decimal_commas_remarks_and_savetxt(tmp_path: Path) -> None:
    path = tmp_path / "theirs.csv"
    table().to_csv(path, index=False, sep=";", decimal=",")
    path.write_text("# made on a Tuesday\n" + path.read_text())
    assert tr.check(path, SYSTEM).passed
    rows = table()[["t", "x", "y"]].to_numpy()
    np.savetxt(tmp_path / "plain.txt", rows, header="t x y")
    assert tr.check(tmp_path / "plain.txt", SYSTEM).passed
    np.savetxt(tmp_path / "bare.txt", rows)
    assert tr.check(tmp_path / "bare.txt", SYSTEM, columns={"t": "1", "x": "2", "y": "3"}).passed
    with pytest.raises(tr.InvalidValueError, match="line of headings"):
        tr.check(tmp_path / "bare.txt", SYSTEM)


def test_netcdf_of_trundle_and_of_others(tmp_path: Path) -> None:
    start = SYSTEM.place((0.1, 0.05), (0.1, -0.2), 3.0)
    ours = tr.simulate(SYSTEM, start, 2.0, 0.01)
    for frame in ("support", "world", "corotating"):
        assert tr.check(ours.in_frame(frame), SYSTEM).passed
    assert tr.check(ours.save(tmp_path / "run.nc"), SYSTEM).passed
    data = run()
    whole = {
        "position": (("time", "axis"), vectors(data, "") * 1e3, {"units": "mm"}),
        "speed": (("time",), np.hypot(data["vx"], data["vy"])),
    }
    theirs = xarray.Dataset(whole, coords={"time": data["t"]})
    theirs.to_netcdf(tmp_path / "theirs.nc", engine="h5netcdf")
    assert tr.check(tmp_path / "theirs.nc", SYSTEM).passed


def test_parquet_or_a_word_about_it(tmp_path: Path) -> None:
    path = tmp_path / "theirs.parquet"
    if importlib.util.find_spec("pyarrow") is None:
        path.write_bytes(b"PAR1")
        with pytest.raises(tr.MissingExtraError, match=r"theirs.parquet` .* pip install 'trundle\[parquet\]'"):
            tr.check(path, SYSTEM)
    else:
        table().to_parquet(path)
        assert tr.check(path, SYSTEM).passed


def test_units_in_headings_and_in_options() -> None:
    data = run()
    headed = {"t (ms)": data["t"] * 1e3, "x [mm]": data["x"] * 1e3, "y_cm": data["y"] * 1e2}
    headed |= {f"w{axis} (deg/s)": np.degrees(data[f"w{axis}"]) for axis in "xyz"}
    assert tr.check(headed, SYSTEM).passed
    bare = only(data, "vw") | {"t": data["t"] * 1e3}
    bare |= {name: data[name] * 1e3 for name in ("x", "y", "z", "vx", "vy", "vz")}
    bare |= {f"w{axis}": np.degrees(data[f"w{axis}"]) for axis in "xyz"}
    assert tr.check(bare, SYSTEM, time="ms", length="mm", angles="deg").passed


def test_conventions_of_the_orientation() -> None:
    data, q = run(), vectors(run(), "q")
    turn = Rotation.from_quat(q, scalar_first=True)
    plain = only(data, "v")
    Q = turn.as_matrix()
    ways: list[tuple[dict[str, Any], dict[str, str]]] = [
        ({"orientation": q[:, [1, 2, 3, 0]]}, {"quaternion": "xyzw"}),
        ({f"q{i}": q[:, i] for i in range(4)}, {}),
        ({f"q{i + 1}": q[:, (i + 1) % 4] for i in range(4)}, {"quaternion": "xyzw"}),
        ({"orientation": q * [1, -1, -1, -1]}, {"orientation": "space-to-body"}),
        ({f"r{i + 1}{j + 1}": Q[:, i, j] for i in range(3) for j in range(3)}, {}),
        ({"orientation": Q}, {}),
        (dict(zip(("roll", "pitch", "yaw"), turn.as_euler("xyz", degrees=True).T, strict=True)), {"angles": "deg"}),
        (dict(zip(("e1", "e2", "e3"), turn.as_euler("XYZ").T, strict=True)), {"euler": "XYZ"}),
    ]
    for columns, options in ways:
        assert tr.check(plain | columns, SYSTEM, **options).passed, (list(columns), options)  # type: ignore[arg-type]
    body = np.einsum("nji,nj->ni", Q, vectors(data, "w"))
    assert tr.check(plain | {"orientation": q, "angular_velocity": body}, SYSTEM, axes="body").passed


def test_signs_of_quaternions_may_jump() -> None:
    q = vectors(run(), "q") * np.where(np.arange(200) % 7 < 3, -1.0, 1.0)[:, None]
    assert tr.check(only(run(), "v") | {"orientation": q}, SYSTEM).passed


def test_uneven_samples() -> None:
    kept = np.sort(np.random.default_rng(2).choice(200, 150, replace=False))
    assert tr.check({name: array[kept] for name, array in only(run(), "w").items()}, SYSTEM).passed


@pytest.mark.parametrize(
    ("data", "options", "says"),
    [
        ({"t": [0, 1], "x": [0, 1]}, {}, "must hold time and position; got 'no column for y"),
        ({"t": np.arange(5.0), "x": np.arange(5.0), "y": np.arange(5.0)}, {}, "12 samples or more"),
        (run() | {"t": run()["t"][::-1]}, {}, "`time` must ascend"),
        (run() | {"vx": np.full(200, np.nan)}, {}, "`vx` must hold a number in most rows"),
        (run() | {"qw": 2 * run()["qw"]}, {}, "unit quaternions"),
        ({name: array for name, array in run().items() if name != "wy"}, {}, "no wy"),
        (run() | {"pos_x": run()["x"]}, {}, "two could be `x`"),
        (run(), {"axes": "bodily"}, "unknown kind of axes"),
        (run(), {"angles": "grad"}, "unknown unit of angles"),
        (run(), {"columns": {"x": "u"}}, "unknown column of the file 'u'"),
        (run(), {"columns": {"u": "x"}}, "unknown column of trundle's 'u'"),
        (run(), {"tolerance": 0.0}, "`tolerance` must be a share"),
        (run(), {"euler": "abc"}, "three axes"),
        (run(), {"time": "furlongs"}, "unit"),
        ("missing.csv", {}, "`file` must exist"),
        ("theirs.docx", {}, "must end in .csv"),
        (7, {}, "must be a file"),
    ],
)
def test_what_cannot_be_read_is_refused_with_a_remedy(data: Any, options: dict[str, Any], says: str) -> None:
    with pytest.raises((tr.InvalidValueError, tr.UnknownNameError), match=says):
        tr.check(data, SYSTEM, **options)


def test_a_broken_file_is_refused(tmp_path: Path) -> None:
    for name, content in (("a.csv", b""), ("b.csv", b"t,x,y\n\xff\xfe\x00"), ("c.nc", b"not a file of that kind")):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(tr.InvalidValueError, match=r"`file`|`columns`"):
            tr.check(tmp_path / name, SYSTEM)


def test_a_lopsided_body_needs_more_than_its_path() -> None:
    from .test_mistakes import LOPSIDED

    with pytest.raises(tr.InvalidValueError, match="Ω or the orientation"):
        tr.check(only(run(LOPSIDED), "v"), system(LOPSIDED))


def test_the_height_follows_on_a_plane() -> None:
    seen = {name: run()[name] for name in ("t", "x", "y")}
    assert not read(seen, SYSTEM, Conventions()).height_given
    checked = tr.check(seen, SYSTEM)
    assert checked.passed
    assert "touches the support" not in [figure.name for figure in checked.figures]


@pytest.mark.parametrize("scenario", [{"t": [0.0, 1.0]}, 7, None])
def test_what_is_no_scenario_is_refused(scenario: Any) -> None:
    with pytest.raises(tr.InvalidValueError, match=r"`scenario` must be the name of a scenario"):
        tr.check(run(), scenario)
