"""The commands of `trundle`. Whatever is slow to load is loaded by the command that needs it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..scenario import files
from . import CARD_FAILED, constraints, screen, signals
from .chaos import chaos
from .check import check
from .derive import derive
from .equations import equations
from .equilibria import equilibria
from .export import export
from .fit import fit
from .lab import lab
from .map import draw_map
from .once import Once
from .options import Folder, Json, Name, Quiet, folder_for, load
from .read import read
from .score import score
from .sensitivity import sensitivity
from .site import site
from .steady import steady
from .sweep import sweep
from .tolerance import tolerance
from .track import track
from .twin import twin
from .vakonomic import vakonomic

if TYPE_CHECKING:
    from ..simulation.trajectory import Trajectory
    from ..verify import Card

FILES = ("run.nc", "path.png", "series.png")


def command() -> Any:
    """Return the whole command, for one call."""
    app = typer.Typer(
        rich_markup_mode="rich" if sys.stdout.isatty() else None,  # no boxes and no colours in a pipe
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(_top)
    app.command("run", short_help="Run a scenario; write its trajectory and figures.")(run)
    app.command("list", short_help="Name the scenarios that ship with trundle.")(list_scenarios)
    app.command("show", short_help="Print a scenario file, and what to expect of it.")(show)
    app.command("check", short_help="Check somebody else's trajectory, and name the likely mistake.")(check)
    app.command("fit", short_help="Fit numbers to measured motion, and say what it cannot show.")(fit)
    app.command("read", short_help="Say what is taken for what in a measured track.")(read)
    app.command("track", short_help="Follow a ball through a film.")(track)
    app.command("derive", short_help="Derive a motion, each equation proved by the code.")(derive)
    app.command("schema", short_help="Print the JSON schema of scenario files, for editors.")(schema)
    app.command("twin", short_help="Find the charge in crossed fields that moves as the ball does.")(twin)
    app.command("constraints", short_help="Holonomic or not: decide it, and show why.")(constraints.constraints)
    app.command("sensitivity", short_help="Rank the shortcomings of a turntable by what they do.")(sensitivity)
    app.command("equilibria", short_help="Where a body stays, put down at rest.")(equilibria)
    app.command("vakonomic", short_help="A negative control: the wrong path of stationary action.")(vakonomic)
    app.command("equations", short_help="Print the law as C, Python, JavaScript, LaTeX or JAX.")(equations)
    app.command("export", short_help="Write a run as a page, a model, a picture, a table.")(export)
    app.command("site", short_help="Write a site of live pages, for any web host.")(site)
    app.command("lab", short_help="Open the lab: the ball in a browser.")(lab)
    app.command("sweep", short_help="Run a scenario for many values of its numbers.")(sweep)
    app.command("map", short_help="Draw a sweep, and open the run behind a point of it.")(draw_map)
    app.command("score", short_help="Score physics engines on exact rolling motions.")(score)
    app.command("tolerance", short_help="How far a run may be off within tolerances.")(tolerance)
    app.command("chaos", short_help="Lyapunov exponents, Poincaré sections, periodic orbits.")(chaos)
    app.command("steady", short_help="Steady motions, and whether they are stable.")(steady)
    for registered in app.registered_commands:
        registered.cls = Once
    return typer.main.get_command(app)


def _print_version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        screen.out(f"trundle {version('trundle')}")
        raise typer.Exit


def _top(
    context: typer.Context,
    version: Annotated[  # noqa: ARG001
        bool, typer.Option("--version", is_eager=True, callback=_print_version, help="Print the version.")
    ] = False,
) -> None:
    """Compute the motion of bodies that roll without slipping, and say how far to trust it."""
    if context.invoked_subcommand is None:
        screen.out(context.get_help())


def run(
    scenario: Name,
    output: Folder = None,
    method: Annotated[
        str | None,
        typer.Option(metavar="METHOD", help="auto, exact, taylor or runge-kutta.", autocompletion=lambda: METHODS),
    ] = None,
    tolerance: Annotated[
        float | None,
        typer.Option(metavar="NUMBER", help="Of a numerical method, 1e-15 to 1e-6. Default: the finest it keeps."),
    ] = None,
    duration: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="Length of the run, such as '60 s', in place of the file's."),
    ] = None,
    every: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="Time between samples, such as '10 ms', in place of the file's."),
    ] = None,
    no_figure: Annotated[bool, typer.Option("--no-figure", help="Draw no figures.")] = False,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Run a scenario, print its verification card, and write run.nc, path.png and series.png.

    A path to roll along, without forces, gives run.nc and stages.png.

    Exit status: 0, all is well; 2, bad input; 3, a figure of the card failed; 130, interrupted; 1, all else.
    """
    from ..solve.methods import check_tolerance
    from .writing import check_folder

    folder = folder_for(output, scenario)
    tables = files.tables_of(scenario)
    if files.rolls_along_path(tables):
        from . import along_path

        finely = None if tolerance is None else f"{tolerance:g}"
        options = {"duration": duration, "every": every, "method": method, "tolerance": finely}
        told = along_path.run(tables, scenario, folder, figure=not no_figure, **options)
        return report(*told, quiet=quiet, as_json=as_json)
    names = FILES[:1] if no_figure else FILES
    check_tolerance(tolerance, "--tolerance")
    loaded = load(scenario, tables, duration=duration, every=every, method=method)
    check_folder(folder, names)
    with screen.ProgressBar(wanted=not quiet) as bar:
        trajectory = loaded.run(tolerance=tolerance, progress=bar)
    signals.check()
    card, written = finish(trajectory, folder, names, quiet=quiet)
    return report(card, [event.text for event in trajectory.events], written, quiet=quiet, as_json=as_json)


