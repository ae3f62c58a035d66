"""A film as its file holds it: pictures one by one, each with its time, and what the file says of how it was taken."""

from __future__ import annotations

import os
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError
from ...extras import need
from ...files import FILM_ENDINGS

Picture = NDArray[np.uint8]
_CAPTURED = b"com.android.capture.fps"
_MOST_HEADER = 2**24  # bytes of a film's index that are looked at
_SAME_RATE = 1.05  # rates nearer than this are one


@dataclass(frozen=True)
class Frame:
    """One picture of a film."""

    number: int  # from 0
    time: float  # of the film, s; NaN where the container has none
    picture: Picture  # (height, width, 3): blue, green, red


@dataclass(frozen=True)
class Film:
    """A film that can be read again and again; one picture of it is in memory at a time."""

    path: Path  # the file
    # `begin`, `end`: which part of it is used, s of the film
    begin: float = 0.0
    end: float = float("inf")
    # called with the number of each picture
    progress: Callable[[int], None] | None = field(default=None, compare=False)

    def frames(self) -> Iterator[Frame]:
        """Yield the pictures from the first; a picture is only good until the next."""
        import cv2

        capture = _opened(self.path)
        try:
            number = 0
            while True:
                good, picture = capture.read()
                if not good:
                    return
                time = float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1e3
                if time > self.end:
                    return
                if self.progress is not None:
                    self.progress(number)
                if time >= self.begin:
                    yield Frame(number, time, _colours(picture))
                number += 1
        finally:
            capture.release()

    def frames_from(self, time: float) -> Iterator[Frame]:
        """Yield the pictures from a time on, s, and perhaps some before it; their numbers are not known."""
        import cv2

        for sought in (time, 0.0):
            capture = _opened(self.path)
            try:
                if sought > 0:
                    capture.set(cv2.CAP_PROP_POS_MSEC, 1e3 * sought)
                good, picture = capture.read()
                at = float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1e3
                if sought > 0 and not (good and at <= time):
                    continue  # sought too far: from the beginning, then
                while good:
                    yield Frame(-1, at, _colours(picture))
                    good, picture = capture.read()
                    at = float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1e3
                return
            finally:
                capture.release()

    def properties(self) -> tuple[tuple[int, int], float, int]:
        """Return what the file says itself: width and height, px; pictures a second; how many there are."""
        import cv2

        capture = _opened(self.path)
        try:
            width, height, rate, count = (
                float(capture.get(one))
                for one in (
                    cv2.CAP_PROP_FRAME_WIDTH,
                    cv2.CAP_PROP_FRAME_HEIGHT,
                    cv2.CAP_PROP_FPS,
                    cv2.CAP_PROP_FRAME_COUNT,
                )
            )
        finally:
            capture.release()
        return (int(width), int(height)), rate, max(int(count), 0)

    def code(self) -> str:
        """Return by which four letters the file names its codec, in small ones."""
        import cv2

        capture = _opened(self.path)
        try:
            number = int(capture.get(cv2.CAP_PROP_FOURCC))
        finally:
            capture.release()
        return number.to_bytes(4, "little", signed=number < 0).decode("latin-1").lower()

    def bits(self, seen: int) -> float:
        """Return how many bits the file has for a pixel of a picture, of as many pictures as it says, or were seen."""
        size, _, count = self.properties()
        return 8.0 * self.path.stat().st_size / (max(count or seen, 1) * size[0] * size[1])

    def rotation(self) -> int:
        """Return by how many degrees the file says that its pictures are to be turned; they come turned."""
        import cv2

        capture = _opened(self.path)
        try:
            return int(capture.get(cv2.CAP_PROP_ORIENTATION_META)) % 360
        finally:
            capture.release()


