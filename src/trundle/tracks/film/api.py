"""`track_film`: from a film to the track of the ball, in metres and seconds of the world."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ...units import to_si
from . import calibration as calibrating
from .calibration import Calibration, Sightings
from .container import Film, open_film, slowness
from .following import Followed, follow_ball, follow_mark, learn_ball, learn_mark, shown
from .ground import Ground, median, sample
from .pinhole import Array
from .result import FilmTrack
from .rim import find_rim

_ASTRAY = 0.02  # relative difference from the rate that the table has
_ACCURACY = 0.1  # px: what lens, edges and compression leave, and more pictures do not mend
# A film that is strongly compressed moves what it shows by blocks: rendered films of 320 × 240 pixels were off by 0.07
# to 0.37 px at 0.03 to 0.2 bits a pixel in codecs before H.264, and so were those after it at 0.01 to 0.16.
_COARSE_ACCURACY = 0.25  # px
_SPARING = ("h264", "x264", "avc1", "avc3", "hevc", "x265", "hvc1", "hev1", "vp80", "vp90", "vp09", "av01")
_LEAST_BITS = {True: 0.2, False: 0.3}  # of a pixel of a picture, in a codec that is sparing, and in another
_EVEN = 1.5  # px, of a mark on a table that turns evenly
_WHOLE = 0.03  # how near to a whole number a ratio of rates is one
_PASSES = 3  # how often a film is read


def track_film(
    film: str | Path,
    *,
    ball_radius: Any,
    rim_radius: Any = None,
    marks: Sequence[Sequence[Any]] | None = None,
    height: Any = None,
    focal: float | None = None,
    distortion: float = 0.0,
    colour: str | None = None,
    mark_colour: str | None = None,
    table_rate: Any = None,
    slow: float | None = None,
    frame_rate: float | None = None,
    readout: Any = 0.0,
    begin: Any = 0.0,
    end: Any = None,
    progress: Callable[[float], None] | None = None,
) -> FilmTrack:
    """Follow a ball on a table through a film, and return its track, which `trundle.fit` takes.

    The rim of the table, or four marks at known places, tell where the camera stood; a coloured dot on the table tells
    how it turns. The ball is found by its colour or by what differs from the table, to a tenth of a pixel. Its places
    are those of its centre: perspective, lens and the height of the ball over the table are undone. The film is read
    three times at most, a picture at a time.

    Parameters
    ----------
    film : str or Path
        Any that FFmpeg reads: MP4, MOV, AVI, WebM and others. Times are those of its frames, also at a variable rate.
    ball_radius : float, quantity or str
        m.
    rim_radius : float, quantity or str, optional
        Of the table whose whole rim is in the picture, m.
    marks : sequence of (px, px, m, m), optional
        Instead of a rim: at least four points at the table's height, where they are seen (to the right, down) and are.
    height : float, quantity or str, optional
        Of the lens over the table, m; needed where the camera looks from almost straight above.
    focal : float, optional
        Focal length in pixels, where it is known, instead of the height.
    distortion : float
        κ of the lens: a direction (u, v) is seen at (u, v) (1 + κ (u² + v²)).
    colour : str, optional
        Of the ball, such as "red" or "#ff8800"; else it is what moves and has its size.
    mark_colour : str, optional
        Of a dot on the table, which shows how that turns.
    table_rate : float, quantity or str, optional
        How fast the table turns, if you know it, rad/s: a film that runs at another speed is refused.
    slow : float, optional
        How many times slower than the world the film runs.
    frame_rate : float, optional
        Frames a second that were taken, of a film in slow motion; instead of `slow`.
    readout : float, quantity or str
        Time that the sensor takes from the first row to the last, s.
    begin, end : float, quantity or str
        Which part of the film is used, s of the film.
    progress : callable, optional
        Called with the fraction of the work that is done.

    Returns
    -------
    FilmTrack
        A track with columns x, y and, of a table with a dot, mark_x, mark_y; the frames that were left out, and why;
        the calibration. It writes itself as a table, and the film with the track drawn in.

    Raises
    ------
    InvalidValueError
        If there is no such film, the rim, the marks or the ball are not found or are ambiguous, or something has to be
        said: the message tells what.
    MissingExtraError
        Without the extra `video`.

    Examples
    --------
    On the page "Film your turntable". A file that is no film is refused:

    >>> import trundle as tr
    >>> _ = Path("notes.mp4").write_text("no film")
    >>> try:
    ...     tr.track_film("notes.mp4", ball_radius="20 mm", rim_radius="15 cm")
    ... except (tr.InvalidValueError, tr.MissingExtraError) as error:
    ...     print(type(error).__name__ in ("InvalidValueError", "MissingExtraError"))
    True
    """
    lengths = {"ball_radius": ball_radius, "rim_radius": rim_radius, "height": height}
    length = {name: None if one is None else float(to_si(one, "length", name)) for name, one in lengths.items()}
    for name, number in length.items():
        if number is not None and not 0 < number < np.inf:
            raise InvalidValueError(name, "must be positive", number, "Give it as a length, such as '20 mm'.")
    if (rim_radius is None) == (marks is None):
        given = "neither" if marks is None else "both"
        remedy = "Measure the rim's radius: rim_radius='15 cm' (`--rim-radius '15 cm'`)."
        raise InvalidValueError("rim_radius", "must be given, or marks at known places, and not both", given, remedy)
    if focal is not None and not 0 < focal < np.inf:
        raise InvalidValueError("focal", "must be positive", focal, "It is counted in pixels.")
    known = None if marks is None else calibrating.check_marks([_mark(one, i) for i, one in enumerate(marks)])
    times = {name: float(to_si(value, "time", name)) for name, value in (("begin", begin), ("readout", readout))}
    last = float("inf") if end is None else float(to_si(end, "time", "end"))
    opened = open_film(film, times["begin"], last)
    work = _Work(opened, progress)

    samples, stamps = sample(work.film())
    film_rate = _rate(stamps, opened.path.name)
    factor, speed = slowness(opened.path, film_rate, slow, frame_rate)

    def clock(time: float) -> float:
        return time / factor

    still = median(frame.picture for frame in samples)
    size = (still.shape[1], still.shape[0])
    rim = None if rim_radius is None else find_rim(still)
    mark = None
    if mark_colour is not None:
        learned, area = learn_mark(samples, still, mark_colour)
        mark = follow_mark(work.film(), clock, still, learned, area)
        mark = _shifted(mark, times["readout"], size)
    seen = Sightings(size, rim, length["rim_radius"] or 0.0, known)
    if mark is not None:
        area = float(np.median(mark.areas))
        seen = replace(seen, times=np.array(mark.times), mark=mark.pixels, mark_area=area)
    found = calibrating.calibrate(seen, length["height"], focal, distortion)
    _check_turning(found, table_rate, speed)
    camera, radius = found.camera, float(length["ball_radius"] or 0.0)
    turns = length["rim_radius"] or (found.turning.outermost if found.turning else 0.0)
    taken = tuple((clock(frame.time), frame.picture) for frame in samples)
    ground = Ground(still, camera, found.turning, float(turns), taken)
    own = learn_ball([(clock(frame.time), frame) for frame in samples], ground, camera, radius, colour)
    ball = _shifted(follow_ball(work.film(), clock, ground, camera, radius, own), times["readout"], size)
    work.done()
    said = [speed, f"rotated by {opened.rotation()}°"] if opened.rotation() else [speed]
    return _track(
        opened,
        ball,
        mark,
        found,
        radius,
        length["rim_radius"] or 0.0,
        (film_rate, factor),
        [*said, f"the ball of colour {shown(own)}"],
    )


def _rate(stamps: Array, name: str) -> float:
    """Return the pictures a second, gaps left out; the mean, since some containers round their times."""
    steps = np.diff(stamps)
    usual = float(np.median(steps))
    if not 0 < usual < np.inf:
        raise InvalidValueError("film", "must say when its pictures were taken", name, "Convert it to MP4.")
    return 1.0 / float(np.mean(steps[np.abs(steps / usual - 1) < 0.5]))


def _mark(one: Sequence[Any], i: int) -> list[float]:
    """Return a mark at a known place in pixels and metres."""
    try:
        x, y, *place = one
        return [float(x), float(y), *(float(to_si(part, "length", f"marks[{i}]")) for part in place)]
    except (TypeError, ValueError) as error:
        if isinstance(error, InvalidValueError):
            raise
        rule = "must be two pixels and two lengths"
        raise InvalidValueError(f"marks[{i}]", rule, one, "Write (412, 300, '10 cm', 0).") from None


class _Work:
    """A film that tells how far its readings are."""

    def __init__(self, film: Film, progress: Callable[[float], None] | None) -> None:
        self._film, self._progress, self._pass, self._count = film, progress, 0, 1

    def film(self) -> Film:
        """Return the film for the next time that it is read."""
        self._pass += 1
        if self._progress is None:
            return self._film
        if self._pass == 1:
            self._count = max(self._film.properties()[2], 1)
        before, tell = self._pass - 1, self._progress

        def told(number: int) -> None:
            tell(min((before + min(number / self._count, 1.0)) / _PASSES, 1.0))

        return Film(self._film.path, self._film.begin, self._film.end, told)

    def done(self) -> None:
        """Tell that all is done."""
        if self._progress is not None:
            self._progress(1.0)


def _shifted(found: Followed, readout: float, size: tuple[int, int]) -> Followed:
    """Return what was followed with the times of the rows in which it was seen."""
    if readout:
        found.times = list(np.array(found.times) + readout * (found.pixels[:, 1] / size[1] - 0.5))
    return found


def _check_turning(found: Calibration, table_rate: Any, speed: str) -> None:
    """Refuse a mark that does not turn evenly, and a film that does not run as the table does."""
    turning = found.turning
    if turning is None:
        if table_rate is not None:
            remedy = "Stick a coloured dot on the table and say its colour: mark_colour='green'."
            raise InvalidValueError("table_rate", "must come with a mark that shows it", table_rate, remedy)
        return
    if turning.misfit > _EVEN:
        remedy = "Begin when the table is at speed (begin='2 s'), and check the colour of the mark and the calibration."
        received = f"{turning.misfit:.1f} px off, root mean square"
        raise InvalidValueError("mark_colour", "must be of a mark that turns evenly", received, remedy)
    if table_rate is None:
        return
    rate = abs(float(to_si(table_rate, "angular velocity", "table_rate")))
    ratio = rate / abs(turning.rate)
    if abs(ratio - 1) > _ASTRAY:
        whole = round(ratio)
        times = f"{whole}" if whole > 1 and abs(ratio / whole - 1) < _WHOLE else f"{ratio:.4g}"
        received = f"{abs(turning.rate):.5g} rad/s in the film, {rate:.5g} rad/s on the table ({speed})"
        remedy = f"If it is in slow motion: slow={times} (`--slow {times}`); else measure the table again."
        raise InvalidValueError("table_rate", "must be what the mark shows", received, remedy)


def _pixel(found: Calibration, places: Array) -> float:
    """Return how wide the part of the table is that a pixel shows, m, where the ball is."""
    middle = np.array([*np.median(places, axis=0), 0.0])
    return float(np.linalg.norm(middle - found.camera.place) / found.camera.focal)


def _track(
    film: Film,
    ball: Followed,
    mark: Followed | None,
    found: Calibration,
    radius: float,
    rim: float,
    rates: tuple[float, float],
    said: Sequence[str],
) -> FilmTrack:
    """Return the track of what was followed."""
    import xarray

    places = found.camera.ball_centres(ball.pixels, radius)
    coarse = film.bits(ball.frames) < _LEAST_BITS[film.code() in _SPARING]
    off = _COARSE_ACCURACY if coarse else _ACCURACY
    columns = {"x": places[:, 0], "y": places[:, 1]}
    if mark is not None:
        number = dict(zip(mark.times, mark.numbers, strict=True))
        there = dict(zip((number[time] for time in found.times), found.camera.on_plane(found.mark), strict=True))
        seen = np.array([there.get(number, (np.nan, np.nan)) for number in ball.numbers])
        columns |= {"mark_x": seen[:, 0], "mark_y": seen[:, 1]}
    data = xarray.Dataset(
        {name: ("time", values, {"units": "m", "heading": name}) for name, values in columns.items()},
        coords={"time": ("time", np.array(ball.times), {"units": "s", "heading": "t"}),
                "row": ("time", np.array(ball.numbers, dtype=int))},
        attrs={"frame": "support", "axes": "space", "film_rate": rates[0],
               "accuracy": off * _pixel(found, places), "accuracy_in_pixels": off},
    )  # fmt: skip
    digest = hashlib.sha256()
    with film.path.open("rb") as stream:
        while part := stream.read(2**20):
            digest.update(part)
    provenance = {"file": film.path.name, "bytes": film.path.stat().st_size, "sha256": digest.hexdigest()}
    return FilmTrack(
        data,
        source=film.path.name,
        format="a film",
        clauses=(f"{len(ball.numbers)} frames of {ball.frames}", *said),
        rejected=ball.as_rejected(),
        counted="frame",
        provenance=provenance,
        calibration=found,
        pixels=ball.pixels,
        ball_radius=radius,
        rim_radius=rim,
        slow=rates[1],
        film=film,
    )
