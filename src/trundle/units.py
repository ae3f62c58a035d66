"""Units at the edges: "33.3 rpm", "3 deg" and pint quantities become SI floats; inside, all is SI."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from fractions import Fraction
from functools import cache, lru_cache
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
    "quadratic damping": ("kg/m", "0.001 kg/m"),
    "rotational damping": ("N*m*s", "1e-5 N*m*s"),
    "density": ("kg/m^3", "7.8 g/cm^3"),
    "number": ("", "0.4"),
}

# The units that a page offers for each of them, the SI unit first, and how many SI units each is.
OFFERED: dict[str, dict[str, float]] = {
    "length": {"m": 1.0, "cm": 0.01, "mm": 1e-3, "in": 0.0254, "ft": 0.3048},
    "mass": {"kg": 1.0, "g": 1e-3, "oz": 0.028349523125, "lb": 0.45359237},
    "time": {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0},
    "angle": {"rad": 1.0, "deg": math.pi / 180, "turn": 2 * math.pi},
    "velocity": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 1e-3, "km/h": 1 / 3.6, "ft/s": 0.3048},
    "acceleration": {"m/s^2": 1.0, "cm/s^2": 0.01},
    "angular velocity": {"rad/s": 1.0, "rpm": math.pi / 30, "turn/s": 2 * math.pi, "deg/s": math.pi / 180},
    "force": {"N": 1.0, "mN": 1e-3},
    "torque": {"N*m": 1.0, "mN*m": 1e-3},
    "inertia": {"kg*m^2": 1.0, "g*m^2": 1e-3, "mg*m^2": 1e-6, "g*cm^2": 1e-7},
    "damping": {"kg/s": 1.0, "g/s": 1e-3},
    "quadratic damping": {"kg/m": 1.0, "g/m": 1e-3},
    "rotational damping": {"N*m*s": 1.0, "mN*m*s": 1e-3},
    "density": {"kg/m^3": 1.0, "g/cm^3": 1e3},
    "number": {"": 1.0},
}

_LONGEST = 200
_NUMBER = re.compile(
    r"([+-]?(?:\d+(?:_\d+)*(?:\.(?:\d+(?:_\d+)*)?)?|\.\d+(?:_\d+)*)(?:[eE][+-]?\d{1,4})?"
    r"|[+-]?(?:nan|inf(?:inity)?)(?![a-z]))\s*(\D.*)?",
    re.DOTALL | re.ASCII | re.IGNORECASE,
)
_PLUS_MINUS = re.compile(r"±|\+/-|\+-")
_SPAN = re.compile(r"\.\.")
_UNIT = re.compile(r"[A-Za-z°µμΩ%²³·/*^() \-\d]{0,40}")
_LARGE_POWER = re.compile(r"\d{2,}|(?:\^|\*\*)[^0-9-]*-?\d{2,}|(?:\^|\*\*).*(?:\^|\*\*).*(?:\^|\*\*)")


def to_si(value: Any, kind: str, key: str) -> Any:
    """Turn a number, a text with a unit or a pint quantity into SI.

    A bare number is SI already; a text has a unit, except for what has no dimension: "45" might be rad/s or rpm, and
    "0.3" can only be 0.3. Arrays and symbolic scalars pass through unchanged. A text in metres, grams,
    seconds, newtons, joules, degrees, turns or rpm (with the usual prefixes, products and powers) is
    converted exactly and rounded once: "35 mm" is the float 0.035. Other units are pint's to convert.

    Examples
    --------
    >>> to_si("35 mm", "length", "radius")
    0.035
    >>> round(to_si("33.3 rpm", "angular velocity", "rate"), 6)
    3.487168
    """
    if isinstance(value, str):
        return finite(_from_text(value, kind, key), key, value)
    if isinstance(value, bool) or not hasattr(value, "__neg__"):  # nothing, a list, a table: no kind of number
        raise InvalidValueError(key, _must_be(kind), value, _example(kind))
    if isinstance(value, (int, float)):
        return finite(_as_float(value, key), key, value)
    if hasattr(value, "to") and hasattr(value, "magnitude"):
        return finite(_convert(value, kind, key, value), key, value)
    return value


def plus_minus(text: str) -> tuple[str, str] | None:
    """Return the two parts of "33.3 ± 0.3 rpm", a unit that stands once with both; None where it is written otherwise.

    Examples
    --------
    >>> plus_minus("33.3 ± 0.3 rpm"), plus_minus("33.3 rpm +- 0.3"), plus_minus("33.3 rpm")
    (('33.3 rpm', '0.3 rpm'), ('33.3 rpm', '0.3 rpm'), None)
    """
    return _two(text, _PLUS_MINUS)


def span(text: str) -> tuple[str, str] | None:
    """Return the two ends of "1..3 cm", a unit that stands once with both; None where it is written otherwise.

    Examples
    --------
    >>> span("1..3 cm"), span("5 mm..3 cm"), span("1 cm")
    (('1 cm', '3 cm'), ('5 mm', '3 cm'), None)
    """
    return _two(text, _SPAN)


def sharing_unit(texts: Sequence[str]) -> list[str]:
    """Return numbers as text, those without a unit with that of the others, where these have but one.

    Examples
    --------
    >>> sharing_unit(["1", "3 deg"]), sharing_unit(["1", "3 deg", "1 rad"]), sharing_unit(["1", "2"])
    (['1 deg', '3 deg'], ['1', '3 deg', '1 rad'], ['1', '2'])
    """
    found = [_NUMBER.fullmatch(text.strip()) for text in texts]
    units = {(match[2] or "").strip() for match in found if match} - {""}
    if len(units) != 1 or not all(found):
        return list(texts)
    unit = units.pop()
    return [text if match and match[2] else f"{text.strip()} {unit}" for text, match in zip(texts, found, strict=True)]


def finite(number: Any, key: str, received: Any) -> Any:
    """Return the number if it is finite; raise `InvalidValueError` under the name `key` if it is not.

    Examples
    --------
    >>> finite(1.0, "radius", "1 m")
    1.0
    """
    if isinstance(number, float) and not math.isfinite(number):
        raise InvalidValueError(key, "must be a finite number", received, "NaN and infinities are refused.")
    return number


def _must_be(kind: str) -> str:
    return f"must be {'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def _example(kind: str) -> str:
    unit, example = UNITS[kind]
    bare = f"or a bare number in {unit}." if unit else "a bare number."
    return f"Write for instance '{example}', {bare}"


def _with_units(kind: str, digits: str) -> str:
    """Say how a number that came as text without a unit may be written."""
    unit, example = UNITS[kind]
    if not float(digits) > 0:  # which may be refused with a unit, too
        return f"Write its unit behind it, as in '{example}'."
    offered = dict.fromkeys([unit, example.partition(" ")[2]])
    quoted = ", ".join(f"'{digits} {one}'" for one in offered)
    return f"Write {quoted} or, in a file or in Python, the bare number {digits}, which is in {unit}."


def _two(text: str, between: re.Pattern[str]) -> tuple[str, str] | None:
    """Return the two parts of a text, a unit that stands with one of them with both."""
    parts = [part.strip() for part in between.split(text)]
    if len(parts) != 2 or not all(parts):
        return None
    first, second = sharing_unit(parts)
    return first, second


def _as_float(value: int | float, key: str) -> float:
    try:
        return float(value)
    except OverflowError:
        raise InvalidValueError(key, "must be a finite number", "an integer beyond 1e308") from None


@lru_cache(maxsize=1000)  # while one number is tried out, the others of its file stay
def _from_text(text: str, kind: str, key: str) -> float:
    plain = text.replace("\u2212", "-").replace("\u00a0", " ").strip()
    match = _NUMBER.fullmatch(plain) if len(plain) <= _LONGEST else None
    if match is None or not _UNIT.fullmatch(match[2] or "") or _LARGE_POWER.search(match[2] or ""):
        comma = re.fullmatch(r"[+-]?\d+,\d+.*", plain, re.DOTALL)
        hint = "A decimal point, not a comma." if comma else _example(kind)
        raise InvalidValueError(key, _must_be(kind), text, hint)
    unit = (match[2] or "").strip()
    unit = "1" + unit if unit.startswith("/") else unit  # "3/s" is "3 1/s"
    number = float(match[1])
    if not math.isfinite(number):
        return number
    if not unit:
        if UNITS[kind][0]:
            raise InvalidValueError(key, f"{_must_be(kind)} with its unit", text, _with_units(kind, match[1]))
        return number
    factor = _exact_factor(unit)
    if factor is None:
        return _through_pint(number, unit, kind, key, text)
    if not _same_dimension(factor[1], kind):
        raise InvalidValueError(key, _must_be(kind), text, _example(kind))
    try:
        return float(Fraction(match[1]) * factor[0])
    except OverflowError:
        return math.inf


# --- the common units, exactly --------------------------------------------------------------------------
# A unit is a factor to SI and the powers of (metre, kilogram, second, radian).

_Unit = tuple[Fraction, tuple[int, int, int, int]]
_PI = Fraction("3.14159265358979323846264338327950288419716939937510")
_NAMED: dict[str, _Unit] = {
    "1": (Fraction(1), (0, 0, 0, 0)),
    "m": (Fraction(1), (1, 0, 0, 0)),
    "g": (Fraction(1, 1000), (0, 1, 0, 0)),
    "s": (Fraction(1), (0, 0, 1, 0)),
    "min": (Fraction(60), (0, 0, 1, 0)),
    "h": (Fraction(3600), (0, 0, 1, 0)),
    "rad": (Fraction(1), (0, 0, 0, 1)),
    "deg": (_PI / 180, (0, 0, 0, 1)),
    "°": (_PI / 180, (0, 0, 0, 1)),
    "turn": (2 * _PI, (0, 0, 0, 1)),
    "rev": (2 * _PI, (0, 0, 0, 1)),
    "rpm": (_PI / 30, (0, 0, -1, 1)),
    "N": (Fraction(1), (1, 1, -2, 0)),
    "J": (Fraction(1), (2, 1, -2, 0)),
}
_PREFIXES = {
    "M": Fraction(10**6),
    "k": Fraction(10**3),
    "d": Fraction(1, 10),
    "c": Fraction(1, 100),
    "m": Fraction(1, 10**3),
    "µ": Fraction(1, 10**6),
    "μ": Fraction(1, 10**6),
    "u": Fraction(1, 10**6),
    "n": Fraction(1, 10**9),
}
_TAKES_PREFIX = ("m", "g", "s", "rad", "N", "J")
_FACTOR = re.compile(r"([A-Za-zµμ°]+|1(?=\s*/))(?:(?:\^|\*\*)(-?\d)|([²³]))?")
_OPERATOR = re.compile(r"\s*(/|\*(?!\*)|·)\s*|\s+")
_POWER = {None: 1, "²": 2, "³": 3}


@cache
def _exact_factor(text: str) -> _Unit | None:
    """Read a product of common units; None where pint must (another unit, brackets, "a/b c")."""
    factor, powers, position, sign = Fraction(1), [0, 0, 0, 0], 0, 1
    while True:
        match = _FACTOR.match(text, position)
        unit = _common_unit(match[1]) if match else None
        if match is None or unit is None:
            return None
        power = sign * (int(match[2]) if match[2] else _POWER[match[3]])
        factor *= unit[0] ** power
        powers = [have + power * more for have, more in zip(powers, unit[1], strict=True)]
        position = match.end()
        if position == len(text):
            return factor, (powers[0], powers[1], powers[2], powers[3])
        operator = _OPERATOR.match(text, position)
        if operator is None or (operator[1] is None and "/" in text[:position]):
            return None
        sign = -1 if operator[1] == "/" else 1
        position = operator.end()


def _common_unit(symbol: str) -> _Unit | None:
    if symbol in _NAMED:
        return _NAMED[symbol]
    if symbol[0] in _PREFIXES and symbol[1:] in _TAKES_PREFIX:
        factor, powers = _NAMED[symbol[1:]]
        return _PREFIXES[symbol[0]] * factor, powers
    return None


def _same_dimension(powers: tuple[int, int, int, int], kind: str) -> bool:
    if kind == "angular velocity" and powers == (0, 0, -1, 0):
        return True  # 1/s: the radian is often left out
    wanted = _exact_factor(UNITS[kind][0])
    return powers == (wanted[1] if wanted else (0, 0, 0, 0))


# --- every other unit, through pint ---------------------------------------------------------------------


def _through_pint(number: float, unit: str, kind: str, key: str, text: str) -> float:
    registry = unit_registry()
    try:
        quantity = registry.Quantity(number, registry.parse_units(unit))
    except Exception:  # noqa: BLE001  pint raises a dozen kinds for a malformed unit; all mean the same to the reader
        raise InvalidValueError(key, "has an unknown unit", text, _example(kind)) from None
    return _convert(quantity, kind, key, text)


def _convert(quantity: Any, kind: str, key: str, received: Any) -> Any:
    try:
        hint = _angle_trap(quantity, kind)
        converted = quantity.to(UNITS[kind][0] or "dimensionless").magnitude
    except Exception:  # noqa: BLE001  as above: dimension, offset unit, overflow
        raise InvalidValueError(key, _must_be(kind), str(received), _example(kind)) from None
    if hint:
        raise InvalidValueError(key, _must_be(kind), str(received), hint)
    return float(converted) if isinstance(converted, (int, float)) else converted


def _angle_trap(quantity: Any, kind: str) -> str:
    """Say what is wrong with a unit that pint takes because to it an angle is a plain number."""
    units = {name for name, _ in quantity.unit_items()}
    root = dict(quantity.to_root_units().unit_items())
    per_time = all(name.endswith(_TIMES) for name in units)  # 1/s: the radian is often left out
    if kind == "angular velocity" and "radian" not in root and not per_time:
        return "A frequency counts turns: write '0.5 turn/s', '30 rpm' or '3.14 rad/s'."
    if kind == "angle" and units and root != {"radian": 1}:
        return _example(kind)
    if kind == "number" and root:
        return _example(kind)
    return ""


_TIMES = ("second", "minute", "hour", "day")


@cache
def unit_registry() -> Any:
    """Return trundle's pint registry, made on first use (pint keeps its definitions in the user's cache).

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
