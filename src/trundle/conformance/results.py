"""Rows of a score, what they come to for each engine and case, and their file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..display import Displayed, Headline, Markup, table
from ..errors import RunFileError
from ..files import read_netcdf
from .answers import CANNOT as CANNOT_OUTCOME
from .measuring import (
    ASTRAY,
    CANNOT,
    CONVERGES,
    DIVERGES,
    EXACT,
    FLOAT_FLOOR,
    NOT_RUN,
    PLATEAUS,
    SILENT_LIMIT,
    classify,
    order,
)

if TYPE_CHECKING:
    import xarray

_Key = tuple[str, str, str, str]
_HALF_A_TURN = 3.0  # rad: between samples an error of π is not met exactly
_CONFINED = 0.5, 2.0  # `Errors.reach` of what is as far off as it can be while it stays where it is
_LESS = 1 / 3  # of the error at the finest step: an ablation that leaves so little names the cause
_FORMAT = "trundle score 1"
_UNITS = {"step": "s", "angle": "rad", "seconds": "1", "limit": "rad/s"}
_SAID = {
    "position": "error of position over the path, the largest",
    "angle": "error of orientation, the largest",
    "turning": "error of orientation over the angle turned through, the largest",
    "slip": "error of the velocity of slipping over the speed that all kinetic energy would be, the largest",
    "reach": "error of position over the distance to which the path itself leads, the largest",
    "spin": "spin about the vertical at the end over the exact one, where the exact one has turned round",
    "energy": "error of the energy over the highest kinetic energy, the largest",
    "seconds": "processor time of the stepping for a second of the motion",
    "derivative": "relative error of the derivatives of the final state, the largest by any input",
    "friction": "error of the mean force of friction over that force",
    "own": "the larger error of position and turning from a body that is exact but for the mesh",
    "mesh": "that error of a body that is exact but for the mesh",
    "limit": "rate at which components of the angular velocity are cut off",
}


@dataclass(frozen=True)
class Row:
    """One run: an engine in a setting, on a case, at a step.

    Parameters
    ----------
    engine, version, setting, of, case : str
        What was run; `of` is the profile that an ablation differs from.
    step : float
        s.
    outcome, message : str
        "ok", or what came instead, and why.
    position, angle, turning, slip, energy : float
        See `Errors`; not a number where there is none.
    seconds : float
        Of a processor, for a second of the motion.
    limit : float
        Rate at which spins are cut off, rad/s; not a number where they are not.
    way : str
        How derivatives of the final state were taken; empty for the motion itself.
    derivative : float
        Their relative error, the largest by any input.
    friction, own, mesh, reach, spin : float
        See `Errors`.
    path : str
        The motion as an animation shows it; empty where there is none.
    """

    engine: str
    version: str
    setting: str
    of: str
    case: str
    step: float
    outcome: str
    message: str
    position: float
    angle: float
    turning: float
    slip: float
    energy: float
    seconds: float
    limit: float
    way: str = ""
    derivative: float = math.nan
    friction: float = math.nan
    own: float = math.nan
    mesh: float = math.nan
    path: str = ""
    reach: float = math.nan
    spin: float = math.nan

    @property
    def worst(self) -> float:
        """The error that classes go by: that of derivatives, or else `Errors.worst`."""
        if self.way:
            return self.derivative
        return max(self.position, self.turning) if math.isnan(self.own) else self.own

    @property
    def lost(self) -> bool:
        """Whether the error that classes go by is that of an orientation, and as large as it can become."""
        return not self.way and math.isnan(self.own) and self.angle > _HALF_A_TURN and self.turning > self.position

    @property
    def cell(self) -> tuple[str, str, str, str]:
        """What it has in common with the same at other steps."""
        return (self.engine, self.setting, self.case, self.way)

    @property
    def key(self) -> tuple[str, str, str, str, float]:
        """What tells it from others."""
        return (*self.cell, self.step)


class Cell(NamedTuple):
    """What the rows of one engine, setting and case come to."""

    engine: str
    setting: str
    case: str
    way: str  # to the derivatives; empty for the motion
    name: str  # its class
    order: float
    rows: tuple[Row, ...]  # the coarsest step first
    cause: str  # the ablation that takes a plateau away

    @property
    def label(self) -> str:
        """The setting, and the way to the derivatives."""
        return f"{self.setting}, {self.way}" if self.way else self.setting

    @property
    def finest(self) -> Row:
        """The run at the finest step that gave a number, or else the last."""
        return next((row for row in reversed(self.rows) if math.isfinite(row.worst)), self.rows[-1])


def _astray(rows: Sequence[Row]) -> bool:
    """Whether nothing is known of how errors fall: half a turn off at the two finest steps, and no more in position."""
    known = [row for row in rows if math.isfinite(row.worst)][-2:]
    if len(known) < 2 or not all(row.lost for row in known):
        return False
    coarse, fine = known
    least, most = _CONFINED
    return fine.position < coarse.position / 2 or all(least < row.reach < most for row in known)


def _recurs(limits: list[float]) -> bool:
    """Whether spins are cut off at the same value at several steps: a limit, not a chance."""
    return any(sum(math.isclose(limit, other, rel_tol=1e-5) for other in limits) > 1 for limit in limits)


@dataclass(frozen=True, repr=False)
class Score(Displayed):
    """What engines made of the cases.

    Parameters
    ----------
    rows : tuple of Row
        One a run.

    Examples
    --------
    >>> import trundle as tr
    >>> tr.conformance.Score(())
    <Score: 0 runs>
    """

    rows: tuple[Row, ...]

    def _headline(self) -> Headline:
        return Headline("", f"{len(self.rows)} runs")

    def _parts(self) -> Iterator[Markup]:
        yield table([list(row) for row in self._merged()], self.heads)

    heads = ("engine", "setting", "case", "class", "order", "error at each step", "cause")

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """What the rows of each engine, setting and case come to, ablations too."""
        groups: dict[_Key, list[Row]] = {}
        for row in self.rows:
            groups.setdefault(row.cell, []).append(row)
        ordered = {key: tuple(sorted(rows, key=lambda row: -row.step)) for key, rows in groups.items()}
        return tuple(self._cell(rows, ordered) for rows in ordered.values())

    @property
    def profiles(self) -> tuple[Cell, ...]:
        """The cells that are no ablations."""
        return tuple(cell for cell in self.cells if not cell.rows[0].of)

    @property
    def motions(self) -> tuple[Cell, ...]:
        """Those of the profiles that are of motions."""
        return tuple(cell for cell in self.profiles if not cell.way)

    @property
    def derivatives(self) -> tuple[Cell, ...]:
        """Those of the profiles that are of derivatives."""
        return tuple(cell for cell in self.profiles if cell.way)

    def _cell(self, rows: tuple[Row, ...], groups: dict[_Key, tuple[Row, ...]]) -> Cell:
        first = rows[0]
        errors = {row.step: row.worst for row in rows}
        name = classify(errors)
        if name not in (CONVERGES, EXACT) and _recurs([row.limit for row in rows if math.isfinite(row.limit)]):
            name = SILENT_LIMIT
        elif name in (PLATEAUS, DIVERGES) and _astray(rows):
            name = ASTRAY
        if all(row.outcome == CANNOT_OUTCOME for row in rows):
            name = CANNOT
        cause = ""
        if name in (PLATEAUS, DIVERGES, SILENT_LIMIT, ASTRAY):
            cause = self._cause(rows, groups)
        if cause.startswith("double precision"):
            name = FLOAT_FLOOR
        p = order(np.array([row.step for row in rows]), np.array([row.worst for row in rows]))
        return Cell(*first.cell, name, p, rows, cause)

    def _cause(self, rows: tuple[Row, ...], groups: dict[_Key, tuple[Row, ...]]) -> str:
        """Return the ablation of this setting that leaves least of the error, if it leaves little."""
        best, least = "", math.inf
        engine, profile, *same = rows[0].cell
        for (other_engine, setting, *other_same), others in groups.items():
            if (other_engine, other_same) != (engine, same) or others[0].of != profile:
                continue
            for mine, other in zip(reversed(rows), reversed(others), strict=False):
                if math.isfinite(other.worst) and mine.step == other.step:
                    share = other.worst / mine.worst if math.isfinite(mine.worst) and mine.worst > 0 else 0.0
                    enough = 1.0 if mine.lost and not other.lost else _LESS  # the error of one that is lost is larger
                    if share < min(enough, least):
                        best, least = setting, share
                    break
        return best

    def lines(self) -> Iterator[tuple[str, ...]]:
        """Yield the cells as words, in the order of `heads`."""
        for cell in self.profiles:
            shown = [f"{row.worst:.1e}" if row.outcome == "ok" else row.outcome for row in cell.rows]
            p = "" if math.isnan(cell.order) or cell.name == EXACT else f"{cell.order:.1f}"
            why = cell.cause or next((row.message for row in cell.rows if row.message), "")
            ran = any(row.outcome == "ok" for row in cell.rows)
            errors = ", ".join(shown if ran else dict.fromkeys(shown))
            yield (cell.engine, cell.label, cell.case, cell.name, p, errors, why)

    def _merged(self) -> Iterator[tuple[str, ...]]:
        """Yield `lines`, one for all cases of an engine of which nothing could be run."""
        lines = list(self.lines())
        for engine in dict.fromkeys(line[0] for line in lines):
            own = [line for line in lines if line[0] == engine]
            if len({line[3:] for line in own}) == 1 and own[0][3] == NOT_RUN and len(own) > 1:
                yield (engine, "", "all", *own[0][3:])
            else:
                yield from own

    def __str__(self) -> str:
        rows = [self.heads, *self._merged()]
        widths = [max(len(row[i]) for row in rows) for i in range(len(self.heads) - 1)]
        lines = (
            "  ".join([*(f"{c:<{w}}" for c, w in zip(row, widths, strict=False)), row[-1]]).rstrip() for row in rows
        )
        return "\n".join(lines)

    def with_rows_of(self, older: Score) -> Score:
        """Return these rows, and those of an older score that were not run again.

        Parameters
        ----------
        older : Score
            Of the same file.

        Returns
        -------
        Score
            Both.
        """
        again = {row.key for row in self.rows}
        return replace(self, rows=(*(row for row in older.rows if row.key not in again), *self.rows))

    def changes_from(self, older: Score) -> list[str]:
        """Return a line for each class that is another than in an older score.

        Parameters
        ----------
        older : Score
            Of the same file.

        Returns
        -------
        list of str
            Empty where nothing has changed.
        """
        before = {cell[:4]: cell.name for cell in older.cells}
        pairs = ((cell, before.get(cell[:4], cell.name)) for cell in self.cells)
        return [
            f"{', '.join(filter(None, cell[:4]))}: {was}, now {cell.name}" for cell, was in pairs if was != cell.name
        ]

    def failures(self, at_most: float | None = None, least_order: float | None = None) -> list[str]:
        """Return a line for each engine and case that does not keep a threshold.

        What an engine cannot say is no failure; what did not come to numbers is one, once there is a threshold.

        Parameters
        ----------
        at_most : float, optional
            For the error at the finest step.
        least_order : float, optional
            For the order at which it falls, unless it is at rounding.

        Returns
        -------
        list of str
            Empty where all is well.

        Examples
        --------
        >>> Score(()).failures(at_most=1e-3)
        []
        """
        lines = []
        for cell in self.profiles if at_most is not None or least_order is not None else ():
            where, last = f"{cell.engine}, {cell.label}, {cell.case}", cell.rows[-1]
            if cell.name == CANNOT:
                continue
            if not math.isfinite(last.worst):
                lines.append(f"{where}: {last.outcome}, {last.message}")
            elif at_most is not None and last.worst > at_most:
                lines.append(f"{where}: the error is {last.worst:.4g} at {last.step:g} s, more than {at_most:g}")
            elif least_order is not None and cell.name != EXACT and not cell.order >= least_order:
                lines.append(f"{where}: the error falls at the order {cell.order:.2g}, less than {least_order:g}")
        return lines

    @property
    def data(self) -> xarray.Dataset:
        """The rows as a dataset over `row`, with units and what each variable means."""
        import xarray

        columns = {each.name: [getattr(row, each.name) for row in self.rows] for each in fields(Row)}
        variables = {}
        for name, values in columns.items():
            number = next(each for each in fields(Row) if each.name == name).type == "float"
            attributes = {"units": _UNITS.get(name, "1")} if number else {}
            if name in _SAID:
                attributes["long_name"] = _SAID[name]
            variables[name] = ("row", np.array(values, dtype=float if number else object), attributes)
        return xarray.Dataset(variables, attrs={"format": _FORMAT, "Conventions": "CF-1.11"})

    def save(self, path: str | Path) -> None:
        """Write the rows to a NetCDF file.

        Parameters
        ----------
        path : path
            The file.
        """
        from ..simulation.netcdf import write_dataset

        write_dataset(self.data, Path(path))

    @staticmethod
    def load(path: str | Path) -> Score:
        """Read the rows of a file.

        Parameters
        ----------
        path : path
            As `save` wrote it.

        Returns
        -------
        Score
            The same.

        Raises
        ------
        RunFileError
            If it is another kind of file.
        """
        data = read_netcdf(Path(path))
        if data.attrs.get("format") != _FORMAT:
            raise RunFileError("file", "must hold a score", data.attrs.get("format"), "Name a score.nc.", str(path))
        columns = {each.name: data[each.name].values for each in fields(Row) if each.name in data}
        kinds: dict[str, Any] = {each.name: float if each.type == "float" else str for each in fields(Row)}
        return Score(
            tuple(
                Row(**{name: kinds[name](values[i]) for name, values in columns.items()})
                for i in range(data.sizes.get("row", 0))
            )
        )

    def as_dict(self) -> list[dict[str, Any]]:
        """Return the rows as plain values, without their paths.

        Returns
        -------
        list of dict
            One a row; None for what is not a number.
        """
        plain = (asdict(replace(row, path="")).items() for row in self.rows)
        return [
            {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in row if k != "path"}
            for row in plain
        ]
