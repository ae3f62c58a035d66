"""Pieces of path laid end to end: where each begins, how it heads and bends, and how long it is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError
from . import bends
from .curves import PlaneCurve, RolledCurve
from .pieces import Arc, Curve, Piece, Straight

Array = NDArray[np.float64]

_MOST_RADIANS = 1e9  # of turning; beyond, rounding alone leaves the orientation unknown
_JOINED = 1e-9  # how near to the end of the path so far a curve must begin, as a share of the lengths there


@dataclass(frozen=True)
class Laid:
    """A path of n pieces on the plane."""

    # `headings`, `curvatures`, `lengths`: (n,): at the beginning of each piece, rad; 1/m, 0 for a curve; m
    headings: Array
    curvatures: Array
    lengths: Array
    distances: Array  # (n + 1,): along the path, of the pieces' ends, m
    places: Array  # (n + 1, 2): of the pieces' ends, m
    last_heading: float  # at the end of the path, rad
    curves: dict[int, RolledCurve]  # the pieces that are curves
    area: float  # between the path and the chord from its end to its beginning, m²


def develop(pieces: tuple[Piece, ...], start: tuple[float, float], radius: float) -> Laid:
    """Lay pieces end to end.

    Examples
    --------
    >>> develop((Straight(length=2.0), Arc(radius=1.0, angle=np.pi)), (0.0, 0.0), 0.1).places.round(9) + 0.0
    array([[0., 0.],
           [2., 0.],
           [2., 2.]])
    """
    here, heading, area = np.array(start), 0.0, 0.0
    rows: list[tuple[float, float, float]] = []
    places, curves = [here], {}
    for i, piece in enumerate(pieces):
        if isinstance(piece, Curve):
            curve = _rolled(piece, radius)
            _check_joined(here, curve, i)
            curves[i] = curve
            begin, heading = curve.headings
            rows.append((begin, 0.0, curve.length))
            here, bulge = curve.places(np.array(curve.ends[1:]))[0][0], curve.area
        else:
            begin, curvature, length = _row(piece, here, heading, radius, i)
            rows.append((begin, curvature, length))
            step = bends.displacement(begin, curvature, length)
            here, heading = here + step, begin + curvature * length
            if isinstance(piece, Straight) and piece.to is not None:
                here = np.array(piece.to)
            bulge = float(bends.segment_area(curvature, length))
        before, onward = places[-1] - places[0], here - places[0]
        area += 0.5 * float(before[0] * onward[1] - before[1] * onward[0]) + bulge
        places.append(here)
    headings, curvatures, lengths = np.array(rows).T
    turned = float(lengths.sum() / radius + np.abs(curvatures * lengths).sum())
    if not turned < _MOST_RADIANS:
        remedy = "Rounding alone would leave its orientation unknown. Check the units of ball and path."
        raise InvalidValueError("path", "must turn the ball by at most 1e9 rad", f"{turned:.3g} rad", remedy)
    distances = np.concatenate([[0.0], np.cumsum(lengths)])
    return Laid(headings, curvatures, lengths, distances, np.array(places), heading, curves, area)


def _row(piece: Straight | Arc, here: Array, before: float, radius: float, index: int) -> tuple[float, float, float]:
    """Return heading, curvature and length of a straight piece or an arc."""
    heading = before if piece.heading is None else piece.heading
    if isinstance(piece, Arc):
        return heading, math.copysign(1.0, piece.angle) / piece.radius, abs(piece.angle) * piece.radius
    if piece.to is None:
        return heading, 0.0, radius * piece.turn if piece.length is None else piece.length
    x, y = np.array(piece.to) - here
    if not math.hypot(x, y) > 0:
        remedy = "The path is there already; leave the piece out."
        raise InvalidValueError(f"path[{index}].to", "must be another place", piece.to, remedy)
    return math.atan2(y, x), 0.0, math.hypot(x, y)


def _rolled(piece: Curve, radius: float) -> RolledCurve:
    if piece.points is not None:
        return RolledCurve(PlaneCurve.through(piece.points, piece.closed), radius)
    return RolledCurve(PlaneCurve.of(piece.function, piece.start, piece.stop), radius)  # type: ignore[arg-type]


def _check_joined(here: Array, curve: RolledCurve, index: int) -> None:
    begins: Any = curve.places(np.array(curve.ends[:1]))[0][0]
    gap = float(np.hypot(*(begins - here)))
    if gap > _JOINED * max(curve.length, float(np.abs(here).max())):
        received = f"({begins[0]:g}, {begins[1]:g}) m"
        remedy = f"The path has come to ({here[0]:g}, {here[1]:g}) m: begin there."
        raise InvalidValueError(f"path[{index}]", "must begin where the path has come to", received, remedy)
