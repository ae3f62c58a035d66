"""What is checked of a rolled path, by routes that its orientation did not take, and the facts of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import E_Z, Quaternion, Vector
from ...solve.orientation import orientation
from ...verify import Card, CardFigure
from .rotation import Rotation

if TYPE_CHECKING:
    from .curves import RolledCurve
    from .rolled import RolledPath

Array = NDArray[np.float64]

_EXACT = 1e-12  # what rounding may do, for each radian of turning
_DIFFERENCED = 4000.0  # units in the last place that a rate measured from samples may be off
_EPSILON = 2.0**-52
_TOLERANCE, _SOLVER = 1e-12, 1e3  # asked of Runge-Kutta, and how many times it may be missed
_PIECES, _WINDOWS = 60, 3  # looked at, and places looked at in each
_NODES, _WINDOW = 12, 0.5  # samples in a place, and how far the ball turns there at most, rad
_NAMES = ("along +x", "along +y", "up", "along −x", "along −y", "down")
_MOST_RADIANS, _MOST_POLYNOMIALS = 500.0, 60  # of a curve that Runge-Kutta follows


def card(rolled: RolledPath) -> Card:
    """Check a rolled path and say what came of it.

    Examples
    --------
    >>> import trundle as tr
    >>> card = tr.roll_along(tr.Straight(turn="90 deg"), radius=1.0).card()
    >>> card["no pivoting"].passed
    True
    """
    figures = [*_rolls(rolled), *_second_opinions(rolled), *facts(rolled)]
    kinds = ["closed form G2 for straight pieces and arcs"] * bool(len(rolled.pieces) - len(rolled._laid.curves))
    kinds += ["rotation products along curves"] * bool(rolled._laid.curves)
    return Card(rolled.title, "; ".join(kinds), tuple(figures))


def _checked(name: str, value: float, bound: float, note: str, unit: str = "") -> CardFigure:
    return CardFigure(name, float(value), unit, bound, bool(value <= bound), note)


# --- is this rolling? --------------------------------------------------------------------------------------


def _rolls(rolled: RolledPath) -> Iterator[CardFigure]:
    """Measure V and Ω from places and orientations alone, and hold them to V = a Ω × n and Ω·n = 0."""
    slips, pivots, bounds, norm = [], [], [], 0.0
    for contact, turned, half, along in _windows(rolled):
        norm = max(norm, float(np.abs(np.linalg.norm(turned, axis=-1) - 1).max()))
        V = np.einsum("mn,npi->mpi", _differentiation(), contact) / half[:, None]
        rate = Quaternion.of(np.einsum("mn,npi->mpi", _differentiation(), turned) / half[:, None])
        _, *parts = rate * Quaternion.of(turned).conjugate
        Omega = Vector(*(2.0 * part for part in parts))
        rolling = (Omega.cross(E_Z) * rolled.radius).array()[..., :2]
        fastest = np.maximum(np.linalg.norm(V, axis=-1).max(axis=0), 1e-300)
        slips.append(np.linalg.norm(V - rolling, axis=-1).max(axis=0) / fastest)
        pivots.append(np.abs(Omega.dot(E_Z)).max(axis=0) * rolled.radius / fastest)
        size = rolled.radius + np.linalg.norm(contact, axis=-1).max(axis=0)
        bounds.append(_DIFFERENCED * _EPSILON * (size / (half * fastest) + along / half))
    bound = np.concatenate(bounds)
    for name, found, note in (
        ("no slip", slips, "|V − a Ω×n| over the speed, Ω measured from the orientations"),
        ("no pivoting", pivots, "|Ω·n| over |Ω|, the same Ω"),
    ):
        values = np.concatenate(found)
        worst = int(np.argmax(values / bound))  # of short pieces, rounding leaves less to measure
        yield _checked(name, values[worst], bound[worst], note)
    yield _checked("length of the quaternions", norm, _EXACT, "off 1")


def _differentiation() -> Array:
    """Return the matrix from values at Chebyshev nodes on [−1, 1] to the slopes there."""
    nodes = np.polynomial.chebyshev.chebpts1(_NODES)
    slopes = [np.polynomial.chebyshev.chebder(row) for row in np.eye(_NODES)]
    values = np.stack([np.polynomial.chebyshev.chebval(nodes, slope) for slope in slopes], axis=-1)
    return values @ np.linalg.inv(np.polynomial.chebyshev.chebvander(nodes, _NODES - 1))


def _windows(rolled: RolledPath) -> Iterator[tuple[Array, Array, Array, Array]]:
    """Give places (nodes, windows, 2), orientations, half widths and middles of short windows all along the path."""
    nodes = np.polynomial.chebyshev.chebpts1(_NODES)[:, None]
    laid, q = rolled._laid, rolled.stages.orientation
    straight = [i for i in range(len(rolled.pieces)) if i not in laid.curves]
    chosen = np.array(_some(straight), dtype=int)
    if chosen.size:
        chosen = np.repeat(chosen, _WINDOWS)
        rate = np.hypot(1 / rolled.radius, laid.curvatures[chosen])
        half = np.minimum(0.5 * laid.lengths[chosen], 0.5 * _WINDOW / rate)
        share = np.tile(np.arange(_WINDOWS) / (_WINDOWS - 1), chosen.size // _WINDOWS)
        middle = half + share * (laid.lengths[chosen] - 2 * half)
        distance = laid.distances[chosen] + middle + nodes * half
        at = rolled.at(np.clip(distance, 0.0, rolled.length).ravel())
        yield at.contact.reshape(*distance.shape, 2), at.orientation.reshape(*distance.shape, 4), half, distance[0]
    for i in _some(list(laid.curves)):
        yield _curve_windows(laid.curves[i], q[i], nodes)


def _some(items: list[int]) -> list[int]:
    return items[:: max(1, len(items) // _PIECES)]


def _curve_windows(curve: RolledCurve, q: Array, nodes: Array) -> tuple[Array, Array, Array, Array]:
    edges = curve.breaks
    low, high = (np.array(_some(list(side))) for side in (edges[:-1], edges[1:]))
    grid = low + 0.5 * (1 + nodes) * (high - low)
    speed = np.linalg.norm(curve.angular_velocity(grid.ravel()), axis=0).reshape(grid.shape).max(axis=0)
    half = 0.5 * np.minimum(high - low, _WINDOW / np.maximum(speed, 1e-300))
    heading = curve.places((low + half * (1 + nodes)).ravel())[1].reshape(grid.shape)
    bend = np.abs(np.diff(np.unwrap(heading, axis=0), axis=0)).sum(axis=0)
    half = half * np.minimum(1.0, _WINDOW / np.maximum(bend, 1e-300))  # nor may the axis turn by more
    u = low + half + nodes * half
    order = np.argsort(u.ravel(), kind="stable")
    turned = np.empty((u.size, 4))
    turned[order] = curve.orientations(u.ravel()[order], q)
    contact = curve.places(u.ravel())[0]
    return contact.reshape(*u.shape, 2), turned.reshape(*u.shape, 4), half, np.abs(u).max(axis=0)


# --- the same by another route -----------------------------------------------------------------------------


def _second_opinions(rolled: RolledPath) -> Iterator[CardFigure]:
    laid, q = rolled._laid, rolled.stages.orientation
    straight = _some([i for i in range(len(rolled.pieces)) if i not in laid.curves])
    if straight:
        angle = max(_apart(_product(rolled, i), q[i + 1]) for i in straight)
        turned = float(np.hypot(1 / rolled.radius, laid.curvatures)[straight].max() * laid.lengths[straight].max())
        note = "angle between the two at the end of each piece"
        yield _checked("closed form against rotation products", angle, _EXACT * max(1.0, turned), note, "rad")
    if laid.curves:
        followed = [_runge_kutta(rolled, i) for i in _some(list(laid.curves))]
        angle = max(apart for apart, _ in followed)
        bound = _SOLVER * _TOLERANCE * max(1.0, max(turned for _, turned in followed))
        note = f"DOP853 at {_TOLERANCE:g}; angle between the two, over {_MOST_POLYNOMIALS} polynomials at most"
        yield _checked("rotation products against Runge-Kutta", angle, bound, note, "rad")
    bound = rolled.error_bound
    yield CardFigure(
        "error bound of the orientation", bound, "rad", note="rounding" + ", and curves" * bool(laid.curves)
    )


def _apart(q: Any, p: Any) -> float:
    return Rotation.of(tuple(Quaternion(*map(float, q)) * Quaternion(*map(float, p)).conjugate)).angle


def _product(rolled: RolledPath, i: int) -> Array:
    laid = rolled._laid
    heading, curvature, length = laid.headings[i], laid.curvatures[i], laid.lengths[i]

    def angular_velocity(s: Array) -> Array:
        now = heading + curvature * s
        return np.stack([-np.sin(now), np.cos(now), np.zeros_like(now)]) / rolled.radius

    return orientation(angular_velocity, np.array([length]), rolled.stages.orientation[i])[0]


def _runge_kutta(rolled: RolledPath, i: int) -> tuple[float, float]:
    """Follow a curve with SciPy's method; return how far apart the two are, and by how much the ball turned."""
    from scipy.integrate import solve_ivp

    curve, q = rolled._laid.curves[i], rolled.stages.orientation[i]
    first, _ = curve.ends
    far = curve.parameter(np.array([min(curve.length, _MOST_RADIANS * rolled.radius)]))
    end = float(min(curve.breaks[: _MOST_POLYNOMIALS + 1][-1], far[0]))
    turned = min(curve.length / rolled.radius, _MOST_RADIANS)

    def rate(u: float, q: Array) -> list[float]:
        Omega = curve.angular_velocity(np.asarray(u))
        return [float(part) for part in Quaternion(*q).rate(Vector(*Omega))]

    solved = solve_ivp(rate, (first, end), q, "DOP853", rtol=_TOLERANCE, atol=_TOLERANCE)
    theirs = solved.y[:, -1] / np.linalg.norm(solved.y[:, -1])
    return _apart(curve.orientations(np.array([end]), q)[0], theirs), turned


