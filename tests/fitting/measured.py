"""Measured motion as nobody in the package makes it: formulas and a plain integration, with seeded noise."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import trundle as tr

Array = NDArray[np.float64]
G, RADIUS, MASS = 9.80665, 0.025, 0.065


def scenario(**tables: Any) -> tr.Scenario:
    """A ball at rest on a level plane at rest, unless told otherwise; the table of the body or support in whole."""
    given = {
        "body": {"kind": "sphere", "radius": RADIUS, "mass": MASS, "inertia_ratio": 0.4},
        "support": {"kind": "plane"},
        "start": {"position": [0.0, 0.0]},
        "run": {"duration": 10.0, "every": 0.05},
    }
    return tr.Scenario.read({**given, **tables}, "measured")


def ball(ratio: float) -> dict[str, Any]:
    return {"kind": "sphere", "radius": RADIUS, "mass": MASS, "inertia_ratio": ratio}


def turntable(rate: float, tilt: float = 0.0, **more: Any) -> dict[str, Any]:
    return {"kind": "plane", "tilt": tilt, "motion": {"kind": "spin", "rate": rate}, **more}


def on_turntable(
    t: Array,
    rate: float,
    k: float = 0.4,
    tilt: float = 0.0,
    drag: float = 0.0,
    place: complex = 0.1,
    speed: complex = 0.15j,
) -> Array:
    """The path on a table that turns and leans by Milne's formula, with linear drag: ζ̈ = λζ̇ + φ, by hand."""
    lam = 1j * rate * k / (1 + k) - drag / (MASS * (1 + k))
    push = G * np.sin(tilt) / (1 + k)
    grown = np.expm1(lam * t)
    return place + grown / lam * speed + (grown - lam * t) / lam**2 * push


def down_incline(t: Array, tilt: float, k: float, speed: float = 0.0) -> Array:
    """Galileo's law, the acceleration g sin α/(1 + k)."""
    return speed * t + 0.5 * G * np.sin(tilt) / (1 + k) * t**2


def in_hollow(t: Array, radius: float, k: float, angle: float, rate: float = 0.0) -> Array:
    """The angle of a ball that rolls in a hollow circle, as a pendulum of length (1 + k)(R − a)."""
    length = (1 + k) * (radius - RADIUS)

    def law(_: float, y: Array) -> list[float]:
        return [y[1], -G / length * np.sin(y[0])]

    return np.asarray(solve_ivp(law, (0.0, t[-1]), [angle, rate], t_eval=t, rtol=1e-11, atol=1e-13).y[0])


def seen(t: Array, noise: float, seed: int, **columns: Array) -> dict[str, Array]:
    """Columns with normal noise; complex ones are x and y."""
    draw = np.random.default_rng(seed)
    table: dict[str, Array] = {"t": t}
    for name, column in columns.items():
        parts = {"x": column.real, "y": column.imag} if np.iscomplexobj(column) else {name: column}
        table |= {part: values + draw.normal(scale=noise, size=t.size) for part, values in parts.items()}
    return table
