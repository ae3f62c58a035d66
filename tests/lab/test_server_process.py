"""`trundle lab` as a user runs it: it says where it is, answers, and leaves nothing behind."""

from __future__ import annotations

import asyncio
import base64
import http.client
import json
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
import zlib
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from tests.lab.conftest import shipped

from trundle.lab.serving import listen
from trundle.scenario import files

pytestmark = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks at processes as Linux shows them")


@dataclass
class Running:
    """A lab in processes of its own session."""

    process: subprocess.Popen[str]
    port: int
    said: str

    def family(self) -> set[int]:
        """Every process of the session that is not dead."""
        found = set()
        for entry in Path("/proc").iterdir():
            with suppress(OSError, ValueError, IndexError):
                after = (entry / "stat").read_text().rpartition(")")[2].split()
                if int(after[3]) == self.process.pid and after[0] not in "ZX":
                    found.add(int(entry.name))
        return found

    def workers(self) -> set[int]:
        """Those of them that compute: copies of a process that is itself the server's child."""
        parents = {
            pid: int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1]) for pid in self.family()
        }
        return {pid for pid, parent in parents.items() if parent in parents and parent != self.process.pid}

    def ask(self, path: str, asked: Any = None) -> tuple[int, bytes]:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        try:
            body = None if asked is None else json.dumps(asked)
            connection.request("GET" if asked is None else "POST", path, body, {"content-type": "application/json"})
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def gone(self, seconds: float) -> bool:
        return within(seconds, lambda: not self.family())


def within(seconds: float, true: Callable[[], bool]) -> bool:
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if true():
            return True
        time.sleep(0.05)
    return False


@contextmanager
def running(*words: str, env: dict[str, str] | None = None, folder: Path | None = None) -> Iterator[Running]:
    process = subprocess.Popen(  # noqa: S603
        [Path(sys.executable).with_name("trundle"), "lab", *words],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1", **(env or {})},
    )
    try:
        said = ""
        while "The lab is at" not in said:
            line = process.stdout.readline()  # type: ignore[union-attr]
            if not line:
                raise AssertionError(f"it ended: {said}")
            said += line
        yield Running(process, int(re.findall(r"http://127\.0\.0\.1:(\d+)/", said)[0]), said)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_answers_and_ends_with_all_its_processes(number: signal.Signals) -> None:
    with running("--no-open", "--port", "0") as lab:
        assert lab.ask("/api/scenarios/tilted-turntable")[0] == 200
        assert lab.ask("/api/simulate", {"scenario": shipped("tilted-turntable")})[1].startswith(b"TRUNDLE1")
        assert len(lab.family()) > 3
        os.killpg(lab.process.pid, number)  # as a terminal does
        told, _ = lab.process.communicate(timeout=60)
        assert lab.gone(20)
        assert lab.process.returncode == 0
        assert told.endswith("The lab has ended.\n")


def test_files_of_the_folder_that_one_is_in_are_not_taken_for_pythons_own(tmp_path: Path) -> None:
    for name in ("random", "signal", "struct", "numpy", "statistics", "nt"):
        (tmp_path / f"{name}.py").write_text(f"raise RuntimeError('{name} of the homework')\n")
    with running("--no-open", "--port", "0", folder=tmp_path) as lab:
        assert lab.ask("/api/simulate", {"scenario": shipped("tilted-turntable")})[1].startswith(b"TRUNDLE1")
        os.killpg(lab.process.pid, signal.SIGINT)
        told, _ = lab.process.communicate(timeout=60)
    assert "homework" not in lab.said + told
    assert "Traceback" not in lab.said + told


def test_ctrl_c_at_once_and_again_ends_it_too() -> None:
    with running("--no-open", "--port", "0") as lab:
        for _ in range(3):
            os.killpg(lab.process.pid, signal.SIGINT)
            time.sleep(0.05)
        told, _ = lab.process.communicate(timeout=60)
        assert "Traceback" not in told
        assert lab.gone(20)


def test_killed_outright_it_leaves_no_process() -> None:
    with running("--no-open", "--port", "0") as lab:
        assert lab.ask("/api/simulate", {"scenario": shipped("tilted-turntable")})[0] == 200
        lab.process.kill()
        assert lab.gone(30)


