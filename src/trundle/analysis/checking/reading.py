"""Somebody else's file, table or arrays, read to labelled arrays in the inertial support frame and SI units."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...errors import InvalidValueError, UnknownNameError
from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.system import RollingSystem
from ...solve import frames
from ...tracks import Track, read_track
from .record import Array, ExternalTrajectory
from .rows import whole_rows

_OTHER_POINTS = ("angle", "mark_", "spot_")  # what a track may hold beside the motion of the centre
AXES, ORDERS, DIRECTIONS = ("space", "body"), ("wxyz", "xyzw"), ("body-to-space", "space-to-body")


@dataclass(frozen=True)
class Conventions:
    """How their numbers are to be read.

    Examples
    --------
    >>> Conventions(angles="deg").angles
    'deg'
    """

    # trundle's name (t, x, y, z, vx, ..., wx, ..., qw, ...) -> their heading, where the name alone does not tell
    columns: Mapping[str, str] = field(default_factory=dict)
    axes: str = "space"  # "space": Ω has its components along the axes of the frame; "body": along those of the body
    angles: str = "rad"  # unit of angles, "rad" or "deg"; rates per second
    # order of the parts, "wxyz" or "xyzw"; matters where columns are numbered or come as one array
    quaternion: str = "wxyz"
    orientation: str = "body-to-space"  # "body-to-space", or "space-to-body" for the inverse
    # for columns e1, e2, e3: the axes, as SciPy has them: "xyz" about fixed axes, "ZXZ" about those of the body
    euler: str = "xyz"
    frame: str = "support"  # one of `trundle.solve.frames.FRAMES`
    time: str = "s"  # its unit, where the heading has none
    length: str = "m"  # the same

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


def read(data: Any, system: RollingSystem, conventions: Conventions) -> ExternalTrajectory:
    """Read a trajectory from whatever it comes in; a row that is wrong is refused, and one that is empty left out.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), tr.Support(tr.Plane()))
    >>> t = np.linspace(0.0, 1.0, 20)
    >>> read({"t": t, "x": t, "y": 0 * t}, system, Conventions()).position[-1].tolist()
    [1.0, 0.0, 0.0]
    """
    track = read_track(
        data,
        columns=conventions.columns,
        units={"time": conventions.time, "length": conventions.length, "angle": conventions.angles},
        frame=conventions.frame,
        axes=conventions.axes,
        quaternion=conventions.quaternion,
    )
    wrong = next((one.error for one in track.rejected if one.error is not None), None)
    if wrong is not None:
        raise wrong
    columns, remarks = whole_rows(track, [name for name in track.columns if not name.startswith(_OTHER_POINTS)])
    theirs = _arrays(columns, conventions, track)
    theirs = _in_space(theirs) if track.axes == "body" and theirs.angular_velocity is not None else theirs
    theirs = theirs if track.frame == "support" else from_frame(theirs, system, track.frame)
    return replace(theirs, source=track.source, remarks=remarks)


def _arrays(columns: dict[str, Array], conventions: Conventions, track: Track) -> ExternalTrajectory:
    missing = [column for column in ("t", "x", "y") if column not in columns]
    if missing:
        raise InvalidValueError(
            "columns",
            "must hold time and position",
            f"no column for {', '.join(missing)} among {', '.join([*columns, *track.left_out])}",
            f"Name them: --columns '{missing[0]}=HEADING'.",
        )
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


def _in_space(theirs: ExternalTrajectory) -> ExternalTrajectory:
    """Turn an Ω along the axes of the body to those of space."""
    if theirs.orientation is None:
        raise InvalidValueError(
            "axes",
            "must be space axes where there is no orientation",
            "body",
            "Add qw, qx, qy, qz; or leave it out, and the check finds the axes by how the ball rolls.",
        )
    Q = Quaternion.of(theirs.orientation).matrix()
    return replace(theirs, angular_velocity=(Q @ Vector.of(theirs.angular_velocity)).array())


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
