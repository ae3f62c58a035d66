"""What the lab's page makes of measured motion: a file read, or what has to be said of it; numbers fitted to it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError, TrundleError, UnknownNameError
from ..files import FILM_ENDINGS
from ..scenario import files
from ..units import UNITS
from . import limits
from .answers import answering, as_json, scenario_from
from .cache import Answer
from .errors import refused
from .exports import slug
from .parts import words_of

if TYPE_CHECKING:
    from ..analysis.fit import Fit
    from ..solve.samples import Array
    from ..tracks import Track

_MOST_VALUES = 12_000  # of a track that goes to the page and back
_FRAMES, _POINTS = 40, 250  # of the way that a fit went; of its path in each
_OUTLINES = 500  # of the fitted ball, in a film
# What may be asked of who brings a file, and answers to choose from; any other may be written.
_QUESTIONS: dict[str, tuple[str, ...]] = {
    "track": (),
    "columns": (),
    "units": ("m", "cm", "mm", "in", "px"),
    "time": ("s", "ms", "frame"),
    "rate": (),
    "pixel": (),
    "y": ("down", "up"),
    "sense": ("anticlockwise", "clockwise"),
    "decimal": ("point", "comma"),
}


# What the page calls numbers that are not of the scenario.
_WORDS = {
    "camera.scale": ("Camera", "Scale"),
    "camera.rotation": ("Camera", "Direction of its axes"),
    "camera.origin": ("Camera", "Origin"),
    "camera.time_offset": ("Camera", "Offset of its clock"),
    "mark.position": ("Mark on the support", "Position"),
    "mark.angle": ("Mark on the support", "Angle"),
    "spot.position": ("Spot on the body", "Position"),
    "gyroscope.mounting": ("Gyroscope", "Turn in the body"),
    "gyroscope.bias": ("Gyroscope", "Bias"),
}


@answering
def examples() -> Answer:
    """List the tracks that ship with the package, each with its file and what is asked of it.

    Examples
    --------
    >>> import json
    >>> [one["file"] for one in json.loads(examples().body)][0]
    'ball-in-a-bowl.csv'
    """
    from .. import tracks

    every = [tracks.example(name) for name in tracks.example_names()]
    return as_json(
        [
            {
                "name": one.name,
                "title": one.title,
                "about": one.about,
                "file": one.path.name,
                "content": one.path.read_text("utf-8"),
                "scenario": one.scenario,
                "free": one.free,
                "noise": one.noise,
            }
            for one in every
        ]
    )


@answering
def read(content: bytes, how: Mapping[str, Any], folder: str) -> Answer:
    r"""Read the track in a file that a visitor dropped on the page; ask for what the file does not say.

    Examples
    --------
    >>> import json, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     answer = read(b"t;x;y\n0;1;2\n1e-2;2;3\n", {"name": "track.txt"}, folder)
    >>> json.loads(answer.body)["asks"]["key"], json.loads(answer.body)["asks"]["choices"][:2]
    ('units', ['m', 'cm'])
    """
    from ..tracks import read_track
    from ..tracks.formats import endings
    from ..tracks.reading import track_names

    name = Path(how["name"].replace("\\", "/")).name
    ending = Path(name).suffix.lower()
    if ending in FILM_ENDINGS:
        remedy = "The page Measure finds the ball in it, and so does `trundle track`."
        raise refused(422, f"{name!r} is a film, and no track. {remedy}", "file")
    if ending not in endings():
        ends = f"{', '.join(endings()[:-1])} or {endings()[-1]}"
        raise refused(422, f"A track is a file that ends in {ends}; this is {name!r}. Export it as CSV.", "file")
    path = Path(folder) / f"{slug(Path(name).stem)}{ending}"
    path.write_bytes(content)
    try:
        return as_json(track_told(read_track(path, **_options(how))) | {"title": name})
    except UnknownNameError as error:
        raise refused(422, str(error), "track" if how.get("track") else "columns") from None
    except InvalidValueError as error:
        if error.key in _QUESTIONS and error.key not in how:
            choices = track_names(path) if error.key == "track" else _QUESTIONS[error.key]
            what = str(error.received).replace(f"{folder}/", "")
            return as_json({"asks": {"key": error.key, "rule": error.rule, "received": what, "choices": choices}})
        raise refused(422, str(error).replace(f"{folder}/", ""), error.key) from None


def _options(how: Mapping[str, Any]) -> dict[str, Any]:
    """Return what `read_track` takes."""
    given = {key: value for key, value in how.items() if key not in ("name", "units", "time", "angles", "columns")}
    units = {
        kind: how[key] for kind, key in (("length", "units"), ("time", "time"), ("angle", "angles")) if how.get(key)
    }
    return {**given, "units": units, "columns": _pairs(how.get("columns", ""))}


def _pairs(text: str) -> dict[str, str]:
    """Return 't=frame_time, x=u' as a mapping."""
    parts = [part.partition("=") for part in text.split(",") if part.strip()]
    if any(not (name.strip() and sign and heading.strip()) for name, sign, heading in parts):
        raise InvalidValueError("columns", "must be pairs NAME=HEADING", text, "Write for instance t=frame_time, x=u.")
    return {name.strip(): heading.strip() for name, _, heading in parts}


def track_told(track: Track) -> dict[str, Any]:
    """Return a track as the page has it, thinned where it is long."""
    from ..analysis.fit.observations import observable
    from ..tracks.names import kind_of

    most = min(limits.MOST_ROWS, _MOST_VALUES // (len(track.columns) + 1))
    step = -(-len(track) // most)
    called = {read: name for name, read in observable(track).items()}
    columns = {called.get(read, read): _listed(track[read][::step]) for read in ("t", *track.columns)}
    said = [
        track.clauses,
        track.rejections,
        *((f"`{name}` was left out: {why}",) for name, why in track.left_out.items()),
    ]
    if step > 1:
        said.append((f"Of {len(track)} rows the lab takes one in {step}; `trundle fit` takes all",))
    if track.frame != "support":
        rule = "must be along axes that do not turn"
        raise InvalidValueError("frame", rule, track.frame, "Turn the columns first.")
    units = {called.get(read, read): UNITS[kind_of(read) or "number"][0] for read in ("t", *track.columns)}
    accuracy = float(track.data.attrs.get("accuracy", 0.0))
    return {"title": track.source, "columns": columns, "units": units, "said": [one for one in said if one],
            "accuracy": accuracy}  # fmt: skip


@answering
def fitted(
    data: dict[str, Any],
    columns: Mapping[str, Sequence[float | None]],
    free: Sequence[str],
    noise: str | None,
    title: str = "data",
    accuracy: float = 0.0,
    view: Mapping[str, Any] | None = None,
) -> Answer:
    """Fit numbers of a scenario to a track: what was found, and the way there.

    Examples
    --------
    >>> import json
    >>> from ..tracks import example
    >>> ramp = example("ball-on-a-ramp")
    >>> seen = {name: _listed(ramp.track()[name]) for name in ("t", "x")}
    >>> found = json.loads(fitted(ramp.scenario, seen, ramp.free, ramp.noise).body)
    >>> found["answer"], found["rows"][0][1]
    ('good', '0.6502 ± 0.0014')
    """
    import numpy as np

    from ..analysis.fit.api import fit_observed
    from ..analysis.fit.camera import Camera
    from ..analysis.fit.observations import observe
    from ..extras import need

    need("fit", "the page Measure")
    scenario = scenario_from(data)
    seen = observe({name: np.array(column, dtype=float) for name, column in columns.items()}, label=title)
    way: list[tuple[Array, float, float]] = []

    def watch(values: Array, residual: Array, until: float) -> None:
        way.append((values.copy(), float(residual @ residual) / residual.size, until))

    found = fit_observed(
        [seen], scenario, free, None, noise, Camera(accuracy=accuracy or None), "linear", start=True, watch=watch
    )
    summary = found.as_dict()
    return as_json(
        {
            "title": found.title,
            "answer": found.answer,
            "verdict": found.verdict,
            "rows": found.rows,
            "unknown": [one["text"] for one in summary["undetermined"] if len(one["names"]) > 1],
            "remarks": found.remarks[: -len(found.problem.models)],
            "card": bool(summary["card_passed"]),
            "scenario": files.parse(found.scenario.to_toml(), found.title),
            "commented": found.to_toml(),
            "way": _way(found, way),
            "named": [{"key": one.name, **_called(found.scenario, one.name)} for one in found.estimates],
            "seen": None if view is None else _seen(found, view),
        }
    )


def _way(found: Fit, way: Sequence[tuple[Array, float, float]]) -> dict[str, Any]:
    """Return the path of some of the values that the fit came by, the last the fitted one."""
    import numpy as np

    model = found.problem.models[0]
    chosen = np.unique(np.linspace(0, len(way) - 1, min(len(way), _FRAMES)).astype(int))
    rows = np.unique(np.linspace(0, model.seen.time.size - 1, _POINTS).astype(int))
    frames = [way[place] for place in chosen] + [(found.values, found.judgement.reduced, 1.0)]
    paths = []
    for values, reduced, until in frames:
        with suppress(TrundleError, ArithmeticError):  # the fit came by, but nothing can move so
            predicted, _ = model.predict([float(value) for value in values], model.seen.time.size, slopes=False)
            columns = [_listed(column) for column in predicted[rows].T]
            paths.append({"reduced": reduced, "share": until, "columns": columns})
    return {"time": model.seen.time[rows].tolist(), "columns": list(model.seen.columns), "frames": paths}


def _called(scenario: Any, name: str) -> dict[str, str]:
    """Return what the page calls a number of a fit.

    Examples
    --------
    >>> import trundle as tr
    >>> _called(tr.Scenario.load("tilted-turntable"), "gyroscope.mounting[0]")
    {'group': 'Gyroscope', 'label': 'Turn in the body x'}
    """
    key, _, place = name.partition("[")
    if key not in _WORDS:
        return words_of(scenario, name)
    group, label = _WORDS[key]
    axis = f" {'xyz'[int(place.rstrip(']'))]}" if place else ""
    return {"group": group, "label": f"{label}{axis}"}


def _seen(found: Fit, view: Mapping[str, Any]) -> dict[str, Any]:
    """Return where a film shows the ball as it was fitted: the outline at some of the times of the track."""
    import numpy as np

    from .filming import outlines

    model, places = found.problem.models[0], found.predicted()[0]
    rows = np.unique(np.linspace(0, model.seen.time.size - 1, _OUTLINES).astype(int))
    at = [model.seen.columns.index(axis) for axis in "xy"]
    return {"time": model.seen.time[rows].tolist(), "outlines": outlines(view, places[rows][:, at])}


def _listed(values: Any) -> list[float | None]:
    """Return numbers as JSON has them: null for none."""
    return [float(value) if math.isfinite(value) else None for value in values]
