"""Files that were damaged on the way: each is read, or refused in words of the house's own.

`python -m tests.tracks.damage --count 2000` mutilates that many files and prints what came of them.
"""

from __future__ import annotations

import argparse
import faulthandler
import sys
import tempfile
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np

import trundle as tr
from trundle.tracks.formats.base import TEXTS

from .examples import EXAMPLES, PLACES, Example

Draw = np.random.Generator
_SIGNS = (b"\t", b";", b",", b" ", b".", b"|")


def _bytes_flipped(content: bytes, draw: Draw) -> bytes:
    damaged = np.frombuffer(content, dtype=np.uint8).copy()
    places = draw.integers(0, damaged.size, draw.integers(1, 12))
    damaged[places] ^= draw.integers(1, 256, places.size, dtype=np.uint8)
    return damaged.tobytes()


def _letters_changed(content: bytes, draw: Draw) -> bytes:
    damaged = bytearray(content)
    for place in draw.integers(0, len(damaged), draw.integers(1, 12)):
        damaged[place] = draw.choice(list(b'0123456789.,;-eE"<>/ \t\nxyz#'))
    return bytes(damaged)


def _cut_off(content: bytes, draw: Draw) -> bytes:
    return content[: draw.integers(0, len(content))]


def _beginning_lost(content: bytes, draw: Draw) -> bytes:
    return content[draw.integers(0, len(content)) :]


def _piece_moved(content: bytes, draw: Draw) -> bytes:
    a, b, c = sorted(draw.integers(0, len(content), 3))
    return content[:a] + content[b:c] + content[a:b] + content[c:]


# What changes no number: whatever is read then, must be what stood there.


def _lines_lost(content: bytes, draw: Draw) -> bytes:
    lines = content.splitlines(keepends=True)
    return b"".join(line for line in lines if draw.random() > 1.5 / max(len(lines), 1))


def _lines_doubled(content: bytes, draw: Draw) -> bytes:
    lines = content.splitlines(keepends=True)
    return b"".join(line * (1 + (draw.random() < 1.5 / max(len(lines), 1))) for line in lines)


def _separator_exchanged(content: bytes, draw: Draw) -> bytes:
    one, other = draw.choice(len(_SIGNS), 2, replace=False)
    return content.replace(_SIGNS[one], _SIGNS[other])


def _encoded_again(content: bytes, draw: Draw) -> bytes:
    try:
        text = content.decode()
    except UnicodeDecodeError:
        return content + b"\x00"
    return text.encode(str(draw.choice(["utf-16", "utf-16-le", "utf-16-be", "utf-8-sig", "latin-1"])), "replace")


def _ends_changed(content: bytes, draw: Draw) -> bytes:
    end = (b"\r\n", b"\r", b"\n\n", b"  \n", b",\n", b";;\n", b"\t\n")[draw.integers(0, 7)]
    return content.replace(b"\n", end)


WILD: tuple[Callable[[bytes, Draw], bytes], ...] = (
    _bytes_flipped, _letters_changed, _cut_off, _beginning_lost, _piece_moved,
)  # fmt: skip
TAME: tuple[Callable[[bytes, Draw], bytes], ...] = (
    _lines_lost, _lines_doubled, _separator_exchanged, _encoded_again, _ends_changed,
)  # fmt: skip


def damaged(seed: int) -> tuple[Example, str, bytes, bool]:
    """Return an example, what was done to it, what became of it, and whether its numbers were left as they were."""
    draw = np.random.default_rng(seed)
    example = EXAMPLES[seed % len(EXAMPLES)]
    tame = bool(draw.random() < 0.5)
    done = draw.choice(np.array(TAME if tame else WILD, dtype=object), draw.integers(1, 3))
    content = example.content
    for change in done:
        content = change(content, draw) or b"\n"
    return example, " ".join(change.__name__[1:] for change in done), content, tame


def outcome(seed: int, folder: Path) -> str:
    """Read a damaged file; raise where something else comes of it than a track that is right, or a refusal."""
    example, done, content, tame = damaged(seed)
    path = folder / example.file
    path.write_bytes(content)
    try:
        track = tr.read_track(path, **example.options)
    except tr.TrundleError as error:
        told = str(error)
    else:
        if tame and example.content[:2] not in (b"PK", b"\x89H"):
            _check_true(track, example, f"{seed}: {example.id}, {done}: {track.taken}")
        return "read, with rows left out" if track.rejected else "read"
    assert "\n" not in told, told
    assert path.suffix not in TEXTS or "readable" not in told, f"a word of Python's own: {told}"
    return f"refused: {told.partition('; got')[0]}"


def _check_true(track: tr.Track, example: Example, told: str) -> None:
    """Find each row that was read in the file as it was before."""
    truth = PLACES | example.truth if "t" not in example.truth else example.truth
    names = [name for name in truth if name in (*track.columns, "t")]
    true = np.column_stack([truth[name] for name in names])
    read = np.column_stack([track[name] for name in names])
    for row in read:
        same = np.isclose(true, row, rtol=1e-9, atol=1e-12, equal_nan=True)
        lost = np.isnan(row)  # a cell may have been lost, and no other may have come in its place
        assert (same | lost).all(axis=1).any(), f"{told}: {dict(zip(names, row, strict=True))}"


def main() -> int:
    """Damage many files, and print what came of them."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    warnings.simplefilter("error")
    found: Counter[str] = Counter()
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(asked.seed, asked.seed + asked.count):
            faulthandler.dump_traceback_later(20, exit=True)  # a library in C that does not return
            try:
                found[outcome(seed, Path(folder))] += 1
            except Exception as error:  # noqa: BLE001
                bad += 1
                print(f"seed {seed}: {type(error).__name__}: {error}")
    for what, count in found.most_common():
        print(f"{count:6d}  {what}")
    print(f"{bad:6d}  tracebacks, or wrong readings")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