# --- the facts ---------------------------------------------------------------------------------------------


def facts(rolled: RolledPath) -> Iterator[CardFigure]:
    """Return what came of it: figures that inform, without a bound."""
    turned = rolled.length / rolled.radius
    yield CardFigure("length of the path", rolled.length, "m", note=f"the ball rolls by {math.degrees(turned):.6g} deg")
    rotation = rolled.rotation
    home = "came home turned by" if rolled.is_closed else "turned in the end by"
    yield CardFigure(home, rotation.angle, "rad", note=str(rotation))
    pole = rolled.north_pole
    lean = math.atan2(math.hypot(pole[0], pole[1]), pole[2])
    yield CardFigure("north pole off the vertical", lean, "rad", note=f"it points {direction(pole)}")
    if not rolled.is_closed:
        yield CardFigure("end to beginning", rolled.gap, "m", note="the path is not closed")
        return
    area, small = float(rolled.enclosed_area or 0.0), float(rolled.small_loop_angle or 0.0)
    yield CardFigure("area enclosed", area, "m²", note="positive anticlockwise, once for each time round")
    note = "what a small loop turns it by, about the normal"
    if rolled.is_small_loop and small:
        note += f"; it did by {rotation.angle / abs(small):.4g} of that, its path {turned:.3g} a long"
    yield CardFigure("−area/a²", small, "rad", note=note)


def direction(vector: Any) -> str:
    """Say where a unit vector points.

    Examples
    --------
    >>> direction((0.0, -1.0, 1e-16)), direction((0.6, 0.0, 0.8))
    ('along −y', 'along (0.6, 0, 0.8)')
    """
    x, y, z = (round(float(part), 6) + 0.0 for part in vector)
    for along, name in zip((x, y, z, -x, -y, -z), _NAMES, strict=True):
        if along == 1:
            return name
    return f"along ({x:.4g}, {y:.4g}, {z:.4g})".replace("-", "−")
