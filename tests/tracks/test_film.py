"""Films of known motions through a known camera: the ball's track and the numbers of the table come back."""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.errors import InvalidValueError
from trundle.tracks.film import ground as grounds
from trundle.tracks.film.calibration import Sightings, calibrate, check_marks
from trundle.tracks.film.container import open_film
from trundle.tracks.film.ground import sample
from trundle.tracks.film.pinhole import PinholeCamera

cv2 = pytest.importorskip("cv2", reason="the extra `video` is not installed")

from .studio import Studio, write  # noqa: E402  it draws with OpenCV

ROOT = Path(__file__).parents[2]
RATIO, RATE = 0.4, 3.4907
PLAIN = Studio()
TABLE: dict[str, Any] = {
    "title": "the filmed table",
    "body": {"kind": "sphere", "radius": "20 mm", "mass": "90 g", "inertia_ratio": RATIO},
    "support": {"kind": "plane", "motion": {"kind": "spin", "rate": RATE}},
    "start": {"position": ["3 cm", 0], "velocity": ["6 cm/s", "-2 cm/s"]},
    "run": {"duration": "8 s", "every": "1 ms"},
}
SEEN = {"ball_radius": "20 mm", "rim_radius": "14 cm", "mark_colour": "#0a500f", "focal": PLAIN.focal}


@pytest.fixture(scope="module")
def path() -> Any:
    """The motion, as trundle computes it, at any time."""
    data = tr.Scenario.read(TABLE).run().data
    time, places = np.asarray(data.time), np.asarray(data.position)
    return lambda t: np.column_stack([np.interp(t, time, places[:, i]) for i in (0, 1)])


def fitted(source: Any) -> Any:
    """Return a fit that begins with wrong numbers."""
    tables = {**TABLE, "body": {**TABLE["body"], "inertia_ratio": 0.6}, "start": {"position": [0, 0]}}
    tables["support"] = {"kind": "plane", "motion": {"kind": "spin", "rate": 3.3}}
    return tr.fit(source, tr.Scenario.read(tables), free=["body.inertia_ratio", "support.motion.rate"])


def comes_back(found: Any) -> None:
    """The numbers are within 1 % and two of their errors."""
    for key, truth in (("body.inertia_ratio", RATIO), ("support.motion.rate", RATE)):
        estimate = found[key]
        assert abs(estimate.value - truth) < 0.01 * truth
        assert abs(estimate.value - truth) < 2 * estimate.sigma, key


# --- the whole way -----------------------------------------------------------------------------------------------


def hand(i: int, picture: Any) -> Any:
    """A hand passes over, slowly; nothing of it looks like the ball."""
    if 60 <= i < 72:
        cv2.rectangle(picture, ((i - 60) * 20, 0), ((i - 60) * 20 + 70, 239), (140, 170, 215), -1)
    return picture


