"""`trundle vakonomic`: the wrong path that stationary action under the constraint would give, beside the true one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import ScenarioError
from ..scenario import files
from . import screen

FILE = "vakonomic.png"

Name = Annotated[
    str,
    typer.Argument(
        metavar="SCENARIO",
        help="The name of a shipped one, or a TOML file.",
        autocompletion=lambda incomplete: [name for name in files.names() if name.startswith(incomplete)],
    ),
]


def vakonomic(
    scenario: Name,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FOLDER", help="Default: a folder of the scenario's name."),
    ] = None,
    multipliers: Annotated[
        tuple[float, float], typer.Option(metavar="X Y", help="λ at the start, along the plane, kg m/s.")
    ] = (0.0, 0.0),
    duration: Annotated[
        str | None, typer.Option(metavar="TIME", help="How long, such as '3 s'; one round of the ball.")
    ] = None,
    no_figure: Annotated[bool, typer.Option("--no-figure", help="Draw no figure.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON, and nothing else.")] = False,
) -> None:
    """Show how a ball would roll if the action were stationary under the constraint. It does not: a negative control.

    For a ball on a plane that is at rest or turns steadily. Writes vakonomic.png with both paths.
    """
    from .writing import check_folder, write_together

    folder = Path(Path(scenario).stem) if output is None else output.expanduser()
    tables = files.tables_of(scenario)
    if files.rolls_along_path(tables):
        remedy = "A ball rolled along a path feels no forces; name a scenario of a ball on a turntable."
        raise ScenarioError("path", "has no vakonomic counterpart", scenario, remedy)
    from ..analysis.vakonomic import compare_vakonomic
    from ..scenario import ScenarioFile

    if not no_figure:
        check_folder(folder, (FILE,))
    found = compare_vakonomic(ScenarioFile.read(tables, scenario), multipliers, duration=duration)
    written = [] if no_figure else write_together(folder, {FILE: lambda path: found.plot().savefig(path)})
    if as_json:
        import json

        screen.out(json.dumps(found.as_dict(), indent=2, ensure_ascii=False))
        return
    screen.out(str(found))
    if written:
        screen.out(f"Wrote {', '.join(str(path) for path in written)}")
