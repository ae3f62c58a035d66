"""Landings: the impulse of a hard contact with Coulomb friction, by Darboux and Keller's equations.

The normal impulse P grows while the body stays where it is; the slip velocity follows ds/dP = M(n − μ ŝ), and slipping
may stop or turn on the way (Keller 1986). Compression ends where s·n = 0, and the impact where the share e² of the work
of compression is given back (Stronge 1990). Then the share e_t² of what friction took is given back too, as far as
friction can: Garwin's superball (1969) and Cross's grip and slip (2002). So no landing makes energy, whatever the body.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ..errors import SolverError
from .algebra import E_X, E_Y, E_Z, ZERO, Matrix, Quaternion, Vector
from .contact import Contact
from .duals import has_duals, value_of, values_of
from .onset import onset
from .records import frozen_record
from .scalars import Scalar, as_float, is_zero, less, namespace
from .slipping import response
from .turning_slip import TurningSlip

if TYPE_CHECKING:
    from .system import RollingSystem

_SLOW = 1e-14  # share of the speed at impact from which on slipping ends along a straight line
_STRAIGHT = 1e-15  # share of M by which slip that goes on along one line seems to turn
_MOST_PIECES = 20


@frozen_record()
class Impact:
    """What a landing does."""

    impulse: Vector  # P on the body, N s, in the inertial support frame
    # `velocity_change`, `angular_velocity_change`: of the body, m/s and rad/s
    velocity_change: Vector
    angular_velocity_change: Vector
    axle_rate_change: float  # of a free axle, rad/s


def land(system: RollingSystem, contact: Contact, orientation: Quaternion, slip: Vector) -> Impact:
    """Return what the support's impulse does to a body that comes down on it.

    Examples
    --------
    A solid ball dropped on a rough floor with sidewards speed 1 keeps 5/7 of it and rolls off:

    >>> import trundle as tr
    >>> from trundle.mechanics.contact import contact_at
    >>> floor = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane()))
    >>> still = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> contact = contact_at(floor, 0.0, Vector(0.0, 0.0, 0.0), still)
    >>> struck = land(floor, contact, still, Vector(1.0, 0.0, -3.0))
    >>> round(1.0 + struck.velocity_change.x, 12) == round(5 / 7, 12), struck.velocity_change.z
    (True, 3.0)

    On a floor that gives the slip back as well it keeps 3/7 (Garwin 1969):

    >>> elastic = tr.Support(tr.Plane(), restitution=1.0, tangential_restitution=1.0)
    >>> rough = tr.RollingSystem(floor.body, elastic)
    >>> round(1.0 + land(rough, contact, still, Vector(1.0, 0.0, -3.0)).velocity_change.x, 12) == round(3 / 7, 12)
    True
    """
    J = system.body.inertia_in_space(orientation.matrix())
    basis = _basis(contact.normal)
    M = Matrix(*(_along(basis, response(system, contact, J, e).slip) for e in basis)).transpose
    mu = math.inf if system.support.friction is None else as_float(system.support.sliding_friction)
    begin = _along(basis, slip)
    shares = as_float(system.support.restitution), as_float(system.support.tangential_restitution)
    (x, y, z), (first, second, n) = _Course(M, mu, *shares, begin).impulse(), basis
    P = first * x + second * y + n * z
    motion = system.support.motion
    axle = -contact.support.lever(contact.point).dot(P) / motion.inertia if motion.free else 0.0
    return Impact(P, P / system.body.mass, J.solve(contact.offset.cross(P)), axle)


def keeps_direction(system: RollingSystem) -> bool:
    """Tell whether the slip of a body that lands keeps to one line: `straight_impulse` holds.

    It does where a push along the support answers alike all round. Else it does without friction, or with as much as it
    takes if nothing of the slip is given back.

    Examples
    --------
    >>> import trundle as tr
    >>> floor, egg = tr.Support(tr.Plane(), friction=0.2), tr.Body.ellipsoid((0.3, 0.2, 0.1), mass=1.0)
    >>> ball = tr.Body.solid_sphere(0.1, 1.0)
    >>> keeps_direction(tr.RollingSystem(ball, floor)), keeps_direction(tr.RollingSystem(egg, floor))
    (True, False)
    """
    support = system.support
    alike = system.body.is_isotropic_sphere and not support.motion.free
    return alike or support.friction == 0 or (support.friction is None and support.tangential_restitution == 0)


def straight_impulse(system: RollingSystem, contact: Contact, orientation: Quaternion, slip: Vector) -> Vector:
    """Return the impulse of a landing in which slip keeps to one line, N s, for any scalar; `land` is for any landing.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.contact import contact_at
    >>> floor = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane(), friction=0.1))
    >>> still = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> contact = contact_at(floor, 0.0, Vector(0.0, 0.0, 0.0), still)
    >>> P = straight_impulse(floor, contact, still, Vector(3.0, 0.0, -3.0))
    >>> round(P.x, 12), round(P.z, 12)
    (-0.6, 6.0)

    With friction enough Garwin's superball (1969) slips as fast the other way:

    >>> superball = tr.Support(tr.Plane(), restitution=1.0, tangential_restitution=1.0)
    >>> bounces = tr.RollingSystem(floor.body, superball)
    >>> P = straight_impulse(bounces, contact, still, Vector(1.0, 0.0, -3.0))
    >>> round(1.0 + P.x / 2.0 * (1.0 + 5 / 2), 12)  # with what the turning does to the point that touches
    -1.0
    """
    n, support = contact.normal, system.support
    J = system.body.inertia_in_space(orientation.matrix())
    M = Matrix(*(response(system, contact, J, e).slip for e in (E_X, E_Y, E_Z))).transpose
    normal = Matrix.outer(n, n)
    along = Matrix.identity() - normal
    s = slip.dot(n)
    xp = namespace(s, *n)
    ending = (along @ M @ along + normal).solve(-(along @ slip))  # what ends the slip, along the support
    back = 1.0 + support.tangential_restitution
    if support.friction is None:
        holding = M.solve(n)
        closing = s + n.dot(M @ ending)
        closing = xp.where(less(closing, 0.0), -closing, 0.0)
        return ending * back + holding * ((1.0 + support.restitution) * closing)
    closing = xp.where(less(s, 0.0), -s, 0.0)
    N = (1.0 + support.restitution) * closing / n.dot(M @ n)
    size, most = ending.norm(), support.sliding_friction * N
    enough = less(most, back * size)
    share = xp.where(enough, most / xp.where(enough, size, 1.0), back)
    return ending * share + n * N


def _basis(n: Vector) -> tuple[Vector, Vector, Vector]:
    """Return two tangents and n."""
    first = n.cross(E_X if abs(n.x) < 0.9 else E_Z)
    first = first / first.norm()
    return first, n.cross(first), n


def _along(basis: tuple[Vector, Vector, Vector], v: Vector) -> Vector:
    """Return a vector's parts along a basis."""
    first, second, n = basis
    return Vector(as_float(v.dot(first)), as_float(v.dot(second)), as_float(v.dot(n)))


