"""`trundle steady`: motions in which all that matters stays as it is, and what a nudge does to them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InvalidValueError, TrundleError
from . import screen
from .options import Folder, Json, Name, NoFigure, folder_for, load

if TYPE_CHECKING:
    from ..analysis.steady import SteadyMotions

FILE = "steady.png"


def steady(
    scenario: Name,
    hold: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME[=VALUE]", help="Keep speed, spin, lean, turning or distance, or give it a value."),
    ] = None,
    along: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="What the figure and the limits go along; also rate, of the support."),
    ] = None,
    lowest: Annotated[str | None, typer.Option("--from", metavar="VALUE", help="Where that begins.")] = None,
    highest: Annotated[str | None, typer.Option("--to", metavar="VALUE", help="Where that ends.")] = None,
    starts: Annotated[int, typer.Option(metavar="NUMBER", min=0, help="Search from that many more starts.")] = 0,
    periodic: Annotated[
        bool, typer.Option("--periodic", help="Find the periodic motion next to the start, and its multipliers.")
    ] = False,
    output: Folder = None,
    no_figure: NoFigure = False,
    as_json: Json = False,
) -> None:
    """Find the steady motion next to a scenario's start, say whether it is stable, and write steady.png.

    Each comes with the frequencies and rates of growth of a nudge, the limits of stability, and evidence.
    """
    from .writing import check_folder

    folder = folder_for(output, scenario)
    asked = load(scenario)
    if periodic:
        return _periodic(asked, as_json)
    from ..analysis.steady import steady_motions

    if not no_figure:
        check_folder(folder, (FILE,))
    found = steady_motions(asked, holding=_held(hold or []), starts=starts)
    return _report(found, folder, (along, lowest, highest), figure=not no_figure, as_json=as_json)


def _held(options: list[str]) -> dict[str, str | None]:
    """Return what the options say: ``lean=20deg`` gives a value, ``lean`` keeps what the start has."""
    held: dict[str, str | None] = {}
    for option in options:
        name, equals, value = (part.strip() for part in option.partition("="))
        if equals and not value:
            raise InvalidValueError(
                "--hold", "must have a value behind the =", option, "Write for instance lean=20deg."
            )
        held[name] = value or None
    return held


def _periodic(asked: Any, as_json: bool) -> None:
    from ..analysis.steady import periodic_motion

    motion = periodic_motion(asked)
    if as_json:
        screen.show_json(motion.as_dict())
    else:
        screen.out(f"{asked.title}\n{motion}")


def _report(
    found: SteadyMotions, folder: Path, asked: tuple[str | None, str | None, str | None], *, figure: bool, as_json: bool
) -> None:
    from ..analysis.steady.sweep import deciding
    from .writing import write_together

    name, lowest, highest = asked
    sweep = None
    if found.found:
        try:
            sweep = found[0].along(name or deciding(found[0]), lowest, highest)
        except TrundleError:
            if name is not None or lowest is not None or highest is not None:
                raise
    written = []
    if figure and sweep is not None:
        drawn = sweep.plot(found.title)
        written = write_together(folder, {FILE: lambda path: drawn.savefig(path)})
    if as_json:
        whole = found.as_dict() | {"sweep": None if sweep is None else sweep.as_dict()}
        screen.show_json(whole)
        return
    screen.out(str(found))
    if sweep is not None:
        screen.out(f"along {sweep}")
    screen.wrote(written)
