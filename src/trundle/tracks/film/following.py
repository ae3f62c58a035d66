"""Following: the mark and the ball from picture to picture, and why a picture was not taken."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ..table import Rejected
from .container import Film, Frame, Picture
from .ground import Ground
from .pinhole import Array, PinholeCamera
from .spots import SAME_COLOUR, Spot, alike, colour_of, core_colour, differing, regions, spots

_SIZES = (0.4, 2.2)  # of the area that is expected, of what may be the ball
_HIDDEN = 0.12  # relative difference of areas from which something hides a spot or touches it
_OFTEN = 0.5  # of the pictures that are looked at, in which a second thing is no chance
_FEW = 0.2  # of the pictures
_FEWEST = 10
_NEARER = 3.0  # times as near to where it is expected as the next
_OFF = 6.0  # standard deviations from a smooth path
_LEAST_OFF = 0.5  # px
_SAME_PICTURE = 0.02, 0.15  # mean difference of a picture that is shown twice: of 255, and of the usual difference
_MARK_AREA = (6.0, 0.02)  # px, and share of the picture


@dataclass
class Followed:
    """Where something was seen: its frames, times, pixels and areas, and the frames that were not taken."""

    numbers: list[int] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    places: list[tuple[float, float]] = field(default_factory=list)
    areas: list[float] = field(default_factory=list)
    rejected: dict[int, str] = field(default_factory=dict)
    frames: int = 0

    def leave_out(self, wrong: Any, reason: str) -> None:
        """Leave out what was found in some frames."""
        for i in np.flatnonzero(wrong):
            self.rejected[self.numbers[i]] = reason
        kept = np.flatnonzero(~np.asarray(wrong))
        for name in ("numbers", "times", "places", "areas"):
            setattr(self, name, [getattr(self, name)[i] for i in kept])

    @property
    def pixels(self) -> Array:
        """The places, (n, 2)."""
        return np.array(self.places, dtype=float).reshape(-1, 2)

    def as_rejected(self) -> tuple[Rejected, ...]:
        """Return the frames that were not taken, in their order."""
        return tuple(Rejected(number, reason) for number, reason in sorted(self.rejected.items()))


def distinct(film: Film, clock: Callable[[float], float], found: Followed) -> Iterator[tuple[Frame, float]]:
    """Yield the frames that show something new, each with its true time; note the others."""
    before: Picture | None = None
    last, usual = -np.inf, 0.0
    for frame in film.frames():
        found.frames += 1
        time = clock(frame.time)
        if not time > last:
            found.rejected[frame.number] = "its time is not after that of the frame before"
            continue
        if before is not None:
            apart = _apart(frame.picture, before)
            if apart < max(_SAME_PICTURE[0], _SAME_PICTURE[1] * usual):
                found.rejected[frame.number] = "it repeats the frame before"
                continue
            usual += 0.2 * (apart - usual)
        before, last = frame.picture, time
        yield frame, time


def _apart(picture: Picture, before: Picture) -> float:
    """Return the mean difference of two pictures, of 255."""
    import cv2

    return float(np.mean(cv2.absdiff(picture[::2, ::2], before[::2, ::2])))


def learn_mark(samples: Sequence[Frame], still: Picture, name: str) -> tuple[Array, float]:
    """Return the colour of the mark on the table as it is in the film, and how many pixels it covers.

    Raises
    ------
    InvalidValueError
        If there is none of this colour that moves, or several.
    """
    wanted = colour_of(name, "mark_colour")
    most = _MARK_AREA[1] * still.shape[0] * still.shape[1]
    colours, areas, several = [], [], 0
    for frame in samples:
        mask = alike(frame.picture, wanted) & differing(frame.picture, still)
        boxes = regions(mask, _MARK_AREA[0], most)
        several += len(boxes) > 1 and boxes_alike(boxes)
        if boxes:
            box = max(boxes, key=lambda one: one[4])
            colours.append(core_colour(frame.picture, mask, box))
            areas.append(box[4])
    if len(colours) < _OFTEN * len(samples):
        remedy = "Say the colour that the film shows, such as '#3cbe28', or stick a larger dot on the table."
        raise InvalidValueError("mark_colour", "must be of a dot that moves with the table", name, remedy)
    if several > _OFTEN * len(samples):
        remedy = "Leave one dot of this colour on the table."
        raise InvalidValueError(
            "mark_colour", "must be of one thing that moves", f"{name}, of which there are several", remedy
        )
    return np.asarray(np.median(colours, axis=0)), float(np.median(areas))


def boxes_alike(boxes: Sequence[tuple[int, ...]]) -> bool:
    """Tell whether the two largest regions are about as large."""
    first, second = sorted((box[4] for box in boxes), reverse=True)[:2]
    return second > 0.5 * first


def follow_mark(film: Film, clock: Callable[[float], float], still: Picture, colour: Array, area: float) -> Followed:
    """Follow the mark on the table through the film."""
    found = Followed()
    for frame, time in distinct(film, clock, found):
        seen = spots(frame.picture, still, colour, 0.3 * area, 3.0 * area)
        if not seen:
            found.rejected[frame.number] = "no mark"
        elif len(seen) > 1 and seen[1].area > 0.5 * seen[0].area:
            found.rejected[frame.number] = "several marks"
        else:
            _take(found, frame, time, seen[0])
    if len(found.numbers) < _FEWEST:
        remedy = "Stick a dot of a strong colour on the table, as large as a coin."
        raise InvalidValueError(
            "mark_colour", "must be of a dot that can be followed", f"{len(found.numbers)} frames with it", remedy
        )
    return found


def _take(found: Followed, frame: Frame, time: float, spot: Spot) -> None:
    found.numbers.append(frame.number)
    found.times.append(time)
    found.places.append((spot.x, spot.y))
    found.areas.append(spot.area)


@dataclass(frozen=True)
class Candidate:
    """A thing of the ball's size in a picture."""

    colour: Array
    place: tuple[float, float]


