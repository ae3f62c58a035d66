"""What every method returns: the states at the instants asked for, and how the run ended."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..display import Displayed, Headline, Markup, number, numbers, pairs
from ..errors import InvalidValueError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import normal_at, normal_on
from ..mechanics.loads import BodyMotion
from ..mechanics.motions import SupportState
from ..mechanics.system import RollingSystem, State

Array = NDArray[np.float64]
Progress = Callable[[float], None]  # told the fraction done, 0 to 1
AT_ONCE = 50_000  # samples that are worked on together, lest what is worked out on the way outgrow the result


ROLLING, SLIPPING, FLIGHT, RESTING = range(4)  # phases of the contact
ENDS = ("rim", "end", "edge", "curved", "spot", "wall")  # kinds of event that end a run
KINDS = ("slip", "grip", "lift", "land", "settle", "jolt", "stop", "start", *ENDS)


@dataclass(frozen=True, repr=False)
class Event(Displayed):
    """Something that happened at one instant of a run.

    Parameters
    ----------
    time : float
        s.
    kind : str
        ``"slip"``: rolling gave way to slipping, or it slips on another way. ``"grip"``: slipping ended. ``"lift"``:
        the support no longer held the body. ``"land"``: a flight ended, the body bouncing or not. ``"settle"``: it
        landed, and its bounces were cut short. ``"jolt"``: the velocity of the support jumped under the body, and the
        support struck it, jerked sideways, or jerked away. ``"stop"``, ``"start"``: it came to rest on the support, or
        left it.
        The run ended at ``"rim"``: the contact reached the rim; ``"end"``: the end of the surface; ``"edge"``: of what
        the body's shape covers; ``"curved"``: where the support is too hollow for the body; ``"spot"``: rolling stopped
        while the body still spins; ``"wall"``: another part of the body came to the support.
    text : str
        What happened, for the reader.
    before, after : State, optional
        The state just before and just after; they differ where something struck.
    contact : triple of float, optional
        Where the body touched, p in the inertial support frame, m.

    Raises
    ------
    InvalidValueError
        If there is no such kind.

    Examples
    --------
    >>> Event(1.5, "rim", "ran off the rim").kind
    'rim'
    """

    time: float
    kind: str
    text: str
    before: State | None = None
    after: State | None = None
    contact: tuple[float, float, float] | None = None

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise InvalidValueError("kind", f"must be one of {', '.join(KINDS)}", self.kind)

    def _headline(self) -> Headline:
        return Headline(self.kind, self.text)

    def _parts(self) -> Iterator[Markup]:
        contact = "" if self.contact is None else numbers(self.contact, unit="m")
        yield pairs([("time", number(self.time, 9, "s")), ("contact", contact)])

    @property
    def final(self) -> bool:
        """Whether the run ended here."""
        return self.kind in ENDS


@dataclass(frozen=True)
class Samples:
    """States of one body at ascending instants, in the inertial support frame; arrays (n,), (n, 3) and (n, 4).

    Examples
    --------
    >>> still = Samples(np.zeros(1), *[np.zeros((1, 3))] * 4, np.array([[1.0, 0, 0, 0]]), np.zeros((1, 3)))
    >>> still.phase.tolist(), still.support_coordinates.shape
    ([0], (1, 0))
    """

    time: Array
    position: Array
    contact: Array
    velocity: Array
    angular_velocity: Array
    orientation: Array
    contact_force: Array
    events: tuple[Event, ...] = ()
    phase: Any = None  # (n,) int8: ROLLING, SLIPPING, FLIGHT or RESTING; absent: rolling
    support_coordinates: Any = None  # (n, k): the coordinates of the support's own motion; absent: none
    slip_velocity: Any = None  # (n, 3): as a dataset holds it; absent: what V, Ω and the support make of it
    form: Any = None  # the closed form of the phase in which they start, where they come from one

    def __post_init__(self) -> None:
        if self.phase is None:
            object.__setattr__(self, "phase", np.zeros(self.time.size, dtype=np.int8))
        if self.support_coordinates is None:
            object.__setattr__(self, "support_coordinates", np.zeros((self.time.size, 0)))

    @property
    def support_columns(self) -> tuple[Array, ...]:
        """The coordinates of the support's own motion, as `Motion.at` takes them."""
        return tuple(self.support_coordinates.T)

    @staticmethod
    def joined(parts: Sequence[Samples], events: tuple[Event, ...] = ()) -> Samples:
        """Return several stretches of one run as one."""
        joined = {name: np.concatenate([getattr(part, name) for part in parts]) for name in _columns()}
        return Samples(**joined, events=events)

    def motion(self, system: RollingSystem) -> BodyMotion:
        """Return the motion that loads and integrals take, with arrays as components."""
        touching, support = not (self.phase == FLIGHT).all(), self.support(system)
        return BodyMotion(
            self.time,
            system.body.mass,
            Vector.of(self.position),
            Vector.of(self.velocity),
            Quaternion.of(self.orientation),
            Vector.of(self.angular_velocity),
            normal_on(system, support, Vector.of(self.contact)) if touching else None,
            support.angular_velocity,
        )

    def support(self, system: RollingSystem) -> SupportState:
        """Return pose, twist and acceleration of the support at each instant."""
        return system.support.motion.at(self.time, *self.support_columns)

    def speeds(self, system: RollingSystem) -> tuple[Vector, Vector, Vector]:
        """Return V, Ω×ρ and u, m/s, from the samples' own numbers; the slip is s = V + Ω×ρ − u."""
        u = self.support(system).material_velocity(Vector.of(self.contact))
        rho = Vector.of(self.contact - self.position)
        return Vector.of(self.velocity), Vector.of(self.angular_velocity).cross(rho), u

    def normals(self, system: RollingSystem) -> Array:
        """Return the support's unit normal at each contact (n, 3), from the support into the body."""
        normal = normal_at(system, self.time, Vector.of(self.contact), self.support_columns)
        return np.broadcast_to(normal.array(), self.position.shape)

    def part(self, where: Any) -> Samples:
        """Return some of the samples, chosen as an array is indexed."""
        slips = None if self.slip_velocity is None else self.slip_velocity[where]
        return replace(self, **{name: getattr(self, name)[where] for name in _columns()}, slip_velocity=slips)

    def blocks(self) -> Iterator[tuple[slice, Samples]]:
        """Yield all samples, `AT_ONCE` of them at a time, and where these stand."""
        for first in range(0, self.time.size, AT_ONCE):
            where = slice(first, min(first + AT_ONCE, self.time.size))
            yield where, self.part(where)

    def state(self, index: int) -> State:
        """Return one sample as a state to start from."""

        def row(array: Array) -> Any:
            return tuple(array[index].tolist())

        return State(
            row(self.position),
            row(self.velocity),
            row(self.angular_velocity),
            row(self.orientation),
            float(self.time[index]),
            row(self.support_coordinates),
        )


