"""What one server keeps while it runs, and how it answers: from the cache, or by a worker."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from tempfile import TemporaryDirectory
from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from . import answers
from .cache import Answer, Cache, key_of, packed
from .errors import Refusal, RefusedError
from .films import Films
from .lanes import Lanes
from .settings import Settings


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
        self.lanes = Lanes(settings)
        self.films = Films(settings)
        self.ready = False  # has a worker answered yet?
        self._coming: dict[str, asyncio.Task[Answer]] = {}

    async def start(self) -> None:
        """Start the workers, and prepare what every page asks for first."""
        first = self.prepare(answers.parts, here=True)
        await asyncio.gather(first, asyncio.to_thread(self.lanes.processes.start))
        await self.prepare(answers.catalogue)

    async def stop(self) -> None:
        """End the workers, whatever they do, and remove what was kept for them."""
        await self.lanes.stop()
        self.films.stop()

    async def answer(
        self,
        request: Request,
        function: Callable[..., Answer | Refusal],
        *arguments: Any,
        slow: bool = False,
        unkept: tuple[Any, ...] = (),
        most: float | None = None,
    ) -> Response:
        """Answer from the cache, or from a worker; `most`: seconds that this may take, other than usual."""
        key = key_of(function.__name__, *arguments)
        tag = _tag(key)
        if tag in (part.strip() for part in request.headers.get("if-none-match", "").split(",")):
            return Response(status_code=304, headers={"etag": tag, "cache-control": "no-cache"})
        found = self.cache.get(key)
        if found is None:
            found = await self._computed(key, request, slow, function, (*arguments, *unkept), most)
        return await self._response(key, found, request)

    async def at_once(self, request: Request, function: Callable[..., Answer | Refusal], *arguments: Any) -> Response:
        """Answer as `answer` does, in a thread of this process: for what only reads a file of the package's own."""
        await self._here(key_of(function.__name__, *arguments), function, arguments)
        return await self.answer(request, function, *arguments)

    async def shared(
        self, request: Request, function: Callable[..., Answer | Refusal], *arguments: Any, here: bool = False
    ) -> Response:
        """Answer as `answer` does, by a computation that all who ask meanwhile wait for, and that none of them ends."""
        key = key_of(function.__name__, *arguments)
        if self.cache.get(key) is None:
            await self.prepare(function, *arguments, here=here)
        return await self.answer(request, function, *arguments)

    async def prepare(self, function: Callable[..., Answer | Refusal], *arguments: Any, here: bool = False) -> None:
        """Compute what will be asked for, once; `here`: in a thread of this process, without waiting for a worker."""
        key = key_of(function.__name__, *arguments)
        if key not in self._coming:
            computing = self._here(key, function, arguments) if here else None
            work = asyncio.create_task(computing or self._computed(key, None, False, function, arguments))
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
        """Answer as `answer` does, in the slow lane, by a function whose last argument is an empty folder.

        The folder has a name of the server's own and goes with the answer, also where the worker was ended.
        """
        with TemporaryDirectory(prefix="trundle-lab-", ignore_cleanup_errors=True) as folder:
            return await self.answer(request, function, *arguments, slow=True, unkept=(folder,))

    async def _computed(
        self,
        key: str,
        request: Request | None,
        slow: bool,
        function: Callable[..., Answer | Refusal],
        arguments: Any,
        most: float | None = None,
    ) -> Answer:
        """Compute, and keep what came out."""
        found = await self.lanes.run(request, slow, packed, function, *arguments, most=most)
        self.ready = True
        if isinstance(found, Refusal):
            raise RefusedError(found)
        self.cache.put(key, found)
        return found

    async def _here(self, key: str, function: Callable[..., Answer | Refusal], arguments: Any) -> Answer:
        """Compute in a thread, and keep what came out."""
        found = await asyncio.to_thread(packed, function, *arguments)
        if isinstance(found, Refusal):
            raise RefusedError(found)
        self.cache.put(key, found)
        return found

    async def _response(self, key: str, found: Answer, request: Request) -> Response:
        """Return an answer as HTTP, unpacked where the client asks for that."""
        headers = {"etag": _tag(key), "cache-control": "no-cache"}
        body = found.body
        if found.filename:
            headers["content-disposition"] = f'attachment; filename="{found.filename}"'
        if found.packed:
            headers["vary"] = "accept-encoding"
            if "gzip" in request.headers.get("accept-encoding", ""):
                headers["content-encoding"] = "gzip"
            else:
                body = await asyncio.to_thread(lambda: found.plain)
        return Response(body, headers=headers, media_type=found.media_type)


def _tag(key: str) -> str:
    return f'W/"{key}"'
