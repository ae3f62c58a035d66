"""Processes that compute: they die, hang and are left alone, and the next who asks is answered."""

from __future__ import annotations

import asyncio
import gc
import logging
import os
import signal
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from tests.lab.working import begun, work, work_for

from trundle.lab import Settings
from trundle.lab.errors import RefusedError
from trundle.lab.lanes import Lanes, LeftError

SMALL = Settings(workers=1, slow_workers=1, wall_time=60.0, quick_time=60.0, grace=0.2, patience=60.0, queue=4)
ALONE = "192.0.2.1"


class Asker:
    """A visitor who goes away when told to."""

    def __init__(self, host: str = ALONE) -> None:
        self.gone = asyncio.Event()
        self.client = SimpleNamespace(host=host)

    async def receive(self) -> dict[str, Any]:
        await self.gone.wait()
        return {"type": "http.disconnect"}


@asynccontextmanager
async def lanes_of(settings: Settings = SMALL) -> AsyncIterator[Lanes]:
    lanes = Lanes(settings)
    try:
        yield lanes
    finally:
        await lanes.stop()


def run(test: Callable[[Lanes], Awaitable[None]], **changed: Any) -> None:
    async def whole() -> None:
        async with lanes_of(replace(SMALL, **changed)) as lanes:
            await lanes.run(None, False, os.getpid)  # the processes are there
            await test(lanes)

    asyncio.run(asyncio.wait_for(whole(), 90))


def quick(lanes: Lanes, function: Callable[..., Any], *arguments: Any, asker: Any = None) -> asyncio.Task[Any]:
    return asyncio.create_task(lanes.run(asker, False, function, *arguments))


async def until(true: Callable[[], bool], seconds: float = 20.0) -> None:
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "it takes too long"
        await asyncio.sleep(0.02)


