"""What is returned of a Poincaré section: the states as a labelled dataset, how well they are located, a figure."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Plottable, Serializable, number, pairs
from ...errors import UnknownNameError
from ...mechanics.system import RollingSystem
from ...solve.samples import Array
from .conditions import quantities, quantity_of

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

LOCATED = 1e-12  # of the largest value of the function: what is left of it where it passes zero


@dataclass(frozen=True, repr=False)
class PoincareSection(Plottable, Serializable):
    """The states of a motion where a condition holds.

    The variables of `data` are those of `Trajectory.data`, at the instants of the crossings, and `residual`, what is
    left of the function there, as a share of its largest value.

    Parameters
    ----------
    title : str
        Of the scenario; empty where there is none.
    condition : str
        What was asked for.
    system : RollingSystem
        What moves.
    duration : float
        How long the motion was followed, s.
    ended : str
        What ended it before the time that was asked for; empty where nothing did.
    jumps : int
        How many times the function only jumped across zero, at an event; these are no crossings.
    data : xarray.Dataset
        Over `time`.

    Examples
    --------
    A ball that swings in a trough passes its bottom once each way in a period:

    >>> import trundle as tr
    >>> trough = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    >>> swing = trough.place(position=(0.001, 0.0))
    >>> found = tr.poincare_section(trough, "position.y falling through 0", swing, "10 s")
    >>> found.count, found.located
    (7, True)
    """

    title: str
    condition: str
    system: RollingSystem
    duration: float
    ended: str
    jumps: int
    data: xarray.Dataset = field(compare=False)

    @property
    def count(self) -> int:
        """How many crossings there are."""
        return int(self.data.time.size)

    @property
    def located(self) -> bool:
        """Whether all of them are found to 1e-12."""
        return bool((self.data.residual.values <= LOCATED).all())

    @property
    def intervals(self) -> Array:
        """The times between one crossing and the next, s."""
        return np.diff(self.data.time.values)

    def __str__(self) -> str:
        lines = [self.title] if self.title else []
        return "\n".join([*lines, self._words, *(f"{name}: {fact}" for name, fact in self._facts)])

    @property
    def _words(self) -> str:
        return f"{self.count} crossing{'s' * (self.count != 1)}: {self.condition}"

    @property
    def _facts(self) -> list[tuple[str, str]]:
        followed = f"{self.duration:.6g} s" + (f": {self.ended}" if self.ended else "")
        facts = [("followed", followed)]
        if self.count:
            facts.append(("located to", f"{float(self.data.residual.max()):.1e}"))
        if self.count > 1:
            facts.append(("time between", f"{self.intervals.min():.6g} s to {self.intervals.max():.6g} s"))
        if self.jumps:
            facts.append(("not counted", f"{self.jumps} jumps across the section at events"))
        return facts

    def _headline(self) -> Headline:
        return Headline(self.title, self._words, None if self.located else False)

    def _parts(self) -> Iterator[Markup]:
        yield pairs([("crossings", number(self.count)), *self._facts])

    def values(self, name: str) -> Array:
        """Return a scalar quantity at each crossing.

        Parameters
        ----------
        name : str
            Such as "position.x" or "angular_velocity.z".

        Returns
        -------
        array (n,)
            In SI units.

        Examples
        --------
        >>> import trundle as tr
        >>> bowl = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
        >>> start = bowl.place(position=(0.2, 0.0), velocity=(0.0, 0.6))
        >>> found = tr.poincare_section(bowl, "position.y rising through 0", start, "5 s")
        >>> bool((found.values("velocity.y") > 0).all())
        True
        """
        return quantity_of(self.system, name)[0](self.data)

    def plot(self, x: str | None = None, y: str | None = None) -> Figure:
        """Draw two quantities against each other, a point for each crossing.

        Parameters
        ----------
        x, y : str, optional
            Their names, such as "position.x"; absent: a coordinate and its velocity, those that vary most.

        Returns
        -------
        matplotlib.figure.Figure
            Needs neither a display nor pyplot.

        Examples
        --------
        >>> import trundle as tr
        >>> bowl = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
        >>> start = bowl.place(position=(0.2, 0.0), velocity=(0.0, 0.6))
        >>> figure = tr.poincare_section(bowl, "position.y rising through 0", start, "5 s").plot()
        >>> figure.axes[0].get_xlabel()
        'centre of mass, x, m'
        """
        from matplotlib.figure import Figure

        from ...views.plots.sheet import BLUE

        known = quantities(self.system)
        if x is None:
            spread = {part: float(np.ptp(self.values(f"position.{part}"))) if self.count else 0.0 for part in "xyz"}
            x = f"position.{max(spread, key=lambda part: spread[part])}"
        if y is None:
            y = f"velocity.{x[-1]}" if x.startswith("position.") else "velocity.x"
        for name in (x, y):
            if name not in known:
                raise UnknownNameError("quantity", name, known)
        figure = Figure(figsize=(6.0, 5.0), layout="constrained")
        panel = figure.subplots()
        panel.plot(self.values(x), self.values(y), ".", markersize=3 if self.count > 200 else 6, color=BLUE)
        for name, label in ((x, panel.set_xlabel), (y, panel.set_ylabel)):
            unit, said = known[name]
            label(f"{said}, {_written(unit)}")
        panel.set_title(self.condition, fontsize=10, loc="left")
        figure.suptitle(self.title, fontsize=11)
        return figure

    def as_dict(self) -> dict[str, Any]:
        """Return what is said of the section, and the instants, in SI units.

        Examples
        --------
        >>> import trundle as tr
        >>> bowl = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
        >>> start = bowl.place(position=(0.2, 0.0), velocity=(0.0, 0.6))
        >>> tr.poincare_section(bowl, "position.y rising through 0", start, "5 s").as_dict()["jumps"]
        0
        """
        return {
            "title": self.title,
            "condition": self.condition,
            "crossings": self.data.time.values.tolist(),
            "located": self.located,
            "duration": self.duration,
            "ended": self.ended,
            "jumps": self.jumps,
        }


def _written(unit: str) -> str:
    return {"m s-1": "m/s", "rad s-1": "rad/s"}.get(unit, unit)
