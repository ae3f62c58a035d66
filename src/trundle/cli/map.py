"""`trundle map`: the figure of a sweep, and the run behind a point of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InvalidValueError
from . import screen, signals

if TYPE_CHECKING:
    from ..analysis.sweep import Sweep


def draw_map(
    store: Annotated[Path, typer.Argument(metavar="STORE", help="What `trundle sweep` wrote, finished or not.")],
    measure: Annotated[
        str | None, typer.Option("--measure", "-m", metavar="NAME", help="What to draw. Default: the first.")
    ] = None,
    over: Annotated[
        list[str] | None, typer.Option(metavar="KEY", help="Over what; repeat for two. Default: the first two.")
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=VALUE", help="Where a number that is not drawn is held, SI. Default: its middle."),
    ] = None,
    point: Annotated[
        str | None,
        typer.Option("--open", metavar="A,B", help="Run the member nearest to this point again, SI, with its card."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="Of the figure, .png, .svg or .pdf; with --open a folder."),
    ] = None,
) -> None:
    """Draw a map of a sweep: a measure in colours over two numbers, or a line over one.

    With --open it runs the member behind a point again, and writes run.nc, its figures, and run.html, a page that plays
    it.

    Exit status: 0, all is well; 2, bad input; 3, a figure of the card failed; 130, interrupted; 1, all else.
    """
    from ..analysis.sweep import Sweep

    found = Sweep.load(store)
    held = dict(_value(text) for text in at or ())
    if point is not None:
        _open(found, point, over or found.over[:2], held, Path(f"{store.stem}-member") if output is None else output)
        return
    from .writing import check_folder, write_together

    target = Path(f"{store.stem}.png") if output is None else output.expanduser()
    if target.suffix not in (".png", ".svg", ".pdf"):
        raise InvalidValueError("--output", "must be a .png, .svg or .pdf", str(target))
    check_folder(target.parent, (target.name,))
    figure = found.plot(measure, over=over or (), at=held)
    write_together(target.parent, {target.name: lambda path: figure.savefig(path)})
    screen.out(f"{found.outcome}\nWrote {target}")


def _open(found: Sweep, point: str, over: list[str], held: dict[str, float], folder: Path) -> None:
    """Run the member nearest to a point, and write what `trundle run` would, and a page."""
    from .app import FILES, finish, report
    from .writing import check_folder

    parts = point.split(",")
    if len(parts) != len(over):
        raise InvalidValueError("--open", f"must be a value for each of {', '.join(over)}", point)
    place = {key: _number(part, "--open") for key, part in zip(over, parts, strict=True)}
    check_folder(folder, (*FILES, "run.html"))
    scenario = found.member({**held, **place})
    with screen.ProgressBar(wanted=True) as bar:
        run = scenario.run(progress=bar)
    signals.check()
    card, written = finish(run, folder, FILES)
    page = run.save_html(folder / "run.html")
    report(card, [event.text for event in run.events], [*written, page], quiet=False, as_json=False)


def _value(text: str) -> tuple[str, float]:
    key, equals, value = text.partition("=")
    if not equals:
        raise InvalidValueError("--at", "must be a key and a value", text, "Write for instance support.tilt=0.01.")
    return key.strip(), _number(value, "--at")


def _number(text: str, key: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InvalidValueError(key, "must be a number in SI", text) from None
