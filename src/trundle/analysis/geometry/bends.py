"""A ball rolled along a line of constant curvature, without pivoting: its orientation in closed form.

A straight line is the arc of curvature 0, and no formula here divides by the curvature.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SMALL = 0.5  # rad; below it θ − sin θ is summed as a series, so that no digits cancel


def displacement(heading: Any, curvature: Any, distance: Any) -> Array:
    """Return how far the contact point has come along a line of constant curvature.

    The chord of an arc that turns by θ = κ s has the length s sin(θ/2)/(θ/2) and points along the mean heading.

    Examples
    --------
    >>> displacement(0.0, 1.0, np.pi).round(12) + 0.0  # half a circle of radius 1 m, to the left
    array([0., 2.])
    """
    half = np.asarray(curvature) * distance / 2
    chord = distance * np.sinc(half / np.pi)
    return np.stack([chord * np.cos(heading + half), chord * np.sin(heading + half)], axis=-1)


def turn(heading: Any, curvature: Any, distance: Any, radius: float) -> Array:
    """Return the rotation of a ball rolled along a line of constant curvature (G2).

    With t the first direction of travel, Ω at unit speed is n × t/a turned about n by κ s. Seen from axes that turn
    with the line it does not change, and there the ball turns at n × t/a − κ n:

        q(s) = exp(½ κ s n) exp(½ s (n × t/a − κ n)) q(0)

    Examples
    --------
    A quarter turn along x brings the north pole to +x, a rotation about y:

    >>> turn(0.0, 0.0, np.pi / 2, 1.0).round(6) + 0.0
    array([0.707107, 0.      , 0.707107, 0.      ])
    """
    heading, curvature, distance = np.broadcast_arrays(heading, curvature, distance)
    scaled = radius * curvature
    size = np.hypot(1.0, scaled)
    half, spin = 0.5 * size * (distance / radius), 0.5 * curvature * distance
    s, c = np.sin(half) / size, np.cos(half)
    x, y, z = -np.sin(heading) * s, np.cos(heading) * s, -scaled * s
    cosine, sine = np.cos(spin), np.sin(spin)
    product = [cosine * c - sine * z, cosine * x - sine * y, cosine * y + sine * x, cosine * z + sine * c]
    return np.stack(product, axis=-1)


def segment_area(curvature: Any, distance: Any) -> Any:
    """Return the area between an arc and its chord, positive where the arc turns to the left.

    Examples
    --------
    >>> bool(abs(segment_area(1.0, np.pi) - np.pi / 2) < 1e-15)  # half a disc
    True
    """
    theta = np.asarray(curvature * distance, dtype=float)
    t2 = theta * theta
    series = 1 / 6 - t2 / 120 * (1 - t2 / 42 * (1 - t2 / 72 * (1 - t2 / 110 * (1 - t2 / 156))))
    large = np.where(np.abs(theta) < _SMALL, 1.0, theta)
    ratio = np.where(np.abs(theta) < _SMALL, theta * series, (large - np.sin(large)) / (large * large))
    return 0.5 * distance * distance * ratio