class Recording:
    """Samples in the making: one array for each column, long enough for all of a run, and filled from the front.

    Parameters
    ----------
    most : int
        How many samples there may be.

    Examples
    --------
    >>> still = Samples(np.zeros(1), *[np.zeros((1, 3))] * 4, np.array([[1.0, 0, 0, 0]]), np.zeros((1, 3)))
    >>> recording = Recording(5)
    >>> recording.add(still)
    >>> recording.add(still)
    >>> recording.samples().position.shape
    (2, 3)
    """

    def __init__(self, most: int) -> None:
        self.most, self.count = most, 0
        self._arrays: dict[str, Any] = {}

    def add(self, part: Samples) -> None:
        """Put samples behind those that are there."""
        upto = self.count + part.time.size
        for name in _columns():
            column = getattr(part, name)
            if name not in self._arrays:
                self._arrays[name] = np.empty((self.most, *column.shape[1:]), column.dtype)
            self._arrays[name][self.count : upto] = column
        self.count = upto

    def samples(self, events: tuple[Event, ...] = (), form: Any = None) -> Samples:
        """Return what was added; where it is little, without the room that was kept for more."""
        kept = {name: array[: self.count] for name, array in self._arrays.items()}
        if self.count < self.most // 2:
            kept = {name: array.copy() for name, array in kept.items()}
        return Samples(**kept, events=events, form=form)


@cache
def _columns() -> tuple[str, ...]:
    return tuple(field.name for field in fields(Samples) if field.name not in ("events", "slip_velocity", "form"))
