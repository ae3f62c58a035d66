"""Routh's pair of linear integrals of a sphere that rolls on a surface of revolution (theory page, section 6).

A sphere with the same inertia I = k m a² about every axis rolls on a surface of revolution that turns at a steady ω
about its axis, under loads with a potential that a turn about the axis leaves alone. Let n be the normal and κ, κ_φ the
curvatures of the surface along the meridian and across it, R_p and R = R_p + a n_R the distances of contact and
centre from the axis, σ the length of the contact's way along the meridian, positive along (n_z, −n_R). With the
centre's ℓ = R V_φ and the spin w = a Ω·n, the parts of I Ω̇ = ρ×(m V̇ − F) across the meridian and along n are

    dℓ/dσ = k/(1 + k) R (κ w + ω n_z)        dw/dσ = [n_R (1 + a κ)/R − κ] ℓ/R + κ ω R_p

without the time: a linear equation along the meridian, whose constants of integration are two integrals linear in the
velocities ([routh1905]; [borisov2002] for the turning surface).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ..algebra import Vector
from ..symmetry import symmetric_potential, without_torque
from ..system import RollingSystem
from .base import ROLLING, Invariant, Record

_NEAREST = 1e-4  # that the centre may come to the axis, as a share of its largest distance from it
_ON_AXIS = 1e-100  # of the radius: nearer, the squares of what is worked out vanish
_TOLERANCE = 1e-13
_STEPS = 48  # of the meridian's stretch, or of R where that is longer: its dense output is then as good as its steps
_BESIDE = 1e-13  # of a contact's distance from the origin, from the surface: rounding
_BEGIN = (0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)  # way from the start, solutions by rows, the one that starts at zero
_ROWS = (0, 0), (0, 1), (1, 0), (1, 1), (0, 2), (1, 2)  # where the last six of these stand in a matrix
_WIDER = 8  # times that the stretch is widened, each time to twice what it was
_GRID = 2001  # contacts, among which the nearest is looked for
_OVER = 0.05  # of a round, by which its solutions go beyond it to either side
_BACK = 3  # of the grid's steps: so near to where it begins, a meridian has come back


def _has_pair(system: RollingSystem) -> tuple[str, ...]:
    surface, body = system.support.surface, system.body
    ball = body.is_isotropic_sphere and body.shape.axis is None
    round_ = bool(surface.axisymmetric) and not surface.flat  # on a plane they are simpler ones
    steady = system.support.motion.steady_rate is not None
    loads = symmetric_potential(system) and all(without_torque(load) for load in system.all_loads)
    return (ROLLING,) if ball and round_ and steady and loads else ()


@dataclass(frozen=True)
class _Pace:
    """How fast centres move at their instants, which tells how often a contact went round a closed meridian."""

    time: Any  # (n,): s, or one for all
    outwards: Any  # (n,): of V, m/s
    upwards: Any  # (n,)


class _Meridian:
    """The linear equation along the meridian, from the latitude of the contact whose centre is nearest to the axis.

    There 1/R is largest and tells each rounding; lengths are counted from there, so that theirs are small. The spin is
    taken times R there: near the axis, w changes by ℓ/R.
    """

    def __init__(self, system: RollingSystem, distance: Any, height: Any, centre: Any, pace: _Pace) -> None:
        import numpy as np

        self.surface, self.a = system.support.surface, float(system.body.radius)
        k = float(system.body.inertia_ratio)
        self.share, self.rate = k / (1 + k), float(system.support.motion.steady_rate or 0.0)
        first = int(np.argmax(centre <= (1 + 1e-6) * centre.min()))  # of those as near, the first
        self.arm = float(centre[first])  # of the centre from the axis
        self.least = 0.5 * self.arm  # where it may come to: on the axis, the equation is singular
        self.start = self._on_surface(Vector(float(distance[first]), 0.0, float(height[first])))
        self.out, self.up = distance - self.start[0], height - self.start[1]
        self.size = float(np.hypot(self.out, self.up).max())
        self.pace, self.first = pace, first

    def _on_surface(self, p: Vector) -> tuple[float, float]:
        """Return where on the surface a contact is meant to be: one that is measured may lie beside it."""
        for _ in range(3):
            step = self.surface.step_onto(p)
            if step.norm() <= _BESIDE * p.norm():
                break
            p += step
        return float(p.x), float(p.z)

    def contact(self, y: Any) -> Vector:
        """Return the contact so far away from the start."""
        return Vector(self.start[0] + y[0], 0.0 * y[0], self.start[1] + y[1])

    def off_axis(self, y: Any) -> float:
        """Return by how much the centre is further from the axis than it may come."""
        p = self.contact(y)
        return float(p.x + self.a * self.surface.normal(p).x - self.least)

    def slopes(self, _: float, y: Any) -> list[float]:
        """Return the slopes of R_p, z, the matrix of solutions (by rows) and the solution that starts at zero."""
        p, arm = self.contact(y), self.arm
        R_p = p.x
        n, S = self.surface.normal(p), self.surface.shape_operator(p)
        along = Vector(n.z, 0.0, -n.x)
        kappa, R = along.dot(S @ along), R_p + self.a * n.x
        up, down = self.share * R * kappa / arm, (n.x * (1 + self.a * kappa) / R - kappa) / R * arm
        turned = (self.share * R * self.rate * n.z, kappa * self.rate * R_p * arm)
        return [
            n.z,
            -n.x,
            up * y[4],
            up * y[5],
            down * y[2],
            down * y[3],
            up * y[7] + turned[0],
            down * y[6] + turned[1],
        ]

    def solve(self, end: float) -> Any:
        """Integrate to a length σ, of either sign, but not across the axis."""
        from scipy.integrate import solve_ivp

        def near_axis(_: float, y: Any) -> float:
            return self.off_axis(y)

        near_axis.terminal = True  # type: ignore[attr-defined]
        return solve_ivp(
            self.slopes,
            (0.0, end),
            _BEGIN,
            method="DOP853",
            rtol=_TOLERANCE,
            atol=1e-3 * _TOLERANCE,
            max_step=max(abs(end), 2 * self.least) / _STEPS,
            dense_output=True,
            events=near_axis,
        )

    def at_each(self) -> Any:
        """Return the solutions at each contact, 8 rows; None where it is unknown how often it went round."""
        import numpy as np

        if self.size <= 1e-12 * max(1e-300, float(np.abs(self.start).max())):
            return np.broadcast_to(np.array([_BEGIN]).T, (8, self.out.size))
        reach = 1.1 * self.size
        for _ in range(_WIDER):
            solutions = self.solve(-reach).sol, self.solve(reach).sol
            length = self._length(solutions)
            if length is not None:
                return self._round(length)
            low, high = _ends(solutions)
            sigma = self._placed(solutions, (low, high))
            if low < sigma.min() and sigma.max() < high:
                break
            reach *= 2
        return _both(solutions, sigma)

    def _length(self, solutions: tuple[Any, Any]) -> float | None:
        """Return the length of a meridian that is closed, if the solutions come round to where they begin."""
        import numpy as np

        grid = np.linspace(*_ends(solutions), _GRID)
        there = _both(solutions, grid)[:2]
        apart = np.hypot(*(there - there[:, :1]))
        back = (apart <= _BACK * (grid[1] - grid[0])) & (np.arange(_GRID) > 2 * _BACK)
        if not back.any():
            return None
        return float(self._closer(solutions, grid[back][:1], *there[:, 0])[0] - grid[0])

    def _round(self, length: float) -> Any:
        """Return the same from one round of a closed meridian, which the solutions of each round repeat in turn."""
        import numpy as np

        solutions = self.solve(-_OVER * length).sol, self.solve((1 + _OVER) * length).sol
        sigma = self._placed(solutions, (0.0, length))
        rounds = self._rounds(sigma, length)
        if rounds is None:
            return None
        rows, once = _both(solutions, sigma), _affine(solutions[1](length))
        for count in np.unique(rounds):
            there = rounds == count
            after = _affine(rows[:, there]) @ np.linalg.matrix_power(once, int(count))
            rows[2:, there] = np.stack([after[:, i, j] for i, j in _ROWS])
        return rows

    def _rounds(self, sigma: Any, length: float) -> Any:
        """Return how often each contact went round since the first, of which its speed decides; None if it is unclear.

        The centre goes by (1 + aκ)σ̇ along its own meridian.
        """
        import numpy as np

        p = self.contact((self.out, self.up))
        n, S = self.surface.normal(p), self.surface.shape_operator(p)
        along = Vector(n.z, 0.0 * n.z, -n.x)
        speed = (self.pace.outwards * along.x + self.pace.upwards * along.z) / (1 + self.a * along.dot(S @ along))
        times = np.broadcast_to(self.pace.time, sigma.shape)
        gone = 0.5 * (speed[1:] + speed[:-1]) * np.diff(times)
        rounds = np.round((gone - np.diff(sigma)) / length)
        if np.abs([gone, np.diff(sigma) + rounds * length]).max(initial=0.0) > 0.25 * length:
            return None
        rounds = np.concatenate([[0.0], np.cumsum(rounds)])
        return (rounds - rounds[self.first]).astype(int)

    def _placed(self, solutions: tuple[Any, Any], between: tuple[float, float]) -> Any:
        """Return the σ of each contact: the nearest of many between two, then Newton's method along the meridian."""
        import numpy as np
        from scipy.spatial import cKDTree

        grid = np.linspace(*between, _GRID)
        there = _both(solutions, grid)[:2]
        nearest = grid[cKDTree(there.T).query(np.column_stack([self.out, self.up]))[1]]
        return self._closer(solutions, nearest, self.out, self.up)

    def _closer(self, solutions: tuple[Any, Any], sigma: Any, out: Any, up: Any) -> Any:
        """Return σ moved along the meridian, by Newton's method, to where given contacts are."""
        import numpy as np

        low, high = _ends(solutions)
        for _ in range(4):
            rows = _both(solutions, sigma)
            n = self.surface.normal(self.contact(rows))
            sigma = np.clip(sigma + (out - rows[0]) * n.z - (up - rows[1]) * n.x, low, high)
        return sigma


