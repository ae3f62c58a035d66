"""The file of a run: it brings its card, tells what has changed, and is refused in one line where it is damaged."""

from __future__ import annotations

import functools
import hashlib
import json
import random
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import xarray

import trundle as tr
from trundle import verify
from trundle.cli import run as command
from trundle.simulation import run_file
from trundle.verify import reread

ARRAYS = ("position", "contact", "velocity", "angular_velocity", "orientation", "contact_force", "slip_velocity")
RUNS: dict[str, Callable[[], tr.Trajectory]] = {
    "a closed form": lambda: scenario("tilted-turntable", 2.0),
    "seen from the table": lambda: scenario("tilted-turntable", 2.0).in_frame("corotating"),
    "slips and rolls": lambda: scenario("billiard-draw", 1.0),
    "bounces, seen from the world": lambda: scenario("bouncing-ball-with-backspin", 1.5).in_frame("world"),
    "a free table": lambda: scenario("free-turntable-ellipse", 1.0),
    "a numerical method": lambda: tr.Scenario.load("rattleback").run("runge-kutta", duration=0.5, every=0.05),
}


def scenario(name: str, duration: float) -> tr.Trajectory:
    return tr.Scenario.load(name).run(duration=duration, every=0.05)


@functools.cache
def made(name: str) -> tr.Trajectory:
    ours = RUNS[name]()
    assert ours.card().passed, str(ours.card())
    return ours


@functools.cache
def content(name: str) -> bytes:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        return made(name).save(Path(folder) / "run.nc").read_bytes()


def edited(path: Path, name: str, edit: Callable[[Any], object]) -> Path:
    """Write the file of a run with something in it changed by a person who has HDF5."""
    path.write_bytes(content(name))
    with h5py.File(path, "a") as file:
        edit(file)
    return path


def attribute(key: str, change: Callable[[Any], Any]) -> Callable[[Any], None]:
    def edit(file: Any) -> None:
        file.attrs[key] = change(file.attrs[key])

    return edit


def variable(key: str, change: Callable[[Any], Any]) -> Callable[[Any], None]:
    def edit(file: Any) -> None:
        file[key][...] = change(file[key][...])

    return edit


def told(path: Path) -> str:
    """Return what is said of a file that is refused: one line."""
    with pytest.raises(tr.InvalidValueError) as found:
        tr.Trajectory.load(path)
    (line,) = str(found.value).splitlines()
    assert line.startswith(str(path))
    return line


