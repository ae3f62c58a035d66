"""Checks on the numbers that a user hands to the mechanics; symbols and arrays pass unlooked at where they must."""

from __future__ import annotations

from typing import Any

from ..errors import InvalidValueError
from ..units import to_si
from .scalars import is_number


def real(value: Any, kind: str, key: str) -> Any:
    """Return a quantity in SI, any finite value allowed.

    Examples
    --------
    >>> real("3 deg", "angle", "tilt")
    0.05235987755982989
    """
    return to_si(value, kind, key)


def positive(value: Any, kind: str, key: str) -> Any:
    """Return a quantity in SI that must be above zero (each element of an array).

    Examples
    --------
    >>> positive("65 g", "mass", "mass")
    0.065
    """
    number = to_si(value, kind, key)
    if (is_number(number) and not number > 0) or (_is_numpy(number) and not (number > 0).all()):
        raise InvalidValueError(key, "must be positive", value, "Zero and negative values have no meaning here.")
    return number


def non_negative(value: Any, kind: str, key: str) -> Any:
    """Return a quantity in SI that must not be below zero (each element of an array).

    Examples
    --------
    >>> non_negative(0, "damping", "coefficient")
    0.0
    """
    number = to_si(value, kind, key)
    if (is_number(number) and not number >= 0) or (_is_numpy(number) and not (number >= 0).all()):
        raise InvalidValueError(key, "must not be negative", value)
    return number


def instance(value: Any, kind: type | tuple[type, ...], key: str, remedy: str) -> Any:
    """Return a part of a system if it is of the right kind.

    Examples
    --------
    >>> instance(3.0, float, "rate", "Give for instance 3.5.")
    3.0
    """
    if not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        raise InvalidValueError(key, f"must be a {' or '.join(k.__name__ for k in kinds)}", value, remedy)
    return value


def components(value: Any, kind: str, key: str, count: int = 3) -> tuple[Any, ...]:
    """Return the components of a vector in SI.

    Examples
    --------
    >>> components(["10 cm", 0], "length", "position", 2)
    (0.1, 0.0)
    """
    if hasattr(value, "to") and hasattr(value, "magnitude"):  # a pint quantity that holds an array
        value = list(value)
    try:
        parts = None if isinstance(value, (str, bytes)) else tuple(value)
    except TypeError:
        parts = None
    if parts is None or len(parts) != count:
        raise InvalidValueError(key, f"must be a list of {count} components", value, f"Each is a {kind}.")
    return tuple(to_si(part, kind, f"{key}[{i}]") for i, part in enumerate(parts))


def _is_numpy(value: Any) -> bool:
    return type(value).__module__ == "numpy" and hasattr(value, "all")
