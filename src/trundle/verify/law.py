"""The law checked by a route that does not use T2: Newton, Euler and the differentiated constraint, solved together.

Rates come from the trajectory's own numbers: each is the slope at the middle of a polynomial through a short window.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import contact_at
from ..mechanics.system import RollingSystem
from ..solve.samples import FLIGHT, RESTING, ROLLING, SLIPPING, Samples
from .acting import acting, cross, exerted, rotated, unturning
from .bounds import A_ROUNDING, SOLVER, Array, blur_of, largest

WINDOWS = 24
_HALF_NODES = 6  # a polynomial of degree 12
_SLOPE = 20.0  # over half a window: the sum of the weights by which a slope takes the errors of its 13 places
_ROUNDING = 4e-14  # of a place, over half a window: so many times ten roundings or so
_PRODUCT = 4e-15  # of a moment: R and its arm are ten roundings off or so, each
_NARROWEST = 1e-10  # of what the clock shows: in less, 13 instants have too few digits
_PHASE_A_WINDOW = 0.3  # rad of the fastest rotation: what a polynomial leaves of a body that is no sphere is rounding


@dataclass(frozen=True)
class Residuals:
    """How far a trajectory is from the law, each as a share of the terms that it is made of."""

    path: float  # the slope of the position against V
    turning: float  # the slope of the orientation against Ω
    slip: float  # how the two points that touch move apart, by the slopes of position, orientation and support
    law: float  # accelerations and reaction against the 9 × 9 system
    virtual_power: float  # of the reaction over the admissible velocities


def window_times(begin: float, end: float, fastest: float) -> Array:
    """Return the instants of short windows spread over a run.

    Examples
    --------
    >>> window_times(0.0, 10.0, 1.0).shape
    (24, 13)
    """
    least = _NARROWEST * max(abs(begin), abs(end))
    width = min(end - begin, max(least, _PHASE_A_WINDOW / max(fastest, 1e-300)))
    golden = 0.6180339887498949
    middles = begin + width / 2 + np.sort((golden * (1 + np.arange(WINDOWS))) % 1.0) * (end - begin - width)
    nodes = -np.cos(np.pi * np.arange(2 * _HALF_NODES + 1) / (2 * _HALF_NODES))
    return np.clip(middles[:, None] + nodes * (width / 2), begin, end)


def narrowed(times: Array) -> Array:
    """Return windows a quarter as wide about the same middles.

    Examples
    --------
    >>> narrowed(window_times(0.0, 10.0, 1.0)).shape
    (24, 13)
    """
    middles = times[:, _HALF_NODES, None]
    return np.clip(middles + 0.25 * (times - middles), times[:, :1], times[:, -1:])


def _rates(windows: Samples) -> tuple[Array, Array, Array]:
    """Return V, Ω and the rate of a free axle: what the law says the slopes of; of no axle an empty array."""
    return windows.velocity, windows.angular_velocity, windows.support_coordinates[:, -1:]


def window_sizes(system: RollingSystem, windows: Samples, times: Array, bound: float) -> tuple[Array, ...]:
    """Return against what V and Ω are small or not in each window, m/s and rad/s, and the slope of each of `_rates`.

    Each has its own: a landing elsewhere in the run makes nothing here less sharp. A body may turn so slowly that its Ω
    says nothing beside what its forces could do to it, and its orientation still must be followed.
    """
    at = windows.part(np.arange(_HALF_NODES, times.size, times.shape[1]))
    sharp = _ROUNDING / bound / (0.5 * (times[:, -1] - times[:, 0]))  # 1/s: what rounding makes of a slope
    passing = _lengths(_slope_at_middle(times, windows.contact.reshape(*times.shape, 3)))
    places = _lengths(at.position) + _lengths(at.contact)
    speeds = [np.maximum(_lengths(at.velocity), passing) + sharp * places, _lengths(at.angular_velocity) + sharp]
    F, _, J, _ = acting(system, at)
    turning = _lengths(at.angular_velocity)
    own = [
        _lengths(_slope_at_middle(times, values.reshape(*times.shape, -1))) + turning * _lengths(values_now)
        for values, values_now in zip(_rates(windows), _rates(at), strict=True)
        if values.size
    ]
    own[0] = np.maximum(own[0], _lengths(F) / float(system.body.mass))
    own[1] += own[0] * _lengths(at.contact - at.position) * float(system.body.mass) / np.trace(J, axis1=1, axis2=2)
    return (*speeds, *own)


def roughness(windows: Samples, times: Array, sizes: tuple[Array, ...]) -> Array:
    """Return what the last Chebyshev coefficients of V, Ω and an axle's rate in each window are to their slopes.

    Of V and Ω, which are slopes themselves, also what they are to them.
    """
    nodes = times.shape[1]
    weights = np.ones(nodes)
    weights[[0, -1]] = 0.5
    last = np.cos(np.pi * np.outer([nodes - 2, nodes - 1], np.arange(nodes)) / (nodes - 1)) * weights / (nodes - 1)
    half = (times[:, -1] - times[:, 0]) / 2
    found = np.zeros(len(times))
    speeds, slopes = (*sizes[:2], np.full(len(times), np.inf)), sizes[2:]
    for values, speed, slope in zip(_rates(windows), speeds, slopes, strict=False):
        tails = np.abs(np.einsum("kn,wnc->wkc", last, values.reshape(*times.shape, -1))).max(axis=(1, 2))
        found = np.maximum(found, tails / np.maximum(np.minimum(speed, slope * half / nodes), 1e-300))
    wide = times[:, -1] - times[:, 0] > 4 * _NARROWEST * np.abs(times).max()
    return np.where(wide, found, 0.0)


def _lengths(vectors: Array) -> Array:
    return np.linalg.norm(vectors, axis=-1)


def _slope_at_middle(times: Array, values: Array) -> Array:
    """Return dy/dt at the middle of each window, for the polynomial through its nodes; values (windows, nodes, ...).

    Barycentric weights (Berrut and Trefethen 2004) from the nodes as they are, which far from t = 0 are rounded.
    """
    half = (times[:, -1:] - times[:, :1]) / 2
    x = (times - times[:, _HALF_NODES : _HALF_NODES + 1]) / half
    apart = x[:, :, None] - x[:, None, :] + np.eye(x.shape[1])
    weights = 1 / apart.prod(axis=2)
    weights /= weights[:, _HALF_NODES : _HALF_NODES + 1]
    x[:, _HALF_NODES] = 1.0
    row = -weights / x
    row[:, _HALF_NODES] = 0.0
    change = values - values[:, _HALF_NODES : _HALF_NODES + 1]
    return np.einsum("wn,wn...->w...", row / half, change)


def residuals(system: RollingSystem, windows: Samples, times: Array, bound: float) -> Residuals:
    """Compare a trajectory with the law by the independent route.

    Examples
    --------
    See `trundle.verify.card`.
    """
    nodes = times.shape[1]
    phases = windows.phase[_HALF_NODES::nodes]
    widths = np.round(np.log2(times[:, -1] - times[:, 0]))  # a slope is as sharp as its own window is wide
    found = []
    for phase, width in np.unique(np.stack([phases, widths], axis=1), axis=0):
        which = np.flatnonzero((phases == phase) & (widths == width))
        index = (which[:, None] * nodes + np.arange(nodes)).ravel()
        found.append(_Windows(system, windows.part(index), times[which], int(phase), bound).residuals())
    return Residuals(*(max(getattr(part, field.name) for part in found) for field in fields(Residuals)))


@dataclass(frozen=True)
class _Windows:
    """Windows of one phase, and what the slopes at their middles say."""

    system: RollingSystem
    all: Samples
    times: Array
    phase: int
    bound: float

    def slope(self, array: Array) -> Array:
        return _slope_at_middle(self.times, array.reshape(*self.times.shape, -1))

    @cached_property
    def middle(self) -> Samples:
        return self.all.part(np.arange(_HALF_NODES, self.times.size, self.times.shape[1]))

    @cached_property
    def half(self) -> float:
        """Half a window, s: a slope is as sharp as rounding over this."""
        return float((self.times[:, -1] - self.times[:, 0]).min()) / 2

    @cached_property
    def rate(self) -> float:
        """How fast the motion changes, 1/s."""
        V, V_rate = self.middle.velocity, self.slope(self.all.velocity)
        return largest(self.middle.angular_velocity) + float(np.abs(V_rate).max() / max(np.abs(V).max(), 1e-300))

    def residuals(self) -> Residuals:
        """Return all of them."""
        path, turning, slip = self._kinematics()
        law = self._law()
        power = self._virtual_power() if self.phase == ROLLING else 0.0
        return Residuals(path, turning, slip, max(law, self._axle()), power)

    @cached_property
    def _speeds(self) -> list[Array]:
        """V, Ω×ρ and u at the middles, m/s."""
        return [np.broadcast_to(v.array(), self.middle.position.shape) for v in self.middle.speeds(self.system)]

    @cached_property
    def _clock(self) -> float:
        """How far the clock has come, s: of all that moves steadily, the place is only as sharp as this."""
        return float(np.abs(self.times).max())

    @cached_property
    def _sharp(self) -> float:
        """The speed that rounding of places makes, over the bound, m/s: no smaller one is told from none."""
        at, fastest = self.middle, sum(map(largest, self._speeds))
        place = largest(at.position) + largest(at.contact) + self._bend + fastest * self._clock
        rounded = _ROUNDING * place + _SLOPE * blur_of(self.system, at)  # the centre is the contact less ρ
        return max(rounded / self.half / self.bound, 1e-300)

    @cached_property
    def _passing(self) -> float:
        """How fast the contact moves, m/s: a place worked out from it is off by a share of its way, and so is a slope.

        The centre of a disc that wobbles, or of a body that hovers over a support that sways, stands still meanwhile.
        """
        return largest(self.slope(self.all.contact))

    @cached_property
    def _bend(self) -> float:
        """The support's radius, m: of what is worked out from its centre, the place is only as sharp as that."""
        at = self.middle
        q = Quaternion.of(at.orientation)
        S = contact_at(self.system, at.time, Vector.of(at.contact), q, at.support_columns).shape_operator
        most = max(float(np.abs(row.array()).max()) for row in S.rows)
        return 1 / most if most > 0 else 0.0

    def _kinematics(self) -> tuple[float, float, float]:
        """Compare what is said of V, Ω and slip with the slopes of position, orientation and support."""
        at, V, Omega = self.middle, self.middle.velocity, self.middle.angular_velocity
        path = largest(self.slope(self.all.position) - V) / max(float(np.abs(V).max()), self._passing, self._sharp)
        # 2 q̇ q*, of which the first part is the rate of |q|
        turned = Quaternion.of(self.slope(self.all.orientation)) * Quaternion.of(at.orientation).conjugate
        off = float(np.linalg.norm(2 * turned.array() - np.pad(Omega, ((0, 0), (1, 0))), axis=1).max())
        angle = 1 + largest(Omega) * self._clock + self._bend / largest(at.contact - at.position)
        turning = off / max(largest(Omega), _ROUNDING * angle / self.half / self.bound)
        if self.phase == FLIGHT:
            return path, turning, 0.0
        apart = self.slope(self._body_points() - self._support_points())
        V, carried, u = self._speeds
        if self.phase == SLIPPING:
            apart = apart - (V + carried - u)
        return path, turning, largest(apart) / max(*map(largest, self._speeds), self._passing, self._sharp)

    def _body_points(self) -> Array:
        """Return where the body's point that touches at the middle of a window is at each of its instants."""
        nodes, at = self.times.shape[1], self.middle
        onward = Quaternion.of(self.all.orientation) * Quaternion.of(np.repeat(at.orientation, nodes, axis=0)).conjugate
        return self.all.position + rotated(onward.array(), np.repeat(at.contact - at.position, nodes, axis=0))

    def _support_points(self) -> Array:
        """Return the same of the support's point."""
        pose, nodes = self.middle.support(self.system), self.times.shape[1]
        own = (pose.local(Vector.of(self.middle.contact))).array()
        own = np.repeat(np.broadcast_to(own, self.middle.contact.shape), nodes, axis=0)
        carried = self.all.support(self.system).carried(Vector.of(own)).array()
        return np.broadcast_to(carried, own.shape)

    def _law(self) -> float:
        """Compare V̇, Ω̇ and R with Newton, Euler and, of a body that rolls, the constraint."""
        at, V_rate, Omega_rate = self.middle, self.slope(self.all.velocity), self.slope(self.all.angular_velocity)
        m, Omega, R = float(self.system.body.mass), at.angular_velocity, at.contact_force
        rho = at.contact - at.position
        F, K, J, gyroscopic = acting(self.system, at)
        if self.phase == ROLLING:  # what holds the body to the support is not asked for, but found
            u = np.broadcast_to(self.all.speeds(self.system)[2].array(), self.all.position.shape)
            rho_rate = self.slope(self.all.contact - self.all.position)
            solved = newton_euler(m, J, rho, F, K - gyroscopic, self.slope(u) - cross(Omega, rho_rate))
        else:
            K = K + self._holding(J @ Omega_rate[:, :, None], K - gyroscopic + cross(rho, R))
            turned = Omega_rate if self.phase == RESTING else _euler(J, K - gyroscopic + cross(rho, R))
            solved = (F + R) / m, turned, R
        a_size = self._acceleration(F, V_rate)
        lever = m * a_size * largest(rho) / np.trace(J, axis1=1, axis2=2).min()  # what R may turn
        turn_size = max(np.abs(Omega_rate).max(), np.abs(Omega).max() * self.rate, lever, self._sharp_turn)
        turn_size += m * self._pressed * largest(rho) / np.linalg.eigvalsh(J).min()
        return float(
            max(
                np.abs(solved[0] - V_rate).max() / a_size,
                np.abs(solved[1] - Omega_rate).max() / turn_size,
                np.abs(solved[2] - R).max() / (m * a_size),
            )
        )

    def _holding(self, change: Array, torque: Array) -> Array:
        """Return the couple along the support that keeps a body that slips from turning over it, N m.

        It is what is missing in Euler's equation, and no larger than the resistance.
        """
        at, n = self.middle, self.middle.normals(self.system)
        missing = change[:, :, 0] - torque
        along = missing - (missing * n).sum(axis=1, keepdims=True) * n
        most = float(self.system.resistance) * (at.contact_force * n).sum(axis=1)
        size = np.linalg.norm(along, axis=1)
        holds = unturning(self.system, at) & (at.phase == SLIPPING)
        return along * (holds * np.minimum(1.0, most / np.maximum(size, 1e-300)))[:, None]

    def _acceleration(self, F: Array, V_rate: Array) -> float:
        """Return against what an acceleration is small or not, and over the bound what rounding makes of a slope."""
        V, at = np.abs(self.middle.velocity).max(), self.middle
        turning = largest(at.angular_velocity)
        fastest = sum(map(largest, self._speeds)) + turning * largest(at.contact - at.position)
        if self.phase == ROLLING:
            fastest += self._passing  # Ω×ρ̇
        sharp = _ROUNDING * fastest / self.half / self.bound  # of Ω×ρ also where Ω is along ρ
        m = float(self.system.body.mass)
        size = max(np.abs(F).max() / m, np.abs(V_rate).max())
        arm = largest(at.contact - at.position)
        blurred = self._blurred * max(size / arm, _SLOPE * turning / self.half)
        return float(max(size, V * self.rate, 1e-300) + sharp + blurred + self._pressed)

    @cached_property
    def _pressed(self) -> float:
        """What rounding of N makes of an acceleration, over the bound, m/s².

        So many times as fast as what moves it the contact moves, so many roundings of N there are. What rests does not
        move it, nor does rounding of its place.
        """
        leverage = self._passing / max(sum(map(largest, self._speeds)), self._sharp * self.bound)
        force = largest(self.middle.contact_force)
        return A_ROUNDING * leverage * force / float(self.system.body.mass) / self.bound

    @cached_property
    def _blurred(self) -> float:
        """By how much rounding may move ρ, over the bound, m: it turns, and Ω×ρ̇.

        It is the small difference of two places, and the body's support map of its orientation.
        """
        at = self.middle
        by_places = 0.5 * A_ROUNDING * (largest(at.position) + largest(at.contact))
        return (by_places + blur_of(self.system, at)) / self.bound

    @property
    def _sharp_turn(self) -> float:
        """The same of Ω̇, 1/s²."""
        return _ROUNDING * largest(self.middle.angular_velocity) / self.half / self.bound

    def _axle(self) -> float:
        """Compare ω̇ of a free axle with I ω̇ = τ − e·[(p − X)×R] − e·(couples of the contact)."""
        motion, at = self.system.support.motion, self.middle
        if not motion.free:
            return 0.0
        pose, R = at.support(self.system), at.contact_force
        axle, arm = (np.broadcast_to(v.array(), R.shape) for v in (pose.axle, Vector.of(at.contact) - pose.origin))
        own = tuple(at.support_coordinates.T)
        parts = [np.broadcast_to(np.asarray(motion.axle_torque(at.time, own), dtype=float), at.time.shape)]
        if self.phase != FLIGHT:
            from_support = exerted(self.system, at)[2]
            parts += [-(axle * cross(arm, R)).sum(axis=1), -(axle * from_support).sum(axis=1)]
        change, rate = self.slope(self.all.support_coordinates), at.support_coordinates[:, -1]
        # Of a force that presses on past the axle, and of a slope, no smaller moment is told from none.
        pressing = _PRODUCT * largest(arm) * largest(R) / self.bound
        # A step's error is a share of the largest number of the state, and |q| is 1.
        fastest = max(1.0, np.abs(rate).max(), largest(at.angular_velocity))
        sharp = motion.inertia * self._stepped * fastest / self.half / self.bound
        steady = motion.inertia * np.abs(rate).max() * self.rate
        size = max(*(float(np.abs(part).max()) for part in parts), steady, pressing + sharp)
        law = np.abs(motion.inertia * change[:, -1] - sum(parts)).max() / max(size, 1e-300)
        angle = 1 + float(np.abs(at.support_coordinates[:, -2]).max()) + np.abs(rate).max() * self._clock
        turned = np.abs(change[:, -2] - rate).max()
        sharp = self._stepped * angle / self.half / self.bound
        return float(max(law, turned / max(np.abs(rate).max(), sharp, 1e-300)))

    @property
    def _stepped(self) -> float:
        """What the error of a step makes of a slope, over half a window, as a share: no less than rounding does."""
        return max(_ROUNDING, _SLOPE * self.bound / (100 * SOLVER))

    def _virtual_power(self) -> float:
        """Return the power of the reaction, as the motion shows it, over δV = −δΩ×ρ."""
        at, V_rate, Omega_rate = self.middle, self.slope(self.all.velocity), self.slope(self.all.angular_velocity)
        m, rho = float(self.system.body.mass), at.contact - at.position
        F, K, J, gyroscopic = acting(self.system, at)
        force = m * V_rate - F
        torque = np.einsum("nij,nj->ni", J, Omega_rate) + gyroscopic - K
        power = [
            np.abs((force * cross(rho, turn)).sum(axis=1) + torque @ turn).max()  # δV = −δΩ×ρ = ρ×δΩ
            for turn in np.eye(3)
        ]
        turning = np.abs(J).max() * max(np.abs(at.angular_velocity).max() * self.rate, self._sharp_turn)
        size = max(m * self._acceleration(F, V_rate) * largest(rho), turning)
        return float(max(power) / size)


