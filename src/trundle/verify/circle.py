"""The circle of a ball on a turntable: its centre and radius stay, and the path alone shows its rate and drift."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ..mechanics.system import RollingSystem, State
from ..solve.exact.circle import Circle, measure
from ..solve.methods import Method
from ..solve.samples import Samples
from .bounds import EXACT, SOLVER, Array, bound_of, turned_in
from .card import CardFigure, checked
from .integrals import drift_of

_FITTED, _CIRCLES_FITTED = 2000, 20  # points and, where they are taken anew, circles


def guiding_centre(circle: Circle, start: State, at: Samples, method: Method) -> Iterator[CardFigure]:
    """Check centre and radius of the circle from positions and velocities: integrals on a turning plane."""
    t, bound = at.time - start.time, bound_of(method, turned_in(at))
    kappa, drift = circle.rate, circle.drift
    if abs(kappa) * float(t[-1]) <= bound:
        return  # of a circle so large these hold whatever the motion
    zeta, rate = (a[:, 0] + 1j * a[:, 1] for a in (at.position, at.velocity))
    arm = -1j * (rate - drift) / kappa
    centre = zeta - arm - drift * t
    size = max(np.abs(zeta).max(), np.abs(arm).max(), np.abs(drift * t).max())
    yield checked(
        "drift of the circle's centre", drift_of(centre, (size,)), bound, "ζ + i(ζ̇ − v_d)/κ − v_d t stays the same"
    )
    yield checked("drift of the circle's radius", drift_of(np.abs(arm), (size,)), bound, "|ζ̇ − v_d|/κ stays the same")


def measured_circle(
    system: RollingSystem, circle: Circle, start: State, samples: Samples, method: Method
) -> Iterator[CardFigure]:
    """Measure rate, centre and drift from the positions alone, beside the formula's."""
    yield CardFigure("circle rate by the formula", circle.rate, "rad/s", note=circle.said)
    turns = abs(circle.rate) * float(samples.time[-1] - start.time) / (2 * math.pi)
    too_little = CardFigure("circle not measured", turns, "turns", note="the run shows too little of the circle")
    if turns <= bound_of(method):
        yield too_little
        return
    t, path = _even_path(system, start, samples, method, abs(circle.rate))
    found = measure(t, path) if circle.arm else None
    if not circle.arm:
        moved = float(np.abs(path - path[0] - circle.drift * t).max())
        size = max(float(np.abs(path).max()), 1e-300)
        yield checked("stays where it was put", moved / size, bound_of(method), "largest departure over the distance")
        return
    if found is None or turns < 0.25 or found.rate_error > 1e-6 * abs(circle.rate):
        yield too_little
        return
    slack = max(10.0, SOLVER * method.tolerance / 2.2e-16)
    for name, value, formula, error, unit in (
        ("circle rate measured", found.rate, circle.rate, found.rate_error, "rad/s"),
        ("centre measured", found.centre, circle.centre, found.centre_error, "m"),
        ("drift measured", found.drift, circle.drift, found.drift_error, "m/s"),
    ):
        scale = max(abs(formula), 1e-300)
        shown = f"{value:.12g} {unit}" if isinstance(value, float) else _pair(value, unit)
        wanted = f"{formula:.12g}" if isinstance(value, float) else _pair(formula, "")
        if abs(formula) <= error:
            yield checked(f"{name}, off the formula's", abs(value - formula), slack * error, f"{shown}", unit)
        else:
            bound = max(slack * error / scale, EXACT)
            note = f"{shown}; formula {wanted}"
            yield checked(f"{name}, off the formula's", abs(value - formula) / scale, bound, note)


def _even_path(
    system: RollingSystem, start: State, samples: Samples, method: Method, kappa: float
) -> tuple[Array, NDArray[np.complex128]]:
    """Return times and path for a fit: the samples at an even step, or new ones where they are too far apart."""
    t = samples.time
    step = float(t[1] - t[0])
    count = t.size - bool(t.size > 2 and t[-1] - t[-2] < 0.999 * step)  # the last may be the run's end
    keep = _fitted(count, step * kappa)
    even = step > 0 and np.allclose(np.diff(t[keep]), keep.step * step, rtol=1e-6)
    if count < 32 or not even or step * kappa > 1:
        span = min(float(t[-1] - start.time), _CIRCLES_FITTED * 2 * math.pi / kappa)
        samples = method.solve(system, start, start.time + np.linspace(0.0, span, _FITTED))
        keep = _fitted(samples.time.size, float(samples.time[1] - samples.time[0]) * kappa)
    place = samples.position[keep]
    return samples.time[keep] - start.time, place[:, 0] + 1j * place[:, 1]


def _fitted(count: int, turned: float) -> slice:
    """Return which of many points to fit, given how far the circle turns from one to the next."""
    stride = max(1, int(0.5 / turned) if turned > 0 else 1, count // _FITTED // 100)
    return slice(0, min(count, stride * _FITTED), stride)


def _pair(value: complex, unit: str) -> str:
    return f"({value.real:.9g}, {value.imag:.9g}) {unit}".rstrip()