def open_film(
    path: str | Path, begin: float = 0.0, end: float = float("inf"), progress: Callable[[int], None] | None = None
) -> Film:
    """Return a film, if the file is one.

    Examples
    --------
    >>> try:
    ...     open_film("nowhere.mp4")
    ... except InvalidValueError as error:
    ...     print(error)
    `film` must exist; got 'nowhere.mp4'. Check the name and the folder.
    """
    need("video", "trundle track")
    place = Path(path)
    if not place.is_file():
        raise InvalidValueError("film", "must exist", str(path), "Check the name and the folder.")
    film = Film(place, begin, end, progress)
    _opened(place).release()
    return film


def _opened(path: Path) -> Any:
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")  # what is wrong is said by us
    import cv2

    before = cv2.getLogLevel() if hasattr(cv2, "getLogLevel") else None
    if before is not None:
        cv2.setLogLevel(0)
    try:
        capture = cv2.VideoCapture(str(path.resolve()), cv2.CAP_FFMPEG)  # whole, so that no name is an address
    finally:
        if before is not None:
            cv2.setLogLevel(before)
    if not capture.isOpened() or capture.get(cv2.CAP_PROP_FRAME_WIDTH) < 1:
        capture.release()
        remedy = f"Films end in {', '.join(FILM_ENDINGS[:5])} and so on; one cut off while it was copied has no index."
        raise InvalidValueError("film", "must be a film that can be read", path.name, remedy)
    return capture


def _colours(picture: Any) -> Picture:
    return np.repeat(picture[:, :, None], 3, axis=2) if picture.ndim == 2 else picture[:, :, :3]


def captured_rate(path: Path) -> float | None:
    r"""Return how many frames a second were taken, where the file of a telephone says it; None where it does not.

    Examples
    --------
    >>> note = b"\0\0\0\x1bmdta" + _CAPTURED + b"\0\0\0\x1cilst\0\0\0\x14data\0\0\0\x17\0\0\0\0"
    >>> _ = Path("slow.mp4").write_bytes(note + struct.pack(">f", 240.0))
    >>> captured_rate(Path("slow.mp4"))
    240.0
    """
    with path.open("rb") as stream:
        size = stream.seek(0, os.SEEK_END)
        for start in (0, max(size - _MOST_HEADER, 0)):  # the index stands at the begin or at the end
            stream.seek(start)
            content = stream.read(_MOST_HEADER)
            key = content.find(_CAPTURED)
            value = content.find(b"data\0\0\0\x17", key) if key >= 0 else -1
            if value >= 0 and len(content) >= value + 16:
                rate = float(struct.unpack(">f", content[value + 12 : value + 16])[0])
                return rate if 1 < rate < 1e5 else None
    return None


def slowness(path: Path, film_rate: float, slow: float | None, frame_rate: float | None) -> tuple[float, str]:
    """Return how many times slower than the world a film runs, and how that is known.

    Raises
    ------
    InvalidValueError
        If the film was taken faster than it is played, and nobody says what is meant.
    """
    if slow is not None and frame_rate is not None:
        raise InvalidValueError("slow", "must not be given with a frame rate", slow, "One follows from the other.")
    for name, value in (("slow", slow), ("frame_rate", frame_rate)):
        if value is not None and not 0 < value < float("inf"):
            raise InvalidValueError(name, "must be positive", value, "Slow motion of 240 for 30 a second is 8.")
    if slow is not None:
        return float(slow), f"slowed down {slow:g} times, as you say"
    if frame_rate is not None:
        return frame_rate / film_rate, f"{frame_rate:g} frames a second, as you say"
    told = captured_rate(path)
    if told is not None and not 1 / _SAME_RATE < told / film_rate < _SAME_RATE:
        rule = "must be given of a film in slow motion"
        received = f"{film_rate:.4g} frames a second played, {told:g} taken"
        remedy = f"Say frame_rate={told:g} (`--frame-rate {told:g}`), or {film_rate:.4g} if it does run at true speed."
        raise InvalidValueError("frame_rate", rule, received, remedy)
    return 1.0, f"{film_rate:.4g} frames a second"
