"""Connections: a visitor who says nothing, or hardly anything, or never listens, is not waited for."""

from __future__ import annotations

import json
import logging
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from types import SimpleNamespace
from typing import Any

import pytest
import uvicorn

from trundle.lab import terminal
from trundle.lab.connections import bounded
from trundle.lab.settings import Settings
from trundle.lab.terminal import Terse

QUICK = Settings(connections=40, connections_each=4, head_time=0.4, reading_time=0.6, sending_time=0.5, idle_time=1)
SLACK = 8.0  # s, on a busy machine
HEAD = b"GET / HTTP/1.1\r\nHost: localhost\r\n"
LARGE = 40_000_000  # more than the system keeps for who does not read


async def app(scope: Any, receive: Any, send: Any) -> None:
    """Answers at once; /large with more than a socket takes, /forbidden without reading what is sent."""
    if scope["type"] != "http":
        return
    more = scope["path"] != "/forbidden"
    while more:
        more = (await receive()).get("more_body", False)
    body = bytes(LARGE) if scope["path"] == "/large" else b"here"
    headers = [(b"content-length", str(len(body)).encode())]
    await send(
        {"type": "http.response.start", "status": 403 if scope["path"] == "/forbidden" else 200, "headers": headers}
    )
    await send({"type": "http.response.body", "body": body})


@contextmanager
def serving(settings: Settings = QUICK) -> Iterator[int]:
    config = uvicorn.Config(
        app,
        http=bounded(settings),
        log_config=None,
        log_level="warning",
        lifespan="off",
        timeout_keep_alive=settings.idle_time,  # type: ignore[arg-type]
    )
    server = uvicorn.Server(config)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [taken]})
        thread.start()
        port = taken.getsockname()[1]
        try:
            while not server.started:
                time.sleep(0.01)
            yield port
        finally:
            server.should_exit = True
            server.force_exit = True
            thread.join(20)
            assert not thread.is_alive()


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    with serving() as port:
        yield port


def reach(port: int, host: str = "127.0.0.1", room: int | None = None) -> socket.socket:
    visitor = socket.socket()
    visitor.settimeout(10)
    if room is not None:
        visitor.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, room)
    try:
        visitor.bind((host, 0))
        visitor.connect(("127.0.0.1", port))
    except OSError:
        visitor.close()
        pytest.skip(f"this system does not let {host} reach itself")
    return visitor


def heard(visitor: socket.socket) -> bytes:
    """All that comes until the other side ends it."""
    got = b""
    with suppress(ConnectionResetError):
        while part := visitor.recv(65536):
            got += part
    return got


def answered(visitor: socket.socket) -> bool:
    """Whether a short answer comes, and the connection stays."""
    got = b""
    while not got.endswith(b"here"):
        part = visitor.recv(65536)
        assert part
        got += part
    return True


def asked(port: int, host: str = "127.0.0.1") -> bytes:
    with reach(port, host) as visitor:
        visitor.sendall(HEAD + b"Connection: close\r\n\r\n")
        return heard(visitor)


def refusal(answer: bytes) -> tuple[int, dict[str, str], dict[str, Any]]:
    head, _, body = answer.partition(b"\r\n\r\n")
    first, *lines = head.decode().split("\r\n")
    headers = dict(line.lower().split(": ", 1) for line in lines)
    assert int(headers["content-length"]) == len(body)
    return int(first.split()[1]), headers, json.loads(body)["error"]


def test_who_says_nothing_is_not_waited_for(port: int) -> None:
    began = time.monotonic()
    with reach(port) as silent:
        assert b"here" in asked(port)
        assert heard(silent) == b""
    assert QUICK.head_time - 0.1 < time.monotonic() - began < QUICK.head_time + SLACK


@pytest.mark.parametrize("piece", [b"X", b"X-A: b\r\n"])
def test_a_head_in_small_pieces_has_no_more_time_than_another(port: int, piece: bytes) -> None:
    began = time.monotonic()
    with reach(port) as slow:
        slow.sendall(HEAD)
        with suppress(BrokenPipeError, ConnectionResetError):
            while time.monotonic() - began < QUICK.head_time + SLACK:
                slow.sendall(piece)
                slow.settimeout(0.05)
                with suppress(TimeoutError):
                    answer = heard(slow)
                    break
        took = time.monotonic() - began
    assert took < QUICK.head_time + SLACK
    status, headers, error = refusal(answer)
    assert (status, headers["connection"]) == (408, "close")
    assert "did not arrive in time" in error["message"]


def test_a_head_in_pieces_that_comes_in_time_is_answered(port: int) -> None:
    with reach(port) as visitor:
        for part in (HEAD[:5], HEAD[5:], b"Connection: close\r\n", b"\r\n"):
            visitor.sendall(part)
            time.sleep(0.02)
        assert heard(visitor).endswith(b"here")


