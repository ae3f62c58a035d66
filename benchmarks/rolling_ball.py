"""A ball on a tilted turntable with drag, written by hand for the peers; nothing of trundle's is in it.

No slip: V_x = −ω p_y + a Ω_y and V_y = ω p_x − a Ω_x. Newton and Euler with the reaction eliminated, n the normal:
(1 + k) V̇ = F/m + k ω n×V with F = (push, 0) − c V; then a Ω̇_x = ω V_x − V̇_y and a Ω̇_y = ω V_y + V̇_x. The state is
(p_x, p_y, p_z, q_w, q_x, q_y, q_z, Ω_x, Ω_y, Ω_z), p the contact point.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Law = Callable[..., tuple[Any, ...]]


def law(radius: Any, mass: Any, inertia_ratio: Any, rate: Any, push: Any, drag: Any, *, zero: Any = 0.0) -> Law:
    """Return the rates of the ten numbers as a function of ten scalars, of any kind of number."""
    share = 1 / (mass * (1 + inertia_ratio))
    pushed, slowed, bent = push * share, drag * share, rate * inertia_ratio / (1 + inertia_ratio)
    turned = 1 / radius

    def rates(
        px: Any, py: Any, _: Any, qw: Any, qx: Any, qy: Any, qz: Any, wx: Any, wy: Any, wz: Any
    ) -> tuple[Any, ...]:
        vx, vy = radius * wy - rate * py, rate * px - radius * wx
        ax, ay = pushed - slowed * vx - bent * vy, bent * vx - slowed * vy
        return (
            vx,
            vy,
            zero,
            -0.5 * (wx * qx + wy * qy + wz * qz),
            0.5 * (wx * qw + wy * qz - wz * qy),
            0.5 * (wy * qw + wz * qx - wx * qz),
            0.5 * (wz * qw + wx * qy - wy * qx),
            (rate * vx - ay) * turned,
            (rate * vy + ax) * turned,
            zero,
        )

    return rates


def for_numba(rates: Law) -> Callable[[float, Any], Any]:
    """Return the law compiled by numba, scalar code throughout, as SciPy takes it: (t, y) -> rates."""
    import numba

    scalar = numba.njit(rates)

    @numba.njit("float64[::1](float64, float64[::1])")
    def compiled(t, y):  # type: ignore[no-untyped-def]  # noqa: ARG001  numba reads no hints
        result = np.empty(10)
        (
            result[0],
            result[1],
            result[2],
            result[3],
            result[4],
            result[5],
            result[6],
            result[7],
            result[8],
            result[9],
        ) = scalar(y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7], y[8], y[9])
        return result

    return compiled


def for_jax(rates: Law) -> Callable[[Any, Any, Any], Any]:
    """Return the law as diffrax takes it: (t, y, args) -> rates."""
    import jax.numpy as jnp

    def stacked(t: Any, y: Any, args: Any) -> Any:  # noqa: ARG001
        return jnp.stack([jnp.asarray(rate, dtype=y.dtype) for rate in rates(*(y[j] for j in range(10)))])

    return stacked
