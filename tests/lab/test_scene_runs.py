"""Every shipped scenario as a scene: whole, and drawn so that the body really rolls."""

import json

import numpy as np
import pytest
from numpy.lib.stride_tricks import sliding_window_view

import trundle as tr
from trundle.scenario.files import is_shipped_path, names
from trundle.views.scene import pack, scene_of, unpack

SHIPPED = [name for name in names() if not is_shipped_path(name)]
ROLLING, FLIGHT = 0, 2
FLOAT32 = 2.0**-23


@pytest.fixture(scope="module", params=SHIPPED)
def shown(request):
    run = tr.Scenario.load(request.param).run()
    return run, unpack(pack(scene_of(run)))


def matrices(q):
    w, x, y, z = np.asarray(q, dtype=float).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (z * z + x * x), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def poses(columns, name):
    """Return place and rotation of "body" or "support" at each sample, from the columns alone."""
    count = columns["time"].size
    if name == "body":
        return columns["position"].astype(float), matrices(columns["orientation"])
    if "support_position" not in columns:
        return np.zeros((count, 3)), np.broadcast_to(np.eye(3), (count, 3, 3))
    return columns["support_position"].astype(float), matrices(columns["support_orientation"])


def material_velocity(columns, name, stride=1):
    """Return how fast the material at the contact moves, by differences to the samples a stride before and after."""
    place, turn = poses(columns, name)
    p, t = columns["contact"].astype(float), columns["time"]
    first, here, last = slice(None, -2 * stride), slice(stride, -stride), slice(2 * stride, None)
    own = np.einsum("nji,nj->ni", turn[here], p[here] - place[here])
    before = place[first] + np.einsum("nij,nj->ni", turn[first], own)
    after = place[last] + np.einsum("nij,nj->ni", turn[last], own)
    h1, h2 = (t[here] - t[first])[:, None], (t[last] - t[here])[:, None]
    # Second order on uneven steps, too.
    return ((after - p[here]) * h1 / h2 + (p[here] - before) * h2 / h1) / (h1 + h2)


def drawn_slip(columns, stride=1):
    return material_velocity(columns, "body", stride) - material_velocity(columns, "support", stride)


def rms(vectors):
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=-1))))


def distance(points, vertices, triangles):
    """Return the distance of each point from a mesh."""
    a, b, c = (vertices[triangles[:, i]].astype(float) for i in range(3))
    u, v = b - a, c - a
    uu, uv, vv = (np.sum(s * t, axis=1) for s, t in ((u, u), (u, v), (v, v)))
    found = []
    for point in points:
        w = point - a
        wu, wv = np.sum(w * u, axis=1), np.sum(w * v, axis=1)
        det = uu * vv - uv * uv
        s, t = (vv * wu - uv * wv) / det, (uu * wv - uv * wu) / det
        inside = (s >= 0) & (t >= 0) & (s + t <= 1)
        plane = np.linalg.norm(w - s[:, None] * u - t[:, None] * v, axis=1)
        edges = []
        for start, way in ((a, u), (a, v), (b, c - b)):
            share = np.clip(np.sum((point - start) * way, axis=1) / np.sum(way * way, axis=1), 0, 1)
            edges.append(np.linalg.norm(point - start - share[:, None] * way, axis=1))
        found.append(np.min(np.where(inside, plane, np.min(edges, axis=0))))
    return np.array(found)


def touching(columns, count):
    """Return some samples at which body and support touch; none of a body that only bounces."""
    where = np.flatnonzero(columns["phase"] != FLIGHT)
    return where[np.unique(np.linspace(0, where.size - 1, count).astype(int))] if where.size else where


