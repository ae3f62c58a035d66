"""Films in the lab: kept for a while under a name of its own, followed, and gone afterwards."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

import trundle as tr
from trundle import extras
from trundle.lab import Settings, create_app
from trundle.lab.filming import outlines

cv2 = pytest.importorskip("cv2", reason="the extra `video` is not installed")

from tests.tracks.studio import Studio, write  # noqa: E402  it draws with OpenCV

STUDIO = Studio(noise=3.0)
SAID = {"ball_radius": "20 mm", "rim_radius": "14 cm", "mark_colour": "#0a500f"}


def circling(t: Any) -> Any:
    """A ball of ratio 0.4 without a push goes round at 2/7 of the table's rate."""
    angle = STUDIO.rate * 2 / 7 * np.asarray(t)
    return 0.06 * np.column_stack([np.cos(angle), np.sin(angle)])


@pytest.fixture(scope="module")
def film(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    target = tmp_path_factory.mktemp("films") / "table.avi"
    return write(target, STUDIO.pictures(circling, np.arange(60) / 30), code="MJPG").read_bytes()


def sent(lab: TestClient, content: bytes, name: str = "table.avi") -> Any:
    head = {"content-type": "application/octet-stream"}
    return lab.post("/api/film", params={"name": name}, content=content, headers=head)


@pytest.fixture
def served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Start a lab with settings of the test's own; films lie in `tmp_path` while it runs, and not after."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    opened = []

    def start(**settings: Any) -> TestClient:
        client = TestClient(create_app(Settings(workers=1, **settings)), base_url="http://127.0.0.1")
        opened.append(client.__enter__())
        return opened[-1]

    yield start
    for client in opened:
        client.__exit__(None, None, None)
    assert not films_in(tmp_path)


def films_in(folder: Path) -> list[Path]:
    return list(folder.glob("trundle-lab-films-*/*/film*"))


def test_a_film_is_followed_as_by_the_package(served: Any, film: bytes, tmp_path: Path) -> None:
    lab = served()
    kept = sent(lab, film).json()
    assert (kept["width"], kept["height"], kept["rate"], kept["length"], kept["taken"]) == (320, 240, 30, 2, None)
    ring = 2 * np.pi * np.arange(400) / 400
    rim = STUDIO.seen(np.column_stack([0.14 * np.cos(ring), 0.14 * np.sin(ring), 0 * ring]))
    far = np.linalg.norm(np.array(kept["rim"])[:, None] - rim[None], axis=2).min(axis=1)
    assert far.max() < 1.0
    answer = lab.post(f"/api/film/{kept['film']}/track", json=SAID).json()
    place = tmp_path / "own.avi"
    place.write_bytes(film)
    own = tr.track_film(place, **SAID)
    for name in own.columns:
        np.testing.assert_array_equal(answer["columns"][name], own[name])
    assert answer["title"] == "table.avi"
    assert answer["accuracy"] == own.data.attrs["accuracy"]
    assert not any("film.avi" in clause for clauses in answer["said"] for clause in clauses)
    np.testing.assert_allclose(answer["film"]["pixels"], own.pixels, atol=0.051)
    assert lab.get(f"/api/film/{kept['film']}/progress").json()["done"] > 0.5

    asked = {"columns": answer["columns"], "accuracy": answer["accuracy"], "view": answer["film"]["view"]}
    found = lab.post("/api/fit", json={**answer["suggested"], **asked}).json()
    k, sigma = (float(part) for part in found["rows"][0][1].split(" ± "))
    assert abs(k - 0.4) < min(0.004, 2 * sigma)
    middles = np.array(found["seen"]["outlines"]).mean(axis=1)
    shown = np.interp(answer["columns"]["t"], found["seen"]["time"], middles[:, 0])
    assert np.abs(shown - own.pixels[:, 0]).max() < 0.7
    assert {"key": "mark.position[0]", "group": "Mark on the support", "label": "Position x"} in found["named"]


def test_the_outline_of_a_ball_is_where_a_camera_of_another_make_sees_it() -> None:
    one = STUDIO
    matrix, _, turn, shift = one.pinhole()
    rotation = cv2.Rodrigues(turn)[0]
    down = cv2.Rodrigues(np.diag([1.0, -1.0, -1.0]) @ rotation)[0].ravel()
    view = {"focal": one.focal, "centre": [matrix[0, 2], matrix[1, 2]], "turn": down.tolist(),
            "place": list(one.lens), "distortion": 0.0, "ball": one.ball}  # fmt: skip
    assert shift is not None
    for place in ((0.05, -0.03), (-0.1, 0.06)):
        mine = np.array(outlines(view, np.array([place]))[0])
        theirs = one.seen(one.outline(*place))
        far = np.linalg.norm(mine[:, None] - theirs[None], axis=2).min(axis=1)
        assert far.max() < 0.6  # the rings have other points: they are 2.2 px apart at most
        assert np.linalg.norm(mine.mean(axis=0) - theirs.mean(axis=0)) < 0.1


def test_pictures_stand_for_a_film_that_a_browser_cannot_play(served: Any, film: bytes) -> None:
    lab = served()
    token = sent(lab, film).json()["film"]
    for at in (0.0, 1.0):
        still = lab.get(f"/api/film/{token}/picture", params={"at": at})
        seen = cv2.imdecode(np.frombuffer(still.content, np.uint8), cv2.IMREAD_COLOR)
        x, y = STUDIO.seen([[*circling([at])[0], STUDIO.ball]])[0].round().astype(int)
        blue, green, red = seen[y, x].astype(int)
        assert red > 80 > max(blue, green)  # the ball
    times, begin = [], 0.0
    while begin is not None:
        part = lab.get(f"/api/film/{token}/pictures", params={"length": 2.0, "begin": begin}).json()
        times += part["times"]
        assert all(one.startswith("data:image/jpeg;base64,") for one in part["pictures"])
        begin = part["next"]
    np.testing.assert_allclose(times, np.arange(60) / 30, atol=1e-3)
    assert len(lab.get(f"/api/film/{token}/pictures", params={"length": 100.0}).json()["times"]) < 10


def test_a_film_is_removed_when_its_page_has_gone(served: Any, film: bytes, tmp_path: Path) -> None:
    lab = served(films_each=1)
    first = sent(lab, film).json()["film"]
    assert len(films_in(tmp_path)) == 1
    second = sent(lab, film).json()["film"]  # takes the place of the first
    assert len(films_in(tmp_path)) == 1
    gone = lab.get(f"/api/film/{first}/progress")
    assert gone.status_code == 404
    assert "Drop it again" in gone.json()["error"]["message"]
    assert lab.delete(f"/api/film/{second}").status_code == 200
    assert not films_in(tmp_path)


def test_a_film_that_nobody_asks_for_is_removed(served: Any, film: bytes, tmp_path: Path) -> None:
    lab = served(film_life=0.5)
    sent(lab, film)
    until = time.monotonic() + 20
    while films_in(tmp_path) and time.monotonic() < until:
        lab.get("/api/ready")
        time.sleep(0.1)
    assert not films_in(tmp_path)


def test_what_is_left_when_the_lab_ends_is_removed(served: Any, film: bytes, tmp_path: Path) -> None:
    sent(served(), film)
    assert films_in(tmp_path)  # and not any more, as the fixture sees


def test_a_film_that_is_too_large_is_not_kept(served: Any, film: bytes, tmp_path: Path) -> None:
    answer = sent(served(film_bytes=1000), film)
    assert answer.status_code == 413
    assert "Send less" in answer.json()["error"]["message"]
    assert not films_in(tmp_path)


def test_a_film_that_takes_too_long_is_given_up(served: Any, film: bytes) -> None:
    lab = served(film_time=0.2)
    token = sent(lab, film).json()["film"]
    answer = lab.post(f"/api/film/{token}/track", json=SAID)
    assert answer.status_code == 504
    assert "0.2 s" in answer.json()["error"]["message"]


def test_not_all_slow_processes_follow_films(served: Any, film: bytes) -> None:
    lab = served(slow_workers=2)
    token = sent(lab, film).json()["film"]
    answers = []
    asking = [
        threading.Thread(target=lambda: answers.append(lab.post(f"/api/film/{token}/track", json=SAID)))
        for _ in range(2)
    ]
    for one in asking:
        one.start()
    for one in asking:
        one.join()
    assert sorted(one.status_code for one in answers) == [200, 503]
    busy = next(one for one in answers if one.status_code == 503)
    assert "follows another film" in busy.json()["error"]["message"]


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("table.txt", b"RIFF", "A film ends in .mp4"),
        ("table.mp4", b"", "an empty file"),
        ("table.mp4", b"so long, and thanks" * 50, "another file"),
        ("table.mp4", b"#EXTM3U\n#EXT-X-TARGETDURATION:9\n#EXTINF:9,\n/etc/passwd\n", "another file"),
        ("table.mp4", b"ffconcat version 1.0\nfile '/etc/passwd'\n", "another file"),
        ("table.avi", 3000, "must be a film that can be read"),
        ("table.mp4", b"\x00\x00\x00\x18ftypmp42" + bytes(range(256)) * 20, "must be a film that can be read"),
    ],
    ids=["ending", "empty", "text", "playlist", "list", "cut", "corrupt"],
)
def test_what_is_no_film_is_refused_in_words(
    served: Any, film: bytes, tmp_path: Path, name: str, content: Any, said: str
) -> None:
    answer = sent(served(), film[:content] if isinstance(content, int) else content, name)
    assert answer.status_code == 422
    assert said in answer.json()["error"]["message"]
    assert str(tmp_path) not in answer.text
    assert not films_in(tmp_path)


