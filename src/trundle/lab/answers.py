"""What the workers compute: each answer is whole, in bytes, or a refusal that says why not."""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec

from ..scenario import files
from . import limits
from .cache import Answer
from .errors import Refusal, refusal_of, refused
from .requests import JSON, PICTURE, SCENE

if TYPE_CHECKING:
    from ..analysis.geometry import PathScenario
    from ..simulation.simulate import Scenario
    from ..simulation.trajectory import Trajectory
    from ..views.scene import Scene

P = ParamSpec("P")


def answering(function: Callable[P, Answer]) -> Callable[P, Answer | Refusal]:
    """Let a function return what the package says is wrong, instead of raising it.

    Examples
    --------
    >>> text_of("no-such-scenario").status
    404
    """

    @wraps(function)
    def answered(*arguments: P.args, **named: P.kwargs) -> Answer | Refusal:
        try:
            return function(*arguments, **named)
        except Exception as error:
            refusal = refusal_of(error)
            if refusal is not None:
                return refusal
            logging.getLogger("trundle.lab").exception("a mistake in the lab")
            return Refusal(500, f"This is a bug in trundle, {type(error).__name__}: {error}", None, "BugError")

    return answered


def scenario_from(data: Any) -> Scenario:
    """Return the scenario that a visitor sent, checked by the package's own model.

    Examples
    --------
    >>> scenario_from(files.tables_of("tilted-turntable")).body.kind
    'solid-sphere'
    """
    from ..simulation.simulate import Scenario

    limits.check_size(data)
    return Scenario.read(data, "")


def path_from(data: Any) -> PathScenario:
    """Return the path to roll along that a visitor sent; as `scenario_from`."""
    from ..analysis.geometry import PathScenario

    limits.check_size(data)
    return PathScenario.read(data, "")


def run_of(
    scenario: Scenario, most: int, wanted: int | None = None, tolerance: float | None = None
) -> tuple[Trajectory, float]:
    """Run a scenario.

    Examples
    --------
    >>> run_of(scenario_from(files.tables_of("tilted-turntable")), 5000)[0].method
    'exact'
    """
    duration, every = float(scenario.timing.duration), float(scenario.timing.every)
    limits.check_timing(duration, every, most)
    began = time.perf_counter()
    run = scenario.run(every=every if wanted is None else max(every, duration / (wanted - 1)), tolerance=tolerance)
    return run, time.perf_counter() - began


@answering
def simulate(
    data: dict[str, Any],
    samples: int | None = None,
    card: bool = False,
    tolerance: float | None = None,
    curves: bool = True,
    known: list[str] | None = None,
) -> Answer:
    """Run a scenario and pack what a viewer needs, without the meshes that it says it has.

    Examples
    --------
    >>> simulate(files.tables_of("tilted-turntable"), samples=100).body[:8]
    b'TRUNDLE1'
    """
    from ..views.scene import pack

    return Answer(pack(scene_from(data, samples, card, tolerance, curves), known), SCENE)


def scene_from(
    data: dict[str, Any],
    samples: int | None = None,
    card: bool = False,
    tolerance: float | None = None,
    curves: bool = True,
) -> Scene:
    """Run what a visitor sent, under forces or along a path, and return it as a scene.

    Examples
    --------
    >>> scene_from(files.tables_of("roll-x-then-y"), 50).header["closed"]
    False
    """
    from ..views.scene import scene_of

    if files.rolls_along_path(data):
        from ..analysis.geometry.scene import rolled_scene

        return rolled_scene(path_from(data).run(), samples, card)
    run, seconds = run_of(scenario_from(data), limits.MOST_SAVED, samples, tolerance)
    return scene_of(run, samples, card, seconds=seconds, curves=curves)


@answering
def card(data: dict[str, Any]) -> Answer:
    """Verify a run of a scenario.

    Examples
    --------
    >>> json.loads(card(files.tables_of("level-turntable-nudged")).body)["passed"]
    True
    """
    if files.rolls_along_path(data):
        return as_json(path_from(data).run().card().as_dict())
    run, _ = run_of(scenario_from(data), limits.MOST_SAMPLES)
    return as_json(run.card().as_dict())


