"""The figure of a sweep: a measure over what varied, in colours that every eye can tell apart."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError, UnknownNameError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .result import Sweep

NUMBERS = "cividis"  # the colour map of what is a number
_MOST_PANELS = 6
_PANEL = 2.6  # inches
_POWERS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_GEOMETRIC = 1e-6  # by which ratios of neighbours may differ on a logarithmic scale


@dataclass(frozen=True)
class Shown:
    """A variable as it is drawn: its values, what they stand for, and what its axis says."""

    name: str
    values: NDArray[Any]
    unit: str
    classes: tuple[tuple[int, str], ...] = ()

    @staticmethod
    def of(one: Any) -> Shown:
        """Take a variable of a dataset."""
        words = str(one.attrs.get("flag_meanings", "")).split()
        classes = tuple(zip(map(int, one.attrs.get("flag_values", ())), words, strict=False))
        return Shown(str(one.name), one.values, str(one.attrs.get("units", "1")), classes)

    @property
    def label(self) -> str:
        """The name and the unit."""
        unit = in_print(self.unit)
        return f"{self.name} ({unit})" if unit else self.name


def in_print(unit: str) -> str:
    """Write a unit as it is printed.

    Examples
    --------
    >>> in_print("m/s^2"), in_print("m s-1"), in_print("kg*m^2"), in_print("1")
    ('m/s²', 'm s⁻¹', 'kg m²', '')
    """
    if unit == "1":
        return ""
    return re.sub(r"(?<=[A-Za-z])\^?(-?\d+)", lambda found: found[1].translate(_POWERS), unit).replace("*", " ")


def draw(found: Sweep, name: str, at: Mapping[str, float] | None = None, axes: tuple[str, ...] = ()) -> Figure:
    """Draw a measure over what varied.

    Parameters
    ----------
    found : Sweep
        The results.
    name : str
        What was measured.
    at : mapping, optional
        Of a grid over more numbers than are drawn: the others' values; the nearest there is, the middle where absent.
    axes : tuple of str
        The one or two numbers that are drawn over; absent: the first two.
    """
    from ...views.plots.sheet import Sheet, look

    data = found.dataset
    drawn = axes or tuple(found.over[:2])
    for key in drawn:
        if key not in found.over:
            raise UnknownNameError("number that varies", key, found.over)
    grid = bool(data.attrs["grid"])
    with look():
        if not grid and len(found.over) != len(drawn) and not axes:
            return draw_marginals(found, name)
        figure = Sheet(7.0, 4.6 if len(drawn) == 2 else 3.6, layout="constrained")
        panel = figure.add_subplot()
        said = found.title
        if grid:
            data, held = _slice(data, [key for key in found.over if key not in drawn], at or {})
            said = ", ".join([said, *held])
            if len(drawn) == 2:
                _map(figure, panel, drawn, data, name)
            else:
                _line(panel, Shown.of(data[drawn[0]]), Shown.of(data[name]), "-o")
        elif len(drawn) == 2:
            _points(figure, panel, drawn, data, name)
        else:
            _line(panel, Shown.of(data[drawn[0]]), Shown.of(data[name]), ".")
        panel.set_title(said, loc="left")
    return figure


def _slice(data: Any, others: list[str], at: Mapping[str, float]) -> tuple[Any, list[str]]:
    """Return the part of a grid at some values of the numbers that are not drawn, and what these are."""
    for key in at:
        if key not in others:
            rule = "must be a number that varies and is not drawn"
            raise InvalidValueError("at", rule, key, f"There are: {', '.join(others) or 'none'}.")
    held = []
    for key in others:
        values = data[key].values
        place = int(np.argmin(np.abs(values - at[key]))) if key in at else values.size // 2
        data = data.isel({key: place})
        held.append(f"{key} = {values[place]:.4g} {in_print(data[key].attrs.get('units', '1'))}".strip())
    return data, held


def _scaled(panel: Axes, which: str, shown: Shown) -> None:
    """Label an axis, in logarithms where the values are evenly spaced in these."""
    getattr(panel, f"set_{which}label")(shown.label)
    if shown.classes:
        getattr(panel, f"set_{which}ticks")([value for value, _ in shown.classes], [word for _, word in shown.classes])
    elif is_geometric(shown.values):
        getattr(panel, f"set_{which}scale")("log")


def is_geometric(values: NDArray[Any]) -> bool:
    """Tell whether values are evenly spaced in their logarithms, and not in themselves.

    Examples
    --------
    >>> is_geometric(np.geomspace(0.1, 10, 5)), is_geometric(np.linspace(0.1, 10, 5))
    (True, False)
    """
    if values.ndim != 1 or values.size < 3 or not (values > 0).all():
        return False
    ratios = values[1:] / values[:-1]
    return bool(np.ptp(ratios) <= _GEOMETRIC * ratios[0] and abs(ratios[0] - 1) > _GEOMETRIC)


def _map(figure: Figure, panel: Axes, drawn: tuple[str, ...], data: Any, name: str) -> None:
    """Colour the fields of a grid."""
    across, up, measured = (Shown.of(one) for one in (data[drawn[0]], data[drawn[1]], data[name].transpose(*drawn)))
    mesh = panel.pcolormesh(
        across.values, up.values, _drawable(measured).T, shading="nearest", **_style(measured), rasterized=True
    )
    panel.set_facecolor("#EEEEEE")
    panel.grid(visible=False)
    _scaled(panel, "x", across)
    _scaled(panel, "y", up)
    _key(figure, panel, mesh, measured)


def _points(figure: Figure, panel: Axes, drawn: tuple[str, ...], data: Any, name: str) -> None:
    """Colour a point for each member."""
    across, up, measured = (Shown.of(data[one]) for one in (*drawn, name))
    points = panel.scatter(across.values, up.values, c=_drawable(measured), s=9, **_style(measured))
    _scaled(panel, "x", across)
    _scaled(panel, "y", up)
    _key(figure, panel, points, measured)


def _line(panel: Axes, across: Shown, measured: Shown, mark: str) -> None:
    from ...views.plots.sheet import BLUE

    panel.plot(across.values, _drawable(measured), mark, color=BLUE, markersize=3, linewidth=1.2)
    _scaled(panel, "x", across)
    _scaled(panel, "y", measured)


def draw_marginals(found: Sweep, name: str) -> Figure:
    """Draw a measure over each number alone, and how it is distributed."""
    from ...views.plots.sheet import BLUE, Sheet, look

    with look():
        return _marginals(found, name, BLUE, Sheet)


def _marginals(found: Sweep, name: str, colour: str, sheet: Any) -> Figure:
    measured = Shown.of(found.data[name])
    keys = found.over[: _MOST_PANELS - 1]
    figure = sheet(2 * _PANEL + 2, _PANEL * -(-(len(keys) + 1) // 2), layout="constrained")
    panels = figure.subplots(-(-(len(keys) + 1) // 2), 2, squeeze=False).ravel()
    for panel, key in zip(panels, keys, strict=False):
        _line(panel, Shown.of(found.data[key]), measured, ".")
    values = _drawable(measured).compressed()
    if measured.classes:
        counts = [int((values == value).sum()) for value, _ in measured.classes]
        panels[len(keys)].bar([word for _, word in measured.classes], counts, color=colour)
    else:
        panels[len(keys)].hist(values, bins=min(40, max(5, int(np.sqrt(values.size)))), color=colour)
        panels[len(keys)].set_xlabel(measured.label)
    panels[len(keys)].set_ylabel("members")
    for panel in panels[len(keys) + 1 :]:
        panel.set_axis_off()
    figure.suptitle(found.title)
    return figure


def _drawable(measured: Shown) -> Any:
    """Return the values, those that are none left out."""
    values = measured.values.astype(float)
    return np.ma.masked_where((values < 0) if measured.classes else ~np.isfinite(values), values)


def _style(measured: Shown) -> dict[str, Any]:
    if not measured.classes:
        return {"cmap": NUMBERS}
    from matplotlib.colors import BoundaryNorm, ListedColormap

    known = [value for value, _ in measured.classes if value >= 0]
    return {
        "cmap": ListedColormap(palette(len(known))),
        "norm": BoundaryNorm(np.arange(len(known) + 1) - 0.5, len(known)),
    }


def palette(count: int) -> list[str]:
    """Return the colours of classes: Okabe and Ito's, the darkest and lightest of them first."""
    from ...views.plots.sheet import BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILION

    colours = [BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILION, INK]
    return [colours[i % len(colours)] for i in range(count)]


def _key(figure: Figure, panel: Axes, drawn: Any, measured: Shown) -> None:
    if not measured.classes:
        figure.colorbar(drawn, ax=panel, label=measured.label)
        return
    from matplotlib.patches import Patch

    values = set(np.unique(_drawable(measured).compressed()).astype(int).tolist())
    known = [(value, word) for value, word in measured.classes if value >= 0]
    colours = palette(len(known))
    patches = [Patch(color=colours[value], label=word) for value, word in known if value in values]
    figure.legend(handles=patches, title=measured.name, loc="outside right upper")
