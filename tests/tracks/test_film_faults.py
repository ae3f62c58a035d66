"""What a film's reader may get wrong by a sign, a half pixel or a frame: each is seen in a film or in its geometry."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.errors import InvalidValueError

cv2 = pytest.importorskip("cv2", reason="the extra `video` is not installed")

from tests.tracks.studio import Studio, write  # noqa: E402  it draws with OpenCV
from tests.tracks.test_film import PLAIN, RATE, RATIO, SMALL, SMALL_SEEN, TABLE, as_ours, fitted  # noqa: E402

from trundle.tracks.film import container  # noqa: E402
from trundle.tracks.film.calibration import Calibration, Sightings, calibrate  # noqa: E402

PIXEL = 0.5 / PLAIN.focal  # m, about


@pytest.fixture(scope="module")
def path() -> Any:
    """The motion, as trundle computes it, at any time."""
    data = tr.Scenario.read(TABLE).run().data
    time, places = np.asarray(data.time), np.asarray(data.position)
    return lambda t: np.column_stack([np.interp(t, time, places[:, i]) for i in (0, 1)])


# --- four marks --------------------------------------------------------------------------------------------------

CORNERS = np.array([(0.16, 0.15), (-0.16, 0.15), (-0.16, -0.15), (0.16, -0.15)])
AXIS = np.array([0.012, -0.007])  # of the table, as whoever measured the marks counts


@pytest.fixture(scope="module")
def by_marks(path: Any, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """A film through a lens that bends lines, with four marks counted from beside the axis; the dot passes the ball."""
    studio = Studio(distortion=-0.1, noise=3.0)
    film = write(tmp_path_factory.mktemp("marks") / "m.mp4", studio.pictures(path, np.arange(130) / 30))
    shown = studio.seen(np.column_stack([CORNERS, np.zeros(4)]))
    marks = [(*pixel, *place) for pixel, place in zip(shown, CORNERS + AXIS, strict=True)]
    return tr.track_film(film, ball_radius="20 mm", marks=marks, mark_colour="#0a500f", distortion=-0.1)


def test_four_marks_give_the_track_of_a_rendered_film(by_marks: Any, path: Any) -> None:
    """Its axes are those of the marks, its origin is on the axis: no turn, no scale and no shift is left to choose."""
    ball = by_marks["x"] + 1j * by_marks["y"]
    mark = by_marks["mark_x"] + 1j * by_marks["mark_y"]
    off = {"ball": ball - path(by_marks.time) @ [1, 1j],
           "mark": mark - PLAIN.mark * np.exp(1j * RATE * by_marks.time)}  # fmt: skip
    for name, each in off.items():
        assert abs(np.nanmean(each)) < 0.15 * PIXEL, name
        assert np.nanstd(each) < 0.3 * PIXEL, name
    assert len(by_marks) > 125  # also where the ball is beside the dot
    np.testing.assert_allclose(by_marks.calibration.camera.place, PLAIN.lens, atol=2e-3)


def lasting(track: Any, true: dict[str, Any]) -> Any:
    """Return by what smooth fields of second degree all places that a film showed are off, (12,), m at the edge."""
    from itertools import product

    shown = np.concatenate([np.column_stack([track[x], track[y]]) for x, y in (("x", "y"), ("mark_x", "mark_y"))])
    right = np.concatenate([np.column_stack([true[x], true[y]]) for x, y in (("x", "y"), ("mark_x", "mark_y"))])
    seen = np.isfinite(shown).all(axis=1)
    u = shown[seen] - shown[seen].mean(axis=0)
    u /= np.linalg.norm(u, axis=1).max()
    powers = [(i, j) for i, j in product(range(3), repeat=2) if i + j < 3]
    terms = np.column_stack([u[:, 0] ** i * u[:, 1] ** j for i, j in powers]) / np.sqrt(len(powers))
    return np.linalg.lstsq(terms, (shown - right)[seen], rcond=None)[0].ravel()


def test_a_compressed_film_is_as_accurate_as_it_says(by_marks: Any, path: Any) -> None:
    """MPEG-4 leaves errors that last for many frames: those of this film are a quarter of a pixel, and not a tenth."""
    from scipy.stats import chi2

    turned = RATE * by_marks.time
    true = dict(zip(("x", "y"), path(by_marks.time).T, strict=True))
    true |= {"mark_x": PLAIN.mark * np.cos(turned), "mark_y": PLAIN.mark * np.sin(turned)}
    off, said = lasting(by_marks, true), by_marks.data.attrs["accuracy"]
    assert said == pytest.approx(0.25 * PIXEL, rel=0.2)
    assert 1e-3 < chi2.sf(((off / said) ** 2).sum(), off.size) < 1 - 1e-3
    assert chi2.sf(((off / (0.4 * said)) ** 2).sum(), off.size) < 1e-6


def test_a_compressed_film_makes_a_good_fit_with_errors_that_hold(by_marks: Any, tmp_path: Path) -> None:
    again = tr.read_track(by_marks.save(tmp_path / "track.csv"))
    assert again.data.attrs["accuracy"] == pytest.approx(by_marks.data.attrs["accuracy"], rel=0.05)
    for track in (by_marks, again):
        found = fitted(track)
        assert found.answer == "good"
        ratio = found["body.inertia_ratio"]
        assert abs(ratio.value - RATIO) < min(0.01 * RATIO, 2 * ratio.sigma)
        assert ratio.sigma < 1e-3


# --- the axis, the rim, the rate ---------------------------------------------------------------------------------

TIMES = np.arange(90) / 30
OFF_AXIS = np.array([0.004, -0.003])  # of the rim's middle


def sighted(seed: int, stray: int | None = None) -> Calibration:
    """Return the calibration by a plate that lies askew, and a dot, each to a tenth of a pixel."""
    draw = np.random.default_rng(seed)
    ring, turn = np.linspace(0, 2 * np.pi, 200), RATE * TIMES + 0.7
    rim = PLAIN.seen(np.column_stack([0.14 * np.cos(ring) + OFF_AXIS[0], 0.14 * np.sin(ring) + OFF_AXIS[1], 0 * ring]))
    mark = PLAIN.seen(0.115 * np.column_stack([np.cos(turn), np.sin(turn), 0 * turn]))
    mark += draw.normal(0, 0.1, mark.shape)
    if stray is not None:
        mark[stray] += (6.0, -4.0)
    seen = Sightings((320, 240), rim + draw.normal(0, 0.1, rim.shape), 0.14, times=TIMES, mark=mark, mark_area=1e-3)
    return calibrate(seen, None, PLAIN.focal, 0.0)


def test_the_rim_of_a_plate_that_lies_askew_is_off_the_axis() -> None:
    found = sighted(0)
    place, lens = found.camera.place, np.array(PLAIN.lens)
    assert abs(np.hypot(*place[:2]) - np.hypot(*lens[:2])) < 1e-3
    turned = (place[0] + 1j * place[1]) / (lens[0] + 1j * lens[1])  # where x lies is free without marks
    there = (OFF_AXIS @ [1, 1j]) * turned / abs(turned)
    assert abs(complex(*found.rim_centre) - there) < 3e-4


def test_the_error_of_the_rate_is_as_large_as_it_says() -> None:
    pulls = []
    for seed in range(16):
        turning = sighted(seed).turning
        assert turning is not None
        pulls.append((turning.rate - RATE) / turning.rate_sigma)
    assert 0.55 < np.sqrt(np.mean(np.square(pulls))) < 1.6


def test_a_dot_that_is_somewhere_else_once_is_left_out() -> None:
    found = sighted(3, stray=85)
    assert len(found.times) == len(TIMES) - 1
    assert TIMES[85] not in found.times
    assert found.turning is not None
    assert found.turning.misfit < 0.2


def test_the_middle_of_a_dot_is_not_the_middle_of_its_picture() -> None:
    from trundle.tracks.film.calibration import _middles

    camera = as_ours(PLAIN, cv2.Rodrigues(PLAIN.pinhole()[2])[0])
    places = np.array([[0.1, 0.0, 0.0], [0.0, -0.1, 0.0], [-0.07, 0.07, 0.0]])
    ring = 2 * np.pi * np.arange(720)[:, None] / 720
    pictures, areas = [], []
    for place in places:
        outline = PLAIN.seen(place + 0.03 * np.hstack([np.cos(ring), np.sin(ring), 0 * ring])).astype(np.float32)
        moments = cv2.moments(outline - outline[0])
        pictures.append(outline[0] + np.array([moments["m10"], moments["m01"]]) / moments["m00"])
        areas.append(moments["m00"])
    apart = np.array(pictures) - PLAIN.seen(places)
    assert np.linalg.norm(apart, axis=1).max() > 0.2
    left = _middles(camera, np.array(pictures), float(np.median(areas))) - PLAIN.seen(places)
    assert np.linalg.norm(left, axis=1).max() < 0.1 * np.linalg.norm(apart, axis=1).max()


# --- which frame, and when ---------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def small_film(path: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("small") / "small.mp4", SMALL.pictures(path, np.arange(40) / 30))


def test_a_rolling_shutter_and_a_part_of_a_film(small_film: Path) -> None:
    plain, rolled = (tr.track_film(small_film, **SMALL_SEEN, readout=one) for one in (0.0, "20 ms"))
    np.testing.assert_allclose(rolled.time - plain.time, 0.02 * (rolled.pixels[:, 1] / 120 - 0.5), atol=1e-12)
    part = tr.track_film(small_film, **SMALL_SEEN, begin="0.5 s", end="1 s")
    assert part.data["row"].values[[0, -1]].tolist() == [15, 30]
    np.testing.assert_allclose(part.time[[0, -1]], [0.5, 1.0], atol=1e-9)


def test_the_check_film_has_rim_dot_and_ball_where_they_are(path: Any, tmp_path: Path) -> None:
    times = np.arange(40) / 30
    pictures = list(SMALL.pictures(path, times))
    pictures[20] = pictures[19]
    track = tr.track_film(write(tmp_path / "a.avi", iter(pictures), code="MJPG"), **SMALL_SEEN)
    drawn = [one.picture.astype(int) for one in container.open_film(track.save_check(tmp_path / "c.avi")).frames()]
    hues = {"ball": (2, 1, 0), "mark": (0, 2, 1), "rim": (0, 1, 2)}  # the two strong colours of a line, and the weak

    def near(i: int, place: Any, what: str) -> bool:
        x, y = np.round(place).astype(int)
        part = drawn[i][y - 2 : y + 3, x - 2 : x + 3]
        one, other, weak = hues[what]
        return bool((np.minimum(part[..., one], part[..., other]) - part[..., weak]).max() > 60)

    turned = RATE * times
    for i in (10, 30):
        shown = SMALL.seen(0.115 * np.array([[np.cos(turned[i]), np.sin(turned[i]), 0.0]]))[0]
        at = int(np.flatnonzero(track.data["row"].values == i)[0])
        assert near(i, shown, "mark")
        assert near(i, track.pixels[at], "ball")
        for place in ([0.0, 0.14, 0.0], [0.14, 0.0, 0.0], [-0.14, 0.0, 0.0]):
            assert near(i, SMALL.seen(np.array([place]))[0], "rim")
    at = int(np.flatnonzero(track.data["row"].values == 19)[0])
    assert near(19, track.pixels[at], "ball")
    assert not near(20, track.pixels[at], "ball")  # left out: it repeats the one before


def test_the_note_of_a_telephone_is_found_at_the_end_of_a_large_film(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(container, "_MOST_HEADER", 256)
    note = b"com.android.capture.fps\0\0\0\x14data\0\0\0\x17\0\0\0\0" + struct.pack(">f", 120.0)
    (tmp_path / "large.mp4").write_bytes(bytes(4096) + note)
    assert container.captured_rate(tmp_path / "large.mp4") == 120.0


# --- what is left out, and what is refused -----------------------------------------------------------------------


def test_a_ball_that_jumps_is_half_hidden_or_leaves_is_left_out(tmp_path: Path) -> None:
    def path(t: Any) -> Any:
        aside = np.where(np.round(30 * np.asarray(t)) == 10, 0.012, 0.0)
        return np.column_stack([-0.03 + 0.16 * np.asarray(t), 0.01 + aside])

    def hand(i: int, picture: Any) -> Any:
        if i in (22, 23):
            x, y = SMALL.seen(np.array([[*path(np.array([i / 30]))[0], 0.02]]))[0]
            cv2.rectangle(picture, (round(x) - 20, round(y) + 2), (round(x) + 20, round(y) + 14), (140, 170, 215), -1)
        return picture

    film = write(tmp_path / "t.avi", SMALL.pictures(path, np.arange(60) / 30, hand), code="MJPG")
    reasons = {one.row: one.reason for one in tr.track_film(film, **SMALL_SEEN).rejected}
    assert reasons[10] == "it is off the path of its neighbours"
    assert {reasons[22], reasons[23]} <= {"the ball is hidden in part, or touched", "no ball",
                                          "something covers or touches the ball"}  # fmt: skip
    assert "the ball is hidden in part, or touched" in reasons.values()


def test_a_ball_at_the_edge_of_the_picture_is_left_out(tmp_path: Path) -> None:
    near = Studio(**{**SMALL.__dict__, "rim": 0.1, "mark": 0.08, "ball": 0.02})
    film = write(
        tmp_path / "out.avi",
        near.pictures(lambda t: np.column_stack([0.02 + 0.14 * t, 0 * t]), np.arange(56) / 30),
        code="MJPG",
    )
    found = tr.track_film(film, **{**SMALL_SEEN, "rim_radius": "10 cm"})
    assert "the ball is cut by the edge of the picture" in {one.reason for one in found.rejected}
    assert found.pixels[:, 0].max() < 152  # its radius from the edge


def test_dots_alike_and_a_table_that_speeds_up_are_refused(path: Any, tmp_path: Path) -> None:
    def other(i: int, picture: Any) -> Any:
        angle = RATE * i / 30 + 2.0
        x, y = SMALL.seen(0.115 * np.array([[np.cos(angle), np.sin(angle), 0.0]]))[0]
        cv2.circle(picture, (round(x), round(y)), 3, SMALL.mark_colour, -1)
        return picture

    twice = write(tmp_path / "twice.avi", SMALL.pictures(path, np.arange(40) / 30, other), code="MJPG")
    with pytest.raises(InvalidValueError, match="of which there are several"):
        tr.track_film(twice, **SMALL_SEEN)
    times = np.arange(40) / 30
    faster = write(tmp_path / "faster.avi", SMALL.pictures(path, times * (1 + 0.4 * times)), code="MJPG")
    with pytest.raises(InvalidValueError, match="must be of a mark that turns evenly"):
        tr.track_film(faster, **SMALL_SEEN)
