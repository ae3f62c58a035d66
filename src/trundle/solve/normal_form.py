"""Algebra on what a tape holds: sums of products with fixed coefficients, in which equal terms meet and cancel.

Each value that varies is a sum of terms c·x^i y^j, the coefficients c known before a run, x and y factors: an input, a
root, a sine, or a sum that is a factor of something else. So coefficients meet before a run, x − x and x/x vanish, and
one product serves wherever it comes up. Sums are not multiplied out, unless something cancels by it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

from .tape import Node, Tape, apply

Monomial = tuple[tuple[int, int], ...]  # (factor, exponent) of each factor, in ascending order
Sum = dict[Monomial, Any]  # to each product its coefficient: a float, or what is fixed
_ONE: Monomial = ()
_SHORT, _LONG = 2, 50  # terms of a sum: in which some have met, then it is written anew; that is a factor by itself


class NormalForm:
    """Values in normal form, and their way onto a tape.

    Parameters
    ----------
    tape : Tape
        Where they go.
    constant : callable
        (coefficient) -> its node on that tape, or a float.
    """

    def __init__(self, tape: Tape, constant: Callable[[Any], Any]) -> None:
        self.tape, self.constant = tape, constant
        self.factors: list[Node] = []  # on the tape
        self.places: dict[int, int] = {}  # of the nodes among the factors
        self.positive: set[int] = set()
        self.units: list[tuple[Any, list[Monomial]]] = []  # what squares add up to
        self.made: dict[Any, Node] = {}
        self.begun: set[Any] = set()  # on their way there
        # How products and sums came about: they are written so, where nothing simpler has come of them.
        self.splits: dict[Monomial, tuple[Monomial, Monomial, str]] = {}
        self.parts: dict[Any, tuple[Sum, Sum, str]] = {}
        self.scales: dict[Any, tuple[Sum, Any]] = {}
        self.seen: set[Any] = set()  # sums: each is written by such as came up before it, so that none leans on itself
        self.depths: dict[Any, int] = {}
        self.wholes: dict[int, tuple[Any, Any]] = {}

    def take_for_positive(self, value: Sum) -> None:
        """Know from now on that a factor is positive."""
        (((place, _),),) = value
        self.positive.add(place)

    def take_as_it_is(self, node: Node) -> None:
        """Know from now on that a node is multiplied by others as it is."""
        (((place, _),),) = self.factor(node)
        self.wholes[place] = 1.0, None

    def take_for_unit(self, vector: Iterable[Sum]) -> None:
        """Know from now on that a vector has length 1."""
        squares = [self._product(part, part, "*") for part in vector if part]
        terms = [term for square in squares for term in square.items()]
        if (
            len(squares) > 1
            and len(terms) == len(squares)
            and len({_key(coefficient) for _, coefficient in terms}) == 1
        ):
            self.units.append((1.0 / terms[0][1], [monomial for monomial, _ in terms]))

    def _with_units(self, value: Sum) -> Sum:
        """Return a sum with x² + y² + z² = 1, or another number, where that is known."""
        for whole, (first, *others) in self.units:
            for monomial, coefficient in list(value.items()):
                rest = _times(monomial, _inverted(first))
                terms = [monomial, *(_times(rest, other) for other in others)]
                if all(term in value and _key(value[term]) == _key(coefficient) for term in terms):
                    left = {term: own for term, own in value.items() if term not in terms}
                    return self._with_units(_added(left, {rest: coefficient * whole}))
        return value

    def factor(self, node: Node) -> Sum:
        """Return a node of the tape as a factor."""
        place = self.places.setdefault(node.index, len(self.factors))
        if place == len(self.factors):
            self.factors.append(node)
        return {((place, 1),): 1.0}

    def apply(self, operation: str, *operands: Sum) -> Sum:
        """Return the result of an operation of a tape."""
        if operation in ("+", "-"):
            return self._sum_of(operands[0], operands[1], operation)
        if operation == "neg":
            return self._times_constant(operands[0], -1.0)
        if operation in ("*", "/"):
            return self._product(operands[0], operands[1], operation)
        if operation in ("sqrt", "abs"):
            root = self._root(operation, operands[0])
            if root is not None:
                return root
        return self._other(operation, [self.node(part) for part in operands])

    def node(self, value: Sum) -> Any:
        """Return a value as a node of the tape, or as a number."""
        if not value:
            return 0.0
        key = _key_of(value)
        if key in self.begun and key not in self.made:  # x = a + b and a = x − b: each would be written by the other
            self.made[key] = self._sum(value) if len(value) > 1 else self._written(value)
        if key not in self.made:
            self.begun.add(key)
            self.made.setdefault(key, self._written(value))
        return self.made[key]

    def _other(self, operation: str, nodes: list[Any]) -> Sum:
        return self.factor(self.tape.record(operation, *nodes))

    def _root(self, operation: str, value: Sum) -> Sum | None:
        """Return √(x²) = x and |x| = x of what is positive; None of all else."""
        if len(value) != 1:
            return None
        ((monomial, coefficient),) = value.items()
        share = 2 if operation == "sqrt" else 1
        known = all(place in self.positive and count % share == 0 for place, count in monomial)
        if not known or not isinstance(coefficient, float) or coefficient < 0:
            return None
        return {tuple((p, n // share) for p, n in monomial): math.sqrt(coefficient) if share == 2 else coefficient}

    def _sum_of(self, a: Sum, b: Sum, operation: str) -> Sum:
        added = _added(a, b if operation == "+" else _scaled(b, -1.0))
        found = self._with_units(added)
        key = _key_of(found)
        if len(found) < 2 or self._came_up(found):
            return found
        size, rest = _shared(found)
        if not _is(size, 1.0) and (sizes := _size_of(a)) is not None and sizes == _size_of(b):
            self.scales[key] = rest, size
            a, b, key = _over(a, size), _over(b, size), _key_of(rest)
            for each in (a, b):
                self._came_up(each)
            if self._came_up(rest):
                return found
        cancelled = len(found) < len(a.keys() | b.keys()) or found is not added
        if not cancelled and (len(found) == len(a) + len(b) or len(found) > _SHORT):
            self.parts.setdefault(key, (a, b, operation))
        self._leans_on(found, a, b)
        return found if len(found) < _LONG else self.factor(self.node(found))

    def _leans_on(self, value: Sum, *parts: Sum) -> None:
        """Write a sum at once that is made of sums made of sums, and so on: to write it later would go too deep."""
        depth = 1 + max(self.depths.get(_key_of(part), 0) for part in parts)
        if depth == _LONG:
            self.node(value)
        self.depths[_key_of(value)] = depth % _LONG

    def _times_constant(self, value: Sum, factor: Any) -> Sum:
        found = _scaled(value, factor)
        if len(value) > 1 and not self._came_up(found):
            self.scales[_key_of(found)] = value, factor
            self._leans_on(found, value)
        return found

    def _product(self, a: Sum, b: Sum, operation: str) -> Sum:
        if operation == "/" or (len(a) > 1 and len(b) > 1):
            b = self._as_term(b)
        if operation == "/" and not b:
            return self._other("/", [self.node(a), 0.0])
        if not a or not b:
            return {}
        if len(b) > 1:
            a, b = b, a
        ((monomial, coefficient),) = b.items()
        if not monomial:
            return self._times_constant(a, 1.0 / coefficient if operation == "/" else coefficient)
        by = _inverted(monomial) if operation == "/" else monomial
        if len(a) > 1 and not any(_cancels(by, other) for other in a):
            a = self._as_term(a)
        if len(a) == 1 and _ONE not in a:
            a, b = self._whole(a), self._whole(b)
            ((monomial, coefficient),) = b.items()
            by = _inverted(monomial) if operation == "/" else monomial
        found: Sum = {}
        for other, factor in a.items():
            product = _times(other, by)
            if other and by and not _cancels(other, by):
                self.splits.setdefault(product, (other, monomial, operation))
            found[product] = factor / coefficient if operation == "/" else factor * coefficient
        self._came_up(found)
        return found

    def _came_up(self, value: Sum) -> bool:
        """Tell whether a sum came up before; from now on it has."""
        key = _key_of(value)
        known = key in self.seen
        self.seen.add(key)
        return known

    def _whole(self, term: Sum) -> Sum:
        """Return c·x as a factor of its own where x has come up in no other way so far: so c is multiplied once."""
        ((monomial, coefficient),) = term.items()
        if len(monomial) != 1 or monomial[0][1] != 1:
            return term
        place, (size, sign) = monomial[0][0], _unsigned(coefficient)
        known, scaled = self.wholes.setdefault(place, (_key(size), None))
        if _is(size, 1.0) or known != _key(size):
            return term
        if scaled is None:
            ((scaled, _),) = self.factor(self.node({monomial: size})).items()
            self.wholes[place] = known, scaled
        return {scaled: sign}

    def _as_term(self, value: Sum) -> Sum:
        """Return a sum as one term: a factor, times the coefficient that all of its terms share, or its sign."""
        if len(value) < 2:
            return value
        scaled = self.scales.get(_key_of(value))
        if scaled is not None:
            return _scaled(self._whole(self._as_term(scaled[0])), scaled[1])
        coefficient, rest = _shared(value)
        if _key_of(_scaled(rest, -1.0)) in self.made:
            coefficient, rest = -coefficient, _scaled(rest, -1.0)
        ((whole, _),) = self.factor(self.node(rest)).items()
        return {whole: coefficient}

    # Onto the tape

    def _written(self, value: Sum) -> Any:
        if len(value) > 1:
            if _key_of(value) in self.parts:
                a, b, operation = self.parts[_key_of(value)]
                return apply(self.tape, operation, self.node(a), self.node(b))
            scaled = self._origin(value)
            if scaled is not None:
                if _is(scaled[1], -1.0) and self._turns(scaled[0]):
                    return self._turned(scaled[0])
                return apply(self.tape, "*", self.node(scaled[0]), self.constant(scaled[1]))
            return self._sum(value)
        ((monomial, coefficient),) = value.items()
        if not monomial:
            return self.constant(coefficient)
        if _is(coefficient, 1.0):
            return self._monomial(monomial)
        return apply(self.tape, "*", self.node({monomial: 1.0}), self.constant(coefficient))

    def _origin(self, value: Sum) -> tuple[Sum, Any] | None:
        """Return the sum, there already or not a multiple itself, of which another is a multiple, and the factor."""
        origin, factor = self.scales.get(_key_of(value), ({}, 1.0))
        while _key_of(origin) in self.scales and _key_of(origin) not in self.made:
            origin, own = self.scales[_key_of(origin)]
            factor = factor * own
        return (origin, factor) if origin else None

    def _turns(self, value: Sum) -> bool:
        """Tell whether a sum that is not there yet can be written with the other sign at the same price."""
        a, b, operation = self.parts.get(_key_of(value), ({}, {}, ""))
        there = _key_of(value) in self.made
        return not there and (operation == "-" or (operation == "+" and (self._turns(a) or self._turns(b))))

    def _turned(self, value: Sum) -> Any:
        """Write a sum with the other sign."""
        a, b, operation = self.parts[_key_of(value)]
        if operation == "-":
            return apply(self.tape, "-", self.node(b), self.node(a))
        a, b = (a, b) if self._turns(a) else (b, a)
        return apply(self.tape, "-", self.node(_scaled(a, -1.0)), self.node(b))

    def _sum(self, value: Sum) -> Any:
        """Write a sum, in which terms with one coefficient are added up before they are multiplied by it."""
        common = _common(value)
        if common and not any(self._is_there(monomial) for monomial in value):
            rest = {_times(monomial, _inverted(common)): coefficient for monomial, coefficient in value.items()}
            return apply(self.tape, "*", self.node({common: 1.0}), self.node(rest))
        groups: dict[Any, tuple[Any, list[tuple[Monomial, float]]]] = {}
        for monomial, coefficient in value.items():
            size, sign = _unsigned(coefficient)
            if monomial == _ONE:
                size, sign = coefficient, 1.0
            groups.setdefault((monomial == _ONE, _key(size)), (size, []))[1].append((monomial, sign))
        total: Any = None
        for (constant, _), (size, terms) in groups.items():
            if constant:
                part = self.constant(size)
            else:
                part = self._plain(dict(terms))
                part = part if _is(size, 1.0) else apply(self.tape, "*", part, self.constant(size))
            total = part if total is None else apply(self.tape, "+", total, part)
        return total

    def _plain(self, terms: dict[Monomial, float]) -> Any:
        """Write a sum whose coefficients are 1 and −1."""
        total: Any = None
        for monomial, sign in sorted(terms.items(), key=lambda term: -term[1]):
            part = self.node({monomial: 1.0})
            if total is None:
                total = part if sign > 0 else -part
            else:
                total = apply(self.tape, "+" if sign > 0 else "-", total, part)
        return total

    def _monomial(self, monomial: Monomial) -> Any:
        """Write a product, by way of one that is there already, if there is one."""
        if len(monomial) == 1 and monomial[0][1] == 1:
            return self.factors[monomial[0][0]]
        split = self.splits.get(monomial)
        rest, place, up = min(self._ways(monomial), key=lambda way: (not self._is_there(way[0]), not way[2]))
        if split is not None and (not self._is_there(rest) or all(map(self._is_there, split[:2]))):
            a, b, operation = split
            if operation == "*" and all(count < 0 for _, count in b) and not self._is_there(b):
                b, operation = _inverted(b), "/"
            return apply(self.tape, operation, self.node({a: 1.0}), self.node({b: 1.0}))
        if all(count % 2 == 0 for _, count in monomial):
            half = self.node({tuple((place, count // 2) for place, count in monomial): 1.0})
            return apply(self.tape, "*", half, half)
        before = self.node({rest: 1.0})
        return apply(self.tape, "*" if up else "/", before, self.factors[place])

    def _ways(self, monomial: Monomial) -> Iterable[tuple[Monomial, int, bool]]:
        """Yield what is left of a product without one of its factors, the factor, and whether it multiplies."""
        for place, count in reversed(monomial):
            step = 1 if count > 0 else -1
            yield _times(monomial, ((place, -step),)), place, count > 0

    def _is_there(self, monomial: Monomial) -> bool:
        return (len(monomial) == 1 and monomial[0][1] == 1) or _key_of({monomial: 1.0}) in self.made


def _key_of(value: Sum) -> Any:
    return frozenset([(monomial, _key(coefficient)) for monomial, coefficient in value.items()])


def _key(coefficient: Any) -> Any:
    return ("node", coefficient.index) if isinstance(coefficient, Node) else coefficient


def _is(coefficient: Any, number: float) -> bool:
    return not isinstance(coefficient, Node) and coefficient == number


def _unsigned(coefficient: Any) -> tuple[Any, float]:
    """Return a coefficient without its sign, and the sign."""
    if isinstance(coefficient, Node):
        return (coefficient, 1.0) if coefficient.minus is None else (coefficient.minus, -1.0)
    return abs(coefficient), math.copysign(1.0, coefficient)


def _scaled(value: Sum, factor: Any) -> Sum:
    return {monomial: coefficient * factor for monomial, coefficient in value.items()}


def _added(a: Sum, b: Sum) -> Sum:
    found = dict(a)
    for monomial, coefficient in b.items():
        if monomial not in found:
            found[monomial] = coefficient
            continue
        both = found[monomial]
        opposite = _key(both) == _key(-coefficient)
        total = 0.0 if opposite else both + coefficient
        if _is(total, 0.0):
            del found[monomial]
        else:
            found[monomial] = total
    return found


def _times(a: Monomial, b: Monomial) -> Monomial:
    if not a or not b:
        return a or b
    counts = dict(a)
    for place, count in b:
        counts[place] = counts.get(place, 0) + count
    return tuple(sorted([pair for pair in counts.items() if pair[1]]))


def _common(value: Sum) -> Monomial:
    """Return the factors, not divisors, that all terms have."""
    first, *others = (dict(monomial) for monomial in value)
    least = {place: min(count, *(other.get(place, 0) for other in others)) for place, count in first.items()}
    return tuple((place, count) for place, count in least.items() if count > 0)


def _inverted(monomial: Monomial) -> Monomial:
    return tuple((place, -count) for place, count in monomial)


def _cancels(a: Monomial, b: Monomial) -> bool:
    """Tell whether a factor of the one is a divisor of the other."""
    if not a or not b:
        return False
    counts = dict(a)
    return any(counts.get(place, 0) * count < 0 for place, count in b)


def _shared(value: Sum) -> tuple[Any, Sum]:
    """Return the coefficient that all terms have but for its sign, and the rest."""
    parts = {monomial: _unsigned(coefficient) for monomial, coefficient in value.items()}
    size = next(iter(parts.values()))[0]
    if any(_key(other) != _key(size) for other, _ in parts.values()):
        return 1.0, value
    return size, {monomial: sign for monomial, (_, sign) in parts.items()}


def _size_of(value: Sum) -> Any:
    """Return the key of the coefficient that all terms have but for its sign; None where they differ."""
    sizes = {_key(_unsigned(coefficient)[0]) for coefficient in value.values()}
    return next(iter(sizes)) if len(sizes) == 1 else None


def _over(value: Sum, size: Any) -> Sum:
    """Return the signs of terms that all have one coefficient, but for its sign."""
    sign = _unsigned(size)[1]
    return {monomial: _unsigned(coefficient)[1] * sign for monomial, coefficient in value.items()}
