"""One of the commands that take a scenario or its run, on what nobody had tried it on: it ends in words."""

from __future__ import annotations

import contextlib
import shlex
import tempfile
from pathlib import Path
from typing import Any

from .drawing import seeded

# S is the scenario, N one of its numbers, R its run, T that as a table.
COMMANDS = (
    "twin S",
    "equilibria S",
    "steady S",
    "sensitivity S",
    "sensitivity S --by N --by N",
    "vakonomic S",
    "derive S --with-numbers",
    "equations S --as python",
    "equations S --as c -o law.c",
    "equations S --as javascript",
    "equations S --as latex",
    "export R run.html",
    "export R run.glb",
    "export R run.toml",
    "export R run.png",
    "export R run.svg",
    "export S run.fmu",
    "export S run.xml",
    "export S run.sdf",
    "export S run.urdf",
    "export S page.html --live",
    "read T",
    "fit T --scenario S --free N",
    "fit --plan --scenario S --free N",
    "check T --scenario S",
    "check R",
    "tolerance S 'gravity=9.8±0.1 m/s^2' --measure 'end hypot(vx, vy)' --members 4",
    "chaos S --count 2 --duration '1 s'",
    "steady S --periodic",
    "run S",
    "run S --method runge-kutta",
)


def status_of(command: str, text: str, run: Any) -> int:
    """Run a command on a scenario and its run in a folder of its own, and return its exit status; errors come through.

    Parameters
    ----------
    command : str
        One of `COMMANDS`.
    text : str
        The scenario, TOML.
    run : Trajectory
        What came of it.

    Returns
    -------
    int
        0, or what the command says besides.
    """
    import trundle as tr
    from trundle.analysis.sensitivities.keys import keys
    from trundle.cli.app import command as whole

    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        Path("scenario.toml").write_text(text, encoding="utf-8")
        run.save("run.nc")
        main = whole().main
        if " T" in command:
            main(["export", "run.nc", "run.csv", "--quiet"], prog_name="trundle", standalone_mode=False)
        files, numbers = {"S": "scenario.toml", "R": "run.nc", "T": "run.csv"}, keys(tr.Scenario.loads(text))
        seeded("numbers", text).shuffle(numbers)
        words = [numbers.pop().name if word == "N" else files.get(word, word) for word in shlex.split(command)]
        return int(main(words, prog_name="trundle", standalone_mode=False) or 0)


def is_wrong(command: str, status: int, run: Any) -> bool:
    """Tell whether a figure failed that should hold: of what does not roll all the way, a check or a fit may fail."""
    from trundle.cli import CARD_FAILED
    from trundle.solve.samples import ROLLING

    rolls = bool((run.data.phase.values == ROLLING).all())
    return status == CARD_FAILED and (rolls or not command.startswith(("check", "fit")))