def learn_ball(
    samples: Sequence[tuple[float, Frame]], ground: Ground, camera: PinholeCamera, radius: float, name: str | None
) -> Array:
    """Return the colour of the ball as it is in the film.

    Raises
    ------
    InvalidValueError
        If nothing of its size moves, or things of several colours do.
    """
    wanted = None if name is None else colour_of(name, "colour")
    found = [_candidates(frame.picture, ground.at(time), camera, radius, wanted) for time, frame in samples]
    groups: list[list[Array]] = []
    for candidates in found:
        taken: set[int] = set()
        for one in candidates:
            group = next(
                (
                    i
                    for i, group in enumerate(groups)
                    if np.linalg.norm(np.median(group, axis=0) - one.colour) < SAME_COLOUR
                ),
                None,
            )
            if group is None:
                groups.append([one.colour])
                taken.add(len(groups) - 1)
            elif group not in taken:
                groups[group].append(one.colour)
                taken.add(group)
    groups.sort(key=len, reverse=True)
    often = [np.median(group, axis=0) for group in groups if len(group) > _OFTEN * len(samples)]
    if len(often) > 1:
        told = " and ".join(shown(colour) for colour in often)
        raise InvalidValueError("colour", "must be said where several things of the ball's size move", told,
                                "Say for instance colour='red' (`--colour red`).")  # fmt: skip
    if not groups or len(groups[0]) < max(_FEW * len(samples), 2):
        given = "nothing of its size that moves" if name is None else f"nothing {name} of its size that moves"
        remedy = "Check ball_radius and rim_radius, say the colour that the film shows, or film against a plain table."
        raise InvalidValueError("ball_radius", "must be of a ball that the film shows", given, remedy)
    return np.asarray(np.median(groups[0], axis=0))


def shown(colour: Array) -> str:
    """Return a colour as #rrggbb.

    Examples
    --------
    >>> shown(np.array([0.0, 128.0, 255.0]))
    '#ff8000'
    """
    blue, green, red = (int(part) for part in colour)
    return f"#{red:02x}{green:02x}{blue:02x}"


def _candidates(
    picture: Picture, ground: Picture, camera: PinholeCamera, radius: float, wanted: Array | None
) -> list[Candidate]:
    mask = differing(picture, ground)
    if wanted is not None:
        mask &= alike(picture, wanted)
    found = []
    for x, y, w, h, area in regions(mask, 4, picture.shape[0] * picture.shape[1] / 2):
        middle = np.array([[x + (w - 1) / 2, y + (h - 1) / 2]])
        expected = expected_area(camera, middle, radius)[0]
        if _SIZES[0] * expected < area < _SIZES[1] * expected and max(w, h) < 2.2 * min(w, h):
            found.append(
                Candidate(core_colour(picture, mask, (x, y, w, h)), (float(middle[0, 0]), float(middle[0, 1])))
            )
    return found


