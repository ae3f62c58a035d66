"""What every closed form is: facts about itself, a domain, a motion."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from ...errors import OutOfDomainError, SolverError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.system import RollingSystem, State
from ..samples import ROLLING
from .circle import Circle
from .domain import FORCES, PARTS, START, Condition
from .finding import Finding
from .fits import Seen
from .formula import NEWTON_AND_EULER, Lines, body_numbers

if TYPE_CHECKING:
    from ..monodromy import Monodromy

# What is said of when a phase ends, by the stop that ends it.
_ENDS = {
    "grip": "it grips and rolls after",
    "land": "it lands after",
    "lift": "it comes off after",
    "slip": "it begins to slip after",
    "stop": "it comes to rest after",
}


class ClosedForm:
    """A motion known as a formula of the time since the start."""

    name: ClassVar[str]
    equation: ClassVar[str]
    source: ClassVar[str]
    conditions: ClassVar[tuple[Condition, ...]]  # of which the domain is put together
    phases: ClassVar[tuple[int, ...]] = (ROLLING,)  # of contact that it covers
    of_arrays: ClassVar[bool] = False  # whether its numbers may be arrays, one element for each time asked for
    never: ClassVar[frozenset[str]] = frozenset()  # stops of the phase that cannot come

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> Self:
        """Read the closed form's numbers from a system and a start; raise OutOfDomainError outside its domain."""
        raise NotImplementedError

    @classmethod
    def of_numbers(cls, system: RollingSystem, start: State, numbers: Sequence[float]) -> Self:  # noqa: ARG003
        """Do the same where the numbers of the phase's law say more than the state, such as a very small slip."""
        return cls.of(system, start)

    @classmethod
    def domain(cls) -> str:
        """Say what it covers."""
        return "".join(condition.words for condition in cls.conditions)

    @classmethod
    def outside(cls, system: RollingSystem, start: State | None = None) -> list[str]:
        """Name what of a system, and of a start where one is given, lies outside the domain."""
        for about in (PARTS, FORCES, START)[: 2 if start is None else 3]:
            asked = [condition for condition in cls.conditions if condition.about == about]
            if found := [failure for condition in asked for failure in condition.failures(system, start)]:
                return found
        return []

    @classmethod
    def refusal(cls, system: RollingSystem, start: State | None = None) -> str:
        """Say what the closed form covers and what lies outside; nothing where the system lies in the domain."""
        outside = cls.outside(system, start)
        if not outside:
            return ""
        return f"The closed form {cls.equation} ({cls.name}) covers {cls.domain()}. Outside it: {'; '.join(outside)}."

    @classmethod
    def check_domain(cls, system: RollingSystem, start: State) -> None:
        """Refuse a system outside the domain by name."""
        refusal = cls.refusal(system, start)
        if refusal:
            raise OutOfDomainError(f'{refusal} Use method="taylor" or method="runge-kutta".')

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force at a time since the start, s."""
        raise NotImplementedError

    def own_at(self, t: Any) -> tuple[Any, ...]:
        """Return by how much the coordinates of the support's own motion have grown, where it has some."""
        del t
        return ()

    def motion_and_own_at(self, t: Any) -> tuple[tuple[Vector, Vector, Vector, Vector], tuple[Any, ...]]:
        """Return what `motion_at` and `own_at` do."""
        return self.motion_at(t), self.own_at(t)

    @property
    def period(self) -> Any:
        """Time after which the motion repeats, s; infinite where it does not."""
        raise NotImplementedError

    def pace(self, duration: float) -> float:  # forms given in time ask how long
        """Return the fastest rate in the motion over a time, 1/s: what a look at it must resolve."""
        raise NotImplementedError

    def paces(self, duration: float) -> list[tuple[float, float]]:
        """Return up to when, s, which rate is the fastest, 1/s: one for all of the time, unless the form knows more."""
        return [(duration, self.pace(duration))]

    @property
    def ends_at(self) -> dict[str, float]:
        """When the phase ends, s since the start, by those of its law's stops that the form knows; or never, inf."""
        return {}

    def expected(self, duration: float) -> list[tuple[str, str]]:
        """Return numbers that it promises of a run, each with its name, for a reader before the run."""
        rows = [(_ENDS[stop], f"{t:.6g} s") for stop, t in self.ends_at.items() if stop in _ENDS and t < math.inf]
        if (period := float(self.period)) < math.inf:
            rows.append(("one period, while it stays on", f"{period:.6g} s"))
        if rows:
            return rows
        try:
            x, y, z = self.motion_at(duration)[0]
            told = f"({x:.6g}, {y:.6g}, {z:.6g}) m"
        except SolverError as error:
            told = str(error)
        return [(f"centre after {duration:g} s, if no event comes first", told)]

    def formulas(self, system: RollingSystem) -> Lines:
        """Return its formulas in LaTeX, each with the numbers put in; the laws that it obeys, unless it has its own."""
        force, torque = NEWTON_AND_EULER
        return [(force, body_numbers(system)), (torque, "")]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Return numbers that it predicts beside what samples show; how far it gets, unless it has its own."""
        end = float(seen.time[-1])
        gone = self.motion_at(end)[0] - self.motion_at(0.0)[0]
        measured = float(np.linalg.norm(seen.at.position[-1] - seen.at.position[0]))
        name, note = "Distance from the start", f"straight, after {end:.4g} s"
        yield Finding(name, "d", float(gone.norm()), measured, "m", note, seen.way or None)

    def repeats(self, stop: str) -> float:  # noqa: ARG002
        """Return after how long the course of one of the law's stops repeats, s; infinite where it does not."""
        return float(self.period)

    @property
    def circle(self) -> Circle | None:
        """The circle in which the body goes about a point that drifts steadily; None where it goes in none."""
        return None

    def straight_turn(self, t: Any) -> tuple[Vector, Any] | None:
        """Return the fixed axis about which the body has turned and the angle, rad, where the position gives them."""
        del t
        return None

    def monodromy(self) -> Monodromy | None:
        """Return the turn of the body over one period, to more digits than a float has; None where it is not known."""
        return None

    def stance(self, t: Any) -> Quaternion | None:
        """Return an orientation with which the law gives the forces of that time; None where any will do."""
        del t
        return None
