"""`trundle sweep`: a scenario for many values of its numbers, into a store that grows chunk by chunk."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InvalidValueError
from . import screen, signals
from .options import Quiet

if TYPE_CHECKING:
    from ..analysis.sweep.engine import Engine
    from ..analysis.sweep.plan import Plan
    from ..analysis.sweep.store import Store

_SHORT = 5.0  # s: to start other processes takes about as long
_MINUTE, _HOUR = 60.0, 3600.0


def sweep(
    files: Annotated[
        list[str] | None,
        typer.Argument(metavar="FILE", help="A sweep as TOML, or the name of a shipped one. With --merge: stores."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="STORE", help="Default: the file's name, with .zarr."),
    ] = None,
    resume: Annotated[
        Path | None, typer.Option("--resume", metavar="STORE", help="Go on with a store that is not finished.")
    ] = None,
    status: Annotated[
        Path | None, typer.Option("--status", metavar="STORE", help="Say how far a store has come.")
    ] = None,
    merge: Annotated[bool, typer.Option("--merge", help="Join stores of parts of one sweep into one.")] = False,
    part: Annotated[
        str | None,
        typer.Option(metavar="K/N", help="Only the K-th of N parts, for machines that know nothing of each other."),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(metavar="N", help="Processes. Default: as many as there are processors.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Of a Dask scheduler; 'local' starts one.")
    ] = None,
    dry: Annotated[bool, typer.Option("--dry-run", help="Check it, say what it will take, and run nothing.")] = False,
    names: Annotated[bool, typer.Option("--list", help="Name the sweeps that ship with trundle.")] = False,
    quiet: Quiet = False,
) -> None:
    """Run a scenario for many values of its numbers, measure each run, and write a Zarr store.

    The sweep's file says which scenario, what varies, and what is measured; docs/sweeps.md describes it. The store
    grows chunk by chunk, and `--resume` goes on with one that was interrupted, however that was. Results are the
    same to the last bit for any number of workers.

    Exit status: 0, all is well; 2, bad input; 130, interrupted; 1, all else.
    """
    from ..analysis.sweep import shipped
    from ..analysis.sweep.engine import Engine
    from ..analysis.sweep.store import Store
    from ..extras import need

    if names:
        screen.show_names(shipped.titles(), "sweep")
        return
    need("sweep", "trundle sweep")
    if status is not None:
        screen.out(_progress_of(Store.open(status)))
        return
    if merge:
        _merge([Path(name) for name in files or ()], output, quiet=quiet)
        return
    engine = Engine(workers, scheduler)
    if resume is not None:
        opened = Store.open(resume)
        _go(opened.plan(), resume, engine, _part(part), resume=True, quiet=quiet, dry=dry, chosen=workers is not None)
        return
    if not files or len(files) != 1:
        rule = "must be one sweep's file, or the name of a shipped one"
        raise InvalidValueError("FILE", rule, " ".join(files or ()), "`trundle sweep --list` names these.")
    from ..analysis.sweep.store import check_new

    plan = shipped.load(files[0])
    store = Path(f"{Path(files[0]).stem}.zarr") if output is None else output.expanduser()
    if not dry:
        check_new(store)
    _go(plan, store, engine, _part(part), resume=False, quiet=quiet, dry=dry, chosen=workers is not None)


def _go(
    plan: Plan,
    store: Path,
    engine: Engine,
    part: tuple[int, int],
    *,
    resume: bool,
    quiet: bool,
    dry: bool,
    chosen: bool,
) -> None:
    """Say what it will take, run it, and show what came of it."""
    from dataclasses import replace

    from ..analysis.sweep.api import cost, run_plan
    from ..analysis.sweep.store import Store, check_room, in_bytes

    engine.check(plan)
    check_room(store, plan)
    bounded = plan.design.name == "boundary"
    share = 1.0 / part[1] if not resume else float((Store.open(store).status == 0).mean())
    needed = cost(plan, engine)
    if not quiet:
        at = "here" if engine.processes == 1 and engine.scheduler is None else f"with {engine.processes} workers"
        at = at if engine.scheduler is None else f"if {engine.scheduler} has {engine.processes} workers"
        parts, about = f" in {plan.chunks:,} chunk{'s' * (plan.chunks != 1)}", "about"
        if bounded:
            parts, about = ", of which those near the boundary are run", "at most"
        took = _in_words(needed.seconds * share)
        screen.out(
            f"{plan.members:,} members{parts}: {about} {took} {at}, at most {in_bytes(needed.bytes)}, into {store}"
        )
    if dry:
        return
    if not chosen and engine.scheduler is None and needed.seconds * share < _SHORT:
        engine = replace(engine, workers=1)
    try:
        with screen.ProgressBar(wanted=not quiet, members=0 if bounded else int(plan.members * share)) as bar:
            found = run_plan(plan, engine, store=store, resume=resume, part=part, progress=bar)
    except (KeyboardInterrupt, SystemExit) as end:
        if not store.exists():
            raise
        screen.note(f"trundle: interrupted; {_progress_of(Store.open(store))}")
        screen.note(f"trundle: go on with: trundle sweep --resume {store}")
        raise SystemExit(end.code if isinstance(end, SystemExit) else signals.INTERRUPTED) from None
    signals.check()
    if not quiet:
        screen.out(str(found))
        screen.out(f"Wrote {store}")


def _merge(stores: list[Path], output: Path | None, *, quiet: bool) -> None:
    """Join stores of parts of one sweep."""
    from ..analysis.sweep.store import Store

    if output is None:
        raise InvalidValueError("--output", "must name the store that they are joined in", None, "Write -o all.zarr.")
    if not stores:
        raise InvalidValueError(
            "FILE", "must be the stores to join", "", "Write trundle sweep --merge -o all.zarr a.zarr b.zarr"
        )
    opened = [Store.open(path) for path in stores]
    plan = opened[0].plan()
    for store in opened[1:]:
        store.check_same(plan)
    joined = Store.create(output, plan)
    with joined.held():
        taken = sum(joined.take(store) for store in opened)
    if not quiet:
        screen.out(f"{taken:,} chunks joined in {output}: {_progress_of(joined)}")


def _progress_of(store: Store) -> str:
    """Say how far a store has come."""
    counts = store.counts()
    all_, waiting = sum(counts.values()), counts.pop("waiting")
    said = f"{all_ - waiting:,} of {all_:,} members are done"
    rest = [f"{counts[name]:,} {name}" for name in ("refused", "failed", "inferred") if counts[name]]
    return ", ".join([said, *rest])


def _part(text: str | None) -> tuple[int, int]:
    if text is None:
        return 1, 1
    found = re.fullmatch(r"\s*(\d+)\s*/\s*(\d+)\s*", text)
    if found is None or not 1 <= int(found[1]) <= int(found[2]):
        raise InvalidValueError("--part", "must be K/N with K from 1 to N", text, "Write for instance 1/2.")
    return int(found[1]), int(found[2])


def _in_words(seconds: float) -> str:
    """Return how long something takes, in the unit that reads best.

    Examples
    --------
    >>> _in_words(0.2), _in_words(95.0), _in_words(9000.0)
    ('1 s', '1.6 min', '2.5 h')
    """
    if seconds < _MINUTE:
        return f"{max(seconds, 1):.0f} s"
    return f"{seconds / _MINUTE:.2g} min" if seconds < _HOUR else f"{seconds / _HOUR:.2g} h"
