"""Slip so slow that friction settles its direction at once: how fast s would change for friction in any direction.

Friction turns the slip towards the one direction that it keeps, at a rate that grows as 1/|s|. A slip that has only
just begun, or will soon end, is therefore all but settled: ŝ follows from where the body is, and only |s| has a rate.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .algebra import Quaternion, Vector
from .contact import Contact
from .records import frozen_record
from .scalars import Scalar, namespace
from .slipping import response, unpushed, unturned

if TYPE_CHECKING:
    from .system import RollingSystem

_STEPS = 5  # of Newton's method, each of which squares the error


@frozen_record()
class SlipRates:
    """How s changes at one instant for friction against any direction ŝ = e₁ cos β + e₂ sin β (T4, with ŝ free).

    Its vectors hold components along e₁, e₂ and n.
    """

    axes: tuple[Vector, Vector, Vector]  # e₁, e₂, n
    friction: Scalar  # μ of slipping
    free: Vector  # the rate of s without a contact force, m/s²
    opening: Scalar  # the rate of s·n without a contact force, m/s²
    pressed: Vector  # of s, for each newton of N without friction, 1/kg
    rubbed: tuple[Vector, Vector]  # of s, for each newton along e₁ and e₂, 1/kg

    def answer(self, c: Scalar, s: Scalar) -> Vector:
        """Return a₁, how s answers to each newton of N, given cos β and sin β, 1/kg."""
        return self.pressed - (self.rubbed[0] * c + self.rubbed[1] * s) * self.friction

    def normal_force(self, c: Scalar, s: Scalar) -> Scalar:
        """Return N, N."""
        return -self.opening / self.answer(c, s).z

    def along(self, c: Scalar, s: Scalar) -> tuple[Scalar, Scalar]:
        """Return the rate of s along e₁ and e₂, m/s²."""
        answer = self.answer(c, s)
        N = -self.opening / answer.z
        return self.free.x + answer.x * N, self.free.y + answer.y * N

    def along_and_pressing(self, c: Scalar, s: Scalar) -> tuple[Scalar, Scalar, Scalar]:
        """Return the same, each times a₁·n, and that: no direction makes them infinite."""
        answer = self.answer(c, s)
        return (
            self.free.x * answer.z - answer.x * self.opening,
            self.free.y * answer.z - answer.y * self.opening,
            answer.z,
        )

    def direction(self, c: Scalar, s: Scalar) -> Vector:
        """Return ŝ."""
        return self.axes[0] * c + self.axes[1] * s

    def settled(self, c: Scalar = 1.0, s: Scalar = 0.0) -> tuple[Scalar, Scalar, Scalar]:
        """Return cos β and sin β of the direction that slip keeps, and |s| times the rate at which it settles.

        Newton's method on t̂·ṡ = 0, t̂ = n×ŝ, from near a direction, e₁ if none is given; the last, m/s², is
        −d(t̂·ṡ)/dβ.
        """
        beta: Scalar = namespace(c, s).atan2(s, c) if s else 0.0
        for step in range(_STEPS + 1):
            first, second = self.along(c, s)
            answer, N = self.answer(c, s), self.normal_force(c, s)
            turned = (self.rubbed[0] * s - self.rubbed[1] * c) * self.friction  # da₁/dβ
            N_turned = -N * turned.z / answer.z
            first_turned, second_turned = (
                a * N + b * N_turned for a, b in ((turned.x, answer.x), (turned.y, answer.y))
            )
            slope = c * (second_turned - first) - s * (first_turned + second)
            if step == _STEPS:
                break
            beta = beta - (c * second - s * first) / slope
            xp = namespace(beta)
            c, s = xp.cos(beta), xp.sin(beta)
        return c, s, -slope


def slip_rates(
    system: RollingSystem,
    time: Scalar,
    contact: Contact,
    orientation: Quaternion,
    angular_velocity: Vector,
    first: Vector,
    slip_velocity: Vector,
    coordinates: tuple[Scalar, ...] = (),
    *,
    held: bool = False,
) -> SlipRates:
    """Return how s would change for friction in any direction.

    Examples
    --------
    On a slope of 45° with μ = 1/7, half of what rolling takes, a ball begins to slip straight down:

    >>> import math
    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import E_X, ZERO
    >>> from trundle.mechanics.contact import contact_at
    >>> slope = tr.Support(tr.Plane(), tilt=math.pi / 4, friction=1 / 7)
    >>> slope = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), slope, gravity=2**0.5)
    >>> still = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> rates = slip_rates(slope, 0.0, contact_at(slope, 0.0, ZERO, still), still, ZERO, E_X, ZERO)
    >>> round(rates.along(1.0, 0.0)[0], 15), round(rates.settled()[2], 15)  # g sin α − (7/2) μ g cos α
    (0.5, 1.0)
    """
    n = contact.normal
    Omega = unturned(contact, angular_velocity) if held else angular_velocity
    free = unpushed(system, time, contact, orientation, Omega, slip_velocity, coordinates, held=held)
    axes = first, n.cross(first), n

    def parts(v: Vector) -> Vector:
        return Vector(*(v.dot(e) for e in axes))

    couple = free.acting.couple if free.acting.has_couple else None
    pressed = response(system, contact, free.inertia, n, couple).slip
    rubbed, rubbed_across = (parts(response(system, contact, free.inertia, e).slip) for e in axes[:2])
    mu = system.support.sliding_friction
    return SlipRates(axes, mu, parts(free.slip_rate), free.opening, parts(pressed), (rubbed, rubbed_across))
