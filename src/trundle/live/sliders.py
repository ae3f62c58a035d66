"""The sliders of a live page: which numbers of a scenario, how far, and in which unit they are shown."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..analysis.sensitivities.keys import Key, chosen, keys, moved
from ..errors import InvalidValueError, OutOfDomainError, TrundleError, UnknownNameError
from ..scenario import ScenarioFile
from ..units import UNITS, span, to_si
from .start import Placed

MOST = 8  # sliders on a page
_OFFERED = 5  # where none is asked for
_SHARES = (0.5, 0.25, 0.1)  # of a number, by which a slider goes to either side: the first that may be
_DRAWN = 24  # combinations of sliders that are compared
_ORDER = ("start", "support", "loads", "body")  # of what is offered: what one would play with comes first
_PLACES = ("first", "second", "third", "fourth")
_UNIT = re.compile(r"^\s*[-+]?[\d.]+(e[-+]?\d+)?\s*", re.IGNORECASE)  # what stands before a unit
_NOT_OFFERED = ("gravity", "body.mass", "start.orientation", "body.moments", "body.products")


@dataclass(frozen=True)
class Slider:
    """One slider."""

    key: Key  # the number
    low: float  # its ends, SI
    high: float  # its ends, SI
    # `label`, `group`, `unit`: what it is called, of what it is a number, and the unit in which it is shown
    label: str
    group: str
    unit: str
    factor: float  # of that unit, in SI

    @property
    def told(self) -> dict[str, Any]:
        """What the page needs to know of it."""
        shown = {name: getattr(self, name) for name in ("low", "high", "label", "group", "unit", "factor")}
        return {"name": self.key.name, "value": self.key.value, **shown}


def sliders_of(scenario: ScenarioFile, asked: Sequence[str]) -> tuple[list[Slider], Placed]:
    """Return sliders as they are asked for, or some that may be, and the start that they place.

    Parameters
    ----------
    scenario : ScenarioFile
        Whose numbers they are.
    asked : sequence of str
        Such as "body.radius" or "body.radius=1 cm..3 cm"; none: some are offered.

    Raises
    ------
    InvalidValueError
        If one cannot be had, with the reason.

    Examples
    --------
    >>> import trundle as tr
    >>> found, _ = sliders_of(tr.Scenario.load("tilted-turntable"), ["support.tilt=0 deg..1 deg"])
    >>> found[0].label, found[0].unit, round(found[0].high, 6)
    ('Tilt', 'deg', 0.017453)
    """
    found = _asked(scenario, asked) if asked else _offered(scenario)
    if len(found) > MOST:
        raise InvalidValueError("--slider", f"must stand at most {MOST} times", len(found))
    try:
        return found, _together(scenario, found, by_formula=True)
    except TrundleError:  # no closed form has its motion for all that the sliders reach
        return found, _together(scenario, found)


def _asked(scenario: ScenarioFile, asked: Sequence[str]) -> list[Slider]:
    found: dict[str, Slider] = {}
    for each in asked:
        name, sign, text = each.partition("=")
        for key in _chosen(scenario, name.strip()):
            ends = _ends(text, scenario, key, each) if sign else None
            found[key.name] = _slider(scenario, key, ends)
    return list(found.values())


def _chosen(scenario: ScenarioFile, name: str) -> list[Key]:
    """Return the numbers of a name."""
    if name == "start.time":
        rule, remedy = "must not name `start.time`", "A page counts its time from the start: move another number."
        raise InvalidValueError("--slider", rule, name, remedy)
    try:
        return chosen(scenario, [name])
    except UnknownNameError:
        raise
    except TrundleError:
        remedy = "A slider moves a number that the scenario gives as one: write it into the scenario first."
        raise InvalidValueError("--slider", "must name a number of the scenario", name, remedy) from None


def _ends(text: str, scenario: ScenarioFile, key: Key, received: str) -> tuple[float, float]:
    """Read "1 cm..3 cm" or "1..3 cm"."""
    _, _, unit, factor = _shown(scenario, key)
    low, here, high = (f"{value / factor:.4g} {unit}".strip() for value in _example(key.value))
    example = f'Write for instance --slider "{key.name}={low}..{high}".'
    parts = span(text)
    if parts is None:
        raise InvalidValueError("--slider", "must give a span as FROM..TO", received, example)
    try:
        first, last = (to_si(part, _kind(key), "--slider") for part in parts)
    except InvalidValueError as error:
        raise InvalidValueError("--slider", error.rule, received, example) from None
    if not first < last:
        raise InvalidValueError("--slider", "must go upwards, FROM..TO", received, example)
    if not first <= key.value <= last:
        raise InvalidValueError("--slider", f"must hold the value that the scenario has, {here}", received, example)
    return first, last


def _example(value: float) -> tuple[float, float, float]:
    """Return a span about a value, and the value."""
    reach = 0.5 * abs(value) or 1.0
    return value - reach, value, value + reach


def _offered(scenario: ScenarioFile) -> list[Slider]:
    """Return some sliders that may be, those of the start first."""
    known = [key for key in keys(scenario) if key.value != 0 and not key.name.startswith(_NOT_OFFERED)]
    known.sort(key=lambda key: next((i for i, head in enumerate(_ORDER) if key.name.startswith(head)), len(_ORDER)))
    found: list[Slider] = []
    for key in known:
        try:
            one = _slider(scenario, key, None)
            _together(scenario, [*found, one])
        except TrundleError:
            continue
        found.append(one)
        if len(found) == _OFFERED:
            break
    return found


def _slider(scenario: ScenarioFile, key: Key, ends: tuple[float, float] | None) -> Slider:
    """Return a slider whose ends may be."""
    placed = _placed(scenario, [key])
    if ends is None:
        ends = _end(scenario, placed, key, -1), _end(scenario, placed, key, 1)
    for end in ends:
        if (why := _why_not(scenario, placed, {key.name: end})) is not None:
            raise InvalidValueError("--slider", _rule(key), f"{key.name} = {end:.6g}", why)
    label, group, unit, factor = _shown(scenario, key)
    return Slider(key, *ends, label, group, unit, factor)


def _rule(key: Key) -> str:
    return f"must lead to starts that a page can place by itself; `{key.name}` may not go so far"


def _placed(scenario: ScenarioFile, wanted: Sequence[Key], *, by_formula: bool = False) -> Placed:
    try:
        return Placed.of(scenario, wanted, by_formula=by_formula)
    except OutOfDomainError as error:
        remedy = "Take another number, or leave --live out."
        raise InvalidValueError("--slider", str(error), ", ".join(key.name for key in wanted), remedy) from None


def _end(scenario: ScenarioFile, placed: Placed, key: Key, side: int) -> float:
    """Return how far a slider goes to one side where nobody says it."""
    whole = abs(key.value or float(to_si(UNITS[_kind(key)][1], _kind(key), "")))
    why: str | None = ""
    for share in _SHARES:
        end = key.value + side * share * whole
        why = _why_not(scenario, placed, {key.name: end})
        if why is None:
            return end
    remedy = f"{why} Give a span: `--slider {key.name}=FROM..TO`."
    raise InvalidValueError("--slider", _rule(key), f"{key.name} = {end:.6g}", remedy)


def _why_not(scenario: ScenarioFile, placed: Placed, values: Mapping[str, float]) -> str | None:
    """Say why a page cannot place the start for some values; None where it can."""
    try:
        placed.check(scenario, dict(values))
    except (TrundleError, ArithmeticError) as error:
        return str(error).rstrip(".") + "."
    return None


def _together(scenario: ScenarioFile, found: Sequence[Slider], *, by_formula: bool = False) -> Placed:
    """Return the start that several sliders place, compared at combinations of them, of which some may be refused."""
    placed = _placed(scenario, [one.key for one in found], by_formula=by_formula)
    if not found:
        return placed
    for shares in _combinations(len(found)):
        values = {
            one.key.name: one.low + share * (one.high - one.low) for one, share in zip(found, shares, strict=True)
        }
        try:
            moved(scenario, values)
        except TrundleError:
            continue  # nobody could start there; the page sees that, too
        if (why := _why_not(scenario, placed, values)) is not None:
            told = ", ".join(f"{name} = {value:.6g}" for name, value in values.items())
            remedy = f"{why} Let one of them go less far, or leave it out."
            raise InvalidValueError("--slider", "must lead to starts that a page can place by itself", told, remedy)
    return placed


def _combinations(count: int) -> Iterator[Sequence[float]]:
    """Yield shares of sliders: all ends where these are few, and some drawn between."""
    draw = np.random.default_rng(seed=count)
    if 2**count <= _DRAWN:
        yield from itertools.product((0.0, 1.0), repeat=count)
    else:
        yield from draw.integers(0, 2, (_DRAWN, count)).astype(float).tolist()
    yield from draw.random((_DRAWN, count)).tolist()


def _shown(scenario: ScenarioFile, key: Key) -> tuple[str, str, str, float]:
    """Return what a number is called, of what it is one, and the unit in which it is written with its factor."""
    *way, last = key.name.split(".")
    table = _value(scenario, way)
    words = [re.sub(r"\[(\d)\]", lambda found: f" {int(found[1]) + 1}", part).replace("_", " ") for part in way]
    name, _, index = last.partition("[")
    fields = type(table).model_fields
    attribute = next((each for each, field in fields.items() if field.alias == name), name)
    title = fields[attribute].title or name.replace("_", " ")
    value, label = getattr(table, attribute), title[:1].upper() + title[1:]
    if index:
        place = int(index[0])
        value, label = value[place], f"{label}, {_PLACES[place]}"
    unit = _UNIT.sub("", getattr(value, "text", None) or "")
    if not unit and key.unit == "rad":
        unit = "deg"
    factor = float(to_si(f"1 {unit}", _kind(key), "")) if unit else 1.0
    return label, " ".join(words), unit or key.unit, factor


def _value(table: Any, way: Sequence[str]) -> Any:
    """Return the table at the end of a way."""
    for part in way:
        name, _, index = part.partition("[")
        found = next((each for each, field in type(table).model_fields.items() if field.alias == name), name)
        table = getattr(table, found)
        table = table[int(index.rstrip("]"))] if index else table
    return table


def _kind(key: Key) -> str:
    """Return a dimension that has the unit of a number."""
    return next(kind for kind, (unit, _) in UNITS.items() if unit == key.unit)


__all__ = ["MOST", "Slider", "sliders_of"]
