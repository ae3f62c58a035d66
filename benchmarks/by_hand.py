"""Coin, rattleback and ball in a spinning bowl, written by hand for the peers; nothing of trundle's is in it.

Each is what one would write who wants this one problem to be fast: the coin in Euler's angles, the rattleback in body
axes, the ball in axes that turn with the bowl. A state's numbers become the contact point and the orientation,
(p_x, p_y, p_z, q_w, q_x, q_y, q_z), by `Problem.seen`, which is not timed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
G = 9.80665
Rates = Callable[..., tuple[Any, ...]]
FLOATS = SimpleNamespace(sqrt=math.sqrt, sin=math.sin, cos=math.cos, number=float)


@dataclass(frozen=True)
class Problem:
    """Equations of motion for one system.

    Parameters
    ----------
    size : int
        Of the state.
    rates : callable
        (functions) -> the rates, a function of as many scalars; `functions` has sqrt, sin, cos and number.
    begin : callable
        (p, q, Ω) of the start in the inertial frame -> the state.
    seen : callable
        (times, states) -> (n, 7), contact point and orientation in the inertial frame.
    """

    size: int
    rates: Callable[[Any], Rates]
    begin: Callable[[Array, Array, Array], Array]
    seen: Callable[[Array, Array], Array]


def coin(radius: float, mass: float, across: float, about: float) -> Problem:
    """A thin disc on a level plane, its state (θ, ψ, φ, w₁, w₂, w₃, x, y).

    e₁ is horizontal along the rim at the contact, e₃ the disc's axis at the angle θ from the vertical, e₂ = e₃×e₁. With
    Ω = w and the frame's own W = w₂ cot θ about e₃, the reaction eliminated,
    (A + ma²) ẇ₁ = A W w₂ − (C + ma²) w₂w₃ − mga cos θ,  A ẇ₂ = (C w₃ − A W) w₁,  (C + ma²) ẇ₃ = ma² w₁w₂.
    """

    def rates(f: Any) -> Rates:
        sin, cos = f.sin, f.cos
        A, C, inertia = f.number(across), f.number(about), f.number(mass * radius * radius)
        a, weight, turned = f.number(radius), f.number(mass * G * radius), f.number(1.0)
        lean, roll, per_across = turned / (A + inertia), inertia / (C + inertia), turned / A

        def rates_of(theta: Any, psi: Any, phi: Any, w1: Any, w2: Any, w3: Any, x: Any, y: Any) -> tuple[Any, ...]:  # noqa: ARG001
            s, c = sin(theta), cos(theta)
            heading = w2 / s
            W = heading * c
            rolled = w3 - W
            return (
                w1,
                heading,
                rolled,
                (A * W * w2 - (C + inertia) * w2 * w3 - weight * c) * lean,
                (C * w3 - A * W) * w1 * per_across,
                roll * w1 * w2,
                -a * rolled * cos(psi),
                -a * rolled * sin(psi),
            )

        return rates_of

    def begin(p: Array, q: Array, Omega: Array) -> Array:
        Q = matrix(q)
        theta = math.acos(Q[2, 2])
        psi = math.atan2(Q[0, 2], -Q[1, 2])  # e₃ = (sin θ sin ψ, −sin θ cos ψ, cos θ)
        phi = math.atan2(Q[2, 0], Q[2, 1])
        e1 = np.array([math.cos(psi), math.sin(psi), 0.0])
        frame = np.array([e1, np.cross(Q[:, 2], e1), Q[:, 2]])
        return np.array([theta, psi, phi, *(frame @ Omega), p[0], p[1]])

    def seen(times: Array, states: Array) -> Array:  # noqa: ARG001
        theta, psi, phi = (states[:, j] / 2 for j in range(3))
        q = [np.cos(theta) * np.cos(psi + phi), np.sin(theta) * np.cos(psi - phi)]
        q += [np.sin(theta) * np.sin(psi - phi), np.cos(theta) * np.sin(psi + phi)]
        return np.stack([states[:, 6], states[:, 7], 0 * theta, *q], axis=1)

    return Problem(8, rates, begin, seen)


def rattleback(mass: float, moments: Any, product: float, axes: Any, centre: float) -> Problem:
    """An ellipsoid on a level plane, its centre over the centre of mass; the state is (q, ω, x, y), ω on body axes.

    γ is the vertical on body axes, ρ(γ) points to the contact, and with ρ' its rate there and v = ρ×ω,
    [J + m(ρ² − ρρᵀ)] ω̇ = −ω×Jω + mρ×(ρ'×ω + ω×v + gγ).
    """

    def rates(f: Any) -> Rates:
        sqrt, number = f.sqrt, f.number
        m, g, rise = number(mass), number(G), number(centre)
        Jx, Jy, Jz, Jxy = (number(value) for value in (*moments, product))
        Ax, Ay, Az = (number(axis * axis) for axis in axes)
        half, one, two = number(0.5), number(1.0), number(2.0)

        def rates_of(qw: Any, qx: Any, qy: Any, qz: Any, wx: Any, wy: Any, wz: Any, x: Any, y: Any) -> tuple[Any, ...]:  # noqa: ARG001
            gx, gy, gz = two * (qx * qz - qw * qy), two * (qy * qz + qw * qx), one - two * (qx * qx + qy * qy)
            ux, uy, uz = gy * wz - gz * wy, gz * wx - gx * wz, gx * wy - gy * wx  # γ' = γ×ω
            bx, by, bz = Ax * gx, Ay * gy, Az * gz
            h = one / sqrt(bx * gx + by * gy + bz * gz)
            rx, ry, rz = -bx * h, -by * h, rise - bz * h
            e = (bx * ux + by * uy + bz * uz) * h * h
            dx, dy, dz = -h * (Ax * ux - bx * e), -h * (Ay * uy - by * e), -h * (Az * uz - bz * e)
            vx, vy, vz = ry * wz - rz * wy, rz * wx - rx * wz, rx * wy - ry * wx
            ax = dy * wz - dz * wy + wy * vz - wz * vy + g * gx
            ay = dz * wx - dx * wz + wz * vx - wx * vz + g * gy
            az = dx * wy - dy * wx + wx * vy - wy * vx + g * gz
            Lx, Ly, Lz = Jx * wx + Jxy * wy, Jxy * wx + Jy * wy, Jz * wz
            kx = m * (ry * az - rz * ay) - (wy * Lz - wz * Ly)
            ky = m * (rz * ax - rx * az) - (wz * Lx - wx * Lz)
            kz = m * (rx * ay - ry * ax) - (wx * Ly - wy * Lx)
            xx, yy, zz = rx * rx, ry * ry, rz * rz
            a, b, c = Jx + m * (yy + zz), Jy + m * (xx + zz), Jz + m * (xx + yy)
            d, s, t = Jxy - m * rx * ry, -m * rx * rz, -m * ry * rz
            A, B, C = b * c - t * t, a * c - s * s, a * b - d * d
            D, S, T = s * t - d * c, d * t - b * s, d * s - a * t
            share = one / (a * A + d * D + s * S)
            return (
                -half * (qx * wx + qy * wy + qz * wz),
                half * (qw * wx + qy * wz - qz * wy),
                half * (qw * wy + qz * wx - qx * wz),
                half * (qw * wz + qx * wy - qy * wx),
                (A * kx + D * ky + S * kz) * share,
                (D * kx + B * ky + T * kz) * share,
                (S * kx + T * ky + C * kz) * share,
                (one - two * (qy * qy + qz * qz)) * dx
                + two * (qx * qy - qw * qz) * dy
                + two * (qx * qz + qw * qy) * dz,
                two * (qx * qy + qw * qz) * dx
                + (one - two * (qx * qx + qz * qz)) * dy
                + two * (qy * qz - qw * qx) * dz,
            )

        return rates_of

    def begin(p: Array, q: Array, Omega: Array) -> Array:
        return np.array([*q, *(matrix(q).T @ Omega), p[0], p[1]])

    def seen(times: Array, states: Array) -> Array:
        return np.stack([states[:, 7], states[:, 8], 0 * times, *states[:, :4].T], axis=1)

    return Problem(9, rates, begin, seen)


def ball_in_bowl(radius: float, inertia_ratio: float, axes: Any, rate: float) -> Problem:
    """A ball in an ellipsoid that spins about the vertical: (p, q, Ω) on axes that turn with it, the bowl at rest.

    With Ω_r = Ω − ω, v = aΩ_r×n, (1 + aS) w = v, ṅ = S w, the force of inertia f = 2ω×v + ω×(ω×r) and gravity,
    (1 + k) a² Ω̇ = G + n (n·G)/k,  G = −ka² ω×Ω − a n×(aΩ_r×ṅ + f + g z).
    """

    def rates(f: Any) -> Rates:
        sqrt, number = f.sqrt, f.number
        a, k, w, g = (number(value) for value in (radius, inertia_ratio, rate, G))
        K, L, M = (number(axes[2] / axis**2) for axis in axes)  # the level is z − ½(Kx² + Ly² + Mz²)
        half, one, two = number(0.5), number(1.0), number(2.0)
        share, per_k = one / (a * a * (one + k)), one / k

        def rates_of(
            px: Any, py: Any, pz: Any, qw: Any, qx: Any, qy: Any, qz: Any, Ox: Any, Oy: Any, Oz: Any
        ) -> tuple[Any, ...]:
            sx, sy, sz = -K * px, -L * py, one - M * pz
            per = one / sqrt(sx * sx + sy * sy + sz * sz)
            nx, ny, nz = sx * per, sy * per, sz * per
            rz = Oz - w
            vx, vy, vz = a * (Oy * nz - rz * ny), a * (rz * nx - Ox * nz), a * (Ox * ny - Oy * nx)
            # On the tangent plane (1 + aS) w = v with S = −P diag(K, L, M) P per; so (1 − a per D) w = v + λn, n·w = 0.
            t = a * per
            dx, dy, dz = one / (one - t * K), one / (one - t * L), one / (one - t * M)
            lam = (dx * nx * vx + dy * ny * vy + dz * nz * vz) / (dx * nx * nx + dy * ny * ny + dz * nz * nz)
            wx, wy, wz = dx * (vx - lam * nx), dy * (vy - lam * ny), dz * (vz - lam * nz)
            # ṅ = S w, and a ṅ = v − w
            ex, ey, ez = vx - wx, vy - wy, vz - wz
            fx = Oy * ez - rz * ey - two * w * vy - w * w * (px + a * nx)
            fy = rz * ex - Ox * ez + two * w * vx - w * w * (py + a * ny)
            fz = Ox * ey - Oy * ex + g
            c = k * a * a * w
            Gx, Gy, Gz = c * Oy - a * (ny * fz - nz * fy), -c * Ox - a * (nz * fx - nx * fz), -a * (nx * fy - ny * fx)
            normal = (nx * Gx + ny * Gy + nz * Gz) * per_k
            return (
                wx,
                wy,
                wz,
                -half * (Ox * qx + Oy * qy + rz * qz),
                half * (Ox * qw + Oy * qz - rz * qy),
                half * (Oy * qw + rz * qx - Ox * qz),
                half * (rz * qw + Ox * qy - Oy * qx),
                (Gx + nx * normal) * share,
                (Gy + ny * normal) * share,
                (Gz + nz * normal) * share,
            )

        return rates_of

    def begin(p: Array, q: Array, Omega: Array) -> Array:
        return np.array([*p, *q, *Omega])  # the two frames agree at time 0

    def seen(times: Array, states: Array) -> Array:
        x, y, z, qw, qx, qy, qz = states[:, :7].T
        c, s = np.cos(rate * times), np.sin(rate * times)
        h, e = np.cos(rate * times / 2), np.sin(rate * times / 2)
        turned = [h * qw - e * qz, h * qx - e * qy, h * qy + e * qx, h * qz + e * qw]
        return np.stack([c * x - s * y, s * x + c * y, z, *turned], axis=1)

    return Problem(10, rates, begin, seen)


def matrix(q: Array) -> Array:
    """Return the rotation matrix of a unit quaternion."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def for_numba(problem: Problem) -> Callable[[float, Array], Array]:
    """Return the equations compiled by numba, scalar code throughout, as SciPy takes them: (t, y) -> rates."""
    import numba

    j = range(problem.size)
    source = [
        "def compiled(t, y):",
        f"    result = np.empty({problem.size})",
        f"    {', '.join(f'result[{i}]' for i in j)} = scalar({', '.join(f'y[{i}]' for i in j)})",
        "    return result",
    ]
    place: dict[str, Any] = {"np": np, "scalar": numba.njit(problem.rates(FLOATS))}
    exec("\n".join(source), place)  # noqa: S102  the four lines above
    return numba.njit("float64[::1](float64, float64[::1])")(place["compiled"])


def reference(problem: Problem, begin: Array, times: Array) -> Array:
    """Integrate the equations with 80-bit numbers, by Taylor series at 1e-19."""
    wide = np.longdouble
    return for_heyoka(problem, begin, wide, 1e-19).propagate_grid(times.astype(wide))[-1]


def for_heyoka(problem: Problem, begin: Array, number: Any = float, tolerance: float = 1e-15) -> Any:
    """Return heyoka's integrator of the equations, in compact mode, as ours."""
    import heyoka

    functions = SimpleNamespace(
        sqrt=heyoka.sqrt, sin=heyoka.sin, cos=heyoka.cos, number=lambda value: heyoka.expression(number(value))
    )
    variables = heyoka.make_vars(*(f"y{j}" for j in range(problem.size)))
    equations = list(zip(variables, problem.rates(functions)(*variables), strict=True))
    return heyoka.taylor_adaptive(
        equations, begin.astype(number), fp_type=number, tol=number(tolerance), compact_mode=True
    )
