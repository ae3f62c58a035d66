"""`trundle equilibria`: where a body stays when it is put down at rest."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import ScenarioError
from ..scenario import files
from . import screen

FILE = "equilibria.png"


def _complete(incomplete: str) -> list[str]:
    return [name for name in files.names() if name.startswith(incomplete)]


Name = Annotated[
    str,
    typer.Argument(metavar="SCENARIO", help="The name of a shipped one, or a TOML file.", autocompletion=_complete),
]


def equilibria(
    scenario: Name,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FOLDER", help="Default: a folder of the scenario's name."),
    ] = None,
    turns: Annotated[
        str | None,
        typer.Option(metavar="NUMBER", help="How many turns of a cylinder to search, either way."),
    ] = None,
    no_figure: Annotated[bool, typer.Option("--no-figure", help="Draw no figure.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON, and nothing else.")] = False,
) -> None:
    """Find where the body of a scenario stays when it is put down at rest, and write equilibria.png.

    Each place comes with its contact force, the friction needed there, and whether the body comes back when nudged.
    """
    from .writing import check_folder, write_together

    folder = Path(Path(scenario).stem) if output is None else output.expanduser()
    tables = files.tables_of(scenario)
    if files.rolls_along_path(tables):
        remedy = "A ball rolled along a path feels no forces; name a scenario with a body under gravity."
        raise ScenarioError("path", "has no equilibria", scenario, remedy)
    from ..analysis.statics import equilibria as find
    from ..scenario import ScenarioFile

    if not no_figure:
        check_folder(folder, (FILE,))
    found = find(ScenarioFile.read(tables, scenario), turns=turns)
    written = [] if no_figure else write_together(folder, {FILE: lambda path: found.plot().savefig(path)})
    if as_json:
        import json

        screen.out(json.dumps(found.as_dict(), indent=2, ensure_ascii=False))
        return
    screen.out(str(found))
    if written:
        screen.out(f"Wrote {', '.join(str(path) for path in written)}")