@answering
def derivation(data: dict[str, Any]) -> Answer:
    """Derive the motion of a scenario, step by step.

    Examples
    --------
    >>> json.loads(derivation(files.tables_of("tilted-turntable")).body)["steps"][0]["title"]
    "Newton's law"
    """
    from .deriving import derivation_of

    return as_json(derivation_of(scenario_from(data)))


@answering
def twin(data: dict[str, Any], samples: int | None = None) -> Answer:
    """Find the charge in crossed fields that moves as the ball of a scenario does.

    Examples
    --------
    >>> twin(files.tables_of("tilted-turntable")).body[:8]
    b'TRUNDLE1'
    """
    from ..views.scene import pack
    from .charge import charge_scene

    scenario = scenario_from(data)
    limits.check_timing(float(scenario.timing.duration), float(scenario.timing.every), limits.MOST_SAVED)
    return Answer(pack(charge_scene(scenario, samples)), SCENE)


@answering
def roll(radius: Any, curve: Mapping[str, Any], samples: int | None = None, card: bool = False) -> Answer:
    """Roll a ball along a curve on a plane.

    Examples
    --------
    >>> roll("25 mm", {"kind": "straight", "turn": "90 deg"}).body[:8]
    b'TRUNDLE1'
    """
    from ..analysis.geometry.scene import rolled_scene
    from ..views.scene import pack
    from .curves import path_of

    return Answer(pack(rolled_scene(path_from(path_of(radius, curve)).run(), samples, card)), SCENE)


@answering
def catalogue() -> Answer:
    """List the scenarios that ship with the package.

    Examples
    --------
    >>> [entry["exact"] for entry in json.loads(catalogue().body) if entry["name"] == "tilted-turntable"]
    [True]
    """
    return as_json([_entry(name) for name in files.names()])


def _entry(name: str) -> dict[str, Any]:
    from ..mechanics.symmetry import ball_of
    from ..simulation.simulate import Scenario
    from ..solve.exact import closed_form

    tables = files.tables_of(name)
    summary = " ".join(str(tables.get("notes", "")).strip().partition("\n\n")[0].split())
    told = {"name": name, "title": tables["title"], "group": tables.get("group", ""), "summary": summary}
    if files.rolls_along_path(tables):
        return {**told, "support": "plane", "body": "sphere", "motion": "path", "exact": True, "level": 1}
    scenario = Scenario.read(tables, name)
    system = scenario.system()
    exact = closed_form(system, scenario.start_state()) is not None
    motion = tables["support"].get("motion", {}).get("kind", "fixed")
    harder = (not exact, not system.support.surface.flat or ball_of(system.body) is None)
    return {
        **told,
        "support": tables["support"]["kind"],
        "body": tables["body"]["kind"],
        "motion": motion,
        "exact": exact,
        "level": 1 + sum(harder),
    }


@answering
def text_of(name: str) -> Answer:
    """Return a scenario that ships with the package.

    Examples
    --------
    >>> json.loads(text_of("tilted-turntable").body)["scenario"]["body"]["kind"]
    'solid-sphere'
    """
    _check_name(name)
    text = files.read(name)
    return as_json({"name": name, "toml": text, "scenario": files.parse(text, name)})


@answering
def picture_of(name: str) -> Answer:
    """Draw a scenario that ships with the package, small.

    Examples
    --------
    >>> picture_of("roll-x-then-y").media_type
    'image/svg+xml'
    """
    from .pictures import SAMPLES, picture

    _check_name(name)
    return Answer(picture(scene_from(files.tables_of(name), SAMPLES)).encode("ascii"), PICTURE)


@answering
def challenges() -> Answer:
    """List the challenges, with all that a page may know of them.

    Examples
    --------
    >>> json.loads(challenges().body)[0]["level"]
    1
    """
    from .challenges import challenge, names

    return as_json([challenge(name).told(name) for name in names()])


