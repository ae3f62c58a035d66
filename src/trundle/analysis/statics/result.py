"""What `equilibria` returns: each place of rest, and all of them with what was searched."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ...display import Headline, Markup, Plottable, Serializable, pairs, paragraph, records
from ...mechanics.system import RollingSystem, State
from .line import Line
from .stability import Mode

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Triple = tuple[float, float, float]


@dataclass(frozen=True, repr=False)
class Equilibrium(Serializable):
    """A place where the body stays, put down at rest.

    Parameters
    ----------
    state : State
        Place and orientation, at rest: a start for `trundle.simulate`.
    contact : tuple of 3 floats
        Contact point, support frame, m.
    position : tuple of 2 floats
        The coordinates that `RollingSystem.place` takes for it.
    roll : float, optional
        Of a cylinder: the angle from the normal to its mark, as `RollingSystem.place` takes it, rad.
    distance : float, optional
        Of a cylinder: how far it has rolled there from the start, m.
    energy : float, optional
        Over the lowest equilibrium found, J; None for a ball under loads without a potential.
    reaction : tuple of 3 floats
        Contact force on the body, support frame, N.
    normal_force, friction_force : float
        N and |f|, N.
    friction : float, optional
        Coulomb's coefficient of the support.
    stability : str
        "stable", "unstable" or "indifferent".
    modes : tuple of Mode
        The motions of the linearised rolling law about it.
    moves : tuple of str
        In which direction each mode takes the body.
    free : tuple of str
        What may be changed without leaving equilibrium; empty where it stands alone.
    dimension : int
        Of the family of equilibria that it belongs to; 0 where it stands alone.
    kinds : tuple of 2 str
        Whether each coordinate is a "length" or an "angle".
    """

    state: State
    contact: Triple
    position: tuple[float, float]
    roll: float | None
    distance: float | None
    energy: float | None
    reaction: Triple
    normal_force: float
    friction_force: float
    friction: float | None
    stability: str
    modes: tuple[Mode, ...]
    moves: tuple[str, ...]
    free: tuple[str, ...]
    dimension: int
    kinds: tuple[str, str] = ("length", "length")
    angle: float | None = field(default=None, repr=False)  # along the line of a figure, rad

    @property
    def friction_needed(self) -> float:
        """The least coefficient of friction that holds it, |f|/N."""
        if self.normal_force > 0:
            return self.friction_force / self.normal_force
        return 0.0 if self.friction_force == 0 else math.inf

    @property
    def holds(self) -> bool | None:
        """Whether the support's friction holds it; None where the support has no coefficient."""
        return None if self.friction is None else self.friction_needed <= self.friction

    @property
    def stands(self) -> bool:
        """Whether the support has to push, not to pull."""
        return self.normal_force >= -1e-12 * math.hypot(*self.reaction)

    def __str__(self) -> str:
        from .words import report_one

        return report_one(self)

    def _headline(self) -> Headline:
        from .words import kind_of, where

        return Headline(f"at {where(self)}", kind_of(self))

    def _parts(self) -> Iterator[Markup]:
        from .words import record_of

        yield pairs((name, value) for name, value in record_of(self).items() if name != "at")

    def as_dict(self) -> dict[str, Any]:
        """Return everything in SI units and plain types, for JSON."""
        modes = [
            {"moves": moves, "kind": mode.kind, "frequency": mode.frequency, "growth": mode.growth, "turn": mode.turn}
            for mode, moves in zip(self.modes, self.moves, strict=True)
        ]
        needed = self.friction_needed
        return {
            "stability": self.stability,
            "position": self.position,
            "roll": self.roll,
            "distance": self.distance,
            "centre": self.state.position,
            "orientation": self.state.orientation,
            "contact": self.contact,
            "energy": self.energy,
            "contact_force": self.reaction,
            "normal_force": self.normal_force,
            "friction_force": self.friction_force,
            "friction_needed": needed if math.isfinite(needed) else None,
            "holds": self.holds,
            "modes": modes,
            "family": {"dimension": self.dimension, "free": self.free},
        }


@dataclass(frozen=True, repr=False)
class Equilibria(Plottable, Serializable):
    """The equilibria of a system, and what was searched for them.

    It is a sequence: the lowest first where there is an energy, else the nearest to the start.

    Parameters
    ----------
    system : RollingSystem
        Body, support and loads.
    start : State
        Where the search began.
    found : tuple of Equilibrium
        Those that the support can hold by pushing.
    pulled : tuple of Equilibrium
        Stationary points at which the support would have to pull: no equilibria, since it cannot.
    conservative : bool
        Whether every load that a body at rest feels has a potential.
    searched : str
        What was searched.
    section : callable
        Rolls the body along a line to draw the energy over: many times the work of the search.
    reason : str
        Where there are none: why.
    repeats : tuple of 2 floats, optional
        Where everything comes again with each turn: after how far, m, and how much higher, J.
    title : str
        For text and figure.

    Examples
    --------
    >>> import trundle as tr
    >>> found = tr.equilibria(tr.Scenario.load("ball-in-a-trough"))
    >>> len(found), found[0].stability
    (1, 'stable')
    """

    system: RollingSystem
    start: State
    found: tuple[Equilibrium, ...]
    pulled: tuple[Equilibrium, ...]
    conservative: bool
    searched: str
    section: Callable[[], tuple[Line | None, tuple[Equilibrium, ...]]] = field(repr=False)
    reason: str = ""
    repeats: tuple[float, float] | None = None
    title: str = ""

    @cached_property
    def _drawn(self) -> tuple[Line | None, tuple[Equilibrium, ...]]:
        return self.section()

    @property
    def line(self) -> Line | None:
        """The line along which the energy is drawn, if there is one."""
        return self._drawn[0]

    @property
    def marked(self) -> tuple[Equilibrium, ...]:
        """The equilibria on that line."""
        return self._drawn[1]

    def __iter__(self) -> Iterator[Equilibrium]:
        return iter(self.found)

    def __len__(self) -> int:
        return len(self.found)

    def __getitem__(self, index: int) -> Equilibrium:
        return self.found[index]

    def __str__(self) -> str:
        from .words import report

        return report(self)

    def _headline(self) -> Headline:
        from .words import count_of

        return Headline(self.title, count_of(self))

    def _parts(self) -> Iterator[Markup]:
        from .words import kind_of, record_of, remarks

        yield records([{"equilibrium": kind_of(one), **record_of(one, len(self))} for one in self.found])
        yield paragraph("\n".join(remarks(self)))

    def as_dict(self) -> dict[str, Any]:
        """Return everything in SI units and plain types, for JSON.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.equilibria(tr.Scenario.load("weighted-cylinder-too-steep")).as_dict()["equilibria"]
        []
        """
        repeats = None if self.repeats is None else {"distance": self.repeats[0], "energy": self.repeats[1]}
        return {
            "title": self.title,
            "equilibria": [one.as_dict() for one in self.found],
            "would_need_pull": [one.as_dict() for one in self.pulled],
            "conservative": self.conservative,
            "searched": self.searched,
            "reason": self.reason,
            "repeats": repeats,
        }

    def plot(self) -> Figure:
        """Draw the energy along the support beside the body at each equilibrium, with the forces on it.

        Examples
        --------
        >>> import trundle as tr
        >>> figure = tr.equilibria(tr.Scenario.load("weighted-cylinder-on-incline")).plot()
        >>> figure.axes[0].get_ylabel()
        'energy (mJ)'
        """
        from .figure import draw

        return draw(self)
