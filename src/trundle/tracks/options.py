"""What a reader says of a file because the file does not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ..errors import InvalidValueError, UnknownNameError
from ..units import to_si
from .grid import DECIMALS

KINDS = ("time", "length", "angle")
ORDERS, SENSES, DIRECTIONS = ("wxyz", "xyzw"), ("clockwise", "anticlockwise"), ("up", "down")
SI = {"time": "s", "length": "m", "angle": "rad"}
LEAST_LIKELIHOOD = 0.6  # below which DeepLabCut itself draws no point


@dataclass(frozen=True)
class Options:
    """How a file is to be read; what is None, the file has to tell.

    Parameters
    ----------
    track : str, optional
        Which of several.
    columns : mapping
        Trundle's name -> the heading in the file.
    units : mapping
        Of columns that say none: time, length, angle; rates are per second.
    rate : float, optional
        Frames a second, where the file counts frames.
    pixel : float, optional
        Size of one pixel, m.
    y : str, optional
        Whether y is counted "up" or "down".
    sense : str, optional
        Of an angle, seen from above: "clockwise" or "anticlockwise".
    decimal : str, optional
        "point" or "comma".
    quaternion : str
        Order of numbered parts.
    likelihood : float
        Below which a point found by a network is none.

    Examples
    --------
    >>> Options.asked(units="cm", pixel="0.5 mm").units, Options.asked(pixel="0.5 mm").pixel
    ({'length': 'cm'}, 0.0005)
    """

    track: str | None = None
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    rate: float | None = None
    pixel: float | None = None
    y: str | None = None
    sense: str | None = None
    decimal: str | None = None
    quaternion: str = "wxyz"
    likelihood: float = LEAST_LIKELIHOOD

    @classmethod
    def asked(cls, *, units: Any = None, rate: Any = None, pixel: Any = None, **given: Any) -> Options:
        """Return options as somebody wrote them, each checked."""
        for name, allowed in (("y", DIRECTIONS), ("sense", SENSES), ("decimal", tuple(DECIMALS))):
            if given.get(name) is not None and given[name] not in allowed:
                raise UnknownNameError(f"{name}", str(given[name]), allowed)
        if given.get("quaternion", "wxyz") not in ORDERS:
            raise UnknownNameError("quaternion order", str(given["quaternion"]), ORDERS)
        asked = {"length": units} if isinstance(units, str) else dict(units or {})
        unknown = next((kind for kind in asked if kind not in KINDS), None)
        if unknown is not None:
            raise UnknownNameError("kind of unit", str(unknown), KINDS)
        for kind, unit in asked.items():
            if unit not in ("px", "frame"):
                to_si(f"1 {unit}", kind, f"unit of {kind}")
        return cls(
            units=asked,
            rate=None if rate is None else _positive("rate", rate, "frames a second, such as 60 or 59.94"),
            pixel=None if pixel is None else _positive("pixel", to_si(pixel, "length", "pixel"), "a length"),
            **given,
        )

    def as_dict(self) -> dict[str, Any]:
        """Return what was said, for the record."""
        return {name: value for name, value in vars(self).items() if value and value != _DEFAULTS.get(name)}


def _positive(name: str, value: Any, what: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = -1.0
    if not 0 < number < float("inf"):
        raise InvalidValueError(name, f"must be {what}", value)
    return number


_DEFAULTS = {"quaternion": "wxyz", "likelihood": LEAST_LIKELIHOOD}
