"""How near a live page's motion is to that of `simulate`, at the defaults and at both ends of each slider.

`python -m tests.live.accuracy` prints it for every shipped scenario, with the time that a page takes.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from tests.fields.systems import DYNAMIC, node

import trundle as tr
from trundle.analysis.sensitivities.keys import moved
from trundle.errors import TrundleError
from trundle.live import law
from trundle.live.sliders import Slider, sliders_of
from trundle.simulation.trajectory import Trajectory
from trundle.views.scene import scene_of
from trundle.views.viewer.bundle import built

_SAMPLES = 40
# What a worker has, so that its script is run as it is.
_BEFORE = """
let hear, answer;
globalThis.addEventListener = (_, listener) => { hear = listener; };
globalThis.postMessage = (message) => { answer = message; };
"""
_BEHIND = """
function motion(values, times) {
  hear({ data: { id: 1, values, times } });
  if (!answer.course) throw new Error(answer.failed);
  return answer.course;
}
motion(asked[0][0]);
const found = asked.map(([values, times]) => {
  const begin = performance.now();
  motion(values);
  const took = performance.now() - begin;
  const { headline } = answer;
  return { ...motion(values, times), headline, took };
});
console.log(JSON.stringify(found));
"""
BOUND = 1e-9  # of the path


@dataclass(frozen=True)
class Compared:
    """One motion, in the page and by `simulate`."""

    where: str
    apart: float  # of the path
    alike: bool  # whether it ends in the same way and at the same time
    run: Trajectory | None
    told: Any  # by the page
    headline: Any  # of the server
    of_file: str = ""  # the sentence of the headline of the file's own numbers
    milliseconds: float = 0.0
    refused: str = ""  # by `simulate`


def compared(scenario: tr.Scenario, asked: Sequence[str] = ()) -> list[Compared]:
    """Compare the motions of a scenario at its defaults and at both ends of each slider."""
    law.check(scenario)
    sliders, placed = sliders_of(scenario, asked)
    values = [(where, _moved(sliders, where)) for where in ("", *_ends(sliders))]
    runs = [_run(scenario, moves) for _, moves in values]
    headlines = [None if isinstance(run, str) else scene_of(run).header["headline"] for run in runs]
    said = (headlines[0] or {"said": ""})["said"]
    text = law.script_of(scenario, [one.key for one in sliders], placed, said) + built("live-worker.js")
    wanted = [[] if isinstance(run, str) else _instants(run).tolist() for run in runs]
    asked_for = [[list(moves.values()), times] for (_, moves), times in zip(values, wanted, strict=True)]
    found = _in_node(text, asked_for)
    return [
        Compared(where, 0.0, True, None, told, None, refused=run)
        if isinstance(run, str)
        else replace(_compared(where, run, told, headline), of_file=said)
        for (where, _), run, told, headline in zip(values, runs, found, headlines, strict=True)
    ]


def _ends(sliders: Sequence[Slider]) -> list[str]:
    return [f"{one.key.name} {side}" for one in sliders for side in ("low", "high")]


def _moved(sliders: Sequence[Slider], where: str) -> dict[str, float]:
    name, _, side = where.partition(" ")
    return {one.key.name: getattr(one, side) if one.key.name == name else one.key.value for one in sliders}


def _run(scenario: tr.Scenario, moves: dict[str, float]) -> Trajectory | str:
    system, start = moved(scenario, moves)
    try:
        return tr.simulate(system, start, float(scenario.timing.duration), float(scenario.timing.every))
    except TrundleError as error:
        return str(error)


def _instants(run: Trajectory) -> Any:
    times = run.data.time.values
    return times[np.unique(np.linspace(0, times.size - 1, _SAMPLES).round().astype(int))]


def _in_node(text: str, asked: list[Any]) -> list[Any]:
    """Return what the script of a page makes of values and times, run by Node."""
    with tempfile.TemporaryDirectory(prefix="trundle-") as folder:
        script = Path(folder) / "main.cjs"
        script.write_text(f"{_BEFORE}{text}\nconst asked = {json.dumps(asked)};\n{_BEHIND}")
        command = [node(), script.name]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)  # noqa: S603
        assert done.returncode == 0, done.stderr[-2000:]
        found: list[Any] = json.loads(done.stdout)
        return found


def _compared(where: str, run: Trajectory, told: Any, headline: Any) -> Compared:
    place = run.data.position.values
    path = float(np.sum(np.linalg.norm(np.diff(place, axis=0), axis=1)))
    arm = float(np.linalg.norm(place[0] - run.data.contact.values[0]))
    times, rows = np.array(told["time"]), np.array(told["rows"], dtype=float)
    both = np.intersect1d(times, run.data.time.values)
    mine, theirs = rows[np.isin(times, both), :3], place[np.isin(run.data.time.values, both)]
    apart = float(np.abs(mine - theirs).max()) / max(path, arm)
    return Compared(where, apart, _ends_alike(run, told["ended"]), run, told, headline, told["took"])


def _ends_alike(run: Trajectory, told: Any) -> bool:
    """Tell whether both end early or neither, in the same way; a page also ends where it says that it cannot go on."""
    final = [event for event in run.events if event.final]
    if told is None:
        return not final
    same = [event for event in run.events if event.kind == told["kind"]]
    return any(abs(event.time - told["time"]) <= 1e-8 * max(event.time, 1e-3) for event in same)


def _line(headline: Any) -> str:
    return f"{headline['text']} ({headline['other']})" if headline else "-"


def main(names: Sequence[str]) -> None:
    """Print the worst of each scenario, and whatever is beyond the bound or ends otherwise."""
    for name in names or DYNAMIC:
        try:
            found = compared(tr.Scenario.load(name))
        except TrundleError as error:
            print(f"{name:34s} refused: {error}")
            continue
        worst, slowest = max(found, key=lambda one: one.apart), max(one.milliseconds for one in found)
        where = worst.where or "defaults"
        print(f"{name:34s} {found[0].apart:8.1e}  worst {worst.apart:8.1e} {where:28s} {slowest:5.0f} ms", flush=True)
        for one in found:
            if one.headline or one.told["headline"]:
                print(f"    {one.where or 'defaults':28s} {_line(one.told['headline'])} | {_line(one.headline)}")
            if one.apart > BOUND or not one.alike or one.refused:
                events = [event.text for event in one.run.events[:3]] if one.run else one.refused
                print(f"    {one.where}: {one.apart:.1e}, {events}, page: {one.told['events'][:3]}")


if __name__ == "__main__":
    main(sys.argv[1:])