def gone(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    return False


def test_it_computes_elsewhere() -> None:
    async def test(lanes: Lanes) -> None:
        assert await lanes.run(None, False, os.getpid) != os.getpid()
        assert await lanes.run(None, True, divmod, 7, 2) == (3, 1)

    run(test)


def test_what_a_function_raises_is_raised() -> None:
    async def test(lanes: Lanes) -> None:
        for slow in (False, True):
            with pytest.raises(ZeroDivisionError):
                await lanes.run(None, slow, divmod, 7, 0)

    run(test)


def test_a_crash_is_told_in_one_line_and_survived(caplog: pytest.LogCaptureFixture) -> None:
    async def test(lanes: Lanes) -> None:
        with pytest.raises(RefusedError) as caught:
            await lanes.run(None, False, os._exit, 3)
        assert (caught.value.refusal.status, caught.value.refusal.kind) == (500, "CrashError")
        assert await lanes.run(None, False, divmod, 7, 2) == (3, 1)

    with caplog.at_level(logging.WARNING):
        run(test)
    [record] = caplog.records
    assert record.getMessage() == "a process that computed died (status 3): a fresh one takes its place"
    assert record.exc_info is None


def test_an_idle_process_that_is_killed_is_replaced(caplog: pytest.LogCaptureFixture) -> None:
    async def test(lanes: Lanes) -> None:
        for number in (signal.SIGKILL, signal.SIGTERM):
            pid = await lanes.run(None, False, os.getpid)
            os.kill(pid, number)
            await until(lambda pid=pid: gone(pid))
            assert await lanes.run(None, False, divmod, 7, 2) == (3, 1)

    with caplog.at_level(logging.WARNING):
        run(test)
    assert {record.getMessage().partition(":")[0] for record in caplog.records} <= {
        "a process that waited for work was killed"
    }


def test_a_computation_that_takes_too_long_is_ended(tmp_path: Path) -> None:
    async def test(lanes: Lanes) -> None:
        began = time.monotonic()
        with pytest.raises(RefusedError) as caught:
            await lanes.run(None, False, work, str(tmp_path / "a"), 60)
        assert time.monotonic() - began < 30
        assert (caught.value.refusal.status, caught.value.refusal.kind) == (504, "TimeUpError")
        assert "1 s" in caught.value.refusal.message
        [pid] = begun(tmp_path / "a")
        await until(lambda: gone(pid))
        assert await lanes.run(None, False, divmod, 7, 2) == (3, 1)

    run(test, wall_time=1.0)


def test_a_computation_ends_with_its_asker(tmp_path: Path) -> None:
    async def test(lanes: Lanes) -> None:
        asker = Asker()
        asking = quick(lanes, work, str(tmp_path / "a"), 60, asker=asker)
        await until(lambda: bool(begun(tmp_path / "a")))
        asker.gone.set()
        with pytest.raises(LeftError):
            await asking
        [pid] = begun(tmp_path / "a")
        await until(lambda: gone(pid))  # long before its time is up
        assert await lanes.run(None, False, divmod, 7, 2) == (3, 1)

    run(test)


def test_what_is_almost_done_may_finish_and_keeps_its_process(tmp_path: Path) -> None:
    async def test(lanes: Lanes) -> None:
        asker = Asker()
        asking = quick(lanes, work, str(tmp_path / "a"), 0.2, asker=asker)
        await until(lambda: bool(begun(tmp_path / "a")))
        asker.gone.set()
        with pytest.raises(LeftError):
            await asking
        await asyncio.sleep(2.2)  # past its grace
        assert not gone(begun(tmp_path / "a")[0])
        assert await lanes.run(None, False, divmod, 7, 2) == (3, 1)

    run(test, grace=2.0)


def test_what_waits_is_dropped_without_a_process(tmp_path: Path) -> None:
    async def test(lanes: Lanes) -> None:
        busy = quick(lanes, time.sleep, 0.5)
        await asyncio.sleep(0.1)
        asker = Asker()
        waiting = quick(lanes, os.mkdir, str(tmp_path / "made"), asker=asker)
        await asyncio.sleep(0.05)
        asker.gone.set()
        with pytest.raises(LeftError):
            await waiting
        await busy
        await lanes.run(None, False, os.getpid)
        assert not (tmp_path / "made").exists()

    run(test)


def test_too_many_are_told_that_it_is_busy() -> None:
    async def test(lanes: Lanes) -> None:
        asked = [quick(lanes, time.sleep, 0.05) for _ in range(SMALL.queue)]
        await asyncio.sleep(0)
        with pytest.raises(RefusedError) as caught:
            await lanes.run(None, False, os.getpid)
        assert caught.value.refusal.status == 503
        assert int(dict(caught.value.refusal.headers)["retry-after"]) > 0
        await asyncio.gather(*asked)
        assert await lanes.run(None, False, divmod, 7, 2) == (3, 1)

    run(test)


def test_who_waits_too_long_is_told_that_it_is_busy() -> None:
    async def test(lanes: Lanes) -> None:
        busy = quick(lanes, time.sleep, 1.0)
        await asyncio.sleep(0.05)
        with pytest.raises(RefusedError) as caught:
            await lanes.run(None, False, os.getpid)
        assert (caught.value.refusal.status, caught.value.refusal.kind) == (503, "BusyError")
        assert int(dict(caught.value.refusal.headers)["retry-after"]) > 0
        await busy

    run(test, patience=0.2)


def test_stopping_ends_what_runs_and_tells_who_waits(tmp_path: Path) -> None:
    async def whole() -> None:
        async with lanes_of() as lanes:
            asked = [quick(lanes, work, str(tmp_path / f"{i}"), 60) for i in range(2)]
            await until(lambda: any(begun(tmp_path / f"{i}") for i in range(2)))
            await lanes.stop()
            for one in asked:
                with suppress(RefusedError):
                    await one
                assert one.done()
            await until(lambda: all(gone(pid) for i in range(2) for pid in begun(tmp_path / f"{i}")))

    asyncio.run(asyncio.wait_for(whole(), 90))


def test_who_asks_again_meets_the_process_that_has_traced_the_law() -> None:
    async def test(lanes: Lanes) -> None:
        first = await lanes.run(None, False, os.getpid)
        assert {await lanes.run(None, slow, os.getpid) for slow in (False, True) * 5} == {first}
        busy = quick(lanes, work_for, 0.5)
        await asyncio.sleep(0.1)
        other = await lanes.run(None, True, os.getpid)
        assert other != first
        assert await busy == first
        assert await lanes.run(None, False, os.getpid) == other  # it was given work last

    run(test)


def test_a_process_that_has_to_begin_anew_comes_last() -> None:
    async def test(lanes: Lanes) -> None:
        with pytest.raises(RefusedError):
            await lanes.run(None, False, os._exit, 3)
        one = await lanes.run(None, False, os.getpid)
        assert {await lanes.run(None, False, os.getpid) for _ in range(5)} == {one}

    run(test)


def test_what_a_process_has_loaded_is_never_looked_through_for_garbage() -> None:
    async def test(lanes: Lanes) -> None:
        assert await lanes.run(None, False, gc.get_freeze_count) > 50_000

    run(test)
