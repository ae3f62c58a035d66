"""Damaged files and traps: each ends in a track or in one line of the house's own, quickly."""

from __future__ import annotations

import io
import pickle
import time
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest

import trundle as tr

from .damage import outcome
from .examples import AXES, MARKS, PROJECT, deeplabcut_hdf5, sleap, trk, zipped

COUNT = 224  # eight of each example; `python -m tests.tracks.damage` takes 2000 and more


@pytest.mark.parametrize("first", range(0, COUNT, 56))
def test_a_damaged_file_is_read_or_refused(first: int, tmp_path: Path) -> None:
    endings = [outcome(seed, tmp_path) for seed in range(first, first + 56)]
    assert 0 < sum(ending.startswith("read") for ending in endings) < 56


def refused(path: Path, content: bytes) -> str:
    path.write_bytes(content)
    began = time.process_time()
    with pytest.raises(tr.InvalidValueError) as caught:
        tr.read_track(path, track="ball", rate=25, pixel="1 mm")
    assert time.process_time() - began < 5
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_entities_are_refused(tmp_path: Path) -> None:
    laughs = "".join(f'<!ENTITY a{i + 1} "{f"&a{i};" * 10}">' for i in range(9))
    trap = PROJECT.replace(b"?>", f'?>\n<!DOCTYPE x [<!ENTITY a0 "ha">{laughs}]>'.encode()).replace(b"mass A", b"&a9;")
    assert "neither a document type nor entities" in refused(tmp_path / "film.trk", trap)
    empty = PROJECT.replace(b"?>", b"?>\n<!DOCTYPE x>")
    assert "neither a document type nor entities" in refused(tmp_path / "film.trk", empty)
    outside = PROJECT.replace(b"?>", b'?>\n<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]>')
    assert "neither a document type nor entities" in refused(tmp_path / "film.trk", outside)


def test_objects_within_objects_are_refused(tmp_path: Path) -> None:
    deep = b'<property name="a" type="object"><object class="b">' * 300
    content = PROJECT.replace(b'<property name="tracks"', deep + b'<property name="tracks"')
    content = content.replace(b"</object>\n</object>", b"</object>\n</object>" + b"</object></property>" * 300)
    assert "must be" in refused(tmp_path / "film.trk", content)


def test_what_unpacks_to_far_more_is_refused(tmp_path: Path) -> None:
    bomb = zipped(**{"film.trk": b" " * 2**26})
    assert "packed at most 200 to 1" in refused(tmp_path / "film.trz", bomb)
    assert "packed at most 200 to 1" in refused(tmp_path / "data.zip", zipped(**{"a.csv": b"0," * 2**24}))
    book = zipped(**{"xl/worksheets/sheet1.xml": b" " * 2**26})
    assert "packed at most 200 to 1" in refused(tmp_path / "data.xlsx", book)
    assert "at most 4096 files" in refused(tmp_path / "data.zip", zipped(**{f"{i}.csv": b"" for i in range(5000)}))


def test_a_film_beside_the_project_may_be_large(tmp_path: Path) -> None:
    (tmp_path / "film.trz").write_bytes(zipped(**{"film.trk": PROJECT, "videos/film.mp4": b" " * 2**26}))
    assert len(tr.read_track(tmp_path / "film.trz")) == 3


@pytest.mark.parametrize("name", ["../film.trk", "/etc/film.trk", "a/../../film.trk", "C:/film.trk", "..\\film.trk"])
def test_names_that_lead_outside_are_refused(tmp_path: Path, name: str) -> None:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("film.trk", PROJECT)
        archive.writestr(name, PROJECT)
    assert "must name its files within itself" in refused(tmp_path / "film.trz", stream.getvalue())
    assert [path.name for path in tmp_path.iterdir()] == ["film.trz"]


def test_a_pickle_that_would_act_is_refused(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[object, tuple[str, str]]:
            return Path.write_text, (Path(tmp_path / "harmed"), "harm")

    stream = io.BytesIO(deeplabcut_hdf5())
    with h5py.File(stream, "r+") as file:
        file["df_with_missing/table"].attrs["values_block_0_kind"] = np.bytes_(pickle.dumps([Trap()], 0))
    assert "must keep the names of its columns as words" in refused(tmp_path / "ball.h5", stream.getvalue())
    assert not (tmp_path / "harmed").exists()


def test_a_heap_of_words_without_an_end_is_refused(tmp_path: Path) -> None:
    """HDF5 itself goes round for ever in such a file."""
    content = sleap()
    heap = content.index(b"GCOL")
    damaged = content[: heap + 16] + bytes(64) + content[heap + 80 :]
    assert "words that lead back to themselves" in refused(tmp_path / "ball.h5", damaged)
    assert "words that lead back to themselves" in refused(tmp_path / "ball.nc", damaged)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (trk(MARKS, {}), "`coords` must hold the axes of a frame"),
        (trk(MARKS, {0: {"xorigin": 0.0, "yorigin": 0.0, "angle": 0.0}}), "`xscale` must be a finite number"),
        (trk(MARKS, {0: AXES | {"xscale": -1.0}}), "`xscale` must be positive"),
        (trk({0: (float("nan"), 1.0)}, {0: AXES}), "`x` must be a finite number"),
        (trk(MARKS, {0: AXES}, step=0.0), "`delta_t` must be positive"),
        (trk(MARKS, {0: AXES}, unit=None), "`units` must be said"),
        (trk({}, {0: AXES}), "must hold a point mass with positions"),
        (trk({10**9: (1.0, 1.0)}, {0: AXES}), "must be of frames up to"),
        (PROJECT.replace(b"ImageCoordSystem", b"ReferenceFrame"), "`coords` must be fixed axes"),
    ],
)
def test_a_project_that_lacks_something_is_refused(tmp_path: Path, content: bytes, says: str) -> None:
    path = tmp_path / "film.trk"
    path.write_bytes(content)
    with pytest.raises(tr.InvalidValueError) as caught:
        tr.read_track(path)
    assert says in str(caught.value)
