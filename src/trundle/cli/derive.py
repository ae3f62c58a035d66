"""The command `trundle derive`: a derivation on screen or in a file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import InvalidValueError
from ..scenario import files
from . import screen


def _complete(incomplete: str) -> list[str]:
    from ..analysis.derivation.topics import TOPICS

    names = sorted({*TOPICS, *files.names()})
    return [name for name in names if name.startswith(incomplete)]


def derive(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[NAME]",
            help="A topic, a shipped scenario or a TOML file; absent: list them.",
            autocompletion=_complete,
        ),
    ] = None,
    markdown: Annotated[bool, typer.Option("--markdown", help="Write Markdown with $$ formulas.")] = False,
    latex: Annotated[bool, typer.Option("--latex", help="Write a fragment of LaTeX.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Write JSON, with each formula in LaTeX and text.")] = False,
    with_numbers: Annotated[
        bool, typer.Option("--with-numbers", help="Put the scenario's numbers in at the end.")
    ] = False,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="Write to a file instead of the screen.")
    ] = None,
) -> None:
    """Derive the motion of a rolling body, each equation proved by the code that computes it.

    The steps stand in the order of the lecture: Newton, Euler, rolling condition, elimination, path.
    """
    from ..analysis.derivation import derivable
    from ..analysis.derivation import derive as derivation_of

    chosen = [option for option, on in {"--markdown": markdown, "--latex": latex, "--json": as_json}.items() if on]
    if len(chosen) > 1:
        raise InvalidValueError(chosen[1], "must stand alone", " ".join(chosen), "Choose one form.")
    if name is None:
        screen.show_names(derivable())
        return
    try:
        derivation = derivation_of(name, with_numbers=with_numbers)
    except InvalidValueError as error:
        if error.key != "with_numbers":
            raise
        raise InvalidValueError("--with-numbers", error.rule, error.received, error.remedy) from None
    if as_json:
        text = screen.json_text(derivation.as_dict()) + "\n"
    else:
        text = derivation.markdown() if markdown else derivation.latex() if latex else derivation.text()
    if output is None:
        screen.out(text, end="")
        return
    _write(output.expanduser(), text)
    screen.out(f"Wrote {output}")


def _write(target: Path, text: str) -> None:
    from ..files import written_whole

    if target.is_dir():
        raise InvalidValueError("--output", "must be a file", str(target), "That is a folder.")
    with written_whole(target) as temporary:
        temporary.write_text(text, encoding="utf-8")
