"""`trundle fit`: numbers of a scenario from measured motion; or how well they would be known, before anything is."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InvalidValueError
from . import CANNOT_DECIDE, CARD_FAILED, screen, signals
from .read import Angles, Columns, Decimal, Pixel, Rate, Sense, Time, Unit, Upwards, Which, pairs, units_of

if TYPE_CHECKING:
    from ..analysis.fit import Fit
    from ..tracks import Example

FIGURE, PAGE, DATA, SCENARIO = "fit.png", "fit.html", "fit.nc", "fit.toml"
TABLES = {"markdown": "fit.md", "latex": "fit.tex", "csv": "fit.csv"}


def fit(
    tracks: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="TRACK",
            help="Measured motion, as `trundle read` reads it, or example:NAME; several share what is free.",
        ),
    ] = None,
    scenario: Annotated[
        str | None,
        typer.Option("--scenario", "-s", metavar="SCENARIO", help="What moves: a shipped scenario or a TOML file."),
    ] = None,
    free: Annotated[
        list[str] | None,
        typer.Option(
            "--free", "-f", metavar="KEY", help="A number to fit, such as body.inertia_ratio; repeat for more."
        ),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FOLDER", help="Default: a folder of the track's name.")
    ] = None,
    noise: Annotated[
        str | None,
        typer.Option(metavar="SIZE", help="Of a value, '0.5 mm', or 'x=0.5 mm, wz=1 deg/s'; else estimated."),
    ] = None,
    prior: Annotated[
        list[str] | None, typer.Option(metavar="KEY=VALUE±SIGMA", help="What is known beforehand; repeat for more.")
    ] = None,
    camera: Annotated[
        list[str] | None,
        typer.Option(metavar="KEY=VALUE", help="Such as scale=1.02 or 'height=1.2 m'; repeat for more."),
    ] = None,
    loss: Annotated[
        str, typer.Option(metavar="LOSS", help="linear; against outliers soft_l1, huber, cauchy.")
    ] = "linear",
    given_start: Annotated[bool, typer.Option("--given-start", help="Take the start from the scenario.")] = False,
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
    compare: Annotated[
        bool, typer.Option("--compare", help="Say what may be missing: drag, resistance, a lean …")
    ] = False,
    draws: Annotated[int, typer.Option(metavar="STEPS", help="Draw from the posterior by emcee, so many steps.")] = 0,
    plan: Annotated[
        bool, typer.Option("--plan", help="Measure nothing: say how well each number would be known.")
    ] = False,
    table: Annotated[
        str | None, typer.Option(metavar="FORM", help="Write the table too: markdown, latex or csv.")
    ] = None,
    no_figure: Annotated[bool, typer.Option("--no-figure", help="Draw no figure, and write no page.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the result as JSON, and nothing else.")] = False,
) -> None:
    """Fit numbers of a scenario to measured motion, and say which of them the data fix, and how well.

    No start is needed: it is found and fitted. Writes fit.toml, the fitted scenario, fit.nc, fit.png and fit.html.

    Exit status: 0, a good fit; 2, bad input; 3, a bad fit; 4, these data cannot decide; 130, interrupted; 1, all else.
    """
    from ..analysis.fit import fit as fit_tracks
    from ..tracks import example_of, read_track

    known = example_of(tracks[0]) if tracks else None
    if scenario is None and known is None:
        remedy = "Name a shipped one (`trundle list`) or a TOML file."
        raise InvalidValueError("--scenario", "must say what moves", "none", remedy)
    numbers = _pairs(camera or [], "--camera")
    loaded = _load(scenario, known)
    if known is not None and scenario is None:
        free, noise = free or list(known.free), noise or known.noise
    if plan:
        _plan(loaded, free or [], noise, numbers, quiet=quiet, as_json=as_json)
        return
    if not tracks:
        raise InvalidValueError("TRACK", "must name a file", "none", "Or plan a measurement: --plan.")
    files = _names(table, figure=not no_figure)
    folder = Path(tracks[0].stem if known is None else known.name) if output is None else output.expanduser()
    from .writing import check_folder, write_together

    check_folder(folder, tuple(files))

    told: dict[str, Any] = {"rate": rate, "pixel": pixel, "y": y, "sense": sense, "decimal": decimal, "track": track}
    found = fit_tracks(
        [read_track(one, columns=pairs(columns), units=units_of(unit, time, angles), **told) for one in tracks],
        loaded,
        free=free or [],
        priors=_priors(prior or []),
        noise=_noise(noise),
        camera=numbers,
        loss=loss,
        start="given" if given_start else "free",
    )
    signals.check()
    writers: dict[str, Any] = {
        SCENARIO: lambda path: path.write_text(found.to_toml(), encoding="utf-8"),
        DATA: found.save,
        FIGURE: lambda path: found.plot().savefig(path),
        PAGE: found.save_html,
        **{name: lambda path, form=form: path.write_text(found.table(form)) for form, name in TABLES.items()},
    }
    written = write_together(folder, {name: writers[name] for name in files})
    if as_json:
        screen.out(json.dumps(found.as_dict(), indent=2, ensure_ascii=False, allow_nan=False))
    elif not quiet:
        _tell(found, draws, written, compare=compare)
    _leave(found)


def _names(table: str | None, *, figure: bool) -> list[str]:
    if table is not None and table not in TABLES:
        from ..errors import UnknownNameError

        raise UnknownNameError("form of table", table, TABLES)
    return [SCENARIO, DATA, *([FIGURE, PAGE] if figure else []), *([TABLES[table]] if table else [])]


def _tell(found: Fit, draws: int, written: list[Path], *, compare: bool) -> None:
    screen.out(str(found))
    card = found.card
    screen.out(f"The card of the fitted run {'passes' if card.passed else 'FAILS'}.")
    if compare or found.answer == "bad":
        screen.out(str(found.compare()))
    if draws:
        screen.out(str(found.sample(draws)))
    screen.out(f"Wrote {', '.join(str(path) for path in written)}")


def _leave(found: Fit) -> None:
    """Leave with a status if the fit is bad or decides nothing."""
    if found.answer == "cannot decide":
        screen.note(f"trundle: {found.verdict}")
        raise typer.Exit(CANNOT_DECIDE)
    if found.answer == "bad" or not found.card.passed:
        screen.note(f"trundle: {found.verdict if found.answer == 'bad' else 'the card of the fitted run fails'}")
        raise typer.Exit(CARD_FAILED)


def _plan(
    scenario: object, free: list[str], noise: str | None, camera: dict[str, Any], *, quiet: bool, as_json: bool
) -> None:
    """Print how well each number would be known."""
    from ..analysis.fit import plan_fit

    noises = {} if noise is None else {"noises": [part.strip() for part in noise.split(",")]}
    found = plan_fit(scenario, free, camera=camera, **noises)  # type: ignore[arg-type]
    if as_json:
        screen.out(json.dumps(found.as_dict(), indent=2, ensure_ascii=False))
    elif not quiet:
        screen.out(str(found))


def _load(scenario: str | None, known: Example | None) -> object:
    """Return the scenario that is named, or the one that an example of a track begins with."""
    from ..scenario import files
    from ..simulation.simulate import Scenario

    if known is not None and scenario is None:
        return Scenario.read(known.scenario, known.name)
    return Scenario.read(files.tables_of(str(scenario)), str(scenario))


def _noise(text: str | None) -> Any:
    """Read '0.5 mm', or 'x=0.5 mm, wz=1 deg/s'."""
    return _pairs(text.split(","), "--noise") if text is not None and "=" in text else text


def _pairs(texts: list[str], option: str) -> dict[str, Any]:
    """Read KEY=VALUE; a number without a unit is one, a list in brackets is one."""
    found: dict[str, Any] = {}
    for text in texts:
        key, sign, value = (part.strip() for part in text.partition("="))
        if not (key and sign and value):
            raise InvalidValueError(option, "must be pairs KEY=VALUE", text, "Write for instance scale=1.02.")
        listed = [part.strip() for part in value[1:-1].split(";")] if value[:1] == "[" else None
        found[key] = _number(value) if listed is None else [_number(part) for part in listed]
    return found


def _priors(texts: list[str]) -> dict[str, tuple[Any, Any]]:
    """Read KEY=VALUE±SIGMA; the unit of SIGMA may stand for both."""
    found = {}
    for key, value in _pairs([text.replace("+-", "±").replace("+/-", "±") for text in texts], "--prior").items():
        middle, sign, sigma = (part.strip() for part in str(value).partition("±"))
        if not sign:
            remedy = "Write for instance body.inertia_ratio=0.4±0.01."
            raise InvalidValueError("--prior", "must be KEY=VALUE±SIGMA", f"{key}={value}", remedy)
        unit = re.sub(r"^[+-]?[\d.]+([eE][+-]?\d+)?\s*", "", sigma)
        bare = isinstance(_number(middle), float)
        found[key] = (_number(f"{middle} {unit}") if unit and bare else _number(middle), _number(sigma))
    return found


def _number(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text
