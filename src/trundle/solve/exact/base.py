"""What every closed form is: facts about itself, a domain, a motion."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from ...errors import OutOfDomainError, SolverError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.duals import has_duals, values_of
from ...mechanics.records import remembered
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


@remembered
def _plain(system: RollingSystem) -> RollingSystem:
    """Return a system whose numbers are no duals."""
    return values_of(system) if has_duals(system) else system


class ClosedForm:
    """A motion known as a formula of the time since the start: a frozen dataclass of the numbers in that formula.

    Examples
    --------
    One that rests wherever it starts, and leaves the rest to its base:

    >>> from trundle.solve.exact.domain import ANY_BODY, AT_REST
    >>> class Still(ClosedForm):
    ...     name, equation, source = "nothing moves", "S1", "by hand"
    ...     conditions = (ANY_BODY, AT_REST)
    >>> Still.domain()
    'any body at rest'
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(1.0))
    >>> Still.violations(tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), table))
    ['the support moves']
    """

    name: ClassVar[str]  # as it goes on after "the closed form"
    equation: ClassVar[str]  # its number on the theory page
    source: ClassVar[str]
    conditions: ClassVar[tuple[Condition, ...]]  # of which the domain is put together
    phases: ClassVar[tuple[int, ...]] = (ROLLING,)  # of contact that it covers
    of_arrays: ClassVar[bool] = False  # whether its numbers may be arrays, one element for each time asked for
    impossible_events: ClassVar[frozenset[str]] = frozenset()  # events of the phase that cannot come

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> Self:
        """Read the closed form's numbers from a system and a start.

        Parameters
        ----------
        system : RollingSystem
            Body, support, gravity and loads.
        start : State
            Where the phase begins.

        Returns
        -------
        ClosedForm
            Of this class.

        Raises
        ------
        OutOfDomainError
            Outside the domain; it names what lies outside.
        """
        raise NotImplementedError

    @classmethod
    def from_state_vector(cls, system: RollingSystem, start: State, numbers: Sequence[float]) -> Self:  # noqa: ARG003
        """Do the same where the numbers of the phase's law say more than the state, such as a very small slip.

        Parameters
        ----------
        system : RollingSystem
            Body, support, gravity and loads.
        start : State
            Where the phase begins.
        numbers : sequence of float
            The law's, SI.

        Returns
        -------
        ClosedForm
            Of this class.
        """
        return cls.of(system, start)

    @classmethod
    def domain(cls) -> str:
        """Say what it covers.

        Returns
        -------
        str
            The words of its conditions.
        """
        return "".join(condition.words for condition in cls.conditions)

    @classmethod
    def violations(cls, system: RollingSystem, start: State | None = None) -> list[str]:
        """Name what of a system, and of a start where one is given, lies outside the domain.

        Parameters
        ----------
        system : RollingSystem
            Body, support, gravity and loads.
        start : State, optional
            Where the phase begins.

        Returns
        -------
        list of str
            Empty inside. Forces are looked at where all parts fit, the start where the forces fit, too. Of duals the
            values are asked.
        """
        if cls not in system._known:  # the same system is asked about at each of its events
            system._known[cls] = cls._outside(_plain(system))
        found: list[str] = list(system._known[cls])
        if found or start is None or not any(condition.about == START for condition in cls.conditions):
            return found
        return cls._failures(START, _plain(system), values_of(start) if has_duals(start) else start)

    @classmethod
    def _outside(cls, system: RollingSystem) -> list[str]:
        return cls._failures(PARTS, system, None) or cls._failures(FORCES, system, None)

    @classmethod
    def _failures(cls, about: int, system: RollingSystem, start: State | None) -> list[str]:
        asked = (condition for condition in cls.conditions if condition.about == about)
        return [failure for condition in asked for failure in condition.failures(system, start)]

    @classmethod
    def refusal(cls, system: RollingSystem, start: State | None = None) -> str:
        """Say what the closed form covers and what lies outside.

        Parameters
        ----------
        system, start : see outside
            Of which it is asked.

        Returns
        -------
        str
            Empty where the system lies in the domain.
        """
        outside = cls.violations(system, start)
        if not outside:
            return ""
        return f"The closed form {cls.equation} ({cls.name}) covers {cls.domain()}. Outside it: {'; '.join(outside)}."

    @classmethod
    def check_domain(cls, system: RollingSystem, start: State) -> None:
        """Refuse a system outside the domain by name.

        Parameters
        ----------
        system, start : see outside
            Of which it is asked.

        Raises
        ------
        OutOfDomainError
            Where anything lies outside.
        """
        refusal = cls.refusal(system, start)
        if refusal:
            raise OutOfDomainError(f'{refusal} Use method="taylor" or method="runge-kutta".')

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return the motion, in the inertial support frame.

        Parameters
        ----------
        t : float or array
            Since the start, s.

        Returns
        -------
        tuple of Vector
            Centre of mass, m; its velocity, m/s; angular velocity, rad/s; contact force, N.
        """
        raise NotImplementedError

    def angular_velocity_at(self, t: Any) -> Vector:
        """Return Ω of `motion_at` alone: override it where that is much less work.

        Parameters
        ----------
        t : float or array
            Since the start, s.

        Returns
        -------
        Vector
            rad/s.
        """
        return self.motion_at(t)[2]

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:
        """Return by how much the coordinates of the support's own motion have grown.

        Parameters
        ----------
        t : float or array
            Since the start, s.

        Returns
        -------
        tuple
            One for each that it has.
        """
        del t
        return ()

    def motion_and_support_at(self, t: Any) -> tuple[tuple[Vector, Vector, Vector, Vector], tuple[Any, ...]]:
        """Return what `motion_at` and `support_coordinates_at` do: override it where they share most of the work.

        Parameters
        ----------
        t : float or array
            Since the start, s.

        Returns
        -------
        tuple
            That of `motion_at`, and that of `support_coordinates_at`.
        """
        return self.motion_at(t), self.support_coordinates_at(t)

    @property
    def period(self) -> Any:
        """Time after which the motion repeats, s; infinite where it does not."""
        raise NotImplementedError

    def max_rate(self, duration: float) -> float:  # forms given in time ask how long
        """Return the fastest rate in the motion: what a look at it must resolve.

        Parameters
        ----------
        duration : float
            Of the run, s.

        Returns
        -------
        float
            1/s.
        """
        raise NotImplementedError

    def max_rates(self, duration: float) -> list[tuple[float, float]]:
        """Return up to when which rate is the fastest: one for all of the time, unless the form knows more.

        Parameters
        ----------
        duration : float
            Of the run, s.

        Returns
        -------
        list of tuple
            Time since the start, s, and rate until then, 1/s.
        """
        return [(duration, self.max_rate(duration))]

    @property
    def ends_at(self) -> dict[str, float]:
        """When the phase ends, s since the start, by those of its law's events that the form knows; or never, inf."""
        return {}

    def expected(self, duration: float) -> list[tuple[str, str]]:
        """Return numbers that it promises of a run, for a reader before the run: when it ends, its period or its place.

        Parameters
        ----------
        duration : float
            Of the run, s.

        Returns
        -------
        list of tuple of str
            Name and value with its unit.
        """
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

    def promised(self, said: str) -> Any:  # noqa: ARG002
        """Return the number of a sentence of its findings, for any scalars.

        Parameters
        ----------
        said : str
            The sentence, as `Finding.said` has it.

        Returns
        -------
        scalar or None
            SI; None where only numbers tell it.
        """
        return None

    def formulas(self, system: RollingSystem) -> Lines:
        """Return its formulas; the laws that it obeys, unless it has its own.

        Parameters
        ----------
        system : RollingSystem
            From which it was read.

        Returns
        -------
        list of tuple of str
            LaTeX of a formula, and of the same with the numbers put in; the latter may be empty.
        """
        force, torque = NEWTON_AND_EULER
        return [(force, body_numbers(system)), (torque, "")]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare numbers that it predicts with what samples show; how far it gets, unless it has its own.

        Parameters
        ----------
        seen : Seen
            A run that starts with it, of four samples or more.

        Yields
        ------
        Finding
            A number, predicted and measured.
        """
        end = float(seen.time[-1])
        gone = self.motion_at(end)[0] - self.motion_at(0.0)[0]
        measured = float(np.linalg.norm(seen.at.position[-1] - seen.at.position[0]))
        name, note = "Distance from the start", f"straight, after {end:.4g} s"
        yield Finding(name, "d", float(gone.norm()), measured, "m", note=note, scale=seen.way or None)

    def repeats(self, stop: str) -> float:  # noqa: ARG002
        """Return after how long the course of one of the law's event functions repeats.

        Parameters
        ----------
        stop : str
            Such as ``"slip"``.

        Returns
        -------
        float
            s; infinite where it does not.
        """
        return float(self.period)

    @property
    def circle(self) -> Circle | None:
        """The circle in which the body goes about a point that drifts steadily; None where it goes in none."""
        return None

    def fixed_axis_rotation(self, t: Any) -> tuple[Vector, Any] | None:
        """Return the fixed axis about which the body has turned and the angle, where the position gives them.

        Parameters
        ----------
        t : float or array
            Since the start, s.

        Returns
        -------
        tuple of (Vector, float or array), or None
            Unit vector and angle, rad; None where Ω has to be followed.
        """
        del t
        return None

    def monodromy(self) -> Monodromy | None:
        """Return the turn of the body over one period, so that a long run costs what one period costs.

        Returns
        -------
        Monodromy or None
            To more digits than a float has; None where it is not known.
        """
        return None

    def representative_orientation(self, t: Any) -> Quaternion | None:
        """Return an orientation with which the law gives the forces of that time.

        Parameters
        ----------
        t : float or array
            Since the start, s.

        Returns
        -------
        Quaternion or None
            None where any will do, as for a body that is alike all round.
        """
        del t
        return None
