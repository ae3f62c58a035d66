"""Somebody else's file, table or arrays, read to labelled arrays in the inertial support frame and SI units."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InvalidValueError, UnknownNameError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.system import RollingSystem
from ...solve import frames
from . import names
from .files import Table, open_file
from .record import Array, ExternalTrajectory
from .rows import whole_rows

AXES, ORDERS, DIRECTIONS = ("space", "body"), ("wxyz", "xyzw"), ("body-to-space", "space-to-body")
_ARRAYS = {
    "t": ("t", "time"),
    "xyz": ("position", "r", "x"),
    "v": ("velocity", "V", "v"),
    "w": ("angular_velocity", "Omega", "Ω", "omega"),
    "q": ("orientation", "q", "quaternion"),
}


@dataclass(frozen=True)
class Conventions:
    """How their numbers are to be read.

    Parameters
    ----------
    columns : mapping, optional
        Trundle's name (t, x, y, z, vx, ..., wx, ..., qw, ...) -> their heading, where the name alone does not tell.
    axes : str
        "space": Ω has its components along the axes of the frame; "body": along those of the body.
    angles : str
        Unit of angles, "rad" or "deg"; rates per second.
    quaternion : str
        Order of the parts, "wxyz" or "xyzw"; matters where columns are numbered or come as one array.
    orientation : str
        "body-to-space", or "space-to-body" for the inverse.
    euler : str
        For columns e1, e2, e3: the axes, as SciPy has them: "xyz" about fixed axes, "ZXZ" about those of the body.
    frame : str
        One of `trundle.solve.frames.FRAMES`.
    time, length : str
        Units of time and length where the headings have none.

    Examples
    --------
    >>> Conventions(angles="deg").angles
    'deg'
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    axes: str = "space"
    angles: str = "rad"
    quaternion: str = "wxyz"
    orientation: str = "body-to-space"
    euler: str = "xyz"
    frame: str = "support"
    time: str = "s"
    length: str = "m"

    def __post_init__(self) -> None:
        for name, value, allowed in (
            ("kind of axes", self.axes, AXES),
            ("unit of angles", self.angles, ("rad", "deg")),
            ("quaternion order", self.quaternion, ORDERS),
            ("sense of the orientation", self.orientation, DIRECTIONS),
            ("frame", self.frame, frames.FRAMES),
        ):
            if value not in allowed:
                raise UnknownNameError(name, str(value), allowed)
        if not re.fullmatch(r"[xyz]{3}|[XYZ]{3}", self.euler):
            raise InvalidValueError("euler", "must name three axes, such as xyz or ZXZ", self.euler)

    def unit(self, kind: str | None) -> str:
        """Return the unit of a column that says none."""
        return {
            "time": self.time,
            "length": self.length,
            "velocity": f"{self.length}/s",
            "angular velocity": f"{self.angles}/s",
            "angle": self.angles,
        }.get(kind or "", "")


def read(data: Any, system: RollingSystem, conventions: Conventions) -> ExternalTrajectory:
    """Read a trajectory from whatever it comes in.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), tr.Support(tr.Plane()))
    >>> t = np.linspace(0.0, 1.0, 20)
    >>> read({"t": t, "x": t, "y": 0 * t}, system, Conventions()).position[-1].tolist()
    [1.0, 0.0, 0.0]
    """
    source = ""
    if isinstance(data, (str, Path)):
        source, data = Path(data).name, open_file(Path(data), conventions.columns)
    elif hasattr(data, "samples") and hasattr(data, "in_frame"):  # a Trajectory
        source, data = data.title, data.data
    lines: tuple[int, ...] = ()
    if isinstance(data, Table):
        data, lines = data.columns, data.lines
    elif hasattr(data, "data_vars"):
        conventions = _told(data, conventions)
        data = _variables(data)
    elif hasattr(data, "columns"):
        data = {str(name): data[name].to_numpy() for name in data.columns}
    if not isinstance(data, Mapping):
        raise InvalidValueError(
            "data", "must be a file, a table, a dataset or a mapping from names to arrays", type(data).__name__
        )
    headings = [str(name) for name in data]
    table = _flat(data, conventions)
    found = names.recognise(name for name in table if name not in conventions.columns.values())
    found |= names.mapped(conventions.columns, table)
    table, remarks = whole_rows(table, [heading for heading, _ in found.values()], lines)
    theirs = _in_space(_arrays(table, found, conventions, headings), system, conventions)
    return replace(theirs, source=source, remarks=remarks)


