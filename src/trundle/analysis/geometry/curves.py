"""Smooth curves on the plane as piecewise polynomials, and a ball rolled along one: rotation products.

A spline through points is such a curve; a function is replaced by polynomials of degree 8 that are as near to it as
rounding allows. How near decides how well the orientation is known: see `RolledCurve.error_bound`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError
from ...solve.orientation import orientation
from .pieces import Curve

Array = NDArray[np.float64]

_DEGREE = 8  # then Ω has degree 7, which is what one step of `orientation` follows exactly
_NEAR = 2.0**-46  # a function's polynomials stay as near to it, as a share of the curve's size
_DEEPEST = 30  # halvings
_PARTS, _NODES = 4, 8  # stretches in which the length of one polynomial is measured, and Gauss nodes on each
_NEWTON = 8  # steps at most from a length to its parameter
_STANDS = 1e-9  # share of the mean speed, and of what goes with it, below which a curve stands still
_EPSILON = 2.0**-52


@dataclass(frozen=True)
class PlaneCurve:
    """A piecewise polynomial curve, and how far it may be from the one that was meant."""

    polynomial: Any  # from the parameter u to (x, y), m
    # the largest distance from the curve that was asked for, m; 0 where the polynomials are what was asked for
    deviation: float

    @staticmethod
    def through(points: tuple[tuple[float, float], ...], closed: bool) -> PlaneCurve:
        """Return the cubic spline through points, with the length of the chords as its parameter.

        Examples
        --------
        >>> PlaneCurve.through(((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), closed=False).polynomial(0.5).round(12).tolist()
        [0.5, 0.0]
        """
        from scipy.interpolate import CubicSpline

        places = np.array([*points, points[0]] if closed else points)
        chords = np.hypot(*np.diff(places, axis=0).T)
        parameter = np.concatenate([[0.0], np.cumsum(chords)])
        if not (np.diff(parameter) > 0).all():
            remedy = "Two points in a row are nearer to each other than a float can tell; leave one out."
            raise InvalidValueError("points", "must be apart", float(chords.min()), remedy)
        return PlaneCurve(CubicSpline(parameter, places, bc_type="periodic" if closed else "not-a-knot"), 0.0)

    @staticmethod
    def of(function: Callable[[Any], Any], start: float, stop: float) -> PlaneCurve:
        """Return the polynomials that follow a function, their pieces halved until they do.

        Examples
        --------
        >>> circle = PlaneCurve.of(lambda u: (np.cos(u), np.sin(u)), 0.0, 2 * np.pi)
        >>> bool(circle.deviation < 1e-13)
        True
        """
        from scipy.interpolate import PPoly

        places = _vectorised(function)
        coarse = places(np.linspace(start, stop, 65))
        size = float(np.ptp(coarse, axis=0).max())
        bound = _NEAR * max(size, float(np.abs(coarse).max()))
        edges = np.linspace(start, stop, 9)
        wanted = list(pairwise(edges))
        done: list[tuple[float, Array, float]] = []
        for depth in range(_DEEPEST + 1):
            low, high = np.array(wanted).T
            coefficients, off = _fitted(places, low, high)
            good = off <= bound
            done += [(low[i], coefficients[:, i], off[i]) for i in np.flatnonzero(good)]
            if good.all():
                break
            if depth == _DEEPEST:
                worst = float(low[int(np.argmax(off))])
                remedy = f"Look at it near {worst:.6g}: at a corner, end one piece and begin another."
                raise InvalidValueError("function", "must be smooth", f"a departure of {off.max():.2g} m", remedy)
            rough = [(low[i], high[i]) for i in np.flatnonzero(~good)]
            wanted = [half for l, h in rough for half in ((l, 0.5 * (l + h)), (0.5 * (l + h), h))]
        done.sort(key=lambda piece: piece[0])
        breaks = np.array([piece[0] for piece in done] + [stop])
        pieces = np.stack([piece[1] for piece in done], axis=1)
        return PlaneCurve(PPoly(pieces, breaks), 2.0 * max(piece[2] for piece in done))


def first_place(curve: Curve) -> tuple[float, float]:
    """Return where a curve begins.

    Examples
    --------
    >>> first_place(Curve(function=lambda u: (u, 1.0)))
    (0.0, 1.0)
    """
    if curve.function is None:
        return curve.points[0]
    x, y = _vectorised(curve.function)(np.array([curve.start]))[0]
    return float(x), float(y)


def _vectorised(function: Callable[[Any], Any]) -> Callable[[Array], Array]:
    """Let a function take an array, whether it was written for one or for a number, and check what it returns."""

    def places(u: Array) -> Array:
        values = _all_places(function, u)
        if values is None:
            values = np.array([_one_place(function, float(one)) for one in u.ravel()]).reshape(*u.shape, 2)
        if not np.isfinite(values).all():
            where = float(u[~np.isfinite(values).all(axis=-1)].ravel()[0])
            remedy = "Let it return finite places between `start` and `stop`."
            raise InvalidValueError("function", "must be finite", f"({where:g}) -> not finite", remedy)
        return values

    return places


def _all_places(function: Callable[[Any], Any], u: Array) -> Array | None:
    try:
        with np.errstate(all="ignore"):  # what is not finite is said below
            x, y = function(u)
        values = np.stack(np.broadcast_arrays(u, x, y)[1:], axis=-1).astype(float)
    except (TypeError, ValueError):
        return None
    return values if values.shape == (*u.shape, 2) else None


def _one_place(function: Callable[[Any], Any], u: float) -> tuple[float, float]:
    received: Any = None
    try:
        received = function(u)
        x, y = received
        return float(x), float(y)
    except (TypeError, ValueError, ArithmeticError) as error:
        shown = f"{type(error).__name__} at {u:g}" if received is None else received
        raise InvalidValueError("function", "must return x and y", shown, "For instance (R cos u, R sin u).") from None


def _fitted(places: Callable[[Array], Array], low: Array, high: Array) -> tuple[Array, Array]:
    """Return polynomials (degree + 1, n, 2) in u − low, highest power first, and how far the function is off them."""
    nodes = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
    between = np.cos(np.pi * np.arange(_DEGREE + 2) / (_DEGREE + 1))  # farthest from the nodes, and the ends
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    values = places(middle + nodes[:, None] * half)
    mean = values.mean(axis=0)
    centred = np.einsum("kn,npj->kpj", np.linalg.inv(np.vander(nodes, increasing=True)), values - mean)
    centred[0] += mean
    wanted = places(middle + between[:, None] * half)
    found = np.einsum("mk,kpj->mpj", np.vander(between, _DEGREE + 1, increasing=True), centred)
    off = np.hypot(*np.moveaxis(found - wanted, -1, 0)).max(axis=0)
    # x = (u − low)/half − 1: powers of x in powers of u − low
    shift = np.array([[math.comb(k, j) * (-1.0) ** (k - j) for k in range(_DEGREE + 1)] for j in range(_DEGREE + 1)])
    local = np.einsum("jk,kpi->jpi", shift, centred) / half[None, :, None] ** np.arange(_DEGREE + 1)[:, None, None]
    return local[::-1], off


@dataclass(frozen=True)
class RolledCurve:
    """A ball of radius a rolled along a smooth curve."""

    curve: PlaneCurve  # of the contact point
    radius: float  # a, m

    @cached_property
    def _rate(self) -> Any:
        return self.curve.polynomial.derivative()

    @property
    def breaks(self) -> Array:
        """The parameters at which one polynomial ends and the next begins."""
        return self.curve.polynomial.x

    @property
    def ends(self) -> tuple[float, float]:
        """The parameter at the beginning and at the end."""
        return float(self.breaks[0]), float(self.breaks[-1])

    def angular_velocity(self, u: Array) -> Array:
        """Return Ω = n × v/a, shape (3, n), rad for each unit of the parameter."""
        v = self._rate(u)
        return np.stack([-v[..., 1], v[..., 0], np.zeros(np.shape(u))]) / self.radius

    # --- length ------------------------------------------------------------------------------------------

    @cached_property
    def _lengths(self) -> tuple[Array, Array]:
        """Parameters at close stations, and the length of the curve up to each."""
        breaks = self.breaks
        share = np.arange(_PARTS) / _PARTS
        stations = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * share).ravel(), breaks[-1])
        return stations, np.concatenate([[0.0], np.cumsum(self._between(stations[:-1], stations[1:]))])

    def _between(self, low: Array, high: Array) -> Array:
        nodes, weights = np.polynomial.legendre.leggauss(_NODES)
        half = 0.5 * (high - low)
        v = self._rate(0.5 * (low + high) + nodes[:, None] * half)
        return half * np.einsum("k,kn->n", weights, np.hypot(v[..., 0], v[..., 1]))

    @property
    def length(self) -> float:
        """The length of the curve, m."""
        return float(self._lengths[1][-1])

    def parameter(self, distance: Array) -> Array:
        """Return the parameter at distances along the curve, by Newton's steps within the station's bounds."""
        stations, lengths = self._lengths
        place = np.clip(np.searchsorted(lengths, distance, side="right") - 1, 0, stations.size - 2)
        low, high = stations[place], stations[place + 1]
        span = np.maximum(lengths[place + 1] - lengths[place], 1e-300)
        u = low + (high - low) * (distance - lengths[place]) / span
        for _ in range(_NEWTON):
            missing = distance - lengths[place] - self._between(low, u)
            speed = np.hypot(*np.moveaxis(self._rate(u), -1, 0))
            step = np.where(speed > 0, missing / np.where(speed > 0, speed, 1.0), 0.0)
            u, before = np.clip(u + step, low, high), u
            if (np.abs(u - before) <= 4 * _EPSILON * np.abs(high)).all():
                break
        return u

    # --- what the ball does ------------------------------------------------------------------------------

    def places(self, u: Array) -> tuple[Array, Array]:
        """Return the contact point (n, 2), m, and the heading, rad, at values of the parameter."""
        v = self._rate(u)
        return self.curve.polynomial(u), np.arctan2(v[..., 1], v[..., 0])

    @cached_property
    def headings(self) -> tuple[float, float]:
        """The heading at the beginning and at the end, rad: where the curve stands still there, as it sets off."""
        polynomial, (first, last) = self.curve.polynomial, self.ends
        found = []
        for u, back in ((first, 1.0), (last, -1.0)):
            for order in (1, 2, 3):
                x, y = polynomial(u, order) * back ** (order - 1)
                if math.hypot(x, y) > _STANDS * self.length / (last - first) ** order:
                    break
            found.append(math.atan2(y, x))
        return found[0], found[1]

    def orientations(self, u: Array, start: Any) -> Array:
        """Return the orientation (n, 4) at ascending values of the parameter: a product of the rotations of steps.

        No step crosses from one polynomial to the next, so each has an Ω that its series follows to the last digit.
        """
        breaks = self.breaks
        return orientation(self.angular_velocity, u, start, float(breaks[0]), breaks)

    @cached_property
    def area(self) -> float:
        """The area between the curve and the chord from its end to its beginning, ½∮(x dy − y dx), m²."""
        nodes, weights = np.polynomial.legendre.leggauss(_DEGREE)
        low, high = self.breaks[:-1], self.breaks[1:]
        u = 0.5 * (low + high) + nodes[:, None] * 0.5 * (high - low)
        r, v = self.curve.polynomial(u) - self.curve.polynomial(low[0]), self._rate(u)
        swept = r[..., 0] * v[..., 1] - r[..., 1] * v[..., 0]
        return float(0.5 * np.einsum("k,kn,n->", weights, swept, 0.5 * (high - low)))

    @property
    def steps(self) -> float:
        """About how many rotations are multiplied."""
        return self.breaks.size - 1 + self.length / self.radius

    @property
    def error_bound(self) -> float:
        """The most that the orientation can be off for the curve's own sake, rad (G3).

        Two curves that stay within ε of each other roll a ball to within (2ε/a)(1 + L/a) of the same orientation.
        """
        return 2 * self.curve.deviation / self.radius * (1 + self.length / self.radius)
