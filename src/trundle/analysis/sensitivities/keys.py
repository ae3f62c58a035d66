"""The numbers of a scenario by name, and the scenario with duals in their places."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeVar, get_args

from ...errors import InvalidValueError, SolverError, TrundleError, UnknownNameError
from ...mechanics.duals import Dual
from ...mechanics.placing import Placing
from ...mechanics.scalars import is_number
from ...mechanics.system import RollingSystem, State
from ...scenario import ScenarioFile
from ...scenario.fields import Measure, Measures
from ...scenario.tables.of_parts import ListOfLengths
from ...scenario.tables.values import Table
from ...units import UNITS

Model = TypeVar("Model", bound=ScenarioFile)
_APART = {"title", "group", "notes", "timing"}  # what says nothing of the motion
_CLOCK = "start.time"
# At 0 these say that there is nothing of the kind.
_AT_ZERO = {
    "start.height": "a body that touches its support cannot be a little lower",
    "start.roll": "the body is not laid across its way",
}


@dataclass(frozen=True)
class Key:
    """A number of a scenario."""

    name: str  # such as "body.radius" or "start.velocity[0]"
    value: float  # in SI
    unit: str  # its SI unit; empty where it has none


def keys(scenario: ScenarioFile) -> list[Key]:
    """Return all numbers of a scenario that say what moves; the clock of its start is not one of them.

    Examples
    --------
    >>> import trundle as tr
    >>> [key.name for key in keys(tr.Scenario.load("tilted-turntable"))][:4]
    ['gravity', 'body.radius', 'body.mass', 'support.rim']
    """
    return [key for key in _all(scenario) if key.name != _CLOCK]


def _all(scenario: ScenarioFile) -> list[Key]:
    """Return all numbers of a scenario that a motion may be differentiated by."""
    kinds = {
        f"{key}[{i}]": kind for key, all_ in scenario._kinds_of_components().items() for i, kind in enumerate(all_)
    }
    units = {name: UNITS[kind][0] for name, kind in kinds.items()}
    told = ((name, value, units.get(name, unit)) for name, value, unit in leaves(scenario))
    return [Key(*one) for one in told if is_number(one[1]) and not _without(*one[:2])]


def _without(name: str, value: Any) -> str:
    """Say why there is no derivative by a number; empty where there is one."""
    return _AT_ZERO.get(name, "") if value == 0 else ""


def chosen(scenario: ScenarioFile, names: Sequence[str]) -> list[Key]:
    """Return the numbers of some names; the name of a list stands for each of its components.

    Examples
    --------
    >>> import trundle as tr
    >>> [key.name for key in chosen(tr.Scenario.load("tilted-turntable"), ["start.velocity"])]
    ['start.velocity[0]', 'start.velocity[1]']
    """
    known = _all(scenario)
    found: dict[str, Key] = {}
    for name in names:
        own = [
            key
            for key in known
            if key.name == name or (key.name.startswith(f"{name}[") and "." not in key.name[len(name) :])
        ]
        if not own:
            raise _refusal(scenario, name, known)
        found |= {key.name: key for key in own}
    return list(found.values())


def _refusal(scenario: ScenarioFile, name: str, known: list[Key]) -> Exception:
    """Say why there is no derivative by what a name stands for."""
    names = [key.name for key in known]
    if not isinstance(name, str):
        return InvalidValueError(
            "wrt", "must hold names of numbers of the scenario", name, f"It has {', '.join(names)}."
        )
    given = {key: value for key, value, _ in leaves(scenario)}
    if given.get(name, 0.0) is None:
        rule = "must name numbers that the scenario gives"
        return InvalidValueError(
            "wrt", rule, name, f"Write `{name}` into the scenario first, with the value that it has."
        )
    if why := _without(name, given.get(name)):
        return InvalidValueError("wrt", f"must not name `{name}` here: {why}", f"{name} = {given[name]:g}")
    if isinstance(given.get(name), str):
        rule = "must name numbers: a motion has no derivative by a text"
        return InvalidValueError("wrt", rule, f"{name} = {given[name]!r}", "Give the number instead, or leave it out.")
    place, _, field = name.rpartition(".")
    kinds = [f'"{kind}"' for kind, table in scenario.kinds.get(place, {}).items() if field in table.model_fields]
    if kinds and field != "kind":
        rule = "must name numbers that the scenario gives"
        return InvalidValueError("wrt", rule, name, f"It belongs to [{place}] of kind {' or '.join(kinds)}.")
    return UnknownNameError("number of the scenario", name, names)


def varied(scenario: ScenarioFile, wanted: Sequence[Key]) -> tuple[RollingSystem, State]:
    """Return the system and the start of a scenario in duals: each with its slopes by the numbers wanted.

    Examples
    --------
    >>> import trundle as tr
    >>> scenario = tr.Scenario.load("tilted-turntable")
    >>> system, start = varied(scenario, chosen(scenario, ["body.radius"]))
    >>> system.body.radius.slopes, start.position[2].slopes
    ((1.0,), (1.0,))
    """
    duals = {
        key.name: Dual(key.value, tuple(float(i == j) for j in range(len(wanted)))) for i, key in enumerate(wanted)
    }
    model = replaced(scenario, duals)
    system = model.system()
    try:
        return system, Placing(system, **model.start.arguments()).state(checked=False)
    except TrundleError:
        raise
    except (ArithmeticError, ValueError):  # a root of less than 0: there is no surface at that place
        raise SolverError("No start has these numbers: its place is beyond the surface, or a formula's end.") from None


def replaced(scenario: Model, values: Mapping[str, Any]) -> Model:
    """Return a scenario with other scalars in the places of its numbers; they are not checked again.

    Examples
    --------
    >>> import trundle as tr
    >>> replaced(tr.Scenario.load("tilted-turntable"), {"body.radius": 0.03}).system().body.radius
    0.03
    """
    model: Model = _replaced(scenario, "", lambda name, value: values.get(name, value))
    return model


def moved(scenario: ScenarioFile, values: dict[str, float]) -> tuple[RollingSystem, State]:
    """Return the system and the start of a scenario with other numbers."""
    model = replaced(scenario, values)
    return model.system(), model.start_state()


@cache
def _fields(kind: Any) -> tuple[tuple[str, str, str], ...]:
    """Return the name of each field of a kind of table, that in the file, and the SI unit of its numbers.

    The numbers of a surface that is given as a table belong to its structure: nothing is differentiated by them.
    """
    found = []
    for name, field in kind.model_fields.items():
        tabled = any(isinstance(note, ListOfLengths) for note in _notes(field))
        if name not in _APART and name != "kind" and not tabled:
            measured = next((note.kind for note in map(_each, _notes(field)) if isinstance(note, Measure)), "number")
            found.append((name, field.alias or name, UNITS[measured][0]))
    return tuple(found)


def _notes(field: Any) -> Iterator[Any]:
    """Yield the notes on the numbers of a field, also where these may be absent."""
    waiting = [*field.metadata, field.annotation]
    while waiting:
        note = waiting.pop(0)
        waiting += [*getattr(note, "__metadata__", ()), *get_args(note)]
        yield note


def _each(note: Any) -> Any:
    return note.each if isinstance(note, Measures) else note


def leaves(table: Any, before: str = "") -> Iterator[tuple[str, Any, str]]:
    """Yield each value of a table with its name and unit, and of the tables within.

    Examples
    --------
    >>> import trundle as tr
    >>> next(leaves(tr.Scenario.load("tilted-turntable")))
    ('gravity', 9.80665, 'm/s^2')
    """
    for name, alias, unit in _fields(table.__class__):
        yield from _within(getattr(table, name), f"{before}{alias}", unit)


def _within(value: Any, name: str, unit: str) -> Iterator[tuple[str, Any, str]]:
    if isinstance(value, Table):
        yield from leaves(value, f"{name}.")
    elif isinstance(value, tuple):
        for i, part in enumerate(value):
            yield from _within(part, f"{name}[{i}]", unit)
    else:
        yield name, value, unit


def _replaced(table: Any, before: str, other: Callable[[str, Any], Any]) -> Any:
    """Return a table with other values; they are not checked again."""
    update = {}
    for name, alias, _ in _fields(table.__class__):
        value = getattr(table, name)
        now = _other(value, f"{before}{alias}", other)
        if now is not value:
            update[name] = now
    return table.model_copy(update=update) if update else table


def _other(value: Any, name: str, other: Callable[[str, Any], Any]) -> Any:
    if isinstance(value, Table):
        return _replaced(value, f"{name}.", other)
    if isinstance(value, tuple):
        parts = tuple(_other(part, f"{name}[{i}]", other) for i, part in enumerate(value))
        return value if all(a is b for a, b in zip(parts, value, strict=True)) else parts
    return other(name, value)
