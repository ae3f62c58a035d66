"""Chunks of members on this processor, on several processes, or on a Dask cluster, with a bounded number under way."""

from __future__ import annotations

import os
import pickle
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from typing import Any, Protocol

from ...errors import InvalidValueError, SolverError
from ...extras import need
from ...processes import own_modules
from ...solve.ensemble import cores
from .job import Columns, Job
from .plan import Plan

Take = Callable[[int, Columns], None]
Next = Callable[[], int | None]  # the next chunk; None where there is none before one of those under way is taken

PATIENCE = "10s"  # for a scheduler to answer
_AHEAD = 4  # chunks under way for each worker
_ASKED_EVERY = 2.0  # s
_ATTEMPTS = 3  # of a chunk whose worker was lost


class Work(Protocol):
    """What is to be done with the chunks: a plan, or a part of one."""

    @property
    def job(self) -> Job:
        """What is done with each member."""

    def values(self, chunk: int, /) -> Any:
        """Return the values of the members of a chunk."""


@dataclass(frozen=True)
class Engine:
    """Where the chunks of a sweep are run."""

    workers: int | None = 1  # processes; 1: this one; None: as many as there are processors
    scheduler: str | None = None  # of Dask: "local" starts one here, else an address; None: no Dask

    def check(self, plan: Plan) -> None:
        """Refuse what cannot be run so, before anything runs."""
        count = self.workers
        if count is not None and (isinstance(count, bool) or not isinstance(count, int) or count < 1):
            raise InvalidValueError("workers", "must be a whole number, 1 or more, or None", count)
        if self.scheduler is not None:
            need("sweep", f"a sweep with the scheduler {self.scheduler!r}")
        elif self.processes > 1:
            for measure in plan.measures:
                if measure.function is not None and not _travels(measure.function):
                    rule = "must be a function of a module where several processes work"
                    remedy = "Put it into a file of its own and import it, or take `workers=1`."
                    raise InvalidValueError(f"measure.{measure.name}", rule, measure.text, remedy)

    @property
    def processes(self) -> int:
        """How many processes work."""
        return self.workers or cores()

    def run(self, work: Work, following: Next, take: Take) -> None:
        """Run chunks of a sweep as long as there is a next one, and hand over each as it is done."""
        if self.scheduler is not None:
            with _client(self.scheduler, self.processes) as client:
                _on_dask(client, work, following, take)
        elif self.processes == 1:
            while (chunk := following()) is not None:
                take(chunk, work.job.run(work.values(chunk)))
        else:
            with own_modules():
                _on_processes(self.processes, work, following, take)


def run_chunk(job: Job, values: Any) -> Columns:
    """Run a chunk wherever it was sent to."""
    return job.run(values)


def _travels(function: Any) -> bool:
    try:
        pickle.dumps(function)
    except (pickle.PicklingError, AttributeError, TypeError):
        return False
    return getattr(function, "__module__", "__main__") != "__main__"


# --- processes --------------------------------------------------------------------------------------------------------


def _on_processes(count: int, work: Work, following: Next, take: Take) -> None:
    attempts: dict[int, int] = {}
    again: list[int] = []  # their worker was lost
    while True:
        pool = _pool(count)
        going: dict[Any, int] = {}
        try:
            while True:
                while len(going) < count * _AHEAD and (chunk := again.pop() if again else following()) is not None:
                    going[pool.submit(run_chunk, work.job, work.values(chunk))] = chunk
                if not going:
                    pool.shutdown()
                    return
                for future in wait(going, timeout=0.2, return_when=FIRST_COMPLETED).done:
                    columns = future.result()
                    take(going.pop(future), columns)
        except BrokenProcessPool:
            pool.shutdown(wait=False, cancel_futures=True)
            for chunk in going.values():
                attempts[chunk] = attempts.get(chunk, 0) + 1
                if attempts[chunk] >= _ATTEMPTS:
                    raise SolverError(
                        f"the process that ran chunk {chunk} was lost {_ATTEMPTS} times: "
                        "is there memory enough? Take fewer `workers`, or smaller chunks (`chunk`)."
                    ) from None
            again += list(going.values())
        except BaseException:
            _stop(pool)
            raise


def _pool(count: int) -> ProcessPoolExecutor:
    import multiprocessing

    return ProcessPoolExecutor(count, mp_context=multiprocessing.get_context("spawn"), initializer=_begin)


def _stop(pool: ProcessPoolExecutor) -> None:
    """End the workers at once: what they are at is lost, and nothing that was taken."""
    processes = list((pool._processes or {}).values())
    for process in processes:
        process.terminate()
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.join(2.0)


def _begin() -> None:
    """Leave Ctrl-C to the parent, and end when it does, however it ended."""
    import multiprocessing
    from multiprocessing.connection import wait as wait_for

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    parent = multiprocessing.parent_process()
    if parent is not None:

        def follow() -> None:
            wait_for([parent.sentinel])
            os._exit(1)

        threading.Thread(target=follow, daemon=True).start()


# --- Dask -------------------------------------------------------------------------------------------------------------


@contextmanager
def _client(scheduler: str, count: int) -> Iterator[Any]:
    from distributed import Client, LocalCluster

    if scheduler == "local":
        options = {"n_workers": count, "threads_per_worker": 1, "dashboard_address": None}
        with own_modules(), LocalCluster(**options) as cluster, Client(cluster) as client:
            yield client
        return
    try:
        client = Client(scheduler, timeout=PATIENCE)
    except (OSError, TimeoutError, ValueError) as error:
        rule = 'must be "local", or the address of a Dask scheduler that answers'
        remedy = "`dask scheduler` prints its own, such as tcp://10.0.0.1:8786."
        raise InvalidValueError("--scheduler", rule, scheduler, f"{remedy} ({type(error).__name__})") from None
    with client:
        yield client


def _on_dask(client: Any, work: Work, following: Next, take: Take) -> None:
    from distributed import KilledWorker, as_completed

    job = client.scatter(work.job, broadcast=True)
    going: dict[str, int] = {}
    done = as_completed(with_results=True, raise_errors=False)

    asked, most = 0.0, 0  # when, and how many chunks may be under way: workers come and go

    def more() -> None:
        nonlocal asked, most
        if time.monotonic() - asked > _ASKED_EVERY:
            asked, most = time.monotonic(), _AHEAD * max(1, sum(client.nthreads().values()))
        if len(going) > most // 2:  # many at once cost the scheduler less
            return
        some = list(islice(iter(following, None), most - len(going)))
        values = [work.values(chunk) for chunk in some]
        futures = client.map(run_chunk, [job] * len(some), values, pure=False, retries=_ATTEMPTS) if some else []
        for chunk, future in zip(some, futures, strict=True):
            going[future.key] = chunk
            done.add(future)

    more()
    for future, columns in done:
        if future.status == "error":
            error = future.exception()
            if isinstance(error, KilledWorker):
                raise SolverError("a chunk lost its worker again and again: is there memory enough?") from None
            raise error
        take(going.pop(future.key), columns)
        more()
