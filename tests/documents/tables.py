"""The documents' tables of parts, made from what the parts say of themselves: `make tables` writes them.

A table stands between `<!-- table: NAME -->` and `<!-- end -->`; what stands there is written anew.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from trundle.mechanics.bodies import Body
from trundle.mechanics.loads import Load
from trundle.mechanics.motions import Motion
from trundle.mechanics.parts import fields_of, kinds_of, sentence_of
from trundle.mechanics.surfaces import Surface
from trundle.scenario import ScenarioFile
from trundle.scenario.fields import Coordinate, Measure, Measures, Varying
from trundle.scenario.tables import KINDS, Run, Start, Table
from trundle.scenario.tables.of_parts import Direction, FormulaText, ListOfLengths, Worded
from trundle.scenario.tables.supports import OnSurface
from trundle.solve.exact import CLOSED_FORMS
from trundle.units import UNITS

DOCS = Path(__file__).parents[2] / "docs"
PLACE = re.compile(r"(<!-- table: ([\w ]+) -->\n).*?(<!-- end -->)", re.DOTALL)
SIGNS = {"positive": "positive", "not negative": "0 or more", "any": "any"}


def rendered(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a table in Markdown."""
    lines = [list(heads), *map(list, rows)]
    lines.insert(1, ["---"] * len(lines[0]))
    return "".join(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in line)} |\n" for line in lines)


def code(words: Iterable[Any]) -> str:
    return ", ".join(f"`{word}`" for word in words)


# --- the keys of a family, each told once for all kinds that mean the same by it ----------------------------------


def keys(kinds: dict[str, type[Table]], prefix: str = "") -> str:
    """Return the table of the keys of a family of parts."""
    told: dict[str, dict[tuple[str, ...], list[str]]] = {}
    for kind, table in kinds.items():
        for key, field in table.model_fields.items():
            if key not in {"kind", "motion"}:
                told.setdefault(key, {}).setdefault(about(key, field), []).append(kind)
    shared = [key for key in told if key == "tilt" or key in OnSurface.model_fields]
    told |= {key: told.pop(key) for key in shared}  # after what is special to a kind
    rows = [
        [f"`{prefix}{key}`", of(having, list(kinds)), *cells]
        for key, each in told.items()
        for cells, having in each.items()
    ]
    of_kind = [f"`{prefix}kind`", "all", "What it is.", "", default_of(kinds), code(kinds)]
    return rendered(("key", "of", "what", "unit", "default", "allowed"), [of_kind, *rows])


def default_of(kinds: dict[str, type[Table]]) -> str:
    """Return the kind that is taken where none is named."""
    resting = OnSurface.model_fields["motion"].default.kind
    return f"`{resting}`" if resting in kinds else "required"


def of(having: list[str], kinds: list[str]) -> str:
    """Say which kinds have a key."""
    others = [kind for kind in kinds if kind not in having]
    if not others:
        return "all"
    return f"all but {code(others)}" if len(others) < len(having) and len(others) < 4 else code(having)


def keys_of(table: Any, *, without: tuple[str, ...] = ()) -> str:
    """Return the table of the keys of one table of a file."""
    fields = {field.alias or key: field for key, field in table.model_fields.items()}
    rows = [[f"`{key}`", *about(key, field)] for key, field in fields.items() if key not in without]
    return rendered(("key", "what", "unit", "default", "allowed"), rows)


def about(key: str, field: Any) -> tuple[str, ...]:
    """Return what a key is, its unit, its default, and what is allowed."""
    what = field.description or f"{field.title or key.replace('_', ' ').capitalize()}."
    units, allowed = zip(*told_by(field), strict=True)
    return (
        what,
        " or ".join(filter(None, dict.fromkeys(units))),
        default(field),
        ", or ".join(filter(None, dict.fromkeys(allowed))),
    )


def default(field: Any) -> str:
    if field.is_required():
        return "required"
    value = field.default
    if value is None or value == "":
        return ""
    return f"`[{', '.join(f'{part:g}' for part in value)}]`" if isinstance(value, tuple) else f"`{short(value)}`"


def short(value: Any) -> str:
    return repr(value).removesuffix(".0") if isinstance(value, float) else str(value)


def told_by(field: Any) -> list[tuple[str, str]]:
    """Return the unit of a key, and what may stand there."""
    if get_origin(field.annotation) is Literal:
        return [("", code(get_args(field.annotation)))]
    found = [each for note in notes(field) for each in of_note(note)]
    return found or [("", "text" if field.annotation is str else "motions, each with a kind and keys of its own")]


