"""Where the torque about the contact vanishes, for a body that touches at a point: many starts, one batch.

The unknowns are the two coordinates of the contact and, where it matters, the orientation. Equations and unknowns
need not be equally many: what is left free is a family of equilibria, and its dimension is part of the answer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import E_X, E_Y, E_Z, Quaternion, Vector
from ...mechanics.bodies import Body
from ...mechanics.shapes import concentric_sphere
from ...mechanics.system import RollingSystem
from . import rest

Array = NDArray[np.float64]

FOUND = 1e-12  # share of the scale below which the torque is nothing
FREE = 1e-9  # share of the largest slope of the torque below which a direction is free
SAME = 1e-6  # radii and radians: places nearer than this are one
_WALKED_TO = 24  # times, to places of a family
_ROUNDS, _LONGEST = 50, 0.5  # Newton steps, and the longest of them, rad
_ORIENTATIONS, _AROUND, _ACROSS = 48, 16, 5  # starts


@dataclass(frozen=True)
class Place:
    """A way for the body to lie: contact point, m, and orientation."""

    p: Vector
    q: Quaternion

    @property
    def numbers(self) -> Array:
        """All seven, as a row."""
        return np.array([*self.p, *self.q], dtype=float)


@dataclass(frozen=True)
class Family:
    """An equilibrium and what may be changed about it without leaving equilibrium."""

    place: Place  # one member, the one found nearest the start
    dimension: int  # of the family, among the ways to lie that are told apart
    free: tuple[int, ...]  # those of the searched directions (two coordinates, three turns) that alone stay in it
    members: tuple[Place, ...] = ()  # those that the search has hit upon, in order of their distance from the start


class Search:
    """The equilibria of a body that touches at a point.

    Parameters
    ----------
    system : RollingSystem
        Its support at rest.
    time : float
        s.
    start : Place
        Where the search begins.
    """

    def __init__(self, system: RollingSystem, time: float, start: Place) -> None:
        self.system, self.time, self.start = system, time, start
        self.oriented = not round_body(system.body)
        self.size = float(rest.contact_at(system, time, start.p, start.q).offset.norm())
        self.uniform = all(load.constant or load.linear_drag is not None for load in system.all_loads)

    def families(self) -> tuple[list[Family], Place, float]:
        """Return the families found, the place where the torque is least, and that torque as a share of its scale."""
        rows = self._settled(self._starts())
        sizes = np.linalg.norm(self._torque(rows), axis=1)
        scales = np.array([max(rest.torque_scale(self.system, self.time, *_place(row)), 1e-300) for row in rows])
        share, inside = sizes / scales, self._inside(rows)
        least = int(np.argmin(np.where(inside, share, np.inf)))
        good = rows[(share <= FOUND) & inside]
        if len(good):
            good = good[np.argsort(np.linalg.norm(self._ways(good, self.start.numbers), axis=1), kind="stable")]
        families: list[Family] = []
        while len(good):
            members, good = self._those_with(good[0], good)
            families.append(self._family([Place(*_place(row)) for row in members]))
        return families, Place(*_place(rows[least])), float(share[least])

    @property
    def told(self) -> str:
        """What is searched, in words."""
        starts = len(self._starts())
        kinds = self.system.support.surface.coordinates
        place = "all round the support" if "angle" in kinds else "one place, since all are alike"
        if not self.uniform:
            place += f", within {self._reach():.3g} m of the start" if "angle" in kinds else ""
            place = place if "angle" in kinds else f"places within {self._reach():.3g} m of the start"
        orientations = f", {len(self._turns())} orientations at each" if self.oriented else ""
        return f"Newton's method from {starts} {'start' if starts == 1 else 'starts'} ({place}{orientations})"

    # --- starts -------------------------------------------------------------------------------------------

    def _starts(self) -> Array:
        """Return places all over the support and in all orientations, the given start first."""
        surface = self.system.support.surface
        u, v = surface.coordinates_of(self.start.p)
        kinds = surface.coordinates
        along = [np.array([0.0])] * 2 if self.uniform else [np.linspace(-1, 1, _ACROSS) * self._reach()] * 2
        spread = [
            np.arange(_AROUND) * 2 * math.pi / _AROUND if k == "angle" else way
            for k, way in zip(kinds, along, strict=True)
        ]
        turns, rows = self._turns(), []
        for du in spread[0]:
            for dv in spread[1]:
                try:
                    p = surface.point(u + float(du), v + float(dv))
                except (ArithmeticError, ValueError):  # the surface does not reach so far
                    continue
                rows += [Place(p, q).numbers for q in turns]
        return np.array(rows)

    def _turns(self) -> list[Quaternion]:
        """Return the orientation of the start, and any others: at a special one the law may be degenerate."""
        turns = [Quaternion(*self.start.q)]
        if not self.oriented:
            return turns
        drawn = np.random.default_rng(seed=28).normal(size=(_ORIENTATIONS, 4))
        return turns + [Quaternion(*row) for row in drawn / np.linalg.norm(drawn, axis=1)[:, None]]

    def _reach(self) -> float:
        rim = self.system.support.surface.rim
        return 0.5 * float(rim) if rim is not None else 10 * self.size

    def _inside(self, rows: Array) -> NDArray[np.bool_]:
        """Return at which places the body is on the support, and touches it with what its shape covers."""
        p, q = _columns(rows)
        with np.errstate(all="ignore"):  # a place beyond the end of a formula is not inside
            room = rest.room(self.system, rest.contact_at(self.system, self.time, p, q), q)
        return np.broadcast_to(room > 0, (len(rows),))

    # --- Newton's method, least steps, all starts at once -------------------------------------------------

    def _torque(self, rows: Array) -> Array:
        return _rows(rest.torque_about_contact(self.system, self.time, *_columns(rows)), len(rows))

    def _slopes(self, rows: Array) -> Array:
        """Return the (n, 3, k) derivatives of the torque, N m per radius or rad."""
        return self._torque_and_slopes(rows)[1]

    def _torque_and_slopes(self, rows: Array) -> tuple[Array, Array]:
        """Return the torque (n, 3) and its derivatives, all by one step along the imaginary axis in each direction."""
        p, q = _columns(rows)
        ways = [rest.moved(p, q, dp, dq, 1j * rest.STEP) for dp, dq in self._directions(p, q)]
        count = (len(ways), len(rows))
        stacked = [
            np.stack([np.broadcast_to(part, len(rows)) for part in parts]).ravel()
            for parts in zip(*((*place, *turn) for place, turn in ways), strict=True)
        ]
        torque = rest.torque_about_contact(self.system, self.time, Vector(*stacked[:3]), Quaternion(*stacked[3:]))
        parts = np.stack([np.broadcast_to(part, count[0] * count[1]).reshape(count) for part in torque])  # (3, k, n)
        return np.real(parts[:, 0]).T, np.imag(parts).transpose(2, 0, 1) / rest.STEP

    def _directions(self, p: Vector, q: Quaternion) -> list[tuple[Vector, Quaternion]]:
        """Return the directions in which the unknowns may change."""
        still = Quaternion(0.0, 0.0, 0.0, 0.0)
        moves = [(along * self.size, still) for along in self.system.support.surface.directions(p)]
        turns = [(Vector(0.0, 0.0, 0.0), q.rate(axis)) for axis in (E_X, E_Y, E_Z)] if self.oriented else []
        return moves + turns

    def _stepped(self, rows: Array, steps: Array) -> Array:
        """Return the rows a step (n, k) further, on the surface and with unit quaternions."""
        p, q = _columns(rows)
        surface = self.system.support.surface
        for i, (dp, dq) in enumerate(self._directions(p, q)):
            p, q = rest.moved(p, q, dp, dq, steps[:, i])
        p = surface.point(*surface.coordinates_of(p))
        turned = _rows(q, len(rows))
        turned /= np.linalg.norm(turned, axis=1)[:, None]
        return np.hstack([_rows(p, len(rows)), turned])

    def _settled(self, rows: Array) -> Array:
        for _ in range(_ROUNDS):
            torque, slopes = self._torque_and_slopes(rows)
            steps = -np.einsum("nki,ni->nk", np.linalg.pinv(slopes, rcond=FREE), torque)
            length = np.linalg.norm(steps, axis=1)
            if length.max() < 1e-13:
                break
            shorter = np.minimum(1.0, _LONGEST / np.maximum(length, 1e-300))
            rows = self._stepped(rows, steps * shorter[:, None])
        return rows

    # --- families -----------------------------------------------------------------------------------------

    def _those_with(self, first: Array, places: Array) -> tuple[Array, Array]:
        """Return the places of one family, the first of them first, and the others.

        A walk straight towards one of them may end where the family bends away: from there others are walked to.
        """
        members, towards, walkers = first[None], [first], places
        for _ in range(_WALKED_TO):
            if not len(places):
                break
            towards = towards or list(members[:_WALKED_TO])
            away = [np.linalg.norm(self._ways(walkers, one), axis=1).min() for one in towards]
            joined, walkers = self._joined(walkers, towards.pop(int(np.argmin(away))))
            members = np.vstack([members, places[joined]])
            towards += list(places[joined][:_WALKED_TO])
            places, walkers = places[~joined], walkers[~joined]
        return members[1:], places

    def _family(self, members: list[Place]) -> Family:
        place = members[0]
        slopes = self._slopes(place.numbers[None])[0]
        scale = rest.torque_scale(self.system, self.time, place.p, place.q)
        values = np.linalg.svd(slopes, compute_uv=False)
        rank = int(np.sum(values > FREE * scale))
        alone = np.linalg.norm(slopes, axis=0) <= FREE * scale
        return Family(place, slopes.shape[1] - rank, tuple(int(i) for i in np.flatnonzero(alone)), tuple(members))

    def _ways(self, here: Array, there: Array) -> Array:
        """Return the (n, k) ways from each of n places to one other, in the searched directions, radii and rad."""
        surface = self.system.support.surface
        kinds = surface.coordinates
        ends = [surface.coordinates_of(Vector(*row.T[:3])) for row in (here, there)]
        way = []
        for a, b, kind, length in zip(*ends, kinds, self._lengths(there), strict=True):
            change = np.broadcast_to(b - a, len(here))
            way.append((np.remainder(change + math.pi, 2 * math.pi) - math.pi if kind == "angle" else change) * length)
        way = [part / self.size for part in way]
        if self.oriented:
            turn = Quaternion(*there[3:]) * Quaternion(*here.T[3:]).conjugate
            w, part = np.asarray(turn.w), np.stack(list(turn)[1:])
            sine = np.linalg.norm(part, axis=0)
            angle = 2 * np.arctan2(sine, np.abs(w)) * np.where(w >= 0, 1.0, -1.0)
            way += list(part * (angle / np.maximum(sine, 1e-300)))
        return np.stack(way, axis=1)

    def _lengths(self, there: Array) -> list[float]:
        """Return how far the point of the support goes for one unit of each coordinate."""
        surface = self.system.support.surface
        u, v = (np.array([part + 0j]) for part in surface.coordinates_of(Vector(*there[:3])))
        steps = ((u + 1j * rest.STEP, v), (u, v + 1j * rest.STEP))
        return [math.hypot(*(float(np.sum(np.imag(part))) for part in surface.point(*at))) / rest.STEP for at in steps]

    def _joined(self, here: Array, there: Array) -> tuple[NDArray[np.bool_], Array]:
        """Return which places can be walked straight to another, always in equilibrium, and where each walk ends."""
        arrived, ends = np.zeros(len(here), dtype=bool), here.copy()
        going = np.arange(len(here))
        for _ in range(_ROUNDS):
            ways = self._ways(here, there)
            torque, slopes = self._torque_and_slopes(here)
            inverse = np.linalg.pinv(slopes, rcond=FREE)
            back = -np.einsum("nki,ni->nk", inverse, torque)  # what the last step left of equilibrium
            along = ways - np.einsum("nki,nij,nj->nk", inverse, slopes, ways)
            length = np.linalg.norm(along, axis=1)
            off = np.linalg.norm(back, axis=1)
            near = np.linalg.norm(ways, axis=1) < SAME
            arrived[going[near]] = True
            stay = ~near & ((length > SAME) | (off > SAME))
            if not stay.any():
                break
            step = along * np.minimum(1.0, _LONGEST / np.maximum(length, 1e-300))[:, None] + back
            here, going = self._stepped(here[stay], step[stay]), going[stay]
            ends[going] = here
        return arrived, ends


def round_body(body: Body) -> bool:
    """Whether its orientation makes no difference to how it rests: a sphere about its centre of mass."""
    return concentric_sphere(body.shape)


def _place(row: Array) -> tuple[Vector, Quaternion]:
    return Vector(*map(float, row[:3])), Quaternion(*map(float, row[3:]))


def _columns(rows: Array) -> tuple[Vector, Quaternion]:
    return Vector(*rows.T[:3]), Quaternion(*rows.T[3:])


def _rows(parts: Vector | Quaternion, count: int) -> Array:
    return np.stack([np.broadcast_to(np.real(part), (count,)) for part in parts], axis=1)
