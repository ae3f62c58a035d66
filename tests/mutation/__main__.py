"""Print the table of the mutants: `python -m tests.mutation`, or `make mutation`."""

from __future__ import annotations

from .mutants import PLANTED, SHARED
from .trying import tried


def main() -> None:
    """Try all of them."""
    counts = {"caught": 0, "refused": 0, "passes": 0}
    for mutant in (*PLANTED, *SHARED):
        failed, refused = tried(mutant)
        outcome = "caught" if failed else "refused" if refused else "passes"
        counts[outcome] += 1
        said = "; ".join(failed) or refused.split(". ")[0] or mutant.shared
        print(f"{mutant.room:34} {mutant.name:62} {outcome:8} {said}")
    print(", ".join(f"{count} {outcome}" for outcome, count in counts.items()))


if __name__ == "__main__":
    main()
