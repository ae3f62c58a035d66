"""What one server keeps while it runs, and how it answers: from the cache, or by a worker."""

from __future__ import annotations

import asyncio
import gzip
from collections.abc import Callable
from functools import partial
from tempfile import TemporaryDirectory
from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from . import answers
from .cache import Answer, Cache, key_of
from .errors import Refusal, RefusedError
from .pool import Lane
from .settings import Settings

_WORDY = ("application/json", "application/toml", "image/svg+xml", "text/csv", "text/html")  # worth compressing


class Lab:
    """What one server keeps while it runs.

    Parameters
    ----------
    settings : Settings
        How it is run.

    Examples
    --------
    See `create_app`.
    """

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.cache = Cache(settings.cache_bytes)
        self.quick = Lane(settings.workers, settings)
        self.slow = Lane(settings.slow_workers, settings, niceness=5)
        self.ready = False  # has a worker answered yet?
        self._coming: dict[str, asyncio.Task[Answer]] = {}

    async def start(self) -> None:
        """Start the workers, and prepare what every page asks for first."""
        await asyncio.to_thread(self.quick.start)
        await asyncio.gather(self.prepare(answers.catalogue), asyncio.to_thread(self.slow.start))

    async def stop(self) -> None:
        """End the workers, whatever they do."""
        await asyncio.gather(*(asyncio.to_thread(lane.stop) for lane in (self.quick, self.slow)))

    async def answer(
        self,
        request: Request,
        lane: Lane,
        function: Callable[..., Answer | Refusal],
        *arguments: Any,
        unkept: tuple[Any, ...] = (),
    ) -> Response:
        """Answer from the cache, or from a worker.

        Parameters
        ----------
        request : Request
            Who asks.
        lane : Lane
            Where it is computed.
        function : callable
            One of `answers` or `exports`.
        *arguments : object
            What JSON can hold, or bytes.
        unkept : tuple
            Further arguments, which the answer does not depend on.

        Returns
        -------
        Response
            With an ETag that stands for what was asked.
        """
        key = key_of(function.__name__, *arguments)
        tag = f'W/"{key}"'
        if tag in (part.strip() for part in request.headers.get("if-none-match", "").split(",")):
            return Response(status_code=304, headers={"etag": tag, "cache-control": "no-cache"})
        found = self.cache.get(key)
        if found is None:
            found = await self._computed(key, request, lane, function, (*arguments, *unkept))
        return _response(found, tag, request)

    async def at_once(self, request: Request, function: Callable[..., Answer | Refusal], *arguments: Any) -> Response:
        """Answer as `answer` does, in a thread of this process: for what only reads a file of the package's own.

        Parameters
        ----------
        request, function, *arguments
            As for `answer`.

        Returns
        -------
        Response
            As of `answer`; it waits for no worker.
        """
        found = await asyncio.to_thread(function, *arguments)
        if isinstance(found, Refusal):
            raise RefusedError(found)
        self.cache.put(key_of(function.__name__, *arguments), found)
        return await self.answer(request, self.quick, function, *arguments)

    async def shared(self, request: Request, function: Callable[..., Answer | Refusal], *arguments: Any) -> Response:
        """Answer as `answer` does, by a computation that all who ask meanwhile wait for, and that none of them ends.

        Parameters
        ----------
        request, function, *arguments
            As for `answer`.

        Returns
        -------
        Response
            As of `answer`.
        """
        key = key_of(function.__name__, *arguments)
        if self.cache.get(key) is None:
            await self.prepare(function, *arguments)
        return await self.answer(request, self.quick, function, *arguments)

    async def prepare(self, function: Callable[..., Answer | Refusal], *arguments: Any) -> None:
        """Compute what will be asked for, once.

        Parameters
        ----------
        function, *arguments
            As for `answer`.
        """
        key = key_of(function.__name__, *arguments)
        if key not in self._coming:
            work = asyncio.create_task(self._computed(key, None, self.quick, function, arguments))
            self._coming[key] = work
            work.add_done_callback(partial(self._came, key))
        await asyncio.wait({self._coming[key]})

    def _came(self, key: str, work: asyncio.Task[Answer]) -> None:
        del self._coming[key]
        if not work.cancelled():
            work.exception()  # who asks next is told

    async def with_folder(
        self, request: Request, function: Callable[..., Answer | Refusal], *arguments: Any
    ) -> Response:
        """Answer as `answer` does, on the slow lane, by a function whose last argument is an empty folder.

        The folder has a name of the server's own and goes with the answer, also where the worker was ended.

        Parameters
        ----------
        request, function, *arguments
            As for `answer`.

        Returns
        -------
        Response
            As of `answer`.
        """
        with TemporaryDirectory(prefix="trundle-lab-", ignore_cleanup_errors=True) as folder:
            return await self.answer(request, self.slow, function, *arguments, unkept=(folder,))

    async def _computed(
        self, key: str, request: Request | None, lane: Lane, function: Callable[..., Answer | Refusal], arguments: Any
    ) -> Answer:
        """Compute, and keep what came out."""
        found = await lane.run(request, function, *arguments)
        self.ready = True
        if isinstance(found, Refusal):
            raise RefusedError(found)
        self.cache.put(key, found)
        return found


def _response(found: Answer, tag: str, request: Request) -> Response:
    headers = {"etag": tag, "cache-control": "no-cache"}
    body = found.body
    if found.filename:
        headers["content-disposition"] = f'attachment; filename="{found.filename}"'
    if found.media_type.partition(";")[0] in _WORDY and len(body) > 1000:
        headers["vary"] = "accept-encoding"
        if "gzip" in request.headers.get("accept-encoding", ""):
            body = gzip.compress(body, 5)
            headers["content-encoding"] = "gzip"
    return Response(body, headers=headers, media_type=found.media_type)
