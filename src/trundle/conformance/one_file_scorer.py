"""Compare a CSV of your engine with the exact run of a case.

    python3 score.py incline mine.csv [threshold]

It needs nothing but Python. Prints the largest error of position over the path, and of orientation over the angle
turned through; its exit status is 1 where the larger exceeds the threshold, 2 where the file is not as it should be.
CC0 1.0.
"""

from __future__ import annotations

import csv
import math
import sys
from itertools import pairwise
from pathlib import Path

Bodies = dict[int, list[tuple[float, list[float], list[float], list[float]]]]
PARTS = (("x", "y", "z"), ("qw", "qx", "qy", "qz"), ("wx", "wy", "wz"))


def read(path: str | Path) -> Bodies:
    """Return {body: [(time, position, quaternion, angular velocity)]} of a file."""
    bodies: Bodies = {}
    with Path(path).open(newline="") as stream:
        rows = csv.DictReader(stream)
        missing = {"time", "body", *(name for part in PARTS for name in part)} - {*(rows.fieldnames or ())}
        if missing:
            raise ValueError(f"these columns are missing: {', '.join(sorted(missing))}")
        for row in rows:
            place, turn, spin = ([float(row[name]) for name in part] for part in PARTS)
            bodies.setdefault(int(row["body"]), []).append((float(row["time"]), place, turn, spin))
    return bodies


def angle(p: list[float], q: list[float]) -> float:
    """Return the angle between two orientations, rad."""
    same = math.copysign(1, sum(a * b for a, b in zip(p, q, strict=True)))
    return 4 * math.asin(min(1, math.dist(p, [same * x for x in q]) / 2))


def compare(exact: Bodies, mine: Bodies) -> tuple[float, float]:
    """Return both errors, the worst of all bodies."""
    position = turning = 0.0
    lengths, turns = [], []
    for body in exact.values():
        lengths.append(sum(math.dist(a[1], b[1]) for a, b in pairwise(body)))
        turns.append(sum(math.hypot(*b[3]) * (b[0] - a[0]) for a, b in pairwise(body)))
    for (name, body), length, turned in zip(exact.items(), lengths, turns, strict=True):
        if len(mine.get(name, ())) != len(body):
            raise ValueError(f"body {name} must have {len(body)} rows, it has {len(mine.get(name, ()))}")
        for there, here in zip(body, mine[name], strict=True):
            if abs(there[0] - here[0]) > 1e-6:
                raise ValueError(f"the times must be those of the exact run: {there[0]} s, not {here[0]} s")
            if not all(map(math.isfinite, (*here[1], *here[2]))):
                raise ValueError(f"the numbers must be finite, at {here[0]} s they are not")
            if abs(math.hypot(*here[2]) - 1) > 1e-3:
                raise ValueError(f"quaternions must have the length 1, at {here[0]} s one has not")
            position = max(position, math.dist(there[1], here[1]) / max(length, 1e-3 * max(lengths), 1e-3))
            turning = max(turning, angle(there[2], here[2]) / max(turned, 1e-3 * max(turns)))
    return position, turning


def main(name: str, file: str, threshold: str = "inf") -> int:
    """Compare one file, and return the exit status."""
    exact = Path(__file__).with_name(f"{name}.csv")
    if not exact.exists():
        print(f"{name}: there is no case of this name beside {Path(__file__).name}", file=sys.stderr)
        return 2
    try:
        most = float(threshold)
        position, turning = compare(read(exact), read(file))
    except (OSError, TypeError, ValueError) as error:
        print(f"{file}: {error}", file=sys.stderr)
        return 2
    print(f"{name}: position {position:.2e} of the path, orientation {turning:.2e} of the angle turned through")
    return int(max(position, turning) > most)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if 3 <= len(sys.argv) <= 4 else __doc__)
