"""Processes that compute: they die, hang and are left alone, and the next who asks is answered."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import replace
from typing import Any

import pytest

from trundle.lab import Settings
from trundle.lab.errors import RefusedError
from trundle.lab.pool import Lane, LeftError

QUICK = Settings(workers=1, slow_workers=1, wall_time=60.0, grace=0.2, patience=60.0, queue=4)


class Asker:
    """A client that goes away when told to."""

    def __init__(self) -> None:
        self.gone = asyncio.Event()

    async def receive(self) -> dict[str, Any]:
        await self.gone.wait()
        return {"type": "http.disconnect"}


@asynccontextmanager
async def lane_of(settings: Settings = QUICK) -> AsyncIterator[Lane]:
    lane = Lane(settings.workers, settings)
    try:
        yield lane
    finally:
        await asyncio.to_thread(lane.stop)


def run(test: Callable[[Lane], Awaitable[None]], **changed: float) -> None:
    async def whole() -> None:
        async with lane_of(replace(QUICK, **changed)) as lane:
            await lane.run(None, os.getpid)  # the process is there
            await test(lane)

    asyncio.run(asyncio.wait_for(whole(), 90))


def ends(pid: int, seconds: float = 20.0) -> bool:
    """Whether a process is gone, or goes within a time."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.02)
    return False


def test_it_computes_elsewhere() -> None:
    async def test(lane: Lane) -> None:
        assert await lane.run(None, os.getpid) != os.getpid()
        assert await lane.run(None, divmod, 7, 2) == (3, 1)

    run(test)


def test_a_crash_is_told_and_survived() -> None:
    async def test(lane: Lane) -> None:
        with pytest.raises(RefusedError) as caught:
            await lane.run(None, os._exit, 3)
        assert (caught.value.refusal.status, caught.value.refusal.kind) == (500, "CrashError")
        assert await lane.run(None, divmod, 7, 2) == (3, 1)

    run(test)


def test_an_idle_process_that_is_killed_is_replaced() -> None:
    async def test(lane: Lane) -> None:
        for number in (signal.SIGKILL, signal.SIGTERM):
            pid = await lane.run(None, os.getpid)
            os.kill(pid, number)
            assert await asyncio.to_thread(ends, pid)
            assert await lane.run(None, divmod, 7, 2) == (3, 1)

    run(test)


def test_a_computation_that_takes_too_long_is_ended() -> None:
    async def test(lane: Lane) -> None:
        pid = await lane.run(None, os.getpid)
        began = time.monotonic()
        with pytest.raises(RefusedError) as caught:
            await lane.run(None, time.sleep, 60)
        assert time.monotonic() - began < 30
        assert (caught.value.refusal.status, caught.value.refusal.kind) == (504, "TimeUpError")
        assert "1 s" in caught.value.refusal.message
        assert await asyncio.to_thread(ends, pid)
        assert await lane.run(None, divmod, 7, 2) == (3, 1)

    run(test, wall_time=1.0)


def test_a_computation_ends_with_its_asker() -> None:
    async def test(lane: Lane) -> None:
        pid, asker = await lane.run(None, os.getpid), Asker()
        asking = asyncio.create_task(lane.run(asker, time.sleep, 60))  # type: ignore[arg-type]
        await asyncio.sleep(0.1)
        asker.gone.set()
        with pytest.raises(LeftError):
            await asking
        assert await asyncio.to_thread(ends, pid)  # long before its time is up
        assert await lane.run(None, divmod, 7, 2) == (3, 1)

    run(test)


def test_what_is_almost_done_may_finish_and_keeps_its_process() -> None:
    async def test(lane: Lane) -> None:
        pid, asker = await lane.run(None, os.getpid), Asker()
        asking = asyncio.create_task(lane.run(asker, time.sleep, 0.2))  # type: ignore[arg-type]
        await asyncio.sleep(0.05)
        asker.gone.set()
        with pytest.raises(LeftError):
            await asking
        assert await lane.run(None, os.getpid) == pid
        await asyncio.sleep(2.2)  # past its grace
        assert await lane.run(None, os.getpid) == pid

    run(test, grace=2.0)


def test_what_waits_is_dropped_without_a_process(tmp_path: Any) -> None:
    async def test(lane: Lane) -> None:
        busy = asyncio.create_task(lane.run(None, time.sleep, 0.5))
        await asyncio.sleep(0.1)
        asker = Asker()
        waiting = asyncio.create_task(lane.run(asker, os.mkdir, str(tmp_path / "made")))  # type: ignore[arg-type]
        await asyncio.sleep(0.05)
        asker.gone.set()
        with pytest.raises(LeftError):
            await waiting
        await busy
        await lane.run(None, os.getpid)
        assert not (tmp_path / "made").exists()

    run(test)


def test_too_many_are_told_that_it_is_busy() -> None:
    async def test(lane: Lane) -> None:
        asked = [asyncio.create_task(lane.run(None, time.sleep, 0.05)) for _ in range(QUICK.queue)]
        await asyncio.sleep(0)
        with pytest.raises(RefusedError) as caught:
            await lane.run(None, os.getpid)
        assert caught.value.refusal.status == 503
        await asyncio.gather(*asked)
        assert await lane.run(None, divmod, 7, 2) == (3, 1)

    run(test)


def test_who_waits_too_long_is_told_that_it_is_busy() -> None:
    async def whole() -> None:
        settings = Settings(workers=1, slow_workers=1, patience=0.2)
        async with lane_of(settings) as lane:
            busy = asyncio.create_task(lane.run(None, time.sleep, 1.0))
            await asyncio.sleep(0.05)
            with pytest.raises(RefusedError) as caught:
                await lane.run(None, os.getpid)
            assert (caught.value.refusal.status, caught.value.refusal.kind) == (503, "BusyError")
            await busy

    asyncio.run(asyncio.wait_for(whole(), 90))


def test_stopping_ends_what_runs() -> None:
    async def whole() -> None:
        async with lane_of() as lane:
            pid = await lane.run(None, os.getpid)
            busy = asyncio.create_task(lane.run(None, time.sleep, 60))
            await asyncio.sleep(0.2)
            await asyncio.to_thread(lane.stop)
            assert ends(pid)
            busy.cancel()
            with suppress(asyncio.CancelledError, Exception):
                await busy

    asyncio.run(asyncio.wait_for(whole(), 90))
