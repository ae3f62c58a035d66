"""How a body is put down on its support, or over it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError, did_you_mean
from . import checks, fitting, line_contact
from .algebra import ZERO, Quaternion, Vector
from .attitude import attitude
from .contact import Contact, contact_at
from .duals import value_of
from .finiteness import check_finite
from .motions import SupportState
from .nearest import closest_contact, misplaced
from .scalars import Scalar, as_float, is_number, is_zero

if TYPE_CHECKING:
    from .system import RollingSystem, State

VELOCITY_WORDS = ("co-rotating", "rolling")  # let go at rest on the support; at the speed that rolls with the Ω given
IN_PROPORTION = 100.0  # times what is asked of a start: more must not follow from it
_ROUNDING = 4 * 2.0**-52
SLIP_TOLERANCE = 1e-9  # of the largest speed at the contact: beyond it a start slips
_OF_A_FALL = 1e-15  # of the speed to which a body falls by its size: less is rounding, were it all that moves


@dataclass(frozen=True)
class Placing:
    """A start as the user describes it; the parameters are those of `RollingSystem.place`.

    Examples
    --------
    See `RollingSystem.place`.
    """

    system: RollingSystem
    position: Any
    velocity: Any
    spin: Any
    angular_velocity: Any
    orientation: Any
    roll: Any
    attitude: Any
    height: Any
    time: Any
    support: Any

    def state(self, *, checked: bool = True) -> State:
        """Return the start, checked; or as its numbers have it, where those of a start like it were checked before."""
        return self.at_contact(checked=checked)[0]

    def at_contact(self, *, checked: bool = True) -> tuple[State, Contact]:
        """Return the same, and the contact at or over which it is."""
        from .system import State

        system, surface = self.system, self.system.support.surface
        time, coordinates = self._now, self._own
        if checked:
            check_finite(system, time, time)
        begin = system.support.motion.at(time, *coordinates)
        u, v = (
            checks.real(part, kind, f"position[{i}]")
            for i, (part, kind) in enumerate(zip(_pair(self.position, "position"), surface.coordinates, strict=True))
        )
        gap = checks.non_negative(self.height, "length", "height")
        if checked:
            fitting.check_place(surface, u, v, self.position)
        q = self._orientation(begin, begin.carried(surface.point(u, v)))
        contact = self._contact(begin.carried(surface.point(u, v)), q)
        offset = begin.rotation.transpose @ contact.offset
        contact = self._contact(begin.carried(surface.contact_from_coordinates(u, v, offset)), q)
        if checked:
            system.check_rim(contact, self.position)
            fitting.check_start(system, contact, q, self.position)
        turning = self._given_turning(contact, gap)
        V = self._velocity(contact, begin.local(contact.point), gap, turning)
        Omega = self._following_turning(contact, V) if turning is None else turning
        centre = contact.centre + contact.normal * gap
        if checked:
            self._check_no_slip(contact, V, Omega, gap)
            self._check_over(contact, centre, q, gap)
        start = State(_triple(centre), _triple(V), _triple(Omega), tuple(q), time, tuple(map(as_float, coordinates)))
        if checked:
            line_contact.check_start(system, start)
        return start, contact

    @cached_property
    def _now(self) -> float:
        return checks.real(self.time, "time", "time") + 0.0

    @cached_property
    def _own(self) -> tuple[Scalar, ...]:
        """Return the coordinates of the support's own motion, as given or as the motion itself starts."""
        motion = self.system.support.motion
        if self.support is None:
            return motion.initial_coordinates()
        given = None if isinstance(self.support, (str, bytes)) or not hasattr(self.support, "__len__") else self.support
        if given is None or len(given) != len(motion.coordinates):
            asked = ", ".join(motion.coordinates) or "nothing: this support's motion is a function of the time alone"
            raise InvalidValueError("support", f"must hold {asked}", self.support, "Leave it out, or give each.")
        kinds = zip(given, motion.coordinate_kinds, strict=True)
        return tuple(checks.real(part, kind, f"support[{i}]") for i, (part, kind) in enumerate(kinds))

    def _contact(self, point: Vector, q: Quaternion) -> Contact:
        """Return the contact there, or say that the body would touch on a side that its shape does not cover."""
        try:
            contact = contact_at(self.system, self._now, point, q, self._own)
            covered = self.system.body.shape.validity_margin(-(contact.normal @ q.matrix()))
        except (ArithmeticError, ValueError):
            covered = 0.0
        if covered is None or covered > fitting.EDGE:
            return contact
        given = (1.0, 0.0, 0.0, 0.0) if self.orientation is None else self.orientation
        raise InvalidValueError(
            "orientation" if self.attitude is None else "attitude",
            "must let the body touch in one point of its round side",
            given if self.attitude is None else self.attitude,
            "There it lies flat or on its edge, which its shape does not cover: turn it. A disc upright on its rim "
            "has `attitude` (heading, 90°, turn).",
        ) from None

    def _orientation(self, begin: SupportState, point: Vector) -> Quaternion:
        """Return q from `orientation`, from `attitude`, or as a cylinder is laid down."""
        laid = self.system.body.shape.axis is not None and self.orientation is None and self.attitude is None
        if not laid and not is_zero(self.roll):
            raise InvalidValueError("roll", "belongs to a cylinder put down without `orientation`", self.roll)
        if self.attitude is not None and self.orientation is not None:
            raise InvalidValueError(
                "attitude", "must not stand beside `orientation`", self.attitude, "Give one of the two."
            )
        surface = self.system.support.surface
        if self.attitude is not None:
            angles = checks.components(self.attitude, "angle", "attitude")
            there = begin.local(point)
            first, n = surface.directions(there)[0], surface.normal(there)
            # Not the second direction but n × e₁: the two coordinates need not grow at right angles.
            axes = (begin.rotation @ first, begin.rotation @ n.cross(first), begin.rotation @ n)
            return attitude(*axes, *angles)
        q = _unit_quaternion((1.0, 0.0, 0.0, 0.0) if self.orientation is None else self.orientation)
        if not laid:
            return q
        turned = checks.real(self.roll, "angle", "roll")
        return line_contact.facing(
            contact_at(self.system, self._now, point, q, self._own), begin, surface, self.velocity, turned
        )

    def _velocity(self, contact: Contact, there: Vector, gap: float, turning: Vector | None) -> Vector:
        """Return V from its components along the surface; one along n that is not given follows from the contact."""
        begin, rho, n = contact.support, contact.offset, contact.normal
        first, second = (begin.rotation @ e for e in self.system.support.surface.directions(there))
        velocity, u = self.velocity, begin.material_velocity(contact.point)
        if self._word == "rolling":
            return u - self._rolled(gap, turning).cross(rho)
        if self._word == "co-rotating":
            carried = begin.material_velocity(contact.centre)
            along: tuple[Any, ...] = (carried.dot(first), carried.dot(second))
        else:
            three = velocity is not None and not hasattr(velocity, "to") and _length(velocity) == 3
            along = checks.components(
                (0.0, 0.0) if velocity is None else velocity, "velocity", "velocity", 3 if three else 2
            )
        V = first * along[0] + second * along[1]
        if len(along) == 3:
            return V + n * along[2]
        if gap > 0:
            return V
        rolling = rolling_along(V, u, rho, n)
        self._check_proportion(rolling, V, u)
        if turning is None or slips(self.system, contact, rolling, turning) is None:
            return rolling
        return not_opening(V, u, turning, rho, n)

    @property
    def _word(self) -> str | None:
        """Return the word that stands for a velocity, where one does."""
        if not isinstance(self.velocity, str):
            return None
        if self.velocity not in VELOCITY_WORDS:
            words = " or ".join(f'"{word}"' for word in VELOCITY_WORDS)
            remedy = did_you_mean(self.velocity, VELOCITY_WORDS).strip()
            raise InvalidValueError("velocity", f"must be two components, {words}", self.velocity, remedy)
        return self.velocity

    def _rolled(self, gap: float, turning: Vector | None) -> Vector:
        """Return the Ω that says at which velocity the body rolls."""
        if gap > 0:
            raise InvalidValueError(
                "velocity", 'must not be "rolling" above the support', self.velocity, "Leave out `height`."
            )
        if turning is None:
            remedy = "Give all three components of `angular_velocity`; with `spin`, give the velocity."
            raise InvalidValueError("velocity", 'must have Ω beside it where it is "rolling"', self.velocity, remedy)
        return turning

    def _given_turning(self, contact: Contact, gap: float) -> Vector | None:
        """Return Ω where it is given, or where nothing else could say it."""
        if self.angular_velocity is not None:
            if self.spin is not None:
                raise InvalidValueError(
                    "angular_velocity", "must not stand beside `spin`", self.angular_velocity, "Give one of the two."
                )
            return Vector(*checks.components(self.angular_velocity, "angular velocity", "angular_velocity"))
        if gap > 0:
            about = 0.0 if self.spin is None else checks.real(self.spin, "angular velocity", "spin")
            return contact.normal * about
        return None

    def _following_turning(self, contact: Contact, V: Vector) -> Vector:
        """Return the Ω with V = u − Ω×ρ and the spin asked for."""
        n, rho, u = contact.normal, contact.offset, contact.support.material_velocity(contact.point)
        turning = contact.support.angular_velocity.dot(n) if isinstance(self.velocity, str) else 0.0
        about_normal = turning if self.spin is None else checks.real(self.spin, "angular velocity", "spin")
        relative = V - u
        if not isinstance(self.velocity, str) and self.velocity is not None and _length(self.velocity) == 3:
            relative = rolling_along(relative, ZERO, rho, n)
        Omega = rolling_rate(relative, rho, n, about_normal)
        self._check_proportion(Omega * rho.norm(), V, u, n * (about_normal * rho.norm()))
        return Omega

    def _check_proportion(self, follows: Vector, *given: Vector) -> None:
        """Refuse what follows from rolling where it is out of all proportion: the body all but lies on its side."""
        most = max(value_of(v.norm()) for v in given)
        if value_of(follows.norm()) <= IN_PROPORTION * most:
            return
        key = "orientation" if self.attitude is None else "attitude"
        value = (1.0, 0.0, 0.0, 0.0) if self.orientation is None else self.orientation
        raise InvalidValueError(
            key,
            "must not let the body all but lie on its side",
            value if self.attitude is None else self.attitude,
            f"Where {most:.3g} m/s are asked for it would have to move at {float(follows.norm()):.3g} m/s to roll. Let "
            "it stand up more, or give all three components of `velocity`, and `angular_velocity`.",
        )

    def _check_over(self, contact: Contact, centre: Vector, q: Quaternion, gap: float) -> None:
        """Refuse a height at which the body is no longer nearest to the place over which it is asked for."""
        if not gap > 0:
            return
        elsewhere = misplaced(self.system, contact, centre, q)
        if not elsewhere:
            nearest = closest_contact(self.system, self._now, centre, q, self._own)
            gap, here = ((centre + at.offset - at.point).dot(at.normal) for at in (nearest, contact))
            if gap < here - SLIP_TOLERANCE * contact.offset.norm():
                shown = ", ".join(f"{part:.4g}" for part in nearest.point)
                elsewhere = f"It is nearer to the support at ({shown}) m: {gap:.4g} m."
        if elsewhere:
            rule, remedy = "must leave the body nearest to `position`", "Put it lower, or over another place."
            raise InvalidValueError("height", rule, self.height, f"{elsewhere} {remedy}")

    def _check_no_slip(self, contact: Contact, V: Vector, Omega: Vector, gap: float) -> None:
        """Refuse a start that slips where nothing says how rough the support is."""
        if gap > 0 or self.system.support.friction is not None:
            return
        slip = slips(self.system, contact, V, Omega)
        if slip is not None:
            raise InvalidValueError(
                "angular_velocity",
                "must agree with rolling, V + Ω×ρ = u(p), where the support has no `friction`",
                f"a slip of {slip:.6g} m/s",
                'Let one follow from no slip: give `spin` instead, or `velocity = "rolling"`; or give the support a '
                "friction.",
            )


