"""What is returned: the derivatives as a labelled dataset, and how well they agree with differences of runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Headline, Markup, Plottable, Serializable, paragraph, table
from ...errors import UnknownNameError
from .comparing import Agreement

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

HEADINGS = ("number", "value", "its unit", "of the last position, m per unit", "of the last velocity, m/s per unit")


@dataclass(frozen=True, repr=False)
class Sensitivities(Plottable, Serializable):
    """The first derivatives of a run by numbers of its scenario.

    The variables of `data` can be read off the result itself: `found.position` is `found.data.position`.

    Parameters
    ----------
    title : str
        Of the scenario.
    data : xarray.Dataset
        The derivatives of `position`, `contact`, `velocity`, `angular_velocity`, `contact_force`, `slip_velocity` and
        `orientation` over `time`, `axis` (or `quaternion`) and `parameter`, at fixed instants, and of `event_time` over
        `event` and `parameter`. The coordinates `value` and `unit` say what each parameter was, in SI.
    method : str
        "exact": by a closed form. "variational": by the variational equations of each phase.
    agreement : Agreement
        How far they are from differences of runs.

    Examples
    --------
    >>> import trundle as tr
    >>> found = tr.sensitivities("tilted-turntable", wrt=["support.tilt", "start.velocity"], duration="2 s")
    >>> found.position.sel(parameter="support.tilt").dims
    ('time', 'axis')
    >>> found.passed
    True
    """

    title: str
    data: xarray.Dataset
    method: str
    agreement: Agreement

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return self[name]

    def __getitem__(self, name: str) -> xarray.DataArray:
        """Return a variable of the dataset by its name."""
        if name not in self.data:
            raise UnknownNameError("derivative", str(name), [str(known) for known in self.data])
        return self.data[name]

    @property
    def passed(self) -> bool | None:
        """Whether they agree with differences of runs; None where nothing could be compared."""
        return self.agreement.passed

    @property
    def cells(self) -> list[tuple[str, ...]]:
        """A row for each number, as the table shows it."""
        rows = []
        for j, name in enumerate(self.data.parameter.values):
            slopes = [self.data[one].values[..., j] for one in ("position", "velocity")]
            last = [", ".join(_shown(part, np.abs(each).max()) for part in each[-1]) for each in slopes]
            unit = str(self.data.unit.values[j])
            rows.append(
                (str(name), f"{float(self.data.value.values[j]):.6g}", unit or "1", *(f"({one})" for one in last))
            )
        return rows

    def __str__(self) -> str:
        rows = [HEADINGS, *self.cells]
        widths = [max(len(row[i]) for row in rows) for i in range(len(HEADINGS))]
        lines = [
            "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
        ]
        return "\n".join([self.title, self.heading, *lines, *self._events])

    @property
    def heading(self) -> str:
        """By which method, and how well they agree with differences of runs."""
        way = "by the closed form" if self.method == "exact" else "by the variational equations"
        end = float(self.data.time.values[-1])
        return f"first derivatives at t = {end:.6g} s {way}; {self.agreement}"

    @property
    def _events(self) -> list[str]:
        """A line for each of the first events: when it comes, and how that changes."""
        lines, names, units = [], self.data.parameter.values, self.data.unit.values
        values = np.abs(self.data.value.values.astype(float))
        for i, kind in enumerate(self.data.kind.values[:_MOST_EVENTS]):
            time, slopes = float(self.data.instant.values[i]), self.data.event_time.values[i]
            scales = np.divide(time, values, out=np.abs(slopes), where=values > 0)
            each = [
                f"{_shown(slope, scale)} {f's per {unit}' if unit else 's'} of {name}"
                for name, unit, slope, scale in zip(names, units, slopes, scales, strict=True)
            ]
            lines.append(f"{kind} at t = {time:.6g} s moves by {', '.join(each)}")
        return lines

    def _headline(self) -> Headline:
        return Headline(self.title, str(self.agreement), self.passed)

    def _parts(self) -> Iterator[Markup]:
        yield paragraph(self.heading)
        yield table(self.cells, HEADINGS)
        for line in self._events:
            yield paragraph(line)

    def as_dict(self) -> dict[str, Any]:
        """Return what is said of the end of the run, and of the events, in SI units.

        Examples
        --------
        >>> import trundle as tr
        >>> found = tr.sensitivities("level-turntable-nudged", wrt=["body.mass"], duration="1 s")
        >>> found.as_dict()["parameters"][0]["name"]
        'body.mass'
        """
        parameters = []
        for j, name in enumerate(self.data.parameter.values):
            last = {
                str(one): [
                    None if np.isnan(part) else float(part) for part in self.data[one].values[-1, ..., j].ravel()
                ]
                for one, variable in self.data.items()
                if "time" in variable.dims
            }
            facts = {
                "name": str(name),
                "value": float(self.data.value.values[j]),
                "unit": str(self.data.unit.values[j]),
            }
            parameters.append({**facts, **last, "event_time": self.data.event_time.values[:, j].tolist()})
        events = [
            {"kind": str(kind), "time": float(time)}
            for kind, time in zip(self.data.kind.values, self.data.instant.values, strict=True)
        ]
        return {
            "title": self.title,
            "method": self.method,
            "time": float(self.data.time.values[-1]),
            "agreement": None if self.passed is None else self.agreement.apart,
            "passed": self.passed,
            "events": events,
            "parameters": parameters,
        }

    def plot(self) -> Figure:
        """Draw the derivatives of the position over time, a panel for each parameter.

        Examples
        --------
        >>> import trundle as tr
        >>> found = tr.sensitivities("level-turntable-nudged", wrt=["start.velocity"], duration="2 s")
        >>> len(found.plot().axes)
        2
        """
        from matplotlib.figure import Figure

        from ...views.plots.sheet import BLUE, FAINT, GREEN, VERMILION

        styles = zip(self.data.axis.values, (BLUE, VERMILION, GREEN), ("-", "--", ":"), strict=True)
        lines = [(axis, {"color": colour, "linestyle": dash, "linewidth": 1.4}) for axis, colour, dash in styles]
        count = self.data.parameter.size
        figure = Figure(figsize=(7.0, 1.2 + 1.8 * count), layout="constrained")
        panels = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
        for j, panel in enumerate(panels):
            for axis, style in lines:
                slopes = self.data.position.isel(parameter=j).sel(axis=axis)
                panel.plot(self.data.time.values, slopes.values, label=str(axis), **style)
            for instant in self.data.instant.values:
                panel.axvline(float(instant), color=FAINT, linewidth=0.8, zorder=0)
            unit = str(self.data.unit.values[j])
            panel.set_ylabel(f"m per {unit}" if unit else "m")
            panel.set_title(f"∂r/∂({self.data.parameter.values[j]})", fontsize=10, loc="left")
        panels[0].legend(ncols=3, fontsize=8, frameon=False)
        panels[-1].set_xlabel("t, s")
        figure.suptitle(self.title, fontsize=11)
        return figure


_MOST_EVENTS = 10
_ROUNDING = 1e-12  # of the scale of a slope


def _shown(slope: float, scale: float) -> str:
    """Write a slope down; what rounding alone has made of none is 0."""
    return "0" if abs(slope) <= _ROUNDING * scale else f"{slope:.4g}"
