"""Text as rows of cells: encoding, separator, decimal sign, lines above the numbers, and rows that do not fit."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InvalidValueError
from .table import Rejected

MISSING = ("", "nan", "na", "n/a", "null", "none", "-", "--", "#n/a")  # what programs write where they have no number
CELL = "\x1f"  # between cells that come apart already: from a spreadsheet, or from quotes
DECIMALS = {"point": ".", "comma": ","}
_NOTE = re.compile(r"#(?!\d|\s*[,;\t]|\s*$|N/A|DIV/0|VALUE|REF|NUM|NAME).*")
_SPELLINGS = sorted({way(word) for word in MISSING for way in (str, str.upper, str.capitalize)} | {"NaN", "N/A"})
_SEPARATORS: tuple[str | None, ...] = ("\t", ";", ",", None)  # None: any white space
_LOOKED_AT = 200  # lines, in which separator and headings are looked for
_MOSTLY = 0.5  # of the cells in a row, that are numbers
_FEW = 20  # times as many cells with the other decimal sign make one with this a slip
_PLAIN, _GROUPED = r"(\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d+)?", r"\d{1,3}((,\d{3})+(\.\d*)?|(\.\d{3})+(,\d*)?)"
_NUMBER = re.compile(rf"[+-]?({_PLAIN}|{_GROUPED}|inf(inity)?)", re.IGNORECASE)
_BOM = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16", b"\xef\xbb": "utf-8-sig"}


def decoded(content: bytes, name: str) -> str:
    r"""Return the text of a file in UTF-8, UTF-16, or an old code of Windows.

    Examples
    --------
    >>> decoded("t\tθ".encode("utf-16"), "a.txt"), decoded(b"t;\xb5m", "a.txt")
    ('t\tθ', 't;µm')
    """
    zeros = [content[i:2000:2].count(0) for i in (0, 1)]
    half = len(content[:2000]) // 4
    wide = "utf-16-be" if zeros[0] > half > zeros[1] else "utf-16-le" if zeros[1] > half > zeros[0] else "utf-8"
    for encoding in (_BOM.get(content[:2], wide), "cp1252"):
        try:
            text = content.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" in text:
            break
        return text.removeprefix("\ufeff")
    raise InvalidValueError("file", "must be text", name, "It holds bytes that are no letters: is it of another kind?")


def is_number(cell: str) -> bool:
    """Tell whether a cell holds a number, with a point or a comma."""
    return _NUMBER.fullmatch(cell.strip()) is not None


def is_missing(cell: str) -> bool:
    """Tell whether a cell says that there is no number."""
    return cell.strip().lower() in MISSING


@dataclass(frozen=True)
class Grid:
    r"""Lines of a text that is a table.

    Examples
    --------
    >>> grid = grid_of("t;x\n0,0;1,5\n0,1;1,6\n")
    >>> grid.names, grid.decimal, [cells.tolist() for cells in grid.cells(2)[0]]
    (['t', 'x'], ',', [[0.0, 0.1], [1.5, 1.6]])
    """

    # the lines above the first row of numbers that are not empty, with their numbers: names, units
    head: tuple[tuple[int, tuple[str, ...]], ...]
    rows: Sequence[str]  # the lines from there on
    lines: Sequence[int]  # their numbers
    separator: str | None  # between cells; None: white space
    decimal: str  # "." or ","
    notes: tuple[str, ...] = ()  # lines that begin with #
    # whether somebody said which sign is the decimal one: the other may then stand between thousands
    asked: bool = False
    counted: str = "line"  # what the numbers of lines count

    @property
    def names(self) -> list[str]:
        """The cells of the last line above the numbers, without empty ones at the end."""
        return trimmed(self.head[-1][1]) if self.head else []

    @property
    def width(self) -> int:
        """How many cells the first row has."""
        return len(trimmed(_split(self.rows[0], self.separator))) if self.rows else 0

    @property
    def remarks(self) -> tuple[str, ...]:
        """What there is to say of how the cells are written."""
        return ("decimal comma",) if self.decimal == "," else ()

    def cells(self, width: int) -> tuple[list[Any], Any, tuple[Rejected, ...]]:
        """Return the columns, the numbers of their lines, and the rows that have more or fewer cells than headings."""
        rows, separator, lines = list(self.rows), self.separator, np.asarray(self.lines, dtype=int)
        if separator is None:
            rows, separator = ["\t".join(row.split()) for row in rows], "\t"
        counts = np.array([row.count(separator) for row in rows], dtype=int) + 1
        rejected = []
        for i in np.flatnonzero(counts != width):
            cells = rows[i].split(separator)
            found = len(cells[:width] + trimmed(cells[width:]))
            if found == width:  # no more than a separator at the end
                rows[i], counts[i] = separator.join(cells[:width]), width
            else:
                rejected.append(self._ragged(lines[i], found, width))
        kept = np.flatnonzero(counts == width)
        rows = rows if kept.size == len(rows) else [rows[i] for i in kept]
        return self._columns(rows, width, separator), lines[kept], tuple(rejected)

    def _ragged(self, line: int, found: int, width: int) -> Rejected:
        rule = f"must have a cell for each of its {width} headings in every {self.counted}"
        remedy = "Is a heading missing, or part of the line?"
        if self.separator == "," and found == 2 * width:
            remedy = "Are these decimal commas? Separate the cells by semicolons or tabs."
        error = InvalidValueError("file", rule, f"{found} in {self.counted} {line}", remedy)
        return Rejected(int(line), f"{found} cells for {width} headings", error)

    def _columns(self, rows: Sequence[str], width: int, separator: str) -> list[Any]:
        if not rows:
            return [np.empty(0) for _ in range(width)]
        import pandas as pd

        frame = pd.read_csv(
            io.StringIO("\n".join(rows)),
            sep=separator,
            header=None,
            names=range(width),
            usecols=range(width),
            index_col=False,
            decimal=self.decimal,
            na_values=_SPELLINGS,
            keep_default_na=False,
            skipinitialspace=True,
            skip_blank_lines=False,
            quoting=csv.QUOTE_NONE,
            low_memory=False,
        )
        return [self._column(frame[i]) for i in range(width)]

    def _column(self, column: Any) -> Any:
        if column.dtype.kind in "iuf":
            return column.to_numpy(dtype=float)
        thousands = {".": r"(?<=\d),(?=\d{3}(?:\D|$))", ",": r"(?<=\d)\.(?=\d{3}(?:\D|$))"}[self.decimal]
        cells = ["" if cell != cell else str(cell).strip() for cell in column.astype(object)]  # NaN
        if self.asked:
            cells = [re.sub(thousands, "", cell) if is_number(cell) else cell for cell in cells]
        if self.decimal == ",":
            cells = [cell.replace(",", ".") if "." not in cell else f"{cell} with a point" for cell in cells]
        try:
            return np.array([np.nan if is_missing(cell) else float(cell) for cell in cells])
        except ValueError:
            return np.array(cells, dtype=object)


def grid_of(text: str, decimal: str | None = None) -> Grid:
    r"""Take a text apart into lines of cells.

    Examples
    --------
    >>> grid_of("mass_A\t\t\nt\tx\ty\n0.0\t1.0\t2.0").head
    ((1, ('mass_A', '', '')), (2, ('t', 'x', 'y')))
    """
    raw = text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\x1a").split("\n")
    notes: tuple[str, ...] = ()
    if "#" in text:
        notes = tuple(line for line in raw if line.lstrip().startswith("#"))
        raw = [_without_note(line) for line in raw]
    lines = [i for i, row in enumerate(raw, 1) if row and not row.isspace()]
    return _grid([raw[i - 1] for i in lines], lines, decimal, notes)


def grid_of_cells(cells: Sequence[Sequence[Any]], decimal: str | None = None) -> Grid:
    """Take the rows of a spreadsheet for lines of text.

    Examples
    --------
    >>> grid_of_cells([["t", "x"], [0.0, 0.5], [0.1, None]]).cells(2)[0][1].tolist()
    [0.5, nan]
    """
    written = [["" if cell is None else str(cell).translate(_TIDY) for cell in row] for row in cells]
    width = max(map(len, written), default=0)
    rows = [
        CELL.join([*row, *[""] * (width - len(row))]) for row in written
    ]  # a sheet leaves out empty cells at the end
    lines = [i for i, row in enumerate(rows, 1) if row.strip(CELL).strip()]
    return _grid([rows[i - 1] for i in lines], lines, decimal, (), CELL, "row")


_TIDY = str.maketrans({"\n": " ", "\r": " ", CELL: " "})


def _grid(
    rows: list[str],
    lines: list[int],
    decimal: str | None,
    notes: tuple[str, ...],
    separator: str | None = "",
    counted: str = "line",
) -> Grid:
    if separator == "":
        separator = _separator(rows[:_LOOKED_AT])
        if separator is not None and any('"' in row for row in rows):
            rows, separator = [_unquoted(row, separator) for row in rows], CELL
    blank = f"{separator or ''} \t"
    if not all(row.strip(blank) for row in rows):  # separators and nothing between them
        kept = [i for i, row in enumerate(rows) if row.strip(blank)]
        rows, lines = [rows[i] for i in kept], [lines[i] for i in kept]
    cells = [_split(row, separator) for row in rows[:_LOOKED_AT]]
    first = _first_row(cells)
    head = tuple((lines[i], tuple(cell.strip().strip('"') for cell in cells[i])) for i in range(first))
    body = rows[first:]
    sign = DECIMALS[decimal] if decimal else _decimal(body) if separator != "," else "."
    return Grid(head, body, lines[first:], separator, sign, notes, decimal is not None, counted)


def _unquoted(row: str, separator: str) -> str:
    """Return a row without its quotes, with another sign between the cells."""
    if '"' not in row:
        return row.replace(separator, CELL)
    try:
        return CELL.join(next(csv.reader([row], delimiter=separator)))
    except csv.Error:  # a cell beyond 131 072 letters
        return row.replace(separator, CELL)


def _without_note(line: str) -> str:
    """Return a line without what stands behind a #, which in "Run #2" and "#N/A" begins no note."""
    return "" if line.lstrip().startswith("#") else _NOTE.sub("", line)


