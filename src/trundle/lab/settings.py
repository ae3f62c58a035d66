"""How a lab is run: where it listens, and what it allows a visitor to ask of the machine."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

DEFAULT_PORT = 8765
FILMS = "/api/film"
UPLOADS = ("/api/open", "/api/track", FILMS)  # these take files
_MIB = 2**20


def _processors() -> int:
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(1, min(available, 8))


def _connections() -> int:
    """Return how many connections a server may have: a part of the files that the system lets a process open."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        files, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
        if files != resource.RLIM_INFINITY:
            return max(16, min(512, files // 2 - 64))
    return 512


@dataclass(frozen=True)
class Settings:
    """What `create_app` is told.

    Parameters
    ----------
    host : str
        The address that the server listens on.
    port : int, optional
        The port that a Host header must name; absent: any.
    exposed : bool
        Whether others on the network may come: they then reach it by the machine's address or name.
    embed_from : tuple of str
        Hosts whose pages may hold the lab in a frame.
    workers, slow_workers : int
        Processes that answer what takes milliseconds, and what takes seconds.
    quick_time : float
        How long a computation may keep others from being answered quickly, s: then it goes on in the slow lane.
    wall_time : float
        The most that one computation may take, s.
    patience : float
        The most that a request waits for a free process, s.
    grace : float
        How long a computation goes on whose asker has gone, s: to end a process costs more than a few milliseconds.
    queue, share : int
        How many requests may wait or be computed at once: of all visitors together, and of one.
    uploads, uploads_each : int
        How many files may be sent and read at once: by all visitors together, and by one.
    connections, connections_each : int
        How many connections may be open: of all visitors together, and of one.
    head_time, reading_time : float
        The most that the head of a request may take to arrive, and its body, s.
    film_bytes : int
        The most that a film may have.
    films, films_each : int
        How many films are kept at once: of all visitors together, and of one. For a new one the longest unused goes.
    film_reading_time : float
        The most that a film may take to arrive, s.
    film_life : float
        How long a film is kept that nobody asks for, s.
    film_time : float
        The most that a ball is followed through a film, s.
    fit_time : float
        The most that a fit may take, s: a first one has its equations to compile.
    sending_time : float
        How long an answer may wait to be read on, s.
    idle_time : float
        How long a connection stays open between two requests, s.
    cache_bytes, body_bytes, upload_bytes : int
        The most that the cache holds; of a request; of a file that is opened.
    static : pathlib.Path
        The built front end.

    Examples
    --------
    >>> Settings().host
    '127.0.0.1'
    """

    host: str = "127.0.0.1"
    port: int | None = None
    exposed: bool = False
    embed_from: tuple[str, ...] = ()
    workers: int = field(default_factory=_processors)
    slow_workers: int = 2
    quick_time: float = 1.0
    wall_time: float = 20.0
    patience: float = 30.0
    grace: float = 1.0
    queue: int = 512
    share: int = 32
    uploads: int = 8
    uploads_each: int = 2
    connections: int = field(default_factory=_connections)
    connections_each: int = 64
    head_time: float = 10.0
    reading_time: float = 15.0
    sending_time: float = 30.0
    idle_time: float = 60.0
    cache_bytes: int = 64 * _MIB
    body_bytes: int = _MIB // 2
    upload_bytes: int = 32 * _MIB
    film_bytes: int = 256 * _MIB
    films: int = 8
    films_each: int = 2
    film_reading_time: float = 120.0
    film_life: float = 1800.0
    film_time: float = 240.0
    fit_time: float = 60.0
    static: Path = Path(__file__).resolve().parent.parent / "views" / "viewer" / "static"

    def body_bounds(self, path: str) -> tuple[int, float]:
        """Return how long the body of a request to some address may be, bytes, and how long it may take, s.

        Examples
        --------
        >>> Settings().body_bounds("/api/simulate")
        (524288, 15.0)
        """
        if path == FILMS:
            return self.film_bytes, self.film_reading_time
        return self.upload_bytes if path in UPLOADS else self.body_bytes, self.reading_time
