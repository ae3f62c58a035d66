"""A ball rolled along a path on a plane, without slipping and without pivoting: where it is and how it is turned."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...display import Headline, Markup, Plottable, fold, joined
from ...errors import InvalidValueError, UnknownNameError
from ...mechanics.algebra import Quaternion
from ...mechanics.checks import positive
from . import bends
from .development import Laid, develop
from .pieces import Piece
from .rotation import Rotation
from .stages import Stages

if TYPE_CHECKING:
    from collections.abc import Iterator

    import xarray
    from matplotlib.figure import Figure

    from ...verify import Card

Array = NDArray[np.float64]

_MOST_SAMPLES = 10_000_000
_CLOSED = 1e-9  # how near to its beginning a path must end to be closed, as a share of its length
_EPSILON = 2.0**-52
_ROUNDING = 8.0  # units in the last place lost for each radian, piece and step
_SMALL = 3.0  # radii of the ball; loops of a shorter way round are small


@dataclass(frozen=True, eq=False, repr=False)
class RolledPath(Plottable):
    """A ball rolled along a path, as `roll_along` returns it.

    Parameters
    ----------
    pieces : tuple of Straight, Arc or Curve
        The path.
    radius : float
        a, of the ball, m.
    start : pair of float
        Where its contact point begins, m.
    orientation : tuple of 4 floats
        Quaternion (w, x, y, z) at the beginning, body frame to support frame.
    title, scenario : str
        Of the scenario that it came from, and its text.

    Examples
    --------
    The lecture's two orders. Both end at the same place, the pole does not:

    >>> import trundle as tr
    >>> x, y = (tr.Straight(heading=heading, turn="90 deg") for heading in ("0 deg", "90 deg"))
    >>> tr.roll_along([x, y], radius=1.0).north_pole.round(9) + 0.0
    array([1., 0., 0.])
    >>> tr.roll_along([y, x], radius=1.0).north_pole.round(9) + 0.0
    array([0., 1., 0.])
    """

    pieces: tuple[Piece, ...]
    radius: float
    start: tuple[float, float] = (0.0, 0.0)
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    title: str = ""
    scenario: str = ""
    _laid: Laid = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_laid", develop(self.pieces, self.start, self.radius))

    def __repr__(self) -> str:
        return f"<RolledPath: {self._extent}>"

    @property
    def _extent(self) -> str:
        count = len(self.pieces)
        return f"{count} piece{'s' * (count != 1)}, {self.length:g} m, ball of radius {self.radius:g} m"

    def _headline(self) -> Headline:
        return Headline(self.title, self._extent)

    def _parts(self) -> Iterator[Markup]:
        from ...verify.card import table_of
        from .evidence import facts

        yield table_of(facts(self))
        yield fold("Stages", joined(self.stages._parts()))

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        names = {part.name for part in fields(RolledPath)} | set(dir(RolledPath))
        raise UnknownNameError("attribute of a RolledPath", name, sorted(n for n in names if n[0] != "_"))

    # --- where the ball is ---------------------------------------------------------------------------------

    @cached_property
    def stages(self) -> Stages:
        """The ball at the beginning, and at the end of each piece: n + 1 stages for n pieces."""
        laid = self._laid
        turns = bends.turn(laid.headings, laid.curvatures, laid.lengths, self.radius)
        q = Quaternion.of(self.orientation)
        found = [q]
        for i in range(len(self.pieces)):
            curve = laid.curves.get(i)
            if curve is None:
                q = Quaternion(*turns[i].tolist()) * q
            else:
                q = Quaternion(*curve.orientations(np.array(curve.ends[1:]), tuple(q))[0].tolist())
            size = math.sqrt(sum(part * part for part in q))
            q = Quaternion(*(part / size for part in q))
            found.append(q)
        headings = np.append(laid.headings, laid.last_heading)
        return Stages(laid.distances, laid.places, headings, np.array([tuple(q) for q in found]), self.radius)

    def at(self, distances: Any) -> Stages:
        """Return the ball at any distances along the path: exact on straight pieces and arcs.

        Parameters
        ----------
        distances : float or array (n,)
            Along the path, 0 to `length`, m; any order.

        Returns
        -------
        Stages
            As many as there are distances.

        Raises
        ------
        InvalidValueError
            If a distance is not on the path.

        Examples
        --------
        >>> import trundle as tr
        >>> rolled = tr.roll_along(tr.Arc(radius=1.0, angle="1 turn"), radius=1.0)
        >>> rolled.at([0.0, rolled.length / 2]).contact.round(9) + 0.0
        array([[0., 0.],
               [0., 2.]])
        """
        wanted = np.atleast_1d(np.asarray(distances, dtype=float)).ravel()
        if not (np.isfinite(wanted).all() and (wanted >= 0).all() and (wanted <= self.length).all()):
            raise InvalidValueError("distances", f"must lie on the path, 0 to {self.length:g} m", distances)
        laid, stages = self._laid, self.stages
        piece = np.clip(np.searchsorted(laid.distances, wanted, side="right") - 1, 0, len(self.pieces) - 1)
        along = wanted - laid.distances[piece]
        heading, curvature = laid.headings[piece], laid.curvatures[piece]
        contact = laid.places[piece] + bends.displacement(heading, curvature, along)
        turned = Quaternion.of(bends.turn(heading, curvature, along, self.radius))
        orientation = (turned * Quaternion.of(stages.orientation[piece])).array()
        heading = heading + curvature * along
        for i, curve in laid.curves.items():
            here = np.flatnonzero(piece == i)
            here = here[np.argsort(along[here], kind="stable")]
            if here.size:
                u = curve.parameter(along[here])
                contact[here], heading[here] = curve.places(u)
                orientation[here] = curve.orientations(u, stages.orientation[i])
        orientation /= np.linalg.norm(orientation, axis=1, keepdims=True)
        return Stages(wanted, contact, heading, orientation, self.radius)

    def sampled(self, every: float | None = None) -> Stages:
        """Return the ball at even steps along the path, and at its stages.

        Parameters
        ----------
        every : float, optional
            Step, m; absent: a two-hundredth of the path.

        Returns
        -------
        Stages
            Ascending; the end is among them.

        Raises
        ------
        InvalidValueError
            If the step is not positive, or asks for more than 10 million samples.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.roll_along(tr.Straight(length=1.0), radius=0.1).sampled(every=0.3).distance
        array([0. , 0.3, 0.6, 0.9, 1. ])
        """
        step = self.length / 200 if every is None else positive(every, "length", "every")
        if not self.length / step < _MOST_SAMPLES:
            remedy = f"The path is {self.length:g} m long; take longer steps."
            raise InvalidValueError("every", "must give at most 10 million samples", every, remedy)
        ends = self._laid.distances
        even = step * np.arange(math.ceil(self.length / step))
        nearest = np.clip(np.searchsorted(ends, even), 1, ends.size - 1)
        apart = np.minimum(np.abs(even - ends[nearest]), np.abs(even - ends[nearest - 1]))
        return self.at(np.sort(np.concatenate([even[apart > 1e-6 * step], ends])))

    # --- what may be said of the whole -----------------------------------------------------------------------

    @property
    def length(self) -> float:
        """Of the path, m."""
        return float(self._laid.distances[-1])

    @property
    def rotation(self) -> Rotation:
        """The rotation that takes the first orientation to the last, in the support frame."""
        first, last = (Quaternion(*self.stages.orientation[i]) for i in (0, -1))
        return Rotation.of(tuple(last * first.conjugate))

    @property
    def north_pole(self) -> Array:
        """Where the north pole points at the end, support frame."""
        return self.stages.north_pole[-1]

    @property
    def gap(self) -> float:
        """The distance from the path's end to its beginning, m."""
        return float(np.hypot(*(self._laid.places[-1] - self._laid.places[0])))

    @property
    def is_closed(self) -> bool:
        """Whether the path ends where it began, to a billionth of its length."""
        return self.gap <= _CLOSED * self.length

    @property
    def enclosed_area(self) -> float | None:
        """The area inside a closed path, m²: positive anticlockwise, counted once for each time round; else None."""
        if not self.is_closed:
            return None
        area = self._laid.area
        return area if abs(area) > _ROUNDING * _EPSILON * self.length**2 else 0.0  # as of a figure of eight

    @property
    def small_loop_angle(self) -> float | None:
        """The angle about the normal by which a small loop turns the ball, −A/a² (G4), rad; None if not closed."""
        area = self.enclosed_area
        return None if area is None else 0.0 - area / self.radius / self.radius

    @property
    def is_small_loop(self) -> bool:
        """Whether it is closed and short beside the ball: `small_loop_angle` is right to some hundredths."""
        return self.is_closed and self.length < _SMALL * self.radius

    @property
    def error_bound(self) -> float:
        """The most by which any orientation can be off, rad: rounding, and for a curve by function its polynomials."""
        laid = self._laid
        bend = float(np.abs(laid.curvatures * laid.lengths).sum())
        steps = len(self.pieces) + self.length / self.radius + bend + sum(c.steps for c in laid.curves.values())
        return float(_ROUNDING * _EPSILON * steps + sum(curve.error_bound for curve in laid.curves.values()))

    # --- what it leaves --------------------------------------------------------------------------------------

    def card(self) -> Card:
        """Return what was checked, and the facts of the path.

        Returns
        -------
        Card
            Each figure with its bound.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.roll_along(tr.Arc(radius=0.1, angle="1 turn"), radius=0.025).card().passed
        True
        """
        from .evidence import card

        return card(self)

    def dataset(self, every: float | None = None) -> xarray.Dataset:
        """Return labelled arrays over the distance along the path.

        Parameters
        ----------
        every : float, optional
            As for `sampled`.

        Returns
        -------
        xarray.Dataset
            `position`, `contact`, `heading`, `orientation` and `north_pole`, SI units in the attributes.

        Examples
        --------
        >>> import trundle as tr
        >>> tr.roll_along(tr.Straight(length=1.0), radius=0.1).dataset().orientation.dims
        ('distance', 'quaternion')
        """
        from .dataset import dataset

        return dataset(self, every)

    def save(self, path: Any, every: float | None = None) -> Path:
        """Write the dataset to a NetCDF4 file, whole or not at all.

        Parameters
        ----------
        path : path
            Such as ``"run.nc"``; its folder must exist.
        every : float, optional
            As for `sampled`.

        Returns
        -------
        pathlib.Path
            The file.

        Raises
        ------
        TrundleError
            If it cannot be written.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> import trundle as tr
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tr.roll_along(tr.Straight(length=1.0), radius=0.1).save(pathlib.Path(folder) / "run.nc").name
        'run.nc'
        """
        from .dataset import save

        return save(self, Path(path), every)

    def plot(self, *others: RolledPath) -> Figure:
        """Draw the path with the ball and its north pole at each stage, one column for each path.

        Parameters
        ----------
        *others : RolledPath
            Drawn beside this one, to the same scale.

        Returns
        -------
        matplotlib.figure.Figure
            Shown by notebooks; save it with `savefig`.

        Examples
        --------
        >>> import trundle as tr
        >>> x, y = (tr.Straight(heading=heading, turn="90 deg") for heading in ("0 deg", "90 deg"))
        >>> figure = tr.roll_along([x, y], radius=1.0).plot(tr.roll_along([y, x], radius=1.0))
        """
        from .figure import draw

        return draw((self, *others))
