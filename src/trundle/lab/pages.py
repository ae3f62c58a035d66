"""The built front end: the page, its scripts, styles and fonts."""

from __future__ import annotations

import gzip
import os
from collections.abc import MutableMapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from fastapi import FastAPI
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.staticfiles import StaticFiles

from .settings import Settings

PAGE = "lab.html"
_FOR_EVER = "public, max-age=31536000, immutable"  # the name of such a file holds a digest of its content
_WORDY = (".js", ".css", ".html", ".svg", ".json", ".txt")  # worth packing
_NOT_BUILT = (
    "The lab's page has not been built into this copy of trundle. In a checkout, `make demo` or `pip install .` builds "
    "it. The API answers at /api/scenarios.\n"
)


class Bundle(StaticFiles):
    """Files of the front end: those whose name changes with their content may be kept for ever."""

    def file_response(
        self,
        full_path: str | os.PathLike[str],
        stat_result: os.stat_result,
        scope: MutableMapping[str, Any],
        status_code: int = 200,
    ) -> Response:
        """Return a file with the time that a browser may keep it; text packed, where the browser takes that."""
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers["cache-control"] = _FOR_EVER if "/assets/" in scope["path"] else "no-cache"
        if Path(full_path).suffix not in _WORDY or not isinstance(response, FileResponse):
            return response
        response.headers["vary"] = "accept-encoding"
        asked = {name: value for name, value in scope["headers"] if name in (b"accept-encoding", b"range")}
        if b"gzip" not in asked.get(b"accept-encoding", b"") or b"range" in asked:
            return response
        packed = _packed(os.fspath(full_path), stat_result.st_mtime_ns)
        kept = {name: response.headers[name] for name in ("cache-control", "etag", "last-modified", "vary")}
        return Response(packed, status_code, {**kept, "content-encoding": "gzip"}, response.media_type)


@lru_cache(maxsize=64)
def _packed(path: str, changed: int) -> bytes:  # noqa: ARG001  of another file the same name may be
    """Pack a file once: while it packs, nobody is answered."""
    return gzip.compress(Path(path).read_bytes())


def add_routes(app: FastAPI, settings: Settings) -> None:
    """Serve the front end, or say that it has not been built.

    Examples
    --------
    See `trundle.lab.app.create_app`.
    """
    page = settings.static / PAGE

    @app.get("/", include_in_schema=False)
    async def front() -> Response:
        if not page.is_file():
            return PlainTextResponse(_NOT_BUILT, status_code=503)
        return FileResponse(page, headers={"cache-control": "no-cache"})

    files = Bundle(directory=settings.static, check_dir=False)
    app.mount("/", files, name="static")
