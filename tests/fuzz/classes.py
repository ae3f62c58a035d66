"""The four classes of scenarios: shipped ones with other numbers, near and far; parts of two together; anything."""

from __future__ import annotations

import copy
from collections.abc import Callable
from functools import cache
from random import Random
from typing import Any

from trundle.scenario import ScenarioFile, files

from . import drawing
from .leaves import Leaf, leaves, rounded, times

Tables = dict[str, Any]

_LONGEST = 10.0  # s of a run: a shipped one of three minutes is no test
_MOST = 1000  # samples


@cache
def shipped() -> dict[str, Tables]:
    """Return the tables of each scenario that ships."""
    return {name: files.parse(files.read(name), name) for name in ScenarioFile.names()}


def one_of(random: Random) -> Tables:
    """Return a copy of a shipped scenario."""
    return copy.deepcopy(shipped()[random.choice(list(shipped()))])


def gentle(random: Random) -> Tables:
    """Return a shipped scenario with numbers times a third to three."""
    found = one_of(random)
    _vary(found, random, 3.0, zeros=0.0)
    return found


def harsh(random: Random) -> Tables:
    """Return a shipped scenario with numbers times a thirtieth to thirty, zeros, other signs, another start."""
    found = one_of(random)
    _vary(found, random, 30.0, zeros=0.05)
    if random.random() < 0.3:
        other = drawing.start(random)
        keys = random.sample(sorted(other), random.randint(1, len(other)))
        found["start"] |= {key: other[key] for key in keys}
    return found


def recombine(random: Random) -> Tables:
    """Return a scenario whose parts come from two that ship."""
    pair = (one_of(random), one_of(random))

    def either() -> Tables:
        return random.choice(pair)

    found = {name: either()[name] for name in ("body", "start", "run")}
    support, motion = either()["support"], either()["support"].get("motion")
    found["support"] = {key: value for key, value in support.items() if key != "motion"}
    if motion is not None:
        found["support"]["motion"] = motion
    return {**found, **{name: tables[name] for name in ("loads", "gravity") for tables in [either()] if name in tables}}


def anything(random: Random) -> Tables:
    """Return a scenario of any body on any surface that moves in any way, under any loads."""
    found = drawing.anything(random)
    found["start"], found["run"] = drawing.start(random), {"duration": 2.0, "every": 0.02}
    return found


def _vary(tables: Tables, random: Random, factor: float, zeros: float) -> None:
    """Multiply some of the numbers, or all: most faults show where only a few have changed."""
    share = random.choice([0.1, 0.3, 1.0])
    for leaf in leaves(ScenarioFile, tables):
        if random.random() < share:
            leaf.holder[leaf.key] = _varied(leaf, random, factor, zeros)


def _varied(leaf: Leaf, random: Random, factor: float, zeros: float) -> Any:
    sign = -1.0 if random.random() < 0.1 else 1.0
    by = 0.0 if random.random() < zeros else sign * factor ** random.uniform(-1, 1)
    value = times(leaf.value, by)
    return value if leaf.allows(value) else leaf.value


CLASSES: dict[str, Callable[[Random], Tables]] = {
    "gentle": gentle,
    "harsh": harsh,
    "recombine": recombine,
    "anything": anything,
}


def candidate(name: str, random: Random) -> Tables:
    """Return a scenario of a class, which the format or the mechanics may refuse.

    Parameters
    ----------
    name : str
        One of `CLASSES`.
    random : Random
        Seeded.

    Returns
    -------
    dict
        Its tables.
    """
    found = CLASSES[name](random)
    found["run"] = _run(found["run"], random)
    found.pop("notes", None)
    return found


def mended(name: str, tables: Tables, key: str, random: Random) -> Tables:
    """Return a scenario after somebody who was told which key is wrong has tried to mend it.

    Parameters
    ----------
    name : str
        Its class.
    tables : dict
        The scenario that was refused.
    key : str
        That the refusal names.
    random : Random
        Seeded.

    Returns
    -------
    dict
        The same without the key or with another value there, or another scenario of the class.
    """
    table, _, rest = key.partition(".")
    word = rest.partition("[")[0]
    start = dict(tables.get("start", {}))
    turns = [one for one in ("orientation", "attitude") if one in start]
    if table == "start" and word in ("orientation", "attitude") and (turns or random.random() < 0.3):
        start = {one: value for one, value in start.items() if one not in turns}
        if random.random() < 0.7:
            start["attitude"] = drawing.start_key("attitude", random)
        return {**tables, "start": start}
    if table == "start" and word == "position" and random.random() < 0.8:
        return {**tables, "start": {**start, word: drawing.start_key(word, random)}}
    if table == "start" and word != "position" and start.pop(word, None) is not None:
        return {**tables, "start": start}
    if name == "anything" and table == "start" and random.random() < 0.9:  # the body does not go on that support
        return {**candidate(name, random), "body": tables["body"]}
    return candidate(name, random)


def _run(run: Tables, random: Random) -> Tables:
    """Return how long and how finely to run: as the scenario says, or a short while; never for minutes."""
    duration = _seconds(run["duration"])
    if random.random() < 0.5:
        duration = 0.3 * 10 ** random.random()
    duration = rounded(min(duration, _LONGEST))
    every = _seconds(run["every"])
    if random.random() < 0.5 or not duration / _MOST <= every <= duration:
        every = duration / (20 * 50 ** random.random())
    return {"duration": duration, "every": rounded(every), "method": drawing.method(random)}


def _seconds(value: Any) -> float:
    return float(drawing.si(value, "time"))
