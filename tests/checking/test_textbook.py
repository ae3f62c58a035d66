"""Every mistake of the textbook is named, on tables of both senses, with the g of the standard and that of school."""

from __future__ import annotations

import pytest

import trundle as tr

from .textbook import MISTAKES, SCHOOL, STANDARD, data, shaken, system

PAIRS = [
    ("wrong-inertia-ratio", "sign-of-table-rate"),
    ("wrong-inertia-ratio", "tilt-left-out"),
    ("rolling-factor", "table-motion-ignored"),
    ("rolling-factor", "coriolis-for-rolling"),
    ("circle-upside-down", "sign-of-table-rate"),
    ("table-motion-ignored", "tilt-left-out"),
    ("sign-of-table-rate", "body-axes-for-space-axes"),
]
TILT = 0.03


def named(checked: tr.Check) -> list[set[str]]:
    return [set(mistake.name.split(" + ")) for mistake in checked.likely]


@pytest.mark.parametrize(("omega", "g"), [(3.49, STANDARD), (-3.49, SCHOOL)])  # each sense, and each g
@pytest.mark.parametrize("mistake", MISTAKES)
def test_each_mistake_is_named_whatever_g_is(mistake: str, omega: float, g: float) -> None:
    checked = tr.check(data(omega, TILT, mistake, g=g, parts="vw"), system(omega, TILT))
    assert checked.answer == "fails"
    expected = {mistake} | ({"wrong-gravity"} if g != STANDARD else set())
    first = named(checked)[0]
    assert mistake in first, checked.verdict
    assert first <= expected, checked.verdict  # the other g may be too little to show
    assert checked.likely[0].removes > 0.99


@pytest.mark.parametrize("mistake", ["table-motion-ignored", "sign-of-table-rate", "rolling-factor", "puck"])
def test_a_path_alone_names_it_among_others(mistake: str) -> None:
    omega = 3.49
    checked = tr.check(data(omega, TILT, mistake, g=SCHOOL, parts=""), system(omega, TILT))
    assert any(mistake in names for names in named(checked)), checked.verdict


@pytest.mark.parametrize("g", [STANDARD, SCHOOL])
def test_another_g_alone_is_named(g: float) -> None:
    other = SCHOOL + STANDARD - g
    checked = tr.check(data(-3.49, TILT, g=other, parts="v"), system(-3.49, TILT, gravity=g))
    assert named(checked)[0] == {"wrong-gravity"}
    assert checked.likely[0].numbers["gravity"] == other


@pytest.mark.parametrize("pair", PAIRS, ids=" + ".join)
def test_two_mistakes_at_once_are_named_together(pair: tuple[str, str]) -> None:
    g, omega = (SCHOOL, -3.49) if pair in PAIRS[::3] else (STANDARD, 3.49)
    checked = tr.check(data(omega, TILT, *pair, g=g, parts="vw"), system(omega, TILT))
    found = [names for names in named(checked) if set(pair) <= names]
    assert found, checked.verdict
    assert found[0] <= {*pair, "wrong-gravity"}


def test_under_noise_the_first_of_two_that_explain_leaves_least() -> None:
    pair = ("wrong-inertia-ratio", "sign-of-table-rate")
    checked = tr.check(shaken(data(-3.49, TILT, *pair, parts="vw"), 1e-4, 2), system(-3.49, TILT))
    assert set(pair) in named(checked), checked.verdict


def test_what_is_not_explained_is_ranked_by_how_much_each_mistake_removes() -> None:
    found = data(-3.49, TILT, "wrong-inertia-ratio", parts="vw")
    found["vx"] = found["vx"] + 2e-3 * (found["t"] > 1.0)  # a jump that nothing explains
    checked = tr.check(found, system(-3.49, TILT))
    assert not checked.likely
    removed = [mistake.removes for mistake in checked.nearest]
    assert removed
    assert removed == sorted(removed, reverse=True)
    assert "wrong-inertia-ratio" in checked.nearest[0].name
    assert f"It takes away {removed[0]:.1%} of what is off" in checked.verdict


def test_the_distance_is_said_in_plain_units() -> None:
    shell = data(-3.49, TILT, "wrong-inertia-ratio", duration=1.0)
    checked = tr.check(shell, system(-3.49, TILT))
    assert checked.apart.endswith("° from our own run after 0.99 s")
    assert checked.apart.partition(" and ")[0].split()[1] in ("mm", "cm", "m")
    assert checked.apart in checked.verdict
    right = tr.check(data(-3.49, TILT, duration=1.0, parts=""), system(-3.49, TILT))
    assert "°" not in right.apart  # nobody gave an orientation
