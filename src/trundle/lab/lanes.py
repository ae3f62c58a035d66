"""Who is computed for next: a quick lane and a slow one, and in each of them one visitor after the other."""

from __future__ import annotations

import asyncio
import itertools
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .errors import refused
from .pool import Computation, Processes
from .settings import Settings

if TYPE_CHECKING:
    from starlette.requests import Request


_LOOK = 0.1  # of the time in the quick lane: how often it is looked whether a process has begun


class LeftError(Exception):
    """Who asked has gone: nobody reads an answer."""


@dataclass(eq=False)
class _Job:
    """A computation that was asked for."""

    client: str
    slow: bool
    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    number: int  # in the order in which they were asked for
    answer: asyncio.Future[Any]
    most: float | None = None  # s, that it may take; none: as usual
    work: asyncio.Task[None] | None = None  # while it is computed
    computation: Computation | None = None  # likewise
    began: float | None = None  # when it was first seen to run: a fresh process takes a moment to be there
    timer: asyncio.TimerHandle | None = None  # of its patience, while it waits
    left: bool = False  # nobody waits for it
    again: bool = False  # it was ended to make room, and waits to be computed anew


class Lanes:
    """Two lanes before the worker processes: the quick one answers what takes milliseconds, the slow one the rest.

    How long a computation takes, nobody knows beforehand. What takes longer than `Settings.quick_time` in the quick
    lane goes on in the slow one, in the process where it is; where that lane is full and others wait, it is ended and
    computed anew when its turn comes. Whose turn it is goes round the visitors, told apart by their address: next is
    the one for whom the fewest processes work, and of what one visitor asked for, the newest.

    Work is handed to a process only when one is free, so that what waits costs nothing to drop.

    Parameters
    ----------
    settings : Settings
        The bounds.

    Examples
    --------
    See `trundle.lab.app.create_app`.
    """

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.processes = Processes(settings.workers + settings.slow_workers, settings)
        self._places = {False: settings.workers, True: settings.slow_workers}  # of the quick lane and of the slow one
        # Where others may come, no one of them takes all that is slow; alone, one may.
        self._most_slow = max(1, settings.slow_workers - int(settings.exposed))
        self._jobs: list[_Job] = []
        self._count = itertools.count()
        self._served: dict[str, int] = {}  # when each visitor of now had its last turn
        self._alarm: asyncio.TimerHandle | None = None
        self._stopped = False

    async def run(
        self,
        request: Request | None,
        slow: bool,
        function: Callable[..., Any],
        *arguments: Any,
        most: float | None = None,
    ) -> Any:
        """Compute something in a process."""
        client = "" if request is None or request.client is None else request.client.host
        self._check(client)
        answer = asyncio.get_running_loop().create_future()
        job = _Job(client, slow, function, arguments, next(self._count), answer, most)
        self._jobs.append(job)
        self._wait(job)
        left = asyncio.create_task(_left(request))
        try:
            await asyncio.wait({answer, left}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            left.cancel()
            if not answer.done():
                self._drop(job)
        if not answer.done():
            raise LeftError
        return answer.result()

    def _check(self, client: str) -> None:
        """Refuse what is more than a visitor's share, or than the lab keeps in mind."""
        own = sum(job.client == client and not job.left for job in self._jobs)
        if client and own >= self.settings.share:
            message = f"You wait for {own} answers already, as many as one visitor may. Ask again when some have come."
            raise refused(429, message, kind="ShareError", after=2)
        if len(self._jobs) >= self.settings.queue:
            raise refused(
                503, "The lab is busy: too many ask at once. Try again in a moment.", kind="BusyError", after=5
            )

    async def stop(self) -> None:
        """End all that runs, and tell whoever waits."""
        self._stopped = True
        for job in list(self._jobs):
            if job.work is not None:
                job.work.cancel()
            self._finish(job, error=refused(503, "The lab has ended.", kind="EndedError"))
        await asyncio.to_thread(self.processes.stop)

    # --- whose turn it is ------------------------------------------------------------------------------------

    def _settle(self) -> None:
        """Let go on in the slow lane what has taken its time, give free places away, and make room for who waits."""
        if self._alarm is not None:
            self._alarm.cancel()
        if self._stopped:
            return
        now = asyncio.get_running_loop().time()
        self._move(now)
        for slow in (True, False):
            while (chosen := self._next(slow)) is not None:
                self._begin(chosen)
        self._make_room(now)
        self._look_again(now)

    def _move(self, now: float) -> None:
        """Let what has had its time in the quick lane go on in the slow one, where that has a place."""
        for job in self._running(slow=False):
            if job.began is None and job.computation is not None and job.computation.running:
                job.began = now
            if self._left_of(job, now) <= 0 and self._admits(slow=True)(job):
                job.slow = True

    def _make_room(self, now: float) -> None:
        """End what has had its time in the quick lane, as many as wait for it; the slow lane computes it anew."""
        waiting = sum(job.work is None and not job.slow for job in self._jobs)
        late = [job for job in self._running(slow=False) if self._left_of(job, now) <= 0 and not job.again]
        held = self._held()
        for job in sorted(late, key=lambda job: (-held[job.client], job.began))[:waiting]:
            job.again = True
            job.work.cancel()  # type: ignore[union-attr]

    def _look_again(self, now: float) -> None:
        """See to it that no time in the quick lane passes, and no process begins, without being noticed."""
        running = self._running(slow=False)
        soon = [self._left_of(job, now) for job in running if job.began is not None and self._left_of(job, now) > 0]
        soon += [_LOOK * self.settings.quick_time] * any(job.began is None for job in running)
        self._alarm = asyncio.get_running_loop().call_later(min(soon) + 1e-3, self._settle) if soon else None

    def _left_of(self, job: _Job, now: float) -> float:
        """Return how much of its time in the quick lane is left, s."""
        return self.settings.quick_time - (0.0 if job.began is None else now - job.began)

    def _running(self, slow: bool) -> list[_Job]:
        return [job for job in self._jobs if job.work is not None and job.slow == slow]

    def _held(self) -> Counter[str]:
        """Count the processes that work for each visitor."""
        return Counter(job.client for job in self._jobs if job.work is not None)

    def _admits(self, slow: bool) -> Callable[[_Job], bool]:
        """Return what tells whether a lane has a place for a job, and its visitor not too many of the slow places."""
        running = self._running(slow)
        held = Counter(job.client for job in running)
        free = len(running) < self._places[slow]
        return lambda job: free and (not slow or not job.client or held[job.client] < self._most_slow)

    def _next(self, slow: bool) -> _Job | None:
        admitted, held = self._admits(slow), self._held()
        ready = [job for job in self._jobs if job.work is None and job.slow == slow and admitted(job)]
        return min(
            ready, key=lambda job: (held[job.client], self._served.get(job.client, -1), -job.number), default=None
        )

    # --- one job ---------------------------------------------------------------------------------------------

    def _wait(self, job: _Job) -> None:
        job.timer = asyncio.get_running_loop().call_later(self.settings.patience, self._give_up, job)
        self._settle()

    def _give_up(self, job: _Job) -> None:
        busy = refused(503, "The lab is busy. Try again in a moment.", kind="BusyError", after=5)
        self._finish(job, error=busy)

    def _begin(self, job: _Job) -> None:
        if job.timer is not None:
            job.timer.cancel()
        job.again, job.began, job.computation = False, None, None
        self._served[job.client] = next(self._count)
        job.work = asyncio.create_task(self._compute(job))

    async def _compute(self, job: _Job) -> None:
        within = 0.0 if job.slow else self.settings.quick_time
        try:
            job.computation = self.processes.computation(job.function, job.arguments, within, job.most)
            result = await job.computation.result()
        except asyncio.CancelledError:
            if job.again and not job.left and not self._stopped:
                job.work, job.slow = None, True
                self._wait(job)
            elif job in self._jobs:
                job.answer.cancel()
                self._finish(job)
        except Exception as error:  # noqa: BLE001  what it raised is for who asked
            self._finish(job, error=error)
        else:
            self._finish(job, result)

    def _finish(self, job: _Job, result: Any = None, error: Exception | None = None) -> None:
        """Forget a job, and tell its asker, where there still is one."""
        if job.timer is not None:
            job.timer.cancel()
        job.work = None
        self._jobs.remove(job)
        if not any(other.client == job.client for other in self._jobs):
            self._served.pop(job.client, None)
        if not job.left and not job.answer.done():
            if error is None:
                job.answer.set_result(result)
            else:
                job.answer.set_exception(error)
                job.answer.exception()  # looked at, so that nobody complains where the asker is just leaving
        self._settle()

    def _drop(self, job: _Job) -> None:
        """End work that nobody waits for; what runs may end by itself first, since a new process costs more."""
        job.left = True
        if job.work is None:
            self._finish(job)
        else:
            asyncio.get_running_loop().call_later(self.settings.grace, job.work.cancel)


async def _left(request: Request | None) -> None:
    """Return when the client has gone; the body has been read before."""
    if request is None:
        await asyncio.Event().wait()
        return
    while (await request.receive())["type"] != "http.disconnect":
        pass
