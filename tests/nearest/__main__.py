"""Run the tests nearest to what has changed, for as long as they may take: `python -m tests.nearest`."""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys

from .budget import SECONDS
from .changes import acts_otherwise, changed

_FILES = 16  # of tests, at most: to collect more would take as long as to run these
_DOCUMENTS = ("README.md", "CONTRIBUTING.md", "docs/")
_OF_SOURCES = "tests/dispatch/test_dispatch.py"  # imports none of what it reads


def main() -> int:
    """Choose the tests, say which, and run them; return pytest's exit status, and 0 where there was nothing to run."""
    parser = argparse.ArgumentParser(prog="python -m tests.nearest", description=__doc__)
    parser.add_argument("--since", default="HEAD", help="The commit to compare the working tree with.")
    parser.add_argument("--seconds", type=float, default=25.0, help="After these no test begins.")
    asked = parser.parse_args()
    chosen, said = choice(changed(asked.since), asked.since)
    print(*said, sep="\n", flush=True)
    if not chosen:
        return 0
    spread = ["-n", "2", "--dist", "loadscope", "--no-loadscope-reorder"]
    words = ["-q", "-p", "tests.nearest.budget", *chosen] + spread * (len(chosen) > 2)  # a few are sooner run by one
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-m", "pytest", *words], env=os.environ | {SECONDS: str(asked.seconds)}, check=False
    )
    return 0 if done.returncode == 5 else done.returncode  # 5: none of them has a test


def choice(files: list[str], since: str) -> tuple[list[str], list[str]]:
    """Return what pytest is to run for files that have changed, the nearest first, and what there is to say of it."""
    if not files:
        return [], [f"Nothing has changed since {since}: no test to run."]
    python = [one for one in files if re.match(r"(src|tests)/.*(?<!conftest)\.py$", one)]
    documents = [one for one in files if one.startswith(_DOCUMENTS) and one.endswith(".md")]
    acting = {file for file in python if acts_otherwise(file, since)}
    near = nearest(acting) if acting else []
    own = [file for file in (*python, *documents) if os.path.exists(file)]  # noqa: PTH110  their own examples and tests
    of_sources = [_OF_SOURCES] if any(file.startswith("src/") for file in acting) else []
    chosen = list(dict.fromkeys([*own, *of_sources, *(file for _, file in near[:_FILES])]))
    said = [f"{len(files)} files differ from {since}, {len(acting)} of them in what the code does."]
    if left := near[_FILES:]:
        said.append(
            f"{_FILES} of {len(near)} files of tests that depend on it run here; {len(left)} are left to make test."
        )
    if others := sorted({*files} - {*python, *documents}):
        said.append(f"No test is chosen for {', '.join(others)}: make test.")
    return chosen, said


def nearest(files: set[str]) -> list[tuple[int, str]]:
    """Return the files of tests that depend on some files, the nearest first."""
    from .distance import Distances

    return Distances().tests(files)


if __name__ == "__main__":
    sys.exit(main())
