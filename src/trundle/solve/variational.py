"""The variational equations of a law, as a law: its state and how that changes with some parameters.

Nothing is derived twice: the law is traced on duals whose slopes are numbers of the state, and what comes of them is
Y' = (∂f/∂y) Y + ∂f/∂θ. So every method that follows the law follows these as well, compiled and kept like any other.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from ..errors import InvalidValueError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.duals import Dual, slopes_of, stacked, unstacked, value_of, values_of
from ..mechanics.loads import BodyMotion
from ..mechanics.parameters import structure_of, with_numbers
from ..mechanics.scalars import Scalar, is_number
from ..mechanics.system import RollingSystem
from .charts import LAWS_OWN, Chart, SupportAxes, Traced, charts
from .contact_state import ContactState
from .laws import Law, Numbers
from .samples import Array

_OF_LAW = "of_law_"  # begins the names of its numbers
_ASIDE = 1e-7  # of a parameter, in SI: where a symmetry is no more, whatever the size


class Template:
    """A system of which only the structure counts: where its numbers stand.

    Parameters
    ----------
    system : RollingSystem
        One with this structure.
    """

    def __init__(self, system: RollingSystem) -> None:
        self.system, self.structure = system, structure_of(system)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Template) and other.structure == self.structure

    def __hash__(self) -> int:
        return hash(self.structure)


@dataclass(frozen=True)
class VariedSystem(RollingSystem):
    """A system with the slopes of its numbers, which are numbers of it too.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.duals import duals
    >>> (tilt,) = duals((0.1,))
    >>> slope = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), tilt=tilt))
    >>> system = VariedSystem.of(slope)
    >>> system.support.tilt, system.in_duals().support.tilt.slopes
    (0.1, (1.0,))
    """

    # of each of the numbers, by each parameter; None where it does not depend on that
    slopes: tuple[tuple[Scalar | None, ...], ...] = ()
    template: Any = None  # the system, to tell which of its scalars are numbers where these stand for others

    @classmethod
    def of(cls, system: RollingSystem) -> VariedSystem:
        """Return a system in duals as one in numbers, with its slopes."""
        plain = values_of(system)
        found = list(_scalars(system, plain))
        count = max((len(one.slopes) for one in found if isinstance(one, Dual)), default=0)
        slopes = tuple(tuple(float(s) if s != 0 else None for s in slopes_of(one, count)) for one in found)
        parts = {field.name: getattr(plain, field.name) for field in fields(RollingSystem)}
        return cls(**parts, slopes=slopes, template=Template(plain))

    def aside(self) -> RollingSystem | None:
        """Return the system with numbers a little off along all their slopes at once; None where it may not be so."""
        for step in (_ASIDE, -_ASIDE):
            with suppress(InvalidValueError):  # a number at its limit
                return self._moved(step)
        return None

    def _moved(self, step: float) -> RollingSystem:
        way = [1.0 + 0.37 * j for j in range(len(self.slopes[0]))]
        moved = []
        for number, row in zip(_scalars(self, self.template.system), self.slopes, strict=True):
            slope = sum(0.0 if one is None else one * share for one, share in zip(row, way, strict=True))
            moved.append(number + step * slope)
        return with_numbers(self.template.system, moved)

    def in_duals(self) -> RollingSystem:
        """Return the system in duals."""
        return with_numbers(self.template.system, self.scalars())

    def scalars(self) -> list[Any]:
        """Return its numbers in duals, those that depend on a parameter."""
        found: list[Any] = []
        for number, row in zip(_scalars(self, self.template.system), self.slopes, strict=True):
            known = tuple(0.0 if slope is None else slope for slope in row)
            found.append(number if all(slope is None for slope in row) else Dual(number, known))
        return found


def _scalars(thing: Any, template: Any) -> Iterator[Any]:
    """Yield what stands in a system where a template has its numbers, in the order of `numbers`."""
    if is_dataclass(template):
        for field in fields(template):
            yield from _scalars(getattr(thing, field.name), getattr(template, field.name))
    elif isinstance(template, tuple):
        for part, of_template in zip(thing, template, strict=True):
            yield from _scalars(part, of_template)
    elif is_number(template) and not isinstance(template, bool):
        yield thing


class VariationalLaw(Law):
    """A law and its variational equations: the state is (y, ∂y/∂θ₁, ∂y/∂θ₂, ...).

    Parameters
    ----------
    law : Law
        Whose they are.
    size : int
        How many numbers its state has.
    count : int
        How many parameters there are.
    """

    variational = True

    def __init__(self, law: Law, size: int, count: int) -> None:
        super().__init__(law.weightless)
        of_law = vars(law).items()
        self.kind, self.settings = type(law), tuple((name, one) for name, one in of_law if not isinstance(one, float))
        self.size, self.count = size, count
        # Numbers of the law are numbers of this one: laws that differ by them alone are traced once.
        vars(self).update({_OF_LAW + name: one for name, one in of_law if isinstance(one, float)})

    @property
    def law(self) -> Law:
        """The law whose variational equations they are."""
        found = object.__new__(self.kind)
        vars(found).update(self.settings)
        own = {name.removeprefix(_OF_LAW): one for name, one in vars(self).items() if name.startswith(_OF_LAW)}
        vars(found).update(own)
        return found

    # What integrators ask of a law is that of the law itself, for its own numbers.

    @property
    def code(self) -> int:  # type: ignore[override]
        """The phase."""
        return self.kind.code

    @property
    def brief(self) -> bool:  # type: ignore[override]
        """Whether it holds for a short time only."""
        return self.kind.brief

    @property
    def unwatched(self) -> int:  # type: ignore[override]
        """All derivatives of a brief law: it takes differences over a short step, whose rounding is theirs."""
        return self.size * self.count if self.brief else 0

    @property
    def ends(self) -> tuple[str, ...]:
        """Which of its events come where something shrinks to nothing."""
        return self.law.ends

    def names(self, system: RollingSystem) -> tuple[str, ...]:
        """Return the names of all numbers of the state."""
        own = self.law.names(system)
        return (*own, *(f"d{j}_{name}" for j in range(self.count) for name in own))

    def split(self, state: Numbers) -> tuple[Vector, Quaternion, Vector, Numbers, tuple[Scalar, ...]]:
        """Return what the law does."""
        return self.law.split(state[: self.size])

    def rates(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return f and (∂f/∂y) Y + ∂f/∂θ."""
        found = self.law.rates(in_duals(system), time, unstacked(state, self.size))
        slopes = [slopes_of(rate, self.count) for rate in found]
        return [*map(value_of, found), *(row[j] for j in range(self.count) for row in slopes)]

    def event_functions(
        self, system: RollingSystem, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> dict[str, Scalar]:
        """Return what the law does."""
        return self.law.event_functions(system, time, state[: self.size], event_parameters)

    def found(self, system: RollingSystem, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return what the law does."""
        return self.law.found(system, time, state[: self.size])

    def unpack(self, system: RollingSystem, time: float, numbers: Sequence[float] | Array) -> ContactState:
        """Return the body that is meant."""
        return self.law.unpack(system, time, numbers[: self.size])

    def motion(self, system: RollingSystem, time: Scalar, state: Numbers) -> BodyMotion:
        """Return what loads may depend on."""
        return self.law.motion(system, time, state[: self.size])

    def stiff(self, numbers: Array) -> bool:
        """Tell what the law does."""
        return self.law.stiff(numbers[: self.size])

    def shrinking(self, system: RollingSystem, time: float, numbers: Sequence[float] | Array, stop: str) -> Vector:
        """Return what the law does."""
        return self.law.shrinking(system, time, numbers[: self.size], stop)

    def shrinking_rate(self, system: RollingSystem, time: float, numbers: Sequence[float] | Array, stop: str) -> Vector:
        """Return what the law does."""
        return self.law.shrinking_rate(system, time, numbers[: self.size], stop)


def in_duals(system: RollingSystem) -> RollingSystem:
    """Return a varied system in duals; any other as it is: nothing of it depends on a parameter."""
    return system.in_duals() if isinstance(system, VariedSystem) else system


@dataclass(frozen=True)
class ChartWithSlopes(Chart):
    """A chart for a law and its derivatives: the numbers of another chart, each with its slopes."""

    chart: Chart = LAWS_OWN  # of the law itself
    own: int = 0  # how many numbers that has
    size: int = 0  # how many numbers the law has
    count: int = 0  # how many parameters there are

    @property
    def bounded(self) -> bool:
        """Whether a run may leave it."""
        return self.chart.bounded

    def names(self, system: RollingSystem, law: Law) -> tuple[str, ...]:
        """Return the names of the numbers, and of their slopes."""
        own = self.chart.names(system, _inner(law))
        return (*own, *(f"d{j}_{name}" for j in range(self.count) for name in own))

    def contains(self, state: Sequence[float]) -> bool:
        """Tell whether a run may begin in it."""
        return self.chart.contains(state[: self.size])

    def traced(
        self, system: RollingSystem, law: Law, time: Scalar, state: Numbers, event_parameters: Numbers
    ) -> Traced:
        """Return the rates of the numbers and of their slopes."""
        seen = in_duals(system)
        found = self.chart.traced(seen, _inner(law), time, unstacked(state, self.own), event_parameters)
        stops = {name: value_of(stop) for name, stop in found.event_functions.items()}
        normal, positive = Vector(*map(value_of, found.normal)), tuple(map(value_of, found.positive))
        lengths = tuple((value_of(anywhere), value_of(known)) for anywhere, known in found.lengths)
        return Traced(stacked(found.rates, self.count), stops, normal, positive, lengths)

    def tidied(self, system: RollingSystem, law: Law, time: Scalar, state: Numbers) -> list[Scalar]:
        """Return the state with its numbers tidied."""
        return [*self.chart.tidied(system, _inner(law), time, state[: self.own]), *state[self.own :]]

    def reduced(self, numbers: Sequence[float]) -> list[float]:
        """Return the numbers with whole turns taken out of the angles."""
        return [*self.chart.reduced(numbers[: self.own]), *numbers[self.own :]]

    def of_law(self, system: RollingSystem, time: float, state: Sequence[float]) -> list[float]:
        """Return its numbers, given the law's."""
        numbers: Any = unstacked(list(map(float, state)), self.size)
        found = self.chart.of_law(in_duals(system), time, numbers)
        return [float(number) for number in stacked(found, self.count)]

    def to_law(self, system: RollingSystem, time: Any, numbers: Numbers) -> list[Any]:
        """Return the law's numbers, or columns of them, given its own."""
        return stacked(self.chart.to_law(in_duals(system), time, unstacked(numbers, self.own)), self.count)


def charts_with_slopes(system: RollingSystem, law: Law) -> tuple[Chart, ...]:
    """Return the charts in which a law may be integrated with its derivatives: those of it, and of what is like it.

    A number that breaks a symmetry of the system has slopes that a chart which leans on it does not know.
    """
    if not isinstance(law, VariationalLaw) or not isinstance(system, VariedSystem):
        return (LAWS_OWN,)
    found: list[Chart] = [LAWS_OWN]
    for chart in _kept(system, law.law):
        own = len(chart.names(system, law.law))
        found.append(ChartWithSlopes(chart=chart, own=own, size=law.size, count=law.count))
    return tuple(found)


def keeps_charts(system: RollingSystem, law: Law) -> bool:
    """Tell whether all charts of a law know the slopes of a system that is given in duals.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.duals import duals
    >>> from trundle.solve.laws import RollingLaw
    >>> radius, moment = duals((0.02, 1e-5))
    >>> coin = tr.Body.disc(radius=radius, mass=0.1)
    >>> keeps_charts(tr.RollingSystem(coin, tr.Support(tr.Plane())), RollingLaw())
    True
    """
    plain = VariedSystem.of(system)
    return len(_kept(plain, law)) == len(_others(plain, law))


def _others(system: RollingSystem, law: Law) -> list[Chart]:
    """Return the charts of a law beside its own; how far a support has turned has slopes that its axes do not know."""
    return [chart for chart in charts(system, law)[1:] if not isinstance(chart, SupportAxes)]


def _kept(system: VariedSystem, law: Law) -> list[Chart]:
    """Return those of them whose symmetry all numbers keep that have slopes."""
    aside = system.aside()
    there = () if aside is None else charts(aside, law)
    return [chart for chart in _others(system, law) if chart in there]


def _inner(law: Law) -> Law:
    return law.law if isinstance(law, VariationalLaw) else law
