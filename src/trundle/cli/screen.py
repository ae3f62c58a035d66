"""What the commands print: tables on a terminal, plain text anywhere else."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Timer
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from . import signals

if TYPE_CHECKING:
    from ..verify import Card

PATIENCE = 1.0  # s without a progress bar


def out(text: str = "", end: str = "\n") -> None:
    """Print to standard output."""
    print(text, end=end)  # noqa: T201


def note(text: str) -> None:
    """Print to standard error."""
    print(text, file=sys.stderr)  # noqa: T201


def json_text(value: object) -> str:
    """Return a value as JSON for people and programs."""
    import json

    return json.dumps(value, indent=2, ensure_ascii=False)


def show(found: Any, written: Iterable[Path] = (), *, quiet: bool = False, as_json: bool = False) -> None:
    """Print a result as JSON, and nothing else; or its text, and the names of the files."""
    if as_json:
        show_json(found.as_dict())
    elif not quiet:
        out(str(found))
        wrote(written)


def show_json(value: object) -> None:
    """Print a value as JSON."""
    out(json_text(value))


def wrote(files: Iterable[Path]) -> None:
    """Name the files that were written, if any."""
    names = ", ".join(map(str, files))
    if names:
        out(f"Wrote {names}")


def on_terminal() -> bool:
    """Whether a person reads the standard output as it comes."""
    return sys.stdout.isatty()


def show_names(rows: list[tuple[str, str]], heading: str = "scenario") -> None:
    """Print names and titles.

    Examples
    --------
    >>> show_names([("a", "First"), ("long", "Second")])
    a     First
    long  Second
    """
    if not on_terminal():
        width = max((len(name) for name, _ in rows), default=0)
        for name, title in rows:
            out(f"{name:<{width}}  {title}")
        return
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    table = Table(heading, "what it is", box=SIMPLE_HEAD)
    for name, title in rows:
        table.add_row(Text(name, style="bold", no_wrap=True), Text(title))
    _console().print(table)


def show_source(text: str) -> None:
    """Print a scenario file as it is; in colour on a terminal."""
    if not on_terminal():
        out(text, end="" if text.endswith("\n") else "\n")
        return
    from rich.syntax import Syntax

    _console().print(Syntax(text, "toml", theme="ansi_dark", background_color="default", word_wrap=True))


def show_pairs(title: str, rows: list[tuple[str, str]]) -> None:
    """Print a few named values below a title."""
    if not on_terminal():
        out(title)
        for name, value in rows:
            out(f"  {name}: {value}")
        return
    from rich.table import Table
    from rich.text import Text

    table = Table.grid(padding=(0, 2))
    for name, value in rows:
        table.add_row(Text(name, style="bold"), Text(value))
    console = _console()
    console.print(Text(title, style="bold underline"))
    console.print(table)


def show_card(card: Card) -> None:
    """Print the verification card: a table on a terminal, its own plain text anywhere else."""
    if not on_terminal():
        out(str(card).rstrip("\n"))
        return
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    styles = {True: "green", False: "bold red", None: ""}
    table = Table("", "", "value", "at most", "how", box=SIMPLE_HEAD)
    for figure in card.figures:
        value = f"{figure.value:.{figure.digits}g} {figure.unit}".rstrip()
        bound = "" if figure.bound is None else f"{figure.bound:.2g}"
        cells = [Text(cell) for cell in (figure.name, value, bound, figure.note)]
        table.add_row(Text(figure.outcome, style=styles[figure.passed]), *cells)
    console = _console()
    console.print(Text(card.title, style="bold"))
    console.print(Text(f"method: {card.method}"))
    if card.origin:
        console.print(Text(f"origin: {card.origin}"))
    console.print(table)
    console.print(Text(card.outcome))


def _console(*, stderr: bool = False) -> Any:
    from rich.console import Console

    return Console(stderr=stderr, highlight=False, soft_wrap=False)


class ProgressBar:
    """A bar on standard error, for a run that takes more than a second and a person who waits for it.

    Parameters
    ----------
    wanted : bool
        Whether there may be a bar at all.
    members : int
        Of a sweep: how many are run, to say how many a second; 0 of one run.
    doing : str
        What takes so long, in a word.

    Examples
    --------
    >>> with ProgressBar(wanted=True) as bar:  # no terminal here: nothing is printed
    ...     bar(0.5)
    """

    def __init__(self, *, wanted: bool, members: int = 0, doing: str = "rolling") -> None:
        self.wanted, self.members, self.doing = wanted and sys.stderr.isatty(), members, doing
        self._began = time.monotonic()
        self._bar: Any = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, fraction: float) -> None:
        """Take note of how much of the run is done, 0 to 1; leave here if a signal said so."""
        signals.check()
        if self.wanted and self._bar is None and time.monotonic() - self._began > PATIENCE:
            self._begin()
        if self._bar is not None:
            rate = fraction * self.members / (time.monotonic() - self._began)
            self._bar.update(self._bar.task_ids[0], completed=fraction, rate=f"{rate:,.4g} a second")

    @contextmanager
    def waiting(self) -> Iterator[None]:
        """Show after a while that something goes on, of which nobody knows how much is left."""
        timer = Timer(PATIENCE, self._begin, [None])
        if self.wanted:
            timer.start()
        try:
            yield
        finally:
            timer.cancel()
            if timer.ident is not None:
                timer.join()

    def _begin(self, total: float | None = 1.0) -> None:
        from rich.progress import (
            BarColumn,
            Progress,
            TaskProgressColumn,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )

        left = [TimeElapsedColumn()] if total is None else [TaskProgressColumn(), TimeRemainingColumn()]
        columns = [TextColumn(self.doing), BarColumn(), *left]
        if self.members:
            columns.append(TextColumn("{task.fields[rate]}"))
        self._bar = Progress(*columns, console=_console(stderr=True), transient=True)
        self._bar.add_task("", total=total, rate="")
        self._bar.start()
