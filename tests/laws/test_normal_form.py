"""What is brought to normal form has the same value, and no more operations than it needs."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.tolerances import EXACT

from trundle.solve.normal_form import NormalForm, Sum
from trundle.solve.tape import Tape

VALUES = [0.7, -1.3, 2.1, 0.4]
OPERATIONS = ("+", "-", "*", "/", "neg", "square")


class Made:
    """Values in normal form of four inputs, and what they are."""

    def __init__(self) -> None:
        self.tape = Tape()
        self.inputs = self.tape.inputs(len(VALUES))
        self.form = NormalForm(self.tape, lambda coefficient: coefficient)
        self.factors: list[Sum] = [self.form.factor(node) for node in self.inputs]

    def __call__(self, operation: str, *parts: Sum) -> Sum:
        return self.form.apply(operation, *parts)

    def value(self, value: Sum) -> float:
        return self.tape.function([self.form.node(value)])(VALUES)[0]

    def operations(self, *values: Sum) -> int:
        needed = self.tape.needed([self.form.node(value) for value in values])
        return sum(self.tape.steps[index][0] != "input" for index in needed)


def done(operation: str, a: float, b: float) -> float:
    """Return the result on floats."""
    plain = {"+": a + b, "-": a - b, "*": a * b, "neg": -a, "square": a * a}
    return a / b if operation == "/" else plain[operation]


@given(st.lists(st.tuples(st.sampled_from(OPERATIONS), st.integers(0, 40), st.integers(0, 40)), max_size=25))
def test_the_value_stays(steps: list[tuple[str, int, int]]) -> None:
    made = Made()
    values, forms, sizes = list(VALUES), list(made.factors), [abs(value) for value in VALUES]
    for operation, i, j in steps:
        i, j = i % len(values), j % len(values)
        a, b = values[i], values[j]
        size = max(sizes[i], sizes[j]) * max(1.0, sizes[i], sizes[j])
        if operation == "/":
            if abs(b) < 1e-3 * sizes[j]:  # what has cancelled is rounding
                continue
            size = max(sizes[i], size) / min(1.0, abs(b)) ** 2
        if size > 1e6:
            continue
        values.append(done(operation, a, b))
        sizes.append(max(size, 1.0))
        two = (forms[i], forms[i]) if operation == "square" else (forms[i], forms[j])
        forms.append(made("*" if operation == "square" else operation, *two[: 1 if operation == "neg" else 2]))
    for value, form, size in zip(values, forms, sizes, strict=True):
        assert abs(made.value(form) - value) <= EXACT(1e4, size)


def test_equal_terms_meet_and_cancel() -> None:
    made = Made()
    x, y, z, _ = made.factors
    assert made("-", made("+", x, y), made("+", y, x)) == {}
    assert made("*", made("/", x, y), y) == x
    assert made("/", x, x) == {(): 1.0}
    twice = made("+", made("*", x, y), made("*", y, x))
    assert made.operations(twice) == 2  # 2·(x y)
    over = made("/", made("-", made("*", x, z), made("*", y, z)), z)
    assert over == made("-", x, y)


def test_a_factor_that_all_terms_share_is_multiplied_once() -> None:
    made = Made()
    x, y, z, w = made.factors
    apart = made("-", made("+", made("+", made("*", x, y), w), made("*", made("*", x, z), {(): 3.0})), w)
    assert made.operations(apart) == 3  # x·(y + 3·z)
    assert abs(made.value(apart) - VALUES[0] * (VALUES[1] + 3 * VALUES[2])) < EXACT(10, 10.0)
    squared = made("-", made("+", made("+", made("*", made("*", x, x), y), w), made("*", x, z)), w)
    assert made.operations(squared) == 3  # x·(x·y + z)
    divided = made("-", made("+", made("+", made("/", y, x), w), made("/", z, x)), w)
    assert abs(made.value(divided) - (VALUES[1] + VALUES[2]) / VALUES[0]) < EXACT(10, 10.0)


def test_a_product_that_is_there_serves_a_sum() -> None:
    made = Made()
    x, y, z, w = made.factors
    there = made("*", x, y)
    assert made.operations(there) == 1
    apart = made("-", made("+", made("+", there, w), made("*", x, z)), w)
    assert made.operations(there, apart) == 3  # x·y, x·z and their sum


def test_a_sum_that_comes_up_again_does_not_lean_on_itself() -> None:
    made = Made()
    x, y, z, w = made.factors
    first = made("/", made("+", made("*", x, w), made("*", y, w)), w)  # x + y
    less = made("-", first, z)
    again = made("+", less, z)
    assert again == first
    assert made.value(again) == VALUES[0] + VALUES[1]
    assert made.value(less) == VALUES[0] + VALUES[1] - VALUES[2]


def test_what_is_known_to_be_positive_or_of_length_one() -> None:
    made = Made()
    x, y, z, w = made.factors
    square = made("*", x, x)
    assert made("sqrt", square) != x
    made.form.take_for_positive(x)
    assert made("sqrt", square) == x
    assert made("abs", x) == x
    made.form.take_for_unit([y, z])
    squares = made("+", made("*", made("*", y, y), w), made("*", made("*", z, z), w))
    assert squares == w


@pytest.mark.parametrize("count", [2, 10, 2000])
def test_long_sums(count: int) -> None:
    made = Made()
    total: Any = made.factors[0]
    for i in range(1, count):
        power = made.factors[i % 4]
        for _ in range(i % 7):
            power = made("*", power, made.factors[i % 4])
        total = made("+", made("*", total, {(): 0.5}), made("sqrt", made("*", power, power)))
    assert math.isfinite(made.value(total))
