"""Taylor's method to the last digit, by heyoka: one compiled integrator a structure, kept in the user's cache."""

from __future__ import annotations

import contextlib
import copy
import hashlib
import os
import pickle
import platform
import stat
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import SolverError
from ..files import written_whole
from ..mechanics.parameters import numbers
from ..mechanics.system import RollingSystem, State
from .samples import Array, Progress, Samples, cut, ran_off
from .tracing import contact_state, heyoka_system

TOLERANCE = 1e-15
_CHUNKS = 100  # of a run at most, between which progress is told and Ctrl-C is heard
_LEAST_CHUNK = 60  # instants


def available() -> bool:
    """Tell whether heyoka can be imported here.

    Returns
    -------
    bool
        False where PyPI has no wheel of it.

    Examples
    --------
    >>> available() in (True, False)
    True
    """
    from importlib.util import find_spec

    return find_spec("heyoka") is not None


def solve(
    system: RollingSystem, start: State, times: Array, tolerance: float = TOLERANCE, progress: Progress | None = None
) -> Samples:
    """Integrate the rolling law and return the states at the given times; a rim ends the run at the located instant.

    Parameters
    ----------
    system : RollingSystem
        Any system.
    start : State
        A start that rolls.
    times : array (n,)
        Ascending, s, none before the start.
    tolerance : float
        Of each step, relative.
    progress : callable, optional
        Told the fraction done.

    Returns
    -------
    Samples
        At `times`, cut at the rim where it is reached.

    Raises
    ------
    SolverError
        If the integration breaks down.

    Examples
    --------
    >>> import numpy as np
    >>> import trundle as tr
    >>> slope = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane(), tilt=0.1))
    >>> x = solve(slope, slope.place(), np.array([1.0])).position[0, 0]
    >>> print(round(x / (9.80665 * np.sin(0.1) / 2), 12))  # (5/7) g sin α
    0.714285714286
    """
    integrator = _integrator(system, tolerance)
    integrator.time = start.time
    integrator.state[:] = contact_state(system, start)
    integrator.pars[:] = numbers(system)
    states, reached = _propagate(integrator, times, progress)
    times = times[: len(states)]
    if reached is not None:
        times, states = cut(times, states, reached, integrator.state)
    samples = Samples.of_contact(system, times, states[:, :3], states[:, 3:7], states[:, 7:])
    return samples if reached is None else samples.ended(ran_off(reached, system.support.surface.rim))


def _propagate(integrator: Any, times: Array, progress: Progress | None) -> tuple[Array, float | None]:
    """Return the states at the times, and the time of the terminal event if it came first."""
    import heyoka

    parts: list[Array] = []
    for chunk in np.array_split(times, min(_CHUNKS, max(1, times.size // _LEAST_CHUNK))):
        if integrator.time < chunk[0]:
            outcome = integrator.propagate_until(float(chunk[0]))[0]
            if outcome != heyoka.taylor_outcome.time_limit:
                return _stopped(integrator, outcome, parts)
        result = integrator.propagate_grid(chunk)
        parts.append(result[-1].reshape(-1, integrator.state.size))
        if result[0] != heyoka.taylor_outcome.time_limit:
            return _stopped(integrator, result[0], parts)
        if progress is not None:
            progress(float((chunk[-1] - times[0]) / max(times[-1] - times[0], 1e-300)))
    return np.vstack(parts), None


def _stopped(integrator: Any, outcome: Any, parts: list[Array]) -> tuple[Array, float]:
    """Tell the terminal event from a breakdown."""
    if int(outcome) >= 0 or int(outcome) < -1000:
        raise SolverError(
            f"Taylor's method broke down at t = {integrator.time:.9g} s ({outcome}): the rates are no longer finite. "
            "Look for a support or load that jumps, or a surface too curved for the body."
        )
    states = np.vstack(parts) if parts else np.empty((0, integrator.state.size))
    return states, float(integrator.time)


def _integrator(system: RollingSystem, tolerance: float) -> Any:
    """Return a fresh copy of the compiled integrator: from this process, the user's cache, or the compiler."""
    equations, exits = heyoka_system(system)
    key = _key(equations, exits, tolerance, len(numbers(system)))
    return copy.copy(_compiled(key, lambda: _compile(equations, exits, tolerance, len(numbers(system)))))


class _Memory:
    """Compiled integrators of this process, by key; never used themselves, only copied."""

    def __init__(self) -> None:
        self.known: dict[str, Any] = {}


@cache
def _memory() -> _Memory:
    return _Memory()


def _compiled(key: str, compile_: Any) -> Any:
    known = _memory().known
    if key not in known:
        known[key] = _load(key)
        if known[key] is None:
            known[key] = compile_()
            _store(key, known[key])
    return known[key]


def _compile(equations: list[Any], exits: list[Any], tolerance: float, parameters: int) -> Any:
    import heyoka

    return heyoka.taylor_adaptive(
        equations,
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        pars=[0.0] * parameters,
        tol=tolerance,
        compact_mode=True,
        t_events=[heyoka.t_event(exit_, direction=heyoka.event_direction.negative) for exit_ in exits],
    )


def _key(equations: list[Any], exits: list[Any], tolerance: float, parameters: int) -> str:
    """Name what a compiled integrator depends on: the equations, the tolerance, heyoka and the processor."""
    import heyoka

    parts = [repr(tolerance), str(parameters), heyoka.__version__, _processor()]
    whole = pickle.dumps((equations, exits))  # the repr of a long expression ends in "..."
    return hashlib.sha256("\n".join(parts).encode() + whole).hexdigest()[:32]


@cache
def _processor() -> str:
    with contextlib.suppress(OSError):
        lines = Path("/proc/cpuinfo").read_text(errors="replace").splitlines()
        return "".join(sorted({line for line in lines if line.startswith(("model name", "flags", "Features"))}))
    return platform.machine() + platform.processor()


def cache_folder() -> Path:
    """Return the folder of the user's cache in which compiled integrators are kept.

    Returns
    -------
    pathlib.Path
        It may not exist yet.

    Examples
    --------
    >>> cache_folder().name
    'trundle'
    """
    from platformdirs import user_cache_path

    return user_cache_path("trundle", appauthor=False)


def _load(key: str) -> Any:
    """Read a compiled integrator; anything wrong with it means to compile again.

    A pickle can run code, so it must belong to this user and be writable by nobody else.
    """
    path = cache_folder() / f"taylor-{key}.pickle"
    try:
        for place in (path.parent, path):
            facts = place.stat()
            if facts.st_uid != os.getuid() or facts.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
                return None
        digest, _, body = path.read_bytes().partition(b"\n")
        if hashlib.sha256(body).hexdigest().encode() != digest:
            return None
        return pickle.loads(body)  # noqa: S301  own file, checked above
    except Exception:  # noqa: BLE001  a cache must never be a reason to fail
        return None


def _store(key: str, integrator: Any) -> None:
    """Write a compiled integrator, whole or not at all; a cache that cannot be written is done without."""
    folder = cache_folder()
    with contextlib.suppress(Exception):
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        body = pickle.dumps(integrator)
        with written_whole(folder / f"taylor-{key}.pickle") as temporary:
            temporary.touch(mode=0o600)  # whatever the umask, or `_load` would not trust it
            temporary.write_bytes(hashlib.sha256(body).hexdigest().encode() + b"\n" + body)