@pytest.fixture(scope="module")
def table_film(path: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A patterned table, a hand, a frame shown twice; compressed."""
    studio = Studio(spokes=3, noise=3.0)
    times = np.arange(130) / 30
    times[101] = times[100]
    pictures = list(studio.pictures(path, times, hand))
    pictures[101] = pictures[100]
    return write(tmp_path_factory.mktemp("film") / "table.webm", iter(pictures), code="VP80")


@pytest.fixture(scope="module")
def tracked(table_film: Path) -> Any:
    return tr.track_film(table_film, **SEEN)


def test_the_numbers_come_back_from_a_film(tracked: Any, path: Any, tmp_path: Path) -> None:
    comes_back(fitted(tracked))
    saved = tr.read_track(tracked.save(tmp_path / "track.csv"))
    assert saved.columns == ("x", "y", "mark_x", "mark_y")
    for name in saved.columns:
        np.testing.assert_allclose(saved[name], tracked[name], atol=1e-7)
    true = path(tracked.time) @ [1, 1j]
    seen = tracked["x"] + 1j * tracked["y"]
    turned = np.vdot(true, seen) / np.vdot(true, true)
    assert abs(abs(turned) - 1) < 2e-3  # a tenth of a pixel of the rim
    assert np.std(seen - turned * true) < 0.1 * PLAIN.lens[2] / PLAIN.focal * 1.5  # a tenth of a pixel, there


def test_what_was_not_taken_is_named_with_its_reason(tracked: Any) -> None:
    reasons = {one.row: one.reason for one in tracked.rejected}
    assert reasons[101] == "it repeats the frame before"
    under_the_hand = {number for number in reasons if 60 <= number < 72}
    assert under_the_hand
    assert set(reasons) <= under_the_hand | {101}
    assert "frame 101 (it repeats the frame before)" in str(tracked)


def test_the_camera_is_found(tracked: Any) -> None:
    assert abs(tracked.height - PLAIN.lens[2]) < 2e-3
    rate, sigma = tracked.rate
    assert abs(rate - RATE) < 4 * sigma < 2e-3


def test_the_check_film_shows_the_track(tracked: Any, table_film: Path, tmp_path: Path) -> None:
    drawn = tracked.save_check(tmp_path / "check.mp4")
    there, here = (list(open_film(one).frames()) for one in (drawn, table_film))
    assert len(there) == len(here)
    i = int(np.flatnonzero(tracked.data["row"].values == 30)[0])
    x, y = tracked.pixels[i].round().astype(int)
    yellow = there[30].picture[y - 1 : y + 2, x - 1 : x + 2].reshape(-1, 3).astype(int)
    assert (yellow[:, 1] - yellow[:, 0]).max() > 80  # the cross, on a red ball
    with pytest.raises(tr.UnknownNameError):
        tracked.save_check(tmp_path / "check.gif")


@pytest.mark.parametrize(("code", "ending", "said"), [("mp4v", "mp4", "a quarter"), ("MJPG", "avi", "a tenth")])
def test_a_coarse_codec_is_said_to_be_less_accurate(code: str, ending: str, said: str, tmp_path: Path) -> None:
    def circling(t: Any) -> Any:
        return 0.06 * np.column_stack([np.cos(t), np.sin(t)])

    film = write(tmp_path / f"film.{ending}", PLAIN.pictures(circling, np.arange(24) / 12), 12.0, code)
    found = tr.track_film(film, **SEEN)
    (line,) = [one for one in found.calibrated if one.startswith("accuracy")]
    assert f"{said} of a pixel" in line
    parts = {"a quarter": 0.25, "a tenth": 0.1}[said]
    assert found.data.attrs["accuracy"] == pytest.approx(parts * PLAIN.lens[2] / PLAIN.focal, rel=0.5)


# --- containers --------------------------------------------------------------------------------------------------

CODECS = {
    "vp9": ("film.webm", ["libvpx-vp9", "-deadline", "realtime", "-cpu-used", "8", "-crf", "10", "-b:v", "0"]),
    "h264": ("film.mp4", ["libx264", "-preset", "ultrafast", "-crf", "10"]),
    "hevc": ("film.mov", ["libx265", "-preset", "ultrafast", "-crf", "8", "-x265-params", "log-level=none"]),
}


@pytest.fixture(scope="session")
def ffmpeg() -> str:
    """The program; tests that need it are skipped where there is none."""
    found = shutil.which(os.environ.get("TRUNDLE_FFMPEG", "ffmpeg"))
    if found is None:
        told = ROOT / ".venv" / "no-ffmpeg"
        why = (
            told.read_text().strip() if told.is_file() else "install it, or name it in TRUNDLE_FFMPEG (.ci/ffmpeg does)"
        )
        pytest.skip(f"no ffmpeg: {why}")
    return found


@pytest.fixture(scope="module")
def uneven(path: Any) -> tuple[Any, list[Any]]:
    """Times as a telephone has them, one frame dropped, and the pictures."""
    times = np.delete(np.arange(100) / 30 + 0.004 * (np.arange(100) % 3), 40)
    return times, list(Studio(noise=3.0).pictures(path, times))


def encode(ffmpeg: str, pictures: list[Any], words: list[str]) -> None:
    """Write a film; skip the test where this ffmpeg has not the encoder."""
    raw = ["-f", "rawvideo", "-pix_fmt", "bgr24", "-s", "320x240", "-r", "30", "-i", "-"]
    command = [ffmpeg, "-loglevel", "error", *raw, "-pix_fmt", "yuv420p", "-threads", "1", *words]
    content = b"".join(one.tobytes() for one in pictures)
    done = subprocess.run(command, input=content, capture_output=True, check=False)  # noqa: S603  our own words
    if b"Unknown encoder" in done.stderr:
        pytest.skip(f"this ffmpeg does not write {words[words.index('-c:v') + 1]}")
    assert done.returncode == 0, done.stderr.decode()


@pytest.mark.parametrize("codec", CODECS)
def test_every_codec_with_the_times_of_its_frames(
    codec: str, ffmpeg: str, uneven: tuple[Any, list[Any]], tmp_path: Path
) -> None:
    times, pictures = uneven
    name, options = CODECS[codec]
    stamps = "(N+gte(N,40))/30+0.004*mod(N+gte(N,40),3)"
    stamped = ["-vf", f"settb=1/12000,setpts='({stamps})/TB'", "-vsync", "vfr", "-enc_time_base", "1/12000"]
    encode(ffmpeg, pictures, [*stamped, "-c:v", *options, str(tmp_path / name)])
    found = tr.track_film(tmp_path / name, **SEEN)
    np.testing.assert_allclose(found.time, times[found.data["row"].values], atol=0.6e-3)  # WebM counts milliseconds
    comes_back(fitted(found))


@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("film.webm", ["libvpx-vp9", "-deadline", "realtime", "-cpu-used", "8", "-crf", "34", "-b:v", "0"], 0.25),
        ("film.mp4", ["libx264", "-preset", "veryfast", "-crf", "26"], 0.25),
        ("film.mp4", ["libx264", "-preset", "veryfast", "-crf", "12"], 0.1),
        ("film.mp4", ["mpeg4", "-q:v", "3"], 0.25),
        ("film.mp4", ["mpeg4", "-q:v", "1"], 0.1),
        ("film.avi", ["mjpeg", "-q:v", "12"], 0.25),
    ],
)
def test_what_counts_is_how_strongly_a_film_is_compressed(
    name: str, options: list[str], said: float, ffmpeg: str, path: Any, tmp_path: Path
) -> None:
    """A film that a messenger has shrunk is no bad fit, and its errors hold, whatever its codec."""
    pictures = list(Studio(noise=3.0).pictures(path, np.arange(130) / 30))
    encode(ffmpeg, pictures, ["-c:v", *options, str(tmp_path / name)])
    track = tr.track_film(tmp_path / name, **SEEN)
    assert track.data.attrs["accuracy_in_pixels"] == said
    found = fitted(track)
    assert found.answer == "good"
    ratio = found["body.inertia_ratio"]
    assert abs(ratio.value - RATIO) < min(0.01 * RATIO, 3 * ratio.sigma)


def rotated(film: Path, target: Path) -> Path:
    """Return the same film with the flag of a telephone that was held upright: a quarter of a turn."""
    content = bytearray(film.read_bytes())
    track = content.index(b"tkhd")
    matrix = track + 4 + 4 + 36  # behind version and flags, times, layer and volume
    assert content[track + 4] == 0  # the version with short times
    content[matrix : matrix + 36] = struct.pack(">9i", 0, 1 << 16, 0, -1 << 16, 0, 0, 240 << 16, 0, 1 << 30)
    target.write_bytes(content)
    return target


def test_a_film_that_is_flagged_as_turned_comes_turned(path: Any, tmp_path: Path) -> None:
    pictures = list(PLAIN.pictures(path, np.arange(45) / 30))
    plain = write(tmp_path / "lying.mp4", iter([np.ascontiguousarray(np.rot90(one)) for one in pictures]))
    upright = rotated(plain, tmp_path / "upright.mp4")
    film = open_film(upright)
    assert film.rotation() == 90
    assert next(iter(film.frames())).picture.shape == (240, 320, 3)
    found, expected = (tr.track_film(one, **SEEN) for one in (upright, write(tmp_path / "a.mp4", iter(pictures))))
    np.testing.assert_allclose(found["x"], expected["x"], atol=3e-4)
    assert "rotated by 90°" in found.taken


# --- slow motion -------------------------------------------------------------------------------------------------


def test_a_slow_film_is_told_by_the_table_or_by_its_file(table_film: Path, tmp_path: Path) -> None:
    short = {**SEEN, "end": "2 s"}
    with pytest.raises(InvalidValueError, match=r"If it is in slow motion: slow=8"):
        tr.track_film(table_film, table_rate=8 * RATE, **short)
    found = tr.track_film(table_film, slow=8, table_rate=f"{8 * RATE} rad/s", **short)
    assert abs(found.rate[0] / (8 * RATE) - 1) < 1e-3
    assert abs(found.time[-1] - 60 / 240) < 1e-9
    same = tr.track_film(table_film, frame_rate=240, **short)
    np.testing.assert_allclose(same.time, found.time, rtol=1e-12)

    told = tmp_path / "told.webm"  # as a telephone writes it
    note = b"com.android.capture.fps\0\0\0\x1cilst\0\0\0\x01\0\0\0\x14data\0\0\0\x17\0\0\0\0" + struct.pack(">f", 240.0)
    told.write_bytes(table_film.read_bytes() + note)
    with pytest.raises(InvalidValueError, match=r"30 frames a second played, 240 taken.*--frame-rate 240"):
        tr.track_film(told, **short)
    assert abs(tr.track_film(told, frame_rate=30, **short).time[-1] - 60 / 30) < 1e-9
    with pytest.raises(InvalidValueError, match="One follows from the other"):
        tr.track_film(told, slow=2, frame_rate=30, **short)


# --- the camera --------------------------------------------------------------------------------------------------

CORNERS = np.array([(0.2, 0.2), (-0.2, 0.2), (-0.2, -0.2), (0.2, -0.2)])


def marked(studio: Studio) -> Any:
    """Return marks beside the table, as the studio sees them."""
    return np.column_stack([studio.seen(np.column_stack([CORNERS, np.zeros(4)])), CORNERS])


@pytest.mark.parametrize("distortion", [0.0, -0.15])
@pytest.mark.parametrize("lens", [(0.02, -0.30, 0.40), (0.25, 0.1, 0.5)])
def test_four_marks_give_the_camera(lens: tuple[float, float, float], distortion: float) -> None:
    studio = Studio(lens=lens, distortion=distortion)
    found = calibrate(Sightings((320, 240), marks=marked(studio)), None, None, distortion)
    np.testing.assert_allclose(found.camera.place, lens, atol=1e-4)
    assert abs(found.camera.focal - studio.focal) < 0.1
    away = np.random.default_rng(2).uniform(-0.15, 0.15, size=(20, 3)) * (1, 1, 0)
    np.testing.assert_allclose(found.camera.on_plane(studio.seen(away)), away[:, :2], atol=1e-6)


def test_what_the_picture_does_not_show_is_asked_for() -> None:
    above = Studio(lens=(0.0, -1e-6, 0.5))
    with pytest.raises(InvalidValueError, match=r"`height` must be given.*--height"):
        calibrate(Sightings((320, 240), marks=marked(above)), None, None, 0.0)
    given = calibrate(Sightings((320, 240), marks=marked(above)), 0.5, None, 0.0)
    assert abs(given.camera.focal - above.focal) < 0.1
    with pytest.raises(InvalidValueError, match="One follows from the other"):
        calibrate(Sightings((320, 240), marks=marked(above)), 0.5, 380.0, 0.0)
    with pytest.raises(InvalidValueError, match="at least 4"):
        check_marks(marked(above)[:3])
    with pytest.raises(InvalidValueError, match="one line"):
        check_marks([(i, i, i, i) for i in range(4)])

    ring = np.linspace(0, 2 * np.pi, 200)
    rim = PLAIN.seen(np.column_stack([0.14 * np.cos(ring), 0.14 * np.sin(ring), 0 * ring]))
    with pytest.raises(InvalidValueError, match="two cameras would see alike"):
        calibrate(Sightings((320, 240), rim, 0.14), None, PLAIN.focal, 0.0)


def test_a_ball_is_where_its_centre_is() -> None:
    """The middle of the picture of a ball is not the picture of its middle, nor over its contact."""
    studio = Studio(width=640, height=480, focal=500.0, ball=0.06, aim=(0.0, 0.1, 0.0))
    ahead = np.array(studio.aim) - np.array(studio.lens)
    assert ahead[2] < 0
    matrix, _, turn, _ = studio.pinhole()
    rows = cv2.Rodrigues(turn)[0]
    for place in ((0.0, 0.0), (0.15, 0.2), (-0.2, -0.1)):
        outline = studio.seen(studio.outline(*place)).astype(np.float32)
        moments = cv2.moments(outline - outline[0])
        middle = outline[0] + np.array([moments["m10"], moments["m01"]]) / moments["m00"]
        # The camera of the package, told where the studio's stands and looks.
        found = as_ours(studio, rows)
        np.testing.assert_allclose(found.ball_centres(middle[None], studio.ball), [place], atol=2e-6)
        area = found.ball_area(np.array([place]), studio.ball)[0]
        assert abs(area / moments["m00"] - 1) < 1e-3
    assert matrix[0, 0] == found.focal


def as_ours(studio: Studio, rows: Any) -> PinholeCamera:
    turn = cv2.Rodrigues(np.diag([1.0, -1.0, -1.0]) @ rows)[0][:, 0]
    centre = ((studio.width - 1) / 2, (studio.height - 1) / 2)
    return PinholeCamera(studio.focal, centre, turn, np.array(studio.lens), studio.distortion)


# --- what is refused ---------------------------------------------------------------------------------------------

SMALL = Studio(width=160, height=120, focal=190.0, exposures=1, noise=2.0)
SMALL_SEEN = {**SEEN, "focal": 190.0}


@pytest.fixture(scope="module")
def small_film(path: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("small") / "small.mp4", SMALL.pictures(path, np.arange(40) / 30))


def test_films_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match="must exist"):
        tr.track_film(tmp_path / "nothing.mp4", **SEEN)
    for content in (b"", b"no film", b"\0\0\0\x18ftypmp42" + bytes(500)):
        (tmp_path / "broken.mp4").write_bytes(content)
        with pytest.raises(InvalidValueError, match=r"must be a film that can be read; got 'broken.mp4'"):
            tr.track_film(tmp_path / "broken.mp4", **SEEN)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"rim_radius": None}, "must be given, or marks"),
        ({"marks": [(1, 2, 3, 4)]}, "and not both"),
        ({"rim_radius": None, "marks": [(1, 2, "3 cm")]}, "two pixels and two lengths"),
        ({"ball_radius": "-1 mm"}, "must be positive"),
        ({"colour": "purplish"}, "must be the name of a colour"),
        ({"colour": "blue"}, "nothing blue of its size that moves"),
        ({"mark_colour": "blue"}, "a dot that moves with the table"),
        ({"ball_radius": "6 cm"}, "must be of a ball that the film shows"),
        ({"table_rate": 3.49, "mark_colour": None, "height": "0.4 m", "focal": None}, "mark"),
        ({"end": "0.1 s"}, "must have 10 pictures at least"),
        ({"slow": 0}, "must be positive"),
    ],
)
def test_what_is_wrong_is_said(change: dict[str, Any], word: str, small_film: Path) -> None:
    with pytest.raises(InvalidValueError, match=word):
        tr.track_film(small_film, **{**SMALL_SEEN, **change})


def test_no_rim_and_two_balls(path: Any, tmp_path: Path) -> None:
    plain = np.full((120, 160, 3), 90, np.uint8)
    with pytest.raises(InvalidValueError, match="none is found"):
        tr.track_film(write(tmp_path / "grey.mp4", iter([plain] * 20)), **SMALL_SEEN)

    def second(colour: tuple[int, int, int]) -> Any:
        def drawn(i: int, picture: Any) -> Any:
            x, y = SMALL.seen(np.array([[-0.05 - 0.001 * i, -0.05 + 0.0005 * i, 0.02]]))[0]
            cv2.circle(picture, (round(x), round(y)), 8, colour, -1)
            return picture

        return drawn

    for colour, word in (((200, 60, 40), "several things of the ball's size"), (SMALL.ball_colour, "two alike")):
        film = write(tmp_path / "two.mp4", SMALL.pictures(path, np.arange(40) / 30, second(colour)))
        with pytest.raises(InvalidValueError, match=word):
            tr.track_film(film, **SMALL_SEEN)
    film = write(tmp_path / "two.mp4", SMALL.pictures(path, np.arange(40) / 30, second((200, 60, 40))))
    assert len(tr.track_film(film, **SMALL_SEEN, colour="red")) > 35


def test_few_pictures_are_in_memory(small_film: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grounds, "_MEMORY", 16 * 160 * 120 * 3)
    kept, times = sample(open_film(small_film))
    assert len(kept) <= 8 < len(times) == 40
    assert kept[-1].number > 25  # from all of the film


def test_the_command_writes_all_or_nothing(small_film: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str],
                                           monkeypatch: pytest.MonkeyPatch) -> None:  # fmt: skip
    from trundle.cli import run

    asked = ["track", str(small_film), "--ball-radius", "20 mm", "--focal", "190", "-o", str(tmp_path / "out")]
    assert run([*asked, "--rim-radius", "14 cm", "--mark-colour", "#0a500f"]) == 0
    assert {one.name for one in (tmp_path / "out").iterdir()} == {"track.csv", "track.png", "check.mp4"}
    assert "the ball of colour" in capsys.readouterr().out
    assert run([*asked, "--mark", "1,2=3 cm"]) == 2
    assert "`--mark` must be two pixels and two lengths" in capsys.readouterr().err

    def interrupted(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("trundle.tracks.film.api.follow_ball", interrupted)
    asked[-1] = str(tmp_path / "other")
    assert run([*asked, "--rim-radius", "14 cm", "--mark-colour", "#0a500f"]) == 130
    assert not (tmp_path / "other").exists()
