"""What a user waits for before anything is computed: imports, and a whole run of the command."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from measure import BrokenBenchmarkError, Row, check, seconds

TITLE = "Start-up, each in a process of its own; the three: heyoka, xarray, matplotlib.pyplot"

ROUNDS = 5
HEAVY = ("heyoka", "xarray", "matplotlib", "sympy")

_IMPORT = """
import json, sys, time
begun = time.perf_counter()
import trundle
took = time.perf_counter() - begun
print(json.dumps([took, sorted({name.partition(".")[0] for name in sys.modules})]))
"""


def rows() -> Iterator[Row]:
    """Measure, the processes taking turns."""
    took, loaded = math.inf, set[str]()
    with tempfile.TemporaryDirectory() as folder:
        python = [sys.executable, "-c"]
        command = [sys.executable, "-m", "trundle", "run", "tilted-turntable", "-o", str(Path(folder) / "out")]
        processes = {
            "python": [*python, "pass"],
            "trundle": [*python, _IMPORT],
            "three": [*python, "import heyoka, xarray, matplotlib.pyplot"],
            "run": command,
            "run, no figure": [*command, "--no-figure"],
        }
        best, used = dict.fromkeys(processes, math.inf), dict.fromkeys(processes, math.inf)
        for round_ in range(ROUNDS + 1):  # the first fills the caches
            for name, words in processes.items():
                elapsed, processor, printed = _timed(words)
                if round_:
                    best[name], used[name] = min(best[name], elapsed), min(used[name], processor)
                if name == "trundle":
                    once, modules = json.loads(printed)
                    took, loaded = min(took, once), loaded | set(modules)
        check((Path(folder) / "out" / "path.png").stat().st_size > 0, "the run must leave its figure")

    found = sorted(loaded & set(HEAVY))
    label = "import trundle: heavy packages loaded"
    yield Row(label, len(found), most=0, raw=", ".join(found) or f"none of {', '.join(HEAVY)}", kind="count")
    yield Row("import trundle", took, raw=f"a process that does nothing: {seconds(best['python'])}", kind="time")

    def against(times: dict[str, float], name: str) -> str:
        return f"{seconds(times[name])} / {seconds(times['three'])}"

    ratio, raw = best["run"] / best["three"], against(best, "run")
    yield Row("trundle run, with figures / import of the three", ratio, most=1.5, raw=raw)
    ratio, raw = used["run"] / used["three"], against(used, "run")
    yield Row("  the same in processor time, all cores", ratio, raw=raw)
    name = "run, no figure"
    yield Row("trundle run --no-figure / import of the three", best[name] / best["three"], raw=against(best, name))


def _timed(words: Sequence[str]) -> tuple[float, float, str]:
    """Return the elapsed time, s, the processor time of the process, s, and what it printed."""
    begun, before = time.perf_counter(), os.times()
    done = subprocess.run(words, capture_output=True, text=True, check=False)  # noqa: S603  our own words
    elapsed, after = time.perf_counter() - begun, os.times()
    processor = after.children_user + after.children_system - before.children_user - before.children_system
    if done.returncode:
        raise BrokenBenchmarkError(f"{' '.join(words[:4])} ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    return elapsed, processor, done.stdout
