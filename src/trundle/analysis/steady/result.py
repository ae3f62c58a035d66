"""What `steady_motions` returns: each steady motion with its evidence, and all of them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ...display import Headline, Markup, Plottable, Serializable, pairs, paragraph, records
from ...mechanics.system import RollingSystem, State
from .finding import Relative
from .modes import Mode, Reduced

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .sweep import Sweep


@dataclass(frozen=True, repr=False)
class SteadyMotion(Serializable):
    """A motion in which all that matters stays as it is, and how it answers a nudge.

    Parameters
    ----------
    system : RollingSystem
        Body, support and loads.
    state : State
        One instant of it: a start for `trundle.simulate`.
    kind : str
        "rest", "turns on the spot", "rolls straight", "circles" or "winds along the axis".
    turning : float
        About the support's axis, of all that can be seen, rad/s.
    drift : tuple of 3 floats
        Velocity along which all is shifted where it does not turn, else along the axis, support frame, m/s.
    own_turn : tuple of 3 floats
        Turn of the body within its own symmetry, body frame, rad/s.
    quantities : dict of str to float
        SI; those of "speed", "spin", "lean", "turning", "distance" and "rate" that it has.
    normal_force, friction_force : float
        N and |f|, N.
    modes : tuple of Mode
        Of the linear law, symmetry and family divided out, the fastest growing first.
    verdict : str
        "stable", "stable to first order", "unstable" or "neutral".
    dimension : int
        Of the family of steady motions that it belongs to; place, direction and phase not counted.
    residual : float
        How far its rates are from those of a symmetry, as a share of their scale.
    frame : str
        In which the frequencies are counted: "inertial" or "turning with the support".
    """

    system: RollingSystem
    state: State
    kind: str
    turning: float
    drift: tuple[float, float, float]
    own_turn: tuple[float, float, float]
    quantities: dict[str, float]
    normal_force: float
    friction_force: float
    modes: tuple[Mode, ...]
    verdict: str
    dimension: int
    residual: float
    frame: str
    relative: Relative = field(repr=False, compare=False)
    reduced: Reduced = field(repr=False, compare=False)

    @property
    def friction_needed(self) -> float:
        """The least coefficient of friction that lets it roll, |f|/N."""
        if self.normal_force > 0:
            return self.friction_force / self.normal_force
        return 0.0 if self.friction_force == 0 else math.inf

    @property
    def holds(self) -> bool | None:
        """Whether the support's friction suffices; None where the support has no coefficient."""
        friction = self.system.support.friction
        return None if friction is None else self.friction_needed <= float(friction)

    @property
    def stands(self) -> bool:
        """Whether the support has to push, not to pull."""
        return self.normal_force >= -1e-12 * math.hypot(self.normal_force, self.friction_force)

    @property
    def growth(self) -> float:
        """The fastest growth of a nudge, 1/s; 0 where none grows."""
        return max((mode.growth for mode in self.modes if mode.growth > 0), default=0.0)

    @property
    def frequencies(self) -> tuple[float, ...]:
        """Of the modes that oscillate, rad/s, the slowest first."""
        return tuple(sorted(mode.frequency for mode in self.modes if mode.frequency))

    @cached_property
    def checked(self) -> float:
        """How far nudged runs of the system are from the linear law, as a share; they know nothing of it."""
        from .runs import check

        return check(self.relative, self.reduced)

    def along(self, name: str, lowest: Any = None, highest: Any = None, *, holding: Any = (), count: int = 41) -> Sweep:
        """Follow the family while one quantity changes, and find where stability begins and ends.

        Parameters
        ----------
        name : str
            "speed", "spin", "lean", "turning" or "distance"; or "rate", of a turning support.
        lowest, highest : float or quantity, optional
            Between which; absent: from nearly nothing to twice what it is.
        holding : sequence of str
            What stays as it is meanwhile.
        count : int
            How many values.

        Returns
        -------
        Sweep
            Growth and frequencies against the quantity, and the limits of stability.

        Examples
        --------
        >>> import trundle as tr
        >>> ball, inside = tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5))
        >>> system = tr.RollingSystem(ball, inside)
        >>> (level,) = tr.steady_motions(system, system.place(velocity=(3.0, 0.0)))
        >>> level.along("speed", count=5).limits
        ()
        """
        from .sweep import follow

        return follow(self, name, lowest, highest, holding, count)

    def __str__(self) -> str:
        from .words import report_one

        return report_one(self)

    def _headline(self) -> Headline:
        return Headline("", f"{self.kind}, {self.verdict}")

    def _parts(self) -> Iterator[Markup]:
        from .words import record_of

        yield pairs(record_of(self).items())

    def as_dict(self) -> dict[str, Any]:
        """Return everything in SI units and plain types, for JSON."""
        needed = self.friction_needed
        return {
            "kind": self.kind,
            "verdict": self.verdict,
            "quantities": self.quantities,
            "turning": self.turning,
            "drift": self.drift,
            "own_turn": self.own_turn,
            "state": {
                "position": self.state.position,
                "velocity": self.state.velocity,
                "angular_velocity": self.state.angular_velocity,
                "orientation": self.state.orientation,
            },
            "normal_force": self.normal_force,
            "friction_force": self.friction_force,
            "friction_needed": needed if math.isfinite(needed) else None,
            "holds": self.holds,
            "modes": [{"kind": one.kind, "frequency": one.frequency, "growth": one.growth} for one in self.modes],
            "family": self.dimension,
            "frame": self.frame,
            "residual": self.residual,
            "nudged_runs_differ": self.checked,
        }


