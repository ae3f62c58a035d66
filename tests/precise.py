"""Numbers of many digits: with them a difference quotient is as good as a derivative."""

from __future__ import annotations

import functools
import random
from collections.abc import Callable
from typing import Any

import mpmath

from trundle.mechanics.algebra import Matrix, Quaternion, Vector

DIGITS = 60
_STEP = "1e-15"  # a central difference with it is good to about 30 digits


def precisely(test: Callable[..., Any]) -> Callable[..., Any]:
    """Run a test with mpmath at `DIGITS` digits."""

    @functools.wraps(test)
    def run(*args: Any, **kwargs: Any) -> Any:
        with mpmath.workdps(DIGITS):
            return test(*args, **kwargs)

    return run


def slope(function: Callable[[Any], Any], at: Any = 0) -> Any:
    """Return the derivative of a scalar, Vector or Matrix function by a central difference."""
    h = mpmath.mpf(_STEP)
    return (function(at + h) - function(at - h)) * (1 / (2 * h))


def numbers(seed: Any, count: int, size: float = 1.0) -> list[Any]:
    """Return numbers between −size and size that are floats, as mpmath's, so that both kinds can start from them."""
    draw = random.Random(seed)  # noqa: S311
    return [mpmath.mpf(draw.uniform(-size, size)) for _ in range(count)]


def vectors(seed: Any, count: int, size: float = 1.0) -> list[Vector]:
    """Return vectors with such components."""
    parts = iter(numbers(seed, 3 * count, size))
    return [Vector(x, y, z) for x, y, z in zip(parts, parts, parts, strict=True)]


def unit(v: Vector) -> Vector:
    """Return the direction of a vector."""
    return v / v.norm()


def directions(seed: Any, count: int) -> list[Vector]:
    """Return unit vectors."""
    return [unit(v) for v in vectors(seed, count)]


def quaternions(seed: Any, count: int) -> list[Quaternion]:
    """Return unit quaternions."""
    parts = iter(numbers(seed, 4 * count))
    found = []
    for four in zip(parts, parts, parts, parts, strict=True):
        length = mpmath.sqrt(sum(part * part for part in four))
        found.append(Quaternion(*(part / length for part in four)))
    return found


def across(n: Vector) -> tuple[Vector, Vector]:
    """Return two unit vectors that are perpendicular to a unit vector and to each other."""
    helper = Vector(1, 0, 0) if abs(n.x) < abs(n.y) else Vector(0, 1, 0)
    first = unit(n.cross(helper))
    return first, n.cross(first)


def turn(rotation_vector: Vector) -> Quaternion:
    """Return the rotation by the length of a vector about it."""
    angle = rotation_vector.norm()
    if angle == 0:
        return Quaternion(mpmath.mpf(1), mpmath.mpf(0), mpmath.mpf(0), mpmath.mpf(0))
    return Quaternion(mpmath.cos(angle / 2), *(rotation_vector * (mpmath.sin(angle / 2) / angle)))


def size_of(thing: Vector | Matrix) -> Any:
    """Return the largest component."""
    rows = thing.rows if isinstance(thing, Matrix) else (thing,)
    return max(abs(part) for row in rows for part in row)


def floats(thing: Any) -> Any:
    """Return the same vector, matrix or quaternion in floats."""
    if isinstance(thing, Matrix):
        return Matrix(*(floats(row) for row in thing.rows))
    return type(thing)(*(float(part) for part in thing))