@answering
def tried(name: str, values: dict[str, float], body: str, samples: int | None = None) -> Answer:
    """Run what a learner chose in a challenge, and pack what a viewer needs.

    Examples
    --------
    >>> tried("home-turned", {"east": 80.0}, "", 50).body[:8]
    b'TRUNDLE1'
    """
    from ..views.scene import pack
    from .challenges import challenge
    from .judging import run

    return Answer(pack(run(challenge(name), values, body, samples)), SCENE)


@answering
def judged(name: str, values: dict[str, float], answer: float | str | None) -> Answer:
    """Say whether an answer to a challenge is right.

    Examples
    --------
    >>> json.loads(judged("which-is-hollow", {}, "Ball B").body)["right"]
    False
    """
    from .challenges import challenge
    from .judging import judge

    return as_json(judge(challenge(name), values, answer))


@answering
def schema() -> Answer:
    """Return the JSON schema of scenario files.

    Examples
    --------
    >>> json.loads(schema().body)["title"]
    'trundle scenario'
    """
    from ..scenario import ScenarioFile

    return as_json(ScenarioFile.schema())


@answering
def parts() -> Answer:
    """Say what a scenario may be made of.

    Examples
    --------
    >>> json.loads(parts().body)["motion"]["spin"]["first"]
    {'kind': 'spin', 'rate': '33.3 rpm'}
    """
    from .parts import all_parts

    return as_json(all_parts())


@answering
def start(
    data: dict[str, Any], at: dict[str, Any], velocity: list[float] | None = None, nudge: list[float] | None = None
) -> Answer:
    """Say a start made by hand in the words of a scenario: dragged there, thrown, or going on from there after a nudge.

    Examples
    --------
    >>> at = {"position": [0.1, 0.0, 0.025], "contact": [0.1, 0.0, 0.0]}
    >>> json.loads(start(files.tables_of("tilted-turntable"), at).body)
    {'position': [0.1, 0.0]}
    """
    from .starts import start_by_hand

    return as_json(start_by_hand(scenario_from(data), at, velocity, nudge))


@answering
def possible(scenarios: Sequence[dict[str, Any]]) -> Answer:
    """Say of each of several scenarios why it cannot start, or None where it can.

    Examples
    --------
    >>> json.loads(possible([files.tables_of("tilted-turntable")]).body)
    [None]
    """
    return as_json([_why_not(data) for data in scenarios])


def _why_not(data: dict[str, Any]) -> dict[str, Any] | None:
    """Return the refusal of a scenario, without running it: by its tables, its start, and the phase that follows."""
    from ..solve import transitions

    try:
        if files.rolls_along_path(data):
            path_from(data)
            return None
        scenario = scenario_from(data)
        limits.check_timing(float(scenario.timing.duration), float(scenario.timing.every), limits.MOST_SAVED)
        system, start = scenario.system(), scenario.start_state()
        transitions.slipping(system, transitions.at_start(system, start))
    except Exception as error:
        refusal = refusal_of(error)
        if refusal is None:
            raise
        return refusal.told
    return None


def told(scenario: Scenario | PathScenario) -> dict[str, Any]:
    """Return a scenario as JSON tables and as TOML.

    Examples
    --------
    >>> told(scenario_from(files.tables_of("tilted-turntable")))["scenario"]["body"]["radius"]
    '25 mm'
    """
    text = scenario.to_toml()
    return {"scenario": files.parse(text, "scenario"), "toml": text}


def warm(name: str) -> None:
    """Answer about a shipped scenario once, so that the next answer finds everything loaded.

    Examples
    --------
    >>> warm("tilted-turntable")
    """
    simulate(files.tables_of(name), samples=50)


def _check_name(name: str) -> None:
    """Refuse a name that no shipped scenario has."""
    if name not in files.names():
        shown = ascii(name[:80])
        raise refused(404, f"There is no scenario {shown}. `/api/scenarios` lists them.", None, "NotFoundError")


def as_json(value: Any) -> Answer:
    """Return an answer in JSON.

    Examples
    --------
    >>> as_json([1.5]).body
    b'[1.5]'
    """
    return Answer(json.dumps(value, ensure_ascii=True, allow_nan=False).encode("ascii"), JSON)