# --- as it was saved ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", RUNS)
def test_the_card_is_that_of_the_run_as_it_was_saved(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "run.nc"
    path.write_bytes(content(name))
    monkeypatch.setattr(verify, "card", None)  # nothing is computed
    monkeypatch.setattr(reread, "card", None)
    again = tr.Trajectory.load(path)
    assert again.changed == ()
    assert again.card() == made(name).card()
    assert "as it was saved in run.nc; the digests hold" in again.card().origin
    assert again.card().origin in str(again.card())
    assert again.in_frame("support").card() is again.card()
    assert json.loads(again.card().as_json())["origin"] == again.card().origin


def test_a_run_computed_here_says_nothing_of_a_file() -> None:
    ours = made("a closed form")
    assert (ours.changed, ours.card().origin) == ((), "")
    assert "origin" not in ours.card().as_dict()


def test_the_digest_of_a_long_run_is_taken_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    ours = made("bounces, seen from the world")
    whole = run_file.digests(ours.data, ours.system, {})
    position = np.ascontiguousarray(ours.data.position.values, dtype="<f8").tobytes()
    assert whole["position"] == hashlib.sha256(position).hexdigest()
    for size in (1, 7, ours.data.position.size):
        monkeypatch.setattr(run_file, "_BLOCK", size)
        assert run_file.digests(ours.data, ours.system, {}) == whole


def test_what_a_user_adds_leaves_the_digests_alone(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    path.write_bytes(content("bounces, seen from the world"))
    data = xarray.load_dataset(path, engine="h5netcdf")
    data.attrs["comment"] = "with the new ball"
    data["position"].attrs["long_name"] = "of the ball's centre"
    data["speed"] = (("time",), np.linalg.norm(data.velocity.values, axis=1), {"units": "m s-1"})
    data["form"], data["events"], data["own"] = 1.0, ("time", data.time.values), ("time", data.time.values)
    data = data.sortby("axis").assign_coords(when=("time", data.time.values))
    data.to_netcdf(path, engine="h5netcdf", encoding={"position": {"zlib": True, "chunksizes": (7, 3)}})
    again = tr.Trajectory.load(path)
    assert again.changed == ()
    assert again.data.attrs["comment"] == "with the new ball"
    assert again.card().passed
    again.plot()
    assert tr.Trajectory.load(again.save(tmp_path / "again.nc")).changed == ()


def test_a_file_without_digests_is_checked_anew(tmp_path: Path) -> None:
    for name in ("a closed form", "slips and rolls"):
        old = tr.Trajectory.load(edited(tmp_path / "run.nc", name, lambda file: file.attrs.pop("sha256")))
        assert old.changed is None
        assert "no digests" in old.card().origin
        assert old.card().passed, str(old.card())
        assert set(made(name).card().figures[:3]) <= set(old.card().figures)


# --- changed since it was saved -------------------------------------------------------------------------


def larger(values: Any) -> Any:
    return values * 1.3 + 0.1 * np.abs(np.nan_to_num(values)).max() + 0.01


def turned(q: Any) -> Any:
    return q[:, [1, 0, 3, 2]] * [-1, 1, 1, -1]


# In flight nothing slips.
CHANGES = [(key, name) for key in ARRAYS for name in RUNS if (key, name[:7]) != ("slip_velocity", "bounces")]


@pytest.mark.parametrize(("key", "name"), CHANGES)
def test_other_numbers_fail_the_card(key: str, name: str, tmp_path: Path) -> None:
    change = turned if key == "orientation" else larger
    again = tr.Trajectory.load(edited(tmp_path / "run.nc", name, variable(key, change)))
    assert again.changed == (key,)
    assert f"run.nc, changed since it was saved: {key}" in again.card().origin
    assert not again.card().passed, str(again.card())


OTHER: dict[str, tuple[str, Callable[[Any], object]]] = {
    "time": ("slips and rolls", variable("time", lambda t: t * 1.01)),
    "phase": ("slips and rolls", variable("phase", lambda phase: 0 * phase + 3)),
    "support_angle": ("a free table", variable("support_angle", lambda angle: angle + 0.01)),
    "support_rate": ("a free table", variable("support_rate", lambda rate: rate * 1.01)),
    "frame": ("a closed form", attribute("frame", lambda _: "world")),
    "tolerance": ("a numerical method", attribute("tolerance", lambda _: 1e-6)),
    "events": ("slips and rolls", attribute("events", lambda text: json.dumps(later(json.loads(text))))),
    "start": ("a closed form", attribute("start", lambda text: text.replace('"velocity": [0.', '"velocity": [0.1'))),
    "scenario": ("a closed form", attribute("scenario", lambda text: text.replace("33.3 rpm", "33.4 rpm"))),
}


def later(events: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [{**event, "time": event["time"] * 1.01} for event in events]


@pytest.mark.parametrize("key", OTHER)
def test_other_claims_fail_the_card_or_are_told(key: str, tmp_path: Path) -> None:
    name, edit = OTHER[key]
    again = tr.Trajectory.load(edited(tmp_path / "run.nc", name, edit))
    assert again.changed == (key,)
    assert not again.card().passed or key == "tolerance", str(again.card())
    assert f"changed since it was saved: {key}" in str(again.card())


def test_a_card_that_was_edited_is_not_believed(tmp_path: Path) -> None:
    def edit(file: Any) -> None:
        variable("position", larger)(file)
        attribute("card", lambda text: text.replace("share of the speed", "none at all"))(file)

    again = tr.Trajectory.load(edited(tmp_path / "run.nc", "a closed form", edit))
    assert again.changed == ("position", "card")
    assert not again.card().passed


def test_numbers_of_one_run_with_the_words_of_another(tmp_path: Path) -> None:
    def edit(file: Any) -> None:
        with h5py.File(tmp_path / "other.nc") as other:
            for key in ("scenario", "start", "events", "card", "sha256"):
                file.attrs[key] = other.attrs[key]

    longer = tr.Scenario.load("hollow-ball-turntable").run(duration=2.0, every=0.05)
    longer.save(tmp_path / "other.nc")
    again = tr.Trajectory.load(edited(tmp_path / "run.nc", "a closed form", edit))
    assert not again.card().passed


@pytest.mark.parametrize("name", RUNS)
def test_a_part_of_a_run_is_checked_for_itself(name: str, tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    path.write_bytes(content(name))
    xarray.load_dataset(path, engine="h5netcdf").isel(time=slice(3, 8, 2)).to_netcdf(path, engine="h5netcdf")
    again = tr.Trajectory.load(path)
    assert again.changed is not None
    assert {"time", "position", "orientation"} <= set(again.changed)
    assert again.card().passed, str(again.card())


NOT_FOLLOWED: dict[str, tuple[str, Callable[[Any], object], str]] = {
    "a billion seconds": ("slips and rolls", variable("time", lambda t: np.where(t == t[-1], 1e9, t)), "would turn by"),
    "more than there are": (
        "seen from the table",
        variable("time", lambda t: np.where(t == t[-1], 1e200, t)),
        "would turn by",
    ),
    "a start as fast as light": (
        "a numerical method",
        attribute("start", lambda text: json.dumps({**json.loads(text), "angular_velocity": [0.0, 0.0, 9e6]})),
        "its first sample is not its start: angular_velocity",
    ),
}


@pytest.mark.parametrize("what", NOT_FOLLOWED)
def test_nonsense_is_not_followed_to_its_end(what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name, edit, said = NOT_FOLLOWED[what]
    monkeypatch.setattr(reread, "card", None)  # nothing is run
    (figure,) = tr.Trajectory.load(edited(tmp_path / "run.nc", name, edit)).card().failures
    assert f"the run cannot be repeated: {said}" in figure.note.replace("it would", "would")


# --- in memory ------------------------------------------------------------------------------------------


def test_a_card_speaks_of_the_numbers_that_it_was_made_of(tmp_path: Path) -> None:
    ours = tr.Trajectory.load(edited(tmp_path / "run.nc", "a closed form", lambda _: None))
    seen = ours.in_frame("world")
    assert ours.card().passed
    ours.data.position.values[:] *= 1.3
    assert not ours.card().passed
    assert "changed since run.nc was read" in ours.card().origin
    again = tr.Trajectory.load(ours.save(tmp_path / "altered.nc"))
    assert again.changed == ()
    assert not again.card().passed
    assert seen.data.position.values[0, 0] != ours.data.position.values[0, 0]


def test_a_part_does_not_give_its_card_to_the_whole() -> None:
    ours = scenario("tilted-turntable", 2.0)
    part, altered = ours.at([0.5, 0.6, 0.7]), replace(ours, data=ours.data.assign(position=ours.data.position * 1.3))
    assert not altered.card().passed
    assert part.card() != ours.card()
    assert ours.card().passed
    assert ours.in_frame("world").card() is ours.card()
    assert not altered.in_frame("world").card().passed


# --- refused --------------------------------------------------------------------------------------------


def without(key: str) -> Callable[[Any], None]:
    def edit(file: Any) -> None:
        del (file.attrs if key in file.attrs else file)[key]

    return edit


def becomes(key: str, value: Any) -> Callable[[Any], None]:
    return attribute(key, lambda _: value)


def at(index: int, value: float) -> Callable[[Any], Any]:
    def change(values: Any) -> Any:
        values[index] = value
        return values

    return change


def rewritten(change: Callable[[xarray.Dataset], xarray.Dataset]) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        path.write_bytes(content("bounces, seen from the world"))
        change(xarray.load_dataset(path, engine="h5netcdf")).to_netcdf(path, engine="h5netcdf")

    return write


def states(change: Callable[[dict[str, Any]], dict[str, Any]]) -> Callable[[Any], None]:
    return attribute("start", lambda text: json.dumps(change(json.loads(text))))


DAMAGED: dict[str, tuple[Callable[[Any], object], str]] = {
    **{f"no {key}": (without(key), f"`{key}`") for key in ("scenario", "card", "method", "frame", "tolerance")},
    **{f"no {key}": (without(key), f"`{key}` must be among the variables") for key in (*ARRAYS, "phase")},
    "no time": (without("time"), "`file` must be NetCDF4"),
    **{f"{key}: no JSON": (becomes(key, "{oops"), f"`{key}`") for key in ("start", "events", "card", "sha256")},
    **{f"{key}: a list": (becomes(key, "[1, 2]"), f"`{key}`") for key in ("start", "events", "card", "sha256")},
    **{f"{key}: a number": (becomes(key, 7.5), f"`{key}` must be text") for key in ("start", "card", "sha256")},
    **{f"{key}: deep": (becomes(key, "[" * 50_000), f"`{key}`") for key in ("start", "events", "card", "sha256")},
    "start: two components": (states(lambda state: {**state, "position": [0.1, 0.2]}), "`start`.*position"),
    "start: text": (states(lambda state: {**state, "velocity": "fast"}), "`start`.*velocity"),
    "start: not finite": (states(lambda state: {**state, "velocity": [1e999, 0, 0]}), "`start` must hold finite"),
    "start: no unit quaternion": (states(lambda state: {**state, "orientation": [1, 1, 0, 0]}), "length 1"),
    "start: of a free table": (states(lambda state: {**state, "support": [0.0, 1.0]}), "`start` must hold nothing"),
    "start: too late": (states(lambda state: {**state, "time": 5.0}), "`start` must not be after the first sample"),
    "events: an unknown kind": (attribute("events", lambda text: text.replace('"land"', '"sink"')), "slip, grip"),
    "events: not in order": (
        attribute("events", lambda text: json.dumps(json.loads(text)[::-1])),
        "`events` must ascend",
    ),
    "scenario: no TOML": (becomes("scenario", "[body"), "is not valid TOML"),
    "scenario: no scenario": (attribute("scenario", lambda text: text.replace("[body]", "[bdy]", 1)), "body"),
    "scenario: a path": (
        becomes("scenario", '[[path]]\nkind = "straight"'),
        "`scenario` must have a body that forces act on",
    ),
    "method: unknown": (becomes("method", "euler"), "`method` must be one of exact, taylor, runge-kutta"),
    "method: a number": (becomes("method", 3), "`method`"),
    "frame: unknown": (becomes("frame", "moon"), "`frame` must be one of support, world, corotating"),
    "tolerance: of no closed form": (becomes("tolerance", 1.0), "`tolerance` must be 0"),
    "tolerance: text": (becomes("tolerance", "fine"), "`tolerance` must be a number"),
    "time: back": (variable("time", at(5, 0.01)), "`time` must ascend; got '0.01 s after 0.2 s'"),
    "time: not finite": (variable("time", at(-1, np.inf)), "`time` must be finite"),
    "position: not finite": (variable("position", at(3, np.nan)), "`position` must be finite"),
    "slip: not finite while it touches": (variable("slip_velocity", at(0, np.inf)), "`slip_velocity` must be finite"),
    "phase: unknown": (variable("phase", at(3, 7)), r"`phase` must be one of 0 \(rolling\).*got \[7\]"),
    "orientation: too long": (variable("orientation", lambda q: q * 1.01), "length 1; got 1.01"),
    "orientation: far too long": (variable("orientation", lambda q: q * 1e200), "length 1"),
    "units: other": (lambda file: file["position"].attrs.__setitem__("units", "mm"), "units 'm'; got 'mm'"),
    "units: a number": (lambda file: file["velocity"].attrs.__setitem__("units", 3), "`velocity` must have the units"),
    "units: none": (lambda file: file["contact"].attrs.__delitem__("units"), "`contact` must have the units"),
    "labels: other": (lambda file: file["axis"].__setitem__(0, "w"), "`axis` must have the labels x, y, z"),
}


@pytest.mark.parametrize("what", DAMAGED)
def test_what_cannot_be_a_run_is_refused_in_one_line(what: str, tmp_path: Path) -> None:
    edit, said = DAMAGED[what]
    name = {"slip": "slips and rolls", "even": "bounces, seen from the world"}.get(what[:4], "a closed form")
    line = told(edited(tmp_path / "run.nc", name, edit))
    with pytest.raises(tr.TrundleError, match=said):
        raise tr.TrundleError(line)


FOREIGN: dict[str, tuple[Callable[[Path], object], str]] = {
    "not there": (lambda path: None, "must exist"),  # noqa: ARG005
    "a folder": (lambda path: path.mkdir(), "must not be a folder"),
    "empty": (lambda path: path.touch(), "NetCDF4"),
    "text": (lambda path: path.write_text("not NetCDF"), "NetCDF4"),
    "a scenario": (lambda path: path.write_text(tr.Scenario.load("rattleback").to_toml()), "NetCDF4"),
    "zeros": (lambda path: path.write_bytes(bytes(5000)), "NetCDF4"),
    "somebody else's": (
        lambda path: xarray.Dataset({"x": ("t", [1.0])}).to_netcdf(path, engine="h5netcdf"),
        "`scenario` must be among the attributes of a run",
    ),
    "HDF5, but no NetCDF": (lambda path: h5py.File(path, "w").close(), "`scenario` must be among the attributes"),
    "a path that was rolled": (
        lambda path: tr.PathScenario.load("roll-x-then-y").run().save(path),
        "It is a path that was rolled",
    ),
    "single precision": (
        rewritten(lambda data: data.assign(position=data.position.astype("float32"))),
        "`position` must hold numbers of type float64; got 'float32'",
    ),
    "text for numbers": (
        rewritten(lambda data: data.assign(velocity=data.velocity.astype(str))),
        "`velocity` must hold numbers",
    ),
    "dates": (
        rewritten(lambda data: data.assign_coords(time=data.time.assign_attrs(units="s since 2000-01-01"))),
        "`time` must have the units 's'",
    ),
    "turned round": (
        rewritten(lambda data: data.transpose("axis", "quaternion", "time")),
        r"`position` must have the dimensions time, axis; got \('axis', 'time'\)",
    ),
    "other names": (rewritten(lambda data: data.rename(axis="component")), "dimensions time, axis"),
    "a flat table": (rewritten(lambda data: data.assign(phase=data.phase.astype("int32"))), "type int8"),
    "no samples": (rewritten(lambda data: data.isel(time=slice(0, 0))), "`time` must have samples"),
    "two components": (rewritten(lambda data: data.isel(axis=slice(0, 2))), "`axis` must have the labels"),
}


@pytest.mark.parametrize("what", FOREIGN)
def test_what_is_no_file_of_a_run_is_refused(what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    make, said = FOREIGN[what]
    path = tmp_path / "run.nc"
    make(path)
    with pytest.raises(tr.TrundleError, match=said):
        raise tr.TrundleError(told(path))
    assert command(["export", str(path), str(tmp_path / "out.csv")]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert line.startswith(f"trundle: {path}: `")
    assert not (tmp_path / "out.csv").exists()


@pytest.mark.parametrize("what", FOREIGN)
def test_check_says_what_is_wrong_with_a_file(what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "run.nc"
    FOREIGN[what][0](path)
    assert command(["check", str(path), "--no-figure", "--quiet"]) in (2, 3)  # some can be judged all the same
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("trundle: ")
    assert "bug" not in line


def test_export_tells_of_a_file_that_has_changed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = edited(tmp_path / "run.nc", "a closed form", variable("position", larger))
    page = tmp_path / "page.html"
    assert command(["export", str(path), str(page)]) == 0
    assert f"{path} has changed since it was saved: position" in capsys.readouterr().err
    assert "changed since it was saved: position" in page.read_text(encoding="utf-8")


def test_a_run_is_no_scenario(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = edited(tmp_path / "run.nc", "a closed form", lambda _: None)
    assert command(["run", str(path)]) == 2
    assert "trundle export" in capsys.readouterr().err


def test_what_could_not_be_read_back_is_not_written(tmp_path: Path) -> None:
    ours = made("a closed form")
    for data, said in (
        (ours.data.drop_vars("contact"), "`contact` must be among the variables"),
        (ours.data.assign(position=ours.data.position.drop_attrs()), "`time` must have the units"),
        (ours.data.assign_attrs(note={"of": "mine"}), "NetCDF cannot hold all"),
    ):
        with pytest.raises(tr.TrundleError, match=said):
            replace(ours, data=data).with_card(ours.card()).save(tmp_path / "run.nc")
    assert not list(tmp_path.iterdir())


# --- any byte -------------------------------------------------------------------------------------------


def damaged(seed: int) -> tuple[str, bytes]:
    """Return the file of a run with a few bits flipped, bytes replaced, a stretch gone, or its end."""
    draw = random.Random(seed)  # noqa: S311
    name = draw.choice(list(RUNS))
    bytes_ = bytearray(content(name))
    way = draw.choice(["bit", "bit", "bit", "bytes", "gone", "cut"])
    place = draw.randrange(len(bytes_))
    if way == "cut":
        return name, bytes(bytes_[:place])
    if way == "gone":
        del bytes_[place : place + draw.choice([1, 8, 512])]
        return name, bytes(bytes_)
    for _ in range(draw.choice([1, 1, 3])):
        place = draw.randrange(len(bytes_))
        bytes_[place] = bytes_[place] ^ (1 << draw.randrange(8)) if way == "bit" else draw.randrange(256)
    return name, bytes(bytes_)


@pytest.mark.parametrize("batch", range(2))
def test_whatever_byte_is_damaged_nothing_passes_in_silence(batch: int, tmp_path: Path) -> None:
    path, seen = tmp_path / "run.nc", {"refused": 0, "intact": 0, "changed": 0}
    for seed in range(100 * batch, 100 * batch + 100):
        name, bytes_ = damaged(seed)
        path.write_bytes(bytes_)
        lines = ["none"]
        try:
            again = tr.Trajectory.load(path)
        except tr.InvalidValueError as error:
            lines = str(error).splitlines()
            seen["refused"] += len(lines)
            continue
        finally:
            assert len(lines) == 1, seed
        card, ours = again.card(), made(name)
        if again.changed == ():
            seen["intact"] += 1
            assert card == ours.card(), seed
            assert (again.start, again.events, again.scenario) == (ours.start, ours.events, ours.scenario), seed
            for key in ("time", *ARRAYS, "phase"):
                assert np.array_equal(again.data[key].values, ours.data[key].values, equal_nan=True), (seed, key)
            continue
        seen["changed"] += 1
        assert again.changed is None or again.changed
        assert card.origin.startswith("made anew from run.nc"), seed
        if card.passed:  # then the change is so small that the method run again gives the same
            bound = card["the method run again"].bound
            assert bound is not None
            for key in ARRAYS[:6]:
                off, size = np.abs(again.data[key].values - ours.data[key].values), np.abs(ours.data[key].values)
                assert off.max() <= max(2 * bound, 1e-12) * max(size.max(), 1.0), (seed, key)
    assert min(seen.values()) >= 5, seen


def test_a_name_from_elsewhere_is_not_taken_for_a_file(tmp_path: Path) -> None:
    source = tmp_path / "run.nc"
    source.write_bytes(content("a closed form"))
    other = tmp_path / "ball läuft (2).nc"
    shutil.copy(source, other)
    assert "ball läuft (2).nc" in tr.Trajectory.load(other).card().origin


def test_words_that_lead_back_to_themselves_are_refused(tmp_path: Path) -> None:
    """HDF5 itself goes round for ever in such a file."""
    whole = content("a closed form")
    heap = whole.index(b"GCOL")
    (tmp_path / "run.nc").write_bytes(whole[: heap + 16] + bytes(64) + whole[heap + 80 :])
    with pytest.raises(tr.InvalidValueError, match="words that lead back to themselves"):
        tr.Trajectory.load(tmp_path / "run.nc")
