"""Answers kept for who asks again: by what was asked, the least recently used go first."""

from __future__ import annotations

import gzip
import hashlib
import json
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from .requests import JSON, PICTURE, SCENE

_WORDY = (JSON, PICTURE, "application/toml", "text/csv", "text/html")
# What is worth compressing, and how hard gzip tries: of numbers, as in a scene, more hardly saves more.
_PACKED = {SCENE: 3} | dict.fromkeys(_WORDY, 5)
_SHORT = 1000  # bytes, that are sent as they are


@dataclass(frozen=True)
class Answer:
    """A whole answer, as a worker made it.

    Examples
    --------
    >>> Answer(b"{}", "application/json").filename is None
    True
    """

    body: bytes  # what is sent
    media_type: str  # its type
    filename: str | None = None  # the name under which a browser saves it
    packed: bool = False  # whether the body is compressed by gzip

    @property
    def plain(self) -> bytes:
        """The body for who cannot unpack it."""
        return gzip.decompress(self.body) if self.packed else self.body


def packed(function: Callable[..., Any], *arguments: Any) -> Any:
    """Return what a function answers, compressed where that is worth it: before it goes from one process to another.

    Examples
    --------
    >>> answer = packed(Answer, bytes(2000), "image/svg+xml")
    >>> answer.packed, len(answer.body) < 50, answer.plain == bytes(2000)
    (True, True, True)
    """
    found = function(*arguments)
    level = _PACKED.get(found.media_type.partition(";")[0]) if isinstance(found, Answer) else None
    if level is None or len(found.body) <= _SHORT:
        return found
    return replace(found, body=gzip.compress(found.body, level), packed=True)


def key_of(*asked: Any) -> str:
    """Return a short text that stands for what was asked: the same for the same JSON, whatever the order of its keys.

    Examples
    --------
    >>> key_of("run", {"a": 1, "b": 2}) == key_of("run", {"b": 2, "a": 1})
    True
    >>> key_of("run", {"a": 1}) == key_of("run", {"a": 1.0})
    False
    """
    digest = hashlib.sha256(_version().encode())
    for part in asked:
        content = part if isinstance(part, bytes) else json.dumps(part, sort_keys=True).encode("ascii")
        digest.update(f"{len(content)}:".encode("ascii") + content)
    return digest.hexdigest()[:40]


@lru_cache
def _version() -> str:
    from importlib.metadata import version  # half a millisecond, each time

    return version("trundle")


class Cache:
    """A bounded store of answers, for one event loop.

    Parameters
    ----------
    largest : int
        How many bytes it may hold; an answer of more than a quarter of that is not kept.

    Examples
    --------
    >>> cache = Cache(100)
    >>> for name in "abcde":
    ...     cache.put(name, Answer(bytes(25), "text/plain"))
    >>> cache.get("a"), cache.get("e") is not None, cache.size
    (None, True, 100)
    """

    def __init__(self, largest: int) -> None:
        self.largest, self.size = largest, 0
        self._kept: OrderedDict[str, Answer] = OrderedDict()

    def get(self, key: str) -> Answer | None:
        """Return an answer that is kept."""
        if key not in self._kept:
            return None
        self._kept.move_to_end(key)
        return self._kept[key]

    def put(self, key: str, answer: Answer) -> None:
        """Keep an answer; let those go that were not asked for the longest."""
        if len(answer.body) * 4 > self.largest:
            return
        if key in self._kept:
            self.size -= len(self._kept.pop(key).body)
        self._kept[key] = answer
        self.size += len(answer.body)
        while self.size > self.largest:
            _, gone = self._kept.popitem(last=False)
            self.size -= len(gone.body)
