"""The sensitivity table: which shortcoming matters most, on the screen, as JSON and as a picture."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from trundle.wording import with_unit

from ...display import Headline, Markup, Plottable, Serializable, paragraph, table
from .rows import HEADINGS, Row, clock

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class Sensitivity(Plottable, Serializable):
    """What each shortcoming alone does to a demonstration, the worst first.

    Parameters
    ----------
    title : str
        Of the scenario.
    rim, horizon, round_time, radius, offset : float
        Distance of the rim from the axis, m; how long was waited, s; of the perfect circle: time of a round, s, radius
        and distance of its centre from the axis, m.
    rows : tuple of Row
        One for each shortcoming, ranked.
    given : Row
        The scenario as it is, with all that it has.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.sensitivity("level-turntable-nudged", tilt="0.2 deg", horizon="60 s")
    >>> print(table.rows[0].label, table.rows[0].size_text, table.rows[0].outcome, sep=", ")
    table not level, 0.2°, leaves after 18.9 s
    >>> table["wobble"].leaves is None
    True
    """

    title: str
    rim: float
    horizon: float
    round_time: float
    radius: float
    offset: float
    rows: tuple[Row, ...]
    given: Row

    def __getitem__(self, name: str) -> Row:
        """Return the row of a shortcoming by its name."""
        from ...errors import UnknownNameError

        for row in (*self.rows, self.given):
            if row.name == name:
                return row
        raise UnknownNameError("row of the table", str(name), [row.name for row in (*self.rows, self.given)])

    @property
    def heading(self) -> str:
        """What was done, in a line."""
        where = with_unit(self.offset, "length") if self.offset > 1e-9 * self.rim else "0 cm"
        over = "; over the rim even where all is perfect" if self.radius + self.offset >= self.rim else ""
        return (
            f"a circle of {with_unit(self.radius, 'length')} in {clock(self.round_time)}, its centre {where} from the "
            f"axis; rim at {with_unit(self.rim, 'length')}; watched for {clock(self.horizon)}{over}"
        )

    @property
    def cells(self) -> list[tuple[str, ...]]:
        """The table as text, a tuple for each row in the order of the headings."""
        ranked = [*((str(i), row) for i, row in enumerate(self.rows, 1)), ("–", self.given)]
        return [(f"{rank}  {row.cells[0]}", *row.cells[1:]) for rank, row in ranked]

    def __str__(self) -> str:
        table = [HEADINGS, *self.cells]
        widths = [max(len(line[i]) for line in table) for i in range(len(HEADINGS))]
        lines = ["  ".join(f"{cell:<{width}}" for cell, width in zip(line, widths, strict=True)) for line in table]
        return "\n".join([self.title, self.heading, *(line.rstrip() for line in lines)])

    def _headline(self) -> Headline:
        return Headline(self.title, f"worst: {self.rows[0].label}, {self.rows[0].outcome}" if self.rows else "")

    def _parts(self) -> Iterator[Markup]:
        yield paragraph(self.heading)
        yield table(self.cells, HEADINGS)

    def as_dict(self) -> dict[str, Any]:
        """Return the table in SI units."""
        return {
            "title": self.title,
            "rim": self.rim,
            "horizon": self.horizon,
            "round_time": self.round_time,
            "circle_radius": self.radius,
            "circle_offset": self.offset,
            "rows": [row.as_dict() for row in self.rows],
            "as_given": self.given.as_dict(),
        }

    def as_json(self) -> str:
        """Return the table as JSON, in SI units.

        Returns
        -------
        str
            Times in s, lengths in m, rates in m/s.

        Examples
        --------
        >>> import json
        >>> import trundle as tr
        >>> table = tr.sensitivity("level-turntable-nudged", horizon="30 s")
        >>> json.loads(table.as_json())["rim"]
        0.5
        """
        return json.dumps(self.as_dict(), indent=2, ensure_ascii=False)

    def plot(self) -> Figure:
        """Draw the path under each shortcoming, and when the ball leaves.

        Examples
        --------
        >>> import trundle as tr
        >>> len(tr.sensitivity("level-turntable-nudged", horizon="30 s").plot().axes) > 5
        True
        """
        from .figure import draw

        return draw(self)
