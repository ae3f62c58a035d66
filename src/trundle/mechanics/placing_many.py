"""Starts by the thousand: what `placing` works out for one, on arrays, with each check as a mask.

Whoever does not plainly pass all of them is put down alone, and told there what is wrong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .algebra import ZERO, Quaternion, Vector
from .attitude import attitude
from .contact import Contact, contact_at
from .fitting import EDGE, LEAST_ROOM, SHARPEST
from .placing import IN_PROPORTION, SLIP_TOLERANCE, not_opening, rolling_along, rolling_rate
from .system import RollingSystem

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Placed:
    """Many starts: arrays over members, of which only those that are `sound` mean anything."""

    position: Array
    velocity: Array
    angular_velocity: Array
    orientation: Array
    sound: Mask


@dataclass(frozen=True)
class ManyPlacing:
    """Starts as the user describes them, in SI: each part an array over members, or absent.

    Examples
    --------
    See `trundle.place_many`.
    """

    system: RollingSystem  # its numbers may be arrays over members
    free: Mask  # (members,): whether the body is known to lie below the surface nowhere
    position: Array  # (members, 2)
    velocity: Array | str | None  # (members, 2 or 3)
    spin: Array | None  # (members,)
    angular_velocity: Array | None  # (members, 3)
    orientation: Array | None  # (members, 4)
    attitude: Array | None  # (members, 3)
    time: float
    support: Sequence[Any]  # (members,): as of `RollingSystem.place`

    @property
    def _rough(self) -> bool:
        return self.system.support.friction is not None

    def starts(self) -> Placed:
        """Return all starts, those in order marked as sound."""
        with np.errstate(all="ignore"):
            contact, q = self._contact
            turning = None if self.angular_velocity is None else Vector.of(self.angular_velocity)
            V, Omega, moves = self._motion(contact, turning)
            sound = self.free & self._fits(contact, q) & moves
            parts = (contact.centre, V, Omega)
            r, v, turns = (self._rows(part.array() + 0.0, 3) for part in parts)
            turned = self._rows(q.array(), 4)
            sound = sound & np.isfinite(np.hstack([r, v, turns, turned])).all(axis=1)
            return Placed(r, v, turns, turned, sound)

    def _rows(self, array: Any, size: int) -> Array:
        return np.broadcast_to(array, (len(self.position), size))

    @cached_property
    def _contact(self) -> tuple[Contact, Quaternion]:
        """The geometry of touch, and the orientation."""
        surface, (u, v) = self.system.support.surface, self.position.T
        begin = self.system.support.motion.at(self.time, *self.support)
        point = begin.carried(surface.point(u, v))
        q = self._orientation(begin, point)
        offset = begin.rotation.transpose @ self._touch(point, q).offset
        return self._touch(begin.carried(surface.contact_from_coordinates(u, v, offset)), q), q

    def _touch(self, point: Vector, q: Quaternion) -> Contact:
        return contact_at(self.system, self.time, point, q, tuple(self.support))

    def _orientation(self, begin: Any, point: Vector) -> Quaternion:
        if self.orientation is not None:
            return Quaternion.of(self.orientation / np.linalg.norm(self.orientation, axis=1)[:, None])
        if self.attitude is None:
            return Quaternion(1.0, 0.0, 0.0, 0.0)
        there = begin.local(point)
        first, n = self.system.support.surface.directions(there)[0], self.system.support.surface.normal(there)
        axes = (begin.rotation @ first, begin.rotation @ n.cross(first), begin.rotation @ n)
        return attitude(*axes, *self.attitude.T)

    def _fits(self, contact: Contact, q: Quaternion) -> Mask:
        """Tell who is on the surface inside its rim and end, on the body's round side, and fits the curvature there."""
        surface, there = self.system.support.surface, contact.support.local(contact.point)
        sound = np.ones(len(self.position), dtype=bool)
        ends = [surface.domain_margin(there), surface.domain_margin(surface.point(*self.position.T))]
        if surface.rim is not None:
            ends.append(surface.rim - np.hypot(there.x, there.y))
        covered = self.system.body.shape.validity_margin(-(q.matrix().transpose @ contact.normal))
        ends.append(None if covered is None else covered - EDGE)
        for margin in ends:
            sound &= True if margin is None else np.asarray(margin > 0)
        sound &= np.isfinite(surface.level(there))
        size = np.max(
            [np.abs(part) for row in contact.shape_operator.dense.rows for part in np.broadcast_arrays(*row)], axis=0
        )
        sound &= size * contact.offset.norm() <= SHARPEST
        # 1 + C S is 1 along n: the two other eigenvalues have the determinant as their product, and the trace less 1
        # as their sum.
        both = contact.relative_curvature()
        product, half = both.determinant, 0.5 * (sum(row[i] for i, row in enumerate(map(tuple, both.rows))) - 1.0)
        return sound & (half - np.sqrt(np.maximum(half * half - product, 0.0)) > LEAST_ROOM)

    def _motion(self, contact: Contact, turning: Vector | None) -> tuple[Vector, Vector, Mask]:
        """Return V, Ω, and who rolls, or slips where it may, in proportion to what is asked."""
        rho, n, u = contact.offset, contact.normal, contact.support.material_velocity(contact.point)
        if isinstance(self.velocity, str) and self.velocity == "rolling":
            Omega = ZERO if turning is None else turning
            return u - Omega.cross(rho), Omega, np.full(len(self.position), turning is not None)
        given = self._given(contact)
        V = given if self._whole else rolling_along(given, u, rho, n)
        sound = np.ones(len(self.position), dtype=bool)
        if not self._whole:
            sound &= self._in_proportion(V, given, u)
        if turning is None:
            about = self._about(contact)
            relative = V - u if not self._whole else rolling_along(V - u, ZERO, rho, n)
            Omega = rolling_rate(relative, rho, n, about)
            sound &= self._in_proportion(Omega * rho.norm(), V, u, n * (about * rho.norm()))
        else:
            Omega = turning
            if not self._whole:
                slipping = self._slips(contact, V, Omega)
                V = Vector(
                    *(np.where(slipping, a, b) for a, b in zip(not_opening(given, u, Omega, rho, n), V, strict=True))
                )
        return V, Omega, sound if self._rough else sound & ~self._slips(contact, V, Omega)

    @property
    def _whole(self) -> bool:
        """Whether all three components of the velocity are given."""
        return isinstance(self.velocity, np.ndarray) and self.velocity.shape[1] == 3

    def _given(self, contact: Contact) -> Vector:
        """Return what is given of V."""
        begin = contact.support
        first, second = (begin.rotation @ e for e in self.system.support.surface.directions(begin.local(contact.point)))
        if isinstance(self.velocity, str):
            carried = begin.material_velocity(contact.centre)
            return first * carried.dot(first) + second * carried.dot(second)
        if self.velocity is None:
            return first * 0.0
        V = first * self.velocity[:, 0] + second * self.velocity[:, 1]
        return V + contact.normal * self.velocity[:, 2] if self._whole else V

    def _about(self, contact: Contact) -> Any:
        """Return Ω·n."""
        if self.spin is not None:
            return self.spin
        return contact.support.angular_velocity.dot(contact.normal) if isinstance(self.velocity, str) else 0.0

    @staticmethod
    def _in_proportion(follows: Vector, *given: Vector) -> Mask:
        most = np.max(np.broadcast_arrays(*(v.norm() for v in given)), axis=0)
        return np.asarray(follows.norm() <= IN_PROPORTION * most)

    @staticmethod
    def _slips(contact: Contact, V: Vector, Omega: Vector) -> Mask:
        s, u = contact.slip_velocity(V, Omega), contact.support.material_velocity(contact.point)
        along = (s - contact.normal * s.dot(contact.normal)).norm()
        sizes = np.broadcast_arrays(V.norm(), Omega.norm() * contact.offset.norm(), u.norm())
        return np.asarray(along > SLIP_TOLERANCE * np.max(sizes, axis=0))
