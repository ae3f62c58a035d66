"""`trundle check`: somebody else's trajectory against the law of rolling."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from . import CANNOT_DECIDE, CARD_FAILED, screen
from .options import (
    NOTHING_SAID,
    FileFolder,
    Json,
    NoFigure,
    Quiet,
    Reading,
    WhatMoves,
    folder_for,
    no_scenario,
    reads_tracks,
)

if TYPE_CHECKING:
    from ..analysis.checking import Check

FIGURE = "check.png"
SI = {"length": "m", "time": "s", "angle": "rad"}  # what a column is in that does not say it


@reads_tracks
def check(
    theirs: Annotated[Path, typer.Argument(metavar="FILE", help="Their trajectory: a table, a track or a run.nc.")],
    scenario: WhatMoves = None,
    output: FileFolder = None,
    reading: Reading = NOTHING_SAID,
    axes: Annotated[str, typer.Option(metavar="AXES", help="Along which Ω is given: space or body.")] = "space",
    quaternion: Annotated[str, typer.Option(metavar="ORDER", help="wxyz or xyzw, where numbered.")] = "wxyz",
    orientation: Annotated[
        str, typer.Option(metavar="SENSE", help="body-to-space or space-to-body.")
    ] = "body-to-space",
    euler: Annotated[str, typer.Option(metavar="AXES", help="Of e1, e2, e3: xyz fixed, ZXZ of the body.")] = "xyz",
    frame: Annotated[str, typer.Option(metavar="FRAME", help="support, world or corotating.")] = "support",
    tolerance: Annotated[
        float, typer.Option(metavar="SHARE", help="To which it is held, as a share of the speed.")
    ] = 1e-5,
    no_figure: NoFigure = False,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Say whether somebody else's trajectory rolls without slipping and obeys the law, and if not, why.

    Exit status: 0, it holds; 2, bad input; 3, it does not hold; 4, these data cannot decide; 130, interrupted;
    1, all else.
    """
    from ..analysis.checking import check as check_trajectory
    from .writing import check_folder, write_together

    folder = folder_for(output, theirs)
    if not no_figure:
        check_folder(folder, (FIGURE,))
    moved = _scenario(theirs, scenario)
    read = reading.read(theirs, SI, frame=frame, axes=axes, quaternion=quaternion)
    found = check_trajectory(read, moved, orientation=orientation, euler=euler, tolerance=tolerance)
    written = [] if no_figure else write_together(folder, {FIGURE: lambda path: found.plot().savefig(path)})
    if as_json:
        screen.out(found.as_json())
    elif not quiet:
        _tell(found, written)
    if found.answer == "cannot decide":
        screen.note("trundle: these data cannot decide")
        raise typer.Exit(CANNOT_DECIDE)
    if not found.passed:
        failed = ", ".join(figure.name for figure in found.failures)
        screen.note(f"trundle: it does not hold: {failed}")
        raise typer.Exit(CARD_FAILED)


def _tell(found: Check, written: list[Path]) -> None:
    screen.show_card(found)
    if screen.on_terminal() and found.verdict:  # in a pipe the card's own text has it
        screen.out(found.verdict)
    screen.wrote(written)


def _scenario(theirs: Path, scenario: str | None) -> object:
    """Return the scenario that was named, or the one in a file of trundle's own."""
    if scenario is not None:
        return scenario
    if theirs.suffix == ".nc":
        from ..scenario import ScenarioFile
        from ..simulation.run_file import scenario_in

        text = scenario_in(theirs)
        if text:
            return ScenarioFile.loads(text, str(theirs))
    raise no_scenario()
