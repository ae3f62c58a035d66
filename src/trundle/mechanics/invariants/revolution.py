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
_WIDER = 8  # times that the stretch is widened, each time to twice what it was


def _has_pair(system: RollingSystem) -> tuple[str, ...]:
    surface, body = system.support.surface, system.body
    ball = body.is_isotropic_sphere and body.shape.axis is None
    round_ = bool(surface.axisymmetric) and not surface.flat  # on a plane they are simpler ones
    steady = system.support.motion.steady_rate is not None
    loads = symmetric_potential(system) and all(without_torque(load) for load in system.all_loads)
    return (ROLLING,) if ball and round_ and steady and loads else ()


class _Meridian:
    """The linear equation along the meridian, from the latitude of the contact whose centre is nearest to the axis.

    There 1/R is largest and tells each rounding; lengths are counted from there, so that theirs are small.
    """

    def __init__(self, system: RollingSystem, distance: Any, height: Any, centre: Any) -> None:
        import numpy as np

        self.surface, self.a = system.support.surface, float(system.body.radius)
        k = float(system.body.inertia_ratio)
        self.share, self.rate = k / (1 + k), float(system.support.motion.steady_rate or 0.0)
        first = int(np.argmax(centre <= (1 + 1e-6) * centre.min()))  # of those as near, the first
        self.least = 0.5 * float(centre[first])  # of the centre from the axis, where the equation is singular
        self.start = self._on_surface(Vector(float(distance[first]), 0.0, float(height[first])))
        self.out, self.up = distance - self.start[0], height - self.start[1]
        self.size = float(np.hypot(self.out, self.up).max())

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
        p = self.contact(y)
        R_p = p.x
        n, S = self.surface.normal(p), self.surface.shape_operator(p)
        along = Vector(n.z, 0.0, -n.x)
        kappa, R = along.dot(S @ along), R_p + self.a * n.x
        up, down = self.share * R * kappa, (n.x * (1 + self.a * kappa) / R - kappa) / R
        turned = (self.share * R * self.rate * n.z, kappa * self.rate * R_p)
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
        """Return the solutions at each contact: an array of 8 rows."""
        import numpy as np

        if self.size <= 1e-12 * max(1e-300, float(np.abs(self.start).max())):
            return np.broadcast_to(np.array([_BEGIN]).T, (8, self.out.size))
        reach = 1.1 * self.size
        for _ in range(_WIDER):
            solutions = self.solve(-reach).sol, self.solve(reach).sol
            rows = _both(solutions, self._placed(solutions))
            if np.hypot(rows[0] - self.out, rows[1] - self.up).max() <= 1e-6 * self.size:
                break
            reach *= 2
        return rows

    def _placed(self, solutions: tuple[Any, Any]) -> Any:
        """Return the σ of each contact: the nearest of many, then Newton's method along the meridian."""
        import numpy as np
        from scipy.spatial import cKDTree

        low, high = (float(solution.t_max if solution.t_max > 0 else solution.t_min) for solution in solutions)
        grid = np.linspace(low, high, 2001)
        rows = _both(solutions, grid)
        sigma = grid[cKDTree(rows[:2].T).query(np.column_stack([self.out, self.up]))[1]]
        for _ in range(4):
            rows = _both(solutions, sigma)
            n = self.surface.normal(self.contact(rows))
            step = (self.out - rows[0]) * n.z - (self.up - rows[1]) * n.x
            sigma = np.clip(sigma + step, low, high)
        return sigma


def _both(solutions: tuple[Any, Any], sigma: Any) -> Any:
    import numpy as np

    return np.where(sigma < 0, solutions[0](np.minimum(sigma, 0.0)), solutions[1](np.maximum(sigma, 0.0)))


def _pair(system: RollingSystem, at: Record) -> list[Any]:
    """Return the terms of ℓ and w carried along the meridian to the latitude of the record's first contact.

    None where the centre comes to the axis, at which the equation along the meridian is singular, or where contacts
    that were measured lie so far beside the surface that it seems to.
    """
    import numpy as np

    a, r, V = float(system.body.radius), at.motion.position, at.motion.velocity
    n, Omega = system.support.surface.normal(at.contact), at.motion.angular_velocity
    parts = [r.x * V.y, -(r.y * V.x), *(a * x * y for x, y in zip(Omega, n, strict=True))]
    shape = np.broadcast_shapes(*(np.shape(part) for part in (*parts, at.contact.x, at.contact.z)))
    flat = [np.broadcast_to(np.asarray(part, dtype=float), shape).reshape(-1) for part in parts]
    contact = [np.broadcast_to(np.asarray(x, dtype=float), shape).reshape(-1) for x in at.contact]
    distance = np.hypot(contact[0], contact[1])
    centre = np.hypot(*(np.broadcast_to(np.asarray(x, dtype=float), shape).reshape(-1) for x in (r.x, r.y)))
    if centre.min() <= max(_NEAREST * centre.max(), _ON_AXIS * a):
        return []
    meridian = _Meridian(system, distance, contact[2], centre)
    if not meridian.off_axis(_BEGIN) > 0:
        return []
    A, B, C, D, *turned = meridian.at_each()[2:]
    inverse = np.array([[D, -B], [-C, A]]) / (A * D - B * C)
    columns = [inverse[:, 0] * part for part in flat[:2]] + [inverse[:, 1] * part for part in flat[2:]]
    columns += [-inverse[:, 0] * turned[0], -inverse[:, 1] * turned[1]]
    first = np.array([[A[0], B[0]], [C[0], D[0]]])
    columns = [first @ column for column in columns]
    columns.append(np.outer([turned[0][0], turned[1][0]], np.ones_like(distance)))
    reach = float(distance[0])  # makes both angular momenta, per mass
    return [(column * np.array([[1.0], [reach]])).T.reshape(*shape, 2) for column in columns]


ROUTH_PAIR = Invariant(
    "pair of linear integrals of Routh", "R V_φ and a Ω·n, carried along the meridian", "m²/s", _has_pair, _pair
)
