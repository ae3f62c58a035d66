"""What the text of a program says of its arguments."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def table(title: str, names: Sequence[str], units: Sequence[str], values: Any = None) -> list[str]:
    """List names with their places, units and values, an array; nothing where there is none.

    Examples
    --------
    >>> table("p", ["mass", "ratio"], ["kg", ""])
    ['p:', '    [0] mass (kg)', '    [1] ratio']
    """
    values = [None] * len(names) if values is None else values.tolist()
    rows = zip(names, units, values, strict=True)
    told = [
        f"    [{i}] {name}{f' ({unit})' if unit else ''}{'' if value is None else f' = {value!r}'}"
        for i, (name, unit, value) in enumerate(rows)
    ]
    return [f"{title}:", *told] if told else []
