"""Challenges: a scenario, what of it may be changed, and what its run must show. Each is a file, as scenarios are."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from ..scenario import files
from .errors import refused

FOLDER = Path(__file__).resolve().parent.parent / "challenges"


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Control(_Part):
    """A number that the learner may choose, and where it stands in the scenario."""

    name: str
    label: str
    paths: Annotated[list[str], Field(min_length=1)]
    unit: str
    least: float
    most: float
    step: Annotated[float, Field(gt=0)]
    first: float
    pattern: str = "{value} {unit}"

    def written(self, value: float) -> str:
        """Return a value as a scenario says it."""
        return self.pattern.format(value=f"{value:.10g}", unit=self.unit)


class Named(_Part):
    """One of the bodies that move, where a challenge has several or does not tell what its body is."""

    name: str
    changes: dict[str, Any]


class Prediction(_Part):
    """What the learner is asked before anything moves."""

    question: str
    choices: Annotated[list[str], Field(min_length=2)]


class Condition(_Part):
    """What a run must show: a quantity over time, one number of it, and its bounds."""

    said: str
    quantity: str
    of: Literal["largest", "smallest", "mean", "last", "range"]
    unit: str
    least: float | None = None
    most: float | None = None
    control: str | None = None


class ByRun(_Part):
    """The answer is a run."""

    kind: Literal["run"]
    conditions: Annotated[list[Condition], Field(min_length=1)]


class ByNumber(_Part):
    """The answer is a number that was measured."""

    kind: Literal["number"]
    label: str
    value: float
    within: float


class ByChoice(_Part):
    """The answer is one of some."""

    kind: Literal["choice"]
    choices: list[str]
    right: str


class Teacher(_Part):
    """What a teacher wants to know before the lesson."""

    aim: str
    time: str
    wrong: list[str]
    apparatus: str


class Challenge(_Part):
    """A challenge, as its file says it.

    Examples
    --------
    >>> challenge("mystery-ball").level
    2
    """

    title: str
    level: Annotated[int, Field(ge=1, le=3)]
    summary: str
    task: str
    scenario: str
    hidden: bool = False
    hints: list[str]
    explain: str
    explanation: str
    setup: dict[str, Any] = {}
    bodies: list[Named] = []
    controls: Annotated[list[Control], Field(min_length=1)]
    prediction: Prediction
    answer: Annotated[ByRun | ByNumber | ByChoice, Field(discriminator="kind")]
    teacher: Teacher

    def told(self, name: str) -> dict[str, Any]:
        """Return what a page may know: not the answer, not what is hidden, not what is said afterwards."""
        shown = self.model_dump(
            include={"title", "level", "summary", "task", "hints", "explain", "controls", "prediction", "teacher"},
            exclude={"controls": {"__all__": {"paths", "pattern"}}},
        )
        answer = self.answer
        asked: dict[str, Any] = {"kind": answer.kind}
        if isinstance(answer, ByNumber):
            asked["label"] = answer.label
        if isinstance(answer, ByChoice):
            asked["choices"] = answer.choices
        return {"name": name, **shown, "answer": asked, "bodies": [body.name for body in self.bodies]}

    def tables(self, values: Mapping[str, float], body: str = "") -> dict[str, Any]:
        """Return the scenario with what the learner chose; refuse what the challenge does not offer."""
        tables = copy.deepcopy(files.tables_of(self.scenario))
        tables["title"] = self.title
        tables.pop("notes", None)
        for path, value in self.setup.items():
            put(tables, path, value)
        for path, value in self._body(body).changes.items():
            put(tables, path, value)
        known = {control.name: control for control in self.controls}
        for name in values:
            if name not in known:
                raise refused(422, "This challenge has no such control. Use those that it shows.", "values")
        for name, control in known.items():
            value = float(values.get(name, control.first))
            if not control.least <= value <= control.most:
                bounds = f"from {control.least:g} to {control.most:g} {control.unit}".rstrip()
                raise refused(422, f"{control.label} must lie {bounds}; got {value:g}.", "values")
            for path in control.paths:
                put(tables, path, control.written(value))
        return tables

    def _body(self, name: str) -> Named:
        if not self.bodies:
            return Named(name="", changes={})
        for body in self.bodies:
            if body.name == name:
                return body
        raise refused(422, f"The bodies here are: {', '.join(body.name for body in self.bodies)}.", "body")


def put(tables: Any, path: str, value: Any) -> None:
    """Put a value where a path leads, in tables and lists.

    Examples
    --------
    >>> tables = {"start": {"velocity": [0, 0]}}
    >>> put(tables, "start.velocity.1", "3 cm/s")
    >>> tables
    {'start': {'velocity': [0, '3 cm/s']}}
    """
    *way, last = path.split(".")
    at = tables
    for key in way:
        at = at[int(key)] if isinstance(at, list) else at.setdefault(key, {})
    if isinstance(at, list):
        at[int(last)] = value
    else:
        at[last] = value


def names() -> list[str]:
    """Return the names of the challenges: the easy ones first.

    Examples
    --------
    >>> names()[0]
    'one-round-in-five-seconds'
    """
    return sorted((path.stem for path in FOLDER.glob("*.toml")), key=lambda name: (challenge(name).level, name))


@cache
def challenge(name: str) -> Challenge:
    """Return a challenge by its name.

    Examples
    --------
    >>> challenge("home-turned").title
    'Make it come home turned by 90°'
    """
    if name not in {path.stem for path in FOLDER.glob("*.toml")}:
        raise refused(404, "There is no such challenge. Choose one of the list.", None, "NotFoundError")
    return Challenge.model_validate(tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8")))


def on_site() -> list[dict[str, Any]]:
    """Return what a page without a server says of all challenges: nothing of what their answers are.

    Examples
    --------
    >>> {"scenario", "hidden", "task"} <= set(on_site()[0]), "explanation" in on_site()[0]
    (True, False)
    """
    every = [(name, challenge(name)) for name in names()]
    return [{**one.told(name), "scenario": one.scenario, "hidden": one.hidden} for name, one in every]
