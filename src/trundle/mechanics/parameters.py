"""The numbers in a system, apart from its structure: so one compiled integrator serves every radius, tilt and rate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, NamedTuple, TypeVar

from .expressions import Expression
from .parts import Field, Number, Numbers, fields_of
from .scalars import Scalar, is_number

T = TypeVar("T")


def numbers(thing: Any) -> list[float]:
    """List the numbers that a system is made of, in a fixed order.

    Examples
    --------
    >>> import trundle as tr
    >>> numbers(tr.Support(tr.Plane(rim=0.5), motion=tr.Spin(3.5), tilt=0.05))
    [0.5, 3.5, 0.05, 0.0, 0.0]
    """
    return [float(value) for value in _walk(thing)]


@cache
def _fields(kind: type) -> tuple[tuple[str, bool], ...] | None:
    """Return the names of a dataclass's fields, and whether they are compared; None for what is no dataclass."""
    return tuple((field.name, field.compare) for field in fields(kind)) if is_dataclass(kind) else None


def _walk(thing: Any) -> Iterator[Any]:
    known = _fields(thing.__class__)
    if known is not None:
        for name, _ in known:
            yield from _walk(getattr(thing, name))
    elif isinstance(thing, tuple):
        for part in thing:
            yield from _walk(part)
    elif is_number(thing) and not isinstance(thing, bool):
        yield thing


class Parameter(NamedTuple):
    """What one number of a system is called, and its dimension, one of `trundle.units.UNITS`."""

    name: str
    dimension: str


def parameters(thing: Any) -> list[Parameter]:
    """Tell of each number that a system is made of, in the order of `numbers`.

    It is named by the way to it, as in a file: "body.radius", "support.tilt", "loads[0].value.x". The numbers in a
    formula are counted as they stand in it; what unit each of them has, SI, only the formula tells.

    Examples
    --------
    >>> import trundle as tr
    >>> [name for name, _ in parameters(tr.Support(tr.Plane(rim=0.5), motion=tr.SpinBy("2*t + 1"), tilt=0.05))][:4]
    ['rim', 'motion.rate[0]', 'motion.rate[1]', 'tilt']
    """
    return [Parameter(name.removeprefix("."), dimension) for name, dimension in _told(thing, "", "number")]


_OF_THE_WHOLE = ("shape", "surface")  # what these are made of is said of the body and of the support


def _told(thing: Any, path: str, dimension: str) -> Iterator[tuple[str, str]]:
    if isinstance(thing, Expression):
        yield from ((f"{path}[{i}]", "number") for i, _ in enumerate(_walk(thing)))
    elif is_dataclass(thing):
        says = fields_of(type(thing))
        for each in fields(thing):
            way = path if each.name in _OF_THE_WHOLE else f"{path}.{each.name}"
            yield from _told(getattr(thing, each.name), way, _dimension(says.get(each.name), dimension))
    elif isinstance(thing, tuple):
        for i, part in enumerate(thing):
            yield from _told(part, f"{path}[{i}]", dimension)
    elif is_number(thing) and not isinstance(thing, bool):
        yield path, dimension


def _dimension(note: Field | None, otherwise: str) -> str:
    """Return the dimension that a field says; a component has that of its vector."""
    note = note.each if isinstance(note, Numbers) else note
    return note.dimension if isinstance(note, Number) else otherwise


def structure_of(thing: Any) -> Any:
    """Return what a system is apart from its numbers, in a form that can be compared.

    Examples
    --------
    >>> import trundle as tr
    >>> plain, small, large = tr.Plane(), tr.Plane(rim=0.5), tr.Plane(rim=2.0)
    >>> structure_of(small) == structure_of(large), structure_of(small) == structure_of(plain)
    (True, False)
    """
    known = _fields(thing.__class__)
    if known is not None:
        return type(thing), tuple([structure_of(getattr(thing, name)) for name, compared in known if compared])
    if isinstance(thing, tuple):
        return tuple([structure_of(part) for part in thing])
    return float if is_number(thing) and not isinstance(thing, bool) else thing


def with_numbers(thing: T, values: Sequence[Scalar]) -> T:
    """Return the same structure with other scalars in the places of its numbers.

    Examples
    --------
    >>> import sympy
    >>> import trundle as tr
    >>> with_numbers(tr.Spin(3.5), [sympy.Symbol("omega")]).rate
    omega
    """
    return _rebuild(thing, iter(values))


def _rebuild(thing: Any, values: Iterator[Scalar]) -> Any:
    known = _fields(thing.__class__)
    if known is not None:
        return type(thing)(**{name: _rebuild(getattr(thing, name), values) for name, _ in known})
    if isinstance(thing, tuple):
        return tuple(_rebuild(part, values) for part in thing)
    if is_number(thing) and not isinstance(thing, bool):
        return next(values)
    return thing