def test_a_long_computation_ends_when_its_client_goes() -> None:
    long = shipped("rattleback")
    long["run"] |= {"duration": "3600 s", "every": "0.02 s", "method": "runge-kutta"}
    with running("--no-open", "--port", "0") as lab:
        lab.ask("/api/simulate", {"scenario": shipped("tilted-turntable")})
        lab.ask("/api/card", {"scenario": shipped("roll-x-then-y")})  # both lanes are there
        before = lab.family()
        with socket.create_connection(("127.0.0.1", lab.port)) as asker:
            body = json.dumps({"scenario": long}).encode()
            head = f"POST /api/simulate HTTP/1.1\r\nHost: 127.0.0.1:{lab.port}\r\nContent-Type: application/json\r\n"
            asker.sendall(f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body)
            time.sleep(0.7)
            assert before <= lab.family()
        assert within(20, lambda: not before <= lab.family())  # its grace, then it is killed
        assert lab.ask("/api/simulate", {"scenario": shipped("tilted-turntable")})[0] == 200


def long_runs(count: int) -> list[dict[str, Any]]:
    """Scenarios that each take longer than the lab allows."""
    scenario = shipped("rattleback")
    run = {"every": "20 ms", "method": "runge-kutta"}
    return [{**scenario, "run": {**run, "duration": f"{3600 - i} s"}} for i in range(count)]


@contextmanager
def asking(lab: Running, scenarios: list[dict[str, Any]]) -> Iterator[list[tuple[int, bytes]]]:
    """Ask for all of them at once; what is answered is in the list in the end."""
    told: list[tuple[int, bytes]] = []

    def ask(scenario: dict[str, Any]) -> None:
        with suppress(OSError, http.client.HTTPException):  # the lab has ended
            told.append(lab.ask("/api/simulate", {"scenario": scenario}))

    threads = [threading.Thread(target=ask, args=(scenario,)) for scenario in scenarios]
    for thread in threads:
        thread.start()
    try:
        yield told
    finally:
        for thread in threads:
            thread.join(60)


def test_six_that_take_long_keep_nobody_waiting_and_ctrl_c_ends_them_too() -> None:
    with running("--no-open", "--port", "0") as lab:
        quick = shipped("tilted-turntable")
        assert lab.ask("/api/simulate", {"scenario": quick})[0] == 200
        with asking(lab, long_runs(6)):
            for i in range(4):
                time.sleep(0.5)
                asked = time.monotonic()
                assert lab.ask("/api/simulate", {"scenario": {**quick, "title": f"{i}"}, "samples": 50})[0] == 200
                assert time.monotonic() - asked < 15.0  # on a busy machine; it was half a minute, and a refusal
            os.killpg(lab.process.pid, signal.SIGINT)
            told, _ = lab.process.communicate(timeout=60)
        assert lab.gone(20)
        assert "Traceback" not in told
        assert len(told.splitlines()) < 6


def test_a_worker_that_is_killed_is_one_line_on_the_terminal() -> None:
    with running("--no-open", "--port", "0") as lab:
        assert lab.ask("/api/simulate", {"scenario": shipped("tilted-turntable")})[0] == 200
        with asking(lab, long_runs(1)) as answers:
            time.sleep(0.7)
            for pid in lab.workers():
                os.kill(pid, signal.SIGKILL)
        [(status, body)] = answers
        assert (status, json.loads(body)["error"]["kind"]) == (500, "CrashError")
        assert lab.ask("/api/simulate", {"scenario": {**shipped("tilted-turntable"), "title": "again"}})[0] == 200
        os.killpg(lab.process.pid, signal.SIGINT)
        told, _ = lab.process.communicate(timeout=60)
        assert lab.gone(20)
    assert [line for line in told.splitlines() if "died" in line] == [
        "trundle: a process that computed died (SIGKILL): a fresh one takes its place"
    ]
    assert len(told.splitlines()) <= 3


def test_visitors_who_say_nothing_keep_nobody_out_and_do_not_fill_the_terminal() -> None:
    with running("--no-open", "--port", "0") as lab, ExitStack() as held:
        for _ in range(100):
            silent = held.enter_context(socket.socket())
            if sys.platform == "linux":
                silent.bind(("127.0.0.2", 0))
            silent.connect(("127.0.0.1", lab.port))
        if sys.platform == "linux":
            assert lab.ask("/api/scenarios/tilted-turntable")[0] == 200
        os.killpg(lab.process.pid, signal.SIGINT)
        told, _ = lab.process.communicate(timeout=60)
        assert lab.gone(20)
    assert "are refused: there are 64" in told
    assert len(told.splitlines()) <= 3


