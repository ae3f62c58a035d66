"""Run every benchmark and print one table of ratios: `make bench`, or `python benchmarks/run.py [name ...]`.

Exit status: 0, every target is met; 1, one is missed; 2, a benchmark broke, so its ratios mean nothing.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before NumPy: one thread copies memory, so one thread computes
os.environ.setdefault("JAX_PLATFORMS", "cpu")

import platform
import sys
import time
import traceback
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version

NAMES = (
    "path",
    "trajectory",
    "bodies",
    "compiled_steps",
    "ensembles",
    "sensitivities",
    "fits",
    "reuse",
    "long_run",
    "orientation",
    "start_up",
    "fields",
    "members",
    "sweeps",
    "engines",
    "lab_load",
    "lab_page",
)
PACKAGES = ("numpy", "scipy", "heyoka", "numba", "llvmlite", "jax", "diffrax", "mpmath", "xarray", "matplotlib")
WIDTHS = (52, 10, 9, 7)


def main(names: list[str]) -> int:
    """Print the table and return the exit status."""
    unknown = sorted(set(names) - set(NAMES))
    if unknown:
        print(f"There is no benchmark {', '.join(unknown)}; there are {', '.join(NAMES)}.", file=sys.stderr)
        return 2
    print(f"Python {platform.python_version()}, " + ", ".join(_versions()))
    print(f"{os.cpu_count()} cores of {platform.machine()}; load {_load()} before")
    _line("", "target", "measured", "", "times")
    missed, broken = [], []
    begun = time.perf_counter()
    for name in names or NAMES:
        try:
            module = import_module(name)
            print(f"\n{module.TITLE}")
            for row in module.rows():
                _line(f"  {row.what}", row.target, row.value, row.verdict, row.raw)
                missed += [row.what.strip()] if row.missed else []
        except Exception as error:  # noqa: BLE001  the others still run
            traceback.print_exc()
            print(f"  BROKEN: {name}: {error}", flush=True)
            broken.append(name)
    print(f"\nLoad {_load()} after {time.perf_counter() - begun:.0f} s.", end=" ")
    print("Every target is met." if not missed + broken else f"MISSED: {'; '.join(missed) or 'none'}.")
    if broken:
        print(f"BROKEN: {', '.join(broken)}.")
    return 2 if broken else int(bool(missed))


def _line(what: str, *cells: str) -> None:
    parts = [what, *cells]
    print(" ".join(part.ljust(width) for part, width in zip(parts, (*WIDTHS, 0), strict=True)).rstrip(), flush=True)


def _versions() -> list[str]:
    found = []
    for package in PACKAGES:
        try:
            found.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            found.append(f"no {package}")
    return found


def _load() -> str:
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