def slips(system: RollingSystem, contact: Contact, V: Vector, Omega: Vector) -> float | None:
    """Return how fast the contact slips along the support; None where that is rounding.

    Where nothing moves it is of the speed to which the body falls by its size: sin(π) of a support that rocks is none.
    """
    s = contact.slip_velocity(V, Omega)
    along = (s - contact.normal * s.dot(contact.normal)).norm()
    u = contact.support.material_velocity(contact.point)
    arm = value_of(contact.offset.norm())
    least = _OF_A_FALL * math.sqrt(value_of(system.gravity) * arm)
    scale = max(V.norm(), Omega.norm() * arm, u.norm())
    return float(value_of(along)) if along > max(SLIP_TOLERANCE * scale, least) else None


def no_gap(contact: Contact, centre: Any) -> float:
    """Return the gap that a body may have which touches, m: what is asked of a start, or what rounding leaves of it."""
    places = Vector(*centre).norm() + contact.point.norm()
    return float(max(SLIP_TOLERANCE * value_of(contact.offset.norm()), _ROUNDING * value_of(places)))


def _length(value: Any) -> int:
    return len(value) if hasattr(value, "__len__") and not isinstance(value, (str, bytes)) else 0


def _triple(v: Vector) -> tuple[float, float, float]:
    return v.x + 0.0, v.y + 0.0, v.z + 0.0  # + 0.0 turns -0.0 into 0.0


