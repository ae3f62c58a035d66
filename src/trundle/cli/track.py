"""`trundle track`: the track of a ball from a film."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

import typer

from ..errors import InvalidValueError
from . import screen, signals
from .options import Quiet

TRACK, CHECK, FIGURE = "track.csv", "check.mp4", "track.png"
_LENGTHS = re.compile(r"\s*[,;]\s*")


def track(
    film: Annotated[Path, typer.Argument(metavar="FILM", help="A film of the ball: MP4, MOV, AVI, WebM ...")],
    ball_radius: Annotated[str, typer.Option(metavar="LENGTH", help="Of the ball, such as '20 mm'.")],
    rim_radius: Annotated[
        str | None, typer.Option(metavar="LENGTH", help="Of the table, whose whole rim the film shows.")
    ] = None,
    mark: Annotated[
        list[str] | None,
        typer.Option(metavar="PX,PX=X,Y", help="Instead of a rim four points: '412,300 = 10 cm, 0 cm'; repeat."),
    ] = None,
    height: Annotated[str | None, typer.Option(metavar="LENGTH", help="Of the lens over the table.")] = None,
    focal: Annotated[float | None, typer.Option(metavar="PIXELS", help="Focal length, instead of the height.")] = None,
    distortion: Annotated[float, typer.Option(metavar="NUMBER", help="Of the lens; below 0 for a barrel.")] = 0.0,
    colour: Annotated[str | None, typer.Option(metavar="COLOUR", help="Of the ball: red, '#ff8800'.")] = None,
    mark_colour: Annotated[
        str | None, typer.Option(metavar="COLOUR", help="Of a dot on the table, which shows how it turns.")
    ] = None,
    table_rate: Annotated[
        str | None, typer.Option(metavar="RATE", help="Of the table, such as '33.3 rpm', to check the film by.")
    ] = None,
    slow: Annotated[float | None, typer.Option(metavar="TIMES", help="How many times slowed down the film is.")] = None,
    frame_rate: Annotated[
        float | None, typer.Option(metavar="NUMBER", help="Frames a second as they were taken, in slow motion.")
    ] = None,
    readout: Annotated[
        str, typer.Option(metavar="TIME", help="From the first row of the sensor to the last, such as '20 ms'.")
    ] = "0 s",
    begin: Annotated[str, typer.Option(metavar="TIME", help="Where in the film to begin, such as '2 s'.")] = "0 s",
    end: Annotated[str | None, typer.Option(metavar="TIME", help="Where in the film to end.")] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FOLDER", help="Default: a folder of the film's name.")
    ] = None,
    no_check: Annotated[bool, typer.Option("--no-check", help="Write no film to check the track by.")] = False,
    quiet: Quiet = False,
) -> None:
    """Follow a ball on a table through a film, and write its track, which `trundle fit` reads.

    Writes track.csv, track.png and check.mp4, the film with the track drawn in. Look at that before you fit.

    Exit status: 0, it was followed; 2, it cannot be, or something has to be said; 130, interrupted; 1, all else.
    """
    from ..tracks.film import track_film
    from .writing import check_folder, write_together

    folder = Path(film.stem) if output is None else output.expanduser()
    names = (TRACK, FIGURE) if no_check else (TRACK, FIGURE, CHECK)
    check_folder(folder, names)
    with screen.ProgressBar(wanted=not quiet, doing="following") as bar:
        found = track_film(
            film,
            ball_radius=ball_radius,
            rim_radius=rim_radius,
            marks=[_mark(one) for one in mark] if mark else None,
            height=height,
            focal=focal,
            distortion=distortion,
            colour=colour,
            mark_colour=mark_colour,
            table_rate=table_rate,
            slow=slow,
            frame_rate=frame_rate,
            readout=readout,
            begin=begin,
            end=end,
            progress=bar,
        )
    signals.check()
    writers = {TRACK: found.save, FIGURE: lambda path: found.plot().savefig(path), CHECK: found.save_check}
    written = write_together(folder, {name: writers[name] for name in names})
    if not quiet:
        screen.out(str(found))
        screen.out(f"Wrote {', '.join(str(path) for path in written)}")


def _mark(text: str) -> list[str]:
    """Read '412,300 = 10 cm, 0 cm'.

    Examples
    --------
    >>> _mark("412,300 = 10 cm, 0 cm")
    ['412', '300', '10 cm', '0 cm']
    """
    seen, sign, place = text.partition("=")
    parts = [*_LENGTHS.split(seen.strip()), *_LENGTHS.split(place.strip())]
    if not sign or len(parts) != 4:
        rule = "must be two pixels and two lengths"
        raise InvalidValueError("--mark", rule, text, "Write '412,300 = 10 cm, 0 cm'.")
    return parts
