"""A scene goes into bytes and comes out again as it was."""

import json
import struct
from dataclasses import replace

import numpy as np
import pytest

import trundle as tr
from trundle.views.scene import Scene, pack, scene_of, unpack
from trundle.views.scene.body_mesh import body_mesh


@pytest.fixture(scope="module")
def scene():
    return scene_of(tr.Scenario.load("level-turntable-nudged").run(duration=2.0))


def test_what_is_packed_is_unpacked(scene):
    again = unpack(pack(scene))
    assert again.header == json.loads(json.dumps(scene.header))
    assert list(again.columns) == list(scene.columns)
    for name, column in scene.columns.items():
        assert again.columns[name].dtype == column.dtype
        assert np.array_equal(again.columns[name], column)
    assert again.units == scene.units


def test_the_bytes_are_laid_out_as_the_viewer_reads_them(scene):
    blob = pack(scene)
    magic, length, zero = struct.unpack("<8sII", blob[:16])
    assert (magic, zero) == (b"TRUNDLE1", 0)
    header = json.loads(blob[16 : 16 + length])
    for name, facts in header["columns"].items():
        begin = 16 + length + facts["offset"]
        rows, *_ = facts["shape"]
        written = np.ascontiguousarray(scene.columns[name], "<" + np.dtype(facts["dtype"]).str[1:]).tobytes()
        differences = b"".join(blob[begin + row : begin + len(written) : rows] for row in range(rows))
        size, side = np.dtype(facts["dtype"]).itemsize, len(written) // rows
        back = [bytes(side), bytes(side)]  # the rows before the first
        for row in range(rows):
            numbers = (
                int.from_bytes(differences[at : at + size], "little")
                + 2 * int.from_bytes(back[-1][at - row * side : at - row * side + size], "little")
                - int.from_bytes(back[-2][at - row * side : at - row * side + size], "little")
                for at in range(row * side, (row + 1) * side, size)
            )
            back.append(b"".join((number % 256**size).to_bytes(size, "little") for number in numbers))
        assert b"".join(back) == bytes(2 * side) + written
    assert header["columns"]["time"] == {"dtype": "float64", "shape": [201], "offset": 0, "unit": "s"}


def test_meshes_that_are_known_are_named_and_left_out(scene):
    meshes = {part: {name for name in scene.columns if name.startswith(part)} for part in ("body_", "support_")}
    moving = {"support_position", "support_orientation"}
    assert "meshes" not in unpack(pack(scene)).header
    named = unpack(pack(scene, ()))
    assert set(named.columns) == set(scene.columns)
    body, support = (named.header["meshes"][whose] for whose in ("body", "support"))
    assert body["size"] == pytest.approx(scene.header["body"]["radius"], rel=1e-12)
    assert set(scene.columns) - set(unpack(pack(scene, [body["name"]])).columns) == meshes["body_"]
    both = unpack(pack(scene, [support["name"], "nobody's", body["name"]]))
    assert set(scene.columns) - set(both.columns) == meshes["body_"] | meshes["support_"] - moving
    assert both.header["meshes"] == named.header["meshes"]
    for name, column in both.columns.items():
        assert np.array_equal(column, scene.columns[name])


def test_only_size_may_differ_under_the_name_of_a_mesh():
    small, large = body_mesh(tr.Body.solid_sphere(0.0113, 1.0)), body_mesh(tr.Body.hollow_sphere(7.7, 3.0))
    assert small.name == large.name
    assert np.allclose(small.vertices * (large.size / small.size), large.vertices, rtol=0, atol=1e-5 * large.size)
    egg = body_mesh(tr.Body.ellipsoid((0.3, 0.2, 0.1), mass=1.0))
    twice = body_mesh(tr.Body.ellipsoid((0.6, 0.4, 0.2), mass=5.0))
    longer = body_mesh(tr.Body.ellipsoid((0.3001, 0.2, 0.1), mass=1.0))
    assert egg.name == twice.name
    assert len({small.name, egg.name, longer.name, replace(egg, paint=-egg.paint).name}) == 4
    assert replace(egg, triangles=egg.triangles[1:]).name != egg.name
    turned = replace(egg, normals=egg.normals[:, ::-1])
    assert turned.name != egg.name


def test_a_column_may_be_empty_or_lie_otherwise_in_memory():
    columns = {
        "none": np.zeros((0, 3), np.float32),
        "turned": np.arange(6.0).reshape(2, 3).T,
        "big": np.arange(4, dtype=">u4").astype("uint32"),
        "extreme": np.array([0.0, -0.0, 5e-324, -1.7976931348623157e308, np.inf, -np.inf, 0.1]),
        "bytes": np.array([[255, 0], [0, 255], [255, 1]], dtype=np.uint8),
        "one": np.array([[7.0, -7.0]], dtype=np.float32),
    }
    again = unpack(pack(Scene({}, columns))).columns
    for name, column in columns.items():
        assert again[name].shape == column.shape
        assert np.array_equal(again[name], column)


def test_numbers_that_are_not_finite_become_null():
    blob = pack(Scene({"ratio": float("nan"), "list": [np.inf, np.float32(0.5)]}, {}))
    assert unpack(blob).header == {"ratio": None, "list": [None, 0.5]}


@pytest.mark.parametrize("part", [slice(40), slice(-400), slice(1, None), slice(0)])
def test_damaged_bytes_are_refused(scene, part):
    with pytest.raises(tr.TrundleError, match="scene"):
        unpack(pack(scene)[part])


def test_a_damaged_header_is_refused(scene):
    blob = bytearray(pack(scene))
    blob[20] = 0
    with pytest.raises(tr.TrundleError, match="damaged"):
        unpack(bytes(blob))


@pytest.mark.parametrize("samples", [1, 0, -5, 2.5, True, "100"])
def test_samples_must_be_a_count(samples):
    run = tr.Scenario.load("ball-under-force").run()
    with pytest.raises(tr.InvalidValueError, match="samples"):
        scene_of(run, samples=samples)


def test_no_more_samples_than_asked():
    run = tr.Scenario.load("ball-under-force").run()
    found = scene_of(run, samples=50).columns["time"]
    assert found.size == 50
    assert found[0] == run.data.time.values[0]
    assert found[-1] == run.data.time.values[-1]


def test_the_card_comes_only_when_asked_for():
    run = tr.Scenario.load("ball-under-force").run()
    assert scene_of(run).header["card"] is None
    header = unpack(pack(scene_of(run, with_card=True, seconds=0.25))).header
    assert header["card"] == json.loads(json.dumps(run.card().as_dict()))
    assert header["seconds"] == 0.25


def test_a_run_is_shown_alike_whatever_frame_it_is_told_in():
    run = tr.Scenario.load("tilted-turntable-put-down").run(duration=2.0)
    one, other = scene_of(run), scene_of(run.in_frame("corotating"))
    for name, column in one.columns.items():
        assert np.allclose(column, other.columns[name], rtol=0, atol=1e-6 * max(1.0, float(np.max(np.abs(column))))), (
            name
        )


def test_the_world_is_turned_about_the_second_axis():
    header = scene_of(tr.Scenario.load("tilted-turntable-put-down").run(duration=1.0)).header
    w, x, y, z = header["to_world"]
    assert (x, z) == (0, 0)
    assert 2 * np.arctan2(y, w) == pytest.approx(header["tilt"], rel=1e-12)
    assert header["gravity"] == [0, 0, -9.80665]