def _pair(value: Any, key: str) -> tuple[Any, Any]:
    """Return two parts of whatever kinds; `checks.components` is for parts of one kind."""
    parts = None if isinstance(value, (str, bytes)) or not hasattr(value, "__len__") else tuple(value)
    if parts is None or len(parts) != 2:
        raise InvalidValueError(key, "must be a list of 2 components", value)
    return parts


def _unit_quaternion(orientation: Any) -> Quaternion:
    parts = checks.components(orientation, "number", "orientation", 4)
    length = math.hypot(*map(value_of, parts))
    if not 0 < length < math.inf:
        raise InvalidValueError("orientation", "must be a quaternion other than zero", orientation)
    if all(map(is_number, parts)) and abs(length - 1) < 4e-16:  # it is one already: keep it to the last digit
        return Quaternion(*parts)
    return Quaternion(*parts).unit


def rolling_along(V: Vector, u: Vector, rho: Vector, n: Vector) -> Vector:
    """Return V with another component along n, so that some Ω can match it: V·ρ = u·ρ."""
    return V + n * ((u - V).dot(rho) / n.dot(rho))


def not_opening(V: Vector, u: Vector, Omega: Vector, rho: Vector, n: Vector) -> Vector:
    """Return V with another component along n, so that nothing opens or closes: n·(V + Ω×ρ − u) = 0."""
    return V + n * (u - V - Omega.cross(rho)).dot(n)


def rolling_rate(relative: Vector, rho: Vector, n: Vector, spin: Scalar) -> Vector:
    """Solve ρ×Ω = V − u for the Ω with Ω·n = spin."""
    across = relative.cross(rho) / rho.dot(rho)
    return across + rho * ((spin - across.dot(n)) / rho.dot(n))
