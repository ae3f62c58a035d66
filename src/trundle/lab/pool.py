"""Computations in processes of their own: they can be ended, and may crash, without harm to the server."""

from __future__ import annotations

import asyncio
import logging
import multiprocessing
import signal
import threading
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from multiprocessing import forkserver, resource_tracker
from multiprocessing.process import BaseProcess
from typing import TYPE_CHECKING, Any

from pebble import ProcessExpired, ProcessPool

from .errors import refused
from .niceness import computed
from .settings import Settings

if TYPE_CHECKING:
    from pebble import ProcessFuture

PRELOADED = "trundle.lab.preloaded"
TASKS_OF_A_PROCESS = 1000  # then a fresh one takes its place: what it has kept in memory goes with it
_log = logging.getLogger("trundle.lab")


class Processes:
    """Worker processes that take any work, as many at once as there are processes.

    Parameters
    ----------
    count : int
        Of processes.
    settings : Settings
        The bounds.

    Examples
    --------
    See `trundle.lab.lanes.Lanes`.
    """

    def __init__(self, count: int, settings: Settings) -> None:
        self.count, self.settings = count, settings
        self._lock = threading.Lock()
        self._pool: ProcessPool | None = None
        self._context: Any = None

    def start(self) -> None:
        """Start the processes; returns when they are there, which takes a second or two."""
        with self._lock:
            if self._pool is None or not self._pool.active:
                if self._pool is not None:
                    _log.warning("a process that waited for work was killed: fresh ones take the place of all")
                    threading.Thread(target=_end, args=(self._pool, self._context), daemon=True).start()
                self._pool, self._context = _new_pool(self.count)

    def stop(self) -> None:
        """End the processes, whatever they do."""
        with self._lock:
            pool, self._pool = self._pool, None
        if pool is not None:
            _end(pool, self._context)

    def computation(
        self, function: Callable[..., Any], arguments: tuple[Any, ...], within: float, most: float | None = None
    ) -> Computation:
        """Return a computation that begins once its result is awaited; `most`: seconds, other than usual."""
        return Computation(self, self.settings.wall_time if most is None else most, function, arguments, within)

    async def schedule(self, most: float, *work: Any) -> ProcessFuture:
        """Hand work to the pool, to a new one where there is none, or an idle process of it was killed."""
        if self._pool is None or not self._pool.active:
            await asyncio.to_thread(self.start)
        pool: Any = self._pool
        try:
            return pool.schedule(computed, work, timeout=most)
        except RuntimeError as error:
            raise BrokenProcessPool(*error.args) from None


class Computation:
    """One computation in a process; see `Processes.computation`."""

    def __init__(self, processes: Processes, most: float, *work: Any) -> None:
        self.processes, self.most, self.work = processes, most, work
        self._future: ProcessFuture | None = None

    @property
    def running(self) -> bool:
        """Whether a process has begun it: a fresh one takes a moment to be there."""
        return self._future is not None and self._future.running()

    async def result(self) -> Any:
        """Return what the function returned; its process ends where this is cancelled."""
        try:
            return await self._in_process()
        except ProcessExpired as expired:
            _log.warning("a process that computed died (%s): a fresh one takes its place", _cause(expired.exitcode))
            message = "The process that computed this died. It may have taken too much memory: ask for less."
            raise refused(500, message, kind="CrashError") from None
        except TimeoutError:
            message = (
                f"This takes longer than the {self.most:g} s that the lab allows; the command line takes its time."
            )
            raise refused(504, message, "run.duration", kind="TimeUpError") from None

    async def _in_process(self) -> Any:
        for _ in range(2):  # an idle process that was killed breaks its pool; the next one is whole
            with suppress(BrokenProcessPool):
                self._future = await self.processes.schedule(self.most, *self.work)
                return await asyncio.wrap_future(self._future)
        raise refused(503, "The processes that compute keep dying. Start the lab anew.", kind="CrashError")


def _cause(code: int | None) -> str:
    """Say how a process ended."""
    if code is not None and code < 0:
        with suppress(ValueError):
            return signal.Signals(-code).name
    return f"status {code}"


class _Context:
    """How processes are made: as copies of one that has imported everything, where there are such copies."""

    def __init__(self) -> None:
        copies = "forkserver" in multiprocessing.get_all_start_methods()
        self._context = multiprocessing.get_context("forkserver" if copies else "spawn")
        self.made: list[BaseProcess] = []
        if copies:
            self._context.set_forkserver_preload([PRELOADED])
            resource_tracker.ensure_running()
            before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # Ctrl-C is the server's to hear
            try:
                forkserver.ensure_running()
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)

    def Process(self, *arguments: Any, **named: Any) -> BaseProcess:
        """Make a process, and remember it while it lives."""
        made: BaseProcess = self._context.Process(*arguments, **named)  # type: ignore[attr-defined]
        self.made = [*(process for process in self.made if process.is_alive()), made]
        return made


def preload() -> None:
    """Start the process that the workers are copies of, where there are copies: it loads while others do."""
    _Context()


def _new_pool(workers: int) -> tuple[ProcessPool, _Context]:
    from .warm import begin_worker

    context: Any = _Context()
    pool = ProcessPool(workers, max_tasks=TASKS_OF_A_PROCESS, initializer=begin_worker, context=context)
    if not pool.active:  # asking starts it
        raise RuntimeError("no process could be started")
    return pool, context


def _end(pool: ProcessPool, context: _Context) -> None:
    """End a pool; its processes first, since one that is still starting would complain that the pool has gone."""
    with suppress(RuntimeError):
        pool.stop()
        for process in context.made:
            with suppress(OSError, ValueError, AttributeError):
                process.kill()
        pool.join()
