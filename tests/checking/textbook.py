"""A ball on a tilted turntable by the textbook's closed form, with the mistakes that people make with it.

With the path as a complex number z, z̈ = iκż + P, where κ = ωk/(1 + k) and P = g sin α/(1 + k).
Nothing of trundle is used.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import trundle as tr

from .theirs import integrated, only, turned, vectors, with_parts

A, M, SOLID, SHELL = 0.025, 0.5, 0.4, 2 / 3
STANDARD, SCHOOL = 9.80665, 9.81
MISTAKES = {
    "table-motion-ignored": "table forgotten",
    "sign-of-table-rate": "−ω",
    "puck": "no friction",
    "wrong-inertia-ratio": "k = 2/3",
    "rolling-factor": "1/(1 + k) missing on gravity",
    "circle-upside-down": "7/2 for 2/7",
    "coriolis-for-rolling": "Coriolis, 2ω",
    "tilt-left-out": "no tilt",
    "body-axes-for-space-axes": "Ω along the body's axes",
}


def system(omega: float, tilt: float, *, gravity: float = STANDARD) -> tr.RollingSystem:
    table = tr.Support(tr.Plane(), motion=tr.Spin(omega), tilt=tilt)
    return tr.RollingSystem(tr.Body.solid_sphere(radius=A, mass=M), table, gravity=gravity)


def data(
    omega: float,
    tilt: float,
    *mistakes: str,
    g: float = STANDARD,
    duration: float = 2.0,
    every: float = 0.01,
    parts: str = "vwq",
) -> dict[str, Any]:
    """Return the columns of a run with some mistakes in it."""
    t = np.arange(0.0, duration, every)
    k = SHELL if "wrong-inertia-ratio" in mistakes else SOLID
    known = 0.0 if "table-motion-ignored" in mistakes else -omega if "sign-of-table-rate" in mistakes else omega
    kappa, pull = known * k / (1 + k), g * np.sin(tilt) / (1 + k)
    if "circle-upside-down" in mistakes:
        kappa = known * (1 + k) / k
    if "coriolis-for-rolling" in mistakes:
        kappa = 2 * known
    if "rolling-factor" in mistakes or "puck" in mistakes:
        pull = g * np.sin(tilt)
    if "puck" in mistakes:
        kappa = 0.0
    if "tilt-left-out" in mistakes:
        pull = 0.0
    z, v = _path(t, 0.1 + 0.05j, 0.1 - 0.2j, kappa, pull)
    w = 1j * (v - 1j * known * z) / A  # n×(V − u)/a
    if "puck" in mistakes:
        w = np.full_like(w, w[0])
    found: dict[str, Any] = {"t": t}
    for stem, plane, normal in (("", z, A), ("v", v, 0.0), ("w", w, 3.0)):
        found = with_parts(found, stem, np.column_stack([plane.real, plane.imag, np.full(t.size, normal)]))
    body = "body-axes-for-space-axes" in mistakes
    if body or "q" in parts:
        found = with_parts(found, "q", integrated(found, body_axes=False))
    if body:
        Q = np.array([turned(q) for q in vectors(found, "q")])
        found = with_parts(found, "w", np.einsum("nji,nj->ni", Q, vectors(found, "w")))
    return only(found, parts)


def _path(t: Any, z0: complex, v0: complex, kappa: float, pull: float) -> tuple[Any, Any]:
    if kappa == 0:
        return z0 + v0 * t + 0.5 * pull * t**2, v0 + pull * t
    drift = pull / (-1j * kappa)
    turn = np.exp(1j * kappa * t)
    return z0 + drift * t + (v0 - drift) * (turn - 1) / (1j * kappa), (v0 - drift) * turn + drift


def painted(found: dict[str, Any], axis: tuple[float, float, float], angle: float) -> dict[str, Any]:
    """Return Ω along the axes of a body that starts turned."""
    unit = np.array(axis) / np.linalg.norm(axis)
    start = turned(np.array([np.cos(angle / 2), *(np.sin(angle / 2) * unit)]))
    return with_parts(found, "w", vectors(found, "w") @ start)


def shaken(found: dict[str, Any], sigma: float, seed: int) -> dict[str, Any]:
    """Return columns with the noise of a camera: σ of each position, 2σ/s of each speed, and as much at the rim."""
    draw = np.random.default_rng(seed)
    sizes = {"x": sigma, "y": sigma, "z": sigma, "v": 2 * sigma, "w": 2 * sigma / A, "q": 0.2 * sigma / A}
    seen = {
        name: array if name == "t" else array + draw.normal(scale=sizes[name[0]], size=array.size)
        for name, array in found.items()
    }
    if "qw" not in seen:
        return seen
    q = vectors(seen, "q")
    return with_parts(seen, "q", q / np.linalg.norm(q, axis=1, keepdims=True))