def test_a_scene_is_whole(shown):
    run, scene = shown
    columns, header = scene.columns, scene.header
    n = columns["time"].size
    assert 2 <= n <= 10_100
    assert np.all(np.diff(columns["time"]) > 0)
    for name, column in columns.items():
        assert np.isfinite(column).all(), name
    for name in ("position", "contact", "velocity", "angular_velocity", "contact_force"):
        assert columns[name].shape == (n, 3)
        assert columns[name].dtype == np.float32
    for name in ("orientation", "support_orientation"):
        if name in columns:
            q = columns[name]
            assert np.allclose(np.linalg.norm(q, axis=1), 1, rtol=0, atol=1e-6)
            assert np.all(np.sum(q[1:] * q[:-1], axis=1) >= 0)
    assert set(np.unique(columns["phase"])) <= {0, 1, 2, 3}
    assert header["support"]["moves"] == ("support_position" in columns)
    assert header["guiding_centre"] == ("guiding_centre" in columns)
    assert header["duration"] == pytest.approx(columns["time"][-1] - columns["time"][0])
    assert [event["time"] for event in header["events"]] == [event.time for event in run.events]
    assert header["scenario"]["body"]["kind"] == header["body"]["kind"]
    assert header["scenario"]["support"]["kind"] == header["support"]["kind"]
    assert json.dumps(header, allow_nan=False)
    for name in ("body", "support"):
        assert columns[f"{name}_triangles"].max() < len(columns[f"{name}_vertices"])
        assert columns[f"{name}_normals"].shape == columns[f"{name}_vertices"].shape


def test_the_samples_are_those_of_the_run(shown):
    run, scene = shown
    columns = scene.columns
    own = run.data.time.values
    _, here, there = np.intersect1d(columns["time"], own, return_indices=True)
    assert here.size >= 2
    for name in ("position", "velocity", "contact_force"):
        expected = run.data[name].values[there]
        size = np.max(np.abs(expected))
        close = np.all(np.abs(columns[name][here] - expected) <= 1e-6 * size, axis=1)
        assert np.mean(close) > 0.99  # of a landing at a sample's time, either side may be shown


def test_the_contact_lies_on_both_meshes(shown):
    _, scene = shown
    columns = scene.columns
    some = touching(columns, 12)
    p = columns["contact"].astype(float)[some]
    size = {"body": scene.header["body"]["radius"], "support": scene.header["support"]["size"]}
    for name in ("body", "support"):
        place, turn = poses(columns, name)
        own = np.einsum("nji,nj->ni", turn[some], p - place[some])
        away = distance(own, columns[f"{name}_vertices"], columns[f"{name}_triangles"])
        rounding = 4 * FLOAT32 * (np.max(np.abs(columns["position"])) + size[name])
        assert np.max(away, initial=0.0) <= 5e-3 * size[name] + rounding, name


def test_what_is_drawn_rolls(shown):
    """No slip, seen in the drawing: the two materials at the contact move alike, to the second order of the step."""
    _, scene = shown
    columns = scene.columns
    t = columns["time"]
    rolls = np.all(sliding_window_view(columns["phase"] == ROLLING, 5), axis=1)
    for event in scene.header["events"]:
        rolls &= ~((t[:-4] <= event["time"]) & (event["time"] <= t[4:]))
    if not rolls.any():
        pytest.skip("it never rolls")
    near, far = rms(drawn_slip(columns)[1:-1][rolls]), rms(drawn_slip(columns, 2)[rolls])
    arm = np.linalg.norm(columns["contact"] - columns["position"], axis=1)
    carried = rms((np.linalg.norm(columns["angular_velocity"], axis=1) * arm)[2:-2][rolls][:, None])
    size = np.max(np.abs(columns["position"])) + np.max(arm)
    rounding = 4 * FLOAT32 * size / np.min(np.diff(t)[1:-1])
    assert near <= 0.4 * far + rounding
    assert near <= 0.1 * carried + rounding
    if carried > 10 * rounding:  # and a body that does not turn would be seen
        still = {**columns, "orientation": np.broadcast_to(columns["orientation"][0], columns["orientation"].shape)}
        slips = [rms(drawn_slip(still, stride)[2 - stride : len(t) - 2 - stride][rolls]) for stride in (1, 2)]
        assert slips[0] > 0.4 * slips[1] + rounding


def test_the_slip_of_the_drawing_falls_with_the_square_of_the_step():
    scenario = tr.Scenario.load("level-turntable-nudged")
    slips = []
    for every in (0.02, 0.01):
        columns = scene_of(scenario.run(duration=3.0, every=every)).columns
        assert np.allclose(np.diff(columns["time"]), every)
        slips.append(np.max(np.linalg.norm(drawn_slip(columns), axis=1)))
    assert 3.7 < slips[0] / slips[1] < 4.3
    assert slips[1] < 0.02
