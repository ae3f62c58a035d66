"""Who is computed for next: a visitor whose work takes long keeps nobody else from being answered quickly."""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.testclient import TestClient
from tests.lab.conftest import shipped
from tests.lab.test_server_pool import SMALL, Asker, quick, run, until
from tests.lab.working import begun, work

from trundle.lab import Settings, create_app
from trundle.lab.errors import RefusedError
from trundle.lab.lanes import Lanes, LeftError

ONE, OTHER = "192.0.2.1", "192.0.2.2"
ON_LINUX = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="threads stand back on Linux only")
BRISK = {"quick_time": 0.3, "queue": 100}
WAIT = 15.0  # s, for one's own turn and a fresh process on a busy machine; it was half a minute, and a refusal

# --- with processes -------------------------------------------------------------------------------------------


def test_work_that_takes_long_makes_room_and_goes_on_where_it_is(tmp_path: Path) -> None:
    async def test(lanes: Lanes) -> None:
        long = quick(lanes, work, str(tmp_path / "long"), 3.0, "done", asker=Asker(ONE))
        await until(lambda: bool(begun(tmp_path / "long")))
        assert await lanes.run(Asker(OTHER), False, divmod, 7, 2) == (3, 1)  # type: ignore[arg-type]
        assert not long.done()
        assert await long == "done"
        assert len(begun(tmp_path / "long")) == 1, "it was begun anew"

    run(test, **BRISK)


def test_six_that_take_long_keep_nobody_waiting_and_all_are_answered(tmp_path: Path) -> None:
    async def test(lanes: Lanes) -> None:
        six = [quick(lanes, work, str(tmp_path / str(i)), 1.0, i, asker=Asker(ONE)) for i in range(6)]
        for _ in range(5):
            asked = time.monotonic()
            assert await lanes.run(Asker(OTHER), False, divmod, 7, 2) == (3, 1)  # type: ignore[arg-type]
            assert time.monotonic() - asked < WAIT
            await asyncio.sleep(0.2)
        assert await asyncio.gather(*six) == list(range(6))
        assert max(len(begun(tmp_path / str(i))) for i in range(6)) == 2, "none had to make room"

    run(test, **BRISK)


def niceness(pid: int) -> set[int]:
    found = set()
    for task in Path(f"/proc/{pid}/task").iterdir():
        with suppress(FileNotFoundError, ProcessLookupError):  # a thread that ends while it is asked
            found.add(int((task / "stat").read_text().rpartition(")")[2].split()[16]))
    return found


