"""The variational equations of a law, as a law: its state and how that changes with some parameters.

Nothing is derived twice: the law is traced on duals whose slopes are numbers of the state, and what comes of them is
Y' = (∂f/∂y) Y + ∂f/∂θ. So every method that follows the law follows these as well, compiled and kept like any other.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.duals import Dual, slopes_of, unstacked, value_of, values_of
from ..mechanics.loads import BodyMotion
from ..mechanics.parameters import structure_of, with_numbers
from ..mechanics.scalars import Scalar, is_number
from ..mechanics.system import RollingSystem
from .contact_state import ContactState
from .laws import Law, Numbers
from .samples import Array


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

    Parameters
    ----------
    slopes : tuple of tuple
        Of each of the numbers, by each parameter; None where it does not depend on that.
    template : Template
        The system, to tell which of its scalars are numbers where these stand for others.

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

    slopes: tuple[tuple[Scalar | None, ...], ...] = ()
    template: Any = None

    @classmethod
    def of(cls, system: RollingSystem) -> VariedSystem:
        """Return a system in duals as one in numbers, with its slopes."""
        plain = values_of(system)
        found = list(_scalars(system, plain))
        count = max((len(one.slopes) for one in found if isinstance(one, Dual)), default=0)
        slopes = tuple(tuple(float(s) if s != 0 else None for s in slopes_of(one, count)) for one in found)
        parts = {field.name: getattr(plain, field.name) for field in fields(RollingSystem)}
        return cls(**parts, slopes=slopes, template=Template(plain))

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

    def __init__(self, law: Law, size: int, count: int) -> None:
        super().__init__(law.weightless)
        self.kind, self.settings = type(law), tuple(vars(law).items())
        self.size, self.count = size, count

    @property
    def law(self) -> Law:
        """The law whose variational equations they are."""
        found = object.__new__(self.kind)
        vars(found).update(self.settings)
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
