"""`trundle score`: physics engines against motions that are known exactly."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InvalidValueError, UnknownNameError
from . import CARD_FAILED, screen, signals
from .options import Json, Quiet

if TYPE_CHECKING:
    from ..conformance import Case, Entrant, Row, Score

DATA, TABLE, PAGE = "score.nc", "score.md", "score.html"


def score(
    engine: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="An engine that an adapter ships for; repeat for more; 'list' names them."),
    ] = None,
    adapter: Annotated[
        list[str] | None,
        typer.Option(metavar="COMMAND", help="A program of yours that answers tasks; repeat for more."),
    ] = None,
    case: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="A case; repeat for more; 'list' names them. Default: all.")
    ] = None,
    step: Annotated[
        list[str] | None, typer.Option(metavar="TIME", help="A step; repeat for more. Default: 10, 1 and 0.1 ms.")
    ] = None,
    ablations: Annotated[
        bool, typer.Option("--ablations", help="Run what looks for causes, beside the profiles.")
    ] = False,
    derivatives: Annotated[
        bool,
        typer.Option("--derivatives", help="Score the derivatives of the final state, too, where a case has them."),
    ] = False,
    repeat: Annotated[
        int, typer.Option(metavar="NUMBER", min=1, help="Make each run so often; its cost is the median.")
    ] = 1,
    limit: Annotated[str, typer.Option(metavar="TIME", help="How long one run may take.")] = "60 s",
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Of score.nc, to which new rows are added.")
    ] = Path("score"),
    at_most: Annotated[
        float | None, typer.Option(metavar="NUMBER", help="Fail where the error at the finest step is larger.")
    ] = None,
    order: Annotated[
        float | None, typer.Option(metavar="NUMBER", help="Fail where the error falls at a lower order.")
    ] = None,
    report: Annotated[
        bool, typer.Option("--report", help="Write score.md and score.html too; without an engine, of the rows there.")
    ] = False,
    junit: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the outcome as JUnit XML.")] = None,
    repro: Annotated[
        tuple[str, str] | None,
        typer.Option(metavar="ENGINE CASE", help="Print a script that shows one finding without trundle."),
    ] = None,
    cases: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Write cases and exact runs as JSON and CSV, with a scorer of one file."),
    ] = None,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Score physics engines on rolling: run them on motions that are known exactly, and say how the error falls.

    Each engine is installed in an environment of its own, and runs in a process of its own. A program of yours is
    scored by --adapter: it reads tasks as lines of JSON, and writes answers as lines of JSON.

    Exit status: 0, all is well; 2, bad input; 3, an engine fails --at-most or --order; 130, interrupted; 1, all else.
    """
    from ..conformance import cases as known
    from ..conformance import engines, portable

    if repro is not None:
        screen.out(portable.script(*repro), end="")
    elif "list" in (engine or ()):
        screen.show_names([(name, engines.engine(name).title) for name in engines.names()], "engine")
    elif "list" in (case or ()):
        screen.show_names([(each.name, each.title) for each in known()], "case")
    elif cases is not None:
        _write(cases, portable.case_files(_cases(case)), quiet=quiet or as_json)
    else:
        entrants = _entrants(engine, adapter, ablations=ablations)
        if not entrants and not (report and (output / DATA).exists()):
            remedy = "Name one with --engine, or give a program of yours with --adapter."
            raise InvalidValueError("--engine", "must name what is to be scored", "none", remedy)
        found = _run(
            entrants, _cases(case), step, limit, output, derivatives, repeat, report=report, quiet=quiet or as_json
        )
        if as_json:
            screen.out(json.dumps(found.as_dict(), indent=2, ensure_ascii=False))
        elif not quiet:
            screen.out(str(found))
            screen.out(f"Wrote {', '.join(str(output / name) for name in (DATA, *([TABLE, PAGE] if report else [])))}")
        if junit is not None:
            _write(junit.parent, {junit.name: portable.junit(found, at_most, order)}, quiet=quiet or as_json)
        failures = found.failures(at_most, order)
        for line in failures:
            screen.note(f"trundle: {line}")
        if failures:
            raise typer.Exit(CARD_FAILED)


def _write(folder: Path, texts: dict[str, str], *, quiet: bool) -> None:
    """Write texts as files of a folder."""
    from .writing import check_folder, write_together

    check_folder(folder, tuple(texts))
    written = write_together(folder, {name: partial(_put, text) for name, text in texts.items()})
    if not quiet:
        screen.out(f"Wrote {written[0] if len(written) == 1 else f'{len(written)} files to {folder}'}")


def _put(text: str, path: Path) -> None:
    path.write_text(text, encoding="utf-8")


def _entrants(names: list[str] | None, commands: list[str] | None, *, ablations: bool) -> list[Entrant]:
    from ..conformance import Entrant

    shipped = [Entrant.of_engine(name, ablations=ablations) for name in names or ()]
    return shipped + [Entrant.of_command(command) for command in commands or ()]


def _cases(names: list[str] | None) -> list[Case]:
    """Return the cases of these names, all where none is named."""
    from ..conformance import cases

    known = {each.name: each for each in cases()}
    for name in names or ():
        if name not in known:
            raise UnknownNameError("case", name, known)
    return [known[name] for name in names] if names else list(known.values())


def _run(
    entrants: list[Entrant],
    cases: list[Case],
    steps: list[str] | None,
    limit: str,
    folder: Path,
    derivatives: bool,
    repeat: int,
    *,
    report: bool,
    quiet: bool,
) -> Score:
    """Score, and add the rows to those of the file; say what has changed. Without entrants, return what is there."""
    from ..conformance import Score, scoring
    from ..conformance import report as reports
    from ..mechanics import checks
    from .writing import check_folder, write_together

    dts = [checks.positive(step, "time", "--step") for step in steps] if steps else scoring.STEPS
    patience = checks.positive(limit, "time", "--limit")
    check_folder(folder, (DATA, TABLE, PAGE))
    older = Score.load(folder / DATA) if (folder / DATA).exists() else Score(())
    rows: list[Row] = [] if entrants else list(older.rows)
    stopped: int | str | None = None
    try:
        for row in scoring.runs(
            entrants, cases, dts, derivatives=derivatives, repeat=repeat, limit=patience, tell=partial(_tell, quiet)
        ):
            rows.append(row)  # noqa: PERF402  those that are there are kept, whatever stops it
    except KeyboardInterrupt:
        stopped = signals.INTERRUPTED
        signals.heard()
    except SystemExit as end:
        stopped = end.code
        signals.heard()
    found = Score(tuple(rows))
    for line in found.changes_from(older):
        if not quiet:
            screen.note(f"changed: {line}")
    everything = found.with_rows_of(older)
    files: dict[str, Callable[[Path], object]] = {DATA: everything.save}
    if report:
        files[TABLE] = partial(_put, reports.markdown(everything))
        files[PAGE] = partial(_put, reports.page(everything, cases))
    if rows or stopped is None:
        write_together(folder, files)
    if stopped is not None:
        screen.note(f"trundle: interrupted; {len(rows)} of the runs written" if rows else "trundle: interrupted")
        raise SystemExit(stopped)
    return found


def _tell(quiet: bool, line: str) -> None:
    if not quiet:
        screen.note(f"{line} ...")
