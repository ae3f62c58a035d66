"""What stands before every route: who is asked for, who asks, how much they may send, and what a page may load."""

from __future__ import annotations

import asyncio
import ipaddress
import re
import socket
from collections import Counter
from collections.abc import Awaitable, Callable, MutableMapping, Sequence
from typing import Any
from urllib.parse import urlsplit

from starlette.exceptions import HTTPException

from ..errors import InvalidValueError
from .errors import Refusal, RefusedError, refused
from .settings import UPLOADS, Settings

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]

LOOPBACK_NAMES = ("127.0.0.1", "localhost", "::1")

# No inline script, no inline style, nothing from elsewhere. Pictures and films that the page itself makes are blobs.
CONTENT_SECURITY_POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' blob: data:",
        "media-src 'self' blob:",
        "font-src 'self'",
        "connect-src 'self'",
        "worker-src 'self'",
        "manifest-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
    )
)

HEADERS = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), microphone=(), geolocation=()",
}
_EMBEDDER = re.compile(r"(https?://)?[a-z0-9-]+(\.[a-z0-9-]+)*(:\d{1,5})?", re.IGNORECASE)


def policy(embed_from: Sequence[str] = ()) -> str:
    """Return what a page of the lab may load, and which pages of others may hold it.

    Examples
    --------
    >>> policy(("moodle.example.org",)).rpartition("; ")[2], policy().rpartition("; ")[2]
    ('frame-ancestors moodle.example.org', "frame-ancestors 'none'")
    """
    return f"{CONTENT_SECURITY_POLICY}; frame-ancestors {' '.join(embed_from) or repr('none')}"


def check_embedder(host: str) -> None:
    """Refuse what is no host that pages come from.

    Examples
    --------
    >>> check_embedder("https://moodle.example.org")
    >>> check_embedder("*")
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `--embed-from` must be a host; got '*'. Write for instance moodle.example.org...
    """
    if not _EMBEDDER.fullmatch(host):
        remedy = "Write for instance moodle.example.org or https://moodle.example.org; name each host by itself."
        raise InvalidValueError("--embed-from", "must be a host", host, remedy)


class Guard:
    """The outermost layer of the application.

    Parameters
    ----------
    app : ASGI application
        What it stands before.
    settings : Settings
        Which hosts, and how much.

    Examples
    --------
    See `trundle.lab.app.create_app`.
    """

    def __init__(self, app: Any, settings: Settings) -> None:
        self.app, self.settings = app, settings
        headers = {"content-security-policy": policy(settings.embed_from), **HEADERS}
        self._headers = [(name.encode(), value.encode()) for name, value in headers.items()]
        self._uploads: Counter[str] = Counter()  # files that are being sent or read, by who sent them

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] != "http":
            if scope["type"] == "websocket":  # the lab has none
                await send({"type": "websocket.close", "code": 1008})
                return
            await self.app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        sent = _with_headers(send, self._headers)
        try:
            check_host(headers.get("host", ""), self.settings)
            if scope["method"] not in ("GET", "HEAD", "OPTIONS"):
                check_origin(headers, scope.get("scheme", "http"))
            uploads = scope["path"] in UPLOADS
            most, seconds = self.settings.body_bounds(scope["path"])
            check_length(headers.get("content-length"), most)
            client = (scope.get("client") or ("",))[0]
            if uploads:
                self._check_uploads(client)
        except RefusedError as error:
            await refuse(error.refusal, sent)
            return
        bounded = _bounded(receive, most, seconds)
        if not uploads:
            await self.app(scope, bounded, sent)
            return
        self._uploads[client] += 1
        try:
            await self.app(scope, bounded, sent)
        finally:
            self._uploads[client] -= 1
            self._uploads += Counter()  # forgets those that have none

    def _check_uploads(self, client: str) -> None:
        """Refuse a file beyond those that are held in memory at once, and that one visitor may send at once."""
        each, all_ = self.settings.uploads_each, self.settings.uploads
        if self._uploads[client] >= each:
            message = (
                f"You open {each} files already, as many at once as one visitor may. Wait for them, and ask again."
            )
            raise refused(429, message, kind="ShareError", after=2)
        if self._uploads.total() >= all_:
            raise refused(
                503, "The lab is busy: too many files are opened. Try again in a moment.", kind="BusyError", after=5
            )


