"""Computations in processes of their own: they can be ended, and may crash, without harm to the server."""

from __future__ import annotations

import asyncio
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
from .settings import Settings

if TYPE_CHECKING:
    from pebble import ProcessFuture
    from starlette.requests import Request

PRELOADED = "trundle.lab.preloaded"
TASKS_OF_A_PROCESS = 1000  # then a fresh one takes its place: what it has kept in memory goes with it


class LeftError(Exception):
    """Who asked has gone: nobody reads an answer."""


class Lane:
    """Some worker processes, and the queue before them.

    Work is handed to a process only when one is free, so that what waits costs nothing to drop.

    Parameters
    ----------
    workers : int
        Processes.
    settings : Settings
        The bounds.
    niceness : int
        By how much its processes stand back for those of others.

    Examples
    --------
    See `trundle.lab.app.create_app`.
    """

    def __init__(self, workers: int, settings: Settings, niceness: int = 0) -> None:
        self.workers, self.settings, self.niceness = workers, settings, niceness
        self._free = asyncio.Semaphore(workers)
        self._asked: set[asyncio.Task[Any]] = set()
        self._running: set[asyncio.Task[Any]] = set()
        self._lock = threading.Lock()
        self._pool: ProcessPool | None = None
        self._context: Any = None

    def start(self) -> None:
        """Start the processes; returns when they are there, which takes a second or two."""
        with self._lock:
            if self._pool is None or not self._pool.active:
                if self._pool is not None:
                    threading.Thread(target=_end, args=(self._pool, self._context), daemon=True).start()
                self._pool, self._context = _new_pool(self.workers, self.niceness)

    def stop(self) -> None:
        """End the processes, whatever they do."""
        with self._lock:
            pool, self._pool = self._pool, None
        if pool is not None:
            _end(pool, self._context)

    async def run(self, request: Request | None, function: Callable[..., Any], *arguments: Any) -> Any:
        """Compute something in a process of the lane.

        Parameters
        ----------
        request : Request or None
            When its client goes away, the computation ends.
        function : callable
            Of a module that the processes can import.
        *arguments : object
            That can be pickled.

        Returns
        -------
        object
            What the function returned.

        Raises
        ------
        RefusedError
            With status 503 if too many wait, 504 if it takes too long, 500 if the process died.
        LeftError
            If the client has gone.
        """
        if len(self._asked) >= self.settings.queue:
            raise refused(503, "The lab is busy: too many ask at once. Try again in a moment.", kind="BusyError")
        work = asyncio.create_task(self._computed(function, arguments))
        self._asked.add(work)
        work.add_done_callback(self._forget)
        if request is None:
            return await work
        left = asyncio.create_task(_left(request))
        try:
            await asyncio.wait({work, left}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            left.cancel()
            if not work.done():
                self._drop(work)
        if not work.done():
            raise LeftError
        return work.result()

    def _forget(self, work: asyncio.Task[Any]) -> None:
        self._asked.discard(work)
        if not work.cancelled():
            work.exception()  # looked at, so that nobody complains of an answer that nobody waited for

    def _drop(self, work: asyncio.Task[Any]) -> None:
        """End work that nobody waits for; what runs may end by itself first, since a new process costs more."""
        if work in self._running:
            asyncio.get_running_loop().call_later(self.settings.grace, work.cancel)
        else:
            work.cancel()

    async def _computed(self, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
        try:
            async with asyncio.timeout(self.settings.patience):
                await self._free.acquire()
        except TimeoutError:
            raise refused(503, "The lab is busy. Try again in a moment.", kind="BusyError") from None
        task: Any = asyncio.current_task()
        self._running.add(task)
        try:
            return await self._in_process(function, arguments)
        except ProcessExpired:
            message = "The process that computed this died. It may have taken too much memory: ask for less."
            raise refused(500, message, kind="CrashError") from None
        except TimeoutError:
            most = self.settings.wall_time
            message = f"This takes longer than the {most:g} s that the lab allows; `trundle run` takes its time."
            raise refused(504, message, "run.duration", kind="TimeUpError") from None
        finally:
            self._running.discard(task)
            self._free.release()

    async def _in_process(self, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
        for _ in range(2):  # an idle process that was killed breaks its pool; the next one is whole
            with suppress(BrokenProcessPool):
                return await asyncio.wrap_future(await self._scheduled(function, arguments))
        raise refused(503, "The processes that compute keep dying. Start the lab anew.", kind="CrashError")

    async def _scheduled(self, function: Callable[..., Any], arguments: tuple[Any, ...]) -> ProcessFuture:
        """Hand work to the pool, to a new one where there is none, or an idle process of it was killed."""
        if self._pool is None or not self._pool.active:
            await asyncio.to_thread(self.start)
        pool: Any = self._pool
        try:
            return pool.schedule(function, arguments, timeout=self.settings.wall_time)
        except RuntimeError as error:
            raise BrokenProcessPool(*error.args) from None


async def _left(request: Request) -> None:
    """Return when the client has gone; the body has been read before."""
    while (await request.receive())["type"] != "http.disconnect":
        pass


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


def _new_pool(workers: int, niceness: int) -> tuple[ProcessPool, _Context]:
    from .warm import begin_worker

    context: Any = _Context()
    pool = ProcessPool(
        workers, max_tasks=TASKS_OF_A_PROCESS, initializer=begin_worker, initargs=(niceness,), context=context
    )
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
