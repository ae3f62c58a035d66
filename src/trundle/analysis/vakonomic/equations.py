"""The vakonomic equations of a ball on a turning plane: not how balls move (docs/vakonomic.md).

The rolling constraint is put into the Lagrangian with multipliers λ in the plane, L' = L + λ·(V − u(r) − aΩ×n), and
the action of L' is made stationary for free variations of position, orientation and λ [kozlov1983], [lewis1995].
A variation of the orientation is δQ = [η×]Q; it changes the angular velocity by δΩ = η̇ + η×Ω. With the momentum
π = ∂L'/∂Ω = IΩ − a n×λ and the potential −F·r, Hamilton's principle then says

    m V̇ + λ̇ = F − ω λ×n        π̇ = Ω×π        V = ω n×r + aΩ×n                                       (V1)

With the constraint differentiated, k = I/(m a²), complex numbers ζ, v, λ for vectors in the plane and s = Ω·n, that is

    λ̇ = k/(1 + k) (F − iωm v) + i(kω + s)/(1 + k) λ     m v̇ = F − λ̇ + iωλ     I ṡ = −aΩ·λ              (V2)

where aΩ = i(v − iωζ) along the plane. d'Alembert's principle has R for −λ̇ + iωλ, and R does no such things: it has
neither a memory nor initial values.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...display import Displayed, Headline, Markup, numbers, pairs
from ...errors import InvalidValueError, OutOfDomainError, SolverError
from ...mechanics import checks
from ...mechanics.loads import Force, Gravity, at_rest
from ...mechanics.scalars import is_number
from ...mechanics.system import RollingSystem, State

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Complex = NDArray[np.complex128]

TOLERANCE = 1e-12
_MOST_CALLS = 150_000  # of the slopes, some seconds


@dataclass(frozen=True)
class _Ball:
    """The numbers of the equations."""

    m: float
    a: float
    k: float
    rate: float  # ω, rad/s
    force: complex  # F along the plane, N

    @property
    def moment(self) -> float:
        """I, kg m²."""
        return self.k * self.m * self.a**2

    def slopes(self, _: float, y: Any) -> Any:
        """Return the rates of (ζ, v, λ, s): V2."""
        import numpy as np

        z, v, lam, s = complex(*y[0:2]), complex(*y[2:4]), complex(*y[4:6]), y[6]
        lam_rate = (self.k * (self.force - 1j * self.rate * self.m * v) + 1j * (self.k * self.rate + s) * lam) / (
            1 + self.k
        )
        v_rate = (self.force - lam_rate + 1j * self.rate * lam) / self.m
        turned = 1j * (v - 1j * self.rate * z)  # aΩ along the plane
        s_rate = -(turned.conjugate() * lam).real / self.moment
        return np.array([v.real, v.imag, v_rate.real, v_rate.imag, lam_rate.real, lam_rate.imag, s_rate])


@dataclass(frozen=True, repr=False)
class VakonomicPath(Displayed):
    """A path by the vakonomic equations, which no ball follows.

    Parameters
    ----------
    time : array (n,)
        s.
    position, velocity : array (n, 2)
        Of the centre over the plane, inertial support frame, m and m/s.
    angular_velocity : array (n, 3)
        Ω, rad/s.
    multipliers : array (n, 2)
        λ along the plane, kg m/s.
    potential : array (n,)
        Of the loads, J.
    system : RollingSystem
        The ball and its plane.
    """

    time: Array
    position: Array
    velocity: Array
    angular_velocity: Array
    multipliers: Array
    potential: Array
    system: RollingSystem

    def _headline(self) -> Headline:
        span = self.time[-1] - self.time[0]
        return Headline("", f"{self.time.size} samples over {span:g} s of wrong mechanics, for comparison only")

    def _parts(self) -> Iterator[Markup]:
        yield pairs(
            [
                ("multipliers at first", numbers(self.multipliers[0], unit="kg m/s")),
                ("centre at first", numbers(self.position[0], unit="m")),
                ("centre in the end", numbers(self.position[-1], unit="m")),
            ]
        )

    @property
    def energy(self) -> Array:
        """½mV² + ½IΩ² + U, J."""
        m, a, k = self.system.body.mass, self.system.body.radius, self.system.body.inertia_ratio
        kinetic = (self.velocity**2).sum(axis=1) + k * a**2 * (self.angular_velocity**2).sum(axis=1)
        return 0.5 * m * kinetic + self.potential

    @property
    def conserved(self) -> Array:
        """E + λ·u, J: what these equations conserve on a plane that turns steadily."""
        x, y = self.position.T
        rate = float(self.system.support.motion.steady_rate or 0.0)
        return self.energy + rate * (x * self.multipliers[:, 1] - y * self.multipliers[:, 0])

    @property
    def momentum(self) -> Array:
        """π = IΩ − a n×λ, kg m²/s: of constant length, since it is fixed in the body."""
        import numpy as np

        body = self.system.body
        moment = body.inertia_ratio * body.mass * body.radius**2
        lx, ly = self.multipliers.T
        return moment * self.angular_velocity - body.radius * np.column_stack([-ly, lx, np.zeros_like(lx)])


def _ball(system: RollingSystem) -> _Ball:
    """Return the numbers of a system that the equations here are for."""
    support, body = system.support, system.body
    outside = []
    if not support.surface.flat:
        outside.append("the surface is no plane")
    if support.motion.steady_rate is None:
        outside.append("the plane does not turn steadily")
    if not body.is_isotropic_sphere or body.shape.axis is not None:
        outside.append("the body is no sphere with the same inertia about every axis")
    if not all(load.constant and isinstance(load, (Force, Gravity)) for load in system.all_loads):
        outside.append("a load has no potential or is not constant")
    if outside:
        raise OutOfDomainError(
            "The vakonomic equations are there for a homogeneous ball on a plane that is at rest or turns steadily, "
            f"under its weight and constant forces. Here, {'; '.join(outside)}."
        )
    F, _ = system.loads_on(at_rest(body.mass))
    numbers = (body.mass, body.radius, body.inertia_ratio, support.motion.steady_rate or 0.0, F.x, F.y)
    if not all(is_number(number) for number in numbers):
        raise InvalidValueError("system", "must be one ball", "arrays or symbols", "Take one member at a time.")
    m, a, k, rate, fx, fy = (float(number) for number in numbers)
    return _Ball(m, a, k, rate, complex(fx, fy))


def vakonomic_path(
    system: RollingSystem, start: State, times: Any, multipliers: Any = (0.0, 0.0), *, reach: Any = None
) -> VakonomicPath:
    """Integrate the vakonomic equations, V2, which are not those of a rolling ball.

    Parameters
    ----------
    system : RollingSystem
        A homogeneous ball on a plane that is at rest or turns steadily, tilted or not, under constant forces.
    start : State
        As `RollingSystem.place` makes it.
    times : array (n,)
        Ascending, s, none before the start.
    multipliers : sequence of 2 floats
        λ at the start, along the plane, kg m/s: nothing in nature says how large it is.
    reach : float or quantity, optional
        Where to stop: the distance of the centre from the axis, m. These paths run away exponentially.

    Returns
    -------
    VakonomicPath
        At the times, up to the last within reach.

    Raises
    ------
    OutOfDomainError
        If the system is another one.
    SolverError
        If the path runs away beyond what can be computed; give a `reach` then.

    Examples
    --------
    On a plane at rest without forces it is the straight line that it should be; on a turning one it is not the circle:

    >>> import trundle as tr
    >>> ball = tr.Body.solid_sphere(0.025, 0.51)
    >>> for rate in (0.0, 3.5):
    ...     system = tr.RollingSystem(ball, tr.Support(tr.Plane(), motion=tr.Spin(rate)))
    ...     path = vakonomic_path(system, system.place((0.2, 0.0), (0.0, 0.1)), [0.0, 1.0])
    ...     true = tr.simulate(system, system.place((0.2, 0.0), (0.0, 0.1)), duration=1.0, every=1.0)
    ...     apart = path.position[-1] - true.data.position.values[-1, :2]
    ...     print(f"at the rate {rate} it is off: {bool(abs(apart).max() > 0.01)}")
    at the rate 0.0 it is off: False
    at the rate 3.5 it is off: True
    """
    import numpy as np
    from scipy.integrate import solve_ivp

    checks.instance(system, RollingSystem, "system", "Give a tr.RollingSystem.")
    checks.instance(start, State, "start", "Let system.place(...) make it.")
    ball, t = _ball(system), np.asarray(times, dtype=float)
    pair = tuple(checks.components(multipliers, "number", "multipliers", 2))
    y = np.array([*start.position[:2], *start.velocity[:2], *pair, start.angular_velocity[2]], dtype=float)
    speed = max(abs(complex(*y[2:4])), abs(ball.rate) * abs(complex(*y[:2])), 1e-6)
    scale = np.array([speed, speed, speed, speed, ball.m * speed, ball.m * speed, speed / ball.a])
    far = None if reach is None else checks.positive(reach, "length", "reach")
    calls = 0

    def slopes(time: float, now: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls > _MOST_CALLS:
            remedy = "Give a `reach` at which to stop, or a shorter time."
            raise SolverError(
                f"The vakonomic path runs away: it turns too fast to follow at t = {time:.6g} s. {remedy}"
            )
        return ball.slopes(time, now)

    def beyond(_: float, now: Any) -> float:
        return float(far - abs(complex(*now[:2]))) if far is not None else 1.0

    beyond.terminal = True  # type: ignore[attr-defined]
    done = solve_ivp(
        slopes,
        (start.time, float(t[-1])),
        y,
        method="DOP853",
        t_eval=t,
        rtol=TOLERANCE,
        atol=1e-3 * TOLERANCE * scale,
        events=beyond,
    )
    if not done.success:
        raise SolverError(f"The vakonomic path could not be followed: {done.message}")
    return _path(system, ball, done.t, done.y)


def _path(system: RollingSystem, ball: _Ball, t: Array, y: Array) -> VakonomicPath:
    import numpy as np

    z, v = y[0] + 1j * y[1], y[2] + 1j * y[3]
    along = 1j * (v - 1j * ball.rate * z) / ball.a
    spin = np.column_stack([along.real, along.imag, y[6]])
    potential = -(ball.force.conjugate() * z).real
    return VakonomicPath(t, y[0:2].T, y[2:4].T, spin, y[4:6].T, potential, system)
