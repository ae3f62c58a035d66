"""What comes of a film: a track with the calibration that it was measured by, and a film to check it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...display import Markup, pairs
from ...files import written_whole
from ..track import Track

if TYPE_CHECKING:
    from .calibration import Calibration

_TOLD = 200  # frames that are named in a file
_PARTS = {
    0.1: "a tenth of a pixel",
    0.25: "a quarter of a pixel, since the film is strongly compressed: film at a higher quality",
}


@dataclass(frozen=True, repr=False)
class FilmTrack(Track):
    """A ball as a film shows it: what `track_film` returns, a `Track` that knows its camera.

    Parameters
    ----------
    data, name, source, format, frame, axes, taken, rejected, left_out, counted, provenance : see Track
        The columns are x and y of the ball's centre, and mark_x and mark_y where the table has a mark.
    calibration : Calibration
        Where the camera stood, and how the table turned.
    pixels : array (n, 2)
        Where the middle of the ball was seen, px.
    ball_radius : float
        m.
    rim_radius : float
        m; 0 where marks were given.
    slow : float
        How many times slower than the world the film runs.
    film : Film
        What it was measured from.

    Examples
    --------
    See `trundle.track_film`.
    """

    calibration: Any = None
    pixels: Any = field(default=None, repr=False)
    ball_radius: float = 0.0
    rim_radius: float = 0.0
    slow: float = 1.0
    film: Any = field(default=None, repr=False)

    @property
    def rate(self) -> tuple[float, float] | None:
        """The rate of the table and its standard deviation, rad/s, if a mark showed it."""
        turning = self.calibration.turning
        return None if turning is None else (turning.rate, turning.rate_sigma)

    @property
    def height(self) -> float:
        """Of the lens over the table, m."""
        return float(self.calibration.camera.place[2])

    @property
    def calibrated(self) -> tuple[str, ...]:
        """What is known of camera and table, a line each."""
        return tuple(f"{name}: {value}" for name, value in self._told())

    def save(self, path: str | Path) -> Path:
        """Write the track as a table that `trundle.read_track` and `trundle fit` read.

        Parameters
        ----------
        path : str or Path
            Ends in .csv.

        Returns
        -------
        Path
            The file.

        Examples
        --------
        See `trundle.track_film`.
        """
        target = Path(path)
        heads = ["t (s)", *(f"{name} ({self.data[name].attrs['units']})" for name in self.columns)]
        notes = [f"# {self.source}: {self.taken}", *(f"# {line}" for line in self.calibrated)]
        notes += [f"# frame {one.row} was left out: {one.reason}" for one in self.rejected[:_TOLD]]
        more = len(self.rejected) - _TOLD
        notes += [f"# and {more} more"] if more > 0 else []
        table = np.column_stack([self.time, *(self[name] for name in self.columns)])
        lines = [f"{row[0]:.6f}," + ",".join(f"{one:.7f}".replace("nan", "") for one in row[1:]) for row in table]
        with written_whole(target) as temporary:
            Path(temporary).write_text("\n".join([*notes, ",".join(heads), *lines]) + "\n", encoding="utf-8")
        return target

    def save_check(self, path: str | Path) -> Path:
        """Write the film again, small, with rim, mark and ball drawn where they were measured.

        Parameters
        ----------
        path : str or Path
            Ends in .mp4, .avi or .webm.

        Returns
        -------
        Path
            The file.

        Examples
        --------
        See `trundle.track_film`.
        """
        from .check_film import write_check

        return write_check(self, Path(path))

    def _told(self) -> list[tuple[str, str]]:
        """Return what is known of camera and table, by name."""
        calibration: Calibration = self.calibration
        camera, turning = calibration.camera, calibration.turning
        told = [
            ("calibrated by", f"{calibration.basis}, to {calibration.misfit:.2f} px"),
            ("lens over the table", f"{camera.place[2]:.4g} m, aside by {np.hypot(*camera.place[:2]):.3g} m"),
            ("focal length", f"{camera.focal:.5g} px"),
        ]
        if "accuracy_in_pixels" in self.data.attrs:
            pixels = _PARTS[self.data.attrs["accuracy_in_pixels"]]
            told.append(("accuracy", f"{self.data.attrs['accuracy']:.2g} m, {pixels}"))
        if turning is not None:
            rpm = turning.rate * 30 / np.pi
            turns = f"{turning.rate:.6g} ± {turning.rate_sigma:.2g} rad/s ({rpm:.5g} rpm)"
            told.append(("table", f"{turns}; the mark at {turning.radius * 1e3:.4g} mm, to {turning.misfit:.2f} px"))
        return told

    def _parts(self) -> Iterator[Markup]:
        yield pairs(self._told())
        yield from super()._parts()

    def __str__(self) -> str:
        return "\n".join([super().__str__(), *self.calibrated])
