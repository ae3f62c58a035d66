"""One table on its way to a track: which column is which, in which unit, on which clock."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InvalidValueError
from ..units import UNITS as SI_UNITS
from . import names
from .options import Options
from .rows import Cells, row_numbers, taken_rows
from .sentence import clauses
from .table import NOT_USED, Column, Table
from .track import Array, Track

_FRAME_SAID = {"world": "seen from the room", "corotating": "seen from the turning support"}
FRAMES, AXES = ("support", "world", "corotating"), ("space", "body")
_UPWARDS = ("y", "vy", "mark_y", "spot_y")  # what turns its sign with y
_STEP = 1.0  # nobody films a ball once a second: times without a unit in such steps are more often frames or ms


@dataclass
class Reading:
    """One table on its way to a track."""

    table: Table
    options: Options
    source: str
    format: str
    frame: str
    axes: str
    film: bool

    def track(self, provenance: Mapping[str, Any]) -> Track:
        """Return the track."""
        import xarray

        self.left_out: dict[str, str] = {}
        self.asked: dict[str, InvalidValueError] = {}
        found = self._found()
        _check_sizes({name: column for name, (column, _) in found.items()})
        self.cells = {name: Cells(column) for name, (column, _) in found.items()}
        units = self._units(found)
        time = self._time(units.pop("t", None))
        values = {name: self.cells[name].numbers * factor for name, (factor, _) in units.items()}
        if not values:
            self._ask()
        if self._down:
            values |= {name: -array for name, array in values.items() if name in _UPWARDS}
        if "angle" in values and self._clockwise:
            values["angle"] = -values["angle"]
        used = {"t": self.cells["t"]} | {name: self.cells[name] for name in values}
        kept, rejected = taken_rows(self.table, time, used)
        data = xarray.Dataset(
            {
                name: ("time", array[kept], {"units": _si(name), "heading": found[name][0].heading})
                for name, array in values.items()
            },
            coords={
                "time": ("time", time[kept], {"units": "s", "heading": found["t"][0].heading}),
                "row": ("time", row_numbers(self.table, time.size)[kept]),
            },
            attrs={"frame": self._frame, "axes": self.table.axes or self.axes, "accuracy": self.table.accuracy},
        )
        return Track(
            data,
            name=self.table.name,
            source=self.source,
            format=self.format,
            frame=self._frame,
            axes=self.table.axes or self.axes,
            clauses=self._clauses(data, {name: unit for name, (_, unit) in units.items()}),
            rejected=rejected,
            left_out=self.left_out,
            counted=self.table.counted,
            provenance=provenance,
        )

    # --- which column is which --------------------------------------------------------------------------

    def _found(self) -> dict[str, tuple[Column, str]]:
        """Return the columns under trundle's names, each with the unit that it says."""
        columns = list(self.table.columns)
        headings = [column.heading for column in columns]
        asked = names.mapped(self.options.columns, headings)
        taken = {heading for heading, _ in asked.values()}
        told = {c.known: (c, c.unit or names.apart(c.heading)[1])
                for c in columns if c.known not in (None, NOT_USED) and c.heading not in taken}  # fmt: skip
        free = [c.heading for c in columns if c.known is None and c.heading not in taken]
        numbered = names.numbered_quaternion(free, self.options.quaternion)
        byname = names.recognise(heading for heading in dict.fromkeys(free) if heading not in numbered.values())
        byname |= {name: (heading, "") for name, heading in numbered.items()}
        known = [c.known for c in columns if c.known not in (None, NOT_USED)]
        for heading in [*(heading for heading, _ in byname.values()), *taken]:
            if headings.count(heading) > 1:
                raise InvalidValueError("headings", "must differ from each other", f"{heading!r} twice", "Rename one.")
        twice = next((name for name in known if known.count(name) > 1), None)
        if twice is not None:
            two = [repr(c.heading) for c in columns if c.known == twice]
            raise InvalidValueError("headings", f"must name one column `{twice}`", " and ".join(two), "Rename one.")
        by_heading = {column.heading: column for column in reversed(columns)}
        found = {str(name): pair for name, pair in told.items()}
        for name, (heading, unit) in {**byname, **asked}.items():
            column = by_heading[heading]
            found[name] = (column, unit or column.unit)
        if "t" in found:
            found.pop("frame", None)
        elif "frame" in found:
            found["t"] = (found["frame"][0], found.pop("frame")[1] or "frame")
        used = {id(column) for column, _ in found.values()}
        self.left_out |= {c.heading: "not used" for c in columns if id(c) not in used and c.heading}
        if "t" not in found:
            shown = ", ".join(dict.fromkeys(filter(None, headings)))
            rule = "must hold time and position"
            lacking = [name for name in ("t", "x", "y") if name not in found]
            remedy = f"Name them: --columns '{lacking[0]}=HEADING'."
            received = f"no column for {', '.join(lacking)} among {shown}"
            raise InvalidValueError("columns", rule, received[:400], remedy)
        return found

    # --- units -----------------------------------------------------------------------------------------

    def _units(self, found: Mapping[str, tuple[Column, str]]) -> dict[str, tuple[float, str]]:
        """Return the factor to SI of each column, and its unit; a column without one is left out with a word."""
        known: dict[str, tuple[float, str]] = {}
        for name, (column, own) in found.items():
            kind = names.kind_of(name)
            if name == "t":
                known[name] = (1.0, own)
                continue
            unit = own or self._unit(kind)
            if unit is None:
                self._leave_out(name, column, kind or "")
            elif name == "angle" and self._clockwise is None:
                rule = "must be said of an angle: clockwise or anticlockwise, seen from above"
                error = InvalidValueError("sense", rule, f"`{column.heading}`", "Give --sense clockwise.")
                self._leave(name, column, "nobody says whether it is clockwise: --sense", error)
            else:
                known[name] = (self._factor(unit, kind, column), unit)
        if self.options.pixel is not None and not any(_in_pixels(unit) for _, unit in known.values()):
            shown = ", ".join(f"`{column.heading}`" for column, _ in found.values())
            raise InvalidValueError("pixel", "is for places in pixels", shown, "Leave it out.")
        return known

    def _unit(self, kind: str | None) -> str | None:
        """Return the unit that was said for all columns of a kind; None where nobody did."""
        units = self.options.units
        length = units.get("length") or ("px" if self.options.pixel is not None else None)
        if kind is None:
            return "1"
        if kind in ("length", "velocity"):
            return length if kind == "length" or length is None else f"{length}/s"
        angle = units.get("angle")
        return angle if kind == "angle" or angle is None else f"{angle}/s"

    def _leave_out(self, name: str, column: Column, kind: str) -> None:
        option = "--unit" if kind in ("length", "velocity") else "--angles"
        example = "units='cm' (`--unit cm`)" if option == "--unit" else "units={'angle': 'deg'} (`--angles deg`)"
        rule = "must be said where the file does not say it"
        what = f"no unit of `{column.heading}` in {self.source or 'the data'}"
        error = InvalidValueError("units", rule, what, f"Give {example}, or m, or what it is." if kind == "length"
                                  else f"Give {example}, or what it is.")  # fmt: skip
        if kind == "length":
            raise error
        self._leave(name, column, f"its unit is not known: {option}", error)

    def _leave(self, name: str, column: Column, why: str, error: InvalidValueError) -> None:
        self.left_out[column.heading] = why
        self.asked[name] = error

    def _ask(self) -> None:
        """Ask for what would have made a column useful; without any, say that there is none."""
        if self.asked:
            raise next(iter(self.asked.values()))
        others = ", ".join(heading for heading in self.left_out) or "none"
        rule = "must hold time and position, or another quantity that is measured"
        raise InvalidValueError("columns", rule, f"no column but the time; others: {others}"[:400],
                                "Name them: --columns 'x=HEADING'.")  # fmt: skip

    def _factor(self, unit: str, kind: str | None, column: Column) -> float:
        if _in_pixels(unit):
            if self.options.pixel is None:
                rule = "must be given where places are in pixels"
                remedy = "Give the size of one: pixel='0.8 mm' (`--pixel '0.8 mm'`)."
                raise InvalidValueError("pixel", rule, f"`{column.heading}` in {unit}", remedy)
            if self._down is None:
                rule = "must be said of places in pixels: up as in graphs, or down as in pictures"
                raise InvalidValueError("y", rule, f"`{column.heading}`", "Give y='down' (`--y down`), or up.")
            return float(self.options.pixel)
        return names.factor(unit, kind, f"unit of {column.heading}")

    @property
    def _down(self) -> bool | None:
        return {"up": False, "down": True, None: self.table.y_down}[self.options.y]

    @property
    def _clockwise(self) -> bool | None:
        """Whether an angle grows clockwise; where its format counts y upwards, it counts angles the other way."""
        told = {"clockwise": True, "anticlockwise": False}
        if self.options.sense is not None:
            return told[self.options.sense]
        return self.table.y_down if self.film else False

    @property
    def _frame(self) -> str:
        return self.table.frame if self.table.frame in FRAMES else self.frame

    # --- time ------------------------------------------------------------------------------------------

    def _time(self, told: tuple[float, str] | None) -> Array:
        """Return the times in seconds, or ask what they are."""
        own = told[1] if told else ""
        numbers = self.cells["t"].numbers
        unit = own or self.options.units.get("time", "")
        steps = np.diff(numbers[np.isfinite(numbers)])
        coarse = bool(steps.size) and float(np.median(np.abs(steps))) >= _STEP
        if not unit and coarse:
            if self.options.rate is None:
                shown = ", ".join(f"{t:.6g}" for t in numbers[np.isfinite(numbers)][:3])
                rule = "must be known: steps of 1 or more may be frames, milliseconds or seconds"
                remedy = "Say it: --rate 60 for frames, --time ms, or --time s."
                raise InvalidValueError("time", rule, f"{shown}, ...", remedy)
            unit = "frame"
        if unit in names.FRAMES:
            self.unit_of_time = "frames"
            if self.options.rate is None:
                rule = "must be given where a file counts frames"
                heading = self.cells["t"].heading
                raise InvalidValueError("rate", rule, f"`{heading}`", "Give the frames a second: --rate 60.")
            return numbers / self.options.rate
        if self.options.rate is not None and self.table.rate is None:
            rule = "is for files that count frames"
            raise InvalidValueError("rate", rule, f"times in {unit or 's'}", "Leave it out.")
        self.unit_of_time = unit or "s"
        return numbers * names.factor(self.unit_of_time, "time", "unit of t")

    def _clauses(self, data: Any, units: Mapping[str, str]) -> tuple[str, ...]:
        """Say what was taken for what."""
        filmed = self.film and (self.table.axes or self.axes) != "body"
        said = clauses(data, units, self.unit_of_time, "frame" if filmed else "sample")
        if self._frame != "support":
            said.append(_FRAME_SAID[self._frame])
        if self._down:
            said.append("y turned up")
        if "angle" in units and self._clockwise:
            said.append("angle turned anticlockwise")
        if self.options.pixel is not None and any(map(_in_pixels, units.values())):
            said.append(f"a pixel of {self.options.pixel * 1e3:.6g} mm")
        return (*said, *self.table.remarks)


def _in_pixels(unit: str) -> bool:
    return unit.removesuffix("/s").strip() in names.PIXELS


def _si(name: str) -> str:
    return SI_UNITS[names.kind_of(name) or "number"][0]


def _check_sizes(columns: Mapping[str, Column]) -> None:
    sizes = {name: len(column.cells) for name, column in columns.items()}
    if len(set(sizes.values())) > 1:
        raise InvalidValueError("columns", "must be of one length", sizes)
