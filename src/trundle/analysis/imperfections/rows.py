"""One line of a sensitivity table: a shortcoming, what came of it, and what theory says."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from trundle.wording import short, with_unit

from ...display import Headline, Markup, Serializable, pairs
from ...simulation.trajectory import Trajectory
from .measuring import CircleMotion

HEADINGS = ("shortcoming", "size", "the ball", "its circle", "theory")
LEAST = 1e-5 / 60  # m/s: a circle that moves by less than a hundredth of a millimetre in a minute


@dataclass(frozen=True, repr=False)
class Row(Serializable):
    """A demonstration with one shortcoming.

    Parameters
    ----------
    name : str
        "tilt", "still-air", "turning-air", "rolling-resistance", "wobble", "uneven-rate"; or "as-given" for the
        scenario as it is.
    label : str
        What it is, for the reader.
    size : float or None
        In SI: rad, kg/s, m, or a share.
    size_text : str
        The size with its unit.
    own : bool
        Whether the size is the scenario's own.
    leaves : float or None
        When the ball ran off the rim, s after the start; None where it stayed.
    motion : CircleMotion or None
        How its circle moved; None where it left within two rounds.
    run : Trajectory
        The motion itself.
    theory_leaves : float or None
        From when on theory lets the ball reach the rim, s; infinite where not within the horizon, None where there
        is no formula.
    theory_motion : CircleMotion or None
        How theory moves the circle over the same time.
    theory : str
        What theory says, in words.

    Examples
    --------
    See `Sensitivity`.
    """

    name: str
    label: str
    size: float | None
    size_text: str
    own: bool
    leaves: float | None
    motion: CircleMotion | None
    run: Trajectory = field(compare=False, repr=False)
    theory_leaves: float | None = None
    theory_motion: CircleMotion | None = None
    theory: str = ""

    @property
    def rank(self) -> tuple[float, float]:
        """What rows are sorted by: those that leave first, then those whose circle changes most."""
        if self.leaves is not None:
            return self.leaves, 0.0
        return math.inf, -self.motion.size if self.motion else 0.0

    @property
    def outcome(self) -> str:
        """When the ball left, or that it stayed, or stopped rolling while it still spun, where the run ends."""
        if self.leaves is not None:
            return f"leaves after {clock(self.leaves)}"
        times, last = self.run.data.time.values, self.run.events[-1:]
        return f"stops after {clock(times[-1] - times[0])}" if last and last[0].kind == "spot" else "stays"

    @property
    def moved(self) -> str:
        """How the circle moved, for the reader."""
        if self.motion is None:
            return "–"
        return f"centre {per_minute(self.motion.centre_rate)}, radius {per_minute(self.motion.radius_rate, sign=True)}"

    @property
    def expected(self) -> str:
        """What theory says, for the reader."""
        if self.theory_leaves is None or not 0 < self.theory_leaves < math.inf:
            return self.theory
        return f"from {clock(self.theory_leaves)}: {self.theory}"

    @property
    def cells(self) -> tuple[str, ...]:
        """The row as text, in the order of the headings of the table."""
        size = self.size_text and self.size_text + " (its own)" * self.own
        return self.label, size, self.outcome, self.moved, self.expected

    def _headline(self) -> Headline:
        return Headline(" ".join(filter(None, (self.label, self.size_text))), self.outcome)

    def _parts(self) -> Iterator[Markup]:
        yield pairs(list(zip(HEADINGS, self.cells, strict=True))[2:])

    def as_dict(self) -> dict[str, Any]:
        """Return the row in SI units, as JSON takes it."""
        finite = self.theory_leaves is not None and math.isfinite(self.theory_leaves)
        return {
            "name": self.name,
            "label": self.label,
            "size": self.size,
            "size_text": self.size_text,
            "size_is_the_scenarios": self.own,
            "leaves": self.leaves,
            **_rates("", self.motion),
            "theory": self.theory,
            "theory_leaves": self.theory_leaves if finite else None,
            **_rates("theory_", self.theory_motion),
        }


def _rates(prefix: str, motion: CircleMotion | None) -> dict[str, float | None]:
    return {
        f"{prefix}centre_rate": motion.centre_rate if motion else None,
        f"{prefix}radius_rate": motion.radius_rate if motion else None,
    }


def clock(time: float) -> str:
    """Write a time in the unit that suits it.

    Examples
    --------
    >>> clock(114.43), clock(3312.0)
    ('114 s', '55.2 min')
    """
    return with_unit(time, "time")


def per_minute(rate: float, sign: bool = False) -> str:
    """Write a rate in millimetres a minute.

    Examples
    --------
    >>> per_minute(0.01227), per_minute(-1e-5, sign=True), per_minute(1e-12)
    ('736 mm/min', '−0.6 mm/min', '0')
    """
    if abs(rate) < LEAST:
        return "0"
    return f"{'+' if sign and rate > 0 else ''}{short(rate * 6e4, 3 if abs(rate) > 1e-3 else 2)} mm/min"
