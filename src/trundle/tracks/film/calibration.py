"""Calibration: where the camera stood, from the rim or from marks at known places, and how the table turned."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from .pinhole import Array, PinholeCamera

_FEWEST = 4  # marks that fix a plane
_FINEST = 0.1  # px: no picture is better than that
_VAGUE = 0.15  # relative error of the height, above which it must be given
_SIDES = 0.005  # of the rim's radius: how far two solutions may be apart
_ALIKE = 2.0  # times the least misfit, within which another solution is as good
_OFF = 5.0  # times the median distance of the mark from where it should be: another thing has spoilt it
_LEAST_OFF = 0.2  # px
_BLURRED = 2.0  # times the radius of a mark, within which all of its blurred picture is
_RING = 2 * np.pi * np.arange(24) / 24
_START_FOCAL = 1.2  # of the longer side: a telephone's


@dataclass(frozen=True)
class Turning:
    """How the table turned, from a mark on it."""

    # `rate`, `rate_sigma`: anticlockwise seen from above, rad/s
    rate: float
    rate_sigma: float
    phase: float  # angle of the mark at the time 0, rad
    radius: float  # its distance from the axis, m
    misfit: float  # root mean square of the distances from an even turning, px
    outermost: float = 0.0  # distance from the axis to which the mark reaches, with its blur, m

    def angle(self, time: Any) -> Any:
        """Return the angle of the mark, rad."""
        return self.phase + self.rate * time


@dataclass(frozen=True)
class Calibration:
    """Where the camera stood over the table, and how the table turned."""

    # the origin of the world on the table's axis if a mark showed it, else in the middle of the rim
    camera: PinholeCamera
    # root mean square of the distances of the rim's edges, or of the marks, from where they should be, px
    misfit: float
    turning: Turning | None  # if a mark was seen
    basis: str  # what it comes from, in words
    # `times`, `mark`: (k,) and (k, 2): of the pictures in which the mark was where it should be, s, and where its
    # middle was seen, px
    times: Array
    mark: Array
    # where the rim has its middle, m: off the axis if the plate lies askew
    rim_centre: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Sightings:
    """What a calibration is made from."""

    size: tuple[int, int]  # width and height of the picture, px
    rim: Array | None = None  # (n, 2): edges of the rim, px
    rim_radius: float = 0.0  # m
    marks: Array | None = None  # (m, 4): marks at known places: px, px, m, m
    # `times`, `mark`: (k,) and (k, 2): where the mark on the table was seen, px
    times: Array | None = None
    mark: Array | None = None
    mark_area: float = 0.0  # how many pixels it covers


def check_marks(marks: Sequence[Sequence[float]]) -> Array:
    """Return marks at known places as an array, if they fix a plane.

    Raises
    ------
    InvalidValueError
        If they are too few, or on a line.
    """
    array = np.asarray(marks, dtype=float).reshape(len(marks), -1)
    if len(array) < _FEWEST or array.shape[1] != 4:
        remedy = "Measure four points of the table that you can find in the picture, far apart."
        raise InvalidValueError(
            "marks", f"must be at least {_FEWEST}, each of two pixels and two lengths", f"{len(array)}", remedy
        )
    for part in (array[:, :2], array[:, 2:]):
        spread = np.linalg.svd(part - part.mean(axis=0), compute_uv=False)
        if spread[1] < 0.05 * spread[0]:
            raise InvalidValueError("marks", "must not lie on one line", part.tolist(), "Take the corners of a square.")
    return array


def calibrate(seen: Sightings, height: float | None, focal: float | None, distortion: float) -> Calibration:
    """Return the calibration that fits best what was seen.

    Raises
    ------
    InvalidValueError
        If what was seen leaves the height of the camera open, or from which side it looked.
    """
    if height is not None and focal is not None:
        raise InvalidValueError("focal", "must not be given with a height", focal, "One follows from the other.")
    known, best = _solved(seen, height, focal, distortion)
    if seen.mark is not None and seen.times is not None:  # once more, seen as a disc, and only where alone
        off = np.linalg.norm(best.fun[-2 * len(seen.mark) :].reshape(-1, 2), axis=1)
        good = off < max(_OFF * float(np.median(off)), _LEAST_OFF)
        camera = known.unpacked(best.x)[0]
        seen = replace(seen, times=seen.times[good], mark=_middles(camera, seen.mark[good], seen.mark_area))
        known, best = _solved(seen, height, focal, distortion)
    camera, turning, axis = known.unpacked(best.x)
    count = len(seen.rim) if seen.rim is not None else 2 * len(known.marks)
    misfit = float(np.sqrt((best.fun[:count] ** 2).mean()))
    if turning is not None:
        freedom = max(best.fun.size - best.x.size, 1)
        covariance = _inverse(best.jac) * 2 * best.cost / freedom
        off = float(np.sqrt((best.fun[count:] ** 2).mean()))
        outermost = turning.radius + _BLURRED * _radius(camera, seen)
        turning = replace(turning, rate_sigma=float(np.sqrt(covariance[-1, -1])), misfit=off, outermost=outermost)
        camera = replace(camera, place=camera.place - np.array([*axis, 0.0]))
    basis = f"the rim ({count} points of its edge)" if seen.rim is not None else f"{len(known.marks)} marks"
    times, mark = (
        (np.zeros(0), np.zeros((0, 2))) if seen.mark is None or seen.times is None else (seen.times, seen.mark)
    )
    return Calibration(camera, misfit, turning, basis, times, mark, (float(-axis[0]), float(-axis[1])))


def _radius(camera: PinholeCamera, seen: Sightings) -> float:
    """Return the radius of a round mark by the pixels that it covers, m."""
    place = np.nanmedian(camera.on_plane(seen.mark), axis=0) if seen.mark is not None else np.zeros(2)
    step = 1e-3
    at, right, up = camera.project(np.array([[*(place + aside), 0.0] for aside in ((0, 0), (step, 0), (0, step))]))
    cell = abs(np.linalg.det([right - at, up - at])) / step**2  # pixels a square metre
    return float(np.sqrt(seen.mark_area / (np.pi * cell)))


def _middles(camera: PinholeCamera, mark: Array, area: float) -> Array:
    """Return where the middle of a round mark is seen; in the middle of its picture the nearer half weighs more."""
    place = np.nan_to_num(camera.on_plane(mark))
    ring = _RING[:, None]

    def outline(radius: float) -> Any:
        flat = [place[:, i] + radius * turn(ring) for i, turn in enumerate((np.cos, np.sin))]
        points = np.stack([*flat, np.zeros_like(flat[0])], axis=-1).reshape(-1, 3)
        return camera.project(points).reshape(len(_RING), len(mark), 2) @ np.array([1, 1j])

    def filled(z: Any) -> tuple[Any, Any]:
        """Return area and middle of polygons."""
        after = np.roll(z, -1, axis=0)
        parts = (np.conj(z) * after).imag / 2
        return parts.sum(axis=0), (parts * (z + after)).sum(axis=0) / (3 * parts.sum(axis=0))

    trial = 1e-3
    radius = trial * float(np.sqrt(area / np.median(np.abs(filled(outline(trial))[0]))))
    middle = camera.project(np.column_stack([place, np.zeros(len(place))])) @ np.array([1, 1j])
    shift = filled(outline(radius))[1] - middle
    return np.asarray(mark - np.column_stack([shift.real, shift.imag]))


def _solved(seen: Sightings, height: float | None, focal: float | None, distortion: float) -> tuple[_Known, Any]:
    known = _Known(seen, height, focal, distortion)
    found = sorted((_solve(known, start) for start in _starts(known)), key=lambda one: float(one.cost))
    _check_sides(known, found)
    _check_height(known, found[0])
    return known, found[0]


@dataclass(frozen=True)
class _Known:
    """What was seen and given, and the order of the numbers that are sought."""

    seen: Sightings
    height: float | None
    focal: float | None
    distortion: float

    @property
    def marks(self) -> Array:
        return np.zeros((0, 4)) if self.seen.marks is None else self.seen.marks

    @property
    def free(self) -> tuple[bool, bool, bool]:
        """Whether the turn about the vertical, the height and the focal length are sought."""
        return self.seen.rim is None, self.height is None, self.focal is None

    def packed(self, camera: PinholeCamera, turning: Sequence[float]) -> Array:
        turn, tall, long = self.free
        parts = [*camera.turn[:2], *camera.place[:2]]
        parts += [camera.turn[2]] * turn + [np.log(camera.place[2])] * tall + [np.log(camera.focal)] * long
        return np.array([*parts, *turning])

    def unpacked(self, numbers: Array) -> tuple[PinholeCamera, Turning | None, Array]:
        rest = list(numbers[4:])
        turn, tall, long = self.free
        third = rest.pop(0) if turn else 0.0
        height = float(np.exp(rest.pop(0))) if tall else float(self.height or 0)
        focal = float(np.exp(rest.pop(0))) if long else float(self.focal or 0)
        width, tallness = self.seen.size
        camera = PinholeCamera(focal, ((width - 1) / 2, (tallness - 1) / 2), np.array([*numbers[:2], third]),
                               np.array([*numbers[2:4], height]), self.distortion)  # fmt: skip
        if self.seen.mark is None:
            return camera, None, np.zeros(2)
        x, y, radius, phase, rate = rest
        return camera, Turning(rate, 0.0, phase, radius, 0.0), np.array([x, y])

    def residual(self, numbers: Array) -> Array:
        """Return how far everything is from where it should be, px."""
        camera, turning, axis = self.unpacked(numbers)
        parts = []
        if self.seen.rim is not None:
            there = camera.on_plane(self.seen.rim)
            far = np.linalg.norm(there - camera.place[:2], axis=1)
            scale = camera.focal / np.hypot(far, camera.place[2])
            parts.append(np.nan_to_num((np.linalg.norm(there, axis=1) - self.seen.rim_radius) * scale, nan=1e3))
        if len(self.marks):
            flat = np.column_stack([self.marks[:, 2:], np.zeros(len(self.marks))])
            parts.append((camera.project(flat) - self.marks[:, :2]).ravel())
        if turning is not None and self.seen.mark is not None:
            angle = turning.angle(self.seen.times)
            place = axis + turning.radius * np.column_stack([np.cos(angle), np.sin(angle)])
            parts.append((camera.project(np.column_stack([place, np.zeros(len(place))])) - self.seen.mark).ravel())
        return np.nan_to_num(np.concatenate(parts), nan=1e3, posinf=1e3, neginf=-1e3)


def _starts(known: _Known) -> list[Array]:
    """Return first numbers: the camera leans to one side or the other by what the ellipse is short of a circle."""
    import cv2

    seen = known.seen
    width, tallness = seen.size
    focal = known.focal or _START_FOCAL * max(width, tallness)
    centre = np.array([(width - 1) / 2, (tallness - 1) / 2])
    if seen.rim is None:
        places, pixels = known.marks[:, 2:], known.marks[:, :2]
        given, shown = _complex(places), _complex(pixels * (1, -1))
        middle, origin = pixels.mean(axis=0), places.mean(axis=0)
        scale = float(np.linalg.norm(shown) / np.linalg.norm(given))
        angle = float(np.angle(np.vdot(given, shown)))
        leans = [np.zeros(2), *(0.5 * np.array(side) for side in ((1, 0), (-1, 0), (0, 1), (0, -1)))]
    else:
        middle, (one, two), degrees = cv2.fitEllipse(seen.rim.astype(np.float32)[:, None])
        long, short = max(one, two), min(one, two)
        minor = np.deg2rad(degrees + (90 if one > two else 0))
        lean = float(np.arccos(np.clip(short / long, 0.0, 1.0)))
        angle, origin, scale = 0.0, np.zeros(2), long / 2 / seen.rim_radius
        # Turning the camera about its own axis (a, b) makes the direction across it short.
        across = np.array([-np.sin(minor), np.cos(minor)]) * (1, -1)
        leans = [lean * across, -lean * across]
    found = []
    for one_lean in leans:
        if known.height is not None and known.focal is None:
            focal = scale * known.height
        far = focal / scale
        camera = PinholeCamera(focal, (float(centre[0]), float(centre[1])), np.array([*one_lean, angle]), np.zeros(3))
        ahead = np.array([*((np.asarray(middle) - centre) / focal), 1.0]) @ camera.rotation
        place = np.array([*origin, 0.0]) - far * ahead / np.linalg.norm(ahead)
        place[2] = known.height or max(float(place[2]), 0.1 * far)
        found.append(known.packed(replace(camera, place=place), _first_turning(known, replace(camera, place=place))))
    return found


def _complex(points: Array) -> Any:
    centred = points - points.mean(axis=0)
    return centred[:, 0] + 1j * centred[:, 1]


def _first_turning(known: _Known, camera: PinholeCamera) -> list[float]:
    """Return axis, radius, phase and rate of the mark as a rough camera shows them."""
    seen = known.seen
    if seen.mark is None or seen.times is None:
        return []
    place = np.nan_to_num(camera.on_plane(seen.mark))
    system = np.column_stack([2 * place, np.ones(len(place))])
    x, y, rest = np.linalg.lstsq(system, (place**2).sum(axis=1), rcond=None)[0]
    angle = np.unwrap(np.arctan2(place[:, 1] - y, place[:, 0] - x))
    rate, phase = np.polyfit(seen.times, angle, 1)
    return [x, y, float(np.sqrt(max(rest + x**2 + y**2, 1e-12))), float(phase), float(rate)]


def _solve(known: _Known, start: Array) -> Any:
    from scipy.optimize import least_squares

    return least_squares(known.residual, start, loss="soft_l1", f_scale=1.0, x_scale="jac", max_nfev=200)


def _inverse(jacobian: Array) -> Array:
    """Return the covariance for a unit error; what does not show at all has a very large one."""
    _, sizes, turned = np.linalg.svd(jacobian, full_matrices=False)
    return np.asarray((turned.T / np.maximum(sizes, 1e-12 * sizes[0]) ** 2) @ turned)


def _check_sides(known: _Known, found: Sequence[Any]) -> None:
    """Refuse a circle alone that a camera on either side of it would see alike."""
    if known.seen.rim is None or known.seen.mark is not None:
        return
    best = known.unpacked(found[0].x)[0]
    for other in found[1:]:
        if other.cost <= _ALIKE * found[0].cost:
            shown = known.unpacked(other.x)[0].on_plane(known.seen.rim) - best.on_plane(known.seen.rim)
            inner = known.unpacked(other.x)[0].on_plane(best.project(np.zeros((1, 3))))
            if max(np.abs(shown).max(), np.abs(inner).max()) > _SIDES * known.seen.rim_radius:
                remedy = "Stick a coloured dot on the table and say mark_colour, give four marks, or film from above."
                rule = "must come with a mark on the table where the camera looks aslant"
                raise InvalidValueError("rim_radius", rule, "a rim alone, which two cameras would see alike", remedy)


def _check_height(known: _Known, best: Any) -> None:
    """Refuse a height that the picture does not fix."""
    if known.height is not None or known.focal is not None:
        return
    freedom = max(best.fun.size - best.x.size, 1)
    covariance = _inverse(best.jac) * max(2 * best.cost / freedom, _FINEST**2)
    place = 5 if known.free[0] else 4
    sigma = float(np.sqrt(covariance[place, place]))
    if not sigma < _VAGUE:
        rule = "must be given where the picture does not show it"
        remedy = "Measure it from the table to the lens, and say height='1.2 m' (`--height '1.2 m'`)."
        raise InvalidValueError("height", rule, "a camera that looks from almost straight above", remedy)
