"""What a scenario may be made of, for a page that offers it: every kind of part, and all of its numbers.

All of it is read off the tables of scenario files, which are made from what the parts say of themselves.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any, Literal, cast, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from ..errors import InvalidValueError
from ..mechanics.algebra import E_Z
from ..mechanics.bodies import Body
from ..mechanics.expressions import Expression
from ..mechanics.surfaces import Surface
from ..mechanics.symmetry import ball_of
from ..scenario.document import ScenarioFile
from ..scenario.fields import Coordinate, Measure, Measures
from ..scenario.path_file import Ball, PathFile
from ..scenario.tables import KINDS, Run, Start, Table
from ..scenario.tables.of_parts import FormulaText
from ..scenario.tables.supports import OnSurface
from ..units import OFFERED, UNITS, to_si
from .sliders import slider

_FURTHEST = ("15 cm", "5 cm", "1 cm")  # from the axis, the first that is on the surface


def all_parts() -> dict[str, Any]:
    """Return every kind of part, the numbers of every table, and the units that they may be given in.

    Returns
    -------
    dict
        `body`, `support`, `motion` and `loads`: each kind with its `label`, a sentence `said`, its `fields`, and the
        table `first` with which it is chosen; None where it takes more than numbers to choose it. `common` and `path`
        have the fields of the other tables, `units` how many SI units each unit of a dimension is.

    Examples
    --------
    >>> all_parts()["support"]["cone"]["first"]
    {'kind': 'cone', 'half_angle': '45 deg', 'rim': '40 cm'}
    """
    return {
        "body": {kind: _body(kind, table) for kind, table in KINDS["body"].items()},
        "support": {kind: _surface(kind, table) for kind, table in KINDS["support"].items()},
        "motion": {kind: _motion(kind, table) for kind, table in KINDS["support.motion"].items()},
        "loads": {kind: _load(kind, table) for kind, table in KINDS["loads"].items()},
        "common": {
            "scenario": {"gravity": _field("gravity", ScenarioFile.model_fields["gravity"])},
            "support": _fields(OnSurface),
            "start": _fields(Start),
            "run": _fields(Run),
            "ball": _fields(Ball),
        },
        "path": {kind: _fields(piece) for kind, piece in PathFile.kinds["path"].items()},
        "at_rest": OnSurface.model_fields["motion"].default.kind,
        "units": OFFERED,
    }


def words_of(scenario: ScenarioFile, key: str) -> dict[str, str]:
    """Return what the page calls a number of a scenario: its `label`, and the `group` that it stands in.

    Examples
    --------
    >>> import trundle as tr
    >>> words_of(tr.Scenario.load("rattleback"), "start.angular_velocity[2]")
    {'group': 'Start', 'label': 'Angular velocity z'}
    """
    group, label, value = "", "", cast(Any, scenario)
    told: dict[str, Any] = {}
    for part in re.findall(r"[^.\[\]]+", key):
        if part.isdigit():
            place, many = int(part), len(value)
            value = value[place]
            if isinstance(value, Table):
                label = f"{place + 1}." if many > 1 else ""
            elif key.startswith("start.position["):
                label = scenario.system().support.surface.coordinate_labels[place]
            else:
                label = f"{label} {told['names'][place] if told.get('names') else place + 1}"
            continue
        told, value = _told_of(value, part)
        label = f"{label} {told['label']}".strip()
        several = isinstance(value, tuple) and any(isinstance(one, Table) for one in value)
        if isinstance(value, Table) or several:
            group, label = (group if group and several else label), ""
    return {"group": group, "label": label}


def _told_of(table: Any, key: str) -> tuple[dict[str, Any], Any]:
    """Return what a control shows of a key of a table, and its value."""
    name, field = next((one, of) for one, of in type(table).model_fields.items() if key in (one, of.alias))
    kind = getattr(table, "kind", "")
    known = _load(kind, type(table))["fields"].get(key) if KINDS["loads"].get(kind) is type(table) else None
    return known or _field(key, field) or {"label": field.title or _words(key)}, getattr(table, name)


# --- families -----------------------------------------------------------------------------------------------


def _kind(kind: str, table: type[Table]) -> dict[str, Any]:
    part: Any = getattr(table, "part", None)
    said = (table.__doc__ or "").partition("\n\n")[0]
    common = OnSurface.model_fields if issubclass(table, OnSurface) else {}
    return {
        "label": getattr(part, "label", "") or _words(kind),
        "said": " ".join(said.split()),
        "fields": _fields(table, tuple(common)),
        "first": _first(kind, table),
    }


def _body(kind: str, table: type[Table]) -> dict[str, Any]:
    told = _kind(kind, table)
    body = table.model_validate(told["first"]).build()  # type: ignore[attr-defined]
    ball = ball_of(body)
    any_way = ball is not None and ball.concentric
    return {
        **told,
        "ball": any_way,
        "inertia_ratio": _ratio(table, told["first"]) if any_way else None,
        "start": _start_of_body(body),
    }


def _ratio(table: Any, first: dict[str, Any]) -> float | None:
    """Return k of a kind of ball that has only one; None of any other."""
    bodies = [table.model_validate({**first, "mass": mass}).build() for mass in (1.0, 2.0)]
    ratios = {float(body.inertia_ratio) for body in bodies if body.is_isotropic_sphere}
    return ratios.pop() if len(ratios) == 1 else None


def _start_of_body(body: Body) -> dict[str, Any]:
    """Return what of a start goes with a body: what could stand still leans and rocks, what would lie flat rolls."""
    if body.is_isotropic_sphere or body.shape.axis is not None:
        return {}
    covered = body.shape.validity_margin(-E_Z)
    if covered is not None and not covered > 0:
        return {"attitude": [0, "80 deg", 0], "velocity": ["30 cm/s", 0]}
    return {"attitude": [0, "20 deg", 0], "velocity": [0, 0]}


def _surface(kind: str, table: type[Table]) -> dict[str, Any]:
    told = _kind(kind, table)
    surface: Surface = _part(table, told["first"])
    pairs = zip(surface.coordinate_labels, surface.coordinates, strict=True)
    place = _example(Start.model_fields["position"])
    coordinates = [
        {"label": label, "dimension": dimension, "unit": _unit(place, dimension)} for label, dimension in pairs
    ]
    velocity = [0, 0] if surface.flat else [0, "50 cm/s"]
    return {**told, "coordinates": coordinates, "start": {"position": _place_on(surface), "velocity": velocity}}


def _place_on(surface: Surface) -> list[Any]:
    """Return a place on a surface that is not at its middle, where nothing would happen."""
    if surface.coordinates[0] == "angle":
        return ["30 deg", 0]
    for place in _FURTHEST:
        left = surface.domain_margin(surface.point(to_si(place, "length", "position"), 0.0))
        if left is None or left > 0:
            return [place, 0]
    return [0, 0]


def _motion(kind: str, table: type[Table]) -> dict[str, Any]:
    told = _kind(kind, table)
    return {**told, "rate": next((key for key in told["fields"] if _is_rate(table, told["first"], key)), None)}


def _is_rate(table: Any, first: dict[str, Any] | None, key: str) -> bool:
    """Tell whether a field is the number that says how fast the support turns on the whole."""
    if first is None or isinstance(first.get(key), list):
        return False
    formula = isinstance(getattr(_part(table, first), key), Expression)
    try:
        return not formula and [_part(table, {**first, key: rate}).mean_rate for rate in (1.0, 1.5)] == [1.0, 1.5]
    except InvalidValueError:
        return False


def _part(table: Any, values: dict[str, Any]) -> Any:
    """Return a part by what its table says."""
    return table.part(**{key: value for key, value in values.items() if key != "kind"})


def _load(kind: str, table: type[Table]) -> dict[str, Any]:
    told = _kind(kind, table)
    first = next(iter(told["fields"].values()))
    if first["type"] in ("number", "vector"):
        first["label"] = told["label"]  # what one first thinks of, such as the coefficient of drag
    return {**told, "usual": table.part.usual}  # type: ignore[attr-defined]


# --- fields -------------------------------------------------------------------------------------------------


def _first(kind: str, table: type[Table]) -> dict[str, Any] | None:
    """Return the table with which a kind is chosen: what it needs, and what else has an example of its own."""
    found = {"kind": kind}
    for key, field in table.model_fields.items():
        if key == "kind":
            continue
        example = _example(field)
        instead = any(isinstance(note, FormulaText) for note in _notes(field))  # a table of points may stand for it
        if field.is_required() or instead or field.examples:
            if example is None:
                return None
            found[key] = example
    return found


def _fields(table: type[BaseModel], without: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the fields of a table that a control can show, by key."""
    shown = ((key, _field(key, field)) for key, field in table.model_fields.items() if key not in without)
    return {key: field for key, field in shown if field is not None}


