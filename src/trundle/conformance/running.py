"""Adapters run: each in a process of its own, one task at a time, ended when it is late."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

from .answers import BAD, FAILED, TOO_SLOW, Answer, read_answer
from .case import Case, Input

LIMIT = 60.0  # s for an answer
STARTING = 60.0  # s more for the first one, in which an engine is imported
_MOST_BYTES = 256 * 2**20  # of an answer
_ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS", "RAYON_NUM_THREADS"), "1"
)


class Adapter:
    """A program that answers tasks: lines of JSON to its standard input, lines of JSON from its standard output.

    It is started with the first task, again when it has ended, and killed when it is late. What is wrong with it is
    said in the answer.

    Parameters
    ----------
    command : sequence of str
        The program and its arguments.
    folder : path, optional
        Where it runs; absent: here.
    limit : float
        s for an answer.
    environment : dict, optional
        Variables of it, beside those that are.
    starting : float
        s that the first answer may take more.

    Examples
    --------
    >>> import trundle as tr
    >>> case = tr.conformance.cases()[0]
    >>> with Adapter(["no-such-program"]) as adapter:
    ...     print(adapter.answer(case, dt=1e-2).message)
    no-such-program cannot be started: No such file or directory
    """

    def __init__(
        self,
        command: Sequence[str],
        folder: Path | None = None,
        limit: float = LIMIT,
        environment: dict[str, str] | None = None,
        starting: float = STARTING,
    ) -> None:
        self.command, self.folder, self.limit, self._starting = list(command), folder, limit, starting
        self._environment = os.environ | _ONE_THREAD | (environment or {})
        self._process: subprocess.Popen[bytes] | None = None
        self._complaints: Any = None
        self._number = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.end()

    def answer(
        self, case: Case, dt: float, setting: dict[str, Any] | None = None, derivatives: Sequence[Input] = ()
    ) -> Answer:
        """Give it one task, and return what came of it.

        Parameters
        ----------
        case : Case
            The motion.
        dt : float
            The engine's step, s.
        setting : dict, optional
            What the adapter is to set beside it.
        derivatives : sequence of Input
            By what it is to differentiate the final state.

        Returns
        -------
        Answer
            Whatever happens.
        """
        self._number += 1
        task = json.dumps({"task": self._number, **case.task(dt, setting, derivatives)}).encode() + b"\n"
        running = self._process is not None and self._process.poll() is None
        try:
            line = self._exchange(task, self.limit) if running else b""
            if not line:  # it may have ended after its last answer, unseen
                self.end()
                self._start()
                line = self._exchange(task, self.limit + self._starting)
        except OSError as error:
            self.end()
            return Answer(FAILED, f"{self.command[0]} cannot be started: {error.strerror or error}")
        if not line:
            return self._ended()
        if isinstance(line, Answer):
            self.end()
            return line
        answer = read_answer(line.decode(errors="replace"), case, self._number, derivatives)
        if answer.outcome == BAD:  # it may say more, which would be late for the next task
            self.end()
        return answer

    def end(self) -> None:
        """Kill the process, with those that it has started, if it is still there."""
        process, self._process = self._process, None
        if process is not None:
            _kill(process)
            while self._listener.is_alive():  # it may wait for a place for what it heard
                with contextlib.suppress(queue.Empty):
                    self._heard.get(timeout=0.1)
        for stream in (process.stdin if process else None, self._complaints):
            if stream is not None:
                with contextlib.suppress(OSError):
                    stream.close()

    def _start(self) -> None:
        self._complaints = tempfile.TemporaryFile()  # noqa: SIM115  closed in `end`
        self._process = subprocess.Popen(  # noqa: S603  the user's own command
            self.command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._complaints,
            cwd=self.folder,
            env=self._environment,
            start_new_session=True,
        )
        self._heard: queue.Queue[bytes] = queue.Queue(maxsize=2)
        self._listener = threading.Thread(target=_listen, args=(self._process.stdout, self._heard), daemon=True)
        self._listener.start()

    def _exchange(self, task: bytes, limit: float) -> bytes | Answer:
        """Return the line that answers a task, empty where the program ends; an answer where there is none to come."""
        process = self._process
        assert process is not None and process.stdin is not None  # noqa: PT018, S101
        with contextlib.suppress(OSError):  # it has ended, and will say so
            process.stdin.write(task)
            process.stdin.flush()
        try:
            line = self._heard.get(timeout=limit)
        except queue.Empty:
            return Answer(TOO_SLOW, f"no answer within {self.limit:g} s")
        if len(line) > _MOST_BYTES:
            return Answer(FAILED, f"an answer of more than {_MOST_BYTES // 2**20} MiB")
        return line

    def _ended(self) -> Answer:
        """Return how the process ended."""
        process = self._process
        assert process is not None  # noqa: S101
        code = process.wait()
        self._complaints.seek(0, os.SEEK_END)
        self._complaints.seek(max(0, self._complaints.tell() - 4096))
        lines = self._complaints.read().decode(errors="replace").strip().splitlines()
        self.end()
        how = f"it was killed by signal {-code}" if code < 0 else f"it ended with status {code}"
        return Answer(FAILED, f"no answer: {how}{f' ({lines[-1][:200]})' if lines else ''}")


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End a process with those that it has started."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        if sys.platform != "win32":
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    process.wait()


def _listen(said: IO[bytes], heard: queue.Queue[bytes]) -> None:
    """Hand on what a program says, line by line, and nothing once it has ended."""
    with said:
        while line := said.readline(_MOST_BYTES + 1):
            heard.put(line)
    heard.put(b"")
