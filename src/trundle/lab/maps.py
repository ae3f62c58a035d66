"""Maps as the lab's page computes them: a sweep over two numbers, a second's work at a time, coarse to fine."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError
from . import limits
from .answers import answering, as_json, scenario_from, told
from .cache import Answer
from .parts import words_of

if TYPE_CHECKING:
    from ..analysis.sweep.plan import Plan
    from ..simulation.simulate import Scenario

_GO = 0.7  # s, of work that one request asks for; the page asks again for more
_FIRST, _TOGETHER = 8, 64  # members that go together: few at first, as nobody knows how long they take
_SAMPLES = 320_000  # of members that go together: what memory there is for them
_COARSE = 5  # squares along the shorter side at first: something is to be seen soon
_SHADES = 64


@answering
def sweeps() -> Answer:
    """List the sweeps over two numbers that ship with the package, with what a map of any other may measure.

    Examples
    --------
    >>> import json
    >>> [one["name"] for one in json.loads(sweeps().body)["sweeps"]]
    ['rattleback', 'shaken-bowl', 'tippe-top']
    """
    import numpy as np
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    from ..analysis.sweep import shipped
    from ..analysis.sweep.figure import NUMBERS, palette
    from ..analysis.sweep.measures import figures

    shades = [to_hex(shade) for shade in colormaps[NUMBERS](np.linspace(0, 1, _SHADES))]
    colours = {"numbers": shades, "classes": palette(7)}
    listed = [_shipped(name, shipped.tables_of(name), shipped.load(name)) for name, _ in shipped.titles()]
    return as_json({"sweeps": [one for one in listed if one["over"]], "figures": figures(), "colours": colours})


def _shipped(name: str, tables: Any, plan: Plan) -> dict[str, Any]:
    """Return a sweep as the page begins with it; without `over` where it is none over two spans."""
    spans = [{"key": key, "scale": "linear", **span} for key, span in tables["over"].items() if isinstance(span, dict)]
    spans = [{**span, "count": min(span["count"], limits.MOST_SIDE)} for span in spans if "count" in span]
    return {
        "name": name,
        "title": plan.title,
        "notes": " ".join(plan.notes.split()),
        "scenario": told(plan.document)["scenario"],
        "over": spans if len(spans) == len(plan.axes) == 2 else [],
        "measures": {one.name: one.text for one in plan.measures},
    }


@answering
def map_numbers(data: dict[str, Any]) -> Answer:
    """List the numbers of a scenario that a map may go over, in SI, each with the words of its control.

    Examples
    --------
    >>> import json
    >>> from ..scenario import files
    >>> json.loads(map_numbers(files.tables_of("tilted-turntable")).body)[1]
    {'key': 'body.radius', 'group': 'Body', 'label': 'Radius', 'value': 0.025, 'unit': 'm'}
    """
    from ..analysis.sweep.varying import numbers_of

    scenario = _rolling(data)
    known = numbers_of(scenario).items()
    return as_json(
        [
            {"key": key, **words_of(scenario, key), "value": value, "unit": unit}
            for key, (value, unit) in known
            if isinstance(value, float) and not key.startswith(("run.", "start.time"))
        ]
    )


@answering
def draw_map(
    data: dict[str, Any], over: Sequence[dict[str, Any]], measure: str, places: Sequence[int], values: Sequence[Any]
) -> Answer:
    """Go on with a map for about a second: what was run, and the picture as far as it is known.

    Examples
    --------
    >>> import json
    >>> from ..scenario import files
    >>> tables = files.tables_of("tilted-turntable")
    >>> spans = [{"key": "support.tilt", "from": 0, "to": 0.01, "count": 2}, {"key": "gravity", "from": 9, "to": 10}]
    >>> found = json.loads(draw_map(tables, [spans[0], {**spans[1], "count": 3}], "end-time", [], []).body)
    >>> sorted(found["places"]), found["left"], len(found["picture"])
    ([0, 1, 2, 3, 4, 5], 0, 6)
    """
    import numpy as np

    from ..analysis.sweep.refining import next_places

    plan = _plan(data, over, measure)
    shape, wanted = tuple(span["count"] for span in over), plan.measures[0]
    run, found = np.zeros(plan.members, dtype=bool), np.full(plan.members, np.nan)
    _check_places(places, plan.members)
    run[places] = True
    none = -1.0 if wanted.classes else np.nan  # a class of its own, of which the boundary is looked for too
    found[places] = [none if value is None else value for value in values]
    grid, everywhere = run.reshape(shape), not wanted.classes
    new: list[int] = []
    samples = float(plan.document.timing.duration) / float(plan.document.timing.every)
    most = min(_TOGETHER, max(_FIRST, int(_SAMPLES / samples)))
    begun, together = time.perf_counter(), _FIRST
    left, picture = next_places(grid, found.reshape(shape), everywhere=everywhere, coarse=_COARSE)
    while left.size and (not new or time.perf_counter() - begun < _GO):
        part = left[:together]
        columns = replace(plan.job, block=together).run(plan.table[part])
        found[part], run[part] = columns[wanted.name], True
        new += part.tolist()
        together = min(2 * together, most)
        left, picture = next_places(grid, found.reshape(shape), everywhere=everywhere, coarse=_COARSE)
    return as_json(
        {
            "shape": list(shape),
            "axes": [
                {
                    "key": axis.key,
                    **words_of(plan.document, axis.key),
                    "unit": axis.unit,
                    "values": [] if axis.values is None else axis.values.tolist(),
                }
                for axis in plan.axes
            ],
            "unit": wanted.unit,
            "classes": list(wanted.classes),
            "places": new,
            "values": _listed(found[new], none),
            "picture": _listed(picture.ravel(), none),
            "run": int(run.sum()),
            "left": int(left.size),
        }
    )


@answering
def map_point(data: dict[str, Any], over: Sequence[dict[str, Any]], place: int) -> Answer:
    """Return the scenario of one field of a map.

    Examples
    --------
    >>> import json
    >>> from ..scenario import files
    >>> spans = [{"key": "support.tilt", "from": 0, "to": 0.01, "count": 2}, {"key": "gravity", "from": 9, "to": 10}]
    >>> found = map_point(files.tables_of("tilted-turntable"), [spans[0], {**spans[1], "count": 3}], 5)
    >>> json.loads(found.body)["scenario"]["gravity"]
    10.0
    """
    plan = _plan(data, over, "end-time")
    _check_places([place], plan.members)
    return as_json(told(plan.job.member(plan.table[place])))


def _plan(data: dict[str, Any], over: Sequence[dict[str, Any]], measure: str) -> Plan:
    """Return the sweep of a map, checked; all that is wrong with it is told in the words of a sweep's file."""
    from ..analysis.sweep.plan import read_plan

    first, second = over
    if first["key"] == second["key"]:
        raise InvalidValueError("over", "must be two numbers", first["key"], "Choose another for one of the sides.")
    spans = {span["key"]: {name: part for name, part in span.items() if name != "key"} for span in over}
    return read_plan({"over": spans, "measure": measure}, document=_rolling(data))


def _rolling(data: dict[str, Any]) -> Scenario:
    """Return a scenario of which many members can be run."""
    from ..scenario import files

    if files.rolls_along_path(data):
        raise InvalidValueError("scenario", "must have forces and a start", "a path", "Choose one that rolls freely.")
    scenario = scenario_from(data)
    limits.check_timing(float(scenario.timing.duration), float(scenario.timing.every), limits.MOST_SAMPLES)
    return scenario


def _check_places(places: Sequence[int], members: int) -> None:
    if any(place >= members for place in places):
        raise InvalidValueError("place", f"must be below {members}, the number of fields", max(places))


def _listed(values: Any, none: float) -> list[float | None]:
    """Return numbers as JSON has them: null for none."""
    return [float(value) if math.isfinite(value) and value != none else None for value in values]
