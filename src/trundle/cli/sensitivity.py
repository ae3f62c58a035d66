"""`trundle sensitivity`: which shortcoming of a turntable matters most; or derivatives by any numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InvalidValueError
from . import CARD_FAILED, screen, signals
from .options import Folder, Json, Name, NoFigure, Quiet, folder_for, load

if TYPE_CHECKING:
    from ..analysis.imperfections import Sensitivity

FILE = "sensitivity.png"
FILES = ("sensitivities.nc", "sensitivities.png")
HORIZON = "1 h"
OPTIONS = {  # where they differ from Python's names
    "rolling_resistance": "--rolling-resistance",
    "variation": "--uneven",
    "variation_rate": "--uneven-rate",
}


def sensitivity(
    scenario: Name,
    output: Folder = None,
    tilt: Annotated[str | None, typer.Option(metavar="ANGLE", help="Of the table, such as '0.1 deg'.")] = None,
    drag: Annotated[
        str | None, typer.Option(metavar="C", help="Of the air, at rest and turning, such as '0.1 g/s'.")
    ] = None,
    rolling_resistance: Annotated[
        str | None, typer.Option(metavar="LENGTH", help="How far ahead the normal force acts, such as '5 um'.")
    ] = None,
    wobble: Annotated[
        str | None, typer.Option(metavar="ANGLE", help="Between table and axle, such as '0.1 deg'.")
    ] = None,
    uneven: Annotated[
        str | None, typer.Option(metavar="SHARE", help="By which the table's rate varies, such as 0.01.")
    ] = None,
    uneven_rate: Annotated[
        str | None, typer.Option(metavar="RATE", help="At which it varies, such as '33.3 rpm'; else once a turn.")
    ] = None,
    horizon: Annotated[
        str | None,
        typer.Option(metavar="TIME", help=f"How long to wait for the ball; default {HORIZON}. With --by: of the run."),
    ] = None,
    by: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY", help="A number to differentiate the run by, such as support.tilt; repeat for more."
        ),
    ] = None,
    no_figure: NoFigure = False,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Vary one shortcoming of a turntable at a time, and rank them by how soon the ball is off; write sensitivity.png.

    A size that is not given is the scenario's own where it has that shortcoming; else 0.1 deg of tilt, 0.1 deg of
    wobble, a rate uneven by 1 % once a turn, the drag of room air on the ball, and a resistance to rolling of a
    ten-thousandth of the weight.

    With --by it takes any scenario, and returns the exact first derivatives of its run by the numbers named, in
    sensitivities.nc, with a figure.
    """
    from ..analysis.imperfections import sensitivity as vary
    from .writing import check_folder, write_together

    folder = folder_for(output, scenario)
    sizes: dict[str, Any] = {
        "tilt": tilt,
        "drag": drag,
        "rolling_resistance": rolling_resistance,
        "wobble": wobble,
        "variation": uneven,
        "variation_rate": uneven_rate,
    }
    if by:
        _refuse(sizes)
        _differentiate(scenario, by, horizon, folder, figure=not no_figure, quiet=quiet, as_json=as_json)
        return
    names = () if no_figure else (FILE,)
    check_folder(folder, names)
    loaded = load(scenario)
    try:
        with screen.ProgressBar(wanted=not quiet) as bar:
            table = vary(loaded, **sizes, horizon=HORIZON if horizon is None else horizon, progress=bar)
    except InvalidValueError as error:
        option = OPTIONS.get(error.key, f"--{error.key}")
        if error.key in sizes or error.key == "horizon":
            raise InvalidValueError(option, error.rule, error.received, error.remedy) from None
        raise
    signals.check()
    written = write_together(folder, {name: lambda path: table.plot().savefig(path) for name in names})
    if as_json:
        screen.out(table.as_json())
    elif not quiet:
        _show(table)
        screen.wrote(written)


def _refuse(sizes: dict[str, Any]) -> None:
    """Refuse sizes of shortcomings beside numbers to differentiate by."""
    for name, size in sizes.items():
        if size is not None:
            option = OPTIONS.get(name, f"--{name}")
            remedy = "Write it into the scenario, and name its key."
            raise InvalidValueError(option, "must not stand beside --by", size, remedy)


def _differentiate(
    scenario: str, by: list[str], horizon: str | None, folder: Path, *, figure: bool, quiet: bool, as_json: bool
) -> None:
    """Show the derivatives of a run by some numbers, and write them."""
    from ..analysis.sensitivities import sensitivities
    from ..simulation.netcdf import write_dataset
    from .writing import check_folder, write_together

    data, picture = FILES
    check_folder(folder, FILES if figure else (data,))
    loaded = load(scenario)
    try:
        with screen.ProgressBar(wanted=not quiet) as bar:
            found = sensitivities(loaded, by, duration=horizon, progress=bar)
    except InvalidValueError as error:
        option = {"wrt": "--by", "duration": "--horizon"}.get(error.key, error.key)
        raise InvalidValueError(option, error.rule, error.received, error.remedy) from None
    signals.check()
    files = {data: lambda path: write_dataset(found.data, path)}
    if figure:
        files[picture] = lambda path: found.plot().savefig(path)
    written = write_together(folder, files)
    screen.show(found, written, quiet=quiet, as_json=as_json)
    if found.passed is False:
        raise typer.Exit(CARD_FAILED)


def _show(table: Sensitivity) -> None:
    """Print the table: ruled on a terminal, its own plain text anywhere else."""
    if not screen.on_terminal():
        screen.out(str(table))
        return
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from ..analysis.imperfections.report import HEADINGS

    ruled = Table(*HEADINGS, box=SIMPLE_HEAD)
    for row, cells in zip((*table.rows, table.given), table.cells, strict=True):
        style = "bold" if row.leaves is not None else ""
        ruled.add_row(*(Text(cell, style=style if i == 2 else "") for i, cell in enumerate(cells)))
    console = Console(highlight=False)
    console.print(Text(table.title, style="bold"))
    console.print(Text(table.heading))
    console.print(ruled)
