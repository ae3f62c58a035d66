"""Orientation in forty digits: q̇ = ½ Ω q by Taylor series, for a sphere on a plane, from the theory page alone.

The rotation is kept as the first column (a, b) of the matrix w − i(x σ₁ + y σ₂ + z σ₃): a = w − iz, b = y − ix, and
a' = −(i/2)(Ω_z a + W̄ b), b' = −(i/2)(W a − Ω_z b) with W = Ω_x + iΩ_y.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath
from mpmath import mpc, mpf
from tests.reference.t5 import Ball

DIGITS = 45
_ORDER = 46
_TURN_A_STEP = 3.0  # rad: half of it to the power 46 over 46! is 2e-50


def quaternion_product(p: Any, q: Any) -> tuple[Any, ...]:
    """Return the product of two quaternions (w, x, y, z)."""
    a, b, c, d = p
    w, x, y, z = q
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )


def power(q: Any, n: int) -> tuple[Any, ...]:
    """Return qⁿ."""
    result, square = (mpf(1), mpf(0), mpf(0), mpf(0)), tuple(q)
    while n:
        if n & 1:
            result = quaternion_product(result, square)
        square, n = quaternion_product(square, square), n >> 1
    return result


def rotations(ball: Ball, times: Any) -> list[tuple[Any, ...]]:
    """Return the rotations (w, x, y, z) that a ball has made at ascending times: q(t) = rotation · q(0)."""
    with mpmath.workdps(DIGITS):
        return [(a.real, -b.imag, b.real, -a.imag) for a, b in _integrate(ball, [mpf(t) for t in times])]


def _integrate(ball: Ball, times: list[Any]) -> Iterator[tuple[Any, Any]]:
    radius, m, k, omega, c = map(mpf, (ball.radius, ball.mass, ball.inertia_ratio, ball.rate, ball.drag))
    kx, ky, kz = map(mpf, ball.torque)
    lam = mpc(-c / (m * (1 + k)), omega * k / (1 + k))
    phi = (mpc(*ball.force[:2]) + mpc(ky, -kx) / radius) / (m * (1 + k))
    zeta, V, spin = mpc(*ball.position), mpc(*ball.velocity), mpf(ball.spin)
    spin_rate = kz / (k * m * radius**2)
    a, b, now = mpc(1), mpc(0), mpf(0)
    for until in times:
        while now < until:
            turning, growing = 1j * V + omega * zeta, 1j * (lam * V + phi) + omega * V
            fastest = abs(turning) / radius + mpmath.sqrt(abs(growing) / radius) + abs(spin) + abs(spin_rate) + abs(lam)
            h = min(_TURN_A_STEP / (1 + fastest), until - now)
            z = [zeta, V]
            for n in range(_ORDER):
                z.append((lam * (n + 1) * z[n + 1] + (phi if n == 0 else 0)) / ((n + 1) * (n + 2)))
            W = [(1j * (n + 1) * z[n + 1] + omega * z[n]) / radius for n in range(_ORDER)]
            a, b = _step(W, (spin, spin_rate), a, b, h)
            zeta, V = mpmath.polyval(z[::-1], h), mpmath.polyval([n * z[n] for n in range(len(z) - 1, 0, -1)], h)
            spin, now = spin + spin_rate * h, now + h
        yield a, b


def _step(W: list[Any], spin: tuple[Any, Any], a0: Any, b0: Any, h: Any) -> tuple[Any, Any]:
    a, b, half = [a0], [b0], mpc(0, -0.5)
    conjugate = [mpmath.conj(w) for w in W]
    for n in range(_ORDER):
        own_a, own_b = spin[0] * a[n], spin[0] * b[n]
        if n:
            own_a, own_b = own_a + spin[1] * a[n - 1], own_b + spin[1] * b[n - 1]
        other_b = mpmath.fdot(zip(conjugate[: n + 1], reversed(b), strict=True))
        other_a = mpmath.fdot(zip(W[: n + 1], reversed(a), strict=True))
        a.append(half * (own_a + other_b) / (n + 1))
        b.append(half * (other_a - own_b) / (n + 1))
    return mpmath.polyval(a[::-1], h), mpmath.polyval(b[::-1], h)
