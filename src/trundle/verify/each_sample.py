"""Each sample by itself: whether its numbers fit each other, and the phase that it is said to be in.

None of this says anything of the law. It ties the columns of a run together: what is found of one holds for all.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import Contact, contact_at, roll
from ..mechanics.system import RollingSystem
from ..solve.contact_state import ContactState
from ..solve.samples import FLIGHT, RESTING, ROLLING, SLIPPING, Event, Samples
from .bounds import EXACT, Array, largest, speed_of
from .card import CardFigure, checked

_WORTH_TELLING = 1e-3  # of its bound
_ROUNDING = 1e-15  # of a place: a few roundings
_LASTING = 0.1  # rad, or of a body's size: what comes off is a ten-thousandth of it away by then
_PRESSES = 1e-13  # share of the forces at hand: more than rounding
_STEP = 1e-6  # of a length, for the slope of the level function


@dataclass(frozen=True)
class Shares:
    """One condition at each sample: how far it is from being met, as a share, and how far it may be."""

    name: str
    share: Array
    bound: Any

    @property
    def ratio(self) -> Array:
        """The share over its bound; what is no number is as far off as can be."""
        ratio = np.asarray(self.share / self.bound, dtype=float)
        return np.where(np.isnan(ratio), np.inf, ratio)


def worst_of(name: str, conditions: list[Shares], time: Array, said: str) -> CardFigure:
    """Return one figure for several conditions: that of the one which is farthest from its bound.

    Examples
    --------
    >>> parts = [Shares("a", np.array([0.0, 2e-13]), 1e-12), Shares("b", np.array([0.0, 0.0]), 1.0)]
    >>> print(worst_of("fits", parts, np.array([0.0, 1.0]), "a and b"))
    ok    fits                                      2e-13            at most 1e-12    a and b; most: a, t = 1 s
    """
    most = max(conditions, key=lambda condition: condition.ratio.max())
    at = int(np.argmax(most.ratio))
    bound = float(np.broadcast_to(most.bound, most.share.shape)[at])
    told = f"; most: {most.name}, t = {time[at]:.6g} s" if most.ratio[at] > _WORTH_TELLING else ""
    return checked(name, max(0.0, float(most.share[at])), bound, said + told)


@dataclass(frozen=True)
class EachSample:
    """Samples of a run, each looked at by itself.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("billiard-draw").run()
    >>> each = EachSample(run.system, run.samples, 1e-12)
    >>> [figure.passed for figure in each.figures()]
    [True, True]
    """

    system: RollingSystem  # what moved
    at: Samples  # any of a run
    bound: float  # the share that the method may be off

    @cached_property
    def flies(self) -> Any:
        """Where nothing touches."""
        return self.at.phase == FLIGHT

    @cached_property
    def speeds(self) -> tuple[Array, Array, Array]:
        """V, Ω×ρ and u, m/s."""
        V, turning, u = (np.broadcast_to(v.array(), self.at.position.shape) for v in self.at.speeds(self.system))
        return V, turning, u

    @cached_property
    def slip(self) -> Array:
        """The slip s = V + Ω×ρ − u, m/s."""
        return self.speeds[0] + self.speeds[1] - self.speeds[2]

    @cached_property
    def normals(self) -> Array:
        """The support's normal at each contact."""
        return self.at.normals(self.system)

    @cached_property
    def touch(self) -> Contact:
        """The geometry at each p."""
        at, q = self.at, Quaternion.of(self.at.orientation)
        return contact_at(self.system, at.time, Vector.of(at.contact), q, at.support_columns)

    @cached_property
    def apart(self) -> tuple[Array, Array]:
        """From p to the point of the body whose normal is −n, m; and how high p is over the surface, m."""
        at, contact = self.at, self.touch
        offset = np.broadcast_to(contact.offset.array(), at.position.shape)
        support, surface = contact.support, self.system.support.surface
        back = support.rotation.transpose
        there, n = back @ (Vector.of(at.contact) - support.origin), back @ contact.normal
        step = _STEP * (largest(offset) + largest(at.contact))
        level = np.asarray(surface.level(there), dtype=float)
        with np.errstate(all="ignore"):
            slope = (surface.level(there + n * step) - surface.level(there - n * step)) / (2 * step)
            height = np.where(np.isfinite(slope), level / slope, 0.0)  # none by the very end of a formula
        height = np.broadcast_to(height, at.time.shape)
        return at.position + offset - at.contact, height

    def figures(self) -> Iterator[CardFigure]:
        """Yield whether it touches, and whether the numbers fit."""
        yield self._touching()
        said = "V, Ω, q, slip, force and phase of each, one against the other; of the law it says nothing"
        yield worst_of("samples fit together", list(self._fitting()), self.at.time, said)

    def _touching(self) -> CardFigure:
        """Check that the body touches where it is said to, and is over the support where not."""
        apart, height = self.apart
        gap = (apart * self.normals).sum(axis=1)
        aside = self._aside(apart, gap)
        size = largest(self.at.contact - self.at.position) + largest(self.at.contact)
        conditions = [
            Shares("the contact is on the surface", np.abs(height) / size, self.bound),
            Shares("and nearest to the body", aside / size, self.bound),
            Shares("the gap", np.where(self.flies, -gap, np.abs(gap)) / size, self.bound),
            Shares("a flight leaves it", self._staying(gap), EXACT),
            *self._ends(size),
        ]
        over = f"; in flight the gap is {gap[self.flies].max():.3g} m at most" if self.flies.any() else ""
        return worst_of("touches the support", conditions, self.at.time, f"gap, share of the size{over}")

    def _staying(self, gap: Array) -> Array:
        """Return 1 in flights that never leave the support, although they last: the body was let go for nothing.

        Where a wall would not have pressed on it, a body may fall along it.
        """
        at, found = self.at, np.zeros(gap.size)
        arms, speeds = np.linalg.norm(at.contact - at.position, axis=1), np.linalg.norm(at.velocity, axis=1)
        noise = _ROUNDING * (largest(at.contact) + largest(at.position))
        parts = np.split(np.arange(gap.size), np.searchsorted(at.time, [event.time for event in at.events]))
        for part, since in zip(parts, (None, *at.events), strict=True):
            if part.size < 2 or not self.flies[part].all() or (since is not None and not self._would_press(since)):
                continue
            arm, spins = arms[part].max(), np.linalg.norm(at.angular_velocity[part], axis=1).max()
            lasts = np.ptp(at.time[part]) * (spins + speeds[part].max() / arm) > _LASTING
            found[part] = float(lasts and gap[part].max() <= EXACT * arm + noise)
        return found

    def _would_press(self, since: Event) -> bool:
        """Tell whether the support would press on a body that rolled on from an event."""
        if since.after is None or since.contact is None:
            return True
        at = ContactState.of(self.system, since.after, Vector(*since.contact))
        rolling = roll(self.system, at.state.time, at.contact.point, at.orientation, at.Omega, at.state.support)
        N = float(rolling.reaction.dot(rolling.contact.normal))
        return N - _PRESSES * at.forces(self.system) > 0

    def _aside(self, apart: Array, gap: Array) -> Array:
        """Return how far the two points are beside each other, m; in flight no more than how far p is beside its place.

        Where a shape ends, or by a cone's apex, the last digit of p moves the body's point by a million of its own.
        While they touch, that moves the body along.
        """
        along = apart - gap[:, None] * self.normals
        aside = np.linalg.norm(along, axis=1)
        if not self.flies.any() or self.touch.flat:
            return aside
        with np.errstate(all="ignore"):
            moved = self.touch.relative_curvature(np.where(self.flies, gap, 0.0)).solve(Vector.of(along))
            off = np.linalg.norm(np.broadcast_to(moved.array(), along.shape), axis=1)
        return np.where(self.flies, np.fmin(aside, off), aside)

    def _ends(self, size: float) -> Iterator[Shares]:
        """Yield how far a body is beyond the rim, the surface's end, or what its shape covers."""
        system, surface = self.system, self.system.support.surface
        support = self.at.support(system)
        there = support.local(Vector.of(self.at.contact))
        shape = self.at.time.shape
        if surface.rim is not None:
            beyond = np.hypot(there.x, there.y) - float(surface.rim)
            yield Shares("inside the rim", np.broadcast_to(beyond, shape) / size, self.bound)
        nu = Quaternion.of(self.at.orientation).matrix().transpose @ Vector.of(self.normals)
        # Where the support bends, what p may be off turns the normal, and so moves the point of the body that is next.
        bend = sum(row.dot(row) for row in self.touch.shape_operator.rows) ** 0.5
        for name, inside, sharp in (
            ("before the end", surface.domain_margin(there), 1.0),
            ("on its shape", system.body.shape.validity_margin(-nu), 1 + bend * size),
        ):
            if inside is not None:
                yield Shares(name, -np.broadcast_to(np.asarray(inside, dtype=float), shape), self.bound * sharp)

    def _fitting(self) -> Iterator[Shares]:
        """Yield what ties the numbers of a sample together."""
        at, s, phase = self.at, self.slip, self.at.phase
        speed, force = max(speed_of(self.system, at), 1e-300), max(largest(at.contact_force), 1e-300)
        yield Shares("|q| = 1", np.abs(np.linalg.norm(at.orientation, axis=1) - 1), EXACT)
        held = (phase == ROLLING) | (phase == RESTING)
        # ρ is the small difference of two places, which may be far out.
        turning = np.linalg.norm(at.angular_velocity, axis=1)
        sharp = self.bound + _ROUNDING * (largest(at.contact) + largest(at.position)) * turning / speed
        yield Shares("no slip", np.linalg.norm(s, axis=1) * held / speed, sharp)
        off = np.abs((s * self.normals).sum(axis=1)) * (phase == SLIPPING)
        yield Shares("slips along the support", off / speed, sharp)
        yield Shares("no force in flight", np.linalg.norm(at.contact_force, axis=1) * self.flies / force, EXACT)
        turning = at.angular_velocity - np.broadcast_to(
            at.support(self.system).angular_velocity.array(), at.position.shape
        )
        arm = largest(at.contact - at.position)
        yield Shares("rests", np.linalg.norm(turning, axis=1) * arm * (phase == RESTING) / speed, self.bound)
        if at.slip_velocity is not None:
            yield self._slip_column(speed)

    def _slip_column(self, speed: float) -> Shares:
        """Compare the slip that was stored, not a number in flight, with what V, Ω and u make of it."""
        stored = self.at.slip_velocity
        off = np.linalg.norm(stored - self.slip, axis=1) / speed
        off = np.where(self.flies, np.where(np.isnan(stored).all(axis=1), 0.0, np.inf), off)
        return Shares("slip_velocity", np.where(np.isnan(off), np.inf, off), EXACT)
