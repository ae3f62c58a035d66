"""The pieces that a path on the plane is made of, as a user gives them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ...mechanics.checks import positive, real


@dataclass(frozen=True, kw_only=True)
class Straight:
    """A straight piece of path: how far, or how far the ball turns, or where to.

    Parameters
    ----------
    heading : float or quantity, optional
        Direction of travel, from the first axis towards the second, rad; absent: on as before, along the first axis at
        the beginning.
    length : float or quantity, optional
        m.
    turn : float or quantity, optional
        The angle by which the ball rolls, in place of the length: a length of a·turn, rad.
    to : pair of float or quantity, optional
        Where the contact point goes, in place of heading and length, m.

    Raises
    ------
    InvalidValueError
        If not exactly one of `length`, `turn` and `to` is given, or a value is refused.

    Examples
    --------
    >>> Straight(heading="90 deg", turn="90 deg").turn
    1.5707963267948966
    """

    heading: Any = None
    length: Any = None
    turn: Any = None
    to: Any = None

    def __post_init__(self) -> None:
        given = [name for name in ("length", "turn", "to") if getattr(self, name) is not None]
        if len(given) != 1:
            remedy = "Give one of them: how far, by what angle the ball rolls, or where to."
            raise InvalidValueError("length, turn, to", "must be one of the three", given, remedy)
        if self.to is not None and self.heading is not None:
            remedy = "Leave the heading out: it follows from where the path goes."
            raise InvalidValueError("heading", "must not stand beside `to`", self.heading, remedy)
        _keep(self, "heading", _angle(self.heading, "heading"))
        for name, kind in (("length", "length"), ("turn", "angle")):
            if getattr(self, name) is not None:
                _keep(self, name, _positive(getattr(self, name), kind, name))
        if self.to is not None:
            _keep(self, "to", point(self.to, "to"))


@dataclass(frozen=True, kw_only=True)
class Arc:
    """A piece of a circle on the plane.

    Parameters
    ----------
    radius : float or quantity
        Of the circle that the contact point follows, m.
    angle : float or quantity
        By how much the path turns: positive to the left, from the first axis towards the second; rad.
    heading : float or quantity, optional
        Direction of travel at its beginning, rad; absent: on as before.

    Raises
    ------
    InvalidValueError
        If a value is refused.

    Examples
    --------
    >>> Arc(radius="10 cm", angle="1 turn").angle == 2 * np.pi
    True
    """

    radius: Any
    angle: Any
    heading: Any = None

    def __post_init__(self) -> None:
        _keep(self, "radius", _positive(self.radius, "length", "radius"))
        _keep(self, "angle", _angle(self.angle, "angle"))
        if not self.angle:
            remedy = "Positive turns to the left, negative to the right; for neither take a Straight."
            raise InvalidValueError("angle", "must not be zero", self.angle, remedy)
        _keep(self, "heading", _angle(self.heading, "heading"))


@dataclass(frozen=True, kw_only=True)
class Curve:
    """A smooth curve on the plane, through points or by a function.

    Through points runs the cubic spline whose parameter is the length of the chords: with continuous curvature, its
    third derivative continuous at the second point and at the last but one ("not a knot"), or periodic where closed.
    The ball rolls along this spline; whether it is the curve that was meant is for the points to say.

    Parameters
    ----------
    points : (n, 2) array, or list of pairs of float or quantity, optional
        Where the contact point passes, n ≥ 2, m; one that repeats the one before it is dropped.
    closed : bool
        Whether the spline goes on to the first point and closes smoothly there.
    function : callable, optional
        In place of points: takes the parameter (an array, or one number), returns x and y in m; any number of times
        differentiable.
    start, stop : float
        Where its parameter begins and ends.

    Raises
    ------
    InvalidValueError
        If not exactly one of `points` and `function` is given, or a value is refused.

    Examples
    --------
    >>> Curve(points=[(0, 0), ("10 cm", "5 cm"), ("20 cm", 0)]).points[1]
    (0.1, 0.05)
    """

    points: Any = None
    closed: bool = False
    function: Callable[[Any], Any] | None = None
    start: float = 0.0
    stop: float = 1.0

    def __post_init__(self) -> None:
        if (self.points is None) == (self.function is None):
            given = "neither" if self.points is None else "both"
            raise InvalidValueError("points, function", "must be one of the two", given, "Give points, or a function.")
        if self.points is not None:
            _keep(self, "points", _points(self.points, self.closed))
            return
        if not callable(self.function):
            remedy = "Give a function of the parameter that returns x and y."
            raise InvalidValueError("function", "must be callable", self.function, remedy)
        if self.closed:
            remedy = "A function closes of itself where it returns to its beginning."
            raise InvalidValueError("closed", "must not stand beside `function`", self.closed, remedy)
        for name in ("start", "stop"):
            _keep(self, name, float(real(getattr(self, name), "number", name)))
        if not self.stop > self.start:
            raise InvalidValueError("stop", "must be greater than `start`", self.stop, f"It starts at {self.start:g}.")


Piece = Straight | Arc | Curve


def point(value: Any, key: str) -> tuple[float, float]:
    """Return a point of the plane in m.

    Examples
    --------
    >>> point(["10 cm", 0], "to")
    (0.1, 0.0)
    """
    try:
        x, y = value
    except (TypeError, ValueError):
        raise InvalidValueError(key, "must be a pair of lengths", value, "Write for instance (0.1, 0.0).") from None
    return _float(x, "length", f"{key}[0]"), _float(y, "length", f"{key}[1]")


def _float(value: Any, kind: str, key: str) -> float:
    try:
        return float(real(float(value) if isinstance(value, np.number) else value, kind, key))
    except TypeError:
        raise InvalidValueError(key, f"must be one {kind}", value) from None


def _positive(value: Any, kind: str, key: str) -> float:
    return float(positive(_float(value, kind, key), kind, key))


def _angle(value: Any, key: str) -> float | None:
    return None if value is None else _float(value, "angle", key)


def _points(values: Any, closed: bool) -> tuple[tuple[float, float], ...]:
    try:
        several = list(values)
    except TypeError:
        remedy = "Write for instance [(0, 0), (0.1, 0.05)]."
        raise InvalidValueError("points", "must be a list of points", values, remedy) from None
    points = [point(value, f"points[{i}]") for i, value in enumerate(several)]
    kept = [here for i, here in enumerate(points) if i == 0 or here != points[i - 1]]
    if closed and len(kept) > 1 and kept[0] == kept[-1]:
        kept.pop()
    least = 3 if closed else 2
    if len(kept) < least:
        rule = f"must hold at least {least} different points"
        raise InvalidValueError("points", rule, points, "Give more points, or take a Straight.")
    return tuple(kept)


def _keep(piece: Any, name: str, value: Any) -> None:
    object.__setattr__(piece, name, value)
