"""`trundle tolerance`: how far a run may be off when some of its numbers are only known within limits."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import InvalidValueError
from . import screen, signals
from .options import Json, Name


def tolerance(
    scenario: Name,
    limits: Annotated[
        list[str], typer.Argument(metavar="KEY=VALUE±LIMIT...", help="Such as 'support.tilt=0±0.1 deg'.")
    ],
    measure: Annotated[
        str, typer.Option("--measure", "-m", metavar="FIGURE", help="What matters, such as 'end hypot(x, y)'.")
    ],
    duration: Annotated[
        str | None, typer.Option(metavar="TIME", help="Length of the run, such as '30 s', in place of the file's.")
    ] = None,
    every: Annotated[str | None, typer.Option(metavar="TIME", help="Time between samples.")] = None,
    members: Annotated[int, typer.Option(metavar="N", help="Of each of the sets drawn, a power of 2.")] = 256,
    normal: Annotated[bool, typer.Option("--normal", help="What stands after ± is a standard deviation.")] = False,
    seed: Annotated[int, typer.Option(metavar="N", help="Of the draws.")] = 0,
    figure: Annotated[Path | None, typer.Option("--figure", metavar="FILE", help="Draw it, as .png or .svg.")] = None,
    as_json: Json = False,
) -> None:
    """Say how far a run may be off when some numbers are only known within limits, and which of them matters most.

    The shares are Sobol's indices: the part of the variance that a number makes alone, and that in which it has any
    part. They need as many sets of runs as there are numbers, and two more.

    Exit status: 0, all is well; 2, bad input; 130, interrupted; 1, all else.
    """
    from ..analysis.sweep.tolerancing import tolerance as find

    over = dict(_limit(text) for text in limits)
    with screen.ProgressBar(wanted=not as_json, members=members * (len(over) + 2)) as bar:
        given = {"members": members, "normal": normal, "seed": seed, "duration": duration, "every": every}
        found = find(scenario, over, measure, progress=bar, **given)  # type: ignore[arg-type]
    signals.check()
    if figure is not None:
        from .writing import check_folder, write_together

        check_folder(figure.parent, (figure.name,))
        write_together(figure.parent, {figure.name: lambda path: found.plot().savefig(path)})
    screen.show(found, as_json=as_json)


def _limit(text: str) -> tuple[str, str]:
    """Return the key and the value of what is uncertain."""
    key, equals, value = text.partition("=")
    if not equals or not value.strip():
        raise InvalidValueError(
            "KEY=VALUE±LIMIT", "must be a key and its limits", text, "Write 'support.tilt=0±0.1 deg'."
        )
    return key.strip(), value.strip()
