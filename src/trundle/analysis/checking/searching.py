"""Which mistakes explain what was found: each alone, then any two, then what else is off beside the best of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from .mistakes import Suspect, together

_FURTHER = 4  # of the best, beside which something else is looked for
_MUCH = 0.75  # of what is off, that mistakes must take away to be worth a word where they do not explain all
_FAR_BETTER = 0.5  # of what another leaves: two mistakes must be so much better than one
_LITTLE = 0.05  # of what is off
_FAR_LESS = 0.1  # times what mistakes leave that explain it alone: two are then worth a word, too
_HELPFUL = 12  # mistakes that help most alone: one of each pair is among them
_NEAREST = 3
SHOWN = 5  # mistakes


@dataclass(frozen=True)
class Tried:
    """Mistakes, tried together."""

    suspects: tuple[Suspect, ...]  # one or more
    left: float  # what is off with them undone, as a share of what is off as it is
    explains: bool  # whether nothing is left beyond its bound
    found: Any = None  # what whoever tried them wants to keep
    mended: int = 0  # how many checks that failed hold with them undone
    tells: bool = True  # whether anything changes with them undone

    @property
    def named(self) -> bool:
        """Whether all their numbers have a reason."""
        return all(one.named for one in self.suspects)

    @property
    def rank(self) -> tuple[bool, int, float]:
        """By which the likelier comes first: numbers with a reason, few mistakes, little left."""
        return not self.named, len(self.suspects), round(self.left, 3)


Trial = Callable[[tuple[Suspect, ...]], Tried | None]  # None where they cannot be tried


def explaining(suspects: Iterable[Suspect], tried: Trial, confirmed: Trial) -> tuple[list[Tried], list[Tried]]:
    """Search for mistakes that explain what was found."""
    singles = _all((one,) for one in suspects)(tried)
    found = _confirmed(singles, confirmed)
    telling = [one for one in singles if one.tells]
    mending = sorted((one for one in telling if one.mended), key=lambda one: (-one.mended, one.left))[:_HELPFUL]
    helpful = _once([*sorted(telling, key=lambda one: one.left)[:_HELPFUL], *mending])
    if any(one.named for one in found):  # beside others that all but explain it something small may be off
        names = {one.suspects[0].name for one in found}
        helpful = [one for one in helpful if one.left <= _LITTLE and one.named and one.suspects[0].name not in names]
    pairs = _all(_pairs(helpful, telling))(tried)
    if found:  # a free number explains too easily, and two mistakes easier than one
        least = _FAR_LESS * min((one.left for one in found if one.named), default=1.0)
        pairs = [one for one in pairs if one.named and one.left <= least]
    found = sorted([*found, *_confirmed(pairs, confirmed)], key=lambda one: one.rank)[:SHOWN]
    if found:
        return found, []
    best = sorted([*singles, *pairs], key=lambda one: one.left)[:_FURTHER]
    more = _all((*few.suspects, one.suspects[0]) for few in best for one in telling)(tried)
    found = _confirmed([one for one in more if len(one.suspects) > 1], confirmed)
    return (found, []) if found else ([], _nearest([*singles, *pairs, *more]))


def _once(trials: Sequence[Tried]) -> list[Tried]:
    return list({id(one): one for one in trials}.values())


def _pairs(helpful: Sequence[Tried], others: Sequence[Tried]) -> Iterator[tuple[Suspect, ...]]:
    """Yield each pair of which one at least helps by itself, once."""
    done: set[int] = set()
    for one in helpful:
        done.add(id(one))
        yield from ((one.suspects[0], other.suspects[0]) for other in others if id(other) not in done)


def _all(combinations: Iterable[tuple[Suspect, ...]]) -> Callable[[Trial], list[Tried]]:
    def by(tried: Trial) -> list[Tried]:
        found = (tried(suspects) for suspects in combinations if together(suspects))
        return [one for one in found if one is not None]

    return by


def _confirmed(trials: Sequence[Tried], confirmed: Trial) -> list[Tried]:
    """Return those that explain all when all is checked, the likeliest of each name first."""
    found: dict[tuple[str, ...], Tried] = {}
    for trial in sorted((one for one in trials if one.explains), key=lambda one: one.rank):
        name = tuple(one.name for one in trial.suspects)
        if name in found or len(found) == SHOWN or _has_a_reason(trial, found.values()):
            continue
        sure = confirmed(trial.suspects)
        if sure is not None and sure.explains:
            found[name] = sure
    return sorted(found.values(), key=lambda one: one.rank)


def _has_a_reason(trial: Tried, found: Iterable[Tried]) -> bool:
    """Tell whether a free number only repeats a number with a reason."""
    free = [one for one in trial.suspects if not one.named]
    given = [one for other in found for one in other.suspects if one.named]
    return any(one.touches & other.touches for one in free for other in given)


def _nearest(trials: Sequence[Tried]) -> list[Tried]:
    """Return those that take away most of what is off; two together only where neither does nearly as much."""
    left = {frozenset(map(id, trial.suspects)): trial.left for trial in trials}
    kept = []
    for trial in sorted((one for one in trials if one.left <= 1 - _MUCH), key=lambda one: one.rank):
        fewer = [frozenset(map(id, trial.suspects)) - {id(one)} for one in trial.suspects]
        if all(trial.left <= _FAR_BETTER * left.get(some, 1.0) for some in fewer):
            kept.append(trial)
    return sorted(kept, key=lambda one: one.left)[:_NEAREST]


__all__ = ["SHOWN", "Trial", "Tried", "explaining"]
