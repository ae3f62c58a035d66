"""The path of a ball on a tilted turntable, ten million samples: against memory, and against NumPy's exponential."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

import trundle as tr
from measure import Row, best_times, check, seconds
from trundle.solve.exact import SphereOnPlane

TITLE = "Closed form: 10^7 samples of the path (x, y) on a tilted turntable"

COUNT = 10_000_000
STEP = 1 / 128  # s; a power of two, so that every sampled time is exact for all who are compared
ROUNDS = 7
_BLOCK = 2048  # `path_on_grid` wants room for whole blocks

Array = NDArray[Any]


def rows() -> Iterator[Row]:
    """Measure, and check that the paths agree."""
    table = tr.Support(tr.Plane(), motion=tr.Spin("33.3 rpm"), tilt="0.01 deg")
    system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.51), table)
    motion = SphereOnPlane.of(system, system.place(position=(0.1, 0.0), velocity=(0.0, 0.2)))

    t = np.arange(COUNT) * STEP
    times = t.reshape(1, COUNT)
    room = np.zeros((2, -(-COUNT // _BLOCK) * _BLOCK))  # zeros that are written to: the pages are there beforehand
    room[:] = 1.0
    source, target, compiled_room = (np.full((2, COUNT), float(j)) for j in range(3))
    compiled = motion.compiled()

    kappa, drift = motion.kappa, complex(*motion.drift_velocity)
    centre = complex(*motion.guiding_centre(0.0))
    arm = complex(*motion.position) - centre

    def grid() -> Array:
        return motion.path_on_grid(STEP, COUNT, out=room)

    def one_liner() -> Array:
        return centre + drift * t + arm * np.exp(1j * kappa * t)

    best = best_times(
        {
            "copy": lambda: np.copyto(target, source),
            "grid": grid,
            "grid, new array": lambda: motion.path_on_grid(STEP, COUNT),
            "compiled": lambda: compiled(times, outputs=compiled_room),
            "numpy": one_liner,
        },
        ROUNDS,
    )
    ours, theirs, cfunc = grid(), one_liner(), compiled(times, outputs=compiled_room)
    size = float(np.abs(theirs).max())
    for path in (ours, cfunc):
        apart = max(float(np.abs(path[0] - theirs.real).max()), float(np.abs(path[1] - theirs.imag).max()))
        check(apart < 1e-10 * size, f"the paths must agree; they are {apart:g} m apart")
    index = np.linspace(0, COUNT - 1, 401).astype(int)
    exact = _precise(motion, index)
    errors = [_error(exact, p[0][index], p[1][index]) for p in (ours, cfunc, (theirs.real, theirs.imag))]

    def against(name: str, other: str) -> str:
        return f"{seconds(best[name])} / {seconds(best[other])}"

    yield Row("path_on_grid / np.copyto of the bytes", best["grid"] / best["copy"], most=3, raw=against("grid", "copy"))
    yield Row("NumPy one-liner / path_on_grid", best["numpy"] / best["grid"], least=10, raw=against("numpy", "grid"))
    raw = f"{errors[0]:.1e} m / {errors[2]:.1e} m after {COUNT * STEP * kappa:.0f} rad"
    yield Row("error: path_on_grid / NumPy one-liner", errors[0] / errors[2], most=1, raw=raw)
    fresh = "grid, new array"
    yield Row("path_on_grid into a new array / np.copyto", best[fresh] / best["copy"], raw=against(fresh, "copy"))
    raw = against("numpy", "compiled")
    yield Row("NumPy one-liner / compiled(), at any times", best["numpy"] / best["compiled"], raw=raw)
    raw = f"{errors[1]:.1e} m / {errors[2]:.1e} m"
    yield Row("error: compiled() / NumPy one-liner", errors[1] / errors[2], raw=raw)


def _precise(motion: SphereOnPlane, index: NDArray[np.intp]) -> list[Any]:
    """Return the path at some samples to 50 digits, from the same numbers: the circle about the drifting centre."""
    mpf, mpc = mpmath.mpf, mpmath.mpc
    with mpmath.workdps(50):
        k = mpf(motion.inertia_ratio)
        kappa = mpf(motion.rate) * k / (1 + k)
        push = mpf(motion.force[0]) / (mpf(motion.mass) * (1 + k))  # down the slope, and nothing else
        check(motion.force[1] == 0 and motion.torque == (0.0, 0.0, 0.0), "only the weight may push")
        start, velocity = mpc(*motion.position), mpc(*motion.velocity)
        drift = mpc(0, push / kappa)
        arm = (velocity - drift) / mpc(0, kappa)
        step = mpf(STEP)
        return [start - arm + drift * (step * int(j)) + arm * mpmath.expj(kappa * step * int(j)) for j in index]


def _error(exact: list[Any], x: Array, y: Array) -> float:
    with mpmath.workdps(50):
        apart = (max(abs(z.real - float(a)), abs(z.imag - float(b))) for z, a, b in zip(exact, x, y, strict=True))
        worst = float(max(apart))
    check(math.isfinite(worst), "the path must be finite")
    return worst
