"""Computations in processes of their own: they can be ended, and may crash, without harm to the server."""

from __future__ import annotations

import asyncio
import itertools
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

from ..processes import own_modules
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
        self._workers: list[_Worker] = []
        self._turns = itertools.count()

    def start(self) -> None:
        """Start the processes that are not there; returns when they are, which takes a second or two."""
        with self._lock:
            whole = [worker for worker in self._workers if worker.pool.active]
            killed = [worker for worker in self._workers if worker not in whole]
            if killed:
                _log.warning("a process that waited for work was killed: a fresh one takes its place")
                threading.Thread(target=_end, args=(killed,), daemon=True).start()
            self._workers = whole + [_Worker() for _ in range(self.count - len(whole))]

    def stop(self) -> None:
        """End the processes, whatever they do."""
        with self._lock:
            workers, self._workers = self._workers, []
        _end(workers)

    def computation(
        self, function: Callable[..., Any], arguments: tuple[Any, ...], within: float, most: float | None = None
    ) -> Computation:
        """Return a computation that begins once its result is awaited; `most`: seconds, other than usual."""
        return Computation(self, self.settings.wall_time if most is None else most, function, arguments, within)

    async def schedule(self, most: float, *work: Any) -> ProcessFuture:
        """Hand work to a process, to a new one where there is none, or the one that waited for it was killed."""
        worker = self._next()
        if worker is None or not worker.pool.active:
            await asyncio.to_thread(self.start)
            worker = self._next()
        if worker is None:
            raise BrokenProcessPool("the processes were ended")
        return worker.schedule(next(self._turns), most, *work)

    def _next(self) -> _Worker | None:
        """Return the idle process that worked last: it has traced the law that is asked about again."""
        return min(self._workers, key=_Worker.rank, default=None)


class _Worker:
    """One process, and its successor where it dies: in a pool of its own, since a pool gives work to any of its own."""

    def __init__(self) -> None:
        from .warm import begin_worker

        self.context: Any = _Context()
        self.pool = ProcessPool(1, max_tasks=TASKS_OF_A_PROCESS, initializer=begin_worker, context=self.context)
        self._given: list[ProcessFuture] = []  # what it has not done, and what it did last
        self._turn = 0
        if not self.pool.active:  # asking starts it
            raise RuntimeError("no process could be started")

    def schedule(self, turn: int, most: float, *work: Any) -> ProcessFuture:
        """Let the process work when it has done what it was given before."""
        try:
            future: ProcessFuture = self.pool.schedule(computed, work, timeout=most)
        except RuntimeError as error:
            raise BrokenProcessPool(*error.args) from None
        self._turn, self._given = turn, [*(one for one in self._given if not one.done()), future]
        return future

    def rank(self) -> tuple[int, bool, int]:
        """Return what is least for who is to work next: first how much waits, last how long ago it was given work."""
        return sum(not one.done() for one in self._given), any(map(_ended, self._given)), -self._turn


def _ended(future: ProcessFuture) -> bool:
    """Whether a process ended with its work: its successor has still to begin."""
    return future.done() and (future.cancelled() or isinstance(future.exception(), ProcessExpired | TimeoutError))


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
        for _ in range(1 + self.processes.count):  # an idle process that was killed breaks its pool; so may be all
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
            with own_modules():
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


def _end(workers: list[_Worker]) -> None:
    """End workers; their processes first, since one that is still starting would complain that its pool has gone."""
    for worker in workers:
        worker.pool.stop()
        for process in worker.context.made:
            with suppress(OSError, ValueError, AttributeError):
                process.kill()
    for worker in workers:
        worker.pool.join()