def test_the_browser_is_opened_once_it_answers(tmp_path: Path) -> None:
    seen = tmp_path / "seen"
    browser = tmp_path / "browser"
    browser.write_text(
        f"#!{sys.executable}\nimport sys, urllib.request\n"
        "try: status = urllib.request.urlopen(sys.argv[1] + 'api/scenarios/tilted-turntable').status\n"
        "except OSError as error: status = error\n"
        f"open({str(seen)!r}, 'w').write(f'{{sys.argv[1]}} {{status}}')\n"
    )
    browser.chmod(0o700)
    with running("--port", "0", env={"BROWSER": f"{browser} %s"}) as lab:
        assert within(20, lambda: seen.exists() and seen.read_text().endswith(" 200"))
        assert seen.read_text() == f"http://127.0.0.1:{lab.port}/ 200"


def test_a_small_answer_does_not_wait_for_the_last_to_be_received() -> None:
    """Nagle's delay and that of acknowledgements make 40 ms together; asyncio ends it only where it knows TCP."""

    async def at_once() -> int:
        told = asyncio.get_running_loop().create_future()

        def came(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            told.set_result(writer.get_extra_info("socket").getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
            writer.close()

        async with await asyncio.start_server(came, sock=listen("127.0.0.1", 0)) as server:
            _, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
            writer.close()
            return await told

    assert asyncio.run(at_once()) != 0


def test_where_the_usual_port_is_taken_another_is_found() -> None:
    with socket.socket() as taken:
        with suppress(OSError):  # taken by whoever
            taken.bind(("127.0.0.1", 8765))
            taken.listen()
        with running("--no-open") as lab:
            assert lab.port != 8765
            assert "port 8765 is taken" in lab.said
            assert lab.ask("/api/scenarios/tilted-turntable")[0] == 200


def test_it_opens_a_scenario_of_ones_own(tmp_path: Path) -> None:
    mine = tmp_path / "my table.toml"
    text = files.read("tilted-turntable").replace('radius = "25 mm"', 'diameter = "40 mm"')
    mine.write_text(text, encoding="utf-8")
    with running(str(mine), "--no-open", "--port", "0") as lab:
        told = lab.process.stdout.readline()  # type: ignore[union-attr]
        assert told.startswith(f"{mine} is at http://127.0.0.1:{lab.port}/#/bench?s=")
        code = told.strip().partition("?s=")[2]
        scenario = json.loads(zlib.decompress(base64.urlsafe_b64decode(code + "=" * (-len(code) % 4)), -15))
        assert scenario["body"]["radius"] == "20 mm"
        assert scenario["title"] == "Steel ball on a tilted turntable"
        assert lab.ask("/api/simulate", {"scenario": scenario})[1].startswith(b"TRUNDLE1")


def test_a_scenario_that_is_none_is_refused_before_it_listens(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(
        files.read("tilted-turntable").replace("25 mm", "-25 mm").replace("510 g", "0 g"), encoding="utf-8"
    )
    for given, said in ((str(wrong), ("`body.radius`", "`body.mass`")), ("tilted-turntabel", ("Did you mean",))):
        done = subprocess.run(  # noqa: S603
            [sys.executable, "-m", "trundle", "lab", given], capture_output=True, text=True, timeout=60, check=False
        )
        assert (done.returncode, done.stdout) == (2, "")
        assert all(word in done.stderr for word in said)
        assert done.stderr.count("\n") == len(said)


def test_what_cannot_be_is_one_line_and_status_2() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        for words, said in (
            (("--port", str(taken.getsockname()[1])), "must be a port that is free"),
            (("--host", "0.0.0.0"), "add --network"),  # noqa: S104  refused
            (("--host", "203.0.113.7", "--network"), "must be an address of this machine"),
            (("--host", "no such host"), "must be an address of this machine"),
        ):
            done = subprocess.run(  # noqa: S603
                [sys.executable, "-m", "trundle", "lab", "--no-open", *words],
                capture_output=True,
                text=True,
                timeout=60,
                check=False,
            )
            assert done.returncode == 2
            assert said in done.stderr
            assert "Traceback" not in done.stderr


def test_help_loads_no_server() -> None:
    script = "import sys; from trundle.cli import run; run(['--help']); print(sorted(sys.modules), file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=True)  # noqa: S603
    assert "lab" in done.stdout
    for heavy in ("fastapi", "uvicorn", "starlette", "pebble", "pydantic", "numpy"):
        assert f"'{heavy}'" not in done.stderr


def test_the_server_itself_loads_nothing_that_computes_or_draws() -> None:
    """That is for the workers."""
    script = "import sys, trundle.lab.app; print(sorted(sys.modules))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=True)  # noqa: S603
    assert "'fastapi'" in done.stdout
    for heavy in ("numpy", "scipy", "matplotlib", "pygltflib", "xarray", "PIL", "sympy", "trundle.views.scene"):
        assert f"'{heavy}'" not in done.stdout
