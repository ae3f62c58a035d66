"""A GLB file, opened again by the library: the poses are the run's, the meshes are the body's."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib as gltf
import pytest
from scipy.spatial.transform import Rotation

import trundle as tr
from trundle.views.scene import scene_of
from trundle.views.viewer.glb import glb_of, rising

FLOAT32 = 2.0**-23
TO_GLTF = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # world: z up; glTF: y up


class Model:
    """A file as another program reads it."""

    def __init__(self, path: Path) -> None:
        self.file: Any = gltf.GLTF2().load(str(path))
        self.blob = self.file.binary_blob()
        self.nodes = {node.name: node for node in self.file.nodes}

    def numbers(self, accessor: int) -> np.ndarray:
        told = self.file.accessors[accessor]
        view = self.file.bufferViews[told.bufferView]
        kind = {gltf.FLOAT: "<f4", gltf.UNSIGNED_INT: "<u4"}[told.componentType]
        parts = {gltf.SCALAR: 1, gltf.VEC3: 3, gltf.VEC4: 4}[told.type]
        values = np.frombuffer(self.blob, kind, told.count * parts, view.byteOffset + (told.byteOffset or 0))
        return values.reshape(told.count, parts)

    def motion(self, name: str) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """The times and values of each channel of a node."""
        node = self.file.nodes.index(self.nodes[name])
        animation = self.file.animations[0]
        found = {}
        for channel in animation.channels:
            if channel.target.node == node:
                sampler = animation.samplers[channel.sampler]
                assert sampler.interpolation in (None, gltf.ANIM_LINEAR), "LINEAR, which for rotations is slerp"
                found[channel.target.path] = (self.numbers(sampler.input)[:, 0], self.numbers(sampler.output))
        return found

    def mesh(self, name: str) -> Any:
        return self.file.meshes[self.nodes[name].mesh].primitives[0]

    def world(self) -> np.ndarray:
        return Rotation.from_quat(self.nodes["world"].rotation).as_matrix()


def saved(name: str, folder: Path) -> tuple[tr.Trajectory, Model]:
    run = tr.Scenario.load(name).run()
    return run, Model(run.save_glb(folder / "scene.glb"))


@pytest.mark.parametrize(
    "name", ["tilted-turntable", "eulers-disc", "ball-in-a-turning-bowl", "bouncing-ball-with-backspin"]
)
def test_the_pose_at_each_instant_is_that_of_the_run(name: str, tmp_path: Path) -> None:
    run, model = saved(name, tmp_path)
    motion = model.motion("body")
    times, places = motion["translation"]
    at = run.at(np.clip(times.astype(float), 0.0, float(run.data.time[-1]))).in_frame("world").data
    speed = float(abs(at.velocity).max())
    expected = at.position.values @ TO_GLTF.T
    apart = np.abs(places @ model.world().T - expected)
    size = np.abs(expected).max()
    assert apart.max() <= 4 * FLOAT32 * (size + speed * times[-1]), "the times are rounded to float32 too"
    turned = Rotation.from_matrix(model.world()) * Rotation.from_quat(motion["rotation"][1])
    upright = Rotation.from_matrix(TO_GLTF) * Rotation.from_quat(np.roll(at.orientation.values, -1, axis=1))
    rate = float(abs(at.angular_velocity).max())
    assert (turned * upright.inv()).magnitude().max() <= 8 * FLOAT32 * (1.0 + rate * times[-1])


def test_time_begins_at_nought_ascends_and_ends_with_the_run(tmp_path: Path) -> None:
    run, model = saved("bouncing-ball-with-backspin", tmp_path)
    times, _ = model.motion("body")["translation"]
    assert times[0] == 0.0
    assert (np.diff(times) > 0).all()
    assert times[-1] == pytest.approx(float(run.data.time[-1]), rel=FLOAT32)


def test_a_turning_support_turns_at_its_rate(tmp_path: Path) -> None:
    run, model = saved("tilted-turntable", tmp_path)
    times, turns = model.motion("support")["rotation"]
    rate = run.system.support.motion.rate
    expected = Rotation.from_rotvec(np.outer(rate * times.astype(float), [0.0, 0.0, 1.0]))
    assert (Rotation.from_quat(turns) * expected.inv()).magnitude().max() <= 8 * FLOAT32 * (1 + rate * times[-1])


def test_a_support_at_rest_has_no_channels(tmp_path: Path) -> None:
    assert saved("eulers-disc", tmp_path)[1].motion("support") == {}


def test_the_mesh_of_a_ball_has_its_radius_and_the_path_its_places(tmp_path: Path) -> None:
    run, model = saved("tilted-turntable", tmp_path)
    told = model.file.accessors[model.mesh("body").attributes.POSITION]
    assert np.allclose([told.min, told.max], [[-0.025] * 3, [0.025] * 3], rtol=0, atol=1e-4)
    line = model.mesh("path")
    assert line.mode == gltf.LINE_STRIP
    points = model.numbers(line.attributes.POSITION)
    assert np.allclose(points[[0, -1]], run.data.position.values[[0, -1]], rtol=4 * FLOAT32)


def test_gravity_points_down_the_y_axis(tmp_path: Path) -> None:
    run, model = saved("tilted-turntable", tmp_path)
    tilt = run.system.support.tilt
    down = model.world() @ np.array([np.sin(tilt), 0.0, -np.cos(tilt)])
    assert np.allclose(down, [0.0, -1.0, 0.0], atol=1e-7)


@pytest.mark.parametrize("name", ["tilted-turntable", "eulers-disc", "ball-in-a-funnel", "cylinder-on-incline"])
def test_every_accessor_says_the_truth(name: str, tmp_path: Path) -> None:
    _, model = saved(name, tmp_path)
    for view in model.file.bufferViews:
        assert view.byteOffset % 4 == 0
        assert view.byteOffset + view.byteLength <= model.file.buffers[0].byteLength
    for node in ("body", "support"):
        mesh = model.mesh(node)
        places = model.numbers(mesh.attributes.POSITION)
        told = model.file.accessors[mesh.attributes.POSITION]
        assert np.allclose([told.min, told.max], [places.min(axis=0), places.max(axis=0)], rtol=1e-6, atol=1e-9)
        normals = model.numbers(mesh.attributes.NORMAL)
        assert np.allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-5)
        colours = model.numbers(mesh.attributes.COLOR_0)
        assert len(normals) == len(colours) == len(places)
        assert 0.0 <= colours.min() <= colours.max() <= 1.0
        if model.motion(node):
            assert len(np.unique(colours, axis=0)) > 1, "nothing is painted, so its turning is not seen"
        assert model.numbers(mesh.indices).max() < len(places)


def test_a_sheet_is_a_board_of_squares_of_a_round_length(tmp_path: Path) -> None:
    """A plane without an edge: it is painted square by square, so that a ball over it is seen to get on."""
    run, model = saved("bouncing-ball-with-backspin", tmp_path)
    mesh = model.mesh("support")
    places, colours = (model.numbers(one) for one in (mesh.attributes.POSITION, mesh.attributes.COLOR_0))
    corners = model.numbers(mesh.indices).reshape(-1, 3)
    assert (np.ptp(colours[corners], axis=1) == 0).all(), "no colour runs into another"
    across = np.cross(*(places[corners[:, i]] - places[corners[:, 0]] for i in (1, 2)))
    assert (across[:, 2] > 0).all()
    low, high = places.min(axis=0), places.max(axis=0)
    assert across[:, 2].sum() / 2 == pytest.approx(np.prod((high - low)[:2]), rel=1e-5), "nothing is left out"
    gone = run.data.position.values[:, :2]
    assert (low[:2] < gone.min(axis=0)).all()
    assert (high[:2] > gone.max(axis=0)).all()
    sides = np.diff(np.unique(places[:, 0].round(6)))[1:-1]
    assert len(sides) >= 5
    side = float(np.median(sides))
    assert np.allclose(sides, side, rtol=1e-4)
    assert round(side / 10 ** np.floor(np.log10(side) + 1e-6), 3) in (1, 2, 5)
    middles = places[corners].mean(axis=1)[:, :2]
    odd = np.floor(middles / side).sum(axis=1) % 2 == 1
    one, other = (np.unique(colours[corners[rule, 0]], axis=0) for rule in (odd, ~odd))
    assert len(one) == len(other) == 1
    assert np.abs(one - other).max() > 0.05


def test_the_container_is_as_the_format_says() -> None:
    content = glb_of(scene_of(tr.Scenario.load("level-turntable-nudged").run()))
    magic, form, length = struct.unpack_from("<4sII", content)
    assert (magic, form, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack_from("<I4s", content, 12)
    assert kind == b"JSON"
    rest, kind = struct.unpack_from("<I4s", content, 20 + size)
    assert kind == b"BIN\0"
    assert 28 + size + rest == len(content)


def test_instants_that_float32_cannot_tell_apart_are_left_out() -> None:
    assert rising(np.array([5.0, 1e3, 1e3 + 1e-9, 1e3 + 1e-2])).tolist() == [True, True, False, True]
