"""`trundle equilibria`: where a body stays when it is put down at rest."""

from __future__ import annotations

from typing import Annotated

import typer

from . import screen
from .options import Folder, Json, Name, NoFigure, folder_for, load

FILE = "equilibria.png"


def equilibria(
    scenario: Name,
    output: Folder = None,
    turns: Annotated[
        str | None,
        typer.Option(metavar="NUMBER", help="How many turns of a cylinder to search, either way."),
    ] = None,
    no_figure: NoFigure = False,
    as_json: Json = False,
) -> None:
    """Find where the body of a scenario stays when it is put down at rest, and write equilibria.png.

    Each place comes with its contact force, the friction needed there, and whether the body comes back when nudged.
    """
    from .writing import check_folder, write_together

    folder = folder_for(output, scenario)
    from ..analysis.statics import equilibria as find

    if not no_figure:
        check_folder(folder, (FILE,))
    found = find(load(scenario), turns=turns)
    written = [] if no_figure else write_together(folder, {FILE: lambda path: found.plot().savefig(path)})
    screen.show(found, written, as_json=as_json)
