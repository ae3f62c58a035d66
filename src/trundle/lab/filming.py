"""What the lab's page makes of a film: its first picture, the ball followed through it, pictures to play."""

from __future__ import annotations

import base64
import math
import re
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError
from ..files import FILM_ENDINGS
from .answers import answering, as_json
from .cache import Answer
from .errors import refused
from .films import told
from .measuring import track_told

if TYPE_CHECKING:
    from ..solve.samples import Array
    from ..tracks.film.container import Picture
    from ..tracks.film.pinhole import PinholeCamera
    from ..tracks.film.result import FilmTrack

JPEG = "image/jpeg"
_WIDEST = 960  # px, of a picture on the page
_MOST_PIXELS = 4096 * 2304  # of a film
_PLAYED = 300, 480  # pictures of a film that the browser cannot play, and their width, px
_AT_ONCE = 2.0, 2**21  # s of work and bytes, for one request for such pictures
_RIM = 60  # points of the rim that are shown
_OUTLINE = 20  # points of the ball's outline
_MASS = 0.1  # kg, of a suggested ball: its motion does not depend on it
_TELLING = 0.2  # s between two notes of the progress
# What a film begins with: nothing else is opened, so that no playlist can name another file.
_BEGINS = (b"RIFF", b"\x1a\x45\xdf\xa3", b"\x00\x00\x01\xba", b"\x00\x00\x01\xb3", b"\x30\x26\xb2\x75", b"OggS")
_BOXES = (b"ftyp", b"moov", b"mdat", b"wide", b"free", b"skip")
_FOR_COMMANDS = re.compile(r" \(`--[^`]*`\)")


def ending_of(name: str) -> str:
    """Return the ending of a film's name.

    Examples
    --------
    >>> ending_of("My film.MOV")
    '.mov'
    """
    ending = Path(name.replace("\\", "/")).suffix.lower()
    if ending not in FILM_ENDINGS:
        raise refused(422, f"A film ends in {', '.join(FILM_ENDINGS)}; this is {name!r}.", "file")
    return ending


@answering
def looked_at(token: str, path: str) -> Answer:
    """Return what a film says of itself, and where its first picture shows a rim."""
    from ..tracks.film.container import captured_rate, open_film

    place = Path(path)
    _check_film(place)
    film = open_film(place)
    size, rate, count = film.properties()
    if size[0] * size[1] > _MOST_PIXELS:
        shown = f"{size[0]} × {size[1]}"
        raise refused(
            422, f"The lab takes films of up to 4096 × 2304 pixels; this has {shown}. Export it smaller.", "file"
        )
    first = _picture(place, 0.0)
    return as_json(
        {
            "film": token,
            "width": first.shape[1],
            "height": first.shape[0],
            "rate": round(rate, 4),
            "length": round(count / rate, 3) if rate > 0 else 0.0,
            "taken": captured_rate(place),
            "rim": _rim(first),
        }
    )


def _check_film(path: Path) -> None:
    with path.open("rb") as stream:
        head = stream.read(200)
    packets = head[::188] == b"GG" or head[4::192] == b"GG"  # of a transport stream
    if not (head.startswith(_BEGINS) or head[4:8] in _BOXES or packets):
        given = "an empty file" if not head else "another file"
        remedy = "Films are MP4, MOV, AVI, WebM and others; one cut off while it was copied cannot be read."
        raise InvalidValueError("file", "must be a film", given, remedy)


