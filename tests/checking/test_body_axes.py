"""Ω along the body's axes is named under noise, with or without an orientation, and only where it is the mistake."""

from __future__ import annotations

import numpy as np
import pytest

import trundle as tr

from .textbook import MISTAKES, SCHOOL, STANDARD, A, data, painted, shaken, system
from .theirs import integrated, turned, vectors, with_parts

BODY = "body-axes-for-space-axes"
TILT = 0.03
OTHERS = [name for name in MISTAKES if name not in (BODY, "puck")]  # a puck keeps its Ω: it is the same along all axes


def names(checked: tr.Check) -> list[set[str]]:
    return [set(mistake.name.split(" + ")) for mistake in checked.likely]


@pytest.mark.parametrize(("omega", "g"), [(3.49, STANDARD), (-3.49, SCHOOL)])
@pytest.mark.parametrize("parts", ["w", "vw", "vwq"])
@pytest.mark.parametrize("sigma", [1e-4, 1e-3])
def test_it_is_named_under_noise(sigma: float, parts: str, omega: float, g: float) -> None:
    seed = 1 + len(parts) + (omega > 0)  # another noise in each
    seen = shaken(data(omega, TILT, BODY, g=g, parts=parts), sigma, seed)
    checked = tr.check(seen, system(omega, TILT))
    assert names(checked), checked.verdict
    assert BODY in names(checked)[0] <= {BODY, "wrong-gravity"}, checked.verdict
    assert checked.likely[0].named


@pytest.mark.parametrize("other", OTHERS)
def test_it_is_named_beside_another_under_noise(other: str) -> None:
    omega, g = (3.49, STANDARD) if other in OTHERS[::2] else (-3.49, SCHOOL)
    seen = shaken(data(omega, TILT, BODY, other, g=g, parts="vw"), 3e-4, 5)
    checked = tr.check(seen, system(omega, TILT))
    assert names(checked), checked.verdict
    assert {BODY, other} <= names(checked)[0] <= {BODY, other, "wrong-gravity"}, checked.verdict


@pytest.mark.parametrize("sigma", [0.0, 1e-4, 1e-3])
def test_a_start_that_nobody_told_is_fitted(sigma: float) -> None:
    exact = painted(data(-3.49, TILT, BODY, parts="vw"), (1.0, -2.0, 0.5), 2.2)
    checked = tr.check(shaken(exact, sigma, 3), system(-3.49, TILT))
    assert names(checked)[:1] == [{BODY}], checked.verdict
    found = checked.likely[0]
    assert not found.named  # three free numbers
    q = np.array([found.numbers[part] for part in ("qw", "qx", "qy", "qz")])
    unit = np.array([1.0, -2.0, 0.5]) / np.linalg.norm([1.0, -2.0, 0.5])
    planted = np.array([np.cos(1.1), *(np.sin(1.1) * unit)])
    assert abs(q @ planted) > np.cos(0.5 * (1e-6 + 100 * sigma))
    assert "was fitted" in found.says


@pytest.mark.parametrize("mistake", [None, *OTHERS, "puck"])
def test_it_is_not_named_where_others_were_made(mistake: str | None) -> None:
    for seed, (sigma, parts, omega) in enumerate([(1e-4, "vw", 3.49), (1e-3, "w", -3.49)]):
        planted = [mistake] if mistake else []
        checked = tr.check(shaken(data(omega, TILT, *planted, parts=parts), sigma, seed), system(omega, TILT))
        assert (checked.answer == "fails") is bool(mistake), checked.verdict
        assert not any(BODY in told.name for told in (*checked.likely, *checked.nearest)), checked.verdict


def test_on_a_circle_about_the_centre_the_rate_that_is_said_comes_first() -> None:
    t, omega, level = np.arange(0.0, 3.0, 0.01), 3.49, system(3.49, 0.0)
    z = 0.1 * np.exp(2j / 7 * omega * t)
    w = 1j * (2j / 7 - 1j) * omega * z / A
    exact = {"t": t}
    for stem, plane, normal in (("", z, A), ("v", 2j / 7 * omega * z, 0.0), ("w", w, 0.0)):
        exact = with_parts(exact, stem, np.column_stack([plane.real, plane.imag, np.full(t.size, normal)]))
    Q = np.array([turned(q) for q in integrated(exact, body_axes=False)])
    own = with_parts(exact, "w", np.einsum("nji,nj->ni", Q, vectors(exact, "w")))
    checked = tr.check(shaken(painted(own, (1.0, 1.0, 0.3), 1.3), 3e-4, 4), level)
    assert names(checked)[:1] == [{BODY}], checked.verdict


def test_straight_ahead_nothing_tells_the_start() -> None:
    t = np.arange(0.0, 2.0, 0.01)
    wrong = {"t": t, "x": 0.3 * t, "y": 0 * t, "vx": 0.3 + 0 * t, "vy": 0 * t, "vz": 0 * t}
    wrong |= {"wx": 0 * t, "wy": -12.0 + 0 * t, "wz": 0 * t}  # of the other sign, which a turn of the start would mend
    checked = tr.check(wrong, system(0.0, 0.0))
    assert [mistake.name for mistake in checked.likely][:1] == ["sign-of-angular-velocity"], checked.verdict
    assert not any(BODY in mistake.name for mistake in checked.likely)
