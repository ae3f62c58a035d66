"""`trundle read`: what is taken for what in a measured track, before anything is made of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InvalidValueError
from . import screen

if TYPE_CHECKING:
    from ..tracks import Track

File = Annotated[
    Path, typer.Argument(metavar="FILE", help="A measured track, from Tracker for instance; or example:NAME.")
]
Which = Annotated[str | None, typer.Option("--track", metavar="NAME", help="Which track, where there are several.")]
Columns = Annotated[
    str | None, typer.Option("--columns", metavar="LIST", help="Names that do not tell: 't=frame_time, x=u, y=v'.")
]
Rate = Annotated[float | None, typer.Option("--rate", metavar="NUMBER", help="Frames a second, where frames count.")]
Pixel = Annotated[str | None, typer.Option("--pixel", metavar="LENGTH", help="The size of one, such as '0.8 mm'.")]
Upwards = Annotated[str | None, typer.Option("--y", metavar="SENSE", help="up or down: which way y grows.")]
Unit = Annotated[
    str | None, typer.Option("--unit", "--length", metavar="UNIT", help="Of places, such as cm; speeds per second.")
]
Time = Annotated[str | None, typer.Option("--time", metavar="UNIT", help="Of time, such as ms.")]
Angles = Annotated[str | None, typer.Option("--angles", metavar="UNIT", help="rad or deg, also of rates.")]
Sense = Annotated[
    str | None, typer.Option("--sense", metavar="SENSE", help="clockwise or anticlockwise: how an angle grows.")
]
Decimal = Annotated[str | None, typer.Option("--decimal", metavar="SIGN", help="point or comma, for '1,234'.")]


def read(
    file: File,
    track: Which = None,
    columns: Columns = None,
    unit: Unit = None,
    time: Time = None,
    angles: Angles = None,
    rate: Rate = None,
    pixel: Pixel = None,
    y: Upwards = None,
    sense: Sense = None,
    decimal: Decimal = None,
    figure: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the track: track.png, or .svg, or .pdf.")
    ] = None,
) -> None:
    """Read a measured track, say what was taken for what, and ask for what the file does not tell.

    Exit status: 0, it was read; 2, it cannot be, or something has to be said; 130, interrupted; 1, all else.
    """
    from ..tracks import read_track

    found = read_track(
        file,
        track=track,
        columns=pairs(columns),
        units=units_of(unit, time, angles),
        rate=rate,
        pixel=pixel,
        y=y,
        sense=sense,
        decimal=decimal,
    )
    if figure is not None:
        _draw(found, figure)
    screen.out(str(found))
    if figure is not None:
        screen.out(f"Wrote {figure}")


def _draw(found: Track, target: Path) -> None:
    from ..files import written_whole

    if target.suffix.lower() not in (".png", ".svg", ".pdf"):
        raise InvalidValueError("--figure", "must end in .png, .svg or .pdf", str(target))
    drawn = found.plot()
    with written_whole(target) as temporary:
        drawn.savefig(temporary)


def units_of(unit: str | None, time: str | None, angles: str | None) -> dict[str, str]:
    """Return the units that were said.

    Examples
    --------
    >>> units_of("cm", None, "deg")
    {'length': 'cm', 'angle': 'deg'}
    """
    return {kind: said for kind, said in (("length", unit), ("time", time), ("angle", angles)) if said is not None}


def pairs(text: str | None) -> dict[str, str]:
    """Read 't=frame_time, x=u'.

    Examples
    --------
    >>> pairs("t=frame_time, x=u")
    {'t': 'frame_time', 'x': 'u'}
    """
    if text is None:
        return {}
    found = [pair.partition("=") for pair in text.split(",") if pair.strip()]
    wrong = next((f"{name}{sign}{heading}" for name, sign, heading in found if not (sign and heading.strip())), None)
    if wrong is not None:
        raise InvalidValueError("--columns", "must be pairs NAME=HEADING", wrong.strip(), "Write 't=time, x=u, y=v'.")
    return {name.strip(): heading.strip() for name, _, heading in found}