def expected_area(camera: PinholeCamera, pixels: Array, radius: float) -> Array:
    """Return how many pixels a ball fills whose picture has its middle there."""
    area = camera.ball_area(camera.ball_centres(pixels, radius), radius)
    return np.asarray(np.where(np.isfinite(area), area, 0.0))


def follow_ball(
    film: Film, clock: Callable[[float], float], ground: Ground, camera: PinholeCamera, radius: float, colour: Array
) -> Followed:
    """Follow the ball through the film.

    Raises
    ------
    InvalidValueError
        If it is in too few frames, or cannot be told from another.
    """
    found, doubtful = Followed(), 0
    height, width = ground.still.shape[:2]
    middle = expected_area(camera, np.array([[width / 2, height / 2]]), radius)[0]
    for frame, time in distinct(film, clock, found):
        seen = spots(frame.picture, ground.at(time), colour, 0.15 * middle, 8.0 * middle)
        areas = expected_area(camera, np.array([[one.x, one.y] for one in seen]).reshape(-1, 2), radius)
        likely = [one for one, area in zip(seen, areas, strict=True) if _SIZES[0] * area < one.area < _SIZES[1] * area]
        if not likely:
            found.rejected[frame.number] = "something covers or touches the ball" if seen else "no ball"
            continue
        chosen = _nearest(found, likely, time)
        if chosen is None:
            doubtful += 1
            found.rejected[frame.number] = "two things look like the ball"
        elif not chosen.whole:
            found.rejected[frame.number] = "the ball is cut by the edge of the picture"
        else:
            _take(found, frame, time, chosen)
    _check_found(found, doubtful)
    ratio = np.array(found.areas) / expected_area(camera, found.pixels, radius)
    found.leave_out(np.abs(ratio / np.median(ratio) - 1) > _HIDDEN, "the ball is hidden in part, or touched")
    found.leave_out(_off_the_path(found), "it is off the path of its neighbours")
    _check_found(found, doubtful)
    return found


def _nearest(found: Followed, likely: Sequence[Spot], time: float) -> Spot | None:
    """Return the one that goes on where the ball was; None where two may be it."""
    if len(likely) == 1:
        return likely[0]
    if len(found.times) < 2:
        return None
    places, times = found.pixels[-2:], found.times[-2:]
    ahead = places[1] + (places[1] - places[0]) * (time - times[1]) / (times[1] - times[0])
    apart = [float(np.hypot(one.x - ahead[0], one.y - ahead[1])) for one in likely]
    order = np.argsort(apart)
    return likely[order[0]] if apart[order[1]] > _NEARER * max(apart[order[0]], 1.0) else None


def _check_found(found: Followed, doubtful: int) -> None:
    if doubtful > max(_FEW * found.frames, _FEWEST):
        remedy = "Say its colour, or begin where it is alone: begin='2 s' (`--begin '2 s'`)."
        raise InvalidValueError(
            "ball_radius", "must be of one ball", f"two alike in {doubtful} frames of {found.frames}", remedy
        )
    if len(found.numbers) < max(_FEWEST, _FEW * found.frames):
        reasons = sorted(set(found.rejected.values()), key=list(found.rejected.values()).count, reverse=True)
        told = f"{len(found.numbers)} frames of {found.frames}" + (f" (the others: {reasons[0]})" if reasons else "")
        remedy = "Say its colour, or look at only a part of the film with begin and end."
        raise InvalidValueError("film", "must show the ball", told, remedy)


def _off_the_path(found: Followed) -> Any:
    """Return which places are off a parabola through their neighbours by more than noise."""
    z = found.pixels @ np.array([1, 1j])
    time = np.array(found.times)
    count, half = len(z), 3
    if count < 2 * half + 3:
        return np.zeros(count, dtype=bool)
    first = np.clip(np.arange(count) - half, 0, count - 2 * half - 1)
    at = first[:, None] + np.arange(2 * half + 1)
    own = np.arange(count)[:, None] == at
    u = time[at] - time[:, None]
    u = u / np.abs(u).max(axis=1, keepdims=True)
    powers = u[:, :, None] ** np.arange(3)
    fitted = (np.linalg.pinv(np.where(own[:, :, None], 0.0, powers))[:, 0, :] * np.where(own, 0.0, z[at])).sum(axis=1)
    off = np.abs(z - fitted)
    return off > max(_OFF * 1.4826 * float(np.median(off)), _LEAST_OFF)