def _euler(J: Array, torque: Array) -> Array:
    return np.asarray(np.linalg.solve(J, torque[..., None])[..., 0])


def applied(system: RollingSystem, at: Samples, p_rate: Array) -> tuple[Array, Array, Array, Array, Array]:
    """Return F, K, J, Ω×JΩ and u̇ at each instant, for a motion of which no slopes are at hand."""
    change = at.support(system).material_acceleration(Vector.of(at.contact), Vector.of(p_rate))
    return *acting(system, at), np.broadcast_to(change.array(), at.position.shape)


def newton_euler(m: float, J: Array, rho: Array, F: Array, K: Array, constraint: Array) -> tuple[Any, Any, Any]:
    """Solve m V̇ − R = F, J Ω̇ − ρ×R = K − Ω×JΩ, V̇ − ρ×Ω̇ = u̇ − Ω×ρ̇ for V̇, Ω̇ and R, one 9×9 system an instant."""
    n, one = len(F), np.eye(3)
    cross = np.zeros((n, 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -rho[:, 2], rho[:, 1], -rho[:, 0]
    cross -= cross.transpose(0, 2, 1)
    A = np.zeros((n, 9, 9))
    A[:, :3, :3], A[:, :3, 6:] = m * one, -one
    A[:, 3:6, 3:6], A[:, 3:6, 6:] = J, -cross
    A[:, 6:, :3], A[:, 6:, 3:6] = one, -cross
    x = np.linalg.solve(A, np.concatenate([F, K, constraint], axis=1)[..., None])[..., 0]
    return x[:, :3], x[:, 3:6], x[:, 6:]
