"""Charts: coordinates of a rolling body, and axes along which its law takes few operations.

The law is one between vectors, so it holds along any axes. Along those of the body the inertia is fixed; along the axis
of a body of revolution and the line of nodes, its contact is too, but for one angle, and the body's own rotation has no
part in the law. A chart shows the law the system as it is seen along its axes; no equation of motion is written here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..mechanics.algebra import Matrix, Quaternion, Vector
from ..mechanics.contact import normal_at
from ..mechanics.loads import BodyMotion, Load
from ..mechanics.motions import Motion, SupportState
from ..mechanics.scalars import Scalar, as_float, is_zero, namespace
from ..mechanics.symmetry import on_plane
from ..mechanics.system import RollingSystem
from . import corner_events
from .laws import CONTACT, Law

CHART = "chart"  # the name of the event with which a chart ends
_INSIDE, _EDGE = 0.15, 0.1  # of the sine of the angle between axis and normal: where the nodes' chart begins and ends
# 2π to 60 digits
TURN = Fraction("6.28318530717958647692528676655900576839433879875021164194988")
_BLOCK = 100.0  # s in which the angle of a support may grow as a float
_UPRIGHT = Quaternion(1.0, 0.0, 0.0, 0.0)
Numbers = Sequence[Scalar]


@dataclass(frozen=True)
class Traced:
    """A law in a chart."""

    rates: list[Scalar]  # of the chart's numbers
    event_functions: dict[str, Scalar]  # those of the law, and where the chart ends
    normal: Vector  # n, of length 1, along the chart's axes
    positive: tuple[Scalar, ...] = ()  # what is known to be positive
    lengths: tuple[tuple[Scalar, Scalar], ...] = ()  # each as it is worked out anywhere, and on the support


@dataclass(frozen=True)
class Chart:
    """The law's own coordinates, along the axes of the support frame; each other chart is a change from these."""

    # whether the support is a plane across the third axis for good, so that the height of the contact is known
    flat: bool = False

    def names(self, system: RollingSystem, law: Law) -> tuple[str, ...]:
        """Return the names of its numbers."""
        return law.names(system)

    def contains(self, state: Sequence[float]) -> bool:  # noqa: ARG002
        """Tell whether a run may begin in it, given the law's numbers."""
        return True

    @property
    def bounded(self) -> bool:
        """Whether a run may leave it."""
        return False

    def traced(
        self, system: RollingSystem, law: Law, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> Traced:
        """Return the rates of its numbers, and the event functions."""
        seen = _unturned(system, law)
        place, q, _, _, coordinates = law.split(state)
        p, unit = _corrected(seen, time, place, q, coordinates)
        near = [*p, *unit, *state[7:]]
        turned, rates = law.rates(seen, time, [*p, *q, *state[7:]])[3:7], law.rates(seen, time, near)
        rates[3:7] = turned  # of which the law of a ball needs no more
        stops = corner_events.all_event_functions(seen, law, time, near, event_parameters)
        return Traced(rates, stops, normal_at(seen, time, p, coordinates), lengths=_lengths(seen, time, p, coordinates))

    def tidied(self, system: RollingSystem, law: Law, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return the state with p moved along the normal to φ(p) = 0, by one step of Newton's method, and q/|q|.

        What rounding leaves of both is so small that the step's own error is its square.
        """
        p, q, _, _, coordinates = law.split(state)
        support = _unturned(system, law).support.motion.at(time, *coordinates)
        p = p + support.rotation @ system.support.surface.step_onto(support.local(p))
        return [*p, *_unit(q), *state[7:]]

    def reduced(self, numbers: Sequence[float]) -> list[float]:
        """Return its numbers with whole turns taken out of the angles."""
        return list(numbers)

    def of_law(self, system: RollingSystem, time: float, state: Sequence[float]) -> list[float]:  # noqa: ARG002
        """Return its numbers, given the law's."""
        return list(state)

    def to_law(self, system: RollingSystem, time: Any, numbers: Numbers) -> list[Any]:  # noqa: ARG002
        """Return the law's numbers, or columns of them, given its own."""
        return list(numbers)

    def _place(self, system: RollingSystem, time: Scalar, numbers: Numbers, coordinates: Numbers) -> Vector:
        """Return p, of whose numbers a plane needs two."""
        if not self.flat:
            return Vector(*numbers[:3])
        return Vector(numbers[0], numbers[1], system.support.motion.at(time, *coordinates).origin.z)

    @property
    def _along(self) -> int:
        """How many numbers p has."""
        return 2 if self.flat else 3


LAWS_OWN = Chart()


@dataclass(frozen=True)
class BodyAxes(Chart):
    """(p, q, Ω) with Ω along the axes of the body, where its inertia is fixed."""

    def names(self, system: RollingSystem, law: Law) -> tuple[str, ...]:
        """Return the names of p, q, ω and of the support's own coordinates."""
        turning = ("omega_1", "omega_2", "omega_3")
        return (*CONTACT[: self._along], *CONTACT[3:7], *turning, *law.names(system)[10:])

    def traced(
        self,
        system: RollingSystem,
        law: Law,
        time: Scalar,
        state: Numbers,
        event_parameters: Numbers,
    ) -> Traced:
        """Return the rates by the law along the axes of the body."""
        k = self._along
        q, omega, coordinates = Quaternion(*state[k : k + 4]), state[k + 4 : k + 7], state[k + 7 :]
        place = self._place(system, time, state, coordinates)
        place, unit = _corrected(system, time, place, q, tuple(coordinates))
        axes = unit.matrix()
        seen = along_axes(system, axes, unit)
        p = axes.transpose @ place
        own = [*p, *_UPRIGHT, *omega, *coordinates]
        rates = law.rates(seen, time, own)
        turned = q * Quaternion(0.0, *omega)
        moved = [*(axes @ Vector(*rates[:3]))][:k]
        stops = law.event_functions(seen, time, own, event_parameters)
        found = [*moved, *(0.5 * part for part in turned), *rates[7:]]
        n = normal_at(seen, time, p, tuple(coordinates))
        return Traced(found, stops, n, lengths=_lengths(seen, time, p, coordinates))

    def tidied(self, system: RollingSystem, law: Law, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return the state with p on the support, and q/|q|."""
        k = self._along
        q, omega, coordinates = Quaternion(*state[k : k + 4]), state[k + 4 : k + 7], state[k + 7 :]
        place = self._place(system, time, state, coordinates)
        p, tidied = place, super().tidied(system, law, time, [*place, *q, *omega, *coordinates])
        return [*(p if self.flat else tidied[:3])][:k] + tidied[3:]

    def of_law(self, system: RollingSystem, time: float, state: Sequence[float]) -> list[float]:  # noqa: ARG002
        """Return p, q and ω = Qᵀ Ω."""
        q = Quaternion(*state[3:7])
        omega = q.matrix().transpose @ Vector(*state[7:10])
        return [*state[: self._along], *q, *omega, *state[10:]]

    def to_law(self, system: RollingSystem, time: Any, numbers: Numbers) -> list[Any]:
        """Return p, q and Ω."""
        k = self._along
        q, coordinates = Quaternion(*numbers[k : k + 4]), numbers[k + 7 :]
        Omega = Quaternion(*_unit(q)).matrix() @ Vector(*numbers[k + 4 : k + 7])
        return [*self._place(system, time, numbers, coordinates), *q, *Omega, *coordinates]


@dataclass(frozen=True)
class SupportAxes(Chart):
    """(p, q, Ω) of a support that turns steadily, along axes that turn with it: there its surface is at rest."""

    def names(self, system: RollingSystem, law: Law) -> tuple[str, ...]:
        """Return the names of p, q and Ω."""
        return (*CONTACT[: self._along], *law.names(system)[3:])

    def traced(
        self,
        system: RollingSystem,
        law: Law,
        time: Scalar,
        state: Numbers,
        event_parameters: Numbers,
    ) -> Traced:
        """Return the rates by the law along the axes of the support."""
        k, motion = self._along, system.support.motion
        now, half = motion.at(time), 0.5 * (motion.steady_rate * time)
        xp = namespace(half)
        q, Omega = Quaternion(*state[k : k + 4]), Vector(*state[k + 4 :])
        p = self._place(system, time, state, ())
        p, unit = p + system.support.surface.correction(p), _nearly_unit(q)
        seen = along_axes(system, now.rotation, Quaternion(xp.cos(half), 0.0, 0.0, xp.sin(half)) * unit)
        seen = replace(seen, support=replace(seen.support, motion=_SeenMotion(motion, now.rotation, True)))
        own = [*p, *unit, *Omega]
        rates, turning = law.rates(seen, time, own), now.angular_velocity
        moved = [*(Vector(*rates[:3]) - turning.cross(p))][:k]
        turned = Vector(*rates[7:10]) - turning.cross(Omega)
        stops = law.event_functions(seen, time, own, event_parameters)
        found = [*moved, *q.rate(Omega - turning), *turned]
        return Traced(found, stops, normal_at(seen, time, p), lengths=_lengths(seen, time, p))

    def tidied(self, system: RollingSystem, law: Law, time: Scalar, state: Numbers) -> list[Scalar]:  # noqa: ARG002
        """Return the state with p on the support, and q/|q|."""
        k = self._along
        p = self._place(system, time, state, ())
        p = p + system.support.surface.step_onto(p)
        return [*[*p][:k], *_unit(Quaternion(*state[k : k + 4])), *state[k + 4 :]]

    def of_law(self, system: RollingSystem, time: float, state: Sequence[float]) -> list[float]:
        """Return the numbers along the axes of the support."""
        given = [np.array([float(part)]) for part in state]
        (turned,) = np.stack(_turned(given, -_half_turn(system, np.array([time]))), axis=1)
        return [*turned[: self._along].tolist(), *turned[3:].tolist()]

    def to_law(self, system: RollingSystem, time: Any, numbers: Numbers) -> list[Any]:
        """Return the numbers along the axes of the support frame."""
        p = self._place(system, time, numbers, ())
        return _turned([*p, *numbers[self._along :]], _half_turn(system, time))


@dataclass(frozen=True)
class LineOfNodes(Chart):
    """A body of revolution on a plane: (x, y, θ, ψ, φ, w), w being Ω along the line of nodes, e₃×e₁ and its axis e₃.

    θ is the angle from the normal to the axis, ψ that of the line of nodes e₁ about the normal, and φ the body's own
    rotation. Where θ is near 0 or π there is no line of nodes, and another chart takes over.
    """

    flat: bool = True

    @property
    def bounded(self) -> bool:
        """Yes: it ends near θ = 0 and π."""
        return True

    def names(self, system: RollingSystem, law: Law) -> tuple[str, ...]:
        """Return the names of x, y, the angles, w and of the support's own coordinates."""
        return ("p_x", "p_y", "theta", "psi", "phi", "w_1", "w_2", "w_3", *law.names(system)[10:])

    def contains(self, state: Sequence[float]) -> bool:
        """Tell whether the axis is far enough from the normal."""
        return bool(_sine(Quaternion(*state[3:7])) > _INSIDE)

    def traced(
        self,
        system: RollingSystem,
        law: Law,
        time: Scalar,
        state: Numbers,
        event_parameters: Numbers,
    ) -> Traced:
        """Return the rates by the law along the line of nodes and the axis."""
        x, y, theta, psi, phi, *w = state[:8]
        coordinates = state[8:]
        xp = namespace(theta)
        s = xp.sin(theta)
        c = xp.cos(theta)
        axes = _nodes(s, c, xp.sin(psi), xp.cos(psi))
        # The law does not ask how far a body of revolution has turned about its axis; only loads may.
        body = replace(system.body, inertia=system.body.inertia.of_revolution)
        seen = replace(along_axes(system, axes, _from_angles(theta, psi, phi)), body=body)
        own = [*(axes.transpose @ self._place(system, time, (x, y), coordinates)), *_UPRIGHT, *w, *coordinates]
        rates = law.rates(seen, time, own)
        heading = w[1] / s  # ψ̇
        frame = Vector(w[0], w[1], heading * c)
        moved = axes @ Vector(*rates[:3])
        turned = Vector(*rates[7:10]) - frame.cross(Vector(*w))
        stops = law.event_functions(seen, time, own, event_parameters)
        stops[CHART] = s * s - _EDGE * _EDGE
        found = [moved.x, moved.y, w[0], heading, w[2] - heading * c, *turned, *rates[10:]]
        return Traced(found, stops, Vector(0.0, s, c), (s,))

    def tidied(self, system: RollingSystem, law: Law, time: Scalar, state: Numbers) -> list[Scalar]:  # noqa: ARG002
        """Return the state: nothing in it can be wrong."""
        return list(state)

    def reduced(self, numbers: Sequence[float]) -> list[float]:
        """Return its numbers with ψ and φ in ±2π: q has turned once after two turns of the body."""
        import math

        x, y, theta, psi, phi, *rest = numbers
        return [x, y, theta, math.remainder(psi, 4 * math.pi), math.remainder(phi, 4 * math.pi), *rest]

    def of_law(self, system: RollingSystem, time: float, state: Sequence[float]) -> list[float]:  # noqa: ARG002
        """Return the angles by half their sum and half their difference, so that q keeps its sign."""
        x, y, _, *rest = map(as_float, state)
        q, Omega, coordinates = Quaternion(*rest[:4]), Vector(*rest[4:7]), rest[7:]
        xp = namespace(*q)
        total, difference = xp.atan2(q.z, q.w), xp.atan2(q.y, q.x)
        theta = 2 * xp.atan2(xp.hypot(q.x, q.y), xp.hypot(q.w, q.z))
        psi = total + difference
        axes = _nodes(xp.sin(theta), xp.cos(theta), xp.sin(psi), xp.cos(psi))
        return [x, y, theta, psi, total - difference, *(axes.transpose @ Omega), *coordinates]

    def to_law(self, system: RollingSystem, time: Any, numbers: Numbers) -> list[Any]:
        """Return p, q and Ω."""
        x, y, theta, psi, phi, *w = numbers[:8]
        coordinates, xp = numbers[8:], namespace(theta)
        axes = _nodes(xp.sin(theta), xp.cos(theta), xp.sin(psi), xp.cos(psi))
        p = self._place(system, time, (x, y), coordinates)
        return [*p, *_from_angles(theta, psi, phi), *(axes @ Vector(*w)), *coordinates]


def charts(system: RollingSystem, law: Law) -> tuple[Chart, ...]:
    """Return the charts in which a law may be integrated, the law's own first.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.solve.laws import RollingLaw
    >>> coin = tr.RollingSystem(tr.Body.disc(0.012, mass=0.0075), tr.Support(tr.Plane()))
    >>> [type(chart).__name__ for chart in charts(coin, RollingLaw())]
    ['Chart', 'BodyAxes', 'LineOfNodes']
    """
    if law.variational:
        from .variational import charts_with_slopes

        return charts_with_slopes(system, law)
    # Event functions that take directions take them along the support frame's axes.
    if not law.in_charts or law.ends or system.corners:
        return (LAWS_OWN,)
    flat, rate = on_plane(system), system.support.motion.steady_rate
    found: list[Chart] = [LAWS_OWN, BodyAxes(flat)]
    # A surface of revolution is the same at any angle, and nothing else turns as fast.
    if rate is not None and rate != 0 and not system.support.surface.axisymmetric:
        found.append(SupportAxes(flat))
    if flat and system.body.axisymmetric:
        found.append(LineOfNodes())
    return tuple(found)


def _corrected(
    system: RollingSystem, time: Scalar, p: Vector, q: Quaternion, coordinates: tuple[Scalar, ...]
) -> tuple[Vector, Quaternion]:
    """Return p on the support and q of length 1, given both but for what rounding leaves, to the square of that.

    Steps do not mend it, and the law of a state that is off by ε turns the whole motion by about ε for each radian.
    """
    support = system.support.motion.at(time, *coordinates)
    return p + support.rotation @ system.support.surface.correction(support.local(p)), _nearly_unit(q)


def _nearly_unit(q: Quaternion) -> Quaternion:
    """Return q/|q|, without a root or a division, to the square of what |q| is off."""
    share = 1.5 - 0.5 * sum((part * part for part in q), 0.0)
    return Quaternion(*(part * share for part in q))


def _unturned(system: RollingSystem, law: Law) -> RollingSystem:
    """Return a system without the angle of a surface of revolution that turns steadily: it is the same at any.

    Variational equations take the numbers out of the system itself.
    """
    rate = system.support.motion.steady_rate
    if rate is None or is_zero(rate) or law.variational or not system.support.surface.axisymmetric:
        return system
    motion = _SeenMotion(system.support.motion, Matrix.identity(), True)
    return replace(system, support=replace(system.support, motion=motion))


def along_axes(system: RollingSystem, axes: Matrix, orientation: Quaternion) -> RollingSystem:
    """Return a system as it is seen along other axes through the same origin, for the instant.

    Parameters
    ----------
    system : RollingSystem
        Any.
    axes : Matrix
        From components along these axes to those in the support frame.
    orientation : Quaternion
        The body's, in the support frame, for loads that ask for it.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.loads import at_rest
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane()), gravity=10.0)
    >>> upside_down = Matrix.diagonal(1.0, -1.0, -1.0)
    >>> along_axes(level, upside_down, _UPRIGHT).acting_on(at_rest(2.0)).force.z
    20.0
    """
    loads = tuple(_SeenLoad(load, axes, orientation, load.at_contact) for load in system.all_loads)
    motion = _SeenMotion(system.support.motion, axes)
    return RollingSystem(system.body, replace(system.support, motion=motion, tilt=0.0), loads, 0.0)


@dataclass(frozen=True)
class _SeenMotion(Motion):
    """A motion, along other axes."""

    motion: Motion
    axes: Matrix
    turns_with_it: bool = False  # the axes are those of the support
    free: bool = field(init=False)
    coordinates: tuple[str, ...] = field(init=False)
    inertia: Any = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "free", self.motion.free)
        object.__setattr__(self, "coordinates", self.motion.coordinates)
        object.__setattr__(self, "inertia", self.motion.inertia if self.motion.free else None)

    def axle_torque(self, time: Scalar, coordinates: tuple[Scalar, ...]) -> Scalar:
        """Return what drives a free axle."""
        return self.motion.axle_torque(time, coordinates)

    def coordinate_rates(self, time: Scalar, coordinates: tuple[Scalar, ...], moment: Scalar) -> tuple[Scalar, ...]:
        """Return the rates of its coordinates."""
        return self.motion.coordinate_rates(time, coordinates, moment)

    def at(self, time: Scalar, *coordinates: Scalar) -> SupportState:
        """Return pose, twist and acceleration."""
        now, to = self.motion.at(time, *coordinates), self.axes.transpose
        vectors = (now.origin, now.velocity, now.acceleration, now.angular_velocity, now.angular_acceleration)
        rotation = Matrix.identity() if self.turns_with_it else to @ now.rotation
        return SupportState(rotation, *(to @ vector for vector in vectors))


@dataclass(frozen=True)
class _SeenLoad(Load):
    """A load, along other axes."""

    load: Load
    axes: Matrix
    orientation: Quaternion
    at_contact: bool = False

    def __post_init__(self) -> None:
        """Take it as it is."""

    def force(self, motion: BodyMotion) -> Vector:
        """Return the force."""
        return self._seen(self.load.force(self._plain(motion)))

    def torque(self, motion: BodyMotion) -> Vector:
        """Return the torque."""
        return self._seen(self.load.torque(self._plain(motion)))

    def torque_per_normal_force(self, motion: BodyMotion) -> Vector:
        """Return the couple for each newton of normal force."""
        return self._seen(self.load.torque_per_normal_force(self._plain(motion)))

    def _seen(self, vector: Vector) -> Vector:
        turned: Vector = self.axes.transpose @ vector
        return turned

    def _plain(self, motion: BodyMotion) -> BodyMotion:
        """Return the motion along the axes of the support frame."""
        axes, normal = self.axes, motion.normal
        return BodyMotion(
            motion.time,
            motion.mass,
            axes @ motion.position,
            axes @ motion.velocity,
            self.orientation,
            axes @ motion.angular_velocity,
            None if normal is None else axes @ normal,
            axes @ motion.support_angular_velocity,
        )


def _lengths(
    system: RollingSystem, time: Scalar, p: Vector, coordinates: Numbers = ()
) -> tuple[tuple[Scalar, Scalar], ...]:
    """Return lengths of a place on the support that are known beforehand."""
    support = system.support.motion.at(time, *coordinates)
    return system.support.surface.known_lengths(support.local(p))


def _nodes(s: Scalar, c: Scalar, sin_psi: Scalar, cos_psi: Scalar) -> Matrix:
    """Return the axes e₁, e₂ = e₃×e₁ and e₃ as columns, given sine and cosine of θ and ψ."""
    return Matrix(
        Vector(cos_psi, -(sin_psi * c), sin_psi * s), Vector(sin_psi, cos_psi * c, -(cos_psi * s)), Vector(0.0, s, c)
    )


def _from_angles(theta: Scalar, psi: Scalar, phi: Scalar) -> Quaternion:
    xp = namespace(theta)
    lean, total, difference = 0.5 * theta, 0.5 * (psi + phi), 0.5 * (psi - phi)
    c, s = xp.cos(lean), xp.sin(lean)
    return Quaternion(c * xp.cos(total), s * xp.cos(difference), s * xp.sin(difference), c * xp.sin(total))


def _half_turn(system: RollingSystem, times: Any) -> Any:
    """Return half the angle by which a support has turned that turns steadily, rad, without whole turns.

    From the last of some instants on it is a float; up to there a fraction, which a million turns leave exact.
    """
    rates, times = np.broadcast_arrays(np.asarray(system.support.motion.mean_rate, dtype=float), times)
    block = np.floor(times / _BLOCK)
    known, which = np.unique(np.stack([rates.ravel(), block.ravel()]), axis=1, return_inverse=True)
    whole = [float((Fraction(rate) * Fraction(begin * _BLOCK) / 2) % TURN) for rate, begin in known.T.tolist()]
    return np.array(whole)[which].reshape(times.shape) + 0.5 * rates * (times - block * _BLOCK)


def _turned(columns: Sequence[Any], half: Any) -> list[Any]:
    """Return p, q and Ω turned about the third axis, given half the angle."""
    px, py, pz, *q, Ox, Oy, Oz = columns
    c, s = np.cos(2 * half), np.sin(2 * half)
    turned = Quaternion(np.cos(half), 0.0, 0.0, np.sin(half)) * Quaternion(*q)
    return [c * px - s * py, s * px + c * py, pz, *turned, c * Ox - s * Oy, s * Ox + c * Oy, Oz]


def _unit(q: Quaternion) -> list[Scalar]:
    length = namespace(*q).sqrt(sum((part * part for part in q), 0.0))
    return [part / length for part in q]


def _sine(q: Quaternion) -> float:
    """Return the sine of the angle between the third axes of body and support frame."""
    import math

    w, x, y, z = map(float, q)
    return 2 * math.hypot(x, y) * math.hypot(w, z)
