"""What Chaplygin's balls have in common: a sphere about its centre of mass, on a level plane at rest."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from ...mechanics.algebra import Matrix, Quaternion, Vector
from ...mechanics.records import remembered
from ...mechanics.scalars import namespace
from ...mechanics.shapes import concentric_sphere
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from .domain import ALONG_NORMAL, AT_REST, CONSTANT_LOADS, PRESSED, START, Condition, on, that
from .finding import Finding
from .fits import Array, Seen, crossings

_EQUAL = 1e-15  # share of a moment by which two that are equal may differ after rounding

Axes = tuple[tuple[float, float, float], ...]


def _still(system: RollingSystem, start: State) -> Iterator[str]:  # noqa: ARG001
    if not any(start.angular_velocity):
        yield "the ball does not turn"


CHAPLYGIN_BALL = (
    that(
        lambda system: concentric_sphere(system.body.shape),
        "a ball with its centre of mass at its centre",
        "the body is no sphere with its centre of mass at its centre",
    ),
    that(
        lambda system: not system.body.is_isotropic_sphere,
        "",
        "the ball has the same moment of inertia about every axis",
    ),
)
ON_LEVEL_PLANE = (on(Plane), AT_REST, CONSTANT_LOADS, ALONG_NORMAL, PRESSED)
TURNS = Condition("", _still, START)


@remembered
def principal_axes(body: Any) -> tuple[tuple[float, float, float], Axes]:
    """Return a body's principal moments of inertia and their axes.

    Examples
    --------
    >>> import trundle as tr
    >>> principal_axes(tr.Body(1.0, tr.Principal(3e-3, 4e-3, 5e-3), tr.Sphere(0.1)))[0]
    (0.003, 0.004, 0.005)
    """
    J = np.array([[float(part) for part in row] for row in body.inertia_in_space(Matrix.identity()).rows])
    if not (J - np.diag(np.diag(J))).any():
        moments, axes = np.diag(J), np.eye(3)
    else:
        moments, axes = np.linalg.eigh(J)
        axes = axes * np.array([1.0, 1.0, np.sign(np.linalg.det(axes))])
    first, second, third = (float(moment) for moment in moments)
    return (first, second, third), tuple((float(x), float(y), float(z)) for x, y, z in axes.T)


def two_are_equal(moments: tuple[float, float, float]) -> int | None:
    """Return which of three moments of inertia differs from two that are equal to rounding.

    Examples
    --------
    >>> two_are_equal((2.0, 3.0, 2.0)), two_are_equal((1.0, 2.0, 3.0))
    (1, None)
    """
    for i in range(3):
        first, second = moments[(i + 1) % 3], moments[(i + 2) % 3]
        if abs(first - second) <= _EQUAL * max(first, second):
            return i
    return None


def body_quaternion(axes: Axes) -> Quaternion:
    """Return the turn from a body's principal axes to its frame.

    Examples
    --------
    >>> body_quaternion(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    Quaternion(w=1.0, x=0.0, y=0.0, z=0.0)
    """
    first, second, third = (Vector(*axis) for axis in axes)
    return Quaternion.of_matrix(Matrix(first, second, third).transpose)


def stance_of(before: Vector, now: Vector) -> Quaternion:
    """Return the shortest turn that takes one unit vector to another.

    Examples
    --------
    >>> stance_of(Vector(0.0, 0.0, 1.0), Vector(0.0, 0.0, -1.0)).matrix() @ Vector(0.0, 0.0, 1.0)
    Vector(x=0.0, y=0.0, z=-1.0)
    """
    across = min((Vector(1.0, 0.0, 0.0), Vector(0.0, 1.0, 0.0)), key=lambda e: abs(before.dot(e))).cross(before)
    axis, cosine = before.cross(now), before.dot(now)
    size = now.dot(now) + cosine
    xp = namespace(size)
    opposite = size < 1e-12  # 4e-13 of the turn is left out, by which no force changes that shows
    w = xp.where(opposite, 0 * size, size)
    x, y, z = (xp.where(opposite, away + 0 * size, part + 0 * size) for away, part in zip(across, axis, strict=True))
    length = xp.sqrt(w * w + x * x + y * y + z * z)
    return Quaternion(w / length, x / length, y / length, z / length)


def turning_faster(name: str, predicted: float, seen: Seen) -> tuple[Finding, Array] | None:
    """Compare the time from one rise of |Ω| to the next, and return when it rises; None where |Ω| stays the same."""
    square = np.sum(seen.at.angular_velocity**2, axis=1)
    low, high = float(np.min(square)), float(np.max(square))
    if not math.isfinite(predicted) or high - low <= 1e-9 * high:
        return None
    times = crossings(seen.time, square - 0.5 * (low + high))
    measured = float((times[-1] - times[0]) / (len(times) - 1)) if len(times) > 1 else None
    note = "from one rise of |Ω| to the next" if measured else "the run shows less than one"
    return Finding(name, "T", predicted, measured, "s", note=note, said="turns faster every {}"), times