def test_a_film_without_a_ball_says_so(served: Any, tmp_path: Path) -> None:
    pictures = (np.random.default_rng(i).normal(100, 3, (120, 160, 3)).clip(0, 255).astype(np.uint8) for i in range(30))
    lab = served()
    kept = sent(lab, write(tmp_path / "wall.avi", pictures, code="MJPG").read_bytes()).json()
    assert kept["rim"] is None
    corners = [[10, 10, "0 cm", "9 cm"], [150, 10, "9 cm", "9 cm"], [150, 110, "9 cm", 0], [10, 110, 0, 0]]
    for told, said in (
        ({"rim_radius": "15 cm"}, "a film in which none is found"),
        ({"marks": corners, "height": "1 m"}, "nothing of its size that moves"),
        ({"marks": corners[:3]}, "must be at least 4"),
        ({"rim_radius": "15 stones"}, "stones"),
    ):
        answer = lab.post(f"/api/film/{kept['film']}/track", json={"ball_radius": "20 mm", **told})
        assert answer.status_code == 422
        assert said in answer.json()["error"]["message"]
        assert "`--" not in answer.text


def test_without_the_extra_the_message_names_it(served: Any, film: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(extras.MODULES, "video", ("no_such_module",))
    lab = served()
    for answer in (lab.get("/api/film"), sent(lab, film)):
        assert answer.status_code == 422
        assert "pip install 'trundle[video]'" in answer.json()["error"]["message"]
