"""Running the lab on this machine: a port that is free, the browser once it answers, and an end that leaves nothing."""

from __future__ import annotations

import ipaddress
import signal
import socket
import threading
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from ..errors import InvalidValueError
from .settings import DEFAULT_PORT, Settings

_BACKLOG = 128  # connections that wait to be taken, and that are taken in one go


def is_loopback(host: str) -> bool:
    """Tell whether only this machine can reach an address.

    Examples
    --------
    >>> is_loopback("127.0.0.1"), is_loopback("localhost"), is_loopback("0.0.0.0")
    (True, True, False)
    """
    if host.lower() == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def listen(host: str, port: int | None) -> socket.socket:
    """Take a port.

    Examples
    --------
    >>> with listen("127.0.0.1", 0) as taken:
    ...     taken.getsockname()[0]
    '127.0.0.1'
    """
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port or 0, type=socket.SOCK_STREAM)[0]
    except (OSError, UnicodeError):
        raise InvalidValueError("--host", "must be an address of this machine", host) from None
    for wanted in (DEFAULT_PORT, 0) if port is None else (port,):
        # Named TCP, or asyncio would not take it for that, and each small answer would wait 40 ms for the one before.
        taken = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
        try:
            taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            taken.bind((address[0], wanted, *address[2:]))
            taken.listen(_BACKLOG)
        except OSError as error:
            taken.close()
            reason = error.strerror or str(error)
        else:
            return taken
    if port is None:
        raise InvalidValueError("--host", "must be an address of this machine", host, f"The system says: {reason}.")
    remedy = f"The system says: {reason}. Leave the port out, and one that is free is found."
    raise InvalidValueError("--port", "must be a port that is free", port, remedy)


def address_of(taken: socket.socket) -> str:
    """Return what to type into a browser on this machine.

    Examples
    --------
    >>> with listen("127.0.0.1", 0) as taken:
    ...     address_of(taken).startswith("http://127.0.0.1:")
    True
    """
    host, port = taken.getsockname()[:2]
    host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)  # noqa: S104  shown, not listened on
    return f"http://{f'[{host}]' if ':' in host else host}:{port}/"


def serve(
    settings: Settings,
    port: int | None,
    *,
    page: str = "",
    open_browser: bool = True,
    told: Callable[[str, int], None] | None = None,
) -> None:
    """Serve the lab until Ctrl-C."""
    from .pool import preload

    with listen(settings.host, port) as taken:
        preload()  # before what follows, which takes a second to import, too
        import uvicorn

        from . import terminal
        from .app import create_app
        from .connections import bounded

        terminal.install()

        class Server(uvicorn.Server):
            @contextmanager
            def capture_signals(self) -> Iterator[None]:
                """End in order at each signal: cut short by a second Ctrl-C, it would leave the workers."""
                before = {number: signal.signal(number, self._ending) for number in (signal.SIGINT, signal.SIGTERM)}
                try:
                    yield
                finally:
                    for number, handler in before.items():
                        signal.signal(number, handler)

            def _ending(self, number: int, frame: Any) -> None:  # noqa: ARG002
                self.should_exit = True

            async def startup(self, sockets: Any = None) -> None:
                await super().startup(sockets)
                if self.started and told is not None:
                    told(address, taken.getsockname()[1])
                if self.started and open_browser:  # some browsers keep their caller
                    threading.Thread(target=webbrowser.open, args=(address + page,), daemon=True).start()

        address = address_of(taken)
        app = create_app(replace(settings, port=taken.getsockname()[1]))
        config = uvicorn.Config(
            app,
            http=bounded(settings),
            backlog=_BACKLOG,
            log_config=None,  # what is told, and how: terminal
            log_level="warning",
            access_log=False,
            server_header=False,
            proxy_headers=False,
            timeout_graceful_shutdown=2,
            timeout_keep_alive=settings.idle_time,  # type: ignore[arg-type]
            ws="none",
        )
        Server(config).run(sockets=[taken])
