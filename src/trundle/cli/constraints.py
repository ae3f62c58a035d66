"""`trundle constraints`: holonomic or not."""

from __future__ import annotations

from typing import Annotated

import typer

from ..analysis.holonomy.names import NAMES
from ..errors import InvalidValueError, UnknownNameError
from . import screen

Name = Annotated[
    str | None,
    typer.Argument(
        metavar="[SYSTEM]",
        help="The name of a system; without one they are listed.",
        autocompletion=lambda incomplete: [name for name in NAMES if name.startswith(incomplete)],
    ),
]


def constraints(
    system: Name = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON.")] = False,
    as_latex: Annotated[bool, typer.Option("--latex", help="Print the formulas as LaTeX.")] = False,
) -> None:
    """Say whether the constraints of a system can be integrated: rank, brackets, growth vector, verdict.

    For constraints of your own, use trundle.PfaffianSystem in Python.
    """
    if as_json and as_latex:
        raise InvalidValueError("--json", "must not stand beside --latex", "both", "Ask for one of the two.")
    if system is None:
        if as_json or as_latex:
            option = "--json" if as_json else "--latex"
            raise InvalidValueError(option, "must come with the name of a system", "no name")
        screen.show_names(list(NAMES.items()), "system")
        return
    if system not in NAMES:
        raise UnknownNameError("system of constraints", system, list(NAMES))
    from ..analysis.holonomy import PfaffianSystem

    found = PfaffianSystem.load(system).analyse()
    if as_json:
        screen.show_json(found.as_dict())
    else:
        screen.out(found.latex() if as_latex else str(found))
