"""From a motion of the support back to its table."""

from __future__ import annotations

from dataclasses import fields
from functools import partial
from typing import Any

from ...mechanics.expressions import Expression
from ...mechanics.motions import (
    Combined,
    Fixed,
    FreeAxle,
    Move,
    PrecessingTilt,
    Rock,
    Shake,
    Spin,
    SpinBy,
    Tilt,
    UnevenSpin,
    Wobble,
)
from .parts import Describe, Words, number_of, numbers_of, one_of


def words_of(kind: str, thing: Any, key: str) -> Words:
    """Return the words of a thing that is its numbers, formulas and lists of them.

    Parameters
    ----------
    kind : str
        Its kind.
    thing : dataclass
        A motion or load, each field named as the key in the file.
    key : str
        Its place in the file, for messages.

    Returns
    -------
    dict
        Its table.

    Examples
    --------
    >>> words_of("shake", Shake((0.002, 0.0, 0.0), 30.0), "support.motion")
    {'kind': 'shake', 'amplitude': [0.002, 0.0, 0.0], 'rate': 30.0, 'phase': 0.0}
    """
    words: Words = {"kind": kind}
    for field in fields(thing):
        value, place = getattr(thing, field.name), f"{key}.{field.name}"
        if isinstance(value, Expression):
            words[field.name] = value.text
        elif value is not None:
            words[field.name] = numbers_of(value, place) if hasattr(value, "__iter__") else number_of(value, place)
    return words


def _combined(motion: Combined, key: str) -> Words:
    parts = [one_of(MOTIONS, part, f"{key}.parts[{i}]") for i, part in enumerate(motion.parts)]
    return {"kind": "combined", "parts": parts}


def by_kind(kinds: dict[type, str]) -> Describe:
    """Return what writes things that are their numbers, formulas and lists of them.

    Parameters
    ----------
    kinds : dict
        The kind of each type.

    Returns
    -------
    dict
        For each type the function that writes it.

    Examples
    --------
    >>> by_kind({Spin: "spin"})[Spin](Spin(2.0), "support.motion")
    {'kind': 'spin', 'rate': 2.0}
    """
    return {thing: partial(words_of, kind) for thing, kind in kinds.items()}


MOTIONS: Describe = {
    Combined: _combined,
    **by_kind(
        {
            Fixed: "fixed",
            Spin: "spin",
            UnevenSpin: "uneven-spin",
            Wobble: "wobble",
            SpinBy: "spin-by",
            FreeAxle: "free-axle",
            Tilt: "tilt",
            Rock: "rock",
            PrecessingTilt: "precessing-tilt",
            Shake: "shake",
            Move: "move",
        }
    ),
}