def finish(
    trajectory: Trajectory, folder: Path, names: tuple[str, ...], *, quiet: bool = False
) -> tuple[Card, list[Path]]:
    """Make card, figures and file, on two processors where there are two, and let the files appear together."""
    from .apart import ForkedCall
    from .writing import write_together

    with ForkedCall(trajectory.card) as checked, ExitStack() as drawing:  # checking imports heyoka meanwhile

        def save(path: Path) -> None:
            with screen.ProgressBar(wanted=not quiet, doing="checking") as bar, bar.waiting():
                card = checked.result()
            trajectory.with_card(card).save(path)

        def draw_path(path: Path) -> None:
            import matplotlib.backends.backend_agg  # before the copy is made, which then has them too
            import matplotlib.figure  # noqa: F401

            def draw_series() -> None:
                trajectory.plot("series").savefig(path.with_name("series.png"))

            series.append(drawing.enter_context(ForkedCall(draw_series)))
            trajectory.plot("path").savefig(path)

        series: list[ForkedCall[None]] = []
        writers = {"path.png": draw_path, "series.png": lambda _: series[0].result(), "run.nc": save}
        write_together(folder, {name: write for name, write in writers.items() if name in names})
        return checked.result(), [folder / name for name in names]


def report(card: Card, lines: list[str], written: list[Path], *, quiet: bool, as_json: bool) -> None:
    """Print the card, what else there is to say and the files' names; leave with a status if a check failed."""
    if as_json:
        screen.out(card.as_json())
    elif not quiet:
        screen.show_card(card)
        for line in lines:
            screen.out(line)
        screen.wrote(written)
    if not card.passed:
        failed = ", ".join(figure.name for figure in card.failures)
        screen.note(f"trundle: the card fails: {failed}")
        raise typer.Exit(CARD_FAILED)


METHODS = ["auto", "exact", "taylor", "runge-kutta"]


def list_scenarios() -> None:
    """Name the scenarios that ship with trundle, with their titles."""
    screen.show_names([(name, files.title_of(name)) for name in files.names()])


def show(scenario: Name) -> None:
    """Print a scenario file as it is, to read or to copy; on a terminal also the numbers to expect of it."""
    text = files.read(scenario)
    tables = files.parse(text, scenario)
    rows: Callable[[], list[tuple[str, str]]]
    if files.rolls_along_path(tables):
        from . import along_path

        rows = along_path.expected(tables, scenario)
    else:
        from ..scenario import ScenarioFile
        from .expectations import expectations

        rows = partial(expectations, ScenarioFile.read(tables, scenario))
    screen.show_source(text)
    if screen.on_terminal():
        screen.show_pairs("To expect", rows())


def schema(
    path: Annotated[bool, typer.Option("--path", help="That of paths to roll along, without forces.")] = False,
) -> None:
    """Print the JSON schema of scenario files, for editors that check and complete TOML."""
    from ..scenario import ScenarioFile
    from ..scenario.path_file import PathFile

    screen.show_json((PathFile if path else ScenarioFile).schema())
