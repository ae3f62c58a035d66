"""The table of a fuzz, and what ended badly, by cause."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from pathlib import Path

from .running import BAD, GAVE_UP, OUTCOMES, REFUSED, Outcome

_EXAMPLES = 4


def table(found: Sequence[Outcome], *, markdown: bool = False) -> str:
    """Return how often what came of each class.

    Parameters
    ----------
    found : sequence of Outcome
        Of all seeds.
    markdown : bool
        As a table of Markdown, or of plain text.

    Returns
    -------
    str
        Lines.
    """
    heads = [
        "class",
        "scenarios",
        "ran",
        *(one for one in OUTCOMES if one != REFUSED),
        REFUSED,
        "bad of those that ran",
    ]
    heads += ["warned", "refused on the way", "CPU s"]
    rows = [_row(name, [one for one in found if one.name == name]) for name in dict.fromkeys(one.name for one in found)]
    if len(rows) > 1:
        rows.append(_row("all", found))
    return _markdown(heads, rows) if markdown else _plain(heads, rows)


def _row(name: str, found: Sequence[Outcome]) -> list[str]:
    counts = Counter(one.outcome for one in found)
    ran = len(found) - counts[REFUSED]
    bad = sum(counts[one] for one in BAD)
    rate = f"{bad} ({100 * bad / ran:.2g} %)" if ran else "-"
    cells = [name, len(found), ran, *(counts[one] for one in OUTCOMES if one != REFUSED), counts[REFUSED], rate]
    cells += [sum(bool(one.warned) for one in found), sum(sum(one.refusals.values()) for one in found)]
    return [*map(str, cells), f"{sum(one.seconds for one in found):.0f}"]


def _plain(heads: list[str], rows: list[list[str]]) -> str:
    lines = [heads, *rows]
    widths = [max(len(line[i]) for line in lines) for i in range(len(heads))]
    return "\n".join(
        "  ".join(cell.rjust(w) if i else cell.ljust(w) for i, (cell, w) in enumerate(zip(line, widths, strict=True)))
        for line in lines
    )


def _markdown(heads: list[str], rows: list[list[str]]) -> str:
    ruled = [heads, ["---", *["---:"] * (len(heads) - 1)], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in ruled)


def causes(found: Sequence[Outcome], *, markdown: bool = False) -> str:
    """Return what ended badly, and what was given up, the most frequent cause first, with seeds to run again.

    Parameters
    ----------
    found : sequence of Outcome
        Of all seeds.
    markdown : bool
        Whether as a list of Markdown.

    Returns
    -------
    str
        Lines; empty where all is well.
    """
    groups: dict[tuple[str, str], list[Outcome]] = defaultdict(list)
    for one in found:
        if one.outcome in (*BAD, GAVE_UP):
            groups[one.outcome, one.cause].append(one)
        if one.warned:
            groups["warned", one.warned].append(one)
    lines = []
    for (outcome, cause), those in sorted(groups.items(), key=lambda item: (item[0][0], -len(item[1]))):
        seeds = ", ".join(f"{one.name} {one.seed}" for one in those[:_EXAMPLES])
        more = f" and {len(those) - _EXAMPLES} more" if len(those) > _EXAMPLES else ""
        lines.append(f"{'- ' if markdown else ''}{outcome}, {len(those)}: {cause} ({seeds}{more})")
    return "\n".join(lines)


def keep(one: Outcome, folder: Path) -> Path | None:
    """Write a scenario that ended badly to a file of its own.

    Parameters
    ----------
    one : Outcome
        Any.
    folder : Path
        Where.

    Returns
    -------
    Path or None
        The file; none where all is well.
    """
    if one.outcome not in BAD or not one.text:
        return None
    path = folder / f"{one.outcome.replace(' ', '-')}-{one.name}-{one.seed}.toml"
    told = "\n".join(f"# {line}" for line in f"{one.outcome}: {one.cause}\n{one.detail}".splitlines())
    path.write_text(f"{told}\n{one.text}", encoding="utf-8")
    return path
