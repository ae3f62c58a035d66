"""How much memory is free, and whether what was asked for finds room in it."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from ..errors import InvalidValueError

_SMALL = 64_000_000  # bytes that are not worth a look
_BESIDES = 1.5  # times the result: what is worked out on the way, the card, figures and file
_CGROUPS = Path("/sys/fs/cgroup")
_HELD = (("memory.max", "memory.current"), ("memory.limit_in_bytes", "memory.usage_in_bytes"))  # versions 2 and 1


def free() -> float | None:
    """Return how many bytes this process may still take.

    Examples
    --------
    >>> free() is None or free() > 0
    True
    """
    return min([*_of_machine(), *_of_groups(), *_of_process()], default=None)


def check_room(samples: int, each: int, key: str, received: object, less: Callable[[int], str]) -> None:
    """Refuse more samples than find room in memory, before any of them is worked out.

    Examples
    --------
    >>> check_room(1000, 185, "every", "1 ms", "ask for {} samples".format)
    """
    if samples * each < _SMALL:
        return
    room = free()
    if room is not None and samples * each * _BESIDES > room:
        rule = "must leave no more samples than find room in memory"
        taken = f"{samples:,} of them take {_said(samples * each * _BESIDES)}, and {_said(room)} are free"
        raise InvalidValueError(key, rule, received, f"{taken}: {less(max(int(room / each / _BESIDES), 2))}.")


def _said(size: float) -> str:
    return f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{size / 1e6:.0f} MB"


def _of_machine() -> list[float]:
    with suppress(OSError, ValueError, IndexError):
        lines = Path("/proc/meminfo").read_text().splitlines()
        return [1024.0 * int(line.split()[1]) for line in lines if line.startswith("MemAvailable:")]
    return []


def _of_groups() -> list[float]:
    """Return what each control group that this process is in leaves."""
    found: list[float] = []
    with suppress(OSError):
        for line in Path("/proc/self/cgroup").read_text().splitlines():
            _, kind, path = line.split(":", 2)
            if kind in ("", "memory"):
                # In a container its own group is the top one, whatever path the host has for it.
                for folder in (_CGROUPS / kind / path.lstrip("/"), _CGROUPS / kind):
                    found += [left for names in _HELD if (left := _left(folder, *names)) is not None]
    return found


def _left(folder: Path, limit: str, used: str) -> float | None:
    with suppress(OSError, ValueError):  # no such file; "max"
        most, now = (int((folder / name).read_text()) for name in (limit, used))
        stat = dict(line.split() for line in (folder / "memory.stat").read_text().splitlines())
        return float(most - now + int(stat.get("inactive_file", 0)))  # what is cached is given back
    return None


def _of_process() -> list[float]:
    with suppress(ImportError, OSError, ValueError):
        import resource

        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit != resource.RLIM_INFINITY:
            taken = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
            return [float(limit - taken)]
    return []
