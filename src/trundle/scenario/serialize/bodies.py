"""From a body back to its table: the shortest from which a builder makes the same body."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from ...errors import InvalidValueError
from ...mechanics.bodies import Body
from ...mechanics.parts import defaults_of, fields_of
from .parts import Words, word_of, wordless


def body_words(body: Body) -> Words:
    """Return the table of a body.

    Examples
    --------
    >>> body_words(Body.solid_sphere(radius=0.025, mass=0.065))
    {'kind': 'solid-sphere', 'radius': 0.025, 'mass': 0.065}
    """
    says = {name: word_of(value, f"body.{name}") for name, value in body.parameters().items()}
    tables = [(kind, words) for kind, build in Body.builders().items() for words in _tables(build, says)]
    tables.sort(key=lambda table: len(table[1]))
    built = [_built(Body.builders()[kind], words) for kind, words in tables]
    for same in (Body.__eq__, _alike):
        for (kind, words), other in zip(tables, built, strict=True):
            if other is not None and same(other, body):
                return {"kind": kind, **words}
    raise wordless("body", body)


def _tables(build: Callable[..., Body], says: Mapping[str, Any]) -> Iterator[Words]:
    """Return the words that a body may have by a builder: the fewest, with an inertia of its own, and a centre."""
    optional = defaults_of(build)
    names = [name for name in fields_of(build) if name in says]
    if all(name in names or name in optional for name in fields_of(build)):
        for left_out in (set(optional), {"centre"}, set()):
            yield {name: says[name] for name in names if name not in left_out}


def _built(build: Callable[..., Body], words: Words) -> Body | None:
    try:
        return build(**words)
    except InvalidValueError:
        return None


def _alike(one: Body, other: Body) -> bool:
    """Tell whether two bodies move alike, though the inertia of one is given by a ratio."""
    return type(one.shape) is type(other.shape) and _numbers(one) == _numbers(other)


def _numbers(body: Body) -> dict[str, Any]:
    return {name: value for name, value in body.parameters().items() if name != "inertia_ratio"}
