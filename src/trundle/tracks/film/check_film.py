"""The film to check a track by: smaller, with what was measured drawn into it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InvalidValueError, UnknownNameError
from ...files import written_whole

if TYPE_CHECKING:
    from .result import FilmTrack

CODES = {".mp4": "mp4v", ".avi": "MJPG", ".webm": "VP80"}
_WIDEST = 960  # px
_TRAIL = 60  # frames
_RING = 2 * np.pi * np.arange(120) / 120
_FINE = 3  # bits behind the point of OpenCV's coordinates
_BALL, _RIM, _MARK, _WORD = (0, 255, 255), (255, 200, 0), (255, 0, 255), (60, 60, 255)


def write_check(track: FilmTrack, target: Path) -> Path:
    """Write the film with rim, mark and ball drawn where they were measured, and the reason where they were not."""
    import cv2

    ending = target.suffix.lower()
    if ending not in CODES:
        raise UnknownNameError("ending of a film to check by", target.suffix, CODES)
    reasons = {one.row: one.reason for one in track.rejected}
    at = {int(number): i for i, number in enumerate(track.data["row"].values)}
    lasting = track.data.attrs["film_rate"]
    with written_whole(target) as temporary:
        writer: Any = None
        for frame in track.film.frames():
            height, width = frame.picture.shape[:2]
            share = min(1.0, _WIDEST / max(width, height))
            size = (int(width * share) // 2 * 2, int(height * share) // 2 * 2)
            picture = cv2.resize(frame.picture, size, interpolation=cv2.INTER_AREA)
            if writer is None:
                writer = cv2.VideoWriter(
                    str(temporary), cv2.CAP_FFMPEG, cv2.VideoWriter_fourcc(*CODES[ending]), lasting, size
                )
                if not writer.isOpened():
                    raise InvalidValueError("check film", "must be one that OpenCV can write", ending, "Try .avi.")
            _draw(picture, track, at.get(frame.number), share)
            if frame.number in reasons:
                cv2.putText(
                    picture,
                    f"{frame.number}: {reasons[frame.number]}",
                    (6, size[1] - 8),
                    cv2.FONT_HERSHEY_SIMPLEX,
                    0.4,
                    _WORD,
                    1,
                    cv2.LINE_AA,
                )
            writer.write(picture)
        if writer is not None:
            writer.release()
    return target


def _draw(picture: Any, track: FilmTrack, i: int | None, share: float) -> None:
    camera, turning = track.calibration.camera, track.calibration.turning
    if track.rim_radius:
        middle = track.calibration.rim_centre
        ring = np.column_stack(
            [middle[0] + track.rim_radius * np.cos(_RING), middle[1] + track.rim_radius * np.sin(_RING), 0 * _RING]
        )
        _line(picture, camera.project(ring) * share, _RIM, closed=True)
    if i is None:
        return
    if turning is not None:
        angle = turning.angle(track.time[i])
        _cross(
            picture, camera.project(turning.radius * np.array([[np.cos(angle), np.sin(angle), 0.0]]))[0] * share, _MARK
        )
    _line(picture, track.pixels[max(i - _TRAIL, 0) : i + 1] * share, _BALL, closed=False)
    _cross(picture, track.pixels[i] * share, _BALL)


def _line(picture: Any, points: Any, colour: Any, *, closed: bool) -> None:
    import cv2

    fine = np.round(points * 2**_FINE).astype(np.int32)
    cv2.polylines(picture, [fine], closed, colour, 1, cv2.LINE_AA, _FINE)


def _cross(picture: Any, at: Any, colour: Any) -> None:
    for along in ((5.0, 0.0), (0.0, 5.0)):
        _line(picture, np.array([at - along, at + along]), colour, closed=False)