@ON_LINUX
@pytest.mark.parametrize("own", [0, 10, 19])
def test_it_stands_back_from_wherever_the_lab_stands(own: int) -> None:
    """As `nice trundle lab` begins it, too: an absolute niceness would bring it forward there."""
    at = os.getpriority(os.PRIO_PROCESS, 0)
    if own < at:
        pytest.skip(f"these tests stand at {at} themselves")
    script = (
        "import os, time; from trundle.lab.niceness import computed; "
        f"os.nice({own - at}); "
        "print(computed(lambda: (time.sleep(0.5), os.getpriority(os.PRIO_PROCESS, 0))[1], (), 0.1))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)  # noqa: S603
    assert int(done.stdout) == min(own + 5, 19)


@ON_LINUX
def test_what_takes_long_stands_back_and_its_process_comes_forward_again(tmp_path: Path) -> None:
    own = os.getpriority(os.PRIO_PROCESS, 0)  # of the tests, whose processes begin with it
    behind = {own, min(own + 5, 19)}

    async def test(lanes: Lanes) -> None:
        long = quick(lanes, work, str(tmp_path / "long"), 1.5)
        await until(lambda: bool(begun(tmp_path / "long")))
        [pid] = begun(tmp_path / "long")
        assert niceness(pid) == {own}
        await until(lambda: niceness(pid) == behind)
        await long
        await until(lambda: niceness(pid) == {own})  # a thread that is through is there for a moment longer
        known = asyncio.create_task(lanes.run(None, True, work, str(tmp_path / "known"), 1.0))
        await until(lambda: bool(begun(tmp_path / "known")))
        await until(lambda: niceness(begun(tmp_path / "known")[0]) == behind, 0.9)
        await known

    run(test, **BRISK)


# --- in a time of their own: seconds pass at once ---------------------------------------------------------------


class Clock(asyncio.SelectorEventLoop):
    """A loop whose time jumps to whatever comes next."""

    def __init__(self) -> None:
        super().__init__()
        self.now = 0.0

    def time(self) -> float:
        return self.now

    def _run_once(self) -> None:
        if not self._ready and self._scheduled:  # type: ignore[attr-defined]
            self.now = max(self.now, self._scheduled[0].when())  # type: ignore[attr-defined]
        super()._run_once()  # type: ignore[misc]


class Imagined:
    """Processes that only let the time pass: a moment until they are there, and as long as each work says."""

    def __init__(self, fresh: float = 0.0) -> None:
        self.fresh = fresh
        self.at_work = self.most = 0
        self.began: dict[Any, float] = {}  # each work, when it was first begun
        self.begun: Counter[Any] = Counter()  # and how often

    def computation(self, seconds: Any, arguments: tuple[Any, ...], *_: float | None) -> Any:
        told = SimpleNamespace(running=False)

        async def result() -> Any:
            self.at_work += 1
            self.most = max(self.most, self.at_work)
            try:
                await asyncio.sleep(self.fresh)
                told.running = True
                self.began.setdefault(arguments[0], asyncio.get_running_loop().time())
                self.begun[arguments[0]] += 1
                await asyncio.sleep(seconds)
                return arguments[0]
            finally:
                self.at_work -= 1

        told.result = result
        return told

    def start(self) -> None:
        pass

    def stop(self) -> None:
        pass


def imagine(test: Callable[[Lanes], Coroutine[Any, Any, Any]], fresh: float = 0.0, **changed: Any) -> Any:
    """Run a test with imagined processes, in imagined time."""
    loop = Clock()
    lanes = Lanes(replace(SMALL, **{**BRISK, **changed}))
    lanes.processes = Imagined(fresh)  # type: ignore[assignment]
    try:
        return loop.run_until_complete(test(lanes))
    finally:
        loop.run_until_complete(loop.shutdown_default_executor())
        loop.close()


def test_a_visitor_is_held_to_a_share_and_others_are_not() -> None:
    async def test(lanes: Lanes) -> None:
        loop = asyncio.get_running_loop()
        askers = [Asker(ONE) for _ in range(5)]
        asked = [quick(lanes, 1.0, i, asker=asker) for i, asker in enumerate(askers)]
        await asyncio.sleep(0.01)
        with pytest.raises(RefusedError) as caught:
            await lanes.run(Asker(ONE), False, 1.0, 5)  # type: ignore[arg-type]
        refusal = caught.value.refusal
        assert (refusal.status, refusal.kind) == (429, "ShareError")
        assert "You wait for 5 answers" in refusal.message
        assert int(dict(refusal.headers)["retry-after"]) > 0
        began = loop.time()
        assert await lanes.run(Asker(OTHER), False, 0.1, "other") == "other"  # type: ignore[arg-type]
        assert loop.time() - began < 0.5
        askers[0].gone.set()  # who goes away makes room for what the same visitor asks next
        await asyncio.sleep(0.01)
        assert await lanes.run(Asker(ONE), False, 0.1, "again") == "again"  # type: ignore[arg-type]
        done = await asyncio.gather(*asked, return_exceptions=True)
        assert [type(one) for one in done[:1]] == [LeftError]
        assert done[1:] == [1, 2, 3, 4]

    imagine(test, share=5)


def test_turns_go_round_and_the_newest_of_a_visitor_comes_first() -> None:
    order: list[str] = []

    async def ask(lanes: Lanes, host: str, name: str) -> None:
        order.append(await lanes.run(Asker(host), False, 0.2, name))  # type: ignore[arg-type]

    async def test(lanes: Lanes) -> None:
        asked = [asyncio.create_task(ask(lanes, ONE, f"one {i}")) for i in range(4)]
        await asyncio.sleep(0.01)
        asked += [asyncio.create_task(ask(lanes, OTHER, f"other {i}")) for i in range(2)]
        await asyncio.gather(*asked)

    imagine(test)
    assert order == ["one 0", "other 1", "one 3", "other 0", "one 2", "one 1"]


@pytest.mark.parametrize(("exposed", "soon"), [(True, True), (False, False)])
def test_on_a_network_nobody_has_all_the_slow_places(exposed: bool, soon: bool) -> None:
    async def test(lanes: Lanes) -> float:
        loop = asyncio.get_running_loop()
        several = [asyncio.create_task(lanes.run(Asker(ONE), True, 10.0, i)) for i in range(3)]  # type: ignore[arg-type]
        await asyncio.sleep(0.01)
        assert await lanes.run(Asker(OTHER), True, 1.0, "card") == "card"  # type: ignore[arg-type]
        took = loop.time()
        assert await asyncio.gather(*several) == [0, 1, 2]
        return took

    assert (imagine(test, slow_workers=2, exposed=exposed) < 2.0) == soon


def test_who_waits_for_a_fresh_process_has_not_had_its_time() -> None:
    """On a busy machine a process that was ended takes long to be replaced: who comes next must not pay for that."""

    async def test(lanes: Lanes) -> float:
        long = [quick(lanes, 30.0, i, asker=Asker(ONE)) for i in range(2)]
        await asyncio.sleep(1.4)  # one of them has gone on in the slow lane, the other waits for a fresh process
        first = quick(lanes, 0.1, "first", asker=Asker(OTHER))
        await asyncio.sleep(0.5)
        second = quick(lanes, 0.1, "second", asker=Asker("192.0.2.3"))
        assert await asyncio.gather(first, second) == ["first", "second"]
        took = asyncio.get_running_loop().time()
        await asyncio.gather(*long)
        return took

    assert imagine(test, fresh=1.0, patience=1000.0) < 6.0


def test_who_had_to_make_room_waits_with_patience_of_its_own() -> None:
    async def test(lanes: Lanes) -> None:
        slow = [asyncio.create_task(lanes.run(Asker(ONE), True, 15.0, i)) for i in range(2)]  # type: ignore[arg-type]
        long = quick(lanes, 15.0, "long", asker=Asker(ONE))
        await asyncio.sleep(1.0)
        assert await lanes.run(Asker(OTHER), False, 0.1, "short") == "short"  # type: ignore[arg-type]
        with pytest.raises(RefusedError) as caught:
            await long
        assert caught.value.refusal.status == 503
        assert asyncio.get_running_loop().time() == pytest.approx(6.0, abs=0.2)
        await asyncio.gather(*slow, return_exceptions=True)

    imagine(test, patience=5.0)


@dataclass(frozen=True)
class Visit:
    host: str
    at: float
    slow: bool
    takes: float
    stays: float


VISITS = st.lists(
    st.builds(
        Visit,
        st.sampled_from([ONE, OTHER, "192.0.2.3"]),
        st.floats(0, 6),
        st.booleans(),
        st.one_of(st.floats(0.01, 0.2), st.floats(0.2, 8)),
        st.one_of(st.just(1e9), st.floats(0, 5)),
    ),
    max_size=14,
)


def look(lanes: Lanes) -> None:
    """Hold the lanes to what they promise at every moment."""
    for lane, most in lanes._places.items():
        running = lanes._running(lane)
        assert len(running) <= most
        if lane and lanes.settings.exposed:
            assert max(Counter(job.client for job in running).values(), default=0) <= max(1, most - 1)
        elif any(job.work is None and job.slow == lane for job in lanes._jobs):
            assert len(running) == most, "somebody waits before a free place"


@given(VISITS, st.integers(1, 3), st.integers(1, 3), st.booleans(), st.sampled_from([0.0, 0.1, 0.25, 1.0]))
def test_whoever_comes_whenever_the_bounds_are_kept(
    visits: list[Visit], quick: int, slow: int, exposed: bool, fresh: float
) -> None:
    async def visit(lanes: Lanes, number: int, one: Visit) -> str:
        processes, each = lanes.processes, lanes.settings.quick_time
        await asyncio.sleep(one.at)
        asker, alone = Asker(one.host), all(job.client != one.host for job in lanes._jobs)
        asyncio.get_running_loop().call_later(one.stays, asker.gone.set)
        try:
            assert await lanes.run(asker, one.slow, one.takes, number) == number  # type: ignore[arg-type]
        except LeftError:
            return "left"
        finally:
            look(lanes)
        if alone and not one.slow:  # before it are what runs, and the turns of two others
            assert processes.began[number] - one.at <= 3 * (1.2 * each + fresh) + fresh + 0.1  # type: ignore[attr-defined]
        if one.slow or one.takes < each:
            assert processes.begun[number] == 1, "it had to make room before its time was up"  # type: ignore[attr-defined]
        return "answered"

    async def test(lanes: Lanes) -> None:
        ends = await asyncio.gather(*(visit(lanes, i, one) for i, one in enumerate(visits)))
        assert set(ends) <= {"answered", "left"}
        await asyncio.sleep(lanes.settings.grace + 0.1)
        assert (lanes._jobs, lanes._served) == ([], {})
        assert lanes.processes.at_work == 0  # type: ignore[attr-defined]
        assert lanes.processes.most <= quick + slow  # type: ignore[attr-defined]

    imagine(test, fresh, workers=quick, slow_workers=slow, exposed=exposed, patience=1000.0)


# --- as HTTP --------------------------------------------------------------------------------------------------


def test_a_flood_is_told_so_in_the_form_of_the_lab_and_another_visitor_is_answered() -> None:
    slow = shipped("rattleback")
    slow["run"] = {"duration": "3600 s", "every": "20 ms", "method": "runge-kutta"}  # six seconds, compiled
    settings = Settings(workers=1, slow_workers=1, share=2, wall_time=2.0, quick_time=0.3)
    app = create_app(settings)
    told: list[Any] = []
    with TestClient(app, base_url="http://127.0.0.1", client=(ONE, 1)) as lab:
        other = TestClient(app, base_url="http://127.0.0.1", client=(OTHER, 1))
        other.portal = lab.portal
        assert other.post("/api/simulate", json={"scenario": shipped("tilted-turntable")}).status_code == 200

        def flood(i: int) -> None:
            told.append(lab.post("/api/simulate", json={"scenario": {**slow, "title": f"{i}"}}))

        threads = [threading.Thread(target=flood, args=(i,)) for i in range(5)]
        for thread in threads:
            thread.start()
        time.sleep(0.5)
        asked = time.monotonic()
        scenario = {**shipped("tilted-turntable"), "title": "another"}
        answer = other.post("/api/simulate", json={"scenario": scenario, "samples": 10})
        assert answer.status_code == 200
        assert time.monotonic() - asked < WAIT
        for thread in threads:
            thread.join()
    statuses = Counter(one.status_code for one in told)
    assert statuses == {429: 3, 504: 2}
    refused = next(one for one in told if one.status_code == 429)
    assert refused.json()["error"]["kind"] == "ShareError"
    assert int(refused.headers["retry-after"]) > 0


def test_files_are_held_in_memory_a_few_at_a_time() -> None:
    from trundle.lab.security import Guard

    reading = asyncio.Event()

    async def app(scope: Any, receive: Any, send: Any) -> None:  # noqa: ARG001
        await reading.wait()
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": b""})

    guard = Guard(app, Settings(uploads=3, uploads_each=2))

    async def upload(host: str, path: str = "/api/open") -> tuple[int, dict[bytes, bytes], bytes]:
        sent: list[Any] = []
        scope = {
            "type": "http",
            "method": "POST",
            "path": path,
            "client": (host, 1),
            "headers": [(b"host", b"localhost")],
        }

        async def send(message: Any) -> None:
            sent.append(message)

        await guard(scope, lambda: asyncio.sleep(3600), send)
        return sent[0]["status"], dict(sent[0]["headers"]), sent[1]["body"]

    async def test() -> None:
        held = [asyncio.create_task(upload(host)) for host in (ONE, ONE, OTHER)]
        await asyncio.sleep(0)
        for host, status in ((ONE, 429), (OTHER, 503)):
            got, headers, body = await upload(host)
            assert got == status
            assert int(headers[b"retry-after"]) > 0
            assert "message" in json.loads(body)["error"]
        other = asyncio.create_task(upload(ONE, "/api/simulate"))  # which holds no file
        reading.set()
        assert [status for status, *_ in await asyncio.gather(*held, other)] == [200] * 4
        assert (await upload(ONE))[0] == 200
        assert not guard._uploads

    asyncio.run(test())
