"""The figure that both drawings start from: its own look, which owes nothing to the user's settings."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any
from warnings import catch_warnings, filterwarnings

import matplotlib as mpl
import numpy as np
from matplotlib.artist import allow_rasterization
from matplotlib.axes import Axes
from matplotlib.figure import Figure

# Okabe and Ito's colours, told apart by every kind of colour vision; lines differ in dash and marker besides.
BLUE, VERMILION, GREEN = "#0072B2", "#D55E00", "#007A5A"
SKY, ORANGE, PURPLE = "#56B4E9", "#E69F00", "#CC79A7"
INK, GREY, FAINT, TABLE = "#1A1A1A", "#5F5F5F", "#D9D9D9", "#F4F3EE"
# Shares of how far a path is from the origin: what moves less is at rest, and the side of the square that shows it
_LEAST, _OF_REST = 1e-6, 0.1

_LOOK: dict[str, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.5,
    "axes.labelsize": 9.5,
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlepad": 7.0,
    "axes.titley": 1.0,  # fixed: finding a place for it costs a second layout of all ticks
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.8,
    "axes.labelcolor": INK,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#E8E8E8",
    "grid.linewidth": 0.6,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.bottom": False,  # the grid marks the places
    "ytick.left": False,
    "legend.fontsize": 9.0,
    "legend.frameon": False,
    "lines.solid_joinstyle": "round",
    "lines.solid_capstyle": "round",
    "text.color": INK,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-5, 6),
    "agg.path.chunksize": 20_000,  # dense lines of a million points would overflow the renderer's cells
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}
_NOT_LOOK = (
    "backend",
    "interactive",
    "toolbar",
    "timezone",
    "webagg",
    "tk.",
    "macosx",
    "savefig.directory",
    "date.epoch",
)


@cache
def _settings() -> dict[str, Any]:
    library = {key: value for key, value in mpl.rcParamsDefault.items() if not key.startswith(_NOT_LOOK)}
    return library | _LOOK


@contextmanager
def look() -> Iterator[None]:
    """Put the figures' own settings in force, and the user's back afterwards."""
    with mpl.rc_context(_settings()):  # type: ignore[arg-type]  # the keys are rcParams' own
        yield


def extent(low: Any, high: Any) -> float:
    """Return the side of the square in which a path is shown: of what stays where it is, a part of how far away it is.

    Examples
    --------
    >>> extent((0.0, 0.0), (3.0, 1.0)), extent((0.5, 0.0), (0.5, 0.0)), extent((0.0, 0.0), (0.0, 0.0))
    (3.0, 0.05, 1e-09)
    """
    corners = np.array([low, high], dtype=float)
    side, away = float(np.ptp(corners, axis=0).max()), float(np.abs(corners).max())
    return max(side if side > _LEAST * away else _OF_REST * away, 1e-9)


def square(low: Any, high: Any, side: float) -> Any:
    """Return the corners of a square about the middle of two others, no smaller than these need.

    Examples
    --------
    >>> square((0.0, 0.0), (2.0, 1.0), 1.0).round(2).tolist()
    [[-0.12, -0.62], [2.12, 1.62]]
    """
    middle, half = (np.asarray(low) + high) / 2, 0.56 * max(float(np.max(np.subtract(high, low))), side)
    return np.array([middle - half, middle + half])


class Sheet(Figure):
    """A figure that draws itself with its own settings, wherever and whenever it is drawn.

    Parameters
    ----------
    width, height : float
        Inches.
    """

    def __init__(self, width: float = 8.0, height: float = 6.0, **kwargs: Any) -> None:
        kwargs.setdefault("figsize", (width, height))
        kwargs.setdefault("dpi", 150)
        super().__init__(**kwargs)

    @allow_rasterization
    def draw(self, renderer: Any) -> None:
        """Draw with the figures' own settings: ticks are made here, not before."""
        with look(), catch_warnings():
            filterwarnings("ignore", "Glyph .* missing from", UserWarning)  # a title may be in any script
            super().draw(renderer)

    def savefig(self, fname: Any, **kwargs: Any) -> None:
        """Save as matplotlib does, with the figures' own settings."""
        if "png" in (kwargs.get("format"), Path(fname).suffix[1:] if isinstance(fname, (str, Path)) else ""):
            kwargs.setdefault("pil_kwargs", {"compress_level": 3})  # as small as the default's 6, in less time
        with look():
            super().savefig(fname, **kwargs)

    def _repr_png_(self) -> bytes:
        # Notebooks show a bare figure only once pyplot is loaded; this shows it always.
        picture = BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()

    def add_box(self, left: float, bottom: float, width: float, height: float, **kwargs: Any) -> Axes:
        """Add axes whose box is given in inches from the lower left corner."""
        across, up = self.get_size_inches()
        return self.add_axes((left / across, bottom / up, width / across, height / up), **kwargs)

    def head(self, title: str, numbers: str) -> None:
        """Write the title and the line of key numbers, cut or shrunk to the sheet's width."""
        across, up = self.get_size_inches()
        room = across - 0.4
        longest = int(room / 0.118)
        title = title if len(title) <= longest else title[: longest - 1] + "…"
        size = 9.5 * min(1.0, room / (0.0755 * max(len(numbers), 1)))
        # No mathematics: a title may hold a dollar sign.
        plain: dict[str, Any] = {"parse_math": False, "ha": "left", "va": "baseline"}
        self.text(0.2 / across, 1.0 - 0.32 / up, title, fontsize=13, fontweight="bold", **plain)
        self.text(0.2 / across, 1.0 - 0.56 / up, numbers, fontsize=size, color=GREY, **plain)
