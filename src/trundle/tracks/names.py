"""What columns may be called, and the units that a heading may carry."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from ..errors import InvalidValueError, UnknownNameError
from ..units import OFFERED, to_si

# The columns as trundle calls them, and the other names that people give them (compared in small letters).
_VECTOR = {
    "": ("", "pos_", "position_", "p", "r", "com_", "centre_", "center_", "r_", "p_"),
    "v": ("v", "v_", "vel_", "velocity_", "d", "lin_vel_", "vcom_"),
    "w": ("w", "w_", "omega", "omega_", "angular_velocity_", "ang_vel_", "angvel_", "avel_", "gyro_", "gyroscope_"),
}
_QUATERNION = ("q", "q_", "quat_", "quaternion_", "orientation_", "rot_", "ori_")
ALIASES: dict[str, tuple[str, ...]] = {
    "t": ("t", "time", "times", "timestamp", "sec", "seconds", "sim_time", "zeit", "temps", "tiempo", "tempo"),
    "frame": ("frame", "frames", "frame_number", "frame_index", "frame_idx"),
    "angle": ("angle", "theta", "phi"),
    # A mark on the table, and a spot on the body, beside the centre of it.
    **{f"{point}_{axis}": (f"{point}_{axis}", f"{point}{axis}") for point in ("mark", "spot") for axis in "xyz"},
    **{f"{key}{axis}": tuple(f"{name}{axis}" for name in names) for key, names in _VECTOR.items() for axis in "xyz"},
    **{f"q{part}": tuple(f"{name}{part}" for name in _QUATERNION) for part in "wxyz"},
    "e1": ("e1", "euler1", "euler_1", "roll"),
    "e2": ("e2", "euler2", "euler_2", "pitch"),
    "e3": ("e3", "euler3", "euler_3", "yaw"),
    **{f"r{i}{j}": (f"r{i}{j}", f"r_{i}{j}", f"q{i}{j}", f"m{i}{j}") for i in "123" for j in "123"},
}
for _axis in "xyz":  # written the other way round: xdot, x_dot, x_velocity
    ALIASES[f"v{_axis}"] += (f"{_axis}dot", f"{_axis}_dot", f"d{_axis}_dt", f"d{_axis}dt", f"d{_axis}/dt")
    ALIASES[f"v{_axis}"] += (f"{_axis}_velocity",)
    ALIASES[_axis] += (f"{_axis}_position",)

_KINDS = {
    "t": "time",
    **dict.fromkeys(("x", "y", "z", *(name for name in ALIASES if name[:5] in ("mark_", "spot_"))), "length"),
    **dict.fromkeys(("vx", "vy", "vz"), "velocity"),
    **dict.fromkeys(("wx", "wy", "wz"), "angular velocity"),
    **dict.fromkeys(("e1", "e2", "e3", "angle"), "angle"),
}
PIXELS, FRAMES = ("px", "pixel", "pixels", "pix"), ("frame", "frames")
_WRITTEN = {"deg.": "deg", "degrees": "deg", "degree": "deg", "sec": "s", "seconds": "s", "metres": "m", "meters": "m"}
_UNITS = {unit for units in OFFERED.values() for unit in units} | {*PIXELS, *FRAMES, *_WRITTEN, "°", "°/s", "us", "µs"}
_BRACKETS = re.compile(r"^(.*?)\s*[\[(]\s*([^\])]*)\s*[\])]\s*$")
_SUFFIXES = {
    "_ms": {"time": "ms", "velocity": "m/s"},
    "_us": {"time": "us"},
    "_s": {"time": "s"},
    "_mm": {"length": "mm"},
    "_cm": {"length": "cm"},
    "_m": {"length": "m"},
    "_mm_s": {"velocity": "mm/s"},
    "_cm_s": {"velocity": "cm/s"},
    "_m_s": {"velocity": "m/s"},
    "_mps": {"velocity": "m/s"},
    "_rad_s": {"angular velocity": "rad/s"},
    "_radps": {"angular velocity": "rad/s"},
    "_deg_s": {"angular velocity": "deg/s"},
    "_dps": {"angular velocity": "deg/s"},
    "_rpm": {"angular velocity": "rpm"},
    "_rad": {"angle": "rad", "angular velocity": "rad/s"},
    "_deg": {"angle": "deg", "angular velocity": "deg/s"},
}


_GREEK = {"Ω": "omega", "ω": "omega", "θ": "theta", "φ": "phi", "ϕ": "phi"}


def is_unit(text: str) -> bool:
    """Tell whether a word is a unit that measured tracks come in.

    Examples
    --------
    >>> is_unit("cm"), is_unit("px"), is_unit("x")
    (True, True, False)
    """
    return text.strip() in _UNITS


def kind_of(column: str) -> str | None:
    """Return the kind of quantity that a column of trundle's name holds; None for a plain number.

    Examples
    --------
    >>> kind_of("wx"), kind_of("x"), kind_of("qw")
    ('angular velocity', 'length', None)
    """
    return _KINDS.get(column)


def recognise(headings: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Find trundle's columns among the headings of a file.

    Examples
    --------
    >>> recognise(["time (ms)", "pos_x", "Omega_z [deg/s]", "comment"])
    {'t': ('time (ms)', 'ms'), 'x': ('pos_x', ''), 'wz': ('Omega_z [deg/s]', 'deg/s')}
    """
    known = {alias: column for column, names in ALIASES.items() for alias in names}
    found: dict[str, tuple[str, str]] = {}
    for heading in headings:
        name, unit = _split(str(heading), known)
        column = known.get(name)
        if column is None:
            continue
        if column in found:
            raise InvalidValueError(
                "columns",
                f"must name one column each; two could be `{column}`",
                f"{found[column][0]!r} and {heading!r}",
                f"Say which: --columns '{column}={heading}'.",
            )
        found[column] = (str(heading), unit)
    return found


