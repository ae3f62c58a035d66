"""The command of the fuzz: `python -m tests.fuzz`."""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict
from itertools import count
from pathlib import Path

from . import report
from .classes import CLASSES
from .commands import COMMANDS
from .running import BAD, LIMIT, Outcome, outcomes


def main(words: list[str] | None = None) -> int:
    """Try out scenarios, print the table and the causes; return 1 where some ended badly, else 0."""
    asked = _arguments(words)
    with tempfile.TemporaryDirectory(prefix="fuzz-") as working:
        ended = outcomes(_cases(asked), Path(working), asked.workers, asked.limit, asked.commands)
        found = list(_told(ended, asked))
    found.sort(key=lambda one: (list(CLASSES).index(one.name), one.seed))
    if asked.one:
        _show(found[0])
        return int(found[0].outcome in BAD)
    print(report.table(found))
    print(report.causes(found))
    if asked.folder:
        whole = f"{report.table(found, markdown=True)}\n\n{report.causes(found, markdown=True)}\n"
        (asked.folder / "table.md").write_text(whole, encoding="utf-8")
    return int(any(one.outcome in BAD for one in found))


def _arguments(words: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--class", dest="classes", action="append", choices=CLASSES, help="Only this; may be repeated.")
    parser.add_argument("--count", type=int, default=60, help="Seeds of each class.")
    parser.add_argument("--seed", type=int, default=0, help="The first.")
    parser.add_argument("--minutes", type=float, help="Begin no more after so long.")
    parser.add_argument("--one", action="store_true", help="One seed of one class, with all there is to say of it.")
    parser.add_argument("--folder", type=Path, help="For the table and the scenarios that ended badly.")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1, help="Processes at a time.")
    parser.add_argument("--limit", type=float, default=LIMIT, help="CPU seconds for a scenario and its card.")
    said = "Try one of the other commands, too, on what passes."
    parser.add_argument("--commands", action=argparse.BooleanOptionalAction, default=True, help=said)
    said = 'Only those that begin so, as "check"; may be repeated.'
    parser.add_argument("--command", dest="begin", action="append", default=[], help=said)
    asked = parser.parse_args(words)
    asked.commands = tuple(one for one in COMMANDS if asked.commands and one.startswith(tuple(asked.begin) or ""))
    if asked.begin and not asked.commands:
        parser.error(f"no command begins with {' or '.join(asked.begin)}")
    asked.classes = asked.classes or list(CLASSES)
    if asked.one and len(asked.classes) != 1:
        parser.error("--one needs one --class, and --seed")
    if asked.folder:
        asked.folder.mkdir(parents=True, exist_ok=True)
        (asked.folder / "outcomes.jsonl").unlink(missing_ok=True)
    return asked


def _cases(asked: argparse.Namespace) -> Iterator[tuple[str, int]]:
    """Return the seeds of each class in turn, so that a run that is cut short has some of each."""
    began = time.monotonic()
    for i in range(1) if asked.one else count() if asked.minutes and not asked.count else range(asked.count):
        for name in asked.classes:
            if asked.minutes and time.monotonic() - began > 60 * asked.minutes:
                return
            yield name, asked.seed + i


def _told(found: Iterator[Outcome], asked: argparse.Namespace) -> Iterator[Outcome]:
    """Tell of each that ends badly as it comes, and keep it: a run that is broken off leaves what it has found."""
    for one in found:
        if one.outcome in BAD and not asked.one:
            print(f"{one.name} {one.seed}: {one.outcome}: {one.cause}", file=sys.stderr, flush=True)
        if asked.folder:
            report.keep(one, asked.folder)
            with (asked.folder / "outcomes.jsonl").open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(asdict(one), ensure_ascii=False) + "\n")
        yield one


def _show(one: Outcome) -> None:
    print(one.text)
    for name in ("outcome", "cause", "detail", "warned", "refusals", "seconds"):
        print(f"{name}: {getattr(one, name)}")


if __name__ == "__main__":
    sys.exit(main())