def check_host(host: str, settings: Settings) -> None:
    """Refuse a request for another host: a page elsewhere may have had its name point here.

    Examples
    --------
    >>> check_host("localhost:8765", Settings(port=8765))
    >>> check_host("evil.example:8765", Settings(port=8765))
    Traceback (most recent call last):
    ...
    trundle.lab.errors.RefusedError: This server answers for 127.0.0.1, localhost and ::1 only, ...
    """
    name, port = _split(host)
    known = {*LOOPBACK_NAMES, settings.host.lower()}
    if settings.exposed:  # an address cannot be made to point elsewhere, as a name can
        known.add(socket.gethostname().lower())
    right_name = name in known or (settings.exposed and _is_address(name))
    if right_name and (settings.port is None or port == settings.port):
        return
    names = "its own addresses and name" if settings.exposed else "127.0.0.1, localhost and ::1"
    where = "" if settings.port is None else f", on port {settings.port}"
    raise refused(421, f"This server answers for {names} only{where}. Take the address that `trundle lab` printed.")


def check_origin(headers: dict[str, str], scheme: str) -> None:
    """Refuse what a page of another origin sends.

    Examples
    --------
    >>> check_origin({"host": "localhost:8765", "origin": "http://localhost:8765"}, "http")
    >>> check_origin({"host": "localhost:8765", "origin": "https://evil.example"}, "http")
    Traceback (most recent call last):
    ...
    trundle.lab.errors.RefusedError: Only the lab's own page may send this. Open it in a tab of its own.
    """
    origin = headers.get("origin")
    foreign = origin is not None and origin.lower() != f"{scheme}://{headers.get('host', '')}".lower()
    if foreign or headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none"):
        raise refused(403, "Only the lab's own page may send this. Open it in a tab of its own.")


def check_length(length: str | None, most: int) -> None:
    """Refuse a body that says itself that it is too long.

    Examples
    --------
    >>> check_length("10", 10)
    """
    if length is not None and length.isdecimal() and int(length[:20]) > most:
        raise _too_long(most)


async def refuse(refusal: Refusal, send: Send) -> None:
    """Send a refusal.

    Examples
    --------
    See `Guard`.
    """
    body = refusal.body
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]
    headers += [(name.encode(), value.encode()) for name, value in refusal.headers]
    if refusal.status in (413, 429, 503):  # the rest of the body is not read
        headers.append((b"connection", b"close"))
    await send({"type": "http.response.start", "status": refusal.status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def _split(host: str) -> tuple[str, int | None]:
    try:
        parts = urlsplit(f"//{host}")
        name, port = parts.hostname or "", parts.port
    except ValueError:
        return "", None
    plain = not (parts.path or parts.query or parts.fragment or parts.username is not None)
    return (name.lower(), 80 if port is None else port) if plain else ("", None)


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _too_long(most: int) -> RefusedError:
    size = f"{most / 2**20:g} MiB" if most >= 2**20 else f"{most / 2**10:g} KiB"
    return refused(413, f"The request is longer than the {size} that are read. Send less.")


def _with_headers(send: Send, headers: list[tuple[bytes, bytes]]) -> Send:
    async def sent(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            there = {name.lower() for name, _ in message.get("headers", [])}
            added = [(name, value) for name, value in headers if name not in there]
            message = {**message, "headers": [*message.get("headers", []), *added]}
        await send(message)

    return sent


def _bounded(receive: Receive, most: int, seconds: float) -> Receive:
    """Return a `receive` that stops reading a body that is too long or too slow."""
    read, complete = 0, False
    until = asyncio.get_running_loop().time() + seconds

    async def received() -> MutableMapping[str, Any]:
        nonlocal read, complete
        if complete:
            return await receive()
        try:
            async with asyncio.timeout_at(until):
                message = await receive()
        except TimeoutError:
            raise HTTPException(408, "The request did not arrive in time. Send it again.") from None
        read += len(message.get("body", b""))
        complete = not message.get("more_body", False)
        if read > most:
            raise HTTPException(413, str(_too_long(most)))
        return message

    return received