def _field(key: str, field: FieldInfo) -> dict[str, Any] | None:
    """Return what a control shows of a field; None where there is no control for it."""
    told: dict[str, Any] = {"label": field.title or _words(key), "said": field.description or ""}
    if field.default is None:
        told["optional"] = True
    elif not field.is_required() and not isinstance(field.default, Table):
        told["default"] = field.default
    if get_origin(field.annotation) is Literal:
        words = get_args(field.annotation)
        return {**told, "type": "choice", "words": list(words)} if key != "kind" else None
    for note in _notes(field):
        if isinstance(note, Measures) and not isinstance(note.each, Coordinate):
            names = note.names if note.size <= len(note.names) else ()
            return {
                **told,
                "type": "vector",
                "names": list(names),
                **_number(note.each, _usual(field, note.each), True),
            }
        if isinstance(note, Measure):
            return {**told, "type": "number", "example": _example(field), **_number(note, _usual(field, note), False)}
        if isinstance(note, FormulaText):
            return {**told, "type": "formula", "label": note.formula.said.removesuffix(".")}
    if field.annotation is str:
        return {**told, "type": "formula"}
    return None


def _number(measure: Measure, example: Any, many: bool) -> dict[str, Any]:
    """Return the dimension of a number, the unit to begin with, and the ends of its slider."""
    parts = example if isinstance(example, list) else [example]
    sizes = [size for part in parts if (size := _size(measure, part))]
    ends = slider(measure, max(sizes, key=abs, default=None))
    if many and measure.kind == "number":  # a direction
        ends |= {"min": -1.0, "max": 1.0}
    return {"dimension": measure.kind, "unit": _unit(parts, measure.kind), **ends}


