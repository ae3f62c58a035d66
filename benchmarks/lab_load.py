"""A class at the lab: two hundred clients for a minute, each changing a number and looking at what came of it."""

from __future__ import annotations

import asyncio
import json
import math
import os
import random
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from measure import BrokenBenchmarkError, Row, check, seconds

CLIENTS, DURATION, SETTLING = 200, 60.0, 15.0  # s; in the settling time everybody arrives, and nothing is counted
THINK = (3.0, 7.0)  # s between an answer and the next change
AGAIN = 0.25  # of the requests are for what others have asked for already
SLOWEST, GROWTH = 0.25, 1.15  # s for 95 of 100; memory after over memory before

TITLE = (
    f"The lab: {CLIENTS} clients for {DURATION:g} s, who look for {THINK[0]:g} to {THINK[1]:g} s between two changes"
)

# Closed forms, each with the numbers that a client drags: path of the key, unit, from, to.
SCENARIOS: dict[str, list[tuple[str, str, float, float]]] = {
    "level-turntable-nudged": [("support.motion.rate", "rpm", 10, 60), ("body.radius", "mm", 10, 40)],
    "tilted-turntable": [("support.tilt", "deg", 0.1, 5), ("support.motion.rate", "rpm", 20, 45)],
    "hollow-ball-turntable": [("support.motion.rate", "rpm", 10, 60)],
    "ball-in-a-trough": [("start.position.0", "deg", -40, 40)],
    "ball-under-force": [("body.radius", "mm", 10, 80)],
    "level-turntable-corotating": [("support.motion.rate", "rpm", 5, 40)],
}


@dataclass
class Seen:
    """What all clients saw together."""

    counting: bool = False
    computed: list[float] = field(default_factory=list)
    again: list[float] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    received: int = 0


def rows() -> Iterator[Row]:
    """Run the class, and say how it went."""
    with served() as (process, port):
        seen, before, after, used = asyncio.run(_class(process, port))
    every = sorted(seen.computed + seen.again)
    check(len(every) > CLIENTS, "the clients must have been answered")
    rate = (
        f"{len(every)} answers, {len(every) / DURATION:.0f} a second, {seen.received / DURATION / 1e6:.0f} MB a second"
    )
    yield Row("failures", len(seen.failures), most=0, raw="; ".join(seen.failures[:3]) or rate, kind="count")
    computed, again = sorted(seen.computed), sorted(seen.again)
    yield Row("computed, 95 of 100 within", _share(computed, 0.95), most=SLOWEST, raw=_times(computed), kind="time")
    yield Row("computed, half within", _share(computed, 0.5), raw=f"{len(computed)} of them", kind="time")
    yield Row("from the cache, half within", _share(again, 0.5), raw=_times(again), kind="time")
    busy = f"of the server's processes together: {used / DURATION:.2f} processors, on average"
    yield Row("processor time for one answer", used / len(every), raw=busy, kind="time")
    sizes = f"{before / 2**20:.0f} MiB, {after / 2**20:.0f} MiB (all processes, shared pages once)"
    yield Row("memory after / before", after / before, most=GROWTH, raw=sizes)


def _share(times: list[float], share: float) -> float:
    return times[min(len(times) - 1, math.ceil(share * len(times)) - 1)] if times else math.nan


def _times(times: list[float]) -> str:
    return f"half {seconds(_share(times, 0.5))}, 99 of 100 {seconds(_share(times, 0.99))}, slowest {seconds(times[-1])}"


@contextmanager
def served() -> Iterator[tuple[subprocess.Popen[str], int]]:
    """A lab as a user runs it, in a session of its own."""
    words = [sys.executable, "-m", "trundle", "lab", "--no-open", "--port", "0"]
    env = {**os.environ, "PYTHONUNBUFFERED": "1"}
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, start_new_session=True, env=env)  # noqa: S603
    try:
        found = re.search(r"http://[\d.]+:(\d+)/", process.stdout.readline() if process.stdout else "")
        if found is None:
            raise BrokenBenchmarkError("the lab did not start")
        yield process, int(found[1])
        process.send_signal(signal.SIGINT)
        check(process.wait(20) == 0, "the lab must end cleanly")
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


