"""Films that visitors dropped on the page: each a temporary file of the lab's own, kept for a while."""

from __future__ import annotations

import asyncio
import secrets
import shutil
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from ..errors import MissingExtraError
from ..extras import need
from .errors import RefusedError, refusal_of, refused
from .settings import Settings

if TYPE_CHECKING:
    from collections.abc import Iterator

    from starlette.requests import Request

PROGRESS = "progress"  # file beside a film: how much of it has been followed
_SPARE = 2  # times the largest film: room that is left on the disk


@dataclass(eq=False)
class Film:
    """A film that is kept."""

    token: str  # under which its page asks for it, and nobody else can
    name: str  # as the visitor calls it
    path: Path  # of the file, with a name of the server's own
    client: str
    busy: int = 0  # how many work on it
    timer: asyncio.TimerHandle | None = None  # of its life

    @property
    def progress(self) -> float:
        """How much of it has been followed, 0 to 1."""
        with suppress(OSError, ValueError):
            return float(self.path.with_name(PROGRESS).read_text("ascii"))
        return 0.0

    def forget_progress(self) -> None:
        """Begin to follow it anew."""
        self.path.with_name(PROGRESS).unlink(missing_ok=True)


class Films:
    """The films that are kept, for one event loop.

    Parameters
    ----------
    settings : Settings
        The bounds.

    Examples
    --------
    >>> Films(Settings()).find("none")
    Traceback (most recent call last):
    ...
    trundle.lab.errors.RefusedError: The lab does not keep this film any more. Drop it again.
    """

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self._folder: TemporaryDirectory[str] | None = None
        self._kept: dict[str, Film] = {}  # the one longest unused first
        self._followed = 0

    def check(self) -> None:
        """Refuse films where nothing reads them."""
        try:
            need("video", "a film on the page Measure")
        except MissingExtraError as error:
            refusal = refusal_of(error)
            raise RefusedError(refusal) if refusal else error from None

    async def take(self, request: Request, name: str, ending: str) -> Film:
        """Keep the film that a request brings."""
        self.check()
        client = "" if request.client is None else request.client.host
        self._make_room(client)
        if self._folder is None:
            self._folder = TemporaryDirectory(prefix="trundle-lab-films-", ignore_cleanup_errors=True)
        token = secrets.token_urlsafe(12)
        folder = Path(self._folder.name) / token
        film = Film(token, name, folder / f"film{ending}", client, busy=1)
        self._kept[token] = film
        try:
            folder.mkdir(mode=0o700)
            self._check_room(folder)
            with film.path.open("xb") as stream:
                async for part in request.stream():
                    stream.write(part)
        except OSError as error:
            self.remove(film)
            raise refused(503, f"The lab could not keep the film: {error.strerror}.", "file") from None
        except BaseException:
            self.remove(film)
            raise
        film.busy -= 1
        self._live_on(film)
        return film

    def find(self, token: str) -> Film:
        """Return a film by its token, which its page alone knows, and keep it longer."""
        film = self._kept.get(token)
        if film is None:
            raise refused(404, "The lab does not keep this film any more. Drop it again.", "file", "FilmGoneError")
        self._live_on(film)
        return film

    def remove(self, film: Film) -> None:
        """Remove a film, whoever works on it."""
        if film.timer is not None:
            film.timer.cancel()
        self._kept.pop(film.token, None)
        shutil.rmtree(film.path.parent, ignore_errors=True)

    @contextmanager
    def in_use(self, film: Film, *, follow: bool = False) -> Iterator[None]:
        """Let a film not be removed meanwhile; `follow`: for minutes, which not all slow processes may be busy for."""
        if follow and self._followed >= max(1, self.settings.slow_workers - 1):
            message = "The lab follows another film just now. Ask again when that is done."
            raise refused(503, message, kind="BusyError", after=10)
        film.busy += 1
        self._followed += follow
        try:
            yield
        finally:
            film.busy -= 1
            self._followed -= follow
            if film.token in self._kept:
                self._live_on(film)

    def stop(self) -> None:
        """Remove all of them."""
        for film in list(self._kept.values()):
            self.remove(film)
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None

    def _check_room(self, folder: Path) -> None:
        if shutil.disk_usage(folder).free < _SPARE * self.settings.film_bytes:
            message = "The disk of the lab has no room for a film. Make room in its temporary folder."
            raise refused(503, message, "file")

    def _live_on(self, film: Film) -> None:
        """Begin the life of a film anew."""
        if film.timer is not None:
            film.timer.cancel()
        self._kept[film.token] = self._kept.pop(film.token)
        film.timer = asyncio.get_running_loop().call_later(self.settings.film_life, self._expire, film)

    def _expire(self, film: Film) -> None:
        if film.busy:
            self._live_on(film)
        else:
            self.remove(film)

    def _make_room(self, client: str) -> None:
        """Remove what is longest unused: of a visitor beyond the share of one, and of all beyond their number."""
        own = [film for film in self._kept.values() if film.client == client]
        for films, most in ((own, self.settings.films_each), (list(self._kept.values()), self.settings.films)):
            for film in films[: max(0, len(films) - most + 1)]:
                if film.busy:
                    raise refused(503, "The lab works on as many films as it keeps. Try again in a moment.", "file",
                                  "BusyError", after=10)  # fmt: skip
                self.remove(film)


def told(path: Path, share: float) -> None:
    """Note how much of a film has been followed, so that the server reads a whole number.

    Examples
    --------
    >>> told(Path("film.mp4"), 0.25)
    >>> Path("progress").read_text()
    '0.2500'
    """
    note = path.with_name(f"{PROGRESS}.new")
    with suppress(OSError):
        note.write_text(f"{share:.4f}", "ascii")
        note.replace(path.with_name(PROGRESS))
