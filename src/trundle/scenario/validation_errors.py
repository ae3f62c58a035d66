"""One `ScenarioError` from whatever pydantic found: the key's path, the rule, what came, what to do."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from ..errors import InvalidValueError, ScenarioError, did_you_mean
from .fields import Diameter, diameter_of

# Which class stands for which table, by path and kind.
Kinds = Mapping[str, Mapping[str, type[BaseModel]]]


class Nothing:
    """What came, where nothing did."""

    def __repr__(self) -> str:
        return "nothing"


@dataclass(frozen=True)
class Complaint:
    """One thing that is wrong with a file."""

    path: str
    rule: str
    received: Any
    remedy: str
    unknown: bool = False  # the key is none of the format's
    missing: bool = False


def complain(error: ValidationError, model: type[BaseModel], source: str = "") -> ScenarioError:
    """Turn a pydantic error into the message that a reader gets, a line for each thing that is wrong."""
    found = [complaint for detail in error.errors(include_url=False) for complaint in _translate(detail, model)]
    found = _without_echoes(sorted(found, key=lambda complaint: not complaint.unknown))
    return ScenarioError.of((InvalidValueError(one.path, one.rule, one.received, one.remedy) for one in found), source)


def _without_echoes(found: list[Complaint]) -> list[Complaint]:
    """Drop a missing key that an unknown one is a misspelling of."""
    meant = {
        path_of(complaint.path, name)
        for complaint in found
        if complaint.unknown
        for suggested in re.findall(r"^Did you mean '(.*?)'", complaint.remedy)
        for name in (suggested, suggested.replace("diameter", "radius"))
    }
    return [complaint for complaint in found if not (complaint.missing and complaint.path in meant)]


def path_of(beside: str, name: str) -> str:
    """Return the path of the key `name` in the table that holds the key `beside`."""
    return beside.rpartition(".")[0] + "." * ("." in beside) + name


def _translate(detail: Any, model: type[BaseModel]) -> list[Complaint]:
    path, table, key, inside = _locate(detail["loc"], model)
    kind, received = detail["type"], detail["input"]
    if kind == "value_error" and isinstance(detail["ctx"]["error"], InvalidValueError):
        if isinstance(received, Diameter):
            path = path_of(path, received.key)
        told = detail["ctx"]["error"]
        return [
            Complaint(_join(path, one.key), one.rule, one.received, one.remedy)
            for one in (told, *getattr(told, "others", ()))
        ]
    return [_complaint(kind, received, detail["msg"], path, table, key, inside, model)]


def _complaint(
    kind: str,
    received: Any,
    message: str,
    path: str,
    table: type[BaseModel],
    key: str,
    inside: type[BaseModel] | None,
    model: Any,
) -> Complaint:
    """Return what pydantic's own checks found."""
    if kind == "missing":
        return Complaint(path, "must be given", Nothing(), _how_to_add(_keys(table)[key], key, model), missing=True)
    if kind == "extra_forbidden":
        return _no_key(path, key, received, table)
    if kind == "string_unicode" and inside is not None:  # half a character in a key, for which no key is looked at
        return _no_key(_join(path, quoted(received)), received, received, inside)
    if kind == "union_tag_not_found":
        known = list(_kinds(path, model))
        remedy = f'Say which, for instance: kind = "{known[0]}". {_there_are(known)}'
        return Complaint(_join(path, "kind"), "must be given", Nothing(), remedy, missing=True)
    if kind == "union_tag_invalid":
        return _not_one_of(_join(path, "kind"), received.get("kind"), _kinds(path, model))
    if kind in ("literal_error", "string_unicode") and get_origin(_keys(table)[key].annotation) is Literal:
        offered = get_args(_keys(table)[key].annotation)
        known = list(offered) if key != "kind" else list(_kinds(path.rpartition(".")[0], model))
        return _not_one_of(path, received, known)
    rule, remedy = _SHAPES.get(kind, (f"is not as it should be ({message})", ""))
    return Complaint(path, rule, received, remedy.format(path=path))


_SHAPES = {
    "string_type": ("must be text", "Put it in quotes."),
    "string_unicode": ("must be text of whole characters", "Leave out what is half a character: \\ud800 to \\udfff."),
    "invalid_key": ("is no key: keys are text", "Put it in quotes."),
    "bool_type": ("must be true or false", "Write it without quotes."),
    "tuple_type": ("must be a list of tables", "Head each with [[{path}]]."),
    "model_type": ("must be a table", "Head it with [{path}] and give its keys below."),
    "model_attributes_type": ("must be a table", "Head it with [{path}] and give its keys below."),
    "dict_type": ("must be a table", "Head it with [{path}] and give its keys below."),
}