def _ends(solutions: tuple[Any, Any]) -> tuple[float, float]:
    """Return how far the solutions lead to either side of the start."""
    return float(solutions[0].t_min), float(solutions[1].t_max)


def _affine(rows: Any) -> Any:
    """Return as a matrix (..., 3, 3) what takes ℓ, w and 1 from the start to where the rows were found."""
    import numpy as np

    matrix = np.zeros((*rows.shape[1:], 3, 3))
    for row, (i, j) in zip(rows[2:], _ROWS, strict=True):
        matrix[..., i, j] = row
    matrix[..., 2, 2] = 1.0
    return matrix


def _both(solutions: tuple[Any, Any], sigma: Any) -> Any:
    import numpy as np

    return np.where(sigma < 0, solutions[0](np.minimum(sigma, 0.0)), solutions[1](np.maximum(sigma, 0.0)))


def _pair(system: RollingSystem, at: Record) -> list[Any]:
    """Return the terms of ℓ and w carried along the meridian to the latitude of the record's first contact.

    None where the centre comes to the axis, at which the equation along the meridian is singular, or where contacts
    that were measured lie so far beside the surface that it seems to, or so far apart that they may have gone round a
    closed meridian in between.
    """
    import numpy as np

    a, r, V = float(system.body.radius), at.motion.position, at.motion.velocity
    n, Omega = system.support.surface.normal(at.contact), at.motion.angular_velocity
    parts = [r.x * V.y, -(r.y * V.x), *(a * x * y for x, y in zip(Omega, n, strict=True))]
    shape = np.broadcast_shapes(*(np.shape(part) for part in (*parts, at.contact.x, at.contact.z)))

    def flat(parts: Iterable[Any]) -> list[Any]:
        return [np.broadcast_to(np.asarray(part, dtype=float), shape).reshape(-1) for part in parts]

    contact, moved, carried = flat(at.contact), flat(V), flat(parts)
    distance, centre = np.hypot(contact[0], contact[1]), np.hypot(*flat((r.x, r.y)))
    if centre.min() <= max(_NEAREST * centre.max(), _ON_AXIS * a):
        return []
    outwards = (contact[0] * moved[0] + contact[1] * moved[1]) / np.maximum(distance, 1e-300)
    times = np.asarray(at.motion.time, dtype=float).reshape(-1)
    meridian = _Meridian(system, distance, contact[2], centre, _Pace(times, outwards, moved[2]))
    if not meridian.off_axis(_BEGIN) > 0:
        return []
    rows = meridian.at_each()
    if rows is None:
        return []
    A, B, C, D, *turned = rows[2:]
    inverse = np.array([[D, -B], [-C, A]]) / (A * D - B * C)
    columns = [inverse[:, 0] * part for part in carried[:2]]
    columns += [inverse[:, 1] * part * meridian.arm for part in carried[2:]]
    columns += [-inverse[:, 0] * turned[0], -inverse[:, 1] * turned[1]]
    first = np.array([[A[0], B[0]], [C[0], D[0]]])
    columns = [first @ column for column in columns]
    columns.append(np.outer([turned[0][0], turned[1][0]], np.ones_like(distance)))
    reach = float(distance[0])  # makes both angular momenta, per mass
    return [(column * np.array([[1.0], [reach / meridian.arm]])).T.reshape(*shape, 2) for column in columns]


ROUTH_PAIR = Invariant(
    "pair of linear integrals of Routh", "R V_φ and a Ω·n, carried along the meridian", "m²/s", _has_pair, _pair
)
