"""Scenario data as TOML text: plain keys first, lists on one line, tables in the order of the format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import tomli_w

from .fields import written


def layout(data: Mapping[str, Any], path: str = "") -> str:
    """Write nested dictionaries as TOML.

    Examples
    --------
    >>> print(layout({"title": "A", "run": {"every": 0.01}}), end="")
    title = "A"
    <BLANKLINE>
    [run]
    every = 0.01
    """
    plain = [f"{key} = {_value(value)}\n" for key, value in data.items() if not _is_table(value)]
    blocks = ["".join(plain)]
    for key, value in data.items():
        if isinstance(value, Mapping):
            blocks.append(f"\n[{path}{key}]\n{layout(value, f'{path}{key}.')}")
        elif _is_table(value):
            blocks.extend(f"\n[[{path}{key}]]\n{layout(part, f'{path}{key}.')}" for part in value)
    return "".join(blocks)


def _is_table(value: Any) -> bool:
    several = isinstance(value, Sequence) and not isinstance(value, str) and bool(value)
    return isinstance(value, Mapping) or (several and isinstance(value[0], Mapping))


def _value(value: Any) -> str:
    value = written(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(part) for part in value) + "]"
    return _text(value) if isinstance(value, str) else _plain(value, lines=False)


@lru_cache(maxsize=1000)  # while one number is tried out, the others of its file stay
def _text(value: str) -> str:
    # A text of several lines reads better as one, but TOML would turn its "\r\n" into "\n".
    return _plain(value, lines="\n" in value and "\r" not in value)


def _plain(value: Any, *, lines: bool) -> str:
    return tomli_w.dumps({"v": value}, multiline_strings=lines).removeprefix("v = ").removesuffix("\n")
