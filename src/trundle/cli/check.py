"""`trundle check`: somebody else's trajectory against the law of rolling."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InvalidValueError
from . import CANNOT_DECIDE, CARD_FAILED, screen
from .read import Columns, Decimal, Pixel, Rate, Upwards, Which, pairs

if TYPE_CHECKING:
    from ..analysis.checking import Check

FIGURE = "check.png"


def check(
    theirs: Annotated[Path, typer.Argument(metavar="FILE", help="Their trajectory: a table, a track or a run.nc.")],
    scenario: Annotated[
        str | None,
        typer.Option("--scenario", "-s", metavar="SCENARIO", help="What moves: a shipped scenario or a TOML file."),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FOLDER", help="Default: a folder of the file's name.")
    ] = None,
    track: Which = None,
    columns: Columns = None,
    axes: Annotated[str, typer.Option(metavar="AXES", help="Along which Ω is given: space or body.")] = "space",
    angles: Annotated[str, typer.Option(metavar="UNIT", help="rad or deg, also of rates.")] = "rad",
    quaternion: Annotated[str, typer.Option(metavar="ORDER", help="wxyz or xyzw, where numbered.")] = "wxyz",
    orientation: Annotated[
        str, typer.Option(metavar="SENSE", help="body-to-space or space-to-body.")
    ] = "body-to-space",
    euler: Annotated[str, typer.Option(metavar="AXES", help="Of e1, e2, e3: xyz fixed, ZXZ of the body.")] = "xyz",
    frame: Annotated[str, typer.Option(metavar="FRAME", help="support, world or corotating.")] = "support",
    time: Annotated[str, typer.Option(metavar="UNIT", help="Of time, such as ms.")] = "s",
    length: Annotated[
        str, typer.Option("--length", "--unit", metavar="UNIT", help="Of positions, such as mm; speeds per second.")
    ] = "m",
    rate: Rate = None,
    pixel: Pixel = None,
    y: Upwards = None,
    decimal: Decimal = None,
    tolerance: Annotated[
        float, typer.Option(metavar="SHARE", help="To which it is held, as a share of the speed.")
    ] = 1e-5,
    no_figure: Annotated[bool, typer.Option("--no-figure", help="Draw no figure.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the card as JSON, and nothing else.")] = False,
) -> None:
    """Say whether somebody else's trajectory rolls without slipping and obeys the law, and if not, why.

    Exit status: 0, it holds; 2, bad input; 3, it does not hold; 4, these data cannot decide; 130, interrupted;
    1, all else.
    """
    from ..analysis.checking import check as check_trajectory
    from ..tracks import read_track
    from .writing import check_folder, write_together

    folder = Path(theirs.stem) if output is None else output.expanduser()
    if not no_figure:
        check_folder(folder, (FIGURE,))
    moved = _scenario(theirs, scenario)
    read = read_track(
        theirs,
        track=track,
        columns=pairs(columns),
        units={"time": time, "length": length, "angle": angles},
        rate=rate,
        pixel=pixel,
        y=y,
        decimal=decimal,
        frame=frame,
        axes=axes,
        quaternion=quaternion,
    )
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
    if written:
        screen.out(f"Wrote {written[0]}")


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
    raise InvalidValueError(
        "--scenario", "must say what moves", "none", "Name a shipped one (`trundle list`) or a TOML file."
    )
