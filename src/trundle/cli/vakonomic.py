"""`trundle vakonomic`: the wrong path that stationary action under the constraint would give, beside the true one."""

from __future__ import annotations

from typing import Annotated

import typer

from . import screen
from .options import Folder, Json, Name, NoFigure, folder_for, load

FILE = "vakonomic.png"


def vakonomic(
    scenario: Name,
    output: Folder = None,
    multipliers: Annotated[
        tuple[float, float], typer.Option(metavar="X Y", help="λ at the start, along the plane, kg m/s.")
    ] = (0.0, 0.0),
    duration: Annotated[
        str | None, typer.Option(metavar="TIME", help="How long, such as '3 s'; one round of the ball.")
    ] = None,
    no_figure: NoFigure = False,
    as_json: Json = False,
) -> None:
    """Show how a ball would roll if the action were stationary under the constraint. It does not: a negative control.

    For a ball on a plane that is at rest or turns steadily. Writes vakonomic.png with both paths.
    """
    from .writing import check_folder, write_together

    folder = folder_for(output, scenario)
    from ..analysis.vakonomic import compare_vakonomic

    if not no_figure:
        check_folder(folder, (FILE,))
    found = compare_vakonomic(load(scenario), multipliers, duration=duration)
    written = [] if no_figure else write_together(folder, {FILE: lambda path: found.plot().savefig(path)})
    screen.show(found, written, as_json=as_json)
