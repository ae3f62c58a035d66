"""What the lab reads and fits is what the package reads and fits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

import trundle as tr
from trundle.lab import Settings, create_app

RAMP = tr.tracks.example("ball-on-a-ramp")


def sent(lab: TestClient, content: bytes, name: str, **how: str) -> Any:
    return lab.post(
        "/api/track",
        params={"name": name, **how},
        content=content,
        headers={"content-type": "application/octet-stream"},
    )


def test_a_fit_is_that_of_the_package(lab: TestClient) -> None:
    track = sent(lab, RAMP.path.read_bytes(), RAMP.path.name).json()
    assert track["columns"]["x"] == [None if np.isnan(x) else x for x in RAMP.track()["x"]]
    asked = {"scenario": RAMP.scenario, "columns": track["columns"], "free": RAMP.free, "noise": RAMP.noise}
    asked["title"] = track["title"]
    answer = lab.post("/api/fit", json=asked).json()
    found = tr.fit(RAMP.track(), tr.Scenario.read(RAMP.scenario), free=RAMP.free, noise=RAMP.noise)
    assert answer["rows"] == [list(row) for row in found.rows]
    assert answer["verdict"] == found.verdict
    assert answer["commented"] == found.to_toml()
    assert tr.Scenario.read(answer["scenario"]).body.inertia_ratio == pytest.approx(found["body.inertia_ratio"].value)
    way = answer["way"]
    first, end = (np.array(way["frames"][place]["columns"][0]) for place in (0, -1))
    assert np.abs(first - end).max() > 1e-3  # it began elsewhere
    last = np.interp(way["time"], found.problem.models[0].seen.time, found.predicted()[0][:, 0])
    assert np.allclose(end, last, rtol=0, atol=1e-12)


def test_a_telephone_in_a_ball_is_no_film_of_its_turning(lab: TestClient) -> None:
    t = np.arange(300) / 50.0
    phone = {"t": t, "gyro_x": 2 + 0 * t, "gyro_y": np.cos(3 * t), "gyro_z": np.sin(3 * t)}
    head = "Time (s),Gyroscope x (rad/s),Gyroscope y (rad/s),Gyroscope z (rad/s)\n"
    rows = "".join(",".join(map(repr, map(float, row))) + "\n" for row in zip(*phone.values(), strict=True))
    track = sent(lab, (head + rows).encode(), "phone.csv").json()
    assert {name: len(column) for name, column in track["columns"].items()} == dict.fromkeys(phone, 300)
    assert track["units"] == {"t": "s"} | dict.fromkeys(("gyro_x", "gyro_y", "gyro_z"), "rad/s")
    ball = {"kind": "sphere", "radius": 0.025, "mass": 0.065, "inertia_ratio": 0.5}
    table = {"kind": "plane", "motion": {"kind": "spin", "rate": 3.0}}
    scenario = {"body": ball, "support": table, "start": {"position": [0.1, 0]}, "run": {"duration": 6, "every": 0.02}}
    asked = {"scenario": scenario, "columns": track["columns"], "free": ["start.spin"], "noise": "0.01 rad/s"}
    answer = lab.post("/api/fit", json=asked).json()
    found = tr.fit(phone, tr.Scenario.read(scenario), free=["start.spin"], noise="0.01 rad/s")
    assert answer["rows"] == [list(row) for row in found.rows]
    assert answer["way"]["columns"] == ["gyro_x", "gyro_y", "gyro_z"]


def test_a_long_track_is_thinned_and_says_so(lab: TestClient) -> None:
    rows = "".join(f"{i / 1000:.4f},{i},{i}\n" for i in range(20_000))
    track = sent(lab, f"t (s),x (mm),y (mm)\n{rows}".encode(), "long.csv").json()
    assert len(track["columns"]["t"]) == 4000
    assert "one in 5" in track["said"][-1][0]


@pytest.mark.parametrize(
    ("name", "content", "how", "said"),
    [
        ("../../track.exe", b"MZ", {}, "'track.exe'"),
        ("track.csv", b"t,x\n0,1\n1e-2,2\n", {"units": "stone"}, "unit of length"),
        ("track.csv", b"t (s),x (m)\n0,1\n1e-2,2\n", {"track": "blue"}, "unknown track of this file"),
        ("track.csv", b"t (s),x (m)\n0,1\n1e-2,2\n", {"columns": "x"}, "must be pairs"),
        ("track.csv", b"t (s),x (m)\n0,1\n1e-2,2\n", {"rate": "sixty"}, "frames a second"),
    ],
)
def test_what_cannot_be_read_is_refused_in_words(
    lab: TestClient, name: str, content: bytes, how: dict[str, str], said: str
) -> None:
    answer = sent(lab, content, name, **how)
    assert answer.status_code == 422
    assert said in answer.json()["error"]["message"]
    assert "trundle-lab-" not in answer.text  # the folder is nobody's business


def test_a_file_that_is_too_large_is_not_read() -> None:
    with TestClient(create_app(Settings(workers=1, upload_bytes=1000)), base_url="http://127.0.0.1") as lab:
        answer = sent(lab, bytes(1001), "track.csv")
    assert answer.status_code == 413
    assert "Send less" in answer.json()["error"]["message"]


@pytest.mark.parametrize("most", [0.02, 60.0])
def test_a_fit_has_a_time_of_its_own(most: float) -> None:
    """Not that of other computations, whichever is longer."""
    settings = Settings(workers=1, slow_workers=1, fit_time=most, wall_time=60.02 - most, quick_time=60.0)
    track = RAMP.track()
    columns = {name: [None if np.isnan(v) else float(v) for v in track[name]] for name in ("t", "x")}
    asked = {"scenario": RAMP.scenario, "columns": columns, "free": RAMP.free, "noise": RAMP.noise}
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as lab:
        answer = lab.post("/api/fit", json=asked)
    assert answer.status_code == (504 if most < 1 else 200), answer.text
    assert most > 1 or "0.02 s" in answer.json()["error"]["message"]


def test_a_fit_of_columns_that_are_no_motion_says_what_is_wrong(lab: TestClient) -> None:
    for columns, said in (({"t": [0, 1]}, "columns"), ({"t": [0, 1], "x": [0, 1]}, "rows at least")):
        answer = lab.post("/api/fit", json={"scenario": RAMP.scenario, "columns": columns})
        assert answer.status_code == 422
        assert said in answer.json()["error"]["message"]