def _usual(field: FieldInfo, measure: Measure) -> Any:
    """Return a usual value of a field: its example, its default or the example of what it is; None where none says."""
    if field.examples:
        return field.examples[0]
    if isinstance(field.default, float) and field.default:
        return field.default
    return json.loads(measure.example) if measure.example else None


def _size(measure: Measure, value: Any) -> float | None:
    try:
        return float(measure(value))
    except (InvalidValueError, ValueError):
        return None  # a formula


def _unit(examples: list[Any], dimension: str) -> str:
    """Return the unit of an example, the SI unit where it is a bare number; else that of the dimension's example."""
    texts = [text for text in examples if isinstance(text, str)]
    if any(examples) and not texts:
        return UNITS[dimension][0]
    for text in (*texts, UNITS[dimension][1]):
        for unit in OFFERED[dimension]:
            if unit and text.endswith(f" {unit}"):
                return unit
    return UNITS[dimension][0]


def _example(field: FieldInfo) -> Any:
    """Return an example of a field as it may stand in a scenario; None where there is none."""
    if field.examples:
        return field.examples[0]
    offers = [note.offer for note in _notes(field) if hasattr(note, "offer")]
    if get_origin(field.annotation) is Literal:
        return get_args(field.annotation)[0]
    return json.loads(offers[0]) if offers else None


def _notes(field: FieldInfo) -> Iterator[Any]:
    yield from field.metadata
    for part in get_args(field.annotation):
        yield from getattr(part, "__metadata__", ())


def _words(key: str) -> str:
    return key.replace("_", " ").replace("-", " ").capitalize()
