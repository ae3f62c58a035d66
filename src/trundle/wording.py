"""Quantities as a reader reads them: in the unit that suits them, with few digits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

LONGEST = 34  # letters of a formula that are shown


@dataclass(frozen=True)
class Unit:
    """A unit that an axis is labelled in: its size in SI and its symbol."""

    scale: float
    symbol: str
    least: float = 1.0  # the least count of it for which it is taken

    def after(self, digits: str) -> str:
        """Return a number's digits with it behind them.

        Examples
        --------
        >>> Unit(1e-3, "mm").after("2.5"), Unit(1e-15, "10⁻¹⁵ m").after("2.5"), Unit(1.0, "").after("2.5")
        ('2.5 mm', '2.5·10⁻¹⁵ m', '2.5')
        """
        between = "" if self.symbol in ("", "°") else "·" if self.symbol.startswith("10") else " "
        return f"{digits}{between}{self.symbol}"


# Size in SI, symbol, and the least count of it for which it is taken; from large to small.
_Units = tuple[tuple[float, str, float], ...]
_LENGTHS: _Units = (
    (1e3, "km", 1.5),
    (1, "m", 2),
    (1e-2, "cm", 2),
    (1e-3, "mm", 1),
    (1e-6, "µm", 1),
    (1e-9, "nm", 1),
)
_TIMES: _Units = (
    (86400, "d", 3),
    (3600, "h", 3),
    (60, "min", 5),
    (1, "s", 0.1),
    (1e-3, "ms", 1),
    (1e-6, "µs", 1),
)
_UNITS: dict[str, _Units] = {
    "length": _LENGTHS,
    "speed": tuple((scale, f"{symbol}/s", least) for scale, symbol, least in _LENGTHS),
    "force": ((1e6, "MN", 2), (1e3, "kN", 2), (1, "N", 1), (1e-3, "mN", 1), (1e-6, "µN", 1), (1e-9, "nN", 1)),
    "time": _TIMES,
    "angular velocity": ((1, "rad/s", 0.01),),
    "torque": ((1, "N m", 1), (1e-3, "mN m", 1), (1e-6, "µN m", 1)),
    "damping": ((1, "kg/s", 0.5), (1e-3, "g/s", 0.5), (1e-6, "mg/s", 0.5)),
    "number": ((1, "", 5e-3),),
    "angle": ((math.pi / 180, "°", 1e-2),),
}
_SI = {
    "length": "m",
    "speed": "m/s",
    "force": "N",
    "time": "s",
    "angular velocity": "rad/s",
    "torque": "N m",
    "damping": "kg/s",
    "number": "",
    "angle": "rad",
}
_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def unit_for(size: float, kind: str) -> Unit:
    """Choose the unit in which a quantity of a given size reads shortest.

    Examples
    --------
    >>> unit_for(0.5, "length").symbol, unit_for(3.0, "length").symbol, unit_for(1e-15, "length").symbol
    ('cm', 'm', '10⁻¹⁵ m')
    """
    if not math.isfinite(size) or size <= 0.0:
        size = 1.0
    scale, symbol, _ = _UNITS[kind][0]
    if size < 2e4 * scale:
        for scale, symbol, least in _UNITS[kind]:
            if size >= least * scale * (1.0 - 1e-9):
                return Unit(scale, symbol)
    power = math.floor(math.log10(size) + 1e-9)
    return Unit(10.0**power, f"10{str(power).translate(_SUPERSCRIPT)} {_SI[kind]}".strip())


def units_of(kind: str) -> list[Unit]:
    """Return the units that `unit_for` chooses from, each with what counts as one; from large to small.

    Examples
    --------
    >>> [(unit.symbol, unit.least) for unit in units_of("angle")]
    [('°', 0.01)]
    """
    return [Unit(scale, symbol, least) for scale, symbol, least in _UNITS[kind]]


def with_unit(value: float, kind: str, digits: int = 3) -> str:
    """Write a value with the unit that suits it.

    Examples
    --------
    >>> with_unit(0.36804, "speed"), with_unit(0.025, "length")
    ('36.8 cm/s', '2.5 cm')
    """
    unit = unit_for(abs(value), kind)
    return unit.after(short(value / unit.scale, digits))


def small_length(size: Any) -> str:
    """Write a radius in millimetres where balls are sold by them.

    Examples
    --------
    >>> small_length(0.025), small_length(0.3)
    ('25 mm', '30 cm')
    """
    return f"{float(size) * 1e3:.4g} mm" if 1e-3 <= float(size) < 0.1 else length(size)


@lru_cache(maxsize=100)  # a ball's k is asked for again and again
def as_ratio(value: float) -> str:
    """Write a number as a simple fraction where it is one, else with four digits.

    Examples
    --------
    >>> as_ratio(0.4), as_ratio(2 / 3), as_ratio(0.37)
    ('2/5', '2/3', '0.37')
    """
    near = Fraction(value).limit_denominator(12)
    return str(near) if abs(float(near) - value) <= 1e-12 * abs(value) else short(value, 4)


def short(value: float, digits: int) -> str:
    """Write a number with so many significant digits, in typographer's signs.

    Examples
    --------
    >>> short(-1.5e-9, 3), short(1283.4, 3), short(33.3, 4)
    ('−1.5·10⁻⁹', '1283', '33.3')
    """
    text = f"{value:.{digits}g}"
    if "e" in text:
        mantissa, power = text.split("e")
        if 0 <= int(power) <= 4:
            text = f"{value:.0f}"
        else:
            exponent = f"10{str(int(power)).translate(_SUPERSCRIPT)}"
            text = exponent if mantissa == "1" else f"{mantissa}·{exponent}"
    return text.replace("-", "−")


def formula(value: Any, symbol: str, unit: str) -> str:
    """Write a number with its unit, or a formula in the time, each with its symbol.

    Examples
    --------
    >>> formula(2.0, "ω", "rad/s")
    'ω = 2 rad/s'
    """
    if hasattr(value, "text"):
        return f"{symbol}(t) = {cut(value.text)}"
    return f"{symbol} = {short(float(value), 4)} {unit}"


def cut(text: str) -> str:
    """Write a formula as a book does, as much of it as a line has room for.

    Examples
    --------
    >>> cut("2*r**2 - r")
    '2·r^2 − r'
    """
    tidy = text.replace("**", "^").replace("*", "·").replace("-", "−")
    return tidy if len(tidy) <= LONGEST else f"{tidy[: LONGEST - 1]}…"


def rate(value: Any) -> str:
    """Write a rate of turning, also by the minute.

    Examples
    --------
    >>> rate(3.0)
    '3 rad/s (28.65 rpm)'
    """
    per_minute = float(value) * 30 / math.pi
    text = f"{short(float(value), 4)} rad/s"
    return f"{text} ({short(per_minute, 4)} rpm)" if 0.1 <= abs(per_minute) < 1e5 else text


def degrees(angle: Any) -> str:
    """Write an angle in degrees.

    Examples
    --------
    >>> degrees(0.5)
    '28.65°'
    """
    return f"{short(math.degrees(float(angle)), 4)}°"


def length(*values: Any) -> str:
    """Write a length, or several as those of a box.

    Examples
    --------
    >>> length(0.5, 0.4)
    '50 cm × 40 cm'
    """
    return " × ".join(with_unit(float(value), "length") for value in values)


def pair(values: tuple[Any, Any], unit: str) -> str:
    """Write two components, what is nothing beside the other as 0.

    Examples
    --------
    >>> pair((0.5, 1e-17), "m")
    '(0.5, 0) m'
    """
    first, second = (float(f"{part:.6g}") + 0.0 for part in values)
    size = max(abs(first), abs(second))
    first, second = (0.0 if abs(part) < 1e-12 * size else part for part in (first, second))
    return f"({first:.6g}, {second:.6g}) {unit}"
