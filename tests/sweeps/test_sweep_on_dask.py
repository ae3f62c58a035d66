"""A real scheduler and two workers on loopback, one of which is killed: the store is that of one process."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from tests.sweeps.stores import files_of

from trundle.analysis.sweep import api
from trundle.analysis.sweep.engine import Engine
from trundle.analysis.sweep.plan import read_plan
from trundle.analysis.sweep.store import Store

pytest.importorskip("heyoka")
pytest.importorskip("distributed")
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore:.*:pytest.PytestUnraisableExceptionWarning")


@contextmanager
def process(*words: str) -> Iterator[subprocess.Popen[str]]:
    command = [sys.executable, "-m", "distributed.cli.dask_" + words[0], *words[1:]]
    paths = os.pathsep.join(path for path in sys.path if path)
    environment = os.environ | {"PYTHONPATH": paths, "DASK_DISTRIBUTED__ADMIN__SYSTEM_MONITOR__INTERVAL": "10s"}
    started = subprocess.Popen(command, stderr=subprocess.PIPE, encoding="utf-8", env=environment)  # noqa: S603
    try:
        yield started
    finally:
        started.kill()
        started.wait()
        if started.stderr is not None:
            started.stderr.close()


def address_of(scheduler: subprocess.Popen[str]) -> str:
    for line in scheduler.stderr or ():
        if found := re.search(r"Scheduler at:\s*(tcp://\S+)", line):
            threading.Thread(target=lambda: [None for _ in scheduler.stderr or ()], daemon=True).start()
            return found[1]
    pytest.fail("the scheduler said no address")


def test_a_worker_that_is_killed_changes_no_bit(tmp_path: Path) -> None:
    over = {"start.position[0]": {"from": 0.05, "to": 0.3, "count": 120}}
    plan = read_plan(
        {
            "scenario": "tilted-turntable",
            "run": {"duration": 30.0, "every": 0.002},
            "over": over,
            "measure": "max hypot(x, y)",
            "chunk": 8,
        }
    )
    with ExitStack() as stack:
        scheduler = stack.enter_context(process("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"))
        address = address_of(scheduler)
        options = ["--no-nanny", "--nthreads", "1", "--no-dashboard", "--host", "127.0.0.1"]
        workers = [stack.enter_context(process("worker", address, *options)) for _ in range(2)]
        for worker in workers:
            threading.Thread(target=lambda stream=worker.stderr: [None for _ in stream], daemon=True).start()
        killed = threading.Event()

        def kill() -> None:
            while not list((tmp_path / "a.zarr").glob("status/c/*")):
                time.sleep(0.02)
            workers[0].send_signal(signal.SIGKILL)
            killed.set()

        threading.Thread(target=kill, daemon=True).start()
        api.run_plan(plan, Engine(scheduler=address), store=tmp_path / "a.zarr")
        assert killed.is_set()
        assert workers[0].wait() == -signal.SIGKILL
    assert Store.open(tmp_path / "a.zarr").counts()["done"] == 120
    api.run_plan(plan, Engine(), store=tmp_path / "b.zarr")
    assert files_of(tmp_path / "a.zarr") == files_of(tmp_path / "b.zarr")
