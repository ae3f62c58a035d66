"""Units at the edges: "33.3 rpm", "25 mm", "3 deg" and pint quantities become SI floats; inside, all is SI."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Any

from .errors import InvalidValueError

# The SI unit of each kind of quantity that trundle reads, and an example for error messages.
UNITS: dict[str, tuple[str, str]] = {
    "length": ("m", "25 mm"),
    "mass": ("kg", "65 g"),
    "time": ("s", "60 s"),
    "angle": ("rad", "3 deg"),
    "velocity": ("m/s", "0.2 m/s"),
    "acceleration": ("m/s^2", "9.80665 m/s^2"),
    "angular velocity": ("rad/s", "33.3 rpm"),
    "force": ("N", "0.1 N"),
    "torque": ("N*m", "2 mN*m"),
    "inertia": ("kg*m^2", "1.6e-5 kg*m^2"),
    "damping": ("kg/s", "0.01 kg/s"),
    "number": ("", "0.4"),
}

_NUMBER = re.compile(r"\s*([+-]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?|[+-]?(?:nan|inf(?:inity)?))(?![\w.])?\s*(.*)", re.DOTALL)
_UNIT = re.compile(r"[A-Za-z°µμΩ%²³·/*^() \-\d]{0,40}")
_LARGE_POWER = re.compile(r"\d{2,}|(?:\^|\*\*)[^0-9-]*-?\d{2,}")


def to_si(value: Any, kind: str, key: str) -> Any:
    """Turn a number, a text with a unit or a pint quantity into SI.

    A bare number is SI already. Arrays and symbolic scalars pass through unchanged.

    Parameters
    ----------
    value : float, str, pint.Quantity, array or symbolic scalar
        What the user gave.
    kind : str
        One of `UNITS`: the dimension that the value must have.
    key : str
        The name that an error message uses.

    Returns
    -------
    float, array or symbolic scalar
        The value in the SI unit of its kind, radians for angles.

    Raises
    ------
    InvalidValueError
        If the text is no quantity, the dimension is another, or the number is NaN or infinite.

    Examples
    --------
    >>> to_si("25 mm", "length", "radius")
    0.025
    >>> round(to_si("33.3 rpm", "angular velocity", "rate"), 6)
    3.487168
    """
    if isinstance(value, str):
        return finite(_from_text(value, kind, key), key, value)
    if isinstance(value, bool) or value is None:
        raise InvalidValueError(key, f"must be a {kind}", value, _example(kind))
    if isinstance(value, (int, float)):
        return finite(_as_float(value, key), key, value)
    if hasattr(value, "to") and hasattr(value, "magnitude"):
        return finite(_convert(value, kind, key, value), key, value)
    return value


def finite(number: Any, key: str, received: Any) -> Any:
    """Return the number if it is finite; raise `InvalidValueError` under the name `key` if it is not.

    Parameters
    ----------
    number : float or array
        The value to look at.
    key : str
        The name that an error message uses.
    received : object
        The value as the user wrote it, for the message.

    Returns
    -------
    float or array
        The same number.

    Examples
    --------
    >>> finite(1.0, "radius", "1 m")
    1.0
    """
    if isinstance(number, float) and not math.isfinite(number):
        raise InvalidValueError(key, "must be a finite number", received, "NaN and infinities are refused.")
    return number


def _example(kind: str) -> str:
    unit, example = UNITS[kind]
    return f"Write for instance '{example}'" + (f", or a bare number in {unit}." if unit else ", a bare number.")


def _as_float(value: int | float, key: str) -> float:
    try:
        return float(value)
    except OverflowError:
        raise InvalidValueError(key, "must be a finite number", "an integer beyond 1e308") from None


def _from_text(text: str, kind: str, key: str) -> float:
    match = _NUMBER.fullmatch(text)
    if match is None or not _UNIT.fullmatch(match[2]) or _LARGE_POWER.search(match[2]):
        raise InvalidValueError(key, f"must be a {kind}", text, _example(kind))
    number, unit = float(match[1]), match[2].strip()
    if not unit:
        return number
    registry = unit_registry()
    try:
        quantity = registry.Quantity(number, registry.parse_units(unit))
    except Exception:  # noqa: BLE001  pint raises a dozen kinds for a malformed unit; all mean the same to the reader
        raise InvalidValueError(key, "has an unknown unit", text, _example(kind)) from None
    return _convert(quantity, kind, key, text)


def _convert(quantity: Any, kind: str, key: str, received: Any) -> Any:
    unit = UNITS[kind][0]
    try:
        converted = quantity.to(unit or "dimensionless").magnitude
    except Exception:  # noqa: BLE001  as above: dimension, offset unit, overflow
        raise InvalidValueError(key, f"must be a {kind}", str(received), _example(kind)) from None
    return float(converted) if isinstance(converted, (int, float)) else converted


@cache
def unit_registry() -> Any:
    """Return trundle's pint registry, made on first use (pint keeps its parsed definitions in the user's cache).

    Returns
    -------
    pint.UnitRegistry
        The registry whose quantities every builder accepts.

    Examples
    --------
    >>> import trundle as tr
    >>> mm = tr.units.unit_registry().mm
    >>> tr.Body.solid_sphere(radius=25 * mm, mass=0.065).shape.radius
    0.025
    """
    import pint

    try:
        return pint.UnitRegistry(cache_folder=":auto:")
    except OSError:  # no writable cache folder: parse the definitions again
        return pint.UnitRegistry()