def apart(heading: str) -> tuple[str, str]:
    """Return a heading and the unit behind it, in brackets or, as ISO 80000 has it, after a stroke.

    Examples
    --------
    >>> apart("x [mm]"), apart("x"), apart("x/mm"), apart("vx/(m/s)"), apart("dx/dt")
    (('x', 'mm'), ('x', ''), ('x', 'mm'), ('vx', 'm/s'), ('dx/dt', ''))
    """
    heading = heading.strip()
    if bracketed := _BRACKETS.match(heading):
        return bracketed[1].removesuffix("/").rstrip(), bracketed[2]
    name, _, unit = (part.strip() for part in heading.partition("/"))
    return (name, unit) if name and is_unit(unit) else (heading, "")


def _split(heading: str, known: Mapping[str, str]) -> tuple[str, str]:
    """Return the name in small letters, and the unit that stands behind it."""
    name, unit = apart(heading)
    for greek, spelled in _GREEK.items():
        name = name.replace(greek, spelled)
    name = re.sub(r"[\s.]+", "_", name.strip()).lower()
    if name in known or unit:
        return name, unit
    for suffix, units in sorted(_SUFFIXES.items(), key=lambda item: -len(item[0])):
        stem = name.removesuffix(suffix)
        kind = kind_of(known[stem]) if stem != name and stem in known else None
        if kind in units:
            return stem, units[kind]
    return name, ""


def numbered_quaternion(headings: Iterable[str], order: str) -> dict[str, str]:
    """Return the parts of a quaternion among headings such as q0 to q3, or q1 to q4, by their order.

    Examples
    --------
    >>> numbered_quaternion(["t", "q1", "q2", "q3", "q4"], "xyzw")
    {'qx': 'q1', 'qy': 'q2', 'qz': 'q3', 'qw': 'q4'}
    """
    small = {heading.lower().replace("_", ""): heading for heading in headings}
    for stem in ("q", "quat"):
        for numbers in ("0123", "1234"):
            if all(f"{stem}{number}" in small for number in numbers):
                return {f"q{part}": small[f"{stem}{n}"] for n, part in zip(numbers, order, strict=True)}
    return {}


def mapped(columns: Mapping[str, str], headings: Iterable[str]) -> dict[str, tuple[str, str]]:
    """Check the columns that a user named.

    Examples
    --------
    >>> mapped({"t": "frame (ms)"}, ["frame (ms)", "u", "v"])
    {'t': ('frame (ms)', 'ms')}
    """
    headings, found = [str(heading) for heading in headings], {}
    for column, heading in columns.items():
        if column not in ALIASES:
            raise UnknownNameError("column of trundle's", str(column), list(ALIASES)[:17])
        if heading not in headings:
            raise UnknownNameError("column of the file", str(heading), headings)
        found[column] = (heading, apart(heading)[1])
    return found


def factor(unit: str, kind: str | None, key: str) -> float:
    """Return what a column must be multiplied with to be in SI.

    Examples
    --------
    >>> factor("ms", "time", "t"), round(factor("deg/s", "angular velocity", "wx"), 9)
    (0.001, 0.017453293)
    """
    plain = _WRITTEN.get(unit.strip(), unit.strip())
    if not plain or kind is None or plain in ("1", "-"):
        return 1.0
    return float(to_si(f"1 {plain}", kind, key))
