"""A landing whose slip turns on the way, over any scalar: the course of `mechanics.impact` as a loop without branches.

It takes the same series as a run does, fewer terms of them and so shorter steps. All is in units of the impact, as in
`mechanics.turning_slip`: speeds as shares of the slip at first, M of its part along the normal.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..mechanics.algebra import E_X, E_Z, Matrix, Quaternion, Vector
from ..mechanics.contact import Contact
from ..mechanics.scalars import Scalar, less, namespace
from ..mechanics.slipping import response
from ..mechanics.system import RollingSystem
from ..mechanics.turning_slip import TurningSlip, polynomial
from ..solve.tape import repeated

_TERMS = 10  # of a series
_PRECISION = 1e-16  # of what the last of them are, as a share
_SLOW = 2e-14  # share of the speed at impact below which nothing slips
_MOST = 4000.0  # steps; a landing of more jams
_NEWTON = 4  # steps to a root of what is all but straight
_TRIED = 12  # directions in which slip may begin again
_NO_LIMIT = 1e30  # coefficient of friction
_LEAST, _FAR = 1e-300, 1e300


def turning_impulse(system: RollingSystem, contact: Contact, orientation: Quaternion, slip: Vector) -> Vector:
    """Return the impulse of any landing, N s, for any scalar; not a number where friction jams the body.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.contact import contact_at
    >>> from trundle.mechanics.impact import land
    >>> egg = tr.Body.ellipsoid((0.2, 0.15, 0.12), mass=1.0)
    >>> floor = tr.RollingSystem(egg, tr.Support(tr.Plane(), friction=0.2, restitution=0.5))
    >>> q = Quaternion(0.8, 0.36, 0.48, 0.0)
    >>> contact = contact_at(floor, 0.0, Vector(0.0, 0.0, 0.0), q)
    >>> s = Vector(0.5, -0.2, -2.0)
    >>> (turning_impulse(floor, contact, q, s) - land(floor, contact, q, s).impulse).norm() < 1e-13
    True
    """
    J, support = system.body.inertia_in_space(orientation.matrix()), system.support
    basis = _basis(contact.normal)
    answers = [response(system, contact, J, e).slip for e in basis]
    M = Matrix(*(Vector(*(answer.dot(d) for answer in answers)) for d in basis))
    unit, size = M.c.z, slip.norm()
    own = Matrix(*(row / unit for row in M.rows))
    limited = support.friction is not None
    mu = support.sliding_friction if limited else _NO_LIMIT
    begin = Vector(*(slip.dot(d) / size for d in basis))
    course = _Course(own, mu, support.restitution, support.tangential_restitution)
    parts = course.impulse(begin, limited=limited)
    return sum((d * part for d, part in zip(basis, parts, strict=True)), start=Vector(0.0, 0.0, 0.0)) * (size / unit)


def _basis(n: Vector) -> tuple[Vector, Vector, Vector]:
    """Return two tangents and n."""
    xp = namespace(*n)
    aside = less(abs(n.x), 0.9)
    first = n.cross(Vector(*(xp.where(aside, x, z) for x, z in zip(E_X, E_Z, strict=True))))
    first = first / first.norm()
    return first, n.cross(first), n


@dataclass(frozen=True)
class _Course:
    """The course of s over the normal impulse, along two tangents and n."""

    M: Matrix
    mu: Scalar
    e: Scalar
    e_t: Scalar

    def impulse(self, begin: Vector, *, limited: bool) -> Vector:
        """Return the whole impulse."""
        ending = self._ending(begin)
        slip, taken = (begin, 0.0) if limited else self._ended(begin, ending)
        holding = self.M.solve(E_Z)
        hx, hy = holding.x / holding.z, holding.y / holding.z
        xp = namespace(hx, begin.x)
        spare = self.mu - xp.hypot(hx, hy)
        c, s = self._beginning()
        held = (xp.where(less(spare, 0.0), part, hold) for part, hold in ((-self.mu * c, hx), (-self.mu * s, hy)))
        given = [*(part for row in self.M.rows for part in row), self.mu, self.e, *held, spare]
        found = repeated(_further, [1.0, *slip, 0.0, 0.0, 0.0, taken, 0.0, 0.0], given)
        _, *end, _, _, _, taken, unused, steps = found
        jams = xp.where(less(_MOST - 1.0, steps), _FAR, 0.0) * _FAR  # ∞
        change = Vector(*end) - begin
        total = self.M.solve(change) + self._given_back(ending, end[2], taken, unused)
        return total + Vector(0.0, 0.0, jams - jams)

    def _ending(self, slip: Vector) -> Vector:
        """Return the impulse along the support that ends the slip by itself."""
        (xx, xy, _), (yx, yy, _), _ = self.M.rows
        x, y, _ = slip
        return Vector(xy * y - yy * x, yx * x - xx * y, 0.0) / (xx * yy - xy * yx)

    def _ended(self, slip: Vector, ending: Vector) -> tuple[Vector, Scalar]:
        """Return what is left of a slip that ends at once, and the work of friction."""
        return Vector(0.0, 0.0, slip.z + self.M.c.dot(ending)), -0.5 * slip.dot(ending)

    def _growth(self, c: Scalar, s: Scalar) -> tuple[Scalar, Scalar, Scalar]:
        """Return how slip in a direction grows, how it turns, and how that changes with the direction."""
        (xx, xy, xz), (yx, yy, yz), _ = self.M.rows
        x, y = xz - self.mu * (xx * c + xy * s), yz - self.mu * (yx * c + yy * s)
        dx, dy = self.mu * (xx * s - xy * c), self.mu * (yx * s - yy * c)
        return c * x + s * y, c * y - s * x, c * (dy - x) - s * (dx + y)

    def _beginning(self) -> tuple[Scalar, Scalar]:
        """Return the direction in which slip grows fastest of those that its own friction leads along."""
        width = 2 * math.pi / _TRIED
        tried = [self._growth(math.cos(i * width), math.sin(i * width))[:2] for i in range(_TRIED)]
        xp = namespace(*(part for pair in tried for part in pair))
        fastest, angle = -_FAR, 0.0
        for i, (grows, turns) in enumerate(tried):
            then, across = tried[(i + 1) % _TRIED]
            apart = turns - across
            share = turns / xp.where(less(abs(apart), _LEAST), 1.0, apart)
            here = xp.where(less(0.0, turns * across), -_FAR, grows + share * (then - grows))
            angle = xp.where(less(fastest, here), (i + share) * width, angle)
            fastest = xp.where(less(fastest, here), here, fastest)
        for _ in range(_NEWTON):
            _, turns, slope = self._growth(xp.cos(angle), xp.sin(angle))
            angle = angle - xp.where(less(slope, -_LEAST), turns / xp.where(less(slope, -_LEAST), slope, 1.0), 0.0)
        return xp.cos(angle), xp.sin(angle)

    def _given_back(self, direction: Vector, up: Scalar, taken: Scalar, unused: Scalar) -> Vector:
        """Return the impulse by which a contact that holds gives back the share e_t² of what friction took.

        First the body comes off the more slowly; then, if that is not all, the support holds against it.
        """
        xp = namespace(*direction, up, taken, unused, self.e_t)
        pressing = -self.M.c.dot(direction)
        presses = less(0.0, pressing)
        rising = xp.where(less(0.0, up), up, 0.0)
        free = xp.where(presses, rising / xp.where(presses, pressing, 1.0), _FAR)
        left = self.e_t * self.e_t * xp.where(less(0.0, taken), taken, 0.0)
        most = self._amount(direction, left, 0.0, unused)
        first = xp.where(less(most, free), most, free)
        gain = self._gain(direction)
        left = left - 0.5 * gain * first * first
        spent = unused - xp.hypot(direction.x, direction.y) * first
        on = direction + E_Z * (pressing / self.M.c.z)
        more = self._amount(on, xp.where(less(0.0, left), left, 0.0), gain * first, spent)
        second = xp.where(less(most, free), 0.0, more)
        none = less(0.0, unused * self.e_t)
        return (direction * first + on * second) * xp.where(none, 1.0, 0.0)

    def _gain(self, direction: Vector) -> Scalar:
        change = self.M @ direction
        return direction.x * change.x + direction.y * change.y

    def _amount(self, direction: Vector, left: Scalar, turned: Scalar, unused: Scalar) -> Scalar:
        """Return how much of an impulse gives back what is left of a work, or as much as friction has left unused."""
        xp = namespace(*direction, left, turned, unused)
        size = xp.hypot(direction.x, direction.y) - self.mu * direction.z
        root = turned + xp.sqrt(turned * turned + 2.0 * self._gain(direction) * left)
        works, takes = less(0.0, root), less(0.0, size)
        enough = xp.where(works, 2.0 * left / xp.where(works, root, 1.0), 0.0)
        most = xp.where(takes, unused / xp.where(takes, size, 1.0), _FAR)
        return xp.where(less(enough, most), enough, most)


def _further(*now: Scalar) -> list[Scalar]:
    """Go a step on with a landing: slip for as long as a series holds, or all of compression or restitution held."""
    _, x, y, z, work, aimed, aim, taken, unused, steps, *given = now
    M, (mu, e, *held) = [given[:3], given[3:6], given[6:9]], given[9:]
    xp = namespace(*now)
    aim = xp.where(less(aimed, 0.5), (1.0 - e * e) * work, aim)
    aimed = xp.where(less(aimed, 0.5), xp.where(less(z, 0.0), 0.0, 1.0), 1.0)
    over = xp.where(less(work, aim), 0.0, aimed)
    sigma = xp.sqrt(x * x + y * y)
    slides = less(_SLOW, xp.where(less(0.0, mu), sigma, 0.0))
    size = xp.where(slides, sigma, 1.0)
    rubs, c, s = (xp.where(slides, part, other) for part, other in ((mu, 0.0), (x / size, 1.0), (y / size, 0.0)))
    slip = TurningSlip(M, rubs, size, c, s, z, work, taken)
    went = zip(_slid(slip, aimed, aim), _stuck(M, held, Vector(x, y, z), work, taken, aimed, aim), strict=True)
    moved = [xp.where(slides, slid, stuck) for slid, stuck in went]
    kept = zip((x, y, z, work, taken, 0.0), moved, strict=True)
    x, y, z, work, taken, spared = (xp.where(less(0.5, over), before, after) for before, after in kept)
    goes_on = xp.where(less(steps, _MOST), 1.0 - over, 0.0)
    return [goes_on, x, y, z, work, aimed, aim, taken, unused + spared, steps + 1.0]


def _slid(slip: TurningSlip, aimed: Scalar, aim: Scalar) -> list[Scalar]:
    """Return slip, work and what friction took after a step, and that nothing was spared."""
    rows = slip.series(_TERMS)
    xp = namespace(slip.size, slip.up, slip.mu, aim)
    step = _longest(rows, slip.size)
    returns = less(0.5, aimed)
    series = [xp.where(returns, of_work, of_up) for of_up, of_work in zip(rows[3], rows[4], strict=True)]
    slopes = [k * part for k, part in enumerate(series)][1:]
    target = xp.where(returns, aim, 0.0)
    last = polynomial(series, step)
    reaches = less(target, last)
    share = (target - series[0]) / xp.where(reaches, last - series[0], 1.0)
    tau = step * xp.sqrt(xp.where(less(0.0, share), share, 0.0))  # right where it begins with no slope, else beyond it
    for _ in range(_NEWTON):
        slope = polynomial(slopes, tau)
        rises = less(_LEAST, slope)
        tau = tau - xp.where(rises, (polynomial(series, tau) - target) / xp.where(rises, slope, 1.0), 0.0)
    tau = xp.where(reaches, xp.where(less(tau, 0.0), 0.0, tau), step)
    size, c, s, up, work, taken = (polynomial(row, tau) for row in rows)
    per = xp.where(less(_SLOW, size), size, 0.0) / xp.sqrt(c * c + s * s)
    up = xp.where(reaches, xp.where(returns, up, 0.0), up)
    work = xp.where(reaches, xp.where(returns, aim, work), work)
    return [c * per, s * per, up, work, taken, 0.0]


def _longest(rows: Sequence[Sequence[Scalar]], size: Scalar) -> Scalar:
    """Return how far series hold to the last digit."""
    found: Scalar = _FAR
    for k in (_TERMS - 2, _TERMS - 1):
        share: Scalar = _LEAST
        for row, scale in zip(rows, (size, 1.0, 1.0, 1.0, 1.0, 1.0), strict=True):
            xp = namespace(row[k], share, scale)
            last = xp.abs(row[k]) / scale
            share = xp.where(less(share, last), last, share)
        xp = namespace(share)
        length = xp.exp(xp.log(_PRECISION / share) / k)
        found = length if found is _FAR else xp.where(less(length, found), length, found)
    return found


def _stuck(
    M: Sequence[Sequence[Scalar]],
    held: Sequence[Scalar],
    slip: Vector,
    work: Scalar,
    taken: Scalar,
    aimed: Scalar,
    aim: Scalar,
) -> list[Scalar]:
    """Return the same at the end of compression or restitution where nothing slips, or slip begins, and what is spared.

    The impulse has one direction, that which holds the contact or in which friction acts against the slip to come.
    """
    x, y, spare = held
    change = [row[0] * x + row[1] * y + row[2] for row in M]
    xp = namespace(*slip, *change, work, aim)
    rises, returns, holds = less(_LEAST, change[2]), less(0.5, aimed), less(0.0, spare)
    up = xp.where(rises, change[2], 1.0)
    square = slip.z * slip.z + 2.0 * up * (aim - work)
    root = xp.where(returns, xp.sqrt(xp.where(less(0.0, square), square, 0.0)), 0.0)
    amount = xp.where(rises, (root - slip.z) / up, _FAR)
    after = [xp.where(holds, 0.0, old + rate * amount) for old, rate in ((slip.x, change[0]), (slip.y, change[1]))]
    took = -0.5 * amount * (x * (slip.x + after[0]) + y * (slip.y + after[1]))
    done = xp.where(returns, aim, work + amount * (slip.z + 0.5 * up * amount))
    rising = xp.where(returns, slip.z + up * amount, 0.0)
    return [*after, rising, done, taken + took, xp.where(holds, spare * amount, 0.0)]