def _told(data: Any, conventions: Conventions) -> Conventions:
    """Take the frame from a file of trundle's own."""
    frame = data.attrs.get("frame", conventions.frame)
    return replace(conventions, frame=str(frame)) if frame in frames.FRAMES else conventions


def _variables(data: Any) -> dict[str, Any]:
    """Return the variables of a dataset by name, with a unit in brackets where an attribute says one."""
    found = {}
    for name in [*data.coords, *data.data_vars]:
        variable = data[name]
        if variable.dtype.kind not in "iuf":
            continue
        unit = str(variable.attrs.get("units", ""))
        unit = re.sub(r"\s+([a-z]+)-(\d)", r"/\1^\2", unit).replace("^1", "")  # "m s-1", as CF has it
        labelled = f"{name} [{unit}]" if unit else str(name)
        found[labelled] = variable.values
    return found


def _flat(data: Mapping[str, Any], conventions: Conventions) -> dict[str, Array]:
    """Return one-dimensional columns: arrays of vectors come apart under trundle's names."""
    parts = {"xyz": "xyz", "v": "xyz", "w": "xyz", "q": conventions.quaternion}
    whole = {name: key for key, several in _ARRAYS.items() for name in several if key != "t"}
    table: dict[str, Array] = {}
    for name, values in data.items():
        try:
            array = np.asarray(values, dtype=float)
        except (TypeError, ValueError):
            array = np.asarray(values, dtype=object)  # text: to be refused where a number is needed
        if array.ndim == 1:
            table[str(name)] = array
            continue
        bare, unit = names.apart(str(name))
        if bare not in whole or array.dtype == object:
            continue
        key, behind = whole[bare], f" [{unit}]" if unit else ""
        if array.ndim == 2:
            if array.shape[1] not in ((2, 3) if key == "xyz" else (len(parts[key]),)):
                raise InvalidValueError(
                    str(name), f"must have the shape (n, {len(parts[key])})", f"the shape {array.shape}"
                )
            stem = "" if key == "xyz" else key
            columns = zip(range(array.shape[1]), parts[key], strict=False)
            table |= {f"{stem}{part}{behind}": array[:, i] for i, part in columns}
        elif array.ndim == 3 and array.shape[1:] == (3, 3):
            table |= {f"r{i + 1}{j + 1}": array[:, i, j] for i in range(3) for j in range(3)}
    return _numbered(table, conventions)


def _numbered(table: dict[str, Array], conventions: Conventions) -> dict[str, Array]:
    """Name the columns q0 to q3, or q1 to q4, by the order of the quaternion."""
    small = {name.lower().replace("_", ""): name for name in table}
    for stem in ("q", "quat"):
        for numbers in ("0123", "1234"):
            if all(f"{stem}{number}" in small for number in numbers):
                renamed = {small[f"{stem}{n}"]: f"q{p}" for n, p in zip(numbers, conventions.quaternion, strict=True)}
                return {renamed.get(name, name): array for name, array in table.items()}
    return table