def _split(row: str, separator: str | None) -> list[str]:
    return row.split() if separator is None else row.split(separator)


def trimmed(cells: Sequence[str]) -> list[str]:
    """Return the cells without empty ones at the end, which a separator at the end of a line makes."""
    kept = list(cells)
    while kept and not kept[-1].strip():
        kept.pop()
    return kept


def numeric_share(cells: Sequence[str]) -> float:
    """Return which share of the cells with something in them are numbers.

    Examples
    --------
    >>> numeric_share(["0.1", "2", "", "good"]), numeric_share(["", ""])
    (0.6666666666666666, 0.0)
    """
    written = [bare for cell in cells if not is_missing(bare := cell.strip().strip('"'))]
    return sum(map(is_number, written)) / len(written) if written else 0.0


def _first_row(rows: Sequence[Sequence[str]]) -> int:
    """Return where the numbers begin: at a row of mostly numbers that another follows, so that no heading is one."""
    numeric = [numeric_share(row) >= _MOSTLY for row in rows]
    follows = [*numeric[1:], True][: len(rows)]
    return next((i for i, (one, after) in enumerate(zip(numeric, follows, strict=True)) if one and after), len(rows))


def _separator(rows: Sequence[str]) -> str | None:
    """Return the sign between cells: the one by which the lines become rows of most numbers."""

    def numbers(separator: str | None) -> float:
        shares = (numeric_share(cells) for row in rows if len(cells := _split(row, separator)) > 1)
        return sum(share for share in shares if share >= _MOSTLY)

    best = max(_SEPARATORS, key=numbers)  # the first of equals
    if numbers(best):
        return best
    return next((sign for sign in _SEPARATORS if sign is not None and rows and sign in rows[0]), None)


_COMMA, _POINT = re.compile(r"\d,\d"), re.compile(r"\d\.")
_SURELY = re.compile(r"(?<![\d.,])0,\d|,\d{1,2}(?![\d,.])|,\d{4}|,\d+[eE]|(?<![\d.,]),\d")


def _decimal(rows: Sequence[str]) -> str:
    """Return the decimal sign of cells that no comma parts, or ask where nobody can know."""
    if not any("," in row for row in rows):
        return "."
    text = "\n".join(rows)
    if "." not in text and _SURELY.search(text):
        return ","
    commas, points = len(_COMMA.findall(text)), len(_POINT.findall(text))
    if not commas or points > _FEW * commas:
        return "."
    if _SURELY.search(text) and commas > _FEW * points:
        return ","
    found = next(_COMMA.finditer(text))
    around = re.split(r"[^\d.,eE+-]", text[max(found.start() - 12, 0) : found.end() + 12])
    shown = next((cell for cell in around if _COMMA.search(cell)), "a comma")
    rule = "must be known: a comma may be the decimal sign, or stand between thousands"
    raise InvalidValueError("decimal", rule, shown, "Say which sign it is: --decimal comma, or --decimal point.")
