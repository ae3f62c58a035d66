"""Print the table of the places: `python -m tests.dispatch`, or `make dispatch`; with `--each`, all of them."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import trundle

from .finding import Place, places
from .parts import KINDS


def main(words: list[str]) -> None:
    """Find them and print them."""
    found = list(places(Path(trundle.__file__).parents[1], "trundle"))
    if "--each" in words:
        print(*(f"{one.file}:{one.line}: {one.part}" for one in found), sep="\n")
    print(table(found))


def table(found: list[Place]) -> str:
    """Return how many there are in each file, of each kind; the files with most of them first."""
    count = Counter((one.file, one.kind) for one in found)
    files = [file for file, _ in Counter(one.file for one in found).most_common()]
    heads = [kind.name for kind in KINDS]
    rows = [[file, *(count[file, head] for head in heads)] for file in files]
    rows.append(["total", *(sum(row[i] for row in rows) for i in range(1, len(heads) + 1))])
    lines = [["file", *heads, "all"], *([str(cell or "·") for cell in (*row, sum(row[1:]))] for row in rows)]
    wide = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join(f"{line[0]:{wide[0]}}" + "".join(map("  {:>{}}".format, line[1:], wide[1:])) for line in lines)


if __name__ == "__main__":
    main(sys.argv[1:])