def _arrays(
    table: dict[str, Array], found: dict[str, tuple[str, str]], conventions: Conventions, headings: list[str]
) -> ExternalTrajectory:
    columns = {}
    for column, (heading, unit) in found.items():
        kind = names.kind_of(column)
        columns[column] = table[heading] * names.factor(unit or conventions.unit(kind), kind, f"unit of {heading}")
    missing = [column for column in ("t", "x", "y") if column not in columns]
    if missing:
        raise InvalidValueError(
            "columns",
            "must hold time and position",
            f"no column for {', '.join(missing)} among {', '.join(headings)}",
            f"Name them: columns {missing[0]}=HEADING.",
        )
    sizes = {column: array.size for column, array in columns.items()}
    if len(set(sizes.values())) > 1:
        raise InvalidValueError("columns", "must be of one length", sizes)
    height = "z" in columns
    z = columns["z"] if height else np.zeros_like(columns["x"])
    if "vx" in columns and "vy" in columns and "vz" not in columns:
        columns["vz"] = np.zeros_like(columns["vx"])
    return ExternalTrajectory(
        columns["t"],
        np.column_stack([columns["x"], columns["y"], z]),
        _together(columns, ("vx", "vy", "vz")),
        _together(columns, ("wx", "wy", "wz")),
        _orientation(columns, conventions),
        height,
    )


def _together(columns: dict[str, Array], wanted: tuple[str, ...]) -> Array | None:
    have = [name for name in wanted if name in columns]
    if have and len(have) < len(wanted):
        lacking = ", ".join(name for name in wanted if name not in columns)
        raise InvalidValueError("columns", f"must hold all of {', '.join(wanted)}", f"no {lacking}")
    return np.column_stack([columns[name] for name in wanted]) if have else None


def _orientation(columns: dict[str, Array], conventions: Conventions) -> Array | None:
    """Return quaternions from quaternions, rotation matrices or Euler angles, whichever there is."""
    q = _together(columns, ("qw", "qx", "qy", "qz"))
    matrix = _together(columns, tuple(f"r{i}{j}" for i in "123" for j in "123"))
    angles = _together(columns, ("e1", "e2", "e3"))
    if q is None:
        from scipy.spatial.transform import Rotation

        if matrix is not None:
            q = Rotation.from_matrix(matrix.reshape(-1, 3, 3)).as_quat(scalar_first=True)
        elif angles is not None:
            q = Rotation.from_euler(conventions.euler, angles).as_quat(scalar_first=True)
    if q is not None and conventions.orientation == "space-to-body":
        q = q * [1.0, -1.0, -1.0, -1.0]
    return q


def _in_space(theirs: ExternalTrajectory, system: RollingSystem, conventions: Conventions) -> ExternalTrajectory:
    if conventions.axes == "body" and theirs.angular_velocity is not None:
        if theirs.orientation is None:
            raise InvalidValueError(
                "axes",
                "must be space axes where there is no orientation",
                "body",
                "Add qw, qx, qy, qz; or leave it out, and the check finds the axes by how the ball rolls.",
            )
        Q = Quaternion.of(theirs.orientation).matrix()
        theirs = replace(theirs, angular_velocity=(Q @ Vector.of(theirs.angular_velocity)).array())
    if conventions.frame == "support":
        return theirs
    return from_frame(theirs, system, conventions.frame)


def from_frame(theirs: ExternalTrajectory, system: RollingSystem, frame: str) -> ExternalTrajectory:
    """Return the same motion in the support frame.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(np.pi))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), table)
    >>> still = ExternalTrajectory(np.array([0.0, 1.0]), np.array([[1.0, 0.0, 0.5], [1.0, 0.0, 0.5]]))
    >>> np.round(from_frame(still, system, "corotating").position[1], 12).tolist()
    [-1.0, 0.0, 0.5]
    """
    import xarray

    vectors = ("position", "velocity", "angular_velocity")
    n = theirs.time.size
    whole = {name: getattr(theirs, name) if getattr(theirs, name) is not None else np.zeros((n, 3)) for name in vectors}
    q = theirs.orientation if theirs.orientation is not None else np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
    data = xarray.Dataset(
        {name: (("time", "axis"), array) for name, array in whole.items()}
        | {"orientation": (("time", "quaternion"), q)},
        coords={"time": theirs.time},
    )
    moved = frames.change(data, system.support, frame, "support")
    given: dict[str, Any] = {
        name: moved[name].values for name in (*vectors, "orientation") if getattr(theirs, name) is not None
    }
    return replace(theirs, **given)