def notes(field: Any) -> Iterator[Any]:
    yield from field.metadata
    for part in get_args(field.annotation):
        yield from getattr(part, "__metadata__", ())


def of_note(note: Any) -> Iterator[tuple[str, str]]:
    match note:
        case Direction():
            yield "", f"{note.size} numbers, not all 0"
        case Measures():
            how_many = f"{note.size}" if note.most is None else f"{note.size} to {note.most}"
            unit, allowed = zip(*of_note(note.each), strict=True)
            numbers = f"{how_many} numbers{'' if allowed[0] in {'', 'any'} else f', each {allowed[0]}'}"
            yield unit[0], " or ".join([numbers, *(f"formulas in {code('t')}" for _ in allowed[1:])])
            if note.words:
                yield "", code(f'"{word}"' for word in note.words)
        case Measure():
            units = [note.kind, note.otherwise] if isinstance(note, Coordinate) else [note.kind]
            yield " or ".join(unit_of(kind) for kind in units), SIGNS[note.sign] if note.check is None else ""
            if isinstance(note, Varying):
                yield "", "a formula in `t`"
            if isinstance(note, Worded):
                yield "", code(f'"{word}"' for word in note.words)
        case FormulaText():
            yield "", f"a formula in {code(note.formula.variables)}"
        case ListOfLengths():
            yield unit_of("length"), "lists of lengths" if note.rows else "a list of lengths"


def unit_of(dimension: str) -> str:
    """Return the SI unit of a dimension as it is printed."""
    unit = UNITS[dimension][0] or "1"
    return unit.replace("^2", "²").replace("^3", "³").replace("*", " ")


# --- the kinds of a family ------------------------------------------------------------------------------------


def kinds_of_parts(family: Any) -> str:
    """Return the table of the motions or loads."""
    rows = (
        [f"`{kind}`", f"`{part.__name__}`", sentence_of(part), code(fields_of(part))]
        for kind, part in kinds_of(family).items()
    )
    return rendered(("kind", "class", "what it is", "keys"), rows)


def surfaces() -> str:
    """Return the table of the surfaces, with how a place on each is said."""
    rows = []
    for kind, part in kinds_of(Surface).items():
        made = [f"{part.__name__}({', '.join(fields_of(part))})"]
        made += [f"{part.__name__}.through({', '.join(part.points)})"] if part.points else []
        rows.append([f"`{kind}`", code(made), sentence_of(part), " and ".join(part.coordinate_labels).lower()])
    return rendered(("kind", "in Python", "what it is", "coordinates"), rows)


def bodies() -> str:
    """Return the table of the builders of bodies."""
    rows = (
        [f"`{kind}`", f"`{make.__name__}`", sentence_of(make), code(fields_of(make))]
        for kind, make in Body.builders().items()
    )
    return rendered(("kind", "`Body.`", "what it is", "keys"), rows)


def closed_forms() -> str:
    """Return the table of the closed forms, in the order in which they are asked."""
    return rendered(
        ("equation", "what for", "it covers"), ([form.equation, form.name, form.domain()] for form in CLOSED_FORMS)
    )


TABLES: dict[str, Callable[[], str]] = {
    "top": lambda: keys_of(ScenarioFile, without=("body", "support", "start", "loads", "run")),
    "body keys": lambda: keys(KINDS["body"]),
    "support keys": lambda: keys(KINDS["support"]),
    "motion keys": lambda: keys(KINDS["support.motion"], "motion."),
    "load keys": lambda: keys(KINDS["loads"]),
    "start": lambda: keys_of(Start),
    "run": lambda: keys_of(Run),
    "bodies": bodies,
    "surfaces": surfaces,
    "motions": lambda: kinds_of_parts(Motion),
    "loads": lambda: kinds_of_parts(Load),
    "closed forms": closed_forms,
}


def written_anew(text: str) -> str:
    """Return a document with its tables as the parts are now."""
    return PLACE.sub(lambda found: f"{found[1]}\n{TABLES[found[2]]()}\n{found[3]}", text)


if __name__ == "__main__":
    for page in sorted(DOCS.glob("*.md")):
        text = page.read_text(encoding="utf-8")
        if (new := written_anew(text)) != text:
            page.write_text(new, encoding="utf-8")
            print(f"wrote {page.name}")
