"""`trundle fit`: numbers of a scenario from measured motion; or how well they would be known, before anything is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import InvalidValueError
from ..units import plus_minus
from . import CANNOT_DECIDE, CARD_FAILED, screen, signals
from .options import (
    NOTHING_SAID,
    FileFolder,
    Json,
    Quiet,
    Reading,
    WhatMoves,
    folder_for,
    load,
    no_scenario,
    reads_tracks,
)

if TYPE_CHECKING:
    from ..analysis.fit import Fit
    from ..tracks import Example

FIGURE, PAGE, DATA, SCENARIO = "fit.png", "fit.html", "fit.nc", "fit.toml"
TABLES = {"markdown": "fit.md", "latex": "fit.tex", "csv": "fit.csv"}


@reads_tracks
def fit(
    tracks: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="TRACK",
            help="Measured motion, as `trundle read` reads it, or example:NAME; several share what is free.",
        ),
    ] = None,
    scenario: WhatMoves = None,
    free: Annotated[
        list[str] | None,
        typer.Option(
            "--free", "-f", metavar="KEY", help="A number to fit, such as body.inertia_ratio; repeat for more."
        ),
    ] = None,
    output: FileFolder = None,
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
    reading: Reading = NOTHING_SAID,
    compare: Annotated[
        bool, typer.Option("--compare", help="Say what may be missing: drag, resistance, a lean …")
    ] = False,
    draws: Annotated[int, typer.Option(metavar="STEPS", help="Draw from the posterior by emcee, so many steps.")] = 0,
    plan: Annotated[
        bool, typer.Option("--plan", help="Measure nothing: say how well each number would be known.")
    ] = False,
    table: Annotated[
        list[str] | None,
        typer.Option(metavar="FORM", help="Write the table too: markdown, latex or csv; repeat for more."),
    ] = None,
    no_figure: Annotated[bool, typer.Option("--no-figure", help="Draw no figure, and write no page.")] = False,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Fit numbers of a scenario to measured motion, and say which of them the data fix, and how well.

    No start is needed: it is found and fitted. Writes fit.toml, the fitted scenario, fit.nc, fit.png and fit.html.

    Exit status: 0, a good fit; 2, bad input; 3, a bad fit; 4, these data cannot decide; 130, interrupted; 1, all else.
    """
    from ..analysis.fit import fit as fit_tracks
    from ..tracks import example_of

    known = example_of(tracks[0]) if tracks else None
    if scenario is None and known is None:
        raise no_scenario()
    numbers = _pairs(camera or [], "--camera")
    loaded = _load(scenario, known)
    if known is not None and scenario is None:
        free, noise = free or list(known.free), noise or known.noise
    if plan:
        _plan(loaded, free or [], noise, numbers, quiet=quiet, as_json=as_json)
        return
    if not tracks:
        raise InvalidValueError("TRACK", "must name a file", "none", "Or plan a measurement: --plan.")
    files = _names(table or [], figure=not no_figure)
    folder = folder_for(output, tracks[0] if known is None else Path(known.name))
    from .writing import check_folder, write_together

    check_folder(folder, tuple(files))

    found = fit_tracks(
        [reading.read(one) for one in tracks],
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
        **{
            name: lambda path, form=form: path.write_text(f"{found.table(form)}\n", encoding="utf-8")
            for form, name in TABLES.items()
        },
    }
    written = write_together(folder, {name: writers[name] for name in files})
    if as_json:
        screen.show_json(found.as_dict())
    elif not quiet:
        screen.out(str(found))
        screen.out(f"The card of the fitted run {'passes' if found.card.passed else 'FAILS'}.")
        screen.wrote(written)
        _ask_more(found, draws, compare=compare)
    _leave(found)


def _names(forms: list[str], *, figure: bool) -> list[str]:
    for form in forms:
        if form not in TABLES:
            from ..errors import UnknownNameError

            raise UnknownNameError("form of table", form, TABLES)
    return [SCENARIO, DATA, *([FIGURE, PAGE] if figure else []), *dict.fromkeys(TABLES[form] for form in forms)]


def _ask_more(found: Fit, draws: int, *, compare: bool) -> None:
    """Print what takes as long as the fit again, or longer."""
    if compare or found.answer == "bad":
        screen.out(str(found.compare()))
    if draws:
        screen.out(str(found.sample(draws)))


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
    screen.show(found, quiet=quiet, as_json=as_json)


def _load(scenario: str | None, known: Example | None) -> Any:
    """Return the scenario that is named, or the one that an example of a track begins with."""
    if scenario is not None or known is None:
        return load(str(scenario))
    from ..simulation.simulate import Scenario

    return Scenario.read(known.scenario, known.name)


def _noise(text: str | None) -> Any:
    """Read '0.5 mm', or 'x=0.5 mm, wz=1 deg/s'."""
    return _pairs(text.split(","), "--noise") if text is not None and "=" in text else text


def _pairs(texts: list[str], option: str) -> dict[str, Any]:
    """Read KEY=VALUE; what stands in brackets is a list."""
    found: dict[str, Any] = {}
    for text in texts:
        key, sign, value = (part.strip() for part in text.partition("="))
        if not (key and sign and value):
            raise InvalidValueError(option, "must be pairs KEY=VALUE", text, "Write for instance scale=1.02.")
        found[key] = [part.strip() for part in value[1:-1].split(";")] if value[:1] == "[" else value
    return found


def _priors(texts: list[str]) -> dict[str, tuple[Any, Any]]:
    """Read KEY=VALUE±SIGMA; the unit of SIGMA may stand for both."""
    found = {}
    for key, value in _pairs(texts, "--prior").items():
        parts = plus_minus(value) if isinstance(value, str) else None
        if parts is None:
            remedy = "Write for instance body.inertia_ratio=0.4±0.01."
            raise InvalidValueError("--prior", "must be KEY=VALUE±SIGMA", f"{key}={value}", remedy)
        found[key] = parts
    return found