def _no_key(path: str, key: str, received: Any, table: type[BaseModel]) -> Complaint:
    known = [name for own in _keys(table) for name in (own, diameter_of(table, own)) if name]
    place = f"[{path.removesuffix(quoted(key)).removesuffix('.')}]" if path != quoted(key) else "the file"
    remedy = f"{did_you_mean(key, known)} {_there_are(known)}".strip()
    return Complaint(path, f"is no key of {place}", received, remedy, unknown=True)


def _not_one_of(path: str, received: Any, known: Any) -> Complaint:
    hint = did_you_mean(received, known) if isinstance(received, str) else ""
    remedy = f"{hint} {_there_are(known)}".strip()
    return Complaint(path, "must be one of those that exist", received, remedy)


def _there_are(known: Iterable[str]) -> str:
    return f"There are: {', '.join(known)}."


def _kinds(path: str, model: Any) -> Mapping[str, type[BaseModel]]:
    return model.kinds[re.sub(r"\[\d+\]", "", path)]


def _locate(
    loc: tuple[int | str, ...], model: type[BaseModel]
) -> tuple[str, type[BaseModel], str, type[BaseModel] | None]:
    """Return the path of a pydantic location, the table class that holds its last key, that key, and its own class.

    The last is None where the key is no table's. Where a table has several kinds, pydantic puts the kind into the
    location; a reader knows of no such part.
    """
    path, key, table = "", "", model
    inside: type[BaseModel] | None = model  # holds the keys that come next; None: the next part is a kind
    for part in loc:
        if isinstance(part, int):
            path = f"{path}[{part}]"
        elif inside is None:
            inside = _kinds(path, model)[part]
        else:
            table, key, path = inside, part, _join(path, quoted(part))
            inside = _table_of(table, key, path, model)
    return path, table, key, inside


def _table_of(table: type[BaseModel], key: str, path: str, model: Any) -> type[BaseModel] | None:
    kinds = list(model.kinds.get(path, {}).values())
    if kinds:
        return kinds[0] if len(kinds) == 1 else None
    return _plain_table(_keys(table)[key]) if key in _keys(table) else None


def _keys(table: type[BaseModel]) -> dict[str, FieldInfo]:
    return {field.alias or name: field for name, field in table.model_fields.items()}


def _plain_table(field: FieldInfo) -> type[BaseModel] | None:
    kind = field.annotation
    return kind if isinstance(kind, type) and issubclass(kind, BaseModel) else None


def _join(path: str, key: str) -> str:
    return path + key if not path or not key or key.startswith("[") else f"{path}.{key}"


def quoted(key: str) -> str:
    """Return a key as it may be printed: what is no bare key comes quoted, cut and escaped."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]{1,60}", key) else repr(key[:60])


def _how_to_add(field: FieldInfo, key: str, model: Any) -> str:
    table = _plain_table(field)
    if key in model.kinds:
        table = next(iter(model.kinds[key].values()))
    if table is None:
        return f"Add for instance: {_example(field, key)}"
    wanted = {name: inner for name, inner in _keys(table).items() if inner.is_required() or _one_of_two(inner)}
    lines = [_example(inner, name) for name, inner in wanted.items()]
    head = f"[[{key}]]" if get_origin(field.annotation) is tuple else f"[{key}]"
    return f"Add for instance, each on a line of its own: {head} {' ; '.join(lines)}"


def _one_of_two(field: FieldInfo) -> bool:
    """Tell whether a key may be left out only where another stands for it, as a mass may for a density."""
    return (field.description or "").startswith("Required")


_LISTS = {"parts": '[[support.motion.parts]] kind = "spin" ; rate = "33.3 rpm"'}  # of tables


def _notes(part: Any) -> tuple[Any, ...]:
    return getattr(part, "__metadata__", ())


def _example(field: FieldInfo, key: str) -> str:
    if get_origin(field.annotation) is tuple and key in _LISTS:
        return _LISTS[key]
    if field.examples:
        offer = f'"{field.examples[0]}"' if isinstance(field.examples[0], str) else str(field.examples[0])
    elif get_origin(field.annotation) is Literal:
        offer = f'"{get_args(field.annotation)[0]}"'
    else:
        offer = ""
    for note in (*(note for part in get_args(field.annotation) for note in _notes(part)), *field.metadata):
        offer = getattr(note, "offer", None) or offer
    return f"{key} = {offer}"