def _rim(picture: Picture) -> list[list[float]] | None:
    from ..tracks.film.rim import find_rim

    try:
        edges = find_rim(picture)
    except InvalidValueError:
        return None
    return _rounded(edges[:: max(1, len(edges) // _RIM)])


def _rounded(places: Array) -> list[list[float]]:
    return [[round(float(part), 1) for part in place] for place in places]


def _picture(path: Path, at: float) -> Picture:
    """Return the picture at a time of the film, s, or the last before it."""
    from ..tracks.film.container import Film

    last = None
    for frame in Film(path).frames_from(at):
        last = frame.picture
        if frame.time >= at or not math.isfinite(frame.time):
            break
    if last is None:
        raise InvalidValueError("file", "must be a film with pictures", "none that can be read", "Export it anew.")
    return last


@answering
def still(token: str, path: str, at: float) -> Answer:  # noqa: ARG001
    """Return the picture at a time of a film, as JPEG."""
    return Answer(_jpeg(_picture(Path(path), at), _WIDEST), JPEG)


def _jpeg(picture: Picture, widest: int) -> bytes:
    import cv2

    height, width = picture.shape[:2]
    share = min(1.0, widest / max(width, height))
    if share < 1:
        size = max(round(width * share), 1), max(round(height * share), 1)
        picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    return bytes(cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 80])[1])


@answering
def reel(token: str, path: str, begin: float, length: float) -> Answer:  # noqa: ARG001
    """Return pictures of a film from some time on, for a browser that cannot play it: as many as come soon."""
    from ..tracks.film.container import Film

    seconds, most = _AT_ONCE
    apart, until = length / _PLAYED[0], time.monotonic() + seconds
    times: list[float] = []
    pictures: list[str] = []
    following: float | None = None
    for frame in Film(Path(path)).frames_from(begin):
        if frame.time < (times[-1] + apart if times else begin) - 1e-6:
            continue
        if times and (time.monotonic() > until or sum(map(len, pictures)) > most):
            following = frame.time
            break
        times.append(round(frame.time, 4))
        pictures.append(f"data:{JPEG};base64,{base64.b64encode(_jpeg(frame.picture, _PLAYED[1])).decode('ascii')}")
    return as_json({"times": times, "pictures": pictures, "next": following})


@answering
def followed(token: str, asked: Mapping[str, Any], path: str, name: str) -> Answer:  # noqa: ARG001
    """Follow the ball through a film: its track, as one from a file, and where it was seen in the pictures."""
    from ..tracks.film import track_film

    place, last = Path(path), 0.0

    def tell(share: float) -> None:
        nonlocal last
        if time.monotonic() - last > _TELLING:
            told(place, share)
            last = time.monotonic()

    given = {key: value for key, value in asked.items() if value is not None and value != ""}
    try:
        found = track_film(place, progress=tell, **given)
    except InvalidValueError as error:
        remedy = _FOR_COMMANDS.sub("", error.remedy)
        raise InvalidValueError(error.key, error.rule, error.received, remedy) from None
    camera = found.calibration.camera
    track = track_told(found)
    step = -(-len(found) // len(track["columns"]["t"]))
    said = [*track["said"], *((one,) for one in found.calibrated)]
    at_hand = {"title": name, "said": [[_named(one, place, name) for one in clauses] for clauses in said]}
    return as_json(
        {
            **track,
            **at_hand,
            "suggested": _suggested(found),
            "film": {
                "slow": found.slow,
                "pixels": _rounded(found.pixels[::step]),
                "view": {
                    "focal": camera.focal,
                    "centre": list(camera.centre),
                    "turn": camera.turn.tolist(),
                    "place": camera.place.tolist(),
                    "distortion": camera.distortion,
                    "ball": found.ball_radius,
                },
            },
        }
    )


def _suggested(found: FilmTrack) -> dict[str, Any]:
    """Return a scenario that may be like what was filmed, and what is to be found of it."""
    support: dict[str, Any] = {"kind": "plane"}
    if found.rim_radius:
        support["rim"] = found.rim_radius
    free = []
    if found.rate is not None:
        support["motion"] = {"kind": "spin", "rate": found.rate[0]}
        free = ["body.inertia_ratio", "support.motion.rate"]
    body = {"kind": "sphere", "radius": found.ball_radius, "mass": _MASS, "inertia_ratio": 0.4}
    x, y = found["x"][0], found["y"][0]
    length = float(found.time[-1] - found.time[0])
    scenario = {
        "title": "A ball on the filmed table",
        "body": body,
        "support": support,
        "start": {"position": [float(x), float(y)]},
        "run": {"duration": max(length, 0.1), "every": 0.02},
    }
    return {"scenario": scenario, "free": free}


def _named(sentence: str, path: Path, name: str) -> str:
    return sentence.replace(path.name, name)


def outlines(view: Mapping[str, Any], places: Array) -> list[list[list[float]]]:
    """Return where the outline of a ball is seen in a film whose camera is known, at each of its places (n, 2), px."""
    import numpy as np

    from ..tracks.film.pinhole import PinholeCamera

    camera: PinholeCamera = PinholeCamera(
        view["focal"], tuple(view["centre"]), np.array(view["turn"]), np.array(view["place"]), view["distortion"]
    )
    seen = camera.ball_outlines(places, view["ball"], _OUTLINE)
    return [_rounded(one) for one in np.nan_to_num(seen)]
