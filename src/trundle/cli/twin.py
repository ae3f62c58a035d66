"""`trundle twin`: the charge in crossed fields that moves as the ball of a scenario does."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InvalidValueError
from . import CARD_FAILED, screen
from .options import Folder, Name, NoFigure, folder_for, load

if TYPE_CHECKING:
    from ..analysis.analogy import Twin

FILE = "twin.png"


def twin(
    scenario: Name,
    output: Folder = None,
    electron: Annotated[
        bool, typer.Option("--electron", help="An electron, a million times as fast as the ball.")
    ] = False,
    mass: Annotated[str | None, typer.Option(metavar="MASS", help="Of the charge, such as '1 g'; the ball's.")] = None,
    charge: Annotated[float, typer.Option(metavar="COULOMB", help="The charge, C.")] = 1.0,
    slow_motion: Annotated[
        float | None, typer.Option(metavar="TIMES", help="Seconds of the ball for one of the charge.")
    ] = None,
    no_figure: NoFigure = False,
) -> None:
    """Find the charge in crossed electric and magnetic fields that moves as a ball on a turntable does.

    Prints what corresponds to what, compares the two paths, and writes twin.png.

    Exit status: 0, all is well; 2, bad input; 3, the two paths differ by more than rounding; 1, all else.
    """
    from .writing import check_folder, write_together

    folder = folder_for(output, scenario)
    pair = _found(load(scenario), mass=mass, charge=charge, electron=electron, slow_motion=slow_motion)
    if not no_figure:
        check_folder(folder, (FILE,))
    screen.out(str(pair))
    if not no_figure:
        written = write_together(folder, {FILE: lambda path: pair.plot().savefig(path)})
        screen.wrote(written)
    if not pair.agrees:
        screen.note("trundle: the two paths differ by more than rounding")
        raise typer.Exit(CARD_FAILED)


def _found(scenario: Any, **options: Any) -> Twin:
    from ..analysis.analogy import twin as find

    try:
        return find(scenario, **options)
    except InvalidValueError as error:
        if error.key in options:  # as the command line calls it
            key = f"--{error.key.replace('_', '-')}"
            raise InvalidValueError(key, error.rule, error.received, error.remedy) from None
        raise
