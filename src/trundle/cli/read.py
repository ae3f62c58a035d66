"""`trundle read`: what is taken for what in a measured track, before anything is made of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InvalidValueError
from . import screen
from .options import NOTHING_SAID, Reading, reads_tracks

if TYPE_CHECKING:
    from ..tracks import Track

File = Annotated[
    Path, typer.Argument(metavar="FILE", help="A measured track, from Tracker for instance; or example:NAME.")
]


@reads_tracks
def read(
    file: File,
    reading: Reading = NOTHING_SAID,
    figure: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the track: track.png, or .svg, or .pdf.")
    ] = None,
) -> None:
    """Read a measured track, say what was taken for what, and ask for what the file does not tell.

    Exit status: 0, it was read; 2, it cannot be, or something has to be said; 130, interrupted; 1, all else.
    """
    found = reading.read(file)
    if figure is not None:
        _draw(found, figure)
    screen.out(str(found))
    if figure is not None:
        screen.wrote([figure])


def _draw(found: Track, target: Path) -> None:
    from ..files import written_whole

    if target.suffix.lower() not in (".png", ".svg", ".pdf"):
        raise InvalidValueError("--figure", "must end in .png, .svg or .pdf", str(target))
    drawn = found.plot()
    with written_whole(target) as temporary:
        drawn.savefig(temporary)