def test_between_two_requests_a_connection_stays_for_a_while(port: int) -> None:
    with reach(port) as visitor:
        for _ in range(2):
            visitor.sendall(HEAD + b"\r\n")
            assert answered(visitor)
            time.sleep(QUICK.head_time + 0.2)  # longer than a head may take: nothing has begun
        began = time.monotonic()
        assert heard(visitor) == b""
        assert time.monotonic() - began < QUICK.idle_time + SLACK


def test_the_second_head_has_no_more_time_than_the_first(port: int) -> None:
    with reach(port) as visitor:
        visitor.sendall(HEAD + b"\r\n")
        assert answered(visitor)
        visitor.sendall(HEAD[:7])
        began = time.monotonic()
        assert refusal(heard(visitor))[0] == 408
        assert time.monotonic() - began < QUICK.head_time + SLACK


@pytest.mark.parametrize("path", [b"/", b"/forbidden"])
def test_a_body_in_small_pieces_is_not_waited_for(port: int, path: bytes) -> None:
    began = time.monotonic()
    with reach(port) as slow:
        slow.sendall(b"POST " + path + b" HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n")
        with suppress(BrokenPipeError, ConnectionResetError):
            while time.monotonic() - began < 20:
                slow.sendall(b"x")
                time.sleep(0.05)
    assert time.monotonic() - began < QUICK.reading_time + 1.0 + SLACK


def test_who_never_reads_is_not_written_to_for_ever(port: int) -> None:
    began = time.monotonic()
    with reach(port, room=65536) as deaf:
        deaf.sendall(b"GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n")
        time.sleep(QUICK.sending_time + 0.5)
        got = heard(deaf)
    assert 0 < len(got) < LARGE
    assert time.monotonic() - began < QUICK.sending_time + 0.5 + SLACK


def test_who_reads_slowly_gets_it_all(port: int) -> None:
    got = b""
    with reach(port, room=400_000) as slow:
        slow.sendall(b"GET /large HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
        began = time.monotonic()
        while part := slow.recv(400_000):
            got += part
            if time.monotonic() - began < 2 * QUICK.sending_time:
                time.sleep(0.05)
    assert got.endswith(bytes(1000))
    assert len(got) > LARGE


def test_one_visitor_has_only_so_many_connections_and_others_are_answered(port: int) -> None:
    time.sleep(0.1)
    with ExitStack() as held:
        for _ in range(QUICK.connections_each):
            held.enter_context(reach(port))
        status, headers, error = refusal(asked(port))
        if sys.platform == "linux":
            assert b"here" in asked(port, "127.0.0.2")
    assert (status, error["kind"]) == (429, "ShareError")
    assert int(headers["retry-after"]) > 0
    assert f"{QUICK.connections_each} connections" in error["message"]
    time.sleep(0.2)
    assert b"here" in asked(port)


def test_all_together_have_only_so_many() -> None:
    with serving(Settings(connections=6, connections_each=3, head_time=5.0)) as port, ExitStack() as held:
        for i in range(6):
            held.enter_context(reach(port, f"127.0.0.{2 + i // 3}"))
        status, headers, error = refusal(asked(port, "127.0.0.9"))
        assert (status, error["kind"]) == (503, "BusyError")
        assert int(headers["retry-after"]) > 0


def test_a_flood_of_connections_is_a_line_on_the_terminal_not_a_megabyte(capsys: pytest.CaptureFixture[str]) -> None:
    handler = Terse()
    logging.getLogger().addHandler(handler)
    try:
        with serving(Settings(connections=10, connections_each=5, head_time=5.0)) as port, ExitStack() as held:
            for _ in range(300):
                held.enter_context(reach(port)).sendall(b"\x16\x03\x01 no words of HTTP\r\n\r\n")
            # Those who are told why take no place of others while they read it.
            assert b"here" in asked(port, "127.0.0.2" if sys.platform == "linux" else "127.0.0.1")
    finally:
        logging.getLogger().removeHandler(handler)
    said = capsys.readouterr().err
    assert len(said.splitlines()) <= 4
    assert "are refused: there are 5" in said
    assert "Traceback" not in said


def raised(words: str) -> logging.LogRecord:
    try:
        int(f"not a number: {words}")
    except ValueError:
        return logging.LogRecord("lab", logging.ERROR, "lab.py", 1, "a mistake", None, sys.exc_info())


def test_what_goes_wrong_is_told_in_a_line_and_the_same_once_in_a_while(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(terminal, "time", SimpleNamespace(monotonic=lambda: now))
    terse = Terse(seldom=10.0)
    first = terse.line(raised("x" * 100 + "\nmore"))
    assert first is not None
    assert first.startswith("trundle: a mistake: ValueError: invalid literal")
    assert "\n" not in first
    assert len(first) < 400
    assert "test_server_connections.py:" in first
    assert [terse.line(raised(f"{i}")) for i in range(1000)] == [None] * 1000  # whatever its words
    other = logging.LogRecord("lab", logging.ERROR, "lab.py", 2, "another\nTraceback", None, None)
    assert terse.line(other) == "trundle: another"
    now = 111.0
    again = terse.line(raised("y"))
    assert again is not None
    assert again.endswith("(and 1000 more since the last time)")
    assert len(terse._told) == 2
