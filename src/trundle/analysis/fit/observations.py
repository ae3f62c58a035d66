"""What was measured: columns over time, how well each is known, and in which row of the data each stands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import InvalidValueError
from ...solve.samples import Array
from ...tracks import Track, read_track
from ...tracks.names import kind_of
from ...units import UNITS, to_si

# What may be observed: the columns of a trajectory and others beside them, and of which kind each is.
OTHERS = ("mark_x", "mark_y", "angle", "spot_x", "spot_y", "spot_z")
GYROSCOPE = {f"w{axis}": f"gyro_{axis}" for axis in "xyz"}  # Ω along axes of the body, by what is read
UNROLLED = tuple(f"unrolled_{axis}" for axis in "xyz")  # the same along axes at rest, by itself
COLUMNS = {name: kind_of(name) for name in (*(f"{part}{axis}" for part in ("", "v", "w") for axis in "xyz"), *OTHERS)}
COLUMNS |= {ours: kind_of(read) for read, ours in GYROSCOPE.items()}
_FEWEST = 4  # rows
_HALF = 4  # rows to either side of one, whose polynomial shows the noise
_DEGREE = 3
_COMPUTED = 1e-11  # share of the largest value by which a computed motion may be off


def unit_of(column: str) -> str:
    """Return the SI unit of a column of `COLUMNS`."""
    return UNITS[COLUMNS[column] or "number"][0]


@dataclass(frozen=True)
class Observations:
    """The measured values of one run."""

    time: Array  # (n,): ascending, s
    columns: tuple[str, ...]  # names of `COLUMNS`
    values: Array  # (n, c): SI; not a number where there is none
    rows: Any  # (n,): what the data call each row: the line of a file, or the place in the table, from 1
    label: str  # the file's name, or "data"
    read: str  # what was taken for what
    accuracy: float = 0.0  # by how much all that is seen at one place may be off, as the track says it, m

    @property
    def known(self) -> Array:
        """Which values there are, (n, c)."""
        return np.isfinite(self.values)

    @property
    def turning(self) -> bool:
        """Whether it was measured how the body turns."""
        return any(name.startswith(("w", "gyro_", "spot_")) for name in self.columns)

    def column(self, name: str) -> Array:
        """Return one column."""
        return np.asarray(self.values[:, self.columns.index(name)])


def observe(
    data: Any,
    columns: Mapping[str, str] | None = None,
    units: str | Mapping[str, str] | None = None,
    label: str = "data",
) -> Observations:
    """Read measured columns.

    Parameters
    ----------
    data : Track, mapping, DataFrame, Dataset or path
        Columns over time.
    columns : mapping, optional
        Of names that do not tell: ours to theirs.
    units : str or mapping, optional
        Of what has none in its heading, as of `trundle.read_track`.
    label : str
        What to call it, unless it is a file.

    Examples
    --------
    >>> seen = observe({"t": [0.0, 0.1, 0.2, 0.3], "x [mm]": [1, 2, 3, 4], "y [cm]": [1, None, 0, 0]})
    >>> seen.columns, seen.values[:, 0].tolist()
    (('x', 'y'), [0.001, 0.002, 0.003, 0.004])
    """
    track = read_track(data, columns=columns, units=units)
    _check_frame(track)
    known = observable(track)
    wanted = [name for name, read in known.items() if np.isfinite(track[read]).any()]
    if not wanted:
        told = f"only empty ones: {', '.join(known)}" if known else "none"
        remedy = f"What may be fitted: {', '.join(COLUMNS)}."
        raise InvalidValueError("columns", "must have one of what was seen of the motion", told, remedy)
    values = np.column_stack([track[known[name]] for name in wanted])
    good = np.isfinite(values).any(axis=1)
    time, values, rows = track.time[good], values[good], np.asarray(track.data["row"].values)[good]
    if time.size < _FEWEST:
        raise InvalidValueError("data", f"must have {_FEWEST} rows at least", f"{time.size} with a time and a value")
    said = f"{track.taken}. {track.left_out_rows}".rstrip(" .")
    accuracy = float(track.data.attrs.get("accuracy", 0.0))
    return Observations(time, tuple(wanted), values, rows, _called(track, label), said, accuracy)


def _check_frame(track: Track) -> None:
    """Refuse what is measured in a frame that turns."""
    if track.frame != "support":
        rule, remedy = "must be along the support's axes at rest", "Say so, or turn the columns first."
        raise InvalidValueError("frame", rule, track.frame, remedy)


def observable(track: Track) -> dict[str, str]:
    """Return the columns of a track that may be fitted, by what each is: Ω along axes of a body is a gyroscope's.

    Examples
    --------
    >>> observable(read_track({"t": [0.0, 0.1], "x": [0.0, 0.1], "gyro_z": [1.0, 1.0]}))
    {'x': 'x', 'gyro_z': 'wz'}
    """
    return {_ours(track, name): name for name in COLUMNS if name in track.columns}


def _ours(track: Track, name: str) -> str:
    own = track.axes == "body" or str(track.data[name].attrs.get("heading", "")).lower().startswith("gyro")
    return GYROSCOPE.get(name, name) if own else name


def _called(track: Track, label: str) -> str:
    return " · ".join(filter(None, (track.source, track.name))) if track.format else label


# How well it is known


def scatter(seen: Observations) -> Array:
    """Return the standard deviation of one value of each column, from how it scatters about short polynomials.

    Examples
    --------
    >>> t, draw = np.linspace(0.0, 6.0, 400), np.random.default_rng(0)
    >>> seen = observe({"t": t, "x": np.sin(t) + draw.normal(scale=1e-3, size=400)})
    >>> float(scatter(seen)[0].round(3))
    0.001
    """
    return np.array([_scatter(seen.time, column) for column in seen.values.T])


def _scatter(time: Array, column: Array) -> float:
    """Return what polynomials of degree 3 through nine neighbours leave over of the one in the middle."""
    good = np.isfinite(column)
    t, x, width = time[good], column[good], 2 * _HALF + 1
    if x.size < width:
        return float(np.std(x - np.polyval(np.polyfit(t - t[0], x, 1), t - t[0]), ddof=2)) if x.size > 3 else 0.0
    first = np.arange(0, x.size - width + 1)
    at = first[:, None] + np.arange(width)
    u = t[at] - t[at[:, _HALF]][:, None]
    u = u / np.abs(u).max(axis=1, keepdims=True)
    powers = u[:, :, None] ** np.arange(_DEGREE + 1)
    # What is left of the middle one, of which the fit itself takes a share: r = x − h·x, var r = (1 − h_mid) σ².
    weights = np.linalg.pinv(powers)[:, 0, :]
    left = x[at[:, _HALF]] - np.einsum("ij,ij->i", weights, x[at] - x[at[:, :1]]) - x[at[:, 0]]
    left /= np.sqrt(np.maximum(1 - 2 * weights[:, _HALF] + (weights**2).sum(axis=1), 1e-12))
    rounding = 4 * float(np.finfo(float).eps * np.abs(x).max())
    return max(1.4826 * float(np.median(np.abs(left))), rounding)


@dataclass(frozen=True)
class Noise:
    """How a difference between data and model is turned into one of unit variance."""

    known: bool  # whether it was given; an estimated one is scaled by the fit
    sigma: Array  # (n, c): standard deviation of each value
    # of a covariance between values: the lower Cholesky factor over all values that there are
    factor: Array | None = None
    least: Array | float = 0.0  # (c,): below which nothing is believed of an estimated one

    def whiten(self, values: Array, seen: Array) -> Array:
        """Return rows (n, c, ...) where `seen` (n, c), in units of the noise, stacked."""
        picked = values[seen]
        if self.factor is None:
            return np.asarray(picked / self.sigma[seen].reshape(-1, *(1,) * (picked.ndim - 1)))
        from scipy.linalg import solve_triangular

        count = picked.shape[0]  # of a shorter stretch the first, which a triangle leaves as they are
        return np.asarray(solve_triangular(self.factor[:count, :count], picked, lower=True))


def noise_for(given: Any, seen: Observations) -> Noise:
    """Return the noise of observations, as given or as they scatter.

    Examples
    --------
    >>> seen = observe({"t": [0, 1, 2, 3], "x": [0, 1, 0, 1], "wz": [1, 1, 2, 1]})
    >>> noise_for({"x": "1 mm", "wz": "1 deg/s"}, seen).sigma[0].round(6).tolist()
    [0.001, 0.017453]
    """
    shape = seen.values.shape
    if given is None:
        least = _least(seen)
        return Noise(False, np.broadcast_to(np.maximum(scatter(seen), least), shape), least=least)
    if isinstance(given, Mapping):
        missing = [name for name in seen.columns if name not in given]
        if missing:
            raise InvalidValueError("noise", "must be given of each column", f"none of {', '.join(missing)}")
        each = [np.asarray(_positive(given[name], COLUMNS[name], f"noise[{name}]")) for name in seen.columns]
        return Noise(True, np.column_stack([np.broadcast_to(one, shape[:1]) for one in each]))
    array = np.asarray(given) if not isinstance(given, str) else np.empty(0)
    if array.ndim == 2:
        return _correlated(array.astype(float), seen)
    kinds = {COLUMNS[name] for name in seen.columns}
    if len(kinds) > 1:
        remedy = "Write for instance {'x': '0.5 mm', 'y': '0.5 mm', 'wz': '0.01 rad/s'}."
        raise InvalidValueError("noise", "must be given of each column where they differ in kind", given, remedy)
    sigma = _positive(given, kinds.pop(), "noise")
    if np.ndim(sigma) and np.size(sigma) != shape[0]:
        raise InvalidValueError("noise", f"must be one number, or one for each of {shape[0]} rows", np.size(sigma))
    return Noise(True, np.broadcast_to(np.reshape(sigma, (-1, 1)) if np.ndim(sigma) else sigma, shape))


def _least(seen: Observations) -> Array:
    """Return the noise below which nothing is believed: the error of what is computed, of a kind along any axis.

    It grows as the motion goes to and fro. Of what never moves it is that of the places in an interval, or of a radian.
    """
    columns, values = [COLUMNS[name] for name in seen.columns], seen.values
    each = np.nanmax(np.abs(values), axis=0)
    way = np.array([np.abs(np.diff(one[np.isfinite(one)])).sum() for one in values.T])
    often = float(np.max(way / np.where(each > 0, each, np.inf), initial=0.0))
    largest = {kind: float(max(each[[one == kind for one in columns]])) for kind in columns}
    interval = float(np.median(np.diff(seen.time))) if seen.time.size > 1 else 1.0
    still = {"velocity": largest.get("length", 0.0) / interval, "angular velocity": 1.0 / interval}
    sizes = [largest[kind] or still.get(str(kind), 0.0) for kind in columns]
    return np.asarray(_COMPUTED * (1.0 + often) * np.maximum(sizes, 1e-30))


def _positive(given: Any, kind: str | None, key: str) -> Any:
    number = to_si(given, str(kind), key)
    try:
        array = np.asarray(number, dtype=float)
    except (TypeError, ValueError):
        raise InvalidValueError(key, "must be a number", given) from None
    if not (np.isfinite(array) & (array > 0)).all():
        remedy = f"Leave it out, and it is estimated; or write for instance {UNITS[str(kind)][1]!r}."
        raise InvalidValueError(key, "must be positive", given, remedy)
    return number


def _correlated(covariance: Array, seen: Observations) -> Noise:
    """Return the noise of a covariance: between the columns of each row, or between all values."""
    n, c = seen.values.shape
    if covariance.shape == (c, c) != (n * c, n * c):
        covariance = np.asarray(np.kron(np.eye(n), covariance))
    elif covariance.shape != (n * c, n * c):
        rule = f"must be of shape ({c}, {c}), columns within a row, or ({n * c}, {n * c}), row by row"
        raise InvalidValueError("noise", rule, str(covariance.shape))
    picked = seen.known.ravel()
    chosen: Any = covariance[np.ix_(picked, picked)]
    try:
        factor: Any = np.linalg.cholesky(chosen)
    except np.linalg.LinAlgError:
        raise InvalidValueError("noise", "must be a covariance: symmetric, positive definite", "another") from None
    sigma = np.full(n * c, np.nan)
    sigma[picked] = np.sqrt(np.diag(chosen))
    return Noise(True, sigma.reshape(n, c), factor)
