"""A sweep as a file says it: read, checked as a whole, and written again."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidValueError, ScenarioError, did_you_mean
from ...scenario import files
from ...scenario.together import tell_all
from ...simulation import labels
from ...simulation.simulate import Scenario
from ...solve.sampling import sample_times
from ...units import sharing_unit
from .job import Job, block_of
from .measures import Measure, read_measures
from .varying import Axis, Design, check_values, grid_shape, numbers_of, read_axes

Array = NDArray[np.float64]

KEYS = (
    "title", "notes", "scenario", "run", "over", "table", "design", "members", "seed", "measure", "keep", "chunk"
)  # fmt: skip
_MOST_CHUNK, _MOST_BYTES, _PARTS = 1024, 2**24, 32  # members and bytes in a chunk; into so many at least
_HEAD = re.compile(r"(.*?)\s*\(([^()]+)\)", re.DOTALL)  # a key, and a unit in brackets
_BARE = re.compile(r"[-+−]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)
_SAMPLE_BYTES = 185  # about, of all that is sampled at an instant


@dataclass(frozen=True)
class Plan:
    """A sweep that has been checked."""

    title: str  # as the file has them
    notes: str  # as the file has them
    document: Scenario  # what is run, its numbers those of the file
    axes: tuple[Axis, ...]  # what varies
    design: Design  # how the values combine
    measures: tuple[Measure, ...]  # what is measured of each member
    keep: int  # each how-many-th sample is kept; 0: none
    chunk: int  # members in a chunk, a multiple of those that go together
    table: Array = field(compare=False, repr=False)  # (members, axes): the value of each axis for each member
    text: str = ""  # the sweep as TOML

    @cached_property
    def job(self) -> Job:
        """What is done with each member."""
        return Job(self.document.to_toml(), self.axes, self.measures, self.keep, block_of(self.members))

    @property
    def members(self) -> int:
        """How many there are."""
        return len(self.table)

    @property
    def chunks(self) -> int:
        """Into how many parts they are divided."""
        return -(-self.members // self.chunk)

    def values(self, chunk: int) -> Array:
        """Return the values of the members of a chunk."""
        return self.table[chunk * self.chunk : (chunk + 1) * self.chunk]

    @property
    def grid(self) -> tuple[int, ...] | None:
        """How many values each axis of a grid takes; None where the members are no grid."""
        return grid_shape(self.design, self.axes)

    @property
    def bytes(self) -> int:
        """How large the results are, before they are compressed."""
        each = sum(np.dtype(one.dtype).itemsize for one in self.measures) + 8 * len(self.axes) + 1
        return self.members * (each + self.job.times.size * labels.size_of(self.document.system()) * bool(self.keep))


def read_plan(
    tables: Mapping[str, Any], source: str = "", *, document: Scenario | None = None, near: Path | None = None
) -> Plan:
    """Check the tables of a sweep's file; tell of all that is wrong with it.

    Parameters
    ----------
    tables : mapping
        As TOML has them; from Python with arrays and functions besides.
    source : str
        The file, for messages.
    document : Scenario, optional
        Instead of the one that the file names.
    near : path, optional
        The folder that the file's own paths begin at.

    Examples
    --------
    >>> plan = read_plan({"scenario": "tilted-turntable", "over": {"gravity": [9.8, 9.9]}, "measure": "max z"})
    >>> plan.members, plan.axes[0].key
    (2, 'gravity')
    """
    try:
        unknown = partial(_check_keys, tables)
        if document is None:
            _, found = tell_all(unknown, partial(_scenario, tables.get("scenario"), tables.get("run"), near))
        else:
            _, found = tell_all(unknown, partial(_with_run, document, tables.get("run")))
        return _plan(tables, found, near)
    except InvalidValueError as error:
        told = [error, *getattr(error, "others", ())]
        if not source or all(getattr(one, "source", "") for one in told):
            raise
        raise ScenarioError.of(told, source) from None


def _plan(tables: Mapping[str, Any], document: Scenario, near: Path | None) -> Plan:
    over = tables.get("over")
    listed = None
    if tables.get("table") is not None:
        listed = _columns(tables["table"], near, document)
    read: Callable[[], list[Axis]] = partial(_axes, over, listed, document)
    name = tables.get("design", "grid" if listed is None else "together")
    design = Design(str(name), tables.get("members"), tables.get("seed", 0))
    axes, measures, keep = tell_all(
        read, partial(read_measures, tables.get("measure")), partial(_keep, tables.get("keep", "nothing"))
    )
    tell_all(
        partial(design.check, axes),
        *(partial(check_values, axis, document) for axis in axes),
        partial(_distinct, axes, measures),
        partial(_classes_first, design, measures),
    )
    table = design.table(axes)
    chunk = _chunk(tables.get("chunk"), len(table), keep, document)
    title = str(tables.get("title") or document.title)
    return Plan(
        title,
        str(tables.get("notes", "")),
        document,
        tuple(axes),
        design,
        tuple(measures),
        keep,
        chunk,
        table,
        _written(tables),
    )


def _check_keys(tables: Mapping[str, Any]) -> None:
    for key in tables:
        if key not in KEYS:
            remedy = f"{did_you_mean(key, KEYS)} There are: {', '.join(KEYS)}.".strip()
            raise InvalidValueError(str(key), "is no key of a sweep", tables[key], remedy)


def _scenario(given: Any, run: Any, near: Path | None) -> Scenario:
    if isinstance(given, Scenario):
        return _with_run(given, run)
    if isinstance(given, Mapping):
        return _read(dict(given), run, "scenario")
    if given is None:
        remedy = 'Write for instance: scenario = "tilted-turntable". `trundle list` names those that ship.'
        raise InvalidValueError("scenario", "must name the scenario that is swept", None, remedy)
    place = given
    if near is not None and isinstance(given, str) and given not in files.names() and (near / given).is_file():
        place = near / given
    return _read({**files.tables_of(place)}, run, str(given))


def _with_run(document: Scenario, run: Any) -> Scenario:
    if not run:
        return document
    return _read(document.model_dump(exclude_unset=True, by_alias=True), run, document.title)


def _read(tables: dict[str, Any], run: Any, source: str) -> Scenario:
    if run is not None:
        if not isinstance(run, Mapping):
            raise InvalidValueError("run", "must be a table", run, 'Write for instance: [run] duration = "10 s".')
        tables["run"] = {**tables.get("run", {}), **run}
    return Scenario.read(tables, source)


def _axes(over: Any, listed: dict[str, list[Any]] | None, document: Scenario) -> list[Axis]:
    if listed is None:
        return read_axes(over, document)
    if over:
        raise InvalidValueError("table", "must not stand beside `over`", "both", "Give one of the two.")
    return read_axes(listed, document)


def _columns(given: Any, near: Path | None, document: Scenario) -> dict[str, list[Any]]:
    """Return the columns of a table of members: a CSV file with the keys as its heads, or a mapping."""
    if isinstance(given, Mapping):
        return {str(key): list(values) for key, values in given.items()}
    place = Path(given) if near is None or Path(given).is_absolute() else near / given
    try:
        with place.open(newline="", encoding="utf-8-sig") as stream:
            rows = [row for row in csv.reader(stream) if row]
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidValueError("table", "must be a CSV file that can be read", str(given), f"{error}.") from None
    if len(rows) < 2 or any(len(row) != len(rows[0]) for row in rows):
        rule = "must have a head with the keys, and as many cells in each row"
        raise InvalidValueError("table", rule, str(given), "Write for instance: start.spin (rpm),support.tilt (deg)")
    read = (partial(_column, head, [row[i] for row in rows[1:]], document) for i, head in enumerate(rows[0]))
    return dict(tell_all(*read))


def _column(head: str, cells: list[str], document: Scenario) -> tuple[str, list[str]]:
    """Return the key and the values of a column, those without a unit in that of its head."""
    parts = _HEAD.fullmatch(head.strip())
    key, unit = (parts[1], parts[2]) if parts else (head.strip(), None)
    texts = [cell.strip() for cell in cells]
    shared = [sharing_unit((text, f"1 {unit}"))[0] for text in texts] if unit else texts
    known = numbers_of(document).get(key)
    if known is not None and known[1] and (bare := [text for text in shared if _BARE.fullmatch(text)]):
        rule = "must have a unit: in its head, or in each cell"
        raise InvalidValueError(f"table.{key}", rule, bare[0], f"Write as its head: {key} ({known[1]})")
    return key, shared


def _keep(given: Any) -> int:
    words = {"nothing": 0, "samples": 1}
    if isinstance(given, str) and given in words:
        return words[given]
    if isinstance(given, int) and not isinstance(given, bool) and given >= 1:
        return given
    rule = 'must be "nothing", "samples", or a whole number n, to keep each n-th sample'
    raise InvalidValueError("keep", rule, given)


def _distinct(axes: list[Axis], measures: list[Measure]) -> None:
    names = [axis.key for axis in axes]
    for one in measures:
        if one.name in names:
            raise InvalidValueError(f"measure.{one.name}", "must not have the name of what varies", one.name)


def _classes_first(design: Design, measures: list[Measure]) -> None:
    if design.name == "boundary" and not measures[0].classes:
        rule = 'must begin with a figure that has classes where the design is "boundary"'
        raise InvalidValueError("measure", rule, measures[0].text, "These are: turned-over, ending.")


def _chunk(given: Any, members: int, keep: int, document: Scenario) -> int:
    """Return how many members are written at once: small enough to lose little, large enough to run fast."""
    block = block_of(members)
    if given is not None:
        if isinstance(given, bool) or not isinstance(given, int) or given < 1:
            raise InvalidValueError("chunk", "must be a whole number of members, 1 or more", given)
        return -(-given // block) * block
    timing = document.timing
    kept = len(sample_times(float(timing.duration), float(timing.every))[:: keep or 1]) if keep else 0
    most = min(_MOST_CHUNK, _MOST_BYTES // (kept * _SAMPLE_BYTES) if kept else _MOST_CHUNK)
    return max(block, min(most, members // _PARTS) // block * block)


def _written(tables: Mapping[str, Any]) -> str:
    """Return the tables of a sweep as TOML, what varies in its order, and a scenario by its title."""
    import tomli_w

    plain = _plain(tables)
    heads = {key: value for key, value in plain.items() if not isinstance(value, dict)}
    if isinstance(tables.get("scenario"), Scenario):
        heads["scenario"] = tables["scenario"].title
    text = tomli_w.dumps(heads)
    for name, inner in plain.items():
        if isinstance(inner, dict) and name == "scenario":
            text += "\n" + tomli_w.dumps({name: inner})
        elif isinstance(inner, dict):  # each on a line: else what is a table would come after what is none
            lines = [f"{json.dumps(key, ensure_ascii=False)} = {_inline(part)}\n" for key, part in inner.items()]
            text += f"\n[{name}]\n" + "".join(lines)
    return text


def _inline(value: Any) -> str:
    import tomli_w

    if isinstance(value, dict):
        parts = (f"{json.dumps(key, ensure_ascii=False)} = {_inline(part)}" for key, part in value.items())
        return f"{{ {', '.join(parts)} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_inline, value))}]"
    return tomli_w.dumps({"v": value}).removeprefix("v = ").rstrip("\n")


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(part) for key, part in value.items() if part is not None}
    if isinstance(value, np.generic):
        return value.item()
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, (list, tuple, range)):
        return [_plain(part) for part in value]
    if isinstance(value, bool | int | float | str):
        return value
    return f"function {getattr(value, '__name__', '')}".strip() if callable(value) else str(value)
