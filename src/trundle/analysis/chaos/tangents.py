"""Small differences of a motion, followed by the variational equations and kept apart on the way.

They are differences of the numbers that a law's state is made of, in units of what is large of each, and they keep to
what the state may be: the contact stays on the support, |q| = 1, and rolling ties the velocity to Ω. A body that rolls
so has eight of them, one that slips ten, one in flight twelve. Time and again they are made orthonormal, by QR
[benettin1980], and how much they have grown is written down: between events, and across each event by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import SolverError
from ...mechanics.algebra import Vector
from ...mechanics.contact import normal_at
from ...mechanics.duals import Dual, slopes_of, stacked, value_of
from ...mechanics.system import RollingSystem, State
from ...solve import transitions
from ...solve.contact_state import ContactState
from ...solve.laws import Law
from ...solve.phases import Integrate, Segment
from ...solve.samples import FLIGHT, RESTING, SLIPPING, Array, Progress
from ...solve.transitions import PhaseStart, ZeroCrossing
from ...solve.variational import VariationalLaw
from ..sensitivities.following import VariationalRun
from .asked import scale_of
from .volume import NODES, Stretch, grown, nodes

_RANK = 1e-9  # singular values below this share are none
_LOST = 1e-11  # share of itself that is left of a difference which an event takes away
_WAITING = 500  # stretches, whose integrals are worked out together


@dataclass(frozen=True)
class Growth:
    """How much the differences have grown by an instant: logarithms, since the start."""

    time: float  # s
    logs: Array  # (count,): of each difference, orthogonal to those before it
    # `between`, `across`: their sum: between events, and across these. What an event takes away altogether is not
    # counted.
    between: float
    across: float


def beginning(system: RollingSystem, start: State) -> PhaseStart:
    """Return the phase in which a motion starts; refuse one that starts with an event, or at rest for good."""
    now = transitions.at_start(system, start)
    if now.across is not None or now.events:
        raise SolverError(
            "The start is at an event itself (it strikes, or begins to slip), so that its neighbours move another way. "
            "Start a little before that or after it."
        )
    if now.law.code == RESTING:
        raise SolverError(
            "The body rests on its support and is held there, so that no difference of two motions grows. Nudge it."
        )
    return now


def tangents(system: RollingSystem, now: PhaseStart, scale: Array) -> Array:
    """Return a basis of what may be different in the state at a start: orthonormal, in units of the scale, (size, d).

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> now = beginning(ball, ball.place(velocity=(1.0, 0.0)))
    >>> tangents(ball, now, scale_of(ball, now.law, 0.1, 10.0)).shape
    (10, 8)
    """
    start = now.start
    parts = [start.position, start.velocity, start.angular_velocity, start.orientation, start.support]
    L, w = float(scale[0]), float(scale[7])
    kinds = system.support.motion.coordinate_kinds
    sizes = [L] * 3 + [L * w] * 3 + [w] * 3 + [1.0] * 4 + [1.0 if kind == "angle" else w for kind in kinds]
    units, count = iter(np.diag(sizes)), len(sizes)
    moved: Any = [tuple(Dual(value, tuple(next(units).tolist())) for value in part) for part in parts]
    at = ContactState.of(system, State(moved[0], moved[1], moved[2], moved[3], start.time, moved[4]))
    if now.law.code != FLIGHT:
        at = at.over(0.0)
    columns = np.array([slopes_of(one, count) for one in now.law.state_vector(at)], dtype=float) / scale[:, None]
    q = np.array(start.orientation)
    columns[3:7] -= np.outer(q, q @ columns[3:7]) / (q @ q)
    U, sizes_found, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(U[:, sizes_found > _RANK * sizes_found[0]])


class TangentRun(VariationalRun):
    """A run with differences that are kept orthonormal.

    Parameters
    ----------
    method : callable
        The way through one stretch.
    system : RollingSystem
        What moves.
    times : array (n,)
        When they are made orthonormal, ascending, s.
    now : PhaseStart
        How it starts.
    columns : array (size, count)
        The differences at the start, orthonormal.
    length, rate : float
        What is large of a length, m, and of a rate, rad/s.
    """

    def __init__(
        self,
        method: Integrate,
        system: RollingSystem,
        times: Array,
        now: PhaseStart,
        columns: Array,
        length: float,
        rate: float,
    ) -> None:
        self.length, self.rate = length, rate
        rows = scale_of(system, now.law, length, rate)[:, None] * columns
        numbers: Any = [Dual(value, tuple(row)) for value, row in zip(now.state_vector, rows.tolist(), strict=True)]
        begins = replace(now, state_vector=numbers)
        super().__init__(method, system, times, system, begins, columns.shape[1])
        self.alive = np.ones(self.count, dtype=bool)
        self.logs, self.between, self.across = np.zeros(self.count), 0.0, 0.0
        self.growth = [Growth(now.time, self.logs.copy(), 0.0, 0.0)]
        self.waiting: list[Stretch] = []
        self.volume = 0.0  # the integral of the divergence so far
        self.lost: list[float] = []  # when a difference was taken away
        self.on_event = False
        self.kept: list[Array] = []  # states with their differences, of the stretch that is gone through

    # On the way

    def integrate(
        self, system: RollingSystem, now: PhaseStart, times: Array, tolerance: float, progress: Progress | None
    ) -> Iterator[Segment]:
        """Follow one law to its first stop, and make the differences orthonormal at the times."""
        for until in times.tolist():
            begin, self.kept = now.time, []
            instants = np.append(nodes(begin, until), until)
            whole = bool(np.all(np.diff(instants) > 0)) and instants[0] > begin
            instants = instants if whole else instants[-1:]
            for piece in super().integrate(system, now, instants, tolerance, None):
                last = piece.times == until
                yield replace(piece, times=piece.times[last], states=piece.states[last])
                if piece.stop is not None and not _shrinks(now.law, piece.stop):
                    self._cut_short(now.law, begin, piece.stop.time, tolerance)
                if piece.stop is not None:
                    return
            law, _, state = self.here
            if whole:
                self._take(now.law, begin, until, np.vstack(self.kept)[:-1], tolerance)
            self.here = law, until, self._renormalised(law, until, state)
            values = [float(value_of(one)) for one in state]
            now = transitions.later(system, now, until, np.array(values))
            if progress is not None:
                progress(until)

    def keep(self, law: Law, piece: Segment) -> None:  # noqa: ARG002
        """Keep the states with their differences, for the integrals over a stretch."""
        self.kept.append(piece.states)

    def stopped(self, law: Law, stop: ZeroCrossing) -> None:
        """Write down how much the differences have grown by an event."""
        _, time, state = self.here
        # Where slip or turning shrinks to nothing, its differences die away without end: that belongs to the event.
        self.here = law, time, self._renormalised(law, stop.time, state, across=_shrinks(law, stop))
        self.on_event = True

    def _state(self, now: PhaseStart) -> list[Dual]:
        found = super()._state(now)
        if self.on_event:
            found, self.on_event = self._renormalised(now.law, now.time, found, across=True), False
        self.entry = PhaseStart(
            VariationalLaw(now.law, len(found), self.count), now.start, stacked(found, self.count), now.event_parameters
        )
        return found

    def finished(self) -> None:
        """Work out what is left of the integral of the divergence."""
        self.volume += grown(self.system, self.waiting)
        self.waiting = []

    def _cut_short(self, law: Law, begin: float, end: float, tolerance: float) -> None:
        """Go once more through a stretch that an event has cut short, for its own instants."""
        instants = nodes(begin, end)
        if not (begin < instants[0] and instants[-1] < end and np.all(np.diff(instants) > 0)):
            return
        states = self._through(self.entry, tolerance)(instants)
        if len(states) == NODES.size:
            self._take(law, begin, end, states, tolerance)

    def _through(self, entry: PhaseStart, tolerance: float) -> Callable[[Array], Array]:
        """Return what goes through a stretch again, from its beginning to some instants."""

        def at(instants: Array) -> Array:
            return np.vstack([piece.states for piece in self.method(self.varied, entry, instants, tolerance, None)])

        return at

    def _take(self, law: Law, begin: float, end: float, states: Array, tolerance: float) -> None:
        scale = scale_of(self.system, law, self.length, self.rate)
        again = self._through(self.entry, tolerance)
        self.waiting.append(Stretch(law, begin, end, states, self.alive.copy(), scale, again))
        if len(self.waiting) >= _WAITING:
            self.finished()

    # Orthonormal again

    def _renormalised(self, law: Law, time: float, state: list[Dual], *, across: bool = False) -> list[Dual]:
        """Return a state with its differences orthonormal, and write down how much they had grown."""
        scale = scale_of(self.system, law, self.length, self.rate)
        values = [float(value_of(one)) for one in state]
        columns = np.array([slopes_of(one, self.count) for one in state], dtype=float) / scale[:, None]
        columns = self._on_what_may_be(law, time, values, columns, scale)
        sizes = np.linalg.norm(columns, axis=0)
        if across:
            self._let_go(columns, sizes, time)
        Q, R = np.linalg.qr(columns[:, self.alive])
        grown = np.log(np.abs(np.diag(R)))
        self.logs[self.alive] += grown
        if across:
            self.across += float(grown.sum())
        else:
            self.between += float(grown.sum())
        columns = np.zeros_like(columns)
        columns[:, self.alive] = Q
        self.growth.append(Growth(time, self.logs.copy(), self.between, self.across))
        rows = scale[:, None] * columns
        return [Dual(value, tuple(row)) for value, row in zip(values, rows.tolist(), strict=True)]

    def _let_go(self, columns: Array, sizes: Array, time: float) -> None:
        """Find the differences that an event has taken away: what is left of them is a mixture of those before."""
        for i in np.flatnonzero(self.alive):
            before = columns[:, :i][:, self.alive[:i]]
            left = columns[:, i]
            if before.shape[1]:
                basis = np.linalg.qr(before)[0]
                left = left - basis @ (basis.T @ left)
            if np.linalg.norm(left) <= _LOST * max(sizes[i], float(sizes.max()) * _LOST):
                self.alive[i], self.logs[i] = False, -np.inf
                self.lost.append(time)

    def _on_what_may_be(self, law: Law, time: float, values: list[float], columns: Array, scale: Array) -> Array:
        """Take out of the differences what rounding has put in: off the support, and along q.

        Nothing of that would die away, and so it would hide what does.
        """
        rows = constraint_rows(self.system, law, time, values) * scale
        basis = np.linalg.qr(rows.T)[0]
        return np.asarray(columns - basis @ (basis.T @ columns))


def _shrinks(law: Law, stop: ZeroCrossing) -> bool:
    """Tell whether a law ends because something has shrunk to nothing."""
    return stop.name.removeprefix("near ") in law.ends


def constraint_rows(system: RollingSystem, law: Law, time: float, values: list[float]) -> Array:
    """Return the slopes of what must stay nothing in the state: |q| − 1, and where it touches φ(p) and s·n."""
    size = len(values)
    rows = np.zeros((1 + (law.code != FLIGHT) + (law.code == SLIPPING and law.variables[10] == "s_x"), size))
    rows[0, 3:7] = values[3:7]
    if law.code == FLIGHT:
        return rows
    first = len(law.variables)
    seeds = [Dual(value, tuple(float(i == j) for j in range(size))) for i, value in enumerate(values)]
    point, coordinates = Vector(*seeds[:3]), tuple(seeds[first:])
    n = normal_at(system, time, point, coordinates)
    rows[1, :3] = [float(value_of(part)) for part in n]
    kinds = system.support.motion.coordinate_kinds
    if kinds:  # how the surface moves with the support's own angle
        pose = system.support.motion.at(time, *values[first:])
        carried = Vector(*rows[1, :3]).dot(pose.lever(Vector(*values[:3])))
        rows[1, first:] = [-float(carried) if kind == "angle" else 0.0 for kind in kinds]
    if len(rows) > 2:
        rows[2] = slopes_of(n.dot(Vector(*seeds[10:13])), size)
    return rows
