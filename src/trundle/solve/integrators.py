"""Compiled integrators of laws: one a structure, from this process, the user's cache or heyoka's compiler."""

from __future__ import annotations

import contextlib
import copy
import hashlib
import pickle
import platform
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from ..mechanics.parameters import numbers, structure_of
from ..mechanics.system import RollingSystem
from . import integrator_cache
from .charts import LAWS_OWN, Chart, charts
from .laws import Law
from .lowering import Lowered, lower

TOLERANCE = 1e-15
# How much is done for the speed of a step. LLVM's highest levels compile for half as long again, and run no faster;
# heyoka's loops unrolled take half the time for a step, and six to fifteen times as long to compile.
IN_HASTE, WITH_CARE, UNROLLED = 0, 1, 2


def compiled(system: RollingSystem, law: Law, tolerance: float = TOLERANCE) -> tuple[Any, Lowered]:
    """Return a fresh copy of a compiled integrator: from this process, the user's cache, or the compiler.

    Examples
    --------
    See `benchmarks/trajectory.py`.
    """
    lowered, key = ready(system, law, tolerance)
    return _copied(lowered, key, tolerance, WITH_CARE), lowered


def _copied(lowered: Lowered, key: str, tolerance: float, level: int) -> Any:
    def compile_() -> Any:
        return _compile(*lowered.heyoka(), tolerance, lowered.parameters, level)

    return copy.copy(kept(f"{key}-{level}", compile_))


@contextlib.contextmanager
def borrowed(lowered: Lowered, key: str, tolerance: float, level: int) -> Iterator[Any]:
    """Lend a copy that nobody else uses, and keep it for the next stretch: to make one takes a millisecond."""
    name = f"{key}-{level}"
    integrator = idle(name) or _copied(lowered, key, tolerance, level)
    if lowered.event_functions:
        integrator.reset_cooldowns()  # a stop just passed is not looked for again at once
    yield integrator
    put_back(name, integrator)  # not where it broke down


def idle(name: str) -> Any | None:
    """Return a copy that was put back under a name, if there is one."""
    waiting = _memory().idle.get(name)
    return waiting.pop() if waiting else None


def put_back(name: str, integrator: Any) -> None:
    """Keep a copy that is no longer in use for whoever asks for the next."""
    _memory().idle.setdefault(name, []).append(integrator)


def ready(
    system: RollingSystem,
    law: Law,
    tolerance: float,
    state: Sequence[float] | None = None,
    zeros: frozenset[int] | None = None,
) -> tuple[Lowered, str]:
    """Return a law ready for the compiler, and the name of what comes of it; worked out once for each structure.

    Parameters
    ----------
    system, law, tolerance
        What is integrated, and how closely.
    state : sequence of float, optional
        The law's numbers where a run begins, for the chart of fewest operations around it; absent: the law's own chart.
    zeros : frozenset of int, optional
        Which of the system's numbers are 0 for good; absent: those that are.
    """
    if zeros is None:
        zeros = frozenset(i for i, value in enumerate(system.once(numbers)) if value == 0)
    among = (LAWS_OWN,) if state is None else charts(system, law)
    known = ready_in(system, law, tolerance, zeros, among)
    return next(each for each in known if state is None or each[0].chart.contains(state))


def ready_in(
    system: RollingSystem, law: Law, tolerance: float, zeros: frozenset[int], among: tuple[Chart, ...]
) -> list[tuple[Lowered, str]]:
    """Return a law in each of some charts, those of fewest operations first, with the name of what comes of it."""
    memory = _memory().ready
    structure: Any = (system.once(structure_of), law.identity, tolerance, zeros, among)
    try:
        known = memory.get(structure)
    except TypeError:  # a part of one's own that cannot be hashed, and so may change
        structure = known = None
    if known is None:
        lowered = sorted((lower(system, law, chart, zeros) for chart in among), key=lambda each: each.cost)
        known = [(each, _key(*each.heyoka(), tolerance, each.parameters)) for each in lowered]
        if structure is not None:
            memory[structure] = known
    return known


class _Memory:
    """Compiled integrators of this process, by key, never used themselves, only copied; and the laws they came of."""

    def __init__(self) -> None:
        self.known: dict[str, Any] = {}
        self.idle: dict[str, list[Any]] = {}  # copies between two uses
        self.ready: dict[Any, list[tuple[Lowered, str]]] = {}


@cache
def _memory() -> _Memory:
    return _Memory()


def kept(key: str, compile_: Callable[[], Any]) -> Any:
    """Return what was compiled under a key, or compile it and keep it in this process and in the user's cache."""
    known = _memory().known
    if key not in known:
        _quiet()
        known[key] = integrator_cache.load(key)
        if known[key] is None:
            with _kept_once():
                known[key] = compile_()
            integrator_cache.store(key, known[key])
    return known[key]


@contextlib.contextmanager
def _kept_once() -> Iterator[None]:
    """Keep heyoka from keeping on disk, in up to 20 gigabytes, what is kept here."""
    import heyoka

    state = heyoka.llvm_state
    enabled = hasattr(state, "set_diskcache_enabled") and state.get_diskcache_enabled()  # of 7.10 and later
    if not enabled:
        yield
        return
    state.set_diskcache_enabled(False)
    try:
        yield
    finally:
        state.set_diskcache_enabled(True)


@cache
def _quiet() -> None:
    """Keep heyoka's warnings out of the results, among which it prints them.

    They say that a stop's root was not found where it was looked for, and passed over. A lift or slip passed over shows
    on the card, in the normal force and the friction needed; slip has two stops for its end.
    """
    import heyoka

    heyoka.set_logger_level_error()


def _compile(equations: list[Any], stops: list[Any], tolerance: float, parameters: int, level: int) -> Any:
    import heyoka

    return heyoka.taylor_adaptive(
        equations,
        [0.0] * len(equations),
        pars=[0.0] * parameters,
        tol=tolerance,
        compact_mode=level != UNROLLED,
        opt_level=min(level, WITH_CARE),
        t_events=[heyoka.t_event(stop, direction=heyoka.event_direction.negative) for stop in stops],
    )


def _key(equations: list[Any], stops: list[Any], tolerance: float, parameters: int) -> str:
    """Name what a compiled integrator depends on: the equations, the tolerance, heyoka and the processor."""
    import heyoka

    parts = [repr(tolerance), str(parameters), heyoka.__version__, _processor()]
    whole = pickle.dumps((equations, stops))  # the repr of a long expression ends in "..."
    return hashlib.sha256("\n".join(parts).encode() + whole).hexdigest()[:32]


@cache
def _processor() -> str:
    with contextlib.suppress(OSError):
        lines = Path("/proc/cpuinfo").read_text(errors="replace").splitlines()
        return "".join(sorted({line for line in lines if line.startswith(("model name", "flags", "Features"))}))
    return platform.machine() + platform.processor()
