"""Connections to the lab: how many there may be, and how long one may keep others waiting for a word."""

from __future__ import annotations

import asyncio
import logging
from contextlib import suppress
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from .errors import Refusal
from .settings import Settings

_log = logging.getLogger("trundle.lab")
_FLUSH = 1.0  # s, in which a last word has to be taken
_READ = 16384  # bytes that count as reading
_LINGERING = 64  # connections that may be taking their last word; beyond, there is none
_REASONS = {408: "Request Timeout", 429: "Too Many Requests", 503: "Service Unavailable"}


class BoundedProtocol(H11Protocol):
    """uvicorn's HTTP, for visitors who may be many, slow, or silent.

    Examples
    --------
    See `bounded`.
    """

    settings: Settings

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._reading: asyncio.TimerHandle | None = None  # runs while a request arrives
        self._phase: Any = None  # which part of it
        self._sending: asyncio.TimerHandle | None = None  # runs while an answer is not taken
        self._ended = False

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Take a connection, or refuse it."""
        super().connection_made(transport)
        refusal = self._too_many()
        if refusal is not None:
            self._end(refusal)
            return
        self._watch()

    def data_received(self, data: bytes) -> None:
        """Read on, while time is left for it."""
        if self._ended or self.transport.is_closing():
            return
        super().data_received(data)
        self._watch(came=True)

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        super().connection_lost(exc)
        for timer in (self._reading, self._sending):
            if timer is not None:
                timer.cancel()

    def pause_writing(self) -> None:
        """Wait for who does not read the answer, but not for ever."""
        super().pause_writing()
        self._expect_reader()

    def resume_writing(self) -> None:
        """Write on: the answer is being read."""
        super().resume_writing()
        if self._sending is not None:
            self._sending.cancel()
            self._sending = None

    def on_response_complete(self) -> None:
        """Wait for the next request; what is written has to be read meanwhile."""
        super().on_response_complete()
        self._expect_reader()
        self._watch()

    @property
    def host(self) -> str:
        """Where the visitor is."""
        return self.client[0] if self.client else ""

    @property
    def _others(self) -> list[BoundedProtocol]:
        """All connections of the server, this one among them."""
        return [one for one in self.connections if isinstance(one, BoundedProtocol)]

    def _too_many(self) -> Refusal | None:
        """Refuse a connection beyond the number that all visitors may have, or one of them."""
        hosts = [one.host for one in self._others if not one._ended]
        host, most, each = self.host, self.settings.connections, self.settings.connections_each
        if hosts.count(host) > each:
            _log.warning("connections of %s are refused: there are %d", host or "one visitor", each)
            message = f"You have {each} connections to the lab, as many as one visitor may. Close some, and ask again."
            return Refusal(429, message, None, "ShareError", (("retry-after", "5"),))
        if len(hosts) > most:
            _log.warning("connections are refused: there are %d", most)
            message = "The lab is busy: too many are connected. Try again in a moment."
            return Refusal(503, message, None, "BusyError", (("retry-after", "5"),))
        return None

    def _watch(self, came: bool = False) -> None:
        """Give each part of a request the time that it may take to arrive, whatever comes in small pieces."""
        state = self.conn.their_state
        phase = state if state in (h11.IDLE, h11.SEND_BODY) else None
        if phase is h11.IDLE and self.cycle is not None and not came:
            phase = None  # between two requests: uvicorn ends what is idle
        if phase is self._phase and phase is not None:
            return
        if self._reading is not None:
            self._reading.cancel()
        self._phase, self._reading = phase, None
        if phase is not None:
            # A body's own time is up before, where the application reads it: that says so in words.
            body = self.settings.body_bounds(self.scope["path"])[1] if phase is h11.SEND_BODY else 0.0
            time = self.settings.head_time if phase is h11.IDLE else body + _FLUSH
            self._reading = self.loop.call_later(time, self._late)

    def _late(self) -> None:
        begun = bool(self.conn.trailing_data[0])
        message = "The request did not arrive in time. Send it again."
        self._end(Refusal(408, message, None, "HTTPError") if begun and self._phase is h11.IDLE else None)

    def _expect_reader(self) -> None:
        if self._sending is None:
            self._sending = self.loop.call_later(self.settings.sending_time, self._look, self._unread)

    def _look(self, before: int) -> None:
        """End a connection of which hardly anything was read since it was looked at last."""
        self._sending = None
        left = self._unread
        if left and before - left < _READ:
            self.transport.abort()
        elif left:
            self._expect_reader()

    @property
    def _unread(self) -> int:
        return self.transport.get_write_buffer_size()

    def _end(self, refusal: Refusal | None) -> None:
        """Close the connection, with a word where one is due and is taken at once."""
        if self._ended or self.transport.is_closing():
            return
        self._ended = True
        if refusal is None or sum(one._ended for one in self._others) > _LINGERING:
            self.transport.abort()
            return
        # Closed before all is read that was sent here, it would be reset, and the word be lost.
        self.transport.write(_written(refusal))
        with suppress(OSError):  # it has gone already
            self.transport.write_eof()
        self.loop.call_later(_FLUSH, self.transport.abort)


def _written(refusal: Refusal) -> bytes:
    """Return a refusal as HTTP, for a connection that no application has seen yet."""
    headers = {
        "content-type": "application/json",
        "content-length": str(len(refusal.body)),
        "connection": "close",
        **dict(refusal.headers),
    }
    lines = [
        f"HTTP/1.1 {refusal.status} {_REASONS[refusal.status]}",
        *(f"{k}: {v}" for k, v in headers.items()),
        "",
        "",
    ]
    return "\r\n".join(lines).encode("ascii") + refusal.body


def bounded(settings: Settings) -> type[H11Protocol]:
    """Return the protocol that uvicorn is to speak under some settings.

    Examples
    --------
    >>> bounded(Settings(head_time=2.0)).settings.head_time
    2.0
    """
    return type("BoundedProtocol", (BoundedProtocol,), {"settings": settings})
