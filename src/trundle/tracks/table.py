"""A track as its file has it: columns under their headings, before names and units are settled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..errors import InvalidValueError

NOT_USED = "-"  # in place of one of trundle's names, for a column that a format knows to be something else


@dataclass(frozen=True)
class Column:
    """One column of a file.

    Parameters
    ----------
    heading : str
        As it stands in the file.
    cells : array (n,)
        Numbers, or objects where some cells are no numbers.
    unit : str
        Where the format says it, and the heading does not.
    known : str, optional
        Trundle's name for it, where the format says so; `NOT_USED` for what is no column of trundle's. None: the
        heading tells.

    Examples
    --------
    >>> Column("X (m)", [0.0, 1.0]).known is None
    True
    """

    heading: str
    cells: Any
    unit: str = ""
    known: str | None = None


@dataclass(frozen=True)
class Rejected:
    """A row of a file that was not taken.

    Parameters
    ----------
    row : int
        Its number: of the line in a text, of the row in a table, of the frame in a film.
    reason : str
        Why.
    error : InvalidValueError, optional
        What to raise if no row may be wrong; None where the row is only empty.

    Examples
    --------
    >>> print(Rejected(12, "'abc' is no number"))
    12: 'abc' is no number
    """

    row: int
    reason: str
    error: InvalidValueError | None = field(default=None, compare=False, repr=False)

    def __str__(self) -> str:
        return f"{self.row}: {self.reason}"


@dataclass(frozen=True)
class Table:
    """One track of a file.

    Parameters
    ----------
    columns : sequence of Column
        In the order of the file.
    name : str
        Of the track; empty where the file has one without a name.
    rows : sequence of int, or array of them
        The number of each row in the file; empty: counted from 1.
    counted : str
        What these numbers count: line, row or frame.
    remarks : tuple of str
        What belongs in the sentence that says how the file was read.
    rejected : tuple of Rejected
        Rows that are none.
    frame, axes : str
        Where the file says it: the frame of reference, and whether Ω is along the axes of space or of the body.
    y_down : bool, optional
        Whether y is counted downwards, as in pictures; None where nobody knows.
    rate : float, optional
        Frames a second, where the file says it.
    accuracy : float
        By how much all that is seen at one place may be off, where the file says it, m.

    Examples
    --------
    >>> Table([Column("t", [0.0, 0.1]), Column("x", [1.0, 2.0])], "mass A").name
    'mass A'
    """

    columns: Sequence[Column]
    name: str = ""
    rows: Any = ()
    counted: str = "row"
    remarks: tuple[str, ...] = ()
    rejected: tuple[Rejected, ...] = ()
    frame: str = ""
    axes: str = ""
    y_down: bool | None = None
    rate: float | None = None
    accuracy: float = 0.0

    @classmethod
    def of(cls, columns: Mapping[str, Any], **known: Any) -> Table:
        """Return a table of arrays by their headings.

        Examples
        --------
        >>> [column.heading for column in Table.of({"t": [0.0], "x": [1.0]}).columns]
        ['t', 'x']
        """
        return cls([Column(heading, cells) for heading, cells in columns.items()], **known)
