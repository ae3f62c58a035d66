"""The built front end: the page, its scripts, styles and fonts."""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import Any

from fastapi import FastAPI
from starlette.middleware.gzip import GZipMiddleware
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.staticfiles import StaticFiles

from .settings import Settings

PAGE = "lab.html"
_FOR_EVER = "public, max-age=31536000, immutable"  # the name of such a file holds a digest of its content
_NOT_BUILT = (
    "The lab's page has not been built into this copy of trundle. In a checkout, `make demo` or `pip install .` builds "
    "it. The API answers at /api/scenarios.\n"
)


class Bundle(StaticFiles):
    """Files of the front end: those whose name changes with their content may be kept for ever."""

    def file_response(self, *arguments: Any, **named: Any) -> Response:
        """Return a file with the time that a browser may keep it."""
        response = super().file_response(*arguments, **named)
        scope: MutableMapping[str, Any] = arguments[2] if len(arguments) > 2 else named["scope"]
        response.headers["cache-control"] = _FOR_EVER if "/assets/" in scope["path"] else "no-cache"
        return response


def add_routes(app: FastAPI, settings: Settings) -> None:
    """Serve the front end, or say that it has not been built.

    Parameters
    ----------
    app : FastAPI
        It has its other routes already: this one takes what is left.
    settings : Settings
        Where the files are.

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
    app.mount("/", GZipMiddleware(files, minimum_size=1000, compresslevel=5), name="static")
