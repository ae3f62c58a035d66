"""What must not happen in any page: an error on its console, an uncaught exception, a request to anywhere else."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from playwright.sync_api import BrowserContext, ConsoleMessage, Request, WebError

OWN = ("blob:", "data:")


@dataclass
class Watch:
    """Collects what goes wrong in the pages of one test.

    `allow` names what a test provokes on purpose: Chromium itself writes "the server responded with a status of 422"
    on the console when a bad value is refused.
    """

    origins: tuple[str, ...]
    faults: list[str] = field(default_factory=list)
    allowed: list[re.Pattern[str]] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def over(self, context: BrowserContext) -> None:
        context.on("console", self._console)
        context.on("weberror", self._exception)
        context.on("request", self._request)

    def allow(self, pattern: str) -> None:
        self.allowed.append(re.compile(pattern))

    def left(self) -> list[str]:
        return [fault for fault in self.faults if not any(pattern.search(fault) for pattern in self.allowed)]

    def asked_for(self, part: str) -> Iterable[str]:
        return (address for address in self.requests if part in address)

    def _console(self, message: ConsoleMessage) -> None:
        if message.type == "error":
            self.faults.append(f"console: {message.text} ({message.location.get('url', '')})")

    def _exception(self, error: WebError) -> None:
        self.faults.append(f"uncaught: {error.error}")

    def _request(self, request: Request) -> None:
        self.requests.append(request.url)
        if not request.url.startswith((*self.origins, *OWN)):
            self.faults.append(f"request to elsewhere: {request.url}")
