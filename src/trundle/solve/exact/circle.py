"""A circle about a centre that drifts, and the same measured from a path alone, without a look at a formula."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Circle:
    """A path ζ(t) = centre + drift·t + arm·e^{iκt}.

    Parameters
    ----------
    rate : float
        κ, rad/s.
    centre, drift, arm : complex
        x + iy: m, m/s and m, at t = 0.
    said : str
        How the rate follows from other numbers.

    Examples
    --------
    >>> Circle(1.0, 0.3j, 0.1 + 0j, 0.5 + 0j).centre_at(2.0)
    (0.2+0.3j)
    """

    rate: float
    centre: complex
    drift: complex
    arm: complex
    said: str = field(default="", kw_only=True)

    def centre_at(self, t: Any) -> Any:
        """Return where the centre is at a time since the start, x + iy, m."""
        return self.centre + self.drift * t


@dataclass(frozen=True)
class MeasuredCircle(Circle):
    """A path fitted by such a circle, with the digits that the fit can have.

    Parameters
    ----------
    rate, centre, drift, arm, said : see Circle
        Fitted.
    rate_error, centre_error, drift_error : float
        What one rounding of the path's coordinates can do to each, rad/s, m, m/s.

    Examples
    --------
    >>> t = np.linspace(0.0, 20.0, 400)
    >>> circle = measure(t, 1.0 + 0.3j + 0.1 * t + 0.5 * np.exp(0.8j * t))
    >>> round(circle.rate, 12), round(abs(circle.arm), 12), round(circle.drift.real, 12)
    (0.8, 0.5, 0.1)
    """

    rate_error: float
    centre_error: float
    drift_error: float


def measure(times: Array, path: NDArray[np.complex128]) -> MeasuredCircle | None:
    """Fit a drifting circle to a path.

    Examples
    --------
    See `MeasuredCircle`.
    """
    if times.size < 8:
        return None
    rate = _first_guess(times, path)
    if rate is None:
        return None
    length, size = float(times[-1]), float(np.abs(path - path.mean()).max())
    for _ in range(12):
        turning = np.exp(1j * rate * times)
        design = np.stack([np.ones_like(turning), times / length, turning], axis=1)
        fit = np.linalg.lstsq(design, path, rcond=None)[0]
        slope = 1j * (times / length) * fit[2] * turning
        step = _real_step(np.column_stack([design, slope]), path - design @ fit)
        rate += step / length
        if abs(step) < 1e-15 * (1 + abs(rate) * length):
            break
    if not np.isfinite(rate):
        return None
    rounding = np.finfo(float).eps * (size + float(np.abs(path).max()))
    errors = _errors(np.column_stack([design, slope]), rounding)
    return MeasuredCircle(
        float(rate),
        complex(fit[0]),
        complex(fit[1] / length),
        complex(fit[2]),
        errors[3] / length,
        errors[0],
        errors[1] / length,
    )


def _first_guess(times: Array, path: NDArray[np.complex128]) -> float | None:
    """Return the rate at which the second differences of the path turn (centre and drift drop out of them)."""
    step = float(times[1] - times[0])
    stride = 1
    while True:  # as wide a stride as the turning of one step allows
        z = path[::stride]
        if z.size < 8:
            return None
        bend = z[2:] - 2 * z[1:-1] + z[:-2]
        if np.abs(bend).max() <= 1e-13 * np.abs(path).max():
            stride *= 2
            continue
        turn = float(np.angle(np.vdot(bend[:-1], bend[1:])))
        if abs(turn) < 0.3 and z.size > 64:
            stride *= 2
            continue
        return turn / (step * stride)


def _real_step(design: NDArray[np.complex128], rest: NDArray[np.complex128]) -> float:
    """Return the change of the rate (a real number) that a linear fit of the rest asks for."""
    others, column = design[:, :3], design[:, 3]
    project = np.linalg.lstsq(others, np.stack([column, rest], axis=1), rcond=None)[0]
    free, left = column - others @ project[:, 0], rest - others @ project[:, 1]
    return float(np.real(np.vdot(free, left)) / max(np.real(np.vdot(free, free)), 1e-300))


def _errors(design: NDArray[np.complex128], rounding: float) -> list[float]:
    """Return what roundings of that size in each point do to each parameter, at worst."""
    inverse = np.linalg.pinv(design)
    return [float(rounding * np.abs(row).sum()) for row in inverse]