def _pushed_along(M: Matrix, mu: Scalar, c: Any, s: Any) -> tuple[Any, Any]:
    """Return the change of slip for each unit of P, along both tangents, against friction on the way (c, s)."""
    first, second, _ = M.rows
    return first.z - mu * (first.x * c + first.y * s), second.z - mu * (second.x * c + second.y * s)


def _length(v: Vector) -> Any:
    """Return the length of the part of a vector along the support."""
    return namespace(v.x, v.y).hypot(v.x, v.y)


def _root(square: Any) -> Any:
    return namespace(square).sqrt(square)


@dataclass
class _Course:
    """The course of s over the normal impulse, along two tangents and n."""

    M: Matrix  # 1/kg
    mu: float  # inf: no limit
    restitution: float
    tangential_restitution: float
    slip: Vector  # m/s
    work: float = 0.0  # of the normal impulse, J; falls in compression
    aim: float | None = None  # the work at which it ends, once compression is over
    taken: float = 0.0  # by friction, J
    unused: float = 0.0  # what friction could have given besides while it held, N s

    def impulse(self) -> Vector:
        """Return the whole impulse, N s."""
        begun, ending = self.slip, ZERO if self.tangential_restitution == 0 else self._ending()
        total = self._to_the_end()
        if self.restitution == 0:
            total = total - self._rounding_of(begun + self.M @ total - self.slip)
        return total + self._given_back(ending) if self.tangential_restitution and self.unused > 0 else total

    def _rounding_of(self, off: Vector) -> Vector:
        """Return what an impulse errs by that leaves some slip where none is to be left, N s.

        A light impulse turns a long body fast: what rounding of it leaves of s is much beside the body's momentum.
        """
        held = is_zero(self.slip.x) and is_zero(self.slip.y)
        return self.M.solve(off) if held else E_Z * (off.z / self.M.c.z)

    def _ending(self) -> Vector:
        """Return the impulse along the support that ends the slip by itself, N s."""
        (xx, xy, _), (yx, yy, _), _ = self.M.rows
        x, y, _ = self.slip
        return Vector(xy * y - yy * x, yx * x - xx * y, 0.0) / (xx * yy - xy * yx)

    def _end_at_once(self) -> Vector:
        """End the slip by an impulse along the support alone, and return it, N s."""
        ending = self._ending()
        self.taken -= 0.5 * self.slip.dot(ending)
        self.slip = Vector(0.0, 0.0, self.slip.z + self.M.c.dot(ending))
        return ending

    def _to_the_end(self) -> Vector:
        """Return the impulse of Keller's course, up to where the share e² of compression is given back, N s."""
        total, size = ZERO, self.slip.norm()
        if math.isinf(value_of(self.mu)):  # friction without limit: slip ends at once
            total = self._end_at_once()
        for _ in range(_MOST_PIECES):
            if self.aim is None and self.slip.z >= 0:
                self.aim = (1 - self.restitution**2) * self.work
            if self.aim is not None and self.work >= self.aim:
                return total
            sigma = _length(self.slip)
            if self.mu and sigma > 2 * _SLOW * size:
                total = total + self._slide(size)
                continue
            if self._holds and not is_zero(sigma):  # how it ends makes a difference of the order of σ² only
                total = total + self._end_at_once()
            total = total + self._straight(self._held)
        raise SolverError("A landing does not end: friction and the body's shape jam it. Use less friction.")

    def _given_back(self, direction: Vector) -> Vector:
        """Return the impulse by which a contact that holds gives back the share e_t² of what friction took, N s.

        It is along the one that ends the slip, and at most what friction left unused. Where it presses the body onto
        the support, the support holds against it and does no work.
        """
        given, left, turned = ZERO, self.tangential_restitution**2 * max(0.0, self.taken), 0.0
        pressing = -self.M.c.dot(direction)
        free = max(0.0, self.slip.z) / pressing if pressing > 0 else math.inf
        while True:
            change = self.M @ direction
            gain = direction.x * change.x + direction.y * change.y
            size = _length(direction) - (self.mu * direction.z if direction.z else 0.0)
            root = _root(turned**2 + 2 * gain * left)
            amount = min(2 * left / (turned + root) if root else 0.0, self.unused / size if size > 0 else math.inf)
            if amount <= free:
                return given + direction * amount
            given, left = given + direction * free, max(0.0, left - 0.5 * gain * free**2)
            turned, self.unused = gain * free, self.unused - size * free
            direction, free = direction + E_Z * (pressing / self.M.c.z), math.inf

    @cached_property
    def _holding(self) -> Vector:
        """The impulse for each unit of P that M takes to the normal."""
        answer = self.M.solve(E_Z)
        return answer / answer.z

    @cached_property
    def _holds(self) -> bool:
        """Whether friction can keep a contact from slipping."""
        return self.mu > 0 and _length(self._holding) <= self.mu

    @cached_property
    def _held(self) -> Vector:
        """The impulse for each unit of P of a contact that does not slip, or that begins to."""
        if self._holds:
            return self._holding
        if self.mu == 0:
            return E_Z
        c, s = self._beginning()
        return Vector(-self.mu * c, -self.mu * s, 1.0)

    def _beginning(self) -> tuple[Scalar, Scalar]:
        """Return the direction in which slipping begins: the one that its own friction leads along."""
        M, mu = values_of((self.M, self.mu))
        found = onset(lambda c, s: (*_pushed_along(M, mu, c, s), 1.0))
        if not found:
            raise SolverError("A landing jams: no direction of slipping leads on. Use less friction.")
        c, s = found[0][1]
        if not has_duals((self.M, self.mu)):
            return c, s
        # A root that was searched for has no slopes: those of Newton's method from there.
        first, second = _pushed_along(self.M, self.mu, c, s)
        x, y = (now - along for now, along in zip(_pushed_along(M, mu, -s, c), (M.rows[0].z, M.rows[1].z), strict=True))
        turned = (s * first - c * second) / (c * y - s * x - value_of(c * first + s * second))
        return c - s * turned, s + c * turned

    def _straight(self, direction: Vector, still: float = math.inf) -> Vector:
        """Go on with a fixed direction of the impulse to the end of compression, or of the impact.

        Slip that falls straight to nothing ends it sooner, at the normal impulse at which it is `still`.
        """
        change, s = self.M @ direction, self.slip
        if not change.z > 0 and math.isinf(still):
            raise SolverError("A landing jams: the impulse does not push the body off. Use less friction.")
        if not change.z > 0:
            upto = math.inf
        elif self.aim is None:
            upto = -s.z / change.z
        else:  # the work s_n P + ½ c P² still to be done
            upto = (-s.z + _root(s.z * s.z + 2 * change.z * (self.aim - self.work))) / change.z
        amount = min(upto, still)
        self.work += s.z * amount + 0.5 * change.z * amount**2
        x, y, z = s + change * amount
        if direction is self._holding:  # nothing slips: of what rounding says of it e_t would give back the root
            x = y = 0.0
            self.unused += (self.mu - _length(direction)) * amount if amount else 0.0
        self.taken -= 0.5 * amount * (direction.x * (s.x + x) + direction.y * (s.y + y))
        if still <= upto:
            x = y = 0.0
        elif self.aim is None:
            z = 0.0
        else:
            self.work = max(self.work, self.aim)
        self.slip = Vector(x, y, z)
        return direction * amount

    def _slide(self, size: float) -> Vector:
        """Go on slipping until slip or compression ends, or the impact: along a line where friction keeps to one."""
        sigma = _length(self.slip)
        c, s = self.slip.x / sigma, self.slip.y / sigma
        change = self.M @ Vector(-self.mu * c, -self.mu * s, 1.0)
        turns = abs(c * change.y - s * change.x)
        if turns and turns > _STRAIGHT * max(row.norm() for row in self.M.rows):
            return self._curved(size)
        return self._straight_on()

    def _straight_on(self) -> Vector:
        """Go on along the line on which it slips."""
        sigma = _length(self.slip)
        c, s = self.slip.x / sigma, self.slip.y / sigma
        direction = Vector(-self.mu * c, -self.mu * s, 1.0)
        change = self.M @ direction
        growth = c * change.x + s * change.y
        return self._straight(direction, -sigma / growth if growth < 0 else math.inf)

    def _curved(self, size: float) -> Vector:
        """Do the same where slip turns on the way; of speeds `size` is the unit, and by M of impulses and work."""
        unit = self.M.c.z
        joule = size * size / unit
        sigma, begun = _length(self.slip), self.slip
        slips = TurningSlip(
            M=[list(row / unit) for row in self.M.rows],
            mu=self.mu,
            size=sigma / size,
            c=begun.x / sigma,
            s=begun.y / sigma,
            up=begun.z / size,
            work=self.work / joule,
            taken=self.taken / joule,
        )
        found = slips.followed(_SLOW, None if self.aim is None else self.aim / joule)
        if found is None:
            raise SolverError("A landing does not end: friction and the body's shape jam it. Use less friction.")
        now, stopped = found
        self.slip = Vector(now.size * now.c, now.size * now.s, now.up) * size
        self.taken, self.work = now.taken * joule, now.work * joule
        if not stopped and self.aim is None:
            self.slip = Vector(self.slip.x, self.slip.y, 0.0)
        elif not stopped and self.aim is not None:
            self.work = self.aim
        done = self.M.solve(self.slip - begun)  # added up it would have fewer digits: ŝ turns fast where slip ends
        return done + self._straight_on() if stopped else done