@dataclass(frozen=True, repr=False)
class SteadyMotions(Plottable, Serializable):
    """The steady motions found, the nearest to the start first; a sequence.

    Parameters
    ----------
    system : RollingSystem
        Body, support and loads.
    start : State
        Where the search began.
    found : tuple of SteadyMotion
        Those that the support can hold by pushing.
    pulled : int
        How many more there would be if the support could pull.
    searched : str
        What was searched.
    reason : str
        Where there are none: why.
    moved : float
        From the start to the first, in units of the body's size, 1 rad and the scale of its rates.
    title : str
        For text and figure.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> tr.steady_motions(system, system.place(velocity=(1.0, 0.0)))[0].kind
    'rolls straight'
    """

    system: RollingSystem
    start: State
    found: tuple[SteadyMotion, ...]
    pulled: int
    searched: str
    reason: str = ""
    moved: float = 0.0
    title: str = ""

    def __iter__(self) -> Iterator[SteadyMotion]:
        return iter(self.found)

    def __len__(self) -> int:
        return len(self.found)

    def __getitem__(self, index: int) -> SteadyMotion:
        return self.found[index]

    def __str__(self) -> str:
        from .words import report

        return report(self)

    def _headline(self) -> Headline:
        from .words import count_of

        return Headline(self.title, count_of(self))

    def _parts(self) -> Iterator[Markup]:
        from .words import record_of, remarks

        yield records([{"motion": f"{one.kind}, {one.verdict}", **record_of(one)} for one in self.found])
        yield paragraph("\n".join(remarks(self)))

    def as_dict(self) -> dict[str, Any]:
        """Return everything in SI units and plain types, for JSON.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.steady_motions(tr.Scenario.load("ball-in-a-trough")).as_dict()["steady_motions"][0]["verdict"]
        'stable to first order'
        """
        return {
            "title": self.title,
            "steady_motions": [one.as_dict() for one in self.found],
            "would_need_pull": self.pulled,
            "moved_from_start": self.moved,
            "searched": self.searched,
            "reason": self.reason,
        }

    def plot(self, along: str | None = None, lowest: Any = None, highest: Any = None) -> Figure:
        """Draw frequencies and growth of the first against the quantity that decides.

        Parameters
        ----------
        along : str, optional
            As for `SteadyMotion.along`; absent: the rate of a turning support, else the speed, else the spin.
        lowest, highest : float or quantity, optional
            Between which.

        Returns
        -------
        matplotlib.figure.Figure
            Needs neither a display nor pyplot.
        """
        from .sweep import deciding

        one = self.found[0]
        return one.along(along or deciding(one), lowest, highest).plot(self.title)
