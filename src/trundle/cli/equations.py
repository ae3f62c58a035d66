"""The command `trundle equations`: a system's law as a program, or as formulas."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

import typer

from ..errors import InvalidValueError, UnknownNameError
from . import screen
from .options import Name, load

FORMS = {"c": "c", "python": "numpy", "javascript": "javascript", "latex": "sympy", "jax": "jax"}  # and their backends


def equations(
    scenario: Name,
    form: Annotated[
        str,
        typer.Option(
            "--as", metavar="FORM", help="c, python, javascript, latex or jax.", autocompletion=lambda: list(FORMS)
        ),
    ] = "python",
    phase: Annotated[
        str | None,
        typer.Option(
            metavar="PHASE",
            help="rolling, slipping, held_slipping, flight or rest. Default: that in which the scenario starts.",
        ),
    ] = None,
    inputs: Annotated[
        str | None,
        typer.Option(
            metavar="LIST", help="Of force, torque and support; '' for none. Default: all, and none in LaTeX."
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="Write to a file; for C, its header beside it."),
    ] = None,
) -> None:
    """Print the right-hand side of a system's law, for a program of your own or to read.

    A program has every phase of the system, its events and what follows them; LaTeX has one phase.

    Exit status: 0, all is well; 2, bad input; 130, interrupted; 1, all else.
    """
    from ..fields.routines import starting_phase
    from ..files import written_whole

    if form not in FORMS:
        raise UnknownNameError("form", form, FORMS)
    if output is not None and output.expanduser().is_dir():
        raise InvalidValueError("--output", "must be a file", str(output), "That is a folder.")
    loaded = load(scenario)
    system, start = loaded.system(), loaded.start_state()
    groups: tuple[str, ...] = ("force", "torque", "support") if form != "latex" else ()
    if inputs is not None:
        groups = tuple(part.strip() for part in inputs.split(",") if part.strip())
    phase = starting_phase(system, start) if phase is None else phase
    try:
        field = system.vector_field(FORMS[form], phase, groups)
    except InvalidValueError as error:
        raise InvalidValueError("--phase", error.rule, error.received, error.remedy) from None
    if output is None:
        screen.out(field.source(start=start), end="")
        return
    target = output.expanduser()
    prefix = re.sub(r"\W|^(?=\d)", "_", target.stem, flags=re.ASCII)
    texts = {target: field.source(prefix, start)}
    if form == "c":
        texts[target.with_suffix(".h")] = field.header(prefix)
    for path, text in texts.items():
        with written_whole(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
    screen.out(f"Wrote {', '.join(map(str, texts))}")
