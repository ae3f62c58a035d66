"""`trundle chaos`: Lyapunov exponents of a motion; or a section through it, or the periodic orbit next to it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InvalidValueError
from ..units import sharing_unit
from . import CARD_FAILED, screen, signals
from .options import Folder, Json, Name, Quiet, folder_for, load

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..simulation.simulate import Scenario

EXPONENTS, SECTION, ORBITS, BIFURCATIONS = "lyapunov.png", "section.png", "orbits.png", "bifurcations.png"
SECTION_DATA = "section.nc"
MOST_VALUES = 10_000  # of a number along which a section is followed


def chaos(
    scenario: Name,
    output: Folder = None,
    duration: Annotated[
        str | None, typer.Option(metavar="TIME", help="How long to follow the motion, in place of the file's.")
    ] = None,
    count: Annotated[int | None, typer.Option(metavar="NUMBER", help="How many exponents; default: all.")] = None,
    section: Annotated[
        str | None,
        typer.Option(metavar="TEXT", help="Such as 'position.z rising through 10 mm', or an event: 'land'."),
    ] = None,
    strobe: Annotated[
        str | None, typer.Option(metavar="TIME", help="Once in each period, such as that of the support.")
    ] = None,
    orbit: Annotated[
        str | None, typer.Option(metavar="TIME", help="Find the periodic orbit next to the start; about its period.")
    ] = None,
    along: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Follow that orbit, or that section, along a number such as support.tilt."),
    ] = None,
    lowest: Annotated[str | None, typer.Option("--from", metavar="VALUE", help="Where that ends below.")] = None,
    highest: Annotated[str | None, typer.Option("--to", metavar="VALUE", help="Where that ends above.")] = None,
    values: Annotated[int, typer.Option(metavar="NUMBER", help="Of the number, between, for a section.")] = 40,
    observe: Annotated[
        str, typer.Option(metavar="NAME", help="What a section along a number shows, such as velocity.z.")
    ] = "velocity.z",
    settle: Annotated[
        str | None, typer.Option(metavar="TIME", help="How long to settle at each value. Default: half of --duration.")
    ] = None,
    no_figure: Annotated[bool, typer.Option("--no-figure", help="Write no file.")] = False,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Find the Lyapunov exponents of a scenario's motion, with errors, and write lyapunov.png.

    With --section or --strobe, a Poincaré section in section.png and section.nc; with --along, where it settles while a
    number goes up and down again, in bifurcations.png. With --orbit, the periodic orbit next to the start with its
    Floquet multipliers, and with --along its branch in orbits.png.
    """
    asked = [name for name, value in (("--section", section), ("--strobe", strobe), ("--orbit", orbit)) if value]
    if len(asked) > 1:
        raise InvalidValueError(asked[1], f"must not stand beside {asked[0]}", scenario, "Ask one after the other.")
    for name, value in (("--along", along), ("--from", lowest), ("--to", highest)):
        if value is not None and not (asked and along):
            rule = "needs --orbit, --section or --strobe" if name == "--along" else "needs --along"
            raise InvalidValueError(name, rule, value, "Say what to follow.")
    if along and not orbit and None in (lowest, highest):
        raise InvalidValueError("--from", "must be given, as well as --to", lowest, "Say how far the number goes.")
    for name, given in (("--count", count if asked else None), ("--duration", duration if orbit else None)):
        if given is not None:
            raise InvalidValueError(name, f"has no meaning with {asked[0]}", given, "Leave it out.")
    if lowest is not None and highest is not None:
        lowest, highest = sharing_unit((lowest, highest))
    loaded = load(scenario)
    folder = folder_for(output, scenario)
    wanted: tuple[str, ...] = (EXPONENTS,)
    if asked:
        section_files = (BIFURCATIONS,) if along else (SECTION, SECTION_DATA)
        wanted = ((ORBITS,) if along else ()) if orbit else section_files
    wanted = () if no_figure else wanted
    if wanted:
        from .writing import check_folder

        check_folder(folder, wanted)
    if orbit:
        found = _orbit(loaded, orbit, along, lowest, highest)
    else:
        with screen.ProgressBar(wanted=not (quiet or as_json)) as bar:
            if along:
                ends = str(lowest), str(highest)
                found = _diagram(loaded, along, ends, values, observe, section, strobe, settle, duration, bar)
            else:
                found = _followed(loaded, duration, count, section, strobe, bar)
    signals.check()
    _tell(found, folder, wanted, quiet=quiet, as_json=as_json)


def _orbit(loaded: Scenario, period: str, along: str | None, lowest: str | None, highest: str | None) -> Any:
    from ..analysis.chaos import periodic_orbit

    orbit = periodic_orbit(loaded, period=period)
    return orbit if along is None else orbit.along(along, lowest, highest)


def _diagram(
    loaded: Scenario,
    along: str,
    ends: tuple[str, str],
    count: int,
    observe: str,
    section: str | None,
    strobe: str | None,
    settle: str | None,
    duration: str | None,
    bar: Any,
) -> Any:
    """Return where a section settles while a number goes up and down again."""
    import numpy as np

    from ..analysis.chaos import bifurcation_diagram
    from ..analysis.chaos.returning import number_of
    from ..mechanics import checks
    from ..mechanics.parameters import parameters

    if not 2 <= count <= MOST_VALUES:
        raise InvalidValueError("--values", f"must be 2 to {MOST_VALUES}", count)
    system = loaded.system()
    dimension = parameters(system)[number_of(system, along)[0]].dimension
    first, last = (float(checks.real(end, dimension, key)) for key, end in zip(("--from", "--to"), ends, strict=True))
    return bifurcation_diagram(
        loaded,
        along,
        np.linspace(first, last, count).tolist(),
        observe,
        section,
        period=strobe,
        settle=settle,
        duration=duration,
        progress=bar,
    )


def _followed(
    loaded: Scenario, duration: str | None, count: int | None, section: str | None, strobe: str | None, bar: Any
) -> Any:
    from ..analysis.chaos import lyapunov_exponents, poincare_section

    if section or strobe:
        return poincare_section(loaded, section, duration=duration, period=strobe, progress=bar)
    return lyapunov_exponents(loaded, duration=duration, count=count, progress=bar)


def _tell(found: Any, folder: Path, wanted: tuple[str, ...], *, quiet: bool, as_json: bool) -> None:
    """Write the files, and print what was found; a figure that fails is told by the exit status."""
    from .writing import write_together

    writers: dict[str, Callable[[Path], Any]] = {
        name: (lambda path: found.data.to_netcdf(path, engine="h5netcdf"))
        if name == SECTION_DATA
        else (lambda path: found.plot().savefig(path))
        for name in wanted
    }
    written = write_together(folder, writers)
    screen.show(found, written, quiet=quiet, as_json=as_json)
    if getattr(found, "passed", None) is False or getattr(found, "located", True) is False:
        raise typer.Exit(CARD_FAILED)