async def _class(process: subprocess.Popen[str], port: int) -> tuple[Seen, float, float, float]:
    tables = {name: json.loads(await ask(port, f"/api/scenarios/{name}"))["scenario"] for name in SCENARIOS}
    await ask(port, "/api/scenarios")
    known = [changed(tables, random.Random(number)) for number in range(20)]  # noqa: S311
    seen = Seen()
    clients = [asyncio.create_task(client(port, tables, known, seen, number)) for number in range(CLIENTS)]
    await asyncio.sleep(SETTLING)
    before, used, seen.counting = memory(process.pid), processor(process.pid), True
    await asyncio.sleep(DURATION)
    after, used, seen.counting = memory(process.pid), processor(process.pid) - used, False
    for task in clients:
        task.cancel()
    await asyncio.gather(*clients, return_exceptions=True)
    return seen, before, after, used


async def client(port: int, tables: dict[str, Any], known: list[bytes], seen: Seen, number: int) -> None:
    """Ask, look, and ask again, over one connection that is kept."""
    chance = random.Random(1000 + number)  # noqa: S311
    await asyncio.sleep(chance.uniform(0, SETTLING * 0.6))
    connection = None
    while True:
        again = chance.random() < AGAIN
        body = chance.choice(known) if again else changed(tables, chance)
        began, counted = time.perf_counter(), seen.counting
        try:
            connection = connection or await asyncio.open_connection("127.0.0.1", port)
            content = await exchange(*connection, port, "/api/simulate", body)
            check(content.startswith(b"TRUNDLE1"), "an answer is no scene")
        except (OSError, EOFError, ValueError, BrokenBenchmarkError) as error:
            connection = None
            if counted:
                seen.failures.append(f"{type(error).__name__}: {error}")
        else:
            if counted:
                (seen.again if again else seen.computed).append(time.perf_counter() - began)
                seen.received += len(content)
        await asyncio.sleep(chance.uniform(*THINK))


def changed(tables: dict[str, Any], chance: random.Random) -> bytes:
    """Return a request for one of the scenarios, one of its numbers dragged elsewhere."""
    name = chance.choice(list(SCENARIOS))
    scenario = json.loads(json.dumps(tables[name]))
    path, unit, low, high = chance.choice(SCENARIOS[name])
    *above, last = path.split(".")
    part = scenario
    for key in above:
        part = part[key]
    part[int(last) if last.isdigit() else last] = f"{chance.uniform(low, high):.4f} {unit}"
    return json.dumps({"scenario": scenario, "samples": 2000}).encode()


async def ask(port: int, path: str, body: bytes | None = None) -> bytes:
    """Ask once, over a connection of its own."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        return await exchange(reader, writer, port, path, body)
    finally:
        writer.close()


async def exchange(
    reader: asyncio.StreamReader, writer: asyncio.StreamWriter, port: int, path: str, body: bytes | None
) -> bytes:
    """Send a request and read its answer; the least HTTP that will do: clients must cost little."""
    head = f"{'GET' if body is None else 'POST'} {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n"
    head += f"Content-Type: application/json\r\nContent-Length: {len(body or b'')}\r\n\r\n"
    writer.write(head.encode() + (body or b""))
    await writer.drain()
    answered = (await reader.readuntil(b"\r\n\r\n")).decode()
    status = int(answered.split(" ", 2)[1])
    length = int(re.search(r"content-length: (\d+)", answered, re.IGNORECASE)[1])  # type: ignore[index]
    content = await reader.readexactly(length)
    check(status == 200, f"status {status}: {content[:200]!r}")
    return content


def memory(session: int) -> float:
    """Return the memory of all processes of a session, bytes; what they share counts once."""
    total = 0
    for entry, _ in processes(session):
        with suppress(OSError):
            found = re.search(r"^Pss:\s+(\d+)", (entry / "smaps_rollup").read_text(), re.MULTILINE)
            total += 1024 * int(found[1]) if found else 0
    return float(total)


def processor(session: int) -> float:
    """Return the processor time that all processes of a session, and those they waited for, have taken so far, s."""
    ticks = sum(sum(map(int, facts[11:15])) for _, facts in processes(session))
    return ticks / os.sysconf("SC_CLK_TCK")


def processes(session: int) -> Iterator[tuple[Path, list[str]]]:
    """The processes of a session, each with what /proc says in its `stat` behind the name."""
    for entry in Path("/proc").iterdir():
        with suppress(OSError, ValueError, IndexError):
            facts = (entry / "stat").read_text().rpartition(")")[2].split()
            if int(facts[3]) == session:
                yield entry, facts
